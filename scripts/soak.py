#!/usr/bin/env python3
"""Lockstep for hours: units of `quadrille cosim` on inputs, draw states, stalls and machines at random, every bit of every clock and every
fragment against the truth, added up in a folder that a later run goes on with.

Unit k follows from the seed and k alone. Six of ten draw a stress family, the others scenes, corner groups and meshes; half of them in a
draw state at random. A unit that finds a fault is kept with the command that repeats it, and the run goes on.

  scripts/soak.sh --hours 8                     into build/soak; the same again goes on
  scripts/soak.sh --hours 8 --shard 0/4 --out A every fourth unit; the other shards elsewhere
  scripts/soak.sh --merge A B C D --out WHOLE   byte for byte what one run of the same units gives, times aside
  scripts/soak.sh --status build/soak           what has been compared, and what 10^9 and 10^12 fragments would take; several folders: of all shards

Exit status: 0 if fragments were compared and no unit, of this run or an earlier one, found a fault; 1 otherwise; 2 bad input; 3 a missing tool."""
import argparse
import collections
import concurrent.futures
import itertools
import json
import os
import random
import shlex
import signal
import sys
import time

sys.dont_write_bytecode = True  # the folder may be a source tree or an installation
from report.files import InputError, write_files  # noqa: E402
from report.lockstep import CORNERS, FAMILIES, FAULTS, MESHES, SKIPPING, Totals, mesh_files, random_configuration, run, set_options  # noqa: E402
from report.program import PROGRAM, ROOT  # noqa: E402
from report.units import Shards, Units, merge, shard, text  # noqa: E402

KINDS = {"stress": 60, "scene": 25, "mesh": 10, "corner": 5}  # of 100 units
SIZES = [(64, 64), (160, 160), (320, 240), (512, 512)]
# --dense: what gives the most fragments a clock. Pixels of homogeneous quads take three clocks each, those of small quads wait for setup.
DENSE_KINDS = {"stress": 45, "scene": 45, "mesh": 10}
DENSE_FAMILIES = ("general", "perspective", "near_edge", "near_vertex", "reflex", "bowtie", "straight_corner", "collapsed_edge", "coplanar", "long_span", "shared_edge", "shared_vertex")
DENSE_SIZES = [(512, 512)]
LIMIT = 1_000_000  # fragments of a unit
STALLED_PART, SLOW_PART = 5, 50  # of them where ports wait, and where they wait nine clocks of ten: so that a unit takes seconds
SUMS = ("fragments", "passes", "cycles", "bits")  # report/lockstep.py, Totals


def make_plan(args):
    """What all units follow from. Machines are configurations drawn by the seed; each takes a simulator."""
    rng = random.Random(f"{args.seed} machines")
    machines = [[], SKIPPING] + [random_configuration(args.quadrille, rng, dropped_bits=False) for _ in range(args.machines)]
    listed = run([args.quadrille, "scenes", "--json"])
    meshes = mesh_files(args.meshes)
    return {"seed": args.seed, "machines": machines, "scenes": [scene["name"] for scene in json.loads(listed.stdout)], "meshes": [os.path.basename(mesh) for mesh in meshes],
            "set": args.set, "limit": args.limit, "dense": args.dense}


def source(rng, plan, folder):
    """The kind of an input, its name, and the options that draw it."""
    kinds = DENSE_KINDS if plan["dense"] else KINDS
    kind = rng.choices(list(kinds), list(kinds.values()))[0]
    if kind == "mesh" and not plan["meshes"]:
        kind = "scene"
    if kind == "stress":
        family = rng.choice(DENSE_FAMILIES if plan["dense"] else FAMILIES)
        return kind, family, ["--stress", family, "--count", "5000"]
    if kind == "corner":
        group = rng.choice(sorted(CORNERS))
        return kind, group, ["--corner", group]
    name = rng.choice(plan["scenes" if kind == "scene" else "meshes"])
    return kind, name, ["--scene", name] if kind == "scene" else ["--mesh", os.path.join(folder, name)]


