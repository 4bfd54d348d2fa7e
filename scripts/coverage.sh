#!/usr/bin/env bash
# Coverage by the tests, against floors (scripts/README.md).
#   scripts/coverage.sh            builds, runs, judges: 45 minutes
#   scripts/coverage.sh --judge    judges the last run's counts again
# Writes build/coverage/coverage/coverage.json.
# Exit status: 0 floors held and exceptions valid, 1 not, or a test failed,
# 2 usage error, 3 missing tool.
set -euo pipefail
source "$(dirname "$0")/help.sh"
case "${1:-}" in
  "" | --judge) ;;
  *) echo "coverage.sh: unknown option $1; --help lists them" >&2; exit 2 ;;
esac
source "$(dirname "$0")/setup.sh"
folder=$root/build/coverage
if [ "${1:-}" = --judge ]; then exec scripts/coverage.py "$folder" "$folder/rtl_counts"; fi
install_packages "${packages[@]}"

# Test programs beside the unit tests. What takes long and comes again to the same lines stays out: mutants, syntheses, sweeps, campaigns, of the
# commands those that sweep or time.
programs=(cosim_test hidden_tiles_test exhaustive_test)
# A file without room takes gcov's counters too; the cache names these simulators otherwise and is not limited.
commands='-CliShrink.*:CliStressWhole.*:SweepCli.*:Cli.BenchPeersReports:CliCosim.WaveformWithoutRoom:CliCosim.TheCacheIsListedAndCleared'
cmake --preset coverage >/dev/null
cmake --build --preset coverage -j "$(nproc)" --target quadrille quadrille-studies unit_tests cli_test studies_cli_test golden_stages "${programs[@]}"
echo "Build: $SECONDS s"

# Simulators of this build count and are of no use to another.
export QUADRILLE_CACHE=$folder/cache QUADRILLE_CACHE_SIZE=0 QUADRILLE_COVERAGE_DIR=$folder/rtl_counts
find "$folder" -name '*.gcda' -delete
rm -rf "$QUADRILLE_COVERAGE_DIR"
mkdir -p "$QUADRILLE_COVERAGE_DIR"
export QUADRILLE_TEST_SEED=${QUADRILLE_TEST_SEED:-1}
status=0
run() { ctest --test-dir "$folder" --output-on-failure --no-tests=error --no-label-summary -j "$(nproc)" -L '^default$' "$@" || status=1; }
run -L '^unit$' -E '^(sweep|fuzz)_test$'
run -R "^($(IFS='|'; echo "${programs[*]}"))\$"
"$folder/tb/lockstep/cosim_test" --gtest_filter='Cosim.PlaneQuads*' --gtest_brief=1 || status=1  # plane quads in lockstep
"$folder/golden/vectors/golden_stages" 1 >/dev/null || status=1
for test in commands/cli_test studies/studies_cli_test; do
  "$folder/tb/$test" --gtest_filter="$commands" --gtest_brief=1 || status=1
done
echo "Tests: $SECONDS s"

# Toggles, of one machine: the default widths and every unit that the default configuration leaves out. Its simulator is thirty times the code of
# one that counts lines.
export QUADRILLE_COVERAGE_TOGGLE=1
draw=("$folder/quadrille" cosim --quiet --no-alone --no-snapping-error --threads 1
  --set hierarchical_z_bits=12 --set plane_quads=1 --set performance_counters=1)
"${draw[@]}" --scene bowtie --size 32x32 || status=1  # builds it
seed=100  # draw states in which every family has a fragment
{
  # Many quads more than many pixels, and places far from the origin.
  for scene in bowtie sphere layers_large; do echo "--scene $scene --size 96x96 --skip all"; done
  for family in $("$folder/quadrille" scenes --stress | sed '/^$/,$d' | cut -d' ' -f1); do
    echo "--stress $family --count 100 --size 256x256 --limit-fragments 2000 --stall 0.3 --gap 0.2"
    echo "--stress $family --count 60 --size 32x32 --stall 0.3 --gap 0.2"
    echo "--stress $family --count 80 --size 1600x16 --limit-fragments 1500 --draw-state random:$((++seed))"
    echo "--stress $family --count 80 --size 16x1600 --limit-fragments 1500 --draw-state random:$((++seed))"
  done
  python3 -c '
import json, sys, tomllib
needs = tomllib.load(open("scripts/plans/campaign.toml", "rb"))["phase"]["corner"]["needs"] | {"burst": "--stall 0.95"}
for group, needed in ((entry["name"], needs.get(entry["name"], "")) for entry in json.load(sys.stdin)):
    if "--set" not in needed:  # of the default configuration
        print("--corner", group, "--limit-fragments 8000", needed, "" if "--size" in needed else "--size 64x64")' < <("$folder/quadrille" scenes --corner --json)
} | xargs -P "$(nproc)" -L 1 "${draw[@]}" || status=1
echo "Toggles: $SECONDS s"

scripts/coverage.py "$folder" "$QUADRILLE_COVERAGE_DIR" || status=1
exit "$status"
