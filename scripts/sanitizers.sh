#!/usr/bin/env bash
# Builds with sanitizers and runs tests in that build.
#   scripts/sanitizers.sh            ASan, UBSan: file readers and C interface
#   scripts/sanitizers.sh --full     all tests but mutants, Yosys and the tree
#   scripts/sanitizers.sh --thread   ThreadSanitizer: all that uses threads
set -euo pipefail
source "$(dirname "$0")/help.sh"
cd "$(dirname "$0")/.."
export UBSAN_OPTIONS=print_stacktrace=1 ASAN_OPTIONS=detect_leaks=1
export LSAN_OPTIONS="suppressions=$PWD/scripts/lsan.supp:print_suppressions=0"
export TSAN_OPTIONS="suppressions=$PWD/scripts/tsan.supp:halt_on_error=1"

# run PRESET TARGET ARGUMENT...: builds the target, or everything for "", and runs what the arguments for ctest select.
run() {
  local preset=$1 target=$2
  shift 2
  cmake --preset "$preset" >/dev/null
  cmake --build --preset "$preset" -j "$(nproc)" ${target:+--target "$target"}
  ctest --test-dir "build/$preset" --output-on-failure --no-tests=error -j "$(nproc)" "$@"
}

case "${1:-}" in
  "") run readers reader_tests -L '^readers$' -L '^default$' ;;
  --full) run sanitizers "" -LE "${QUADRILLE_SANITIZE_SKIP:-sample|mutants|yosys|tree}" ;;
  --thread) run tsan threaded_tests -L '^threads$' -L '^quick$' ;;
  *) usage >&2; exit 2 ;;
esac