def unit_options(plan, folder, number):
    rng = random.Random(f"{plan['seed']} {number}")
    kind, name, options = source(rng, plan, folder)
    width, height = rng.choice(DENSE_SIZES if plan["dense"] else SIZES)
    stall, gap = (0, 0) if plan["dense"] or rng.random() < 0.5 else (rng.choice([0, 0.1, 0.5, 0.9]), rng.choice([0, 0.1, 0.5, 0.9]))
    limit = max(1, plan["limit"] // (SLOW_PART if max(stall, gap) >= 0.9 else STALLED_PART if max(stall, gap) > 0 else 1))
    options += ["--size", f"{width}x{height}", "--seed", str(rng.randint(1, 10**9)), "--stall", str(stall), "--gap", str(gap), "--limit-fragments", str(limit)]
    if rng.random() < (0.1 if plan["dense"] else 0.5):
        options += ["--draw-state", f"random:{rng.randint(1, 10**9)}"]
    options += rng.choice(plan["machines"])
    return kind, name, options + set_options(plan["set"])


class Soak:
    def __init__(self, args, plan):
        self.args, self.plan = args, plan
        self.folder = args.meshes or MESHES

    def unit(self, number):
        kind, name, options = unit_options(self.plan, self.folder, number)
        command = [self.args.quadrille, "cosim", *options, "--no-alone", "--no-snapping-error", "--threads", "1", "--quiet", "--json", "-"]
        result = run(command)
        if not result.stdout:
            raise InputError(f"{result.stderr}{shlex.join(command)}: ended with status {result.returncode}")
        report = json.loads(result.stdout)
        totals = Totals()
        totals.add(report)
        faults = {key: totals.sum[key] for key in FAULTS if totals.sum[key]}
        if not report["model_alone"]["ok"]:
            faults["model_alone"] = 1
        printed = [os.path.basename(part) if part.startswith(self.folder) else part for part in options]
        unit = {"kind": kind, "input": name, "options": printed, "fragment_hash": report["fragment_hash"], "worst": totals.worst, "faults": faults}
        unit.update((key, totals.sum[key]) for key in SUMS)
        return unit

    def build_simulators(self):
        """Those of all machines, before any unit is timed."""
        def build(machine):
            command = [self.args.quadrille, "cosim", "--scene", "bowtie", "--size", "32x32", "--no-alone", "--quiet", *machine, *set_options(self.plan["set"])]
            result = run(command)
            if result.returncode not in (0, 1):  # faults are for the units to find
                raise InputError(f"{result.stderr}{shlex.join(command)}: ended with status {result.returncode}")

        with concurrent.futures.ThreadPoolExecutor(self.args.jobs) as pool:
            list(pool.map(build, self.plan["machines"]))

    def work(self, units):
        """Until the time is over, or all units asked for are done."""
        self.build_simulators()
        start, step = self.args.shard
        numbers = itertools.count(start, step) if self.args.units is None else range(start, self.args.units, step)
        until = None if self.args.hours is None else time.monotonic() + 3600 * self.args.hours
        told = {"units": 0, "passes": 0, "last": time.monotonic()}

        def tell(number, unit):
            told["units"] += 1
            told["passes"] += unit["passes"]
            if unit["faults"]:
                print(f"FAILED: unit {number}: {unit['faults']}: quadrille cosim {shlex.join(unit['options'])}", file=sys.stderr, flush=True)
            if time.monotonic() > told["last"] + 60:
                told["last"] = time.monotonic()
                left = "" if until is None else f", {max(0.0, until - time.monotonic()) / 3600:.2f} h left"
                print(f"{told['units']} units, {told['passes']} fragments{left}", flush=True)

        units.run(self.unit, numbers, self.args.jobs, until, tell)


def summary(seed, done):
    """Sums of all units done, without times: the same bytes for the same units."""
    zero = {"units": 0, **dict.fromkeys(SUMS, 0), "worst": 0.0}
    total, kinds, inputs = dict(zero), collections.defaultdict(lambda: dict(zero)), collections.defaultdict(lambda: dict(zero))
    faulty, worst = {}, {}
    for number, unit in done.items():
        if unit["worst"] > total["worst"]:
            worst = {"unit": number, "command": "quadrille cosim " + shlex.join(unit["options"])}
        for sums in (total, kinds[unit["kind"]], inputs[f"{unit['kind']} {unit['input']}"]):
            sums["units"] += 1
            for key in SUMS:
                sums[key] += unit[key]
            sums["worst"] = max(sums["worst"], unit["worst"])
        if unit["faults"]:
            faulty[str(number)] = {"faults": unit["faults"], "command": "quadrille cosim " + shlex.join(unit["options"])}
    return {"seed": seed, "total": total, "kinds": kinds, "inputs": inputs, "worst": worst, "faulty": faulty}


def report(units):
    """Prints the sums, and keeps them in the folder of a run. Whether something was compared and nothing was wrong."""
    done = {number: units.read(number) for number in units.done()}
    totals = summary(units.plan["seed"], done)
    if isinstance(units, Units):
        write_files(units.directory, {"totals.json": text(totals).encode()})
    total = totals["total"]
    stress = totals["kinds"].get("stress", {"passes": 0})["passes"] / max(1, total["passes"])
    print(f"{total['units']} units of seed {totals['seed']}: {total['passes']} fragments in lockstep ({100 * stress:.1f} % of stress families), of {total['fragments']} pixels,"
          f" each drawn in passes with other attributes; {total['cycles']} clocks, {total['bits']} bits compared")
    print(f"  worst weight {100 * total['worst']:.1f} % of the bound" + (f", unit {totals['worst']['unit']}: {totals['worst']['command']}" if totals["worst"] else ""))
    for name, sums in sorted(totals["inputs"].items()):
        print(f"  {name:30} {sums['units']:6} units {sums['passes']:12} fragments  worst {100 * sums['worst']:5.1f} %")
    seconds = units.seconds()
    timed = [number for number in done if number in seconds]
    if timed and total["passes"]:
        rate = sum(done[number]["passes"] for number in timed) / max(1e-9, sum(seconds[number] for number in timed))
        print(f"  {rate:.0f} fragments/s on a core: 10^9 fragments take {1e9 / rate / 3600:.1f} core hours, 10^12 {1e12 / rate / 3600 / 24:.0f} core days")
    for number, unit in totals["faulty"].items():
        print(f"FAILED: unit {number}: {unit['faults']}: {unit['command']}", file=sys.stderr)
    if not total["fragments"]:
        print("FAILED: nothing was compared", file=sys.stderr)
    return total["fragments"] > 0 and not totals["faulty"]


def options():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--hours", type=float, help="end after so many, each unit begun being finished")
    parser.add_argument("--units", type=int, metavar="N", help="end when the first N units are done")
    parser.add_argument("--out", metavar="DIR", help="folder of the run (default: build/soak)")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--shard", type=shard, default=(0, 1), metavar="I/N", help="units I, I + N, … alone, 0 <= I < N")
    parser.add_argument("--jobs", type=int, default=os.cpu_count(), help="units at a time (default: one a processor)")
    parser.add_argument("--machines", type=int, default=6, help="configurations at random, beside the default and one with every skip (default: 6)")
    parser.add_argument("--limit", type=int, default=LIMIT, help=f"fragments of a unit, at most, a fifth of them where ports wait, a fiftieth where they do nine clocks of ten (default: {LIMIT})")
    parser.add_argument("--dense", action="store_true", help="large ordinary quads, ports that never wait: the most fragments an hour")
    parser.add_argument("--meshes", metavar="DIR", help="folder with OBJ files (default: ../shared/meshes when it is there)")
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE", help="configuration, as for quadrille, after those at random")
    parser.add_argument("--status", nargs="+", metavar="DIR", help="only report on a run, or on its shards together")
    parser.add_argument("--merge", nargs="+", metavar="DIR", help="put shards together into --out")
    parser.add_argument("--quadrille", default=PROGRAM, help="the program")
    args = parser.parse_args()
    if not os.access(args.quadrille, os.X_OK) and args.status is None and args.merge is None:
        parser.error(f"--quadrille {args.quadrille}: no such program; scripts/soak.sh builds it")
    if args.status is None and args.merge is None and args.hours is None and args.units is None:
        parser.error("--hours or --units says how long; or --status DIR, or --merge DIR… --out DIR")
    if args.merge is not None and args.out is None:
        parser.error("--merge needs a new folder: --out DIR")
    for name, least in (("jobs", 1), ("limit", 1), ("machines", 0), ("units", 1)):
        if getattr(args, name) is not None and getattr(args, name) < least:
            parser.error(f"--{name} {getattr(args, name)}: at least {least} is expected")
    if args.hours is not None and not args.hours > 0:
        parser.error(f"--hours {args.hours}: more than 0 is expected")
    return args


def main():
    args = options()
    signal.signal(signal.SIGTERM, signal.default_int_handler)  # units under way are lost, the others kept
    try:
        if args.status is not None:
            units = Units(args.status[0]) if len(args.status) == 1 else Shards(args.status)
        elif args.merge is not None:
            units = merge(args.out, args.merge)
        else:
            plan = make_plan(args)
            units = Units(args.out or os.path.join(ROOT, "build/soak"), plan)
            Soak(args, plan).work(units)
        return 0 if report(units) else 1
    except InputError as error:
        print(f"soak: {error}", file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        print("stopped; the same command goes on", file=sys.stderr)
        return 130


if __name__ == "__main__":
    sys.exit(main())
