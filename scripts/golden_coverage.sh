#!/usr/bin/env bash
# Lists branches of the model's stages that no golden vector takes.
#   scripts/golden_coverage.sh [LEVEL]
# Builds in build/golden_coverage, default configuration. Branches of exceptions
# do not count; unreachable ones are listed with the reason.
# Exit status: 0 all others taken, 1 not.
set -euo pipefail
source "$(dirname "$0")/help.sh"
cd "$(dirname "$0")/.."
level=${1:-1}
build=${BUILD_DIR:-build/golden_coverage}

cmake -S . -B "$build" -DCMAKE_BUILD_TYPE=Debug -DCMAKE_CXX_FLAGS="--coverage -O0" >"$build.log" 2>&1 ||
  { cat "$build.log" >&2; exit 2; }
rm -f "$build.log"
cmake --build "$build" -j "$(nproc)" --target golden_stages
find "$build" -name '*.gcda' -delete
"$build/golden/vectors/golden_stages" "$level"

PYTHONPATH=scripts python3 -B - "$build" <<'PYTHON'
import os, sys

import coverage

stages = {f"model/{name}" for name in (
    "port/snap.cpp", "port/quick_snap.cpp", "front/quad_setup.cpp", "front/tile_context.cpp", "front/stamp_coverage.cpp",
    "pixel/forward_difference.cpp", "pixel/normalise.cpp", "pixel/sqrt.hpp", "pixel/reciprocal.hpp",
    "pixel/table_polynomial.hpp", "pixel/significand.hpp", "pixel/mean_value_ratios.cpp", "pixel/root_ratio.hpp",
    "pixel/weight_factors.cpp", "pixel/mean_value_weights.cpp", "pixel/interpolate.cpp", "pixel/fragment_output.cpp")}
# (file, piece of the source line): why no stimulus gets there in the default configuration.
unreachable = {
    ("model/pixel/fragment_output.cpp", "shift >= 0 ? r.p << shift"): "2S - 2 = 34 exceeds the bits of either output format",
    ("model/pixel/fragment_output.cpp", "p.valid && !discard"): "a bubble of the pipeline is no vector",
    ("model/pixel/normalise.cpp", "c.config.notch_exact &&"): "a constant of the configuration",
    **{("model/front/quad_setup.cpp", piece): "clocks, not values" for piece in ("int quad_setup_steps", "separates")},
    **{("model/pixel/weight_factors.cpp", piece): "plane_quads is off in the default configuration" for piece in (
        "> areas(", "any_of(p.a", "behind_diagonal", "= c.format.one();", "auto area", "none{{}", "area(1)", "quad.plane ?")},
    ("model/port/snap.cpp", "a product with k is too large"): "k is below 2^96 and z at most 2^80; the port reaches 2^256",
    ("model/port/snap.cpp", "extent_.zero()"): "w = 0 here leaves x and y as given, which are not both 0",
    **{("model/port/snap.cpp", piece): "vertices of the suite have all attributes" for piece in ("as_many) ||", "return slot <")},
    ("model/port/snap.cpp", "quad_id_bits"): "ids belong to quads; the suite snaps vertices",
    ("model/port/snap.cpp", "SnapError(quad.id"): "as above",
    ("model/port/snap.cpp", "is_ordinary"): "a query of the test bench",
    ("model/port/snap.cpp", "for (const SnappedVertex& v : quad.vertex)"): "as above",
    ("model/port/snap.cpp", "if (v.w != 1 << config.frac()) return false;"): "as above",
    ("model/port/snap.cpp", "return true;"): "as above",
    ("model/port/snap.cpp", "has_ordinary_vertices"): "as above",
    ("model/port/snap.cpp", "const std::int32_t between"): "as above",
    ("model/port/snap.cpp", "& between) != 0) return false;"): "as above",
}


def reason_of(name, source):
    for (file, piece), reason in unreachable.items():
        if file == name and piece in source:
            return reason
    return None


root, build, counts = os.getcwd(), os.path.realpath(sys.argv[1]), coverage.Counts()
for report in coverage.run_gcov(build):
    coverage.add_gcov(counts, report, root)
sources = coverage.Sources(root)
coverage.without_closing_lines(counts, sources)
missing = branches = excused = lines = 0
for file in sorted(stages):
    points = counts.files.get(file) or sys.exit(f"no counters of {file}")
    lines += len(points["lines"])
    branches += sum(points["lines"][line] > 0 for line, *_ in points["branches"])
    gone = [(line, "never executed") for line, count in points["lines"].items() if count == 0]
    gone += [(line, f"branch {i} of {n} never taken") for (line, n, i), count in points["branches"].items() if count == 0 < points["lines"][line]]
    for number, what in sorted(gone):
        source = sources.line(file, number)
        if "catch (" in source:  # landing pads of exceptions
            continue
        reason = reason_of(file, source)
        print(f"{file}:{number}: {what}{f' (cannot be: {reason})' if reason else ''}: {source}")
        excused += reason is not None
        missing += reason is None
print(f"{branches} branches in {lines} lines of {len(stages)} files; {missing} not taken, {excused} cannot be")
sys.exit(1 if missing else 0)
PYTHON
