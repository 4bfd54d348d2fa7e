#!/usr/bin/env python3
"""Lockstep for hours: units of `quadrille cosim` on inputs, draw states, stalls and machines at random, every bit of every clock and every
fragment against the truth, added up in a folder that a later run goes on with.

Unit k follows from the seed and k alone. Six of ten draw a stress family, the others scenes, corner groups and meshes; half of them in a
draw state at random. A unit that finds a fault, or in which the program dies, is kept with the command that repeats it, and the run goes on.

  scripts/soak.sh --hours 8                     into build/soak; the same again goes on
  scripts/soak.sh --hours 8 --shard 0/4 --out A every fourth unit; the other shards elsewhere
  scripts/soak.sh --merge A B C D --out WHOLE   byte for byte what one run of the same units gives, times aside
  scripts/soak.sh --status build/soak           what has been compared, and what 10^9 and 10^12 fragments would take; writes nothing
  scripts/soak.sh --status A B C D              the same over several folders: shards, or runs of any seeds and machines

SIGTERM, SIGINT and SIGHUP end the units under way at once: they are lost, every one that was done is kept. So is a unit that something else
kills (SIGKILL: out of memory): it is not kept, the run goes on, and the next run does it again.

Exit status: 0 if fragments were compared and no unit, of this run or an earlier one, found a fault or was lost; 1 otherwise; 2 bad input;
3 a missing tool; 130 stopped."""
import argparse
import collections
import concurrent.futures
import itertools
import json
import os
import random
import shlex
import sys
import time

sys.dont_write_bytecode = True  # the folder may be a source tree or an installation
from report.files import InputError, write_files  # noqa: E402
from report.lockstep import (  # noqa: E402
    CHILDREN, CORNERS, FAMILIES, FAULTS, MESHES, SKIPPING, MissingTool, NoReport, Stopped, Totals, cosim_report, mesh_files, processors,
    random_configuration, run, set_options)
from report.program import PROGRAM, ROOT  # noqa: E402
from report.units import Lost, Shards, Units, merge, shard, text  # noqa: E402

