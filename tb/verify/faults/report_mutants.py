#!/usr/bin/env python3
"""Generated mutants through the checks: which check saw which, a table, and the survivors. A plan of scripts/run_long.py, whose options go too.

    tb/verify/faults/report_mutants.py BUILD_DIR [--count N] [--seed S] [--side S] [--file F] [--class C] [--name N] [--json FILE] [--quiet]
    tb/verify/faults/report_mutants.py BUILD_DIR --shard I/N --json PART …      every N-th mutant, for several machines
    tb/verify/faults/report_mutants.py --from FILE … [--json FILE]              the same of what --json kept, shards put together

BUILD_DIR is tb/verify/faults of a build. --count: so many, drawn by the seed; half of them in the RTL, a quarter in the model. A mutant must be seen by
the check that caught_by.json names, which goes first; one that is argued equivalent by none. --record: each goes through the checks in their order
instead, and caught_by.json and the tables say what saw it from then on.
With --json each result is kept in the folder FILE.part as it comes: the same command goes on there after it was stopped.
Exit status: 0 every mutant is seen as recorded or argued equivalent; 1 one is not, or a shard is missing; 2 usage; 3 the checks did not run."""
import collections
import hashlib
import json
import os
import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[2]
sys.path[:0] = [str(ROOT / "scripts"), str(HERE)]
import run_long  # noqa: E402
from report.children import NoReport, json_report  # noqa: E402
from report.files import InputError, MissingTool, write_text  # noqa: E402
from report.program import options  # noqa: E402
from faults import Edit, pick, read_record, write_record  # noqa: E402
SIDES = {"rtl": "RTL", "model": "model", "common": "both alike"}
CLASSES = ("operator", "constant", "width", "sign", "index", "enable", "reset", "priority", "comparison")
# Of lockstep, how a mutant of the RTL showed: `differs` is a bit or a clock.
CHECKS = ("lockstep", "truth", "lanes", "functions", "kept", "float", "limits", "tests")


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
    """A table for each side with a row for each class, without empty columns, and in words how many of both alike are one fault."""
    tables = []
    for side, name in SIDES.items():
        if of_side := [m for m in mutants if m["side"] == side]:
            rows = [[c, *counts(chosen)] for c in CLASSES if (chosen := [m for m in of_side if m["class"] == c])] + [["all", *counts(of_side)]]
            used = [n for n, cell in enumerate(rows[-1]) if cell != ""]
            head, *rows = [[row[n] for n in used] for row in [[f"{name}: class", *HEAD], *rows]]
            tables.append(table(head, rows))
    text = "\n\n".join(tables)
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


def judge(arguments, drawn, mutants):
    """Keeps and prints what came of the mutants; whether each is seen as recorded. `drawn`: how many there are to be."""
    if arguments.json:
        write_text(arguments.json, json.dumps({"drawn": drawn, "mutants": mutants}, indent=1) + "\n")
    if len(mutants) < drawn:
        print(f"{len(mutants)} of {drawn} mutants of the draw: not all of it was run, or a shard is missing")
    report(mutants, by_file=not arguments.quiet)
    wrong = [m for m in mutants if bool(m["equivalent"]) == ("killed" in m["result"])]
    wrong += [] if arguments.record else [m for m in mutants if m not in wrong and [m["result"].get("killed", "")] != (m["checks"] or [""])]
    for m in wrong:
        print(f"{m['name']}: {'argued equivalent' if m['equivalent'] else 'recorded as seen by ' + ', '.join(m['checks'])}, now: {how_seen(m['result'])}")
    if arguments.record:
        record(mutants)
        print("scripts/measure.py --write writes the tables of the pages")
    return not wrong and bool(mutants)


