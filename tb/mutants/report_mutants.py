#!/usr/bin/env python3
"""Puts generated mutants through the checks and says which check saw which: a table, and the survivors.

    tb/mutants/report_mutants.py BUILD_DIR [--count N] [--seed S] [--side S] [--file F] [--class C] [--name N] [--jobs J] [--json FILE] [--quiet]
    tb/mutants/report_mutants.py BUILD_DIR --shard I/N --json PART …      every N-th mutant, for several machines
    tb/mutants/report_mutants.py --from FILE … [--json FILE]              the same of what --json kept, shards put together

BUILD_DIR is tb/mutants of a build. --count: so many, drawn by the seed; half of them in the RTL, a quarter in the model. A mutant must be seen by
the check that caught_by.json names, which goes first; one that is argued equivalent by none. --record: each goes through the checks in their order
instead, and caught_by.json and the tables say what saw it from then on.
With --json each result is kept in FILE.part as it comes: the same command goes on there after it was stopped, and FILE is written whole at the
end.
Exit status: 0 every mutant is seen as recorded or argued equivalent; 1 one is not, or a shard is missing; 2 usage; 3 the checks did not run."""
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

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]
sys.dont_write_bytecode = True
sys.path.insert(0, str(ROOT / "scripts"))
from report.files import InputError, write_files  # noqa: E402
from report.units import shard  # noqa: E402
from faults import Edit, pick, read_record, write_record  # noqa: E402
SIDES = {"rtl": "RTL", "model": "model", "common": "both alike"}
CLASSES = ("operator", "constant", "width", "sign", "index", "enable", "reset", "priority", "comparison")
# Of lockstep, how a mutant of the RTL showed: `differs` is a bit or a clock.
CHECKS = ("lockstep", "truth", "lanes", "functions", "kept", "float", "limits", "tests")


def run(build, arguments, only):
    """The results, one after the other, of those named in a file."""
    command = [str(build / "mutate"), "--jobs", str(arguments.jobs), "--only", str(only), *(["--afresh"] if arguments.record else [])]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
        try:
            for line in process.stdout:
                yield json.loads(line)
        except BaseException:
            process.terminate()
            raise
    if process.returncode != 0:
        sys.exit(process.returncode if process.returncode in (2, 3) else 3)