KINDS = {"stress": 60, "scene": 25, "mesh": 10, "corner": 5}  # of 100 units
SIZES = [(64, 64), (160, 160), (320, 240), (512, 512)]
# --dense: what gives the most fragments a clock. Pixels of homogeneous quads take three clocks each, those of small quads wait for setup.
DENSE_KINDS = {"stress": 45, "scene": 45, "mesh": 10}
DENSE_FAMILIES = ("general", "perspective", "near_edge", "near_vertex", "reflex", "bowtie", "straight_corner", "collapsed_edge", "coplanar", "long_span", "shared_edge", "shared_vertex")
DENSE_SIZES = [(512, 512)]
LIMIT = 1_000_000  # fragments of a unit
STALLED_PART, SLOW_PART = 5, 50  # of them where ports wait, and where they wait nine clocks of ten: so that a unit takes seconds
SUMS = ("fragments", "passes", "cycles", "bits")  # report/lockstep.py, Totals
OLDER_PLANS = {"dense": False}  # what a plan without the key means
SILENT = 100  # units on end without a report, after which a run ends: the program does nothing else


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
        command = [self.args.quadrille, "cosim", *options, "--no-alone", "--no-shrink", "--no-snapping-error", "--threads", "1", "--quiet", "--json", "-"]
        printed = [os.path.basename(part) if part.startswith(self.folder) else part for part in options]
        unit = {"kind": kind, "input": name, "options": printed, "fragment_hash": "", "worst": 0.0, "faults": {}, **dict.fromkeys(SUMS, 0)}
        try:
            report, _ = cosim_report(command)
        except NoReport as fault:
            unit["faults"]["no_report"] = str(fault)
            return unit
        totals = Totals()
        totals.add(report)
        unit["faults"] = {key: totals.sum[key] for key in FAULTS if totals.sum[key]}
        if not report["model_alone"]["ok"]:
            unit["faults"]["model_alone"] = 1
        unit.update(fragment_hash=report["fragment_hash"], worst=totals.worst, **{key: totals.sum[key] for key in SUMS})
        return unit

    def build_simulators(self):
        """Those of all machines, before any unit is timed."""
        def build(machine):
            command = [self.args.quadrille, "cosim", "--scene", "bowtie", "--size", "32x32", "--no-alone", "--quiet", *machine, *set_options(self.plan["set"])]
            result = run(command)
            if result.returncode > 1:  # faults are for the units to find
                kind = MissingTool if result.returncode == 3 else InputError
                raise kind(f"{result.stderr}{shlex.join(command)}: ended with status {result.returncode}")

        with concurrent.futures.ThreadPoolExecutor(self.args.jobs) as pool:
            list(pool.map(build, self.plan["machines"]))

    def work(self, units):
        """Until the time is over, or all units asked for are done. Whether none was lost."""
        self.build_simulators()
        start, step = self.args.shard
        until = None if self.args.hours is None else time.monotonic() + 3600 * self.args.hours
        told = {"units": 0, "passes": 0, "last": time.monotonic(), "silent": 0}

        def numbers():
            for number in itertools.count(start, step) if self.args.units is None else range(start, self.args.units, step):
                if told["silent"] >= SILENT:
                    break
                yield number

        def tell(number, unit):
            silent = isinstance(unit, Lost) or "no_report" in unit["faults"]
            told["silent"] = told["silent"] + 1 if silent else 0
            if isinstance(unit, Lost):
                print(f"FAILED: unit {number}: {unit}; not kept, the next run does it again", file=sys.stderr, flush=True)
                return
            told["units"] += 1
            told["passes"] += unit["passes"]
            if unit["faults"]:
                print(f"FAILED: unit {number}: {unit['faults']}: quadrille cosim {shlex.join(unit['options'])}", file=sys.stderr, flush=True)
            if time.monotonic() > told["last"] + 60:
                told["last"] = time.monotonic()
                left = "" if until is None else f", {max(0.0, until - time.monotonic()) / 3600:.2f} h left"
                print(f"{told['units']} units, {told['passes']} fragments{left}", flush=True)

        whole = units.run(self.unit, numbers(), self.args.jobs, until, tell)
        if told["silent"] >= SILENT:
            print(f"FAILED: ended after {told['silent']} units on end without a report", file=sys.stderr)
        return whole


def command_of(unit):
    return "quadrille cosim " + shlex.join(unit["options"])


def summary(done):
    """Sums of units by label, without times: the same bytes for the same units."""
    zero = {"units": 0, **dict.fromkeys(SUMS, 0), "worst": 0.0}
    total, kinds, inputs = dict(zero), collections.defaultdict(lambda: dict(zero)), collections.defaultdict(lambda: dict(zero))
    faulty, worst = {}, {}
    for label, unit in done.items():
        if unit["worst"] > total["worst"]:
            worst = {"unit": label, "command": command_of(unit)}
        for sums in (total, kinds[unit["kind"]], inputs[f"{unit['kind']} {unit['input']}"]):
            sums["units"] += 1
            for key in SUMS:
                sums[key] += unit[key]
            sums["worst"] = max(sums["worst"], unit["worst"])
        if unit["faults"]:
            faulty[str(label)] = {"faults": unit["faults"], "command": command_of(unit)}
    return {"total": total, "kinds": kinds, "inputs": inputs, "worst": worst, "faulty": faulty}


def keep_totals(units):
    """The sums, in the folder of the run."""
    totals = {"seed": units.plan["seed"], **summary({number: units.read(number) for number in units.done()})}
    write_files(units.directory, {"totals.json": text(totals).encode()})


def runs_of(directories):
    """The folders of each plan together, by the plan's text."""
    plans = {}
    for directory in directories:
        plans.setdefault(text(Units(directory, defaults=OLDER_PLANS).plan), []).append(directory)
    return [Shards(of_one, OLDER_PLANS) for of_one in plans.values()]


def described(plan):
    words = [f"seed {plan['seed']}", f"{len(plan['machines'])} machines", f"at most {plan['limit']} fragments a unit"]
    return ", ".join(words + (["--dense"] if plan["dense"] else []) + plan["set"])


def amount(passes, seconds):
    """What more of the same would take."""
    rate = passes / max(1e-9, seconds)
    return f"{rate:9.0f} fragments/s on a core: 10^9 take {1e9 / rate / 3600:.1f} core hours, 10^12 {1e12 / rate / 3600 / 24:.0f} core days"