class Kind(run_long.Work):
    @staticmethod
    def options(parser, table):
        parser.add_argument("build", nargs="?", type=pathlib.Path, default=ROOT / "build/release/tb/verify/faults", help="build of mutate (default: build/release/tb/verify/faults)")
        parser.add_argument("--side", default="", choices=("",) + tuple(SIDES), help="only mutants of this side")
        parser.add_argument("--file", default="", help="only mutants of this file")
        parser.add_argument("--class", dest="fault_class", default="", choices=("",) + CLASSES, help="only mutants of this class")
        parser.add_argument("--name", default="", help="only this mutant")
        parser.add_argument("--only", type=pathlib.Path, metavar="FILE", help="only mutants named in this file")
        parser.add_argument("--count", type=int, default=0, metavar="N", help="number of mutants, drawn by the seed (default: all)")
        parser.add_argument("--json", type=pathlib.Path, metavar="FILE", help="results; partial ones are in FILE.part")
        parser.add_argument("--quiet", action="store_true", help="print only survivors and faults")
        parser.add_argument("--record", action="store_true", help="run every check and record what each sees")
        parser.set_defaults(seed=int(os.environ.get("QUADRILLE_TEST_SEED", "1")), quadrille=sys.executable)

    def __init__(self, args, table):
        super().__init__(args, table)
        if args.json and not args.out:
            args.out = f"{args.json}.part"
        try:
            chosen = draw(args, json.loads((args.build / "faults.json").read_text()))
            only = args.only and set(args.only.read_text().split())
        except (OSError, ValueError) as error:
            sys.exit(f"report_mutants: {error}; BUILD_DIR is tb/verify/faults of a build (scripts/mutate.sh)")
        self.mutants = {m["name"]: {"number": number} | m for number, m in enumerate(chosen)}
        self.wanted = [name for name in self.mutants if not only or name in only]

    def plan(self):
        if not self.wanted:
            raise InputError("no mutant has these properties")
        files = b"".join(hashlib.sha256((self.args.build / name).read_bytes()).digest() for name in ("mutate", "faults.json"))
        return {"build": hashlib.sha256(files).hexdigest(), "mutants": self.wanted, "record": self.args.record}

    def begin(self, units):
        return len(self.wanted)

    def unit(self, number):
        name = self.wanted[number]
        try:
            result, _ = json_report([str(self.args.build / "mutate"), "--name", name, *(["--afresh"] if self.args.record else [])])
        except NoReport as fault:
            raise MissingTool(f"mutate --name {name}: {fault}") from None
        return {key: value for key, value in result.items() if key != "seconds"}  # the same mutant leaves the same bytes

    def told(self, number, result):
        if not self.args.quiet:
            print(f"{result['name']}: {how_seen(result)}", file=sys.stderr, flush=True)

    def report(self, runs):
        found = {result["name"]: result for shards in runs for result in map(shards.read, shards.done())}
        mutants = [m | {"result": found[name]} for name, m in self.mutants.items() if name in found]
        return judge(self.args, len(self.mutants), mutants)


def put_together(files):
    """The mutants of several kept files, in the order of the draw; an error ends the script."""
    found, drawn = {}, None
    for file in files:
        try:
            kept = json.loads(file.read_text())
            if drawn not in (None, kept["drawn"]):
                sys.exit(f"{file}: of a draw of {kept['drawn']} mutants, {files[0]} of {drawn}; expected shards of one draw")
            drawn = kept["drawn"]
            for m in kept["mutants"]:
                if found.setdefault(m["number"], m) != m:
                    sys.exit(f"{file}: {m['name']} has different results in two files")
        except (OSError, ValueError, KeyError, TypeError) as error:
            sys.exit(f"{file}: not a file of --json ({error})")
    return drawn, [found[number] for number in sorted(found)]


def main():
    if "--from" not in sys.argv:
        return run_long.main("mutation", sys.argv[1:])
    parser = options(__doc__)
    parser.add_argument("--from", dest="kept", type=pathlib.Path, nargs="+", required=True)
    parser.add_argument("--json", type=pathlib.Path)
    parser.add_argument("--quiet", action="store_true")
    parser.add_argument("--record", action="store_true")
    arguments = parser.parse_args()
    drawn, mutants = put_together(arguments.kept)
    return 0 if judge(arguments, drawn, mutants) and len(mutants) == drawn else 1


if __name__ == "__main__":
    sys.exit(main())
