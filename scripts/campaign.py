#!/usr/bin/env python3
"""Lockstep campaign: scenes, stress families and meshes under several stall and gap probabilities, corner groups, and draw states at random.

Runs `quadrille cosim` for each input and pattern, adds up the reports and fails when anything differed, when a fragment stream
changed with the stall pattern, or when fewer fragments were compared, in all or of some kind, than promised. Then every input
again in draw states, viewports, stalls and configurations that the seed draws; the options of a run that fails are printed.

  scripts/campaign.py                    the whole campaign (at least 2 million fragments; about 8 minutes)
  scripts/campaign.py --short            the form for continuous integration (at least 200,000 fragments)
  scripts/campaign.py --meshes DIR       OBJ files to add (default: ../shared/meshes when it is there)
  scripts/campaign.py --out DIR          keeps what was done; the same again goes on
  scripts/campaign.py --shard 0/4 --out A   every fourth unit; the other shards elsewhere
  scripts/campaign.py --merge A B C D --out WHOLE   the sums of all, byte for byte as of one run

A run in which the program dies is a failure of its unit, and the campaign goes on. SIGTERM, SIGINT and SIGHUP end the units under way at
once: they are lost, those that were done are kept in --out. So is a unit that something else kills (SIGKILL).

Exit status: 0 all agreed and as much was compared as is promised (of a shard: all agreed); 1 otherwise; 2 bad input; 3 a missing tool; 130 stopped."""
import argparse
import json
import os
import random
import shlex
import sys
import tempfile

sys.dont_write_bytecode = True  # the folder may be a source tree or an installation
from report.files import InputError  # noqa: E402
from report.lockstep import (  # noqa: E402
    CHILDREN, CORNERS, FAMILIES, MESHES, SKIPPING, MissingTool, NoReport, Stopped, Totals, cosim_report, fail, mesh_files, processors,
    random_configuration, run, set_options)
from report.program import PROGRAM  # noqa: E402
from report.units import Lost, Units, merge, shard  # noqa: E402

# Stall and gap; each takes every value.
PATTERNS = [(0, 0), (0.1, 0.5), (0.5, 0.1), (0.9, 0.9)]
CORNER_PATTERNS = [(0, 0), (0.95, 0)]
# Fragments of each kind that must have been compared.
KINDS = {"eye_crossing": 10_000, "near_edge": 10_000, "near_vertex": 10_000, "tiny": 10_000}
FRAGMENTS = (2_000_000, 200_000)
# Scenes of which much is hidden, and the tiles of them that must have been.
LAYERS = ["layers_large", "city_random", "city_front"]
HIDDEN_TILES = 1_000
# Fragments of corner groups whose depth is that of a limit. In draws at random they are rare: the short form promises none there.
CORNER_DEPTH_LIMITS = 100
# Fragments that must have been compared in draws of each kind, in the whole campaign and in its short form.
DRAWN_KINDS = {
    **dict.fromkeys(["scissor", "cull", "no_perspective", "no_depth", "znear", "zfar", "fewer_attributes", "no_tile_skip", "no_quad_skip", "no_walk_skip", "no_operand_skip",
                     "dropped_bits", "over_256_px"], (50_000, 4_000)), "at_depth_limit": (1_000, 0), "stall_0.95": (10_000, 2_000),
}
DRAWN_RUNS = (3, 2)  # of each input
DRAWN_CONFIGURATIONS = (5, 1)  # beside the one given and SKIPPING; each takes a simulator


SIZES = ("512x512", "160x160")
LIMITS = (60_000, 4_000)  # fragments of an input that is no scene: scenes are drawn to their end, so that missing pixels show
COUNTS = (2_000, 150), (200, 40)  # quads of a stress family, in the standard state and in states at random


def inputs(scenes, count, meshes):
    """Options that name an input, scenes first."""
    # A tiny quad covers one or two pixels, so there are more of them.
    stress = [["--stress", family, "--count", str(20 * count if family == "tiny" else count)] for family in FAMILIES]
    return [["--scene", scene] for scene in scenes] + stress + [["--mesh", mesh] for mesh in meshes]


