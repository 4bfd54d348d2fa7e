"""Plans of lockstep: which runs of `quadrille cosim` a unit makes, and sums of what they compared and found."""
import collections
import concurrent.futures
import glob
import os
import random
import shlex
import sys

from report.children import NoReport, checked, json_report, processors, run
from report.files import InputError
from report.program import ROOT
from run_long import Work

# Tiles are hidden where a draw asks for it: every second one with a depth test. (Plane quads are looked for and never found: weights as
# attributes are not plane. tb/lockstep/cosim_test.cpp draws some.)
SKIPPING = ["hierarchical_z_bits=12", "hierarchical_z_tiles_log2=8", "plane_quads=1", "performance_counters=1"]
MESHES = os.path.join(ROOT, "../shared/meshes")  # which need not be there
OPTIONS = {"scene": "--scene", "stress": "--stress", "mesh": "--mesh", "corner": "--corner"}
FAULTS = {"mismatches": "mismatches", "cycle_mismatches": "cycle mismatches", "reference": "coverage differences", "beyond": "values beyond their bound"}


def set_options(settings):
    """Options of a program for KEY=VALUE…"""
    return [part for setting in settings for part in ("--set", setting)]


def merged(table, over):
    """A table with the values of another in it, by key."""
    return table | {key: merged(table[key], value) if isinstance(value, dict) and key in table else value for key, value in over.items()}


def random_configuration(program, rng, dropped_bits):
    """Settings of a configuration at random that can be built."""
    ranges = {"significand_bits": range(12, 27), "notch_exact": (1, 1, 0), "align_guard_bits": range(5), "subpixel_bits": range(4, 9),
              "attribute_slots": range(1, 9), "depth_bits": range(12, 31), "tile_log2": range(2, 5), "quad_slots_log2": range(1, 5),
              "tile_slots_log2": range(1, 5), "stamp_fifo_log2": range(1, 6), "pixels_per_clock": (1, 2, 4), "dot_units": (2, 4),
              "performance_counters": (0, 1), "hierarchical_z_bits": (0, 4, 9, 12), "hierarchical_z_tiles_log2": range(6, 10), "plane_quads": (0, 1)}
    if dropped_bits:
        ranges["quadratic_frac_bits"] = range(13)
    while True:
        settings = [f"{key}={rng.choice(values)}" for key, values in ranges.items()]
        if run([program, "config", "--quiet", *set_options(settings)]).returncode == 0:
            return settings


def random_unit(plan, phase, kind, name, rng):
    """Options of a run in a draw state, a viewport, stalls and a configuration at random."""
    width, height = (rng.randint(*map(int, (side.split(":") * 2)[:2])) for side in rng.choice(phase["sizes"]).split("x"))
    waits, limit = ["--stall", "0", "--gap", "0"], phase["limit"]
    if rng.random() < phase["waiting"]:
        stall, gap = rng.choice([0, 0.1, 0.5, 0.9, 0.95]), rng.choice([0, 0.1, 0.5, 0.9])
        bursts = rng.choice(["bursts", "sparse", "locked", "mixed"])  # what a chance hardly meets: waits nearly always, the same clocks again and again
        waits, gap = (["--waits", bursts], 0.1) if stall == 0.1 else (["--stall", str(stall), "--gap", str(gap)], gap)
        limit //= [1, *phase["limit_parts"]][(max(stall, gap) > 0) + (max(stall, gap) >= 0.9)]
    options = [*named(phase, kind, name), "--size", f"{width}x{height}", "--seed", str(rng.randint(1, 10**9)), *waits, "--limit-fragments", str(max(1, limit))]
    if rng.random() < phase["draw_state"]:
        options += ["--draw-state", f"random:{rng.randint(1, 10**9)}"]
    return options + set_options(rng.choice(plan["configurations"]))


def named(phase, kind, name):
    """Options that draw an input. A tiny quad covers one or two pixels, so there are more of them."""
    return [OPTIONS[kind], name] + (["--count", str(phase["count"] * (20 if name == "tiny" else 1))] if kind == "stress" else [])


def names_of(plan, phase, kind):
    return phase.get({"stress": "families", "scene": "scenes"}.get(kind), plan[kind])


