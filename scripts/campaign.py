#!/usr/bin/env python3
"""Lockstep campaign: scenes, stress families and meshes under several stall and gap probabilities.

Runs `quadrille cosim` for each input and pattern, adds up the reports and fails when anything differed, when a fragment stream
changed with the stall pattern, or when fewer fragments were compared than promised.

  scripts/campaign.py                    the whole campaign (at least 2 million fragments; about 5 minutes)
  scripts/campaign.py --short            the form for continuous integration (at least 200,000 fragments)
  scripts/campaign.py --meshes DIR       OBJ files to add (default: ../shared/meshes when it is there)
"""
import argparse
import glob
import json
import os
import subprocess
import sys

sys.dont_write_bytecode = True  # the folder may be a source tree or an installation
from report.program import PROGRAM, ROOT  # noqa: E402

FAMILIES = (
    "general perspective any_w near_edge on_edge near_vertex on_vertex sliver collapsed_edge straight_corner reflex bowtie "
    "tiny huge eye_crossing eye_in_hull w_zero shared_edge shared_vertex coplanar long_span coincident"
).split()
# Stall and gap; each takes every value.
PATTERNS = [(0, 0), (0.1, 0.5), (0.5, 0.1), (0.9, 0.9)]
# Fragments of each kind that must have been compared.
KINDS = {"eye_crossing": 10_000, "near_edge": 10_000, "near_vertex": 10_000, "tiny": 10_000}
FRAGMENTS = (2_000_000, 200_000)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--quadrille", default=PROGRAM, help="the program")
    parser.add_argument("--short", action="store_true")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--meshes", metavar="DIR", help="folder with OBJ files (default: ../shared/meshes when it is there)")
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE", help="configuration, as for quadrille")
    args = parser.parse_args()

    size = "160x160" if args.short else "512x512"
    limit = 4_000 if args.short else 60_000
    scenes = json.loads(run([args.quadrille, "scenes", "--json"]))
    if args.short:  # the first paper's figures have every shape that the others vary
        scenes = [scene for scene in scenes if scene["paper"].startswith("Hormann & Tarini")]
    inputs = [["--scene", scene["name"]] for scene in scenes]
    count = 150 if args.short else 2_000
    # A tiny quad covers one or two pixels, so there are more of them.
    inputs += [["--stress", family, "--count", str(20 * count if family == "tiny" else count)] for family in FAMILIES]
    meshes = sorted(glob.glob(os.path.join(args.meshes or os.path.join(ROOT, "../shared/meshes"), "*.obj")))
    if args.meshes and not meshes:
        parser.error(f"--meshes {args.meshes}: no OBJ file there")
    inputs += [["--mesh", mesh] for mesh in meshes]

    total = {"fragments": 0, "cycles": 0, "bits": 0, "mismatches": 0, "cycle_mismatches": 0, "reference": 0, "beyond": 0}
    kinds = dict.fromkeys(KINDS, 0)
    worst = 0.0
    failures = []
    complete = set()
    for source in inputs:
        hashes = set()
        for index, (stall, gap) in enumerate(PATTERNS):
            command = [args.quadrille, "cosim", *source, "--size", size, "--seed", str(args.seed), "--stall", str(stall), "--gap", str(gap),
                       "--no-alone", "--quiet", "--json", "-"]
            command += [part for setting in args.set for part in ("--set", setting)]
            if source[0] != "--scene":  # scenes are drawn to their end, so that missing pixels show
                command += ["--limit-fragments", str(limit)]
            if index > 0:
                command.append("--no-snapping-error")
            report = json.loads(run(command, failures))
            total["fragments"] += report["fragments"]
            total["cycles"] += report["cycles_all_passes"]
            total["bits"] += report["compared_bits"]
            total["mismatches"] += report["mismatches"]
            total["cycle_mismatches"] += report["cycle_mismatches"]
            total["reference"] += report["reference_mismatches"]
            total["beyond"] += report["beyond_bound"] + report["beyond_attribute"] + report["beyond_depth"]
            for kind in kinds:
                kinds[kind] += report["counts"][kind]
            worst = max(worst, report.get("worst", {}).get("error_over_bound", 0))
            if report["complete"]:
                complete.add(" ".join(source))
            elif source[0] == "--scene":
                failures.append(f"{' '.join(source)}: not drawn to its end")
            hashes.add((report["fragments"], report["fragment_hash"]))
        if len(hashes) != 1:
            failures.append(f"{' '.join(source)}: the fragment stream depends on the stall pattern")
        print(f"{' '.join(source):60s} {report['fragments']:8d} fragments x {len(PATTERNS)}", flush=True)

    form = 1 if args.short else 0
    print(f"\n{len(inputs)} inputs ({len(meshes)} meshes), (stall, gap) {PATTERNS}, seed {args.seed}")
    print(f"{total['fragments']} fragments, {total['cycles']} cycles, {total['bits']} bits compared")
    print(f"{total['mismatches']} mismatches, {total['cycle_mismatches']} cycle mismatches, {total['reference']} coverage differences, "
          f"{total['beyond']} values beyond their bound; worst weight {100 * worst:.1f} % of the bound, {len(complete)} inputs drawn to their end")
    print(", ".join(f"{kind} {count}" for kind, count in kinds.items()))
    for key in ("mismatches", "cycle_mismatches", "reference", "beyond"):
        if total[key]:
            failures.append(f"{key}: {total[key]}")
    if total["fragments"] < FRAGMENTS[form]:
        failures.append(f"only {total['fragments']} fragments were compared, {FRAGMENTS[form]} are promised")
    for kind, count in kinds.items():
        if count < KINDS[kind]:
            failures.append(f"only {count} fragments of kind {kind}, {KINDS[kind]} are promised")
    for failure in failures:
        print("FAILED: " + failure, file=sys.stderr)
    return 1 if failures else 0


def run(command, failures=None):
    """Standard output of a command; a failed one is recorded, or ends the campaign when it printed no report."""
    result = subprocess.run(command, stdout=subprocess.PIPE, text=True)
    if result.returncode != 0:
        if failures is None or not result.stdout:
            sys.exit(f"FAILED: {' '.join(command)} ended with status {result.returncode}")
        failures.append(f"{' '.join(command)}: status {result.returncode}")
    return result.stdout


if __name__ == "__main__":
    sys.exit(main())