def make_plan(args):
    """What all units follow from: what each of them draws."""
    form = 1 if args.short else 0
    command = [args.quadrille, "scenes", "--json"]
    listed = run(command)
    if listed.returncode != 0:
        fail(command, listed)
    scenes = json.loads(listed.stdout)
    if args.short:  # the first paper's figures have every shape that the others vary
        scenes = [scene for scene in scenes if scene["paper"].startswith("Hormann & Tarini")]
    scenes = [scene["name"] for scene in scenes]
    meshes = [os.path.basename(mesh) for mesh in mesh_files(args.meshes)]
    configurations = [[], SKIPPING]
    rng = random.Random(f"{args.seed}")
    for number in range(DRAWN_CONFIGURATIONS[form]):
        configurations.append(random_configuration(args.quadrille, rng, dropped_bits=number % 2 == 0))
    standard, drawn = (inputs(scenes, counts[form], meshes) for counts in COUNTS)
    drawn += [["--corner", group] for group in CORNERS]
    units = [["standard", source] for source in standard] + [["corner", group] for group in CORNERS] + [["hidden", scene] for scene in LAYERS]
    units += [["drawn", source, index, number] for index, source in enumerate(drawn) for number in range(DRAWN_RUNS[form])]
    return {"seed": args.seed, "form": form, "set": args.set, "meshes": meshes, "configurations": configurations, "units": units}


