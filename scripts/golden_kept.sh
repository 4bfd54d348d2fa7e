#!/usr/bin/env bash
# Checks the kept golden vectors (golden/vectors/kept): same bytes when generated
# again; model, float and RTL agree; golden/CHANGELOG.md has a new version.
#   scripts/golden_kept.sh PATH_TO_QUADRILLE [--update | --quick | --default]
# --update replaces the set; then add the line that the script names.
# --quick: no simulators; --default: one per suite; otherwise both.
set -euo pipefail
source "$(dirname "$0")/help.sh"
[ $# -gt 0 ] || { usage >&2; exit 2; }
cd "$(dirname "$0")/.."
export QUADRILLE
QUADRILLE=$(realpath "$1")
kept=golden/vectors/kept
suites=(snapping setup tile_context coverage forward_difference normalise sqrt reciprocal ratios weights interpolation depth machine
  stress_reflex stress_bowtie stress_eye_crossing)
generate() {
  local arguments=()
  for suite in "${suites[@]}"; do arguments+=(--suite "$suite"); done
  "$QUADRILLE" golden generate --level 1 --limit 200 --quiet "${arguments[@]}" --out "$@"
}

form=${2:-}
case $form in "" | --update | --quick | --default) ;; *) usage >&2; exit 2 ;; esac
if [ "$form" = --update ]; then
  generate "$kept.new"  # --force replaces sets of this format alone
  rm -r "$kept"
  mv "$kept.new" "$kept"
elif [ "$form" != --quick ]; then
  work=$(mktemp -d)
  trap 'rm -rf "$work"' EXIT
  generate "$work/again"
  "$QUADRILLE" golden diff "$kept" "$work/again"
  diff -r "$kept" "$work/again"  # every byte, manifests too
fi

scripts/golden_changelog.sh golden/CHANGELOG.md "$kept"
size=$(du -sb "$kept" | cut -f1)
[ "$size" -le 5000000 ] || { echo "$kept has $size bytes; 5 MB at most" >&2; exit 1; }

"$QUADRILLE" golden verify "$kept" --engine model --quiet
"$QUADRILLE" golden verify "$kept" --engine float --quiet
golden/examples/check_edges_and_weights.py "$kept"
[ "$form" != --quick ] || exit 0
if [ "$form" = --default ]; then
  stages=() machines=()
  for suite in "${suites[@]}"; do
    case $suite in snapping) ;; machine | stress_*) machines+=(--suite "$suite") ;; *) stages+=(--suite "$suite") ;; esac
  done
  scripts/replay.sh "$kept" icarus "${stages[@]}"
  scripts/replay.sh "$kept" verilator "${machines[@]}"
  exit 0
fi
scripts/replay.sh "$kept" verilator
scripts/replay.sh "$kept" icarus
scripts/replay.sh "$kept" icarus --netlist --suite sqrt --suite reciprocal
"$QUADRILLE" golden verify "$kept" --engine rtl --suite reciprocal --quiet
