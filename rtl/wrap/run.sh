#!/usr/bin/env bash
# Simulates quadrille_axi4 on the kept golden vectors, with and without back-pressure. Under Verilator with one pixel a
# clock also with each recorded fault of the wrapper (tb/verify/faults), which the bench must find.
#   rtl/wrap/run.sh [verilator|icarus] [PIXELS_PER_CLOCK]     the fragments are the same with 1, 2 and 4 pixels a clock
# QUADRILLE_TEST_SEED: seed of the pauses (default: 1)
# Exit status: 0 all agree and the faults were found, 1 otherwise, 2 usage, 3 a missing tool.
set -euo pipefail
source "$(dirname "$0")/../../scripts/help.sh"
simulator=${1:-verilator} lanes=${2:-1} seed=${QUADRILLE_TEST_SEED:-1}
case $simulator in
  verilator) tool=verilator ;;
  icarus) tool=iverilog ;;
  *) usage >&2; exit 2 ;;
esac
case $lanes in
  1 | 2 | 4) ;;
  *) echo "$lanes pixels per clock: 1, 2 or 4" >&2; exit 2 ;;
esac
command -v $tool >/dev/null || { echo "$tool is missing; on Debian: apt-get install $tool" >&2; exit 3; }
here=$(cd "$(dirname "$0")" && pwd)
rtl=$(dirname "$here") registry=$here/../../tb/verify/faults
set=$here/../../golden/vectors/kept/machine
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

lines() { wc -l <"$set/$1"; }
plusargs=("+set=$set" "+draws=$(lines states.hex)" "+beats=$(lines stimulus.hex)" "+fragments=$(lines response.hex)" "+seed=$seed")

faults=()
wrapper=$here
if [ "$simulator $lanes" = "verilator 1" ]; then
  python3 "$registry/select_mutants.py" "$work/faulty" wrap
  wrapper=$work/faulty/rtl/wrap
  faults+=("$work/faulty/rtl/quadrille_mutant_pkg.sv")
  # As it is, the wrapper has no warnings; with faults it may.
  verilator --lint-only -Wall -F "$rtl/quadrille.f" "$here"/*_pkg.sv $(ls "$here"/quadrille_*.sv | grep -v _pkg) --top-module quadrille_axi4
fi
mapfile -t sources < <(printf '%s\n' "$wrapper"/*_pkg.sv; ls "$wrapper"/quadrille_*.sv | grep -v _pkg; printf '%s\n' "$here"/wrap_*.sv)
case $simulator in
  verilator) verilator --binary --assert -Wno-fatal "-DQUADRILLE_PIXELS_PER_CLOCK=$lanes" -CFLAGS -O1 --top-module wrap_bench --Mdir "$work/obj" -o "$work/bench" \
    -F "$rtl/quadrille.f" ${faults[@]+"${faults[@]}"} "${sources[@]}" ;;
  icarus)
    mapfile -t machine < <(sed "/^[/+]/d; s|^|$rtl/|" "$rtl/quadrille.f")
    iverilog -g2012 -I"$rtl/include" "-DQUADRILLE_PIXELS_PER_CLOCK=$lanes" -s wrap_bench -o "$work/bench" "${machine[@]}" "${sources[@]}" ;;
esac >"$work/build.log" 2>&1 || { tail -25 "$work/build.log" >&2; echo "the bench does not build" >&2; exit 1; }

# run [FAULT]: the status is the bench's. ($fatal ends in abort(), which the shell would report.)
run() {
  local command=("$work/bench" "${plusargs[@]}")
  [ $simulator = verilator ] || command=(vvp -N "${command[@]}")
  { QUADRILLE_MUTANT=${1:-0} "${command[@]}" >"$work/out" 2>&1; } 2>/dev/null
}

if ! run || [ "$(grep -c '^wrap: .*, 0 mismatches$' "$work/out")" != 2 ]; then
  cat "$work/out" >&2
  exit 1
fi
grep '^wrap:' "$work/out"

[ ${#faults[@]} -gt 0 ] || exit 0
while read -r name number; do
  if run "$number" || ! seen=$(grep -m 1 -E '^wrap: [0-9]+: |Assertion failed' "$work/out"); then
    cat "$work/out" >&2
    echo "the fault $name was not found" >&2
    exit 1
  fi
  echo "with the fault $name: ${seen##*/}"
done < <(python3 "$registry/faults.py" wrap)
