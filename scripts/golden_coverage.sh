#!/usr/bin/env bash
# Branches of the model's stage functions that a level of the golden stage suites does not take.
#   scripts/golden_coverage.sh [LEVEL]
# Builds the model with gcov's counters in build/coverage, generates for the default configuration, and lists line and
# branch of what was never taken, exceptions apart, and what no vector can take, with the reason. Status 1 if anything
# else is left.
set -euo pipefail
cd "$(dirname "$0")/.."
level=${1:-1}
build=${BUILD_DIR:-build/golden_coverage}

cmake -S . -B "$build" -DCMAKE_BUILD_TYPE=Debug -DCMAKE_CXX_FLAGS="--coverage -O0" >"$build.log" 2>&1 ||
  { cat "$build.log" >&2; exit 2; }
rm -f "$build.log"
cmake --build "$build" -j "$(nproc)" --target golden_stages
find "$build" -name '*.gcda' -delete
"$build/golden/suites/golden_stages" "$level"

python3 - "$build" <<'PYTHON'
import json, pathlib, subprocess, sys

stages = {f"model/{name}" for name in (
    "snap.cpp", "quad_setup.cpp", "tile_context.cpp", "stamp_coverage.cpp", "forward_difference.cpp", "normalise.cpp", "sqrt.hpp", "reciprocal.hpp",
    "table_polynomial.hpp", "significand.hpp", "mean_value_ratios.cpp", "root_ratio.hpp", "weight_factors.cpp", "mean_value_weights.cpp", "interpolate.cpp",
    "fragment_output.cpp")}
# (file, piece of the source line): why no stimulus gets there in the default configuration.
unreachable = {
    ("model/fragment_output.cpp", "shift >= 0 ? r.p << shift"): "2S - 2 = 34 exceeds the bits of either output format",
    ("model/fragment_output.cpp", "p.valid && !discard"): "a bubble of the pipeline is no vector",
    ("model/normalise.cpp", "c.config.notch_exact &&"): "a constant of the configuration",
    ("model/quad_setup.cpp", "int quad_setup_steps"): "clocks, not values",
    ("model/snap.cpp", "a product with k is too large"): "k is below 2^96 and z at most 2^80; the port reaches 2^256",
    ("model/snap.cpp", "extent == 0"): "w = 0 here leaves x and y as given, which are not both 0",
    ("model/snap.cpp", "quad_id_bits"): "ids belong to quads; the suite snaps vertices",
    ("model/snap.cpp", "SnapError(quad.id"): "as above",
    ("model/snap.cpp", "is_ordinary"): "a query of the test bench",
    ("model/snap.cpp", "for (const SnappedVertex& v : quad.vertex)"): "as above",
    ("model/snap.cpp", "if (v.w != 1 << config.frac()) return false;"): "as above",
    ("model/snap.cpp", "return true;"): "as above",
    ("model/snap.cpp", "has_ordinary_vertices"): "as above",
    ("model/snap.cpp", "const std::int32_t between"): "as above",
    ("model/snap.cpp", "& between) != 0) return false;"): "as above",
}


def reason_of(name, source):
    for (file, piece), reason in unreachable.items():
        if file == name and piece in source:
            return reason
    return None


root = pathlib.Path.cwd()
taken = {}  # (file, line) -> branch counts of each object that holds the line: one line may be compiled into many
lines = {}
for data in pathlib.Path(sys.argv[1]).rglob("*.gcda"):
    report = subprocess.run(["gcov", "--json-format", "--stdout", "--branch-probabilities", str(data)], check=True,
                            capture_output=True, text=True).stdout
    for text in report.splitlines():
        for file in json.loads(text)["files"]:
            path = pathlib.Path(file["file"])
            name = str(path.relative_to(root)) if path.is_relative_to(root) else str(path)
            if name not in stages:
                continue
            for line in file["lines"]:
                key = (name, line["line_number"])
                lines[key] = lines.get(key, 0) + line["count"]
                counts = tuple(b["count"] for b in line["branches"] if not b["throw"])
                # Copies of a line with the same number of branches are the same code.
                old = taken.setdefault(key, {}).get(len(counts), [0] * len(counts))
                taken[key][len(counts)] = [a + b for a, b in zip(old, counts)]
missing = branches = excused = 0
for key in sorted(taken):
    source = pathlib.Path(key[0]).read_text().splitlines()[key[1] - 1].strip()
    if source == "}" or "catch (" in source:  # landing pads of exceptions
        continue
    gone = []
    if lines[key] == 0:
        gone.append("never executed")
    else:
        for counts in taken[key].values():
            if len(counts) > 1:
                branches += len(counts)
                gone += [f"branch {i} of {len(counts)} never taken" for i, count in enumerate(counts) if count == 0]
    reason = reason_of(key[0], source)
    for what in gone:
        print(f"{key[0]}:{key[1]}: {what}{f' (cannot be: {reason})' if reason else ''}: {source}")
    if reason:
        excused += len(gone)
    else:
        missing += len(gone)
seen = {key[0] for key in taken}
if seen != stages:
    sys.exit(f"no counters of {sorted(stages - seen)}")
print(f"{branches} branches in {len(lines)} lines of {len(stages)} files; {missing} not taken, {excused} cannot be")
sys.exit(1 if missing else 0)
PYTHON
