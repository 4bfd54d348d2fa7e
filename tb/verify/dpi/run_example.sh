#!/usr/bin/env bash
# Builds example_bench.sv with Verilator and runs it; then builds it around an sqrt with a fault, which the bench must find.
#   tb/verify/dpi/run_example.sh LIBRARY QUADRILLE [KEY=VALUE]...     libquadrille_dpi.so, the program, a configuration
# Exit status: 0 the RTL agrees with the model and the fault was found, 1 otherwise, 2 usage, 3 no Verilator.
set -euo pipefail
source "$(dirname "$0")/../../../scripts/help.sh"
if [ $# -lt 2 ]; then
  usage >&2
  exit 2
fi
command -v verilator >/dev/null || { echo "verilator is missing; on Debian: apt-get install verilator" >&2; exit 3; }
library=$(realpath "$1")
quadrille=$(realpath "$2")
shift 2
here=$(cd "$(dirname "$0")" && pwd)
rtl=$here/../../../rtl
vectors=20000

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
sets=() defines=()
for kv in "$@"; do
  key=${kv%%=*}
  sets+=(--set "$kv")
  defines+=("-DQUADRILLE_${key^^}=${kv#*=}")
done
"$quadrille" config --quiet ${sets[@]+"${sets[@]}"} --emit-tables "$work/quadrille_tables_pkg.sv" >/dev/null

# build NAME SQRT: the bench around that file as $work/NAME/bench.
build() {
  if ! verilator --binary -Wall -Wno-UNUSEDPARAM -Wno-BLKSEQ -CFLAGS -O1 --top-module example_bench --Mdir "$work/$1" -o bench \
      ${defines[@]+"${defines[@]}"} -I"$rtl/include" "$rtl/quadrille_pkg.sv" "$work/quadrille_tables_pkg.sv" "$rtl/quadrille_delay_line.sv" \
      "$rtl/quadrille_table_polynomial.sv" "$2" "$here/quadrille_dpi_pkg.sv" "$here/example_bench.sv" \
      "$library" -LDFLAGS "-Wl,-rpath,$(dirname "$library")" >"$work/$1.log" 2>&1; then
    tail -25 "$work/$1.log" >&2
    echo "the bench does not build" >&2
    exit 1
  fi
}

# run NAME: its output in $work/NAME.out; the status is the bench's. ($fatal ends in abort(), which the shell would report.)
run() {
  { "$work/$1/bench" "+settings=$settings" "+vectors=$vectors" >"$work/$1.out" 2>&1; } 2>/dev/null
}
settings="$*"

build rtl "$rtl/quadrille_sqrt.sv"
if ! run rtl || ! grep -qx "sqrt: $vectors vectors, 0 mismatches" "$work/rtl.out"; then
  cat "$work/rtl.out" >&2
  exit 1
fi
grep '^sqrt:' "$work/rtl.out"

# The fault: every power of two counts as a power of four. Only significands without fraction show it.
sed "s/sqrt_rom({exp_i\[0\],/sqrt_rom({exp_i[0] \&\& sig_i[S-2:0] != '0,/" "$rtl/quadrille_sqrt.sv" >"$work/quadrille_sqrt.sv"
if cmp -s "$rtl/quadrille_sqrt.sv" "$work/quadrille_sqrt.sv"; then
  echo "the fault is not in the copy of quadrille_sqrt.sv" >&2
  exit 1
fi
build broken "$work/quadrille_sqrt.sv"
if run broken || ! grep -qE "^sqrt: $vectors vectors, [1-9][0-9]* mismatches$" "$work/broken.out"; then
  cat "$work/broken.out" >&2
  echo "the fault was not found" >&2
  exit 1
fi
echo "with a fault: $(grep '^sqrt:' "$work/broken.out")"
