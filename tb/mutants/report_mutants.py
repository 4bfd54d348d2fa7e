#!/usr/bin/env python3
"""Puts generated mutants through the checks and says which check saw which: a table, and the survivors.

    tb/mutants/report_mutants.py BUILD_DIR [--side S] [--file F] [--class C] [--name N] [--sample N] [--seed S] [--jobs J] [--json FILE] [--quiet]
    tb/mutants/report_mutants.py BUILD_DIR --shard I/N --json PART …      every N-th mutant, for several machines
    tb/mutants/report_mutants.py --from FILE … [--json FILE]              the same of what --json kept, shards put together

BUILD_DIR is tb/mutants of a build. A mutant that no check sees must be argued equivalent in equivalent.toml, by its file, its line and the line
as changed; one that is there must be seen by none, and its line must still exist. An entry with `open` instead says which check is missing.
With --json each result is kept in FILE.part as it comes: the same command goes on there after it was stopped, and FILE is written whole at the
end (not of a --sample, of which only `mutate` knows the draw).
Exit status: 0 every mutant is seen or argued equivalent (in a --sample: or open); 1 one is not, or a shard is missing; 2 usage; 3 the checks did not run."""
import argparse
import collections
import fcntl
import hashlib
import json
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import tomllib

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]
sys.dont_write_bytecode = True
sys.path.insert(0, str(ROOT / "scripts"))
from report.files import InputError, write_files  # noqa: E402
from report.units import shard  # noqa: E402
SIDES = {"rtl": "RTL", "model": "model", "common": "both alike"}
CLASSES = ("operator", "constant", "width", "sign", "index", "enable", "reset", "priority", "comparison")
# Of lockstep, how a mutant of the RTL showed: `differs` is a bit or a clock.
CHECKS = ("lockstep", "truth", "lanes", "functions", "kept", "float", "limits", "tests")


def equivalents():
    """The list, and what is wrong with it."""
    entries = tomllib.loads((HERE / "equivalent.toml").read_text()).get("equivalent", [])
    faults = []
    for entry in entries:
        path = ROOT / entry["file"]
        source = path.read_text() if path.exists() else ""
        if entry["text"] not in source:
            faults.append(f"equivalent.toml: {entry['file']} has no more: {entry['text']}")
        if len(entry.get("why", entry.get("open", ""))) < 20:
            faults.append(f"equivalent.toml: {entry['file']}: no argument for: {entry['mutated']}")
    return entries, faults


def argument(entries, mutant):
    for entry in entries:
        if all(entry[key] == mutant[key] for key in ("file", "text", "mutated")) and mutant["side"] in entry.get("sides", SIDES):
            return entry
    return None


