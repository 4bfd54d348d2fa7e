#!/usr/bin/env bash
# Sets up and runs a tier of the tests (scripts/README.md):
#   scripts/test.sh --quick     a minute once built
#   scripts/test.sh             default tier, as in CI: 20 minutes
#   scripts/test.sh --full      everything but Python and the page, an hour
#   scripts/test.sh --python    the Python package and cocotb, 8 minutes from nothing built; needs PyPI
#   scripts/test.sh --page      the page in a browser, 6 minutes; needs PyPI and npm
# Other arguments go to ctest, alone or after a tier: --quick -L model.
# Exit status: 0 all passed, 1 not.
set -euo pipefail
source "$(dirname "$0")/help.sh"
source "$(dirname "$0")/setup.sh"
case "${1:-}" in
  --python) exec "$root/model/python/tests/run.sh" "${@:2}" ;;
  --quick) tier=quick targets=(quick_tests) select=(-L '^quick$') ;;
  --full) tier=full targets=() select=(-LE '^(sample|page)$') ;;
  --page) tier=page targets=(quadrille page) select=(-L '^page$') packages+=("${page_packages[@]}") ;;
  "") tier=default targets=(default_tests) select=(-L '^default$') ;;
  *) tier="" targets=() select=() ;;
esac
[[ -n $tier && $# -gt 0 ]] && shift
set_up ${targets[@]+"${targets[@]}"}
echo "${tier:+Tier $tier. }Build: $SECONDS s"
# Which faults are drawn follows from the commit.
export QUADRILLE_TEST_SEED=${QUADRILLE_TEST_SEED:-$((16#$(git rev-parse --short=7 HEAD 2>/dev/null || echo 1)))}
mkdir -p build/release/Testing
report=$root/build/release/Testing/run.xml log=$root/build/release/Testing/run.log
rm -f "$report"
status=0
# One more than processors: some entries sleep.
ctest --test-dir build/release --output-on-failure --no-tests=error --no-label-summary --output-junit "$report" --test-output-size-passed 1000000 -j "$(($(nproc) + 1))" \
  ${select[@]+"${select[@]}"} "$@" 2>&1 | tee "$log" || status=$?
scripts/test_summary.py build/release "$report" || { [ "$status" -ne 0 ] || status=1; }
# What the tests of the lanes could run here: a clone that the processor lacks is not tested.
[ -z "$tier" ] || [ "$tier" = page ] || build/release/model/model_test --gtest_filter=LaneTarget.WhatRunsHere | grep '^lanes ' || true
echo "${tier:+Tier $tier, }seed $QUADRILLE_TEST_SEED (QUADRILLE_TEST_SEED), $SECONDS s with the build"
grep -E '^[0-9]+% tests passed' "$log" || true
exit "$status"
