#!/usr/bin/env bash
# Simulates the machine between AXI4-Stream interfaces on the kept golden vectors, with and without backpressure; nothing but rtl/ and
# those vectors is needed. Then with each of two faults in a copy of the wrapper, which the bench must find.
#   rtl/axi4_stream/run.sh [verilator|icarus] [PIXELS_PER_CLOCK]     the fragments are the same with 1, 2 and 4 pixels a clock
# Exit status: 0 all agree and the faults were found, 1 otherwise, 2 usage, 3 a missing tool.
set -euo pipefail
simulator=${1:-verilator} lanes=${2:-1}
case $simulator in
  verilator) tool=verilator ;;
  icarus) tool=iverilog ;;
  *) sed -n '2,5s/^# \{0,1\}//p' "$0" >&2; exit 2 ;;
esac
case $lanes in
  1 | 2 | 4) ;;
  *) echo "$lanes pixels per clock: 1, 2 or 4" >&2; exit 2 ;;
esac
command -v $tool >/dev/null || { echo "$tool is missing; on Debian: apt-get install $tool" >&2; exit 3; }
here=$(cd "$(dirname "$0")" && pwd)
set=$here/../../golden/vectors/kept/machine
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

lines() { wc -l <"$set/$1"; }
plusargs=("+set=$set" "+draws=$(lines states.hex)" "+beats=$(lines stimulus.hex)" "+fragments=$(lines response.hex)")

mapfile -t rtl < <(sed "/^[/+]/d; s|^|$here/../|" "$here/../quadrille.f")
# build NAME WRAPPER: the bench around that wrapper as $work/NAME.
build() {
  local log=$work/$1.log
  case $simulator in
    verilator) verilator --binary --assert -Wall -Wno-BLKSEQ "-DQUADRILLE_PIXELS_PER_CLOCK=$lanes" -CFLAGS -O1 --top-module axi4_stream_bench --Mdir "$work/$1.obj" -o "$work/$1" \
      -F "$here/../quadrille.f" "$2" "$here/axi4_stream_bench.sv" ;;
    icarus) iverilog -g2012 -I"$here/../include" "-DQUADRILLE_PIXELS_PER_CLOCK=$lanes" -s axi4_stream_bench -o "$work/$1" "${rtl[@]}" "$2" "$here/axi4_stream_bench.sv" ;;
  esac >"$log" 2>&1 || { tail -25 "$log" >&2; echo "the bench does not build" >&2; exit 1; }
}

# run NAME [FAULT]: the status is the bench's. ($fatal ends in abort(), which the shell would report.)
run() {
  local command=("$work/$1" "${plusargs[@]}" ${2:+"+$2"})
  [ $simulator = verilator ] || command=(vvp -N "${command[@]}")
  { "${command[@]}" >"$work/$1.out" 2>&1; } 2>/dev/null
}

build bench "$here/quadrille_axi4_stream.sv"
if ! run bench || [ "$(grep -c '^axi4_stream: .*, 0 mismatches$' "$work/bench.out")" != 2 ]; then
  cat "$work/bench.out" >&2
  exit 1
fi
grep '^axi4_stream:' "$work/bench.out"

# The faults, chosen as the bench runs: a draw ends when its last vertex was taken, not when the machine is idle; no flush behind it.
sed -e 's/DRAIN: if (!busy/DRAIN: if (($test$plusargs("early_end") != 0 || !busy)/' \
  -e 's/\.flush_i(step_q == DRAIN)/.flush_i(step_q == DRAIN \&\& $test$plusargs("no_flush") == 0)/' \
  "$here/quadrille_axi4_stream.sv" >"$work/quadrille_axi4_stream.sv"
if [ "$(diff "$here/quadrille_axi4_stream.sv" "$work/quadrille_axi4_stream.sv" | grep -c '^>')" != 2 ]; then
  echo "the faults are not in the copy of the wrapper" >&2
  exit 1
fi
build broken "$work/quadrille_axi4_stream.sv"
for fault in early_end no_flush; do
  case $fault in
    early_end) seen='^axi4_stream: fragment' ;;
    no_flush) seen='nothing moves in draw' ;;
  esac
  if run broken $fault || ! grep -q "$seen" "$work/broken.out"; then
    cat "$work/broken.out" >&2
    echo "the fault $fault was not found" >&2
    exit 1
  fi
  echo "with the fault $fault: $(grep -m 1 "$seen" "$work/broken.out")"
done
