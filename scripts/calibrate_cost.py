#!/usr/bin/python3
"""Fits the weights of the hardware cost to synthesis.

  scripts/calibrate_cost.py --target ecp5-nodsp
  scripts/calibrate_cost.py --check
  scripts/calibrate_cost.py --synthesise --target ecp5      minutes per row

golden/analysis/synthesised.csv has sizes by scripts/size.py. Rows `fit` are
fitted, rows `check` are not. LUTs = sum of weight * bits (not negative, no
constant, least relative squares). DSP blocks and block RAMs are counted.

Prints the weights as the table [cost] of a configuration file, the residuals,
and the rank correlation on rows outside the fit (each `fit` row by a fit to the
others, and the `check` rows).

Exit status: 0 done, 1 check or synthesis failed, 2 usage or input error,
3 missing tool.
"""
import csv
import itertools
import json
import math
import os
import subprocess
import sys
import tempfile

try:
    import numpy as np
except ImportError as missing:
    print(f"calibrate_cost.py: {missing}; install with: apt-get install python3-numpy (this is {sys.executable}, Debian's is /usr/bin/python3)",
          file=sys.stderr)
    sys.exit(3)

from report.files import InputError, write_text  # noqa: E402
from report.program import PROGRAM, ROOT, end, options  # noqa: E402

FIGURES = os.path.join(ROOT, "golden/analysis/synthesised.csv")
COLUMNS = ["target", "use", "luts", "flip_flops", "dsps", "block_rams", "configuration"]
COUNTS = COLUMNS[2:6]
USES = {"fit", "check"}
# Target -> (resources fitted, those whose weights are another target's): the logic beside the multipliers is the same.
FITTED = {"ecp5": (["adder", "table", "join"], None), "ecp5-nodsp": (["multiplier"], ("ecp5", ["adder", "table"]))}
RESOURCES = ["state", "multiplier", "adder", "table", "join"]
BLOCKS = {"dsp": "dsps", "block_ram": "block_rams"}
STATE = 0.001  # a flip-flop sits beside a LUT and takes none, but it is not free
GOOD_RANK = 0.95


def main():
    parser = options(__doc__)
    parser.add_argument("--target", choices=FITTED, help="only this target (default: all measured)")
    parser.add_argument("--figures", default=FIGURES, metavar="FILE", help="measured sizes (default: golden/analysis/synthesised.csv)")
    parser.add_argument("--check", action="store_true", help="fail if the program's weights differ, a count is wrong or a rank correlation is below 0.95")
    parser.add_argument("--synthesise", action="store_true", help="first measure --target (or all) again")
    parser.add_argument("--quadrille", default=PROGRAM, metavar="PATH", help="program (default: build/release/quadrille)")
    args = parser.parse_args()
    try:
        if args.synthesise:
            synthesise(args)
        rows = read(args.figures)
        for row in rows:
            row |= resources(args.quadrille, row["configuration"])
    except OSError as error:
        raise InputError(error) from None
    faults, weights = [], {}
    for target, (fitted, taken) in FITTED.items():
        mine = [row for row in rows if row["target"] == target]
        if not mine:
            continue
        seen = [row for row in mine if row["use"] == "fit"]
        if len(seen) <= len(fitted):
            raise InputError(f"{args.figures}: {len(seen)} rows to fit for {target}; more than {len(fitted)} are needed")
        known = {"state": STATE} | ({name: weights[taken[0]][name] for name in taken[1]} if taken else {})
        weights[target] = fit(seen, fitted, known)
        if args.target in (None, target):
            faults += calibrate(target, lambda rows, fitted=fitted, known=known: fit(rows, fitted, known), mine, seen,
                                args.quadrille if args.check else None)
    for fault in faults:
        print(f"calibrate_cost.py: {fault}", file=sys.stderr)
    return 1 if faults else 0


def calibrate(target, fit_to, rows, seen, program):
    """Prints the fit of a target; what is wrong with it, as the weights of `program` have it."""
    weights = fit_to(seen)
    unseen = {id(row): estimate(row, fit_to([other for other in seen if other is not row])) for row in rows}
    faults = []
    print(f"{target}\n{'LUTs':>9} {'fitted':>9} {'off by':>7} {'unseen':>7} {'FF':>7} {'counted':>7} {'DSP':>5} {'BRAM':>5}  configuration")
    for row in rows:
        print(f"{row['luts']:9} {estimate(row, weights):9.0f} {off(estimate(row, weights), row):6.1f}% {off(unseen[id(row)], row):6.1f}% "
              f"{row['flip_flops']:>7} {row['state'] - row['memory']:7} {row['dsps']:5} {row['block_rams']:5}  {row['configuration']}"
              f"{'' if row['use'] == 'fit' else '  (not fitted)'}")
        for name, column in BLOCKS.items():
            if row[name] != row[column] and not (name == "dsp" and target == "ecp5-nodsp"):
                faults.append(f"{target} {row['configuration']}: {row[column]} {name} blocks, counted {row[name]}")
    for what, among in (("each fitted row by the fit to the others", seen), ("rows that were not fitted", [r for r in rows if r["use"] == "check"]),
                        ("all rows, none in its own fit", rows)):
        if len(among) > 2:
            rank = spearman([unseen[id(row)] for row in among], [row["luts"] for row in among])
            print(f"rank correlation, {len(among)} {what}: {rank:.3f}")
            if rank < GOOD_RANK:
                faults.append(f"{target}: rank correlation {rank:.3f} of {what}, at least {GOOD_RANK} is needed")
    print("[cost]")
    for name in RESOURCES:
        print(f"{name} = {weights.get(name, 0):.3g}")
    print()
    if program:
        faults += weights_that_differ(target, weights, program)
    return faults