class Unit:
    """Runs of one input, added up: what a folder of units keeps of them."""

    def __init__(self, args, plan):
        self.args, self.plan = args, plan
        self.folder = args.meshes or MESHES
        self.threads = ["--threads", str(max(1, processors() // args.jobs))]
        self.totals, self.kinds, self.failures = Totals(), {}, []

    def result(self):
        return {"sum": self.totals.sum, "worst": self.totals.worst, "worst_value": self.totals.worst_value, "kinds": self.kinds, "failures": self.failures}

    def count(self, kind, fragments):
        self.kinds[kind] = self.kinds.get(kind, 0) + fragments

    def cosim(self, options, may_be_empty=False):
        """The report of a run, None if it had none. A failed one is recorded, but where only the truth differs and nothing is claimed about it
        (dropped bits of D and r^2), or where a run that compares nothing is no failure."""
        placed = [os.path.join(self.folder, part) if before == "--mesh" else part for before, part in zip(["", *options], options)]
        command = [self.args.quadrille, "cosim", *placed, "--no-alone", "--no-shrink", "--quiet", "--json", "-", *self.threads, *set_options(self.plan["set"])]
        printed = f"quadrille cosim {shlex.join([*options, *set_options(self.plan['set'])])}"
        try:
            report, result = cosim_report(command)
        except NoReport as fault:
            self.failures.append(f"{printed}: {fault}")
            return None
        lockstep = report["mismatches"] + report["cycle_mismatches"] == 0
        sound = lockstep and report["model_alone"]["ok"]
        no_claim = sound and not report["bound"]["applies"]
        empty = sound and report["fragments"] + report["reference_mismatches"] == 0
        if result.returncode != 0 and not no_claim and not (may_be_empty and empty):
            sys.stderr.write(result.stderr)
            self.failures.append(f"{printed}: status {result.returncode}")
        self.totals.add(report)
        return report

    def patterns(self, patterns, options, count):
        """The same under several patterns of stalls and gaps; `count` takes each report. The fragments must be the same. Whether the last was
        complete."""
        hashes, complete = set(), False
        for index, (stall, gap) in enumerate(patterns):
            report = self.cosim([*options, "--seed", str(self.plan["seed"]), "--stall", str(stall), "--gap", str(gap)] +
                                (["--no-snapping-error"] if index > 0 else []))
            complete = report is not None and report["complete"]
            if report is not None:
                count(report)
                hashes.add((report["fragments"], report["fragment_hash"]))
        if len(hashes) > 1:
            self.failures.append(f"{' '.join(options)}: the fragments depend on the stall pattern")
        return complete

    def standard(self, source):
        """An input in one draw state under every pattern."""
        form = self.plan["form"]

        def count(report):
            for kind in KINDS:
                self.count(kind, report["counts"][kind])

        limit = [] if source[0] == "--scene" else ["--limit-fragments", str(LIMITS[form])]
        complete = self.patterns(PATTERNS, [*source, "--size", SIZES[form], *limit], count)
        if source[0] == "--scene" and not complete:
            self.failures.append(f"{' '.join(source)}: not drawn to its end")
        self.count("complete", int(complete))

    def corner(self, group):
        needs = CORNERS[group]
        size = [] if "--size" in needs else ["--size", "40x40"]
        self.patterns(CORNER_PATTERNS, ["--corner", group, *size, *needs], lambda report: self.count("at_depth_limit", report["counts"]["at_depth_limit"]))

    def hidden(self, scene):
        self.patterns(CORNER_PATTERNS, ["--scene", scene, "--size", "96x96", "--skip", "all", *SKIPPING],
                      lambda report: self.count("tiles_hidden", report["counters"]["tiles_hidden"]))

    def drawn(self, source, index, number):
        """An input in a draw state, a viewport, stalls and a configuration at random."""
        plan = self.plan
        rng = random.Random(f"{plan['seed']} {index} {number}")
        width, height = rng.randint(32, 160), rng.randint(32, 160)
        if rng.random() < 0.25:
            width, height = rng.randint(32, 160), rng.randint(257, 600)
            if rng.random() < 0.25:
                width, height = height, width
        stall, gap = rng.choice([0, 0.1, 0.5, 0.9, 0.95]), rng.choice([0, 0.1, 0.5, 0.9])
        # What a chance hardly meets: bursts, waits nearly always, the same number of clocks again and again.
        waits = ["--waits", rng.choice(["bursts", "sparse", "locked", "mixed"])] if stall == 0.1 else \
            ["--stall", str(stall), "--gap", str(gap)]
        limit = (600 if stall >= 0.9 else 2_000) * (1 if plan["form"] else 4)
        report = self.cosim([*source, "--size", f"{width}x{height}", "--draw-state", f"random:{rng.randint(1, 10**9)}",
                             "--seed", str(plan["seed"] + number), *waits,
                             "--limit-fragments", str(limit), "--no-snapping-error", *rng.choice(plan["configurations"])], may_be_empty=True)
        if report is None:
            return
        state = report["draw_state"]
        words = state.split()
        skips = words[words.index("--skip") + 1].split(",") if "--skip" in words else ["tiles", "quads", "walk", "operands"]
        held = {"scissor": "--scissor" in state, "cull": "--cull" in state, "no_perspective": "--no-perspective" in state,
                "no_depth": "--no-depth" in state, "znear": "--znear" in state and "--no-depth" not in state,
                "zfar": "--zfar" in state and "--no-depth" not in state, "fewer_attributes": "--attributes" in state,
                "no_tile_skip": "tiles" not in skips, "no_quad_skip": "quads" not in skips, "no_walk_skip": "walk" not in skips,
                "no_operand_skip": "operands" not in skips, "dropped_bits": not report["bound"]["applies"],
                "over_256_px": max(width, height) > 256, "stall_0.95": stall == 0.95}
        for kind, holds in held.items():
            self.count(kind, report["fragments"] if holds else 0)
        self.count("at_depth_limit", report["counts"]["at_depth_limit"])


def do(args, plan, number):
    phase, *which = plan["units"][number]
    unit = Unit(args, plan)
    getattr(unit, phase)(*which)
    return unit.result()


class Sums:
    """Of the units of one phase."""

    def __init__(self, units, done, phase, kinds):
        self.totals, self.kinds, self.failures, self.units = Totals(), dict.fromkeys(kinds, 0), [], 0
        for number in done:
            if units.plan["units"][number][0] != phase:
                continue
            result = units.read(number)
            self.totals.add_sums(result["sum"], result["worst"], result.get("worst_value", 0))
            self.failures += result["failures"]
            self.units += 1
            for kind, fragments in result["kinds"].items():
                self.kinds[kind] = self.kinds.get(kind, 0) + fragments

    def promised(self, what, promised):
        return [f"only {self.kinds[kind]} {what} {kind}, {count} are promised" for kind, count in promised.items() if self.kinds[kind] < count]


def report(units):
    """Prints the sums of a whole campaign, or of a part; whether all agreed and, of a whole one, as much as is promised was compared."""
    plan, done = units.plan, units.done()
    form = plan["form"]
    whole = len(done) == len(plan["units"])
    standard, corner = Sums(units, done, "standard", KINDS), Sums(units, done, "corner", ["at_depth_limit"])
    hidden, drawn = Sums(units, done, "hidden", ["tiles_hidden"]), Sums(units, done, "drawn", DRAWN_KINDS)
    failures = []
    print(f"\n{standard.units} inputs ({len(plan['meshes'])} meshes), {standard.kinds.pop('complete', 0)} drawn to their end, (stall, gap) {PATTERNS}, seed {plan['seed']}")
    for sums, title, label in ((standard, "standard draw state", ""), (corner, f"{corner.units} corner groups, (stall, gap) {CORNER_PATTERNS}", ""),
                               (hidden, f"{hidden.units} scenes with hidden tiles, (stall, gap) {CORNER_PATTERNS}", ""),
                               (drawn, "draw states at random", "fragments with ")):
        if sums is drawn:
            print(f"\n{drawn.totals.sum['runs']} runs in draw states at random, seed {plan['seed']}; configurations beside the one given:")
            for options in plan["configurations"][1:]:
                print("  " + " ".join(options))
        sums.totals.print(title)
        print("  " + label + ", ".join(f"{kind} {count}" for kind, count in sums.kinds.items()))
        failures += sums.failures + sums.totals.failures(title)
    if whole:
        if standard.totals.sum["fragments"] < FRAGMENTS[form]:
            failures.append(f"only {standard.totals.sum['fragments']} fragments were compared, {FRAGMENTS[form]} are promised")
        failures += standard.promised("fragments of kind", KINDS)
        failures += corner.promised("fragments of corner groups", {"at_depth_limit": CORNER_DEPTH_LIMITS})
        failures += hidden.promised("of", {"tiles_hidden": HIDDEN_TILES})
        failures += drawn.promised("fragments in draws of kind", {kind: count[form] for kind, count in DRAWN_KINDS.items()})
    else:
        print(f"\n{len(done)} of {len(plan['units'])} units: a part; what is promised is of the whole")
        if not done:
            failures.append("no unit was done")
    for failure in failures:
        print("FAILED: " + failure, file=sys.stderr)
    return not failures


def options():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--quadrille", default=PROGRAM, help="the program")
    parser.add_argument("--short", action="store_true")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--meshes", metavar="DIR", help="folder with OBJ files (default: ../shared/meshes when it is there)")
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE", help="configuration, as for quadrille")
    parser.add_argument("--out", metavar="DIR", help="folder of what was done (default: none is kept)")
    parser.add_argument("--shard", type=shard, metavar="I/N", help="units I, I + N, … alone, 0 <= I < N; needs --out")
    parser.add_argument("--jobs", type=int, default=1, help="units at a time (default: 1; each has threads of its own)")
    parser.add_argument("--merge", nargs="+", metavar="DIR", help="put shards together into --out")
    args = parser.parse_args()
    if (args.shard or args.merge) and not args.out:
        parser.error("--shard and --merge need a folder: --out DIR")
    if args.jobs < 1:
        parser.error(f"--jobs {args.jobs}: at least 1 is expected")
    return args


def work(args, folder):
    """Units of a folder, which a later run goes on with."""
    plan = make_plan(args)
    units = Units(folder, plan)

    def tell(number, result):
        if isinstance(result, Lost):
            print(f"FAILED: unit {number}: {result}; not kept, the next run does it again", file=sys.stderr, flush=True)
            return
        phase, which, *_ = plan["units"][number]
        print(f"{phase:8} {which if isinstance(which, str) else ' '.join(which):60s} {result['sum']['fragments']:8d} fragments in {result['sum']['runs']} runs", flush=True)

    start, step = args.shard or (0, 1)
    whole = units.run(lambda number: do(args, plan, number), range(start, len(plan["units"]), step), args.jobs, told=tell)
    return report(units) and whole


def main():
    args = options()
    CHILDREN.stop_at_signals()
    try:
        if args.merge:
            return 0 if report(merge(args.out, args.merge)) else 1
        if args.out:
            return 0 if work(args, args.out) else 1
        with tempfile.TemporaryDirectory() as folder:
            return 0 if work(args, os.path.join(folder, "campaign")) else 1
    except InputError as error:
        print(f"campaign: {error}", file=sys.stderr)
        return 3 if isinstance(error, MissingTool) else 2
    except Stopped:
        print("stopped" + ("; what was done is kept, the same command goes on" if args.out else ""), file=sys.stderr)
        return 130


if __name__ == "__main__":
    sys.exit(main())
