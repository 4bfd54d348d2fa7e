#!/usr/bin/env bash
# Runs the commands that use threads, with four of them, for ThreadSanitizer (scripts/sanitizers.sh --thread).
#   scripts/threaded_commands.sh PATH_TO_QUADRILLE
set -euo pipefail
source "$(dirname "$0")/help.sh"
[ $# = 1 ] || { usage >&2; exit 2; }
quadrille=$(realpath "$1")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
run() {
  echo "quadrille $*"
  "$quadrille" "$@" --threads 4 --quiet
}
run cosim --scene bowtie --size 64x64 --set significand_bits=12 --stall 0.3 --gap 0.1 --no-alone  # lockstep with the truth beside it
run sweep --scene fig10_concave --size 48x48 --cosim none --axis significand_bits=10:14 --axis align_guard_bits=0:2 --out sweep
run sweep --scene fig10_concave --size 48x48 --cosim none --target-error lambda=2^-9 --axis significand_bits=8:16 --out search
run golden generate --level 1 --limit 20 --suite setup --suite weights --suite machine --out vectors
run golden verify vectors --engine model
run golden verify vectors --engine float
for engine in model float truth; do run render --engine $engine --scene sphere --size 96x96 --png $engine.png; done
run fragments --engine model --stress general --count 40 --size 64x64 --out fragments.csv
run compare --scene fig10_convex --methods split02,adaptive,mvc --size 64x64 --out compare
run bench --no-rtl --repeat 1 --fragments 2000 --size 64x64
run bench --error --no-rtl --repeat 1 --stress general --count 20 --size 64x64