def report(runs):
    """Prints the sums of several runs. Whether something was compared and nothing was wrong."""
    done, timed, lines = {}, collections.defaultdict(lambda: [0, 0.0]), []
    for index, run_of in enumerate(runs):
        seconds = run_of.seconds()
        before = len(done)
        for number in run_of.done():
            unit = done[number if len(runs) == 1 else f"{run_of.directories[0]} {number}"] = run_of.read(number)
            if number in seconds:
                for kind in ("all", unit["kind"] + (" of --dense" if run_of.plan["dense"] else "")):
                    timed[kind][0] += unit["passes"]
                    timed[kind][1] += seconds[number]
        passes = sum(unit["passes"] for unit in list(done.values())[before:])
        lines.append(f"  {' '.join(run_of.directories)}: {described(run_of.plan)}: {len(done) - before} units, {passes} fragments")
    totals = summary(done)
    total = totals["total"]
    stress = totals["kinds"].get("stress", {"passes": 0})["passes"] / max(1, total["passes"])
    whose = f"of seed {runs[0].plan['seed']}" if len(runs) == 1 else f"of {len(runs)} runs"
    print(f"{total['units']} units {whose}: {total['passes']} fragments in lockstep ({100 * stress:.1f} % of stress families), of {total['fragments']} pixels,"
          f" each drawn in passes with other attributes; {total['cycles']} clocks, {total['bits']} bits compared; {len(totals['faulty'])} units with faults")
    if len(runs) > 1:
        print("\n".join(lines))
    print(f"  worst weight {100 * total['worst']:.1f} % of the bound" + (f", unit {totals['worst']['unit']}: {totals['worst']['command']}" if totals["worst"] else ""))
    for name, sums in sorted(totals["inputs"].items()):
        print(f"  {name:30} {sums['units']:6} units {sums['passes']:12} fragments  worst {100 * sums['worst']:5.1f} %")
    if timed["all"][0]:
        print(f"  {timed['all'][1] / 3600:.2f} core hours of units")
        for kind, (passes, took) in sorted(timed.items()):
            print(f"  {kind:20} {100 * passes / timed['all'][0]:5.1f} % " + (amount(passes, took) if passes else "no fragments"))
    for label, unit in totals["faulty"].items():
        print(f"FAILED: unit {label}: {unit['faults']}: {unit['command']}", file=sys.stderr)
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
    parser.add_argument("--jobs", type=int, default=processors(), help="units at a time (default: one a processor that may be used)")
    parser.add_argument("--machines", type=int, default=6, help="configurations at random, beside the default and one with every skip (default: 6)")
    parser.add_argument("--limit", type=int, default=LIMIT, help=f"fragments of a unit, at most, a fifth of them where ports wait, a fiftieth where they do nine clocks of ten (default: {LIMIT})")
    parser.add_argument("--dense", action="store_true", help="large ordinary quads, ports that never wait: the most fragments an hour")
    parser.add_argument("--meshes", metavar="DIR", help="folder with OBJ files (default: ../shared/meshes when it is there)")
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE", help="configuration, as for quadrille, after those at random")
    parser.add_argument("--status", nargs="+", metavar="DIR", help="only report on a run, on its shards, or on several runs together; writes nothing")
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
    CHILDREN.stop_at_signals()
    whole = True
    try:
        if args.status is not None:
            return 0 if report(runs_of(args.status)) else 1
        if args.merge is not None:
            units = merge(args.out, args.merge, OLDER_PLANS)
        else:
            plan = make_plan(args)
            units = Units(args.out or os.path.join(ROOT, "build/soak"), plan, OLDER_PLANS)
            whole = Soak(args, units.plan).work(units)
        keep_totals(units)
        return 0 if report(runs_of([units.directory])) and whole else 1
    except InputError as error:
        print(f"soak: {error}", file=sys.stderr)
        return 3 if isinstance(error, MissingTool) else 2
    except Stopped:
        print("stopped; what was done is kept, the same command goes on", file=sys.stderr)
        return 130


if __name__ == "__main__":
    sys.exit(main())