def run(build, arguments, only):
    """The results, one after the other; `only`: a file of names, or none."""
    command = [str(build / "mutate"), "--jobs", str(arguments.jobs), "--sample", str(arguments.sample), "--seed", str(arguments.seed)]
    for key in ("side", "file", "name"):
        if getattr(arguments, key):
            command += [f"--{key}", getattr(arguments, key)]
    if arguments.fault_class:
        command += ["--class", arguments.fault_class]
    if only:
        command += ["--only", str(only)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
        try:
            for line in process.stdout:
                yield json.loads(line)
        except BaseException:
            process.terminate()
            raise
    if process.returncode != 0:
        sys.exit(process.returncode if process.returncode in (2, 3) else 3)


def names_wanted(arguments, drawn):
    """Of a run without --sample: those in --only, of these the shard's (every N-th), of these what the options choose, as `mutate` does."""
    chosen = drawn
    if arguments.only:
        only = set(pathlib.Path(arguments.only).read_text().split())
        chosen = [m for m in chosen if m["name"] in only]
    index, count = arguments.shard or (0, 1)
    return [m["name"] for m in chosen[index::count]
            if arguments.side in ("", m["side"]) and arguments.fault_class in ("", m["class"]) and arguments.name in ("", m["name"])
            and (not arguments.file or f"/{m['file']}".endswith(f"/{arguments.file}"))]


class Journal:
    """Results in FILE.part as they come: a line that says what of, then one of each. What is there is gone on with."""

    def __init__(self, path, build, wanted):
        self.path = pathlib.Path(f"{path}.part")
        of = {"mutants": digest("\n".join(wanted).encode()), "build": digest(*((build / name).read_bytes() for name in ("mutate", "generated.json")))}
        self.file = open(self.path, "a+b")
        try:
            fcntl.flock(self.file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError:
            raise InputError(f"{self.path}: another process is writing there") from None
        self.file.seek(0)
        self.results, whole = {}, 0
        for number, line in enumerate(self.file):
            if not line.endswith(b"\n"):
                break  # cut off
            try:
                entry = json.loads(line)
                if number == 0 and entry != of:
                    what = next((key for key in of if entry[key] != of[key]), "mutants")
                    raise InputError(f"{self.path}: is of {'another build' if what == 'build' else 'other mutants'}; the command that began it goes on there, or remove it")
                if number > 0:
                    self.results[entry["name"]] = entry
            except (ValueError, KeyError, TypeError) as error:
                raise InputError(f"{self.path}: line {number + 1} is not what a run leaves ({error}); remove it") from None
            whole += len(line)
        self.file.truncate(whole)
        if whole == 0:
            self.write(of)

    def write(self, entry):
        self.file.write((json.dumps(entry) + "\n").encode())
        self.file.flush()

    def close(self):
        self.path.unlink()
        self.file.close()


def digest(*parts):
    return hashlib.sha256(b"".join(hashlib.sha256(part).digest() for part in parts)).hexdigest()


def results(build, arguments, wanted, journal):
    """Of those wanted, each without its time, as it comes; then those of earlier runs."""
    kept = journal.results if journal else {}
    if kept:
        print(f"{journal.path}: {len(kept)} of {len(wanted)} mutants are done", file=sys.stderr, flush=True)
    missing = [name for name in wanted if name not in kept]
    if missing or not wanted:  # of none `mutate` says that there is none
        with tempfile.NamedTemporaryFile("w", suffix=".names") as file:
            file.write("".join(name + "\n" for name in missing or [""]))
            file.flush()
            yield from told(run(build, arguments, file.name), arguments, journal)
    yield from kept.values()


def told(found, arguments, journal=None):
    """Each without its time, said once it is kept."""
    for result in found:
        seconds = result.pop("seconds")  # not kept: the same mutant leaves the same bytes
        if journal:
            journal.write(result)
        if not arguments.quiet:
            print(f"{seconds:6.1f} s  {result['name']}: {how_seen(result)}", file=sys.stderr, flush=True)
        yield result


def put_together(files):
    """The mutants of several kept files, in the order of the draw; an error ends the script."""
    found, drawn = {}, None
    for file in files:
        try:
            kept = json.loads(file.read_text())
            if drawn not in (None, kept["drawn"]):
                sys.exit(f"{file}: of a draw of {kept['drawn']} mutants, {files[0]} of {drawn}; shards of one draw are expected")
            drawn = kept["drawn"]
            for m in kept["mutants"]:
                if found.setdefault(m["number"], m) != m:
                    sys.exit(f"{file}: {m['name']} has another result than in another file, where the same was expected")
        except (OSError, ValueError, KeyError, TypeError) as error:
            sys.exit(f"{file}: is not what --json keeps ({error})")
    return drawn, [found[number] for number in sorted(found)]


def how_seen(result):
    if "killed" not in result:
        return "survives"
    return f"{result['killed']}, {result['where']}: {result['how']}"


def table(head, rows):
    lines = ["| " + " | ".join(head) + " |", "|---" * len(head) + "|"]
    return "\n".join(lines + ["| " + " | ".join(str(cell) for cell in row) + " |" for row in rows])


def counts(mutants):
    """Cells of a row: generated, by check, not by a difference, equivalent, surviving."""
    by_check = collections.Counter(m["result"].get("killed") for m in mutants)
    how = collections.Counter(m["result"].get("how") for m in mutants)
    equivalent = sum("why" in m for m in mutants)
    return [len(mutants), *(by_check[c] or "" for c in CHECKS), how["assertion"] or "", how["hang"] or "", (how["crash"] + how["error"]) or "",
            equivalent or "", (by_check[None] - equivalent) or ""]


HEAD = ["mutants", *CHECKS, "of these by an assertion", "hung", "crashed", "equivalent", "**survive**"]


def report(mutants, by_file):
    rows = []
    for side, name in SIDES.items():
        for fault_class in CLASSES:
            chosen = [m for m in mutants if (m["side"], m["class"]) == (side, fault_class)]
            if chosen:
                rows.append([name, fault_class, *counts(chosen)])
    rows.append(["all", "", *counts(mutants)])
    print(table(["fault in", "class", *HEAD], rows))
    if by_file:
        rows = []
        for file, side in sorted({(m["file"], m["side"]) for m in mutants}):
            rows.append([file, SIDES[side], *counts([m for m in mutants if (m["file"], m["side"]) == (file, side)])])
        print("\n" + table(["file", "fault in", *HEAD], rows))
    twins = [m for m in mutants if m["side"] == "common" and len(m["edit"]) == 2]
    blind = sum(m["result"].get("twin") is True for m in twins)
    common = sum(m["side"] == "common" for m in mutants)
    if common:
        print(f"\nBoth alike: {common}, in {len(twins)} of them an expression of the RTL changed too; with both changes on lockstep sees nothing of {blind}.")
    for m in mutants:
        if "killed" not in m["result"] and "why" not in m:
            print(f"\nSURVIVES {m['name']}")
            for edit in m["edit"] if m["side"] != "common" else m["edit"][:1]:
                print(f"{edit['file']}:{edit['line']}\n-   {edit['text']}\n+   {edit['mutated']}")
            if "open" in m:
                print(f"missing: {m['open']}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", nargs="?", type=pathlib.Path)
    parser.add_argument("--side", default="", choices=("",) + tuple(SIDES))
    parser.add_argument("--file", default="")
    parser.add_argument("--class", dest="fault_class", default="", choices=("",) + CLASSES)
    parser.add_argument("--name", default="")
    parser.add_argument("--only", default="")
    parser.add_argument("--sample", type=int, default=0)
    parser.add_argument("--seed", type=int, default=int(os.environ.get("QUADRILLE_TEST_SEED", "1")))
    parser.add_argument("--jobs", type=int, default=len(os.sched_getaffinity(0)))
    parser.add_argument("--json", type=pathlib.Path)
    parser.add_argument("--from", dest="kept", type=pathlib.Path, nargs="+")
    parser.add_argument("--shard", type=shard, metavar="I/N", help="every N-th mutant, from I; 0 <= I < N")
    parser.add_argument("--quiet", action="store_true")
    arguments = parser.parse_args()
    if not arguments.build and not arguments.kept:
        parser.error("BUILD_DIR is missing")
    if arguments.shard and (arguments.sample or arguments.kept):
        parser.error("--shard goes with neither --sample nor --from")
    entries, faults = equivalents()
    journal = None
    if arguments.kept:
        drawn, mutants = put_together(arguments.kept)
    else:
        left_out = {name for file in arguments.build.glob("*.left_out") for name in file.read_text().split()}
        generated = [m for m in json.loads((arguments.build / "generated.json").read_text()) if m["name"] not in left_out]
        drawn = len(generated)
        names = {m["name"]: {"number": number} | m for number, m in enumerate(generated)}
        if arguments.sample:
            found = list(told(run(arguments.build, arguments, arguments.only), arguments))
        else:
            wanted = names_wanted(arguments, generated)
            if arguments.json:
                journal = Journal(arguments.json, arguments.build, wanted)
            found = sorted(results(arguments.build, arguments, wanted, journal), key=lambda result: names[result["name"]]["number"])
        mutants = [names[result["name"]] | {"result": result} for result in found]
    if arguments.json:
        write_files(str(arguments.json.parent), {arguments.json.name: (json.dumps({"drawn": drawn, "mutants": mutants}, indent=1) + "\n").encode()})
    if journal:
        journal.close()
    if arguments.kept and len(mutants) < drawn:
        print(f"{len(mutants)} of {drawn} mutants of the draw: not all of it was run, or a shard is missing")
    survivors = 0
    for m in mutants:
        entry = argument(entries, m)
        if entry is None:
            survivors += "killed" not in m["result"]
        elif "killed" in m["result"]:
            faults.append(f"equivalent.toml: seen by {how_seen(m['result'])}: {m['file']}: {m['mutated']}")
        elif "why" in entry:
            m["why"] = entry["why"]
        else:
            m["open"] = entry["open"]
            survivors += arguments.sample == 0
    report(mutants, by_file=not arguments.quiet)
    for fault in faults:
        print(fault)
    missing = arguments.kept and len(mutants) < drawn
    return 1 if faults or survivors or missing or not mutants else 0


if __name__ == "__main__":
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(143))  # with the checks, not leaving them behind
    try:
        sys.exit(main())
    except InputError as error:
        print(f"report_mutants: {error}", file=sys.stderr)
        sys.exit(2)
