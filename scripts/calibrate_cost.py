#!/usr/bin/python3
"""Fit of the hardware cost's weights (golden/analysis/hardware_cost.hpp) to synthesis of the RTL as it is.

Synthesizes a list of diverse configurations with `quadrille sweep --synth`, fits LUTs = sum of weight * bits (not negative, no
constant, least relative squares) and prints the weights, the residuals, and how well estimates rank configurations that the fit has not
seen: each row by the fit to all others. With DSP blocks multipliers take no LUTs, and the blocks are counted, not fitted.

  scripts/calibrate_cost.py                      the whole list: minutes for each configuration the first time, then from the cache
  scripts/calibrate_cost.py --target ecp5-nodsp  with multipliers in logic
  scripts/calibrate_cost.py DIR [DIR ...]        sweeps that are there already (points.csv, synth.csv), all of one target

The fitted weights are printed as the table [cost] of a configuration file.
"""
import argparse
import csv
import itertools
import os
import subprocess
import sys
import tempfile

sys.dont_write_bytecode = True  # the folder may be a source tree or an installation
try:
    import numpy as np
except ImportError as missing:
    print(f"calibrate_cost.py: {missing}; install with: apt-get install python3-numpy (this is {sys.executable}, Debian's is /usr/bin/python3)",
          file=sys.stderr)
    sys.exit(3)

from report.program import PROGRAM  # noqa: E402

# Every key that moves many LUTs, at both ends and together with others.
CONFIGURATIONS = [
    "significand_bits=18",
    "significand_bits=8",
    "significand_bits=12",
    "significand_bits=15",
    "significand_bits=22",
    "significand_bits=26",
    "significand_bits=18 sqrt_degree=1 recip_degree=1",
    "significand_bits=18 attribute_slots=8",
    "significand_bits=14 attribute_slots=1 tile_log2=2 notch_exact=0 quad_slots_log2=1 tile_slots_log2=1",
    "significand_bits=10 tile_log2=4 align_guard_bits=6 quad_slots_log2=4 stamp_fifo_log2=5",
    "significand_bits=12 subpixel_bits=4 homogeneous_frac_bits=5 viewport_bits=10 depth_bits=16",
    "significand_bits=16 quadratic_frac_bits=8 align_guard_bits=0 attribute_slots=2",
]
RESOURCES = {"ecp5": ["state_bits", "adder_bits", "table_bits", "join_bits"],
             "ecp5-nodsp": ["state_bits", "multiplier_bits", "adder_bits", "table_bits"]}
ALL_RESOURCES = ["state_bits", "multiplier_bits", "adder_bits", "table_bits", "join_bits"]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("directories", metavar="DIR", nargs="*", help="results of `quadrille sweep --synth`; default: make them")
    parser.add_argument("--target", choices=RESOURCES, default="ecp5", help="what to synthesize for")
    parser.add_argument("--quadrille", default=PROGRAM, metavar="PATH", help="the program")
    args = parser.parse_args()

    try:
        if args.directories:
            rows = [row for directory in args.directories for row in read(directory)]
        else:
            rows = synthesise(args.quadrille, args.target)
    except (OSError, KeyError) as error:
        sys.exit(f"calibrate_cost.py: {error}")
    targets = {row["target"] for row in rows}
    if len(targets) != 1 or not targets <= set(RESOURCES):
        sys.exit(f"calibrate_cost.py: rows of one of the targets {', '.join(RESOURCES)} are needed, not of {', '.join(sorted(targets)) or 'none'}")
    resources = RESOURCES[targets.pop()]
    if len(rows) <= len(resources):
        sys.exit(f"{len(rows)} synthesized configurations; more than {len(resources)} are needed")

    luts = [row["luts"] for row in rows]
    weights = fit(rows, resources)
    unseen = [estimate(row, fit(rows[:i] + rows[i + 1:], resources)) for i, row in enumerate(rows)]
    print(f"{'LUTs':>9} {'flip-flops':>10} {'DSPs':>5} {'path':>5} {'cost':>9} {'fitted':>9} {'off by':>7} {'unseen':>7} {'counted':>7}  configuration")
    for row, guess in zip(rows, unseen):
        print(f"{row['luts']:9.0f} {row['flip_flops']:10.0f} {row['dsps']:5.0f} {row['longest_path']:5.0f} {row['cost_luts']:9.0f} "
              f"{estimate(row, weights):9.0f} {100 * (estimate(row, weights) / row['luts'] - 1):6.1f}% {100 * (guess / row['luts'] - 1):6.1f}% "
              f"{row['cost_dsps']:7.0f}  {row['configuration']}")
    print(f"\nrank correlation with synthesized LUTs: {spearman([row['cost_luts'] for row in rows], luts):.3f} with the weights used, "
          f"{spearman([estimate(row, weights) for row in rows], luts):.3f} fitted, {spearman(unseen, luts):.3f} each by the fit to the others\n")
    print("[cost]")
    for name in ALL_RESOURCES:
        print(f"{name.removesuffix('_bits')} = {weights.get(name, 0):.4g}")


