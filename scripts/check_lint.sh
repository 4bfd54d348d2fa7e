#!/usr/bin/env bash
# `verilator --lint-only -Wall` over rtl/, and over the machine with probes, for a spread of configurations; any warning fails.
#   scripts/check_lint.sh PATH_TO_QUADRILLE [--default]
# --default, for that tier of tests: only four configurations, which have every `generate` branch, and not the machine with probes, of
# which simulators are built with the same warnings.
set -euo pipefail
source "$(dirname "$0")/help.sh"
[ $# -gt 0 ] || { usage >&2; exit 2; }
quadrille=$(realpath "$1") default=${2:-}
cd "$(dirname "$0")/../rtl"
tables=$(mktemp -d)
trap 'rm -rf "$tables"' EXIT
count=0
"$quadrille" config --boundaries sv >"$tables/quadrille_probes_pkg.svh"
lint() {
  local sets=() defines=()
  for kv in "$@"; do
    sets+=(--set "$kv")
    local key=${kv%%=*}
    defines+=("-DQUADRILLE_${key^^}=${kv#*=}")
  done
  "$quadrille" config --quiet "${sets[@]}" --emit-tables "$tables/quadrille_tables_pkg.sv" >/dev/null
  local machine=(-Iinclude quadrille_pkg.sv "$tables/quadrille_tables_pkg.sv" $(ls ./*.sv | grep -v _pkg.sv))
  verilator --lint-only -Wall "${defines[@]}" --top-module quadrille "${machine[@]}"
  [ -n "$default" ] || verilator --lint-only -Wall "${defines[@]}" --top-module quadrille_probed -I"$tables" "${machine[@]}" ../tb/device/quadrille_probed.sv
  count=$((count + 1))
}
lint significand_bits=18
lint significand_bits=8 notch_exact=0 viewport_bits=8 hierarchical_z_bits=16 hierarchical_z_tiles_log2=16 attribute_slots=8 quad_slots_log2=1 \
  plane_quads=1 performance_counters=1
lint significand_bits=26 sqrt_degree=1 recip_degree=1 viewport_bits=14 guard_bits=1 tile_log2=4 hierarchical_z_bits=4 hierarchical_z_tiles_log2=6 \
  pixels_per_clock=2
lint significand_bits=12 tile_log2=2 attribute_slots=1 pixels_per_clock=4 quadratic_frac_bits=8 align_guard_bits=0 attribute_frac_bits=30 depth_bits=8 \
  dot_units=4 guard_bits=2 subpixel_bits=2 homogeneous_frac_bits=4 performance_counters=1
if [ -z "$default" ]; then
lint significand_bits=8 notch_exact=0
lint performance_counters=1
lint significand_bits=24 tile_log2=4 attribute_slots=8 pixels_per_clock=2
lint significand_bits=26 sqrt_degree=1 recip_degree=1
lint significand_bits=12 quadratic_frac_bits=8 align_guard_bits=0 attribute_frac_bits=30
lint significand_bits=16 viewport_bits=14 guard_bits=1 depth_bits=8
lint hierarchical_z_bits=12
lint plane_quads=1 performance_counters=1
lint significand_bits=8 attribute_slots=8 quad_slots_log2=1 plane_quads=1
lint significand_bits=26 attribute_slots=1 quad_slots_log2=4 dot_units=4 viewport_bits=8 guard_bits=2 subpixel_bits=2 homogeneous_frac_bits=4 tile_log2=2 plane_quads=1
lint significand_bits=8 attribute_slots=1 pixels_per_clock=2 plane_quads=1
lint significand_bits=8 viewport_bits=8 hierarchical_z_bits=16 hierarchical_z_tiles_log2=16
lint significand_bits=26 viewport_bits=14 guard_bits=1 tile_log2=4 hierarchical_z_bits=4 hierarchical_z_tiles_log2=6
fi
echo "$count configurations are lint-clean"