def weights_that_differ(target, weights, program):
    """The program's weights are the fit, in three digits."""
    used = sweep(program, "significand_bits=18", target)[1]["cost_weights"]
    return [f"{target}: the program's weight of {name} is {used[name]:g}, the fit is {weights.get(name, 0):.3g}"
            for name in RESOURCES if not math.isclose(used[name], float(f"{weights.get(name, 0):.3g}"), rel_tol=1e-9)]


def estimate(row, weights):
    return sum(weight * row[name] for name, weight in weights.items())


def off(guess, row):
    return 100 * (guess / row["luts"] - 1)


# ---- figures ----


def read(name):
    with open(name, newline="", encoding="utf-8") as file:
        lines = [line for line in file if not line.startswith("#")]
    rows = list(csv.DictReader(lines))
    for number, row in enumerate(rows, 1):
        if list(row) != COLUMNS or None in row.values():
            raise InputError(f"{name}: row {number}: columns are {','.join(COLUMNS)}")
        if row["target"] not in FITTED or row["use"] not in USES or not all(row[column].isdigit() for column in COUNTS):
            raise InputError(f"{name}: row {number}: a target of {', '.join(FITTED)}, a use of fit, check and four counts are expected")
        row |= {column: int(row[column]) for column in COUNTS}
    return rows


def synthesise(args):
    """Rewrites the counts of the rows of the target."""
    with open(args.figures, encoding="utf-8") as file:
        head = [line for line in file if line.startswith("#")]
    rows = read(args.figures)
    for index, row in enumerate(rows, 1):
        if args.target not in (None, row["target"]):
            continue
        print(f"{index}/{len(rows)} {row['target']} {row['configuration']}", file=sys.stderr, flush=True)
        command = [sys.executable, os.path.join(os.path.dirname(os.path.abspath(__file__)), "size.py"), "--target", row["target"], "--quadrille",
                   args.quadrille, "--json", "-", *row["configuration"].split()]
        done = subprocess.run(command, stdout=subprocess.PIPE, text=True, check=False)
        if done.returncode != 0:
            sys.exit(done.returncode)
        row |= {column: json.loads(done.stdout)[column] for column in COUNTS}
        text = "".join([*head, ",".join(COLUMNS) + "\n", *(",".join(str(r[column]) for column in COLUMNS) + "\n" for r in rows)])
        write_text(args.figures, text)


def resources(program, configuration):
    """What hardware_cost() counts: resource -> bits, `memory` among the state, `dsp` and `block_ram`."""
    point = sweep(program, configuration, "ecp5")[0]
    counted = {name: int(point[f"{name}_bits"]) for name in RESOURCES}
    return counted | {name: int(point[column]) for name, column in BLOCKS.items()} | {"memory": int(point["memory_bits"])}


def sweep(program, configuration, target):
    """A sweep of one point, whose input does not matter: its row of points.csv, and its manifest."""
    axis, *settings = configuration.split()
    with tempfile.TemporaryDirectory() as directory:
        command = [program, "sweep", "--axis", axis, *(part for setting in settings for part in ("--set", setting)), "--synth-target", target,
                   "--cosim", "none", "--no-cycles", "--scene", "bowtie", "--size", "16x16", "--quiet", "--out", directory]
        done = subprocess.run(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, check=False)
        if done.returncode != 0:
            raise InputError(f"{' '.join(command)}: {done.stderr.strip()}")
        with open(os.path.join(directory, "points.csv"), newline="", encoding="utf-8") as file:
            point = next(csv.DictReader(file))
        with open(os.path.join(directory, "manifest.json"), encoding="utf-8") as file:
            return point, json.load(file)


# ---- arithmetic ----


def fit(rows, names, known):
    """Non-negative least squares of the relative error with some weights known: of all choices of weights that are not zero the best one."""
    share = np.array([[row[name] / row["luts"] for name in names] for row in rows])
    wanted = np.array([1 - estimate(row, known) / row["luts"] for row in rows])
    found = []
    for count in range(1, len(names) + 1):
        for used in itertools.combinations(range(len(names)), count):
            weights = np.linalg.lstsq(share[:, used], wanted, rcond=None)[0]
            if (weights >= 0).all():
                found.append((((share[:, used] @ weights - wanted) ** 2).sum(), dict(zip(used, weights))))
    best = min(found, key=lambda candidate: candidate[0])[1]
    return known | {name: float(best.get(i, 0)) for i, name in enumerate(names)}


def spearman(a, b):
    """Rank correlation, average ranks for ties; not a number for a constant list."""
    def ranks(values):
        return [sum(v < value for v in values) + sum(v == value for v in values) / 2 for value in values]

    with np.errstate(invalid="ignore"):
        return float(np.corrcoef(ranks(a), ranks(b))[0, 1])


if __name__ == "__main__":
    end(main)
