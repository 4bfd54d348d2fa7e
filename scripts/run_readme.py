#!/usr/bin/env python3
"""Runs the blocks marked `sh` of the pages, in order, in a fresh clone.

  scripts/run_readme.py BUILD-FOLDER [README...] --left-out N

Without names: every README.md and the three starts (PAGES). Each page has its
own clone and shell. In a block with `$ ` lines, only these
are commands; the others are output. A comment before a block:
  <!-- long: COMMAND -->    over 60 s; runs the smaller COMMAND instead
  <!-- not run: REASON -->  runs nothing
The clone has the working tree; its build folder links to BUILD-FOLDER.

Exit status: 0 done, 1 a command failed or another number was left out, 2 usage
error.
"""
import argparse
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent
PAGES = ("README.md", "DECIDE.md", "INTEGRATE.md", "EXPLORE.md")
LONG = 60       # seconds from which a command is marked
LIMIT = 5 * LONG  # of any command, on a machine that does other work too
BLOCK = re.compile(r"(?:<!-- (long|not run): (.*?) -->\n)?```sh\n(.*?)```\n", re.DOTALL)


def fail(message):
    sys.exit(f"run_readme: {message}")


def commands_of(block):
    """The commands of a block; a backslash joins lines."""
    lines = re.sub(r"\\\n", " ", block).splitlines()
    if any(line.startswith("$ ") for line in lines):
        lines = [line[2:] for line in lines if line.startswith("$ ")]
    return [line.strip() for line in lines if line.strip() and not line.lstrip().startswith("#")]


def plan(readme):
    """[(what is run, the long command that it stands for)], [(command that is not run, reason)]."""
    text = readme.read_text(encoding="utf-8")
    run, left_out = [], []
    for mark, instead, block in BLOCK.findall(text):
        commands = commands_of(block)
        if not commands:
            fail(f"{readme}: a block marked `sh` has no command")
        if mark == "not run":
            left_out += [(command, instead) for command in commands]
        elif mark == "long":
            if len(commands) != 1:
                fail(f"{readme}: a block marked long has {len(commands)} commands; give each a block of its own")
            run.append((instead, commands[0]))
        else:
            run += [(command, None) for command in commands]
    if text.count("```sh\n") != len(BLOCK.findall(text)):
        fail(f"{readme}: a block marked `sh` has no end")
    return run, left_out


def git(*arguments):
    done = subprocess.run(["git", "-C", str(ROOT), *arguments], capture_output=True, text=True, check=True)
    return [name for name in done.stdout.split("\0") if name]


def clone_into(folder, build):
    """A clone with the working tree's files as they are, and links to what was built."""
    if (ROOT / ".git").exists():
        subprocess.run(["git", "clone", "-q", str(ROOT), str(folder)], check=True)
        for name in git("ls-files", "-z", "--modified", "--others", "--exclude-standard"):
            target = folder / name
            if (ROOT / name).exists():
                target.parent.mkdir(parents=True, exist_ok=True)
                shutil.copy2(ROOT / name, target, follow_symlinks=False)
            else:
                target.unlink(missing_ok=True)
    else:  # a copy of the sources without a history
        shutil.copytree(ROOT, folder, symlinks=True, ignore=shutil.ignore_patterns("build", "__pycache__"))
    (folder / "build/release").mkdir(parents=True)
    for name in ("quadrille", "lib", "model", "golden", "tb"):
        if (build / name).exists():
            (folder / "build/release" / name).symlink_to(build / name)


def run_commands(readme, commands, folder, log):
    """Runs the commands in one shell; seconds of each. Ends this program when one fails."""
    marks = folder.parent / "marks"  # a line when a command begins: its number and the time
    script = folder.parent / "commands.sh"
    lines = ["set -o pipefail", f"__mark() {{ echo \"$1 $EPOCHREALTIME\" >>{marks}; }}"]
    for number, (command, _) in enumerate(commands):
        lines += [f"__mark {number}", command, '__status=$?; [ "$__status" -eq 0 ] || exit "$__status"']
    script.write_text("\n".join([*lines, "__mark end", ""]), encoding="utf-8")
    marks.touch()
    with log.open("wb") as out:
        shell = subprocess.Popen(["bash", str(script)], cwd=folder, stdin=subprocess.DEVNULL, stdout=out,
                                 stderr=subprocess.STDOUT, start_new_session=True)
        while shell.poll() is None:
            if time.time() - marks.stat().st_mtime > LIMIT:
                os.killpg(shell.pid, signal.SIGTERM)
                shell.wait()
            time.sleep(0.05)
    begun = [line.split() for line in marks.read_text(encoding="utf-8").splitlines()]
    if not begun or begun[-1][0] != "end":
        text = log.read_text(encoding="utf-8", errors="replace")
        command = commands[len(begun) - 1][0] if begun else "bash"
        fail(f"{readme}: `{command}` ended with status {shell.returncode} (limit {LIMIT} s); its last lines:\n"
             f"{text[-3000:]}")
    times = [float(at) for _, at in begun]
    return [end - start for start, end in zip(times, times[1:])]


def main():
    parser = argparse.ArgumentParser(prog="run_readme.py", description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", metavar="BUILD-FOLDER", type=pathlib.Path, help="folder of the program quadrille")
    parser.add_argument("readmes", metavar="README", nargs="*", type=pathlib.Path,
                        help="default: every README.md, and the three starts")
    parser.add_argument("--left-out", metavar="N", type=int, required=True,
                        help="expected number of commands not run")
    options = parser.parse_args()
    build = options.build.resolve()
    if not (build / "quadrille").exists():
        fail(f"{build}: no program quadrille; build it first")
    readmes = [path.resolve() for path in options.readmes] or sorted(
        path for path in ROOT.rglob("*.md") if path.name in PAGES and "build" not in path.relative_to(ROOT).parts)
    ran = reduced = 0
    left_out = []
    for readme in readmes:
        name = readme.relative_to(ROOT)
        commands, skipped = plan(readme)
        left_out += [(name, *one) for one in skipped]
        if not commands:
            continue
        with tempfile.TemporaryDirectory(prefix="readme.") as work:
            folder = pathlib.Path(work) / "quadrille"
            clone_into(folder, build)
            seconds = run_commands(name, commands, folder, pathlib.Path(work) / "log")
        for (command, stands_for), took in zip(commands, seconds):
            print(f"{took:7.1f} s  {name}: {command}" + (f"   (long: {stands_for})" if stands_for else ""), flush=True)
            if took > LONG and stands_for is None:
                print(f"           took more than {LONG} s: on an idle machine too? then mark it long", flush=True)
        print(f"{sum(seconds):7.1f} s  {name}: {len(commands)} commands", flush=True)
        ran += len(commands)
        reduced += sum(stands_for is not None for _, stands_for in commands)
    for name, command, reason in left_out:
        print(f"not run: {name}: {command}   ({reason})")
    print(f"{ran} commands run, {reduced} of them reduced; {len(left_out)} not run")
    if not ran:
        fail("no command was run")
    if len(left_out) != options.left_out:
        fail(f"{len(left_out)} commands not run; expected {options.left_out} (CMakeLists.txt)")


if __name__ == "__main__":
    main()
