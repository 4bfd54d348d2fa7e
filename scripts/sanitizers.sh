#!/usr/bin/env bash
# Builds with AddressSanitizer and UndefinedBehaviorSanitizer and runs the tests of model, reference, scenes, io and command line.
set -euo pipefail
cd "$(dirname "$0")/.."
cmake --preset sanitizers >/dev/null
cmake --build --preset sanitizers -j "$(nproc)"
export UBSAN_OPTIONS=print_stacktrace=1 ASAN_OPTIONS=detect_leaks=1
export LSAN_OPTIONS="suppressions=$PWD/scripts/lsan.supp:print_suppressions=0"
exec ctest --test-dir build/sanitizers --output-on-failure --no-tests=error -j "$(nproc)" -LE "${QUADRILLE_SANITIZE_SKIP:-slow|mutants|yosys|tree}"
