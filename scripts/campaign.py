#!/usr/bin/env python3
"""Lockstep campaign: scenes, stress families and meshes under several stall and gap probabilities, corner groups, and draw states at random.

Runs `quadrille cosim` for each input and pattern, adds up the reports and fails when anything differed, when a fragment stream
changed with the stall pattern, or when fewer fragments were compared, in all or of some kind, than promised. Then every input
again in draw states, viewports, stalls and configurations that the seed draws; the options of a run that fails are printed.

  scripts/campaign.py                    the whole campaign (at least 2 million fragments; about 8 minutes)
  scripts/campaign.py --short            the form for continuous integration (at least 200,000 fragments)
  scripts/campaign.py --meshes DIR       OBJ files to add (default: ../shared/meshes when it is there)
"""
import argparse
import json
import random
import shlex
import sys

sys.dont_write_bytecode = True  # the folder may be a source tree or an installation
from report.files import InputError  # noqa: E402
from report.lockstep import CORNERS, FAMILIES, SKIPPING, Totals, fail, mesh_files, random_configuration, run, set_options  # noqa: E402
from report.program import PROGRAM  # noqa: E402

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


class Campaign:
    def __init__(self, args):
        self.args = args
        self.form = 1 if args.short else 0
        self.failures = []

    def cosim(self, options, may_be_empty=False):
        """The report of a run. A failed one is recorded, but where only the truth differs and nothing is claimed about it (dropped bits of D
        and r^2), or where a run that compares nothing is no failure."""
        command = [self.args.quadrille, "cosim", *options, "--no-alone", "--quiet", "--json", "-"]
        command += set_options(self.args.set)
        result = run(command)
        if not result.stdout:
            fail(command, result)
        report = json.loads(result.stdout)
        lockstep = report["mismatches"] + report["cycle_mismatches"] == 0
        sound = lockstep and report["model_alone"]["ok"]
        no_claim = sound and not report["bound"]["applies"]
        empty = sound and report["fragments"] + report["reference_mismatches"] == 0
        if result.returncode != 0 and not no_claim and not (may_be_empty and empty):
            sys.stderr.write(result.stderr)
            self.failures.append(f"{shlex.join(command)}: status {result.returncode}")
        return report

    def inputs(self, count):
        """Options that name an input, scenes first."""
        command = [self.args.quadrille, "scenes", "--json"]
        listed = run(command)
        if listed.returncode != 0:
            fail(command, listed)
        scenes = json.loads(listed.stdout)
        if self.args.short:  # the first paper's figures have every shape that the others vary
            scenes = [scene for scene in scenes if scene["paper"].startswith("Hormann & Tarini")]
        inputs = [["--scene", scene["name"]] for scene in scenes]
        # A tiny quad covers one or two pixels, so there are more of them.
        inputs += [["--stress", family, "--count", str(20 * count if family == "tiny" else count)] for family in FAMILIES]
        try:
            meshes = mesh_files(self.args.meshes)
        except InputError as error:
            sys.exit(str(error))
        return inputs + [["--mesh", mesh] for mesh in meshes], len(meshes)

    def standard_runs(self):
        """Every input in one draw state under every pattern."""
        size = "160x160" if self.args.short else "512x512"
        limit = 4_000 if self.args.short else 60_000
        inputs, meshes = self.inputs(150 if self.args.short else 2_000)
        totals = Totals()
        kinds = dict.fromkeys(KINDS, 0)
        complete = 0
        for source in inputs:
            hashes = set()
            for index, (stall, gap) in enumerate(PATTERNS):
                options = [*source, "--size", size, "--seed", str(self.args.seed), "--stall", str(stall), "--gap", str(gap)]
                if source[0] != "--scene":  # scenes are drawn to their end, so that missing pixels show
                    options += ["--limit-fragments", str(limit)]
                if index > 0:
                    options.append("--no-snapping-error")
                report = self.cosim(options)
                totals.add(report)
                for kind in kinds:
                    kinds[kind] += report["counts"][kind]
                if source[0] == "--scene" and not report["complete"]:
                    self.failures.append(f"{' '.join(source)}: not drawn to its end")
                hashes.add((report["fragments"], report["fragment_hash"]))
            complete += report["complete"]
            if len(hashes) != 1:
                self.failures.append(f"{' '.join(source)}: the fragment stream depends on the stall pattern")
            print(f"{' '.join(source):60s} {report['fragments']:8d} fragments x {len(PATTERNS)}", flush=True)

        print(f"\n{len(inputs)} inputs ({meshes} meshes), {complete} drawn to their end, (stall, gap) {PATTERNS}, seed {self.args.seed}")
        totals.print("standard draw state")
        print("  " + ", ".join(f"{kind} {count}" for kind, count in kinds.items()), flush=True)
        self.failures += totals.failures("standard draw state")
        if totals.sum["fragments"] < FRAGMENTS[self.form]:
            self.failures.append(f"only {totals.sum['fragments']} fragments were compared, {FRAGMENTS[self.form]} are promised")
        for kind, count in kinds.items():
            if count < KINDS[kind]:
                self.failures.append(f"only {count} fragments of kind {kind}, {KINDS[kind]} are promised")

    def corner_runs(self):
        totals = Totals()
        at_depth_limit = 0
        for group, needs in CORNERS.items():
            for stall, gap in CORNER_PATTERNS:
                size = [] if "--size" in needs else ["--size", "40x40"]
                report = self.cosim(["--corner", group, *size, *needs, "--seed", str(self.args.seed), "--stall", str(stall), "--gap", str(gap)])
                totals.add(report)
                at_depth_limit += report["counts"]["at_depth_limit"]
        totals.print(f"{len(CORNERS)} corner groups, (stall, gap) {CORNER_PATTERNS}")
        print(f"  at_depth_limit {at_depth_limit}", flush=True)
        self.failures += totals.failures("corner groups")
        if at_depth_limit < CORNER_DEPTH_LIMITS:
            self.failures.append(f"only {at_depth_limit} fragments of corner groups at a limit of depth, {CORNER_DEPTH_LIMITS} are promised")

    def hidden_runs(self):
        totals = Totals()
        hidden = 0
        for scene in LAYERS:
            hashes = set()
            for stall, gap in CORNER_PATTERNS:
                report = self.cosim(["--scene", scene, "--size", "96x96", "--skip", "all", "--seed", str(self.args.seed), "--stall", str(stall), "--gap", str(gap), *SKIPPING])
                totals.add(report)
                hidden += report["counters"]["tiles_hidden"]
                hashes.add((report["fragments"], report["fragment_hash"]))
            if len(hashes) != 1:
                self.failures.append(f"{scene}: what is hidden depends on the stall pattern")
        totals.print(f"{len(LAYERS)} scenes with hidden tiles, (stall, gap) {CORNER_PATTERNS}")
        print(f"  tiles hidden {hidden}", flush=True)
        self.failures += totals.failures("scenes with hidden tiles")
        if hidden < HIDDEN_TILES:
            self.failures.append(f"only {hidden} tiles were hidden, {HIDDEN_TILES} are promised")

    def drawn_runs(self):
        """Every input in draw states, viewports, stalls and configurations at random."""
        configurations = [[], SKIPPING]
        rng = random.Random(f"{self.args.seed}")
        for number in range(DRAWN_CONFIGURATIONS[self.form]):
            configurations.append(random_configuration(self.args.quadrille, rng, dropped_bits=number % 2 == 0))
        inputs, _ = self.inputs(40 if self.args.short else 200)
        inputs += [["--corner", group] for group in CORNERS]
        totals = Totals()
        kinds = dict.fromkeys(DRAWN_KINDS, 0)
        for index, source in enumerate(inputs):
            for number in range(DRAWN_RUNS[self.form]):
                rng = random.Random(f"{self.args.seed} {index} {number}")
                width, height = rng.randint(32, 160), rng.randint(32, 160)
                if rng.random() < 0.25:
                    width, height = rng.randint(32, 160), rng.randint(257, 600)
                    if rng.random() < 0.25:
                        width, height = height, width
                stall, gap = rng.choice([0, 0.1, 0.5, 0.9, 0.95]), rng.choice([0, 0.1, 0.5, 0.9])
                limit = (600 if stall >= 0.9 else 2_000) * (1 if self.args.short else 4)
                report = self.cosim([*source, "--size", f"{width}x{height}", "--draw-state", f"random:{rng.randint(1, 10**9)}",
                                     "--seed", str(self.args.seed + number), "--stall", str(stall), "--gap", str(gap),
                                     "--limit-fragments", str(limit), "--no-snapping-error", *rng.choice(configurations)], may_be_empty=True)
                totals.add(report)
                state = report["draw_state"]
                fragments = report["fragments"]
                words = state.split()
                skips = words[words.index("--skip") + 1].split(",") if "--skip" in words else ["tiles", "quads", "walk", "operands"]
                held = {"scissor": "--scissor" in state, "cull": "--cull" in state, "no_perspective": "--no-perspective" in state,
                        "no_depth": "--no-depth" in state, "znear": "--znear" in state and "--no-depth" not in state,
                        "zfar": "--zfar" in state and "--no-depth" not in state, "fewer_attributes": "--attributes" in state,
                        "no_tile_skip": "tiles" not in skips, "no_quad_skip": "quads" not in skips, "no_walk_skip": "walk" not in skips, "no_operand_skip": "operands" not in skips, "dropped_bits": not report["bound"]["applies"],
                        "over_256_px": max(width, height) > 256, "stall_0.95": stall == 0.95}
                for kind, holds in held.items():
                    kinds[kind] += fragments if holds else 0
                kinds["at_depth_limit"] += report["counts"]["at_depth_limit"]
        print(f"\n{totals.sum['runs']} runs in draw states at random, seed {self.args.seed}; configurations beside the one given:")
        for options in configurations[1:]:
            print("  " + " ".join(options))
        totals.print("draw states at random")
        print("  fragments with " + ", ".join(f"{kind} {count}" for kind, count in kinds.items()), flush=True)
        self.failures += totals.failures("draw states at random")
        for kind, count in kinds.items():
            if count < DRAWN_KINDS[kind][self.form]:
                self.failures.append(f"only {count} fragments in draws of kind {kind}, {DRAWN_KINDS[kind][self.form]} are promised")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--quadrille", default=PROGRAM, help="the program")
    parser.add_argument("--short", action="store_true")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--meshes", metavar="DIR", help="folder with OBJ files (default: ../shared/meshes when it is there)")
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE", help="configuration, as for quadrille")
    campaign = Campaign(parser.parse_args())
    campaign.standard_runs()
    campaign.corner_runs()
    campaign.hidden_runs()
    campaign.drawn_runs()
    for failure in campaign.failures:
        print("FAILED: " + failure, file=sys.stderr)
    return 1 if campaign.failures else 0


if __name__ == "__main__":
    sys.exit(main())