def draw(arguments, mutants):
    """What the options choose."""
    chosen = [m for m in mutants if m["generated"] and arguments.side in ("", m["side"]) and arguments.fault_class in ("", m["class"])
              and arguments.name in ("", m["name"]) and (not arguments.file or f"/{m['file']}".endswith(f"/{arguments.file}"))]
    if not arguments.count:
        return chosen
    n = arguments.count
    counts = {arguments.side: n} if arguments.side else {"rtl": n // 2, "model": n // 4, "common": n - n // 2 - n // 4}
    names = {m["name"] for side, count in counts.items() if count
             for m in pick([m for m in chosen if m["side"] == side], count, arguments.seed, lambda m: m["name"])}
    return [m for m in chosen if m["name"] in names]


def names_wanted(arguments, mutants):
    """Of the draw those in --only, of these the shard's (every N-th)."""
    names = [m["name"] for m in mutants]
    if arguments.only:
        only = set(pathlib.Path(arguments.only).read_text().split())
        names = [name for name in names if name in only]
    index, count = arguments.shard or (0, 1)
    return names[index::count]


class Journal:
    """Results in FILE.part as they come: a line that says what of, then one of each. What is there is gone on with."""

    def __init__(self, path, build, wanted):
        self.path = pathlib.Path(f"{path}.part")
        of = {"mutants": digest("\n".join(wanted).encode()), "build": digest(*((build / name).read_bytes() for name in ("mutate", "faults.json")))}
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
    """Of those wanted, each without its time, as it comes, kept and said; then those of earlier runs."""
    kept = journal.results if journal else {}
    if kept:
        print(f"{journal.path}: {len(kept)} of {len(wanted)} mutants are done", file=sys.stderr, flush=True)
    missing = [name for name in wanted if name not in kept]
    if missing or not wanted:  # of none `mutate` says that there is none
        with tempfile.NamedTemporaryFile("w", suffix=".names") as file:
            file.write("".join(name + "\n" for name in missing or [""]))
            file.flush()
            for result in run(build, arguments, file.name):
                seconds = result.pop("seconds")  # not kept: the same mutant leaves the same bytes
                if journal:
                    journal.write(result)
                if not arguments.quiet:
                    print(f"{seconds:6.1f} s  {result['name']}: {how_seen(result)}", file=sys.stderr, flush=True)
                yield result
    yield from kept.values()


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
    equivalent = sum("killed" not in m["result"] and bool(m["equivalent"]) for m in mutants)
    return [len(mutants), *(by_check[c] or "" for c in CHECKS), how["assertion"] or "", how["hang"] or "", (how["crash"] + how["error"]) or "",
            equivalent or "", (by_check[None] - equivalent) or ""]


HEAD = ["mutants", *CHECKS, "of these by an assertion", "hung", "crashed", "equivalent", "**survive**"]


def class_table(mutants):
    """A row for each side and class, and in words how many of both alike are one fault."""
    rows = []
    for side, name in SIDES.items():
        of_side = [m for m in mutants if m["side"] == side]
        rows += [[name, c, *counts(chosen)] for c in CLASSES if (chosen := [m for m in of_side if m["class"] == c])]
        rows += [[name, "all", *counts(of_side)]] if of_side else []
    text = table(["fault in", "class", *HEAD], [*rows, ["all", "", *counts(mutants)]])
    if common := [m for m in mutants if m["side"] == "common"]:
        twins = [m["result"]["twin"] for m in common if "twin" in m["result"]]
        text += f"\n\nBoth alike: {len(common)}, in {len(twins)} of them an expression of the RTL changed too; with both changes on lockstep sees nothing of {sum(twins)}."
    return text


def report(mutants, by_file):
    print(class_table(mutants))
    if by_file:
        rows = []
        for file, side in sorted({(m["file"], m["side"]) for m in mutants}):
            rows.append([file, SIDES[side], *counts([m for m in mutants if (m["file"], m["side"]) == (file, side)])])
        print("\n" + table(["file", "fault in", *HEAD], rows))
    for m in mutants:
        if "killed" not in m["result"] and not m["equivalent"]:
            print(f"\nSURVIVES {m['name']}")
            for edit in map(Edit.read, m["edits"] if m["side"] != "common" else m["edits"][:1]):
                print("{}:{}\n-   {}\n+   {}".format(edit.file, *edit.lines((ROOT / edit.file).read_text())))


def record(mutants):
    """Writes down what saw each."""
    kept = read_record()
    for m in mutants:
        result, entry = m["result"], {k: v for k, v in kept.get(m["name"], {}).items() if k in ("proofs", "replays")}
        if "killed" in result:
            entry = {"checks": [result["killed"]], "scenario": result["where"], "how": result["how"]} | entry
        kept[m["name"]] = entry | ({"twin": result["twin"]} if "twin" in result else {})
    write_record(kept)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", nargs="?", type=pathlib.Path)
    parser.add_argument("--side", default="", choices=("",) + tuple(SIDES))
    parser.add_argument("--file", default="")
    parser.add_argument("--class", dest="fault_class", default="", choices=("",) + CLASSES)
    parser.add_argument("--name", default="")
    parser.add_argument("--only", default="")
    parser.add_argument("--count", type=int, default=0)
    parser.add_argument("--seed", default=os.environ.get("QUADRILLE_TEST_SEED", "1"))
    parser.add_argument("--jobs", type=int, default=len(os.sched_getaffinity(0)))
    parser.add_argument("--json", type=pathlib.Path)
    parser.add_argument("--from", dest="kept", type=pathlib.Path, nargs="+")
    parser.add_argument("--shard", type=shard, metavar="I/N", help="every N-th mutant, from I; 0 <= I < N")
    parser.add_argument("--quiet", action="store_true")
    parser.add_argument("--record", action="store_true")
    arguments = parser.parse_args()
    if not arguments.build and not arguments.kept:
        parser.error("BUILD_DIR is missing")
    if arguments.shard and arguments.kept:
        parser.error("--shard does not go with --from")
    journal = None
    if arguments.kept:
        size, mutants = put_together(arguments.kept)
    else:
        chosen = draw(arguments, json.loads((arguments.build / "faults.json").read_text()))
        size = len(chosen)
        names = {m["name"]: {"number": number} | m for number, m in enumerate(chosen)}
        wanted = names_wanted(arguments, chosen)
        if arguments.json:
            journal = Journal(arguments.json, arguments.build, wanted)
        found = sorted(results(arguments.build, arguments, wanted, journal), key=lambda result: names[result["name"]]["number"])
        mutants = [names[result["name"]] | {"result": result} for result in found]
    if arguments.json:
        write_files(str(arguments.json.parent), {arguments.json.name: (json.dumps({"drawn": size, "mutants": mutants}, indent=1) + "\n").encode()})
    if journal:
        journal.close()
    missing = arguments.kept and len(mutants) < size
    if missing:
        print(f"{len(mutants)} of {size} mutants of the draw: not all of it was run, or a shard is missing")
    report(mutants, by_file=not arguments.quiet)
    wrong = [m for m in mutants if m["equivalent"] and "killed" in m["result"] or not m["equivalent"] and "killed" not in m["result"]]
    wrong += [] if arguments.record else [m for m in mutants if m not in wrong and [m["result"].get("killed", "")] != (m["checks"] or [""])]
    for m in wrong:
        print(f"{m['name']}: {'argued equivalent' if m['equivalent'] else 'recorded as seen by ' + ', '.join(m['checks'])}, now: {how_seen(m['result'])}")
    if arguments.record:
        record(mutants)
        subprocess.run([HERE / "record_mutants.py", "--table"], check=True)
    return 1 if wrong or missing or not mutants else 0


if __name__ == "__main__":
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(143))  # with the checks, not leaving them behind
    try:
        sys.exit(main())
    except InputError as error:
        print(f"report_mutants: {error}", file=sys.stderr)
        sys.exit(2)