def units_of(plan):
    """(phase, kind of input, input) of each unit; None: without end, drawn by weight."""
    if plan.get("endless"):
        return None
    return [(name, kind, source) for name in plan["order"] for phase in [plan["phase"][name]] for kind in phase["inputs"]
            for source in names_of(plan, phase, kind) for _ in range(phase.get("runs", 1))]


def unit_of(plan, number):
    """(phase, kind, input, options of each of its runs)."""
    rng = random.Random(f"{plan['seed']} {number}")
    if plan.get("endless"):
        (where, phase), = plan["phase"].items()
        weights = phase["weights"] if plan["mesh"] else phase["weights"] | {"mesh": 0}
        kind = rng.choices(list(weights), list(weights.values()))[0]
        name = rng.choice(names_of(plan, phase, kind))
    else:
        where, kind, name = units_of(plan)[number]
        phase = plan["phase"][where]
    if "patterns" not in phase:
        return where, kind, name, [random_unit(plan, phase, kind, name, rng)]
    needs = shlex.split(phase.get("needs", {}).get(name, ""))
    options = named(phase, kind, name) + ([] if "--size" in needs else ["--size", phase["size"]]) + needs + ["--seed", str(plan["seed"])]
    options += ["--skip", "all", *set_options(SKIPPING)] if phase.get("skips") else []
    options += ["--limit-fragments", str(phase["limit"])] if "limit" in phase and kind != "scene" else []
    return where, kind, name, [[*options, "--stall", str(stall), "--gap", str(gap)] for stall, gap in phase["patterns"]]


def promised(phase):
    """What must have been compared of each kind, when all units are done."""
    return dict.fromkeys(phase.get("kinds", []), phase.get("promised_of_each")) | phase.get("promised", {})


def amounts(report, options):
    """Fragments, tiles and draws of each kind that a phase may promise."""
    state, fragments = report["draw_state"], report["fragments"]
    words = state.split()
    skips = words[words.index("--skip") + 1].split(",") if "--skip" in words else ["tiles", "quads", "walk", "operands"]
    held = {"scissor": "--scissor" in state, "cull": "--cull" in state, "no_perspective": "--no-perspective" in state, "no_depth": "--no-depth" in state,
            "znear": "--znear" in state and "--no-depth" not in state, "zfar": "--zfar" in state and "--no-depth" not in state,
            "fewer_attributes": "--attributes" in state, "dropped_bits": not report["bound"]["applies"],
            "over_256_px": max(map(int, options[options.index("--size") + 1].split("x"))) > 256, "stall_0.95": "0.95" in options,
            **{f"no_{skip}_skip": f"{skip}s" not in skips and skip not in skips for skip in ("tile", "quad", "walk", "operand")}}
    return report["counts"] | report.get("counters", {}) | {"fragments": fragments} | {kind: fragments * holds for kind, holds in held.items()}


