#!/usr/bin/env python3
"""Generated mutants through the checks: which check saw which, a table, and the survivors. A plan of scripts/run_long.py, whose options go too.

    tb/mutants/report_mutants.py BUILD_DIR [--side S] [--file F] [--class C] [--name N] [--sample N] [--seed S] [--json FILE] [--quiet]
    tb/mutants/report_mutants.py BUILD_DIR --shard I/N --json PART …      every N-th mutant, for several machines
    tb/mutants/report_mutants.py --from FILE … [--json FILE]              the same of what --json kept, shards put together

BUILD_DIR is tb/mutants of a build. A mutant that no check sees must be argued equivalent in equivalent.toml, by its file, its line and the line
as changed; one that is there must be seen by none, and its line must still exist. An entry with `open` instead says which check is missing.
With --json each result is kept in the folder FILE.part as it comes: the same command goes on there after it was stopped.
Exit status: 0 every mutant is seen or argued equivalent (in a --sample: or open); 1 one is not, or a shard is missing; 2 usage; 3 the checks did not run."""
import collections
import hashlib
import json
import os
import pathlib
import random
import sys
import tomllib

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]
sys.path.insert(0, str(ROOT / "scripts"))
import run_long  # noqa: E402
from report.children import NoReport, json_report  # noqa: E402
from report.files import InputError, MissingTool, write_text  # noqa: E402
from report.program import options  # noqa: E402
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


def judge(arguments, drawn, mutants, sample=0):
    """Keeps and prints what came of the mutants; whether none survives. `drawn`: how many there are to be; None: those."""
    if arguments.json:
        write_text(arguments.json, json.dumps({"drawn": drawn, "mutants": mutants}, indent=1) + "\n")
    entries, faults = equivalents()
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
            survivors += sample == 0
    report(mutants, by_file=not arguments.quiet)
    print("".join(fault + "\n" for fault in faults), end="")
    return not faults and not survivors and bool(mutants)


class Kind(run_long.Work):
    @staticmethod
    def options(parser, table):
        parser.add_argument("build", nargs="?", type=pathlib.Path, default=ROOT / "build/release/tb/mutants", help="(default: %(default)s)")
        parser.add_argument("--side", default="", choices=("",) + tuple(SIDES))
        parser.add_argument("--file", default="")
        parser.add_argument("--class", dest="fault_class", default="", choices=("",) + CLASSES)
        parser.add_argument("--name", default="")
        parser.add_argument("--only", type=pathlib.Path, help="those named in this file")
        parser.add_argument("--sample", type=int, default=0, help="so many, drawn by the seed")
        parser.add_argument("--json", type=pathlib.Path, help="keeps the results there; until they are whole in FILE.part")
        parser.add_argument("--quiet", action="store_true")
        parser.set_defaults(seed=int(os.environ.get("QUADRILLE_TEST_SEED", "1")), quadrille=sys.executable)

    def __init__(self, args, table):
        super().__init__(args, table)
        if args.json and not args.out:
            args.out = f"{args.json}.part"
        try:
            left_out = {name for file in args.build.glob("*.left_out") for name in file.read_text().split()}
            drawn = [m for m in json.loads((args.build / "generated.json").read_text()) if m["name"] not in left_out]
            only = args.only and set(args.only.read_text().split())
        except (OSError, ValueError) as error:
            sys.exit(f"report_mutants: {error}; BUILD_DIR is tb/mutants of a build (scripts/mutate.sh)")
        self.mutants = {m["name"]: {"number": number} | m for number, m in enumerate(drawn)}
        self.wanted = [m["name"] for m in drawn if args.side in ("", m["side"]) and args.fault_class in ("", m["class"]) and args.name in ("", m["name"])
                       and (not args.file or f"/{m['file']}".endswith(f"/{args.file}")) and (not only or m["name"] in only)]
        if args.sample:
            self.wanted = random.Random(args.seed).sample(self.wanted, min(args.sample, len(self.wanted)))

    def plan(self):
        if not self.wanted:
            raise InputError("no mutant is so")
        files = b"".join(hashlib.sha256((self.args.build / name).read_bytes()).digest() for name in ("mutate", "generated.json"))
        return {"build": hashlib.sha256(files).hexdigest(), "mutants": self.wanted}

    def begin(self, units):
        return len(self.wanted)

    def unit(self, number):
        try:
            result, _ = json_report([str(self.args.build / "mutate"), "--name", self.wanted[number]])
        except NoReport as fault:
            raise MissingTool(f"mutate --name {self.wanted[number]}: {fault}") from None
        return {key: value for key, value in result.items() if key != "seconds"}  # the same mutant leaves the same bytes

    def told(self, number, result):
        if not self.args.quiet:
            print(f"{result['name']}: {how_seen(result)}", file=sys.stderr, flush=True)

    def report(self, runs):
        found = {result["name"]: result for shards in runs for result in map(shards.read, shards.done())}
        return judge(self.args, len(self.mutants), [m | {"result": found[name]} for name, m in self.mutants.items() if name in found], self.args.sample)


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


def main():
    if "--from" not in sys.argv:
        return run_long.main("mutation", sys.argv[1:])
    parser = options(__doc__)
    parser.add_argument("--from", dest="kept", type=pathlib.Path, nargs="+", required=True)
    parser.add_argument("--json", type=pathlib.Path)
    parser.add_argument("--quiet", action="store_true")
    arguments = parser.parse_args()
    drawn, mutants = put_together(arguments.kept)
    if len(mutants) < drawn:
        print(f"{len(mutants)} of {drawn} mutants of the draw: not all of it was run, or a shard is missing")
    return 0 if judge(arguments, drawn, mutants) and len(mutants) == drawn else 1


if __name__ == "__main__":
    sys.exit(main())