def estimate(row, weights):
    return sum(weight * row[name] for name, weight in weights.items())


def synthesise(program, target):
    """One sweep of one point for each configuration; the input does not matter, so it is small."""
    rows = []
    for index, configuration in enumerate(CONFIGURATIONS):
        print(f"{index + 1}/{len(CONFIGURATIONS)} {configuration}", file=sys.stderr, flush=True)
        axis, *settings = configuration.split()
        with tempfile.TemporaryDirectory() as directory:
            command = [program, "sweep", "--axis", axis, *(part for setting in settings for part in ("--set", setting)),
                       "--synth", "all", "--synth-target", target, "--cosim", "none", "--no-cycles", "--scene", "bowtie", "--size", "64x64", "--quiet",
                       "--out", directory]
            done = subprocess.run(command, stdout=subprocess.DEVNULL, check=False)
            if done.returncode != 0:
                sys.exit(f"{' '.join(command)} ended with status {done.returncode}")
            rows += [row | {"configuration": configuration} for row in read(directory)]
    return rows


def read(directory):
    """Rows of synth.csv with the resources from points.csv."""
    with open(os.path.join(directory, "points.csv"), newline="", encoding="utf-8") as file:
        points = {row["row"]: row for row in csv.DictReader(file)}
    with open(os.path.join(directory, "synth.csv"), newline="", encoding="utf-8") as file:
        for row in csv.DictReader(file):
            numbers = {name: float(row[name]) for name in ["luts", "flip_flops", "dsps", "longest_path", "cost_luts", "cost_dsps"]}
            numbers |= {name: float(points[row["row"]][name]) for name in ALL_RESOURCES}
            yield numbers | {"target": row["target"], "configuration": f"{directory} row {row['row']}"}


def fit(rows, resources):
    """Non-negative least squares of the relative error: of all choices of weights that are not zero the best one."""
    share = np.array([[row[name] / row["luts"] for name in resources] for row in rows])
    found = []
    for count in range(1, len(resources) + 1):
        for used in itertools.combinations(range(len(resources)), count):
            weights = np.linalg.lstsq(share[:, used], np.ones(len(rows)), rcond=None)[0]
            if (weights >= 0).all():
                found.append((((share[:, used] @ weights - 1) ** 2).sum(), dict(zip(used, weights))))
    best = min(found, key=lambda candidate: candidate[0])[1]
    return {name: float(best.get(i, 0)) for i, name in enumerate(resources)}


def spearman(a, b):
    """Rank correlation, average ranks for ties; not a number for a constant list."""
    def ranks(values):
        return [sum(v < value for v in values) + sum(v == value for v in values) / 2 for value in values]

    with np.errstate(invalid="ignore"):
        return float(np.corrcoef(ranks(a), ranks(b))[0, 1])


if __name__ == "__main__":
    main()