class Kind(Work):
    def __init__(self, args, table):
        super().__init__(args, table)
        self.folder = args.meshes or MESHES

    @staticmethod
    def options(parser, table):
        parser.add_argument("--meshes", metavar="DIR", help="folder of OBJ files (default: ../shared/meshes, if present)")
        parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE", help="configuration key, after the random ones; repeatable")
        parser.add_argument("--machines", type=int, metavar="N", help="random configurations, besides two fixed ones")
        parser.add_argument("--limit", type=int, metavar="N", help="most fragments of a random unit; fewer with stalls or gaps")
        for form in table.get("form", {}):
            parser.add_argument(f"--{form}", action="store_true", help=f"use [form.{form}] of the plan")

    def plan(self):
        args = self.args
        plan = {key: value for key, value in self.table.items() if key not in ("form", "out", "jobs", "about")}
        forms = [form for form in self.table.get("form", {}) if getattr(args, form)]
        for form in forms:
            plan = merged(plan, self.table["form"][form])
        if args.limit is not None:
            plan = merged(plan, {"phase": {"drawn": {"limit": args.limit}}})
        listed = {}
        for kind, option in (("scene", []), ("stress", ["--stress"]), ("corner", ["--corner"])):
            listed[kind], _ = json_report([args.quadrille, "scenes", *option, "--json"])
        meshes = sorted(glob.glob(os.path.join(self.folder, "*.obj")))
        if args.meshes and not meshes:
            raise InputError(f"--meshes {args.meshes}: no OBJ files")
        rng, machines = random.Random(f"{args.seed} machines"), plan["machines"] if args.machines is None else args.machines
        drawn = [random_configuration(args.quadrille, rng, plan.get("dropped_bits", False) and number % 2 == 0) for number in range(machines)]
        return plan | {"seed": args.seed, "forms": forms, "order": list(plan["phase"]), "set": args.set, "configurations": [[], SKIPPING, *drawn], "machines": machines,
                       "scene": [scene["name"] for scene in listed["scene"] if scene["paper"].startswith(plan.get("papers", ""))],
                       "stress": [entry["name"] for entry in listed["stress"] if entry["kind"] == "family"],
                       "corner": [entry["name"] for entry in listed["corner"]], "mesh": [os.path.basename(mesh) for mesh in meshes]}

    def begin(self, units):
        """Builds the simulators of all machines."""
        self.drawn = units.plan

        def build(machine):
            checked([self.args.quadrille, "cosim", "--scene", "bowtie", "--size", "32x32", "--no-alone", "--quiet", *set_options([*machine, *self.drawn["set"]])])

        with concurrent.futures.ThreadPoolExecutor(self.args.jobs) as pool:
            list(pool.map(build, self.drawn["configurations"]))
        listed = units_of(self.drawn)
        return None if listed is None else len(listed)

    def unit(self, number):
        where, kind, name, runs = unit_of(self.drawn, number)
        phase = self.drawn["phase"][where]
        unit = {"phase": where, "kind": kind, "input": name, "sum": collections.Counter(dict.fromkeys(FAULTS, 0)), "kinds": collections.Counter(), "failures": [],
                "worst": 0.0, "worst_value": 0.0, "command": ""}
        hashes = set()
        for index, options in enumerate(runs):
            options = options + set_options(self.drawn["set"])
            placed = [os.path.join(self.folder, part) if before == "--mesh" else part for before, part in zip(["", *options], options)]
            command = [self.args.quadrille, "cosim", *placed, "--no-alone", "--no-shrink", "--quiet", "--json", "-", "--threads", str(max(1, processors() // self.args.jobs))]
            printed = f"quadrille cosim {shlex.join(options)}"
            try:
                report, result = json_report(command + (["--no-snapping-error"] if index > 0 or len(runs) == 1 else []))
            except NoReport as fault:
                unit["failures"].append(f"{printed}: {fault}")
                continue
            exact = report["bound"]["applies"]  # with dropped bits of D and r^2 nothing is claimed about the truth
            sums = {"runs": 1, "fragments": report["fragments"], "passes": report["fragments_all_passes"], "cycles": report["cycles_all_passes"],
                    "bits": report["compared_bits"], "mismatches": report["mismatches"], "cycle_mismatches": report["cycle_mismatches"],
                    "reference": report["reference_mismatches"] * exact, "beyond": exact * sum(n for key, n in report.items() if key.startswith("beyond_"))}
            unit["sum"].update(sums)
            sound = report["mismatches"] + report["cycle_mismatches"] == 0 and report["model_alone"]["ok"]
            empty = report["fragments"] + report["reference_mismatches"] == 0
            faults = {key: sums[key] for key in FAULTS if sums[key]}
            if faults or result.returncode != 0 and not (sound and (not exact or empty and "patterns" not in phase)):
                sys.stderr.write(result.stderr)
                unit["failures"].append(f"{printed}: status {result.returncode}" + "".join(f", {n} {FAULTS[key]}" for key, n in faults.items()))
            hashes.add((report["fragments"], report["fragment_hash"]))
            if exact and (worst := report.get("worst", {}).get("error_over_bound", 0)) > unit["worst"]:
                unit["worst"], unit["command"] = worst, printed
            if exact:
                unit["worst_value"] = max(unit["worst_value"], report["bound"]["attribute_over_bound"], report["bound"]["depth_over_bound"])
            found = amounts(report, options)
            unit["kinds"].update({key: found.get(key, 0) for key in promised(phase)})
            if kind == "scene" and "patterns" in phase and not report["complete"]:
                unit["failures"].append(f"{printed}: not drawn to its end")
        if len(hashes) > 1:
            unit["failures"].append(f"{printed}: the fragments depend on the stall pattern")
        return unit

    def told(self, number, result):
        for failure in result["failures"]:
            print(f"FAILED: unit {number}: {failure}", file=sys.stderr, flush=True)
        print(f"{number:6} {result['phase']:8} {result['kind']:6} {result['input']:24} {result['sum']['passes']:9} fragments", flush=True)
        return not result["sum"].get("runs", 0)

    def report(self, runs):
        total, phases, inputs = Sums(), collections.defaultdict(Sums), collections.defaultdict(Sums)
        timed, failures, lines, faulty = collections.defaultdict(lambda: [0, 0.0]), [], [], 0
        for shards in runs:
            plan, seconds, own, label = shards.plan, shards.seconds(), Sums(), "unit " + (shards.directories[0] + " " if len(runs) > 1 else "")
            for number in shards.done():
                unit = shards.read(number)
                for sums in (total, own, phases[unit["phase"]], inputs[f"{unit['kind']} {unit['input']}"]):
                    sums.add(unit, f"{label}{number}")
                failures += [f"{label}{number}: {failure}" for failure in unit["failures"]]
                faulty += bool(unit["failures"])
                for kind in ("all", " of --".join([unit["kind"], *plan["forms"]])) if number in seconds else ():
                    timed[kind][0] += unit["sum"].get("passes", 0)
                    timed[kind][1] += seconds[number]
            words = [f"seed {plan['seed']}", *(f"--{form}" for form in plan["forms"]), f"{plan['machines']} machines at random", *plan["set"]]
            lines.append(f"  {' '.join(shards.directories)}: {', '.join(words)}: {own.units} units, {own.sum['passes']} fragments")
            if (listed := units_of(plan)) is not None:
                if own.units < len(listed):
                    lines.append(f"  {own.units} of {len(listed)} units: a part; what is promised is of the whole")
                else:
                    failures += [f"only {phases[name].kinds[kind]} of {kind} in phase {name}, {least} are promised" for name, phase in plan["phase"].items()
                                 for kind, least in promised(phase).items() if phases[name].kinds[kind] < least]
        share = sum(sums.sum["passes"] for name, sums in inputs.items() if name.startswith("stress ")) / max(1, total.sum["passes"])
        print(f"{total.units} units of {len(runs)} runs: {total.sum['passes']} fragments in lockstep ({100 * share:.1f} % of stress families), of {total.sum['fragments']}"
              f" pixels, each drawn in passes with other attributes; {total.sum['cycles']} clocks, {total.sum['bits']} bits compared; {faulty} units with faults")
        print("\n".join(lines))
        print("  " + ", ".join(f"{total.sum[key]} {name}" for key, name in FAULTS.items()) + f"; worst weight {100 * total.worst[0]:.1f} % of its bound, {total.worst[1]}; "
              f"worst attribute or depth {100 * total.worst_value:.1f} %")
        for name, sums in phases.items():
            print(f"  phase {name}: {sums.units} units; " + ", ".join(f"{kind} {count}" for kind, count in sums.kinds.items()))
        for name, sums in sorted(inputs.items()):
            print(f"  {name:30} {sums.units:6} units {sums.sum['passes']:12} fragments  worst {100 * sums.worst[0]:5.1f} %")
        for kind, (passes, took) in sorted((kind, both) for kind, both in timed.items() if both[0]):
            rate = max(1e-9, passes / max(1e-9, took))  # what more of the same would take
            print(f"  {kind:20} {100 * passes / timed['all'][0]:5.1f} % {took / 3600:.2f} core hours, {rate:9.0f} fragments/s on a core: "
                  f"10^9 take {1e9 / rate / 3600:.1f} core hours, 10^12 {1e12 / rate / 3600 / 24:.0f} core days")
        failures += [] if total.sum["fragments"] else ["nothing was compared"]
        for failure in failures:
            print("FAILED: " + failure, file=sys.stderr)
        return not failures


class Sums:
    """Of units."""

    def __init__(self):
        self.units, self.sum, self.kinds, self.worst, self.worst_value = 0, collections.Counter(), collections.Counter(), (0.0, "none"), 0.0

    def add(self, unit, label):
        self.units += 1
        self.sum.update(unit["sum"])
        self.kinds.update(unit["kinds"])
        if unit["worst"] > self.worst[0]:
            self.worst = unit["worst"], f"{label}: {unit['command']}"
        self.worst_value = max(self.worst_value, unit["worst_value"])
