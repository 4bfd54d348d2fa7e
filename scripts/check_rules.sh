#!/usr/bin/env bash
# A wrong configuration stops Verilator, Yosys and Icarus Verilog at elaboration, with the rule that it breaks: every rule of
# rtl/config_check.sv in every tool, and the whole machine once in each; the default passes.
#   scripts/check_rules.sh PATH_TO_QUADRILLE
set -euo pipefail
[ $# = 1 ] || { echo "usage: scripts/check_rules.sh PATH_TO_QUADRILLE" >&2; exit 2; }
quadrille=$(realpath "$1")
cd "$(dirname "$0")/../rtl"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
checks=0

# elaborate TOOL TOP TABLES DEFINE...: what the tool prints goes to $work/log, its status is the function's.
elaborate() {
  local tool=$1 top=$2 tables=$3
  shift 3
  local defines=("${@/#/-DQUADRILLE_}") files=(quadrille_pkg.sv "$tables" config_check.sv)
  [ "$top" = config_check ] || mapfile -t files < <(echo quadrille_pkg.sv; echo "$tables"; ls ./*.sv | grep -v _pkg.sv)
  case $tool in
    verilator) verilator --lint-only -Wno-lint ${defines[@]+"${defines[@]}"} --top-module "$top" "${files[@]}" ;;
    yosys) yosys -q -p "read_verilog -sv ${defines[*]-} ${files[*]}; hierarchy -check -top $top" ;;
    icarus) iverilog -g2012 -t null ${defines[@]+"${defines[@]}"} -s "$top" "${files[@]}" ;;
  esac >"$work/log" 2>&1
}

# passes TOP TABLES DEFINE...; refuses RULE TOP TABLES DEFINE...
passes() {
  for tool in "${tools[@]}"; do
    elaborate "$tool" "$@" || { cat "$work/log" >&2; echo "$tool refuses $*" >&2; exit 1; }
    checks=$((checks + 1))
  done
}
refuses() {
  local rule=$1
  shift
  for tool in "${tools[@]}"; do
    ! elaborate "$tool" "$@" || { echo "$tool takes $*; expected $rule" >&2; exit 1; }
    grep -qw "$rule" "$work/log" || { cat "$work/log" >&2; echo "$tool refuses $* without a word of $rule" >&2; exit 1; }
    checks=$((checks + 1))
  done
  echo "$rule" >>"$work/seen"
}

"$quadrille" config --quiet --emit-tables "$work/tables.sv" >/dev/null
tools=(verilator yosys icarus)
passes config_check "$work/tables.sv"
# A rule, and settings that break it first.
while read -r rule settings; do
  # shellcheck disable=SC2086
  refuses "$rule" config_check "$work/tables.sv" $settings
done <<'RULES'
viewport_bits_must_be_6_to_14 VIEWPORT_BITS=5
viewport_bits_must_be_6_to_14 VIEWPORT_BITS=15
guard_bits_must_be_1_to_4 GUARD_BITS=0
guard_bits_must_be_1_to_4 GUARD_BITS=5
subpixel_bits_must_be_2_to_8 SUBPIXEL_BITS=1
subpixel_bits_must_be_2_to_8 SUBPIXEL_BITS=9
homogeneous_frac_bits_must_be_4_to_10 HOMOGENEOUS_FRAC_BITS=3
homogeneous_frac_bits_must_be_4_to_10 HOMOGENEOUS_FRAC_BITS=11
quadratic_frac_bits_must_be_at_most_twice_the_fraction_bits QUADRATIC_FRAC_BITS=31
significand_bits_must_be_8_to_26 SIGNIFICAND_BITS=7
significand_bits_must_be_8_to_26 SIGNIFICAND_BITS=99
notch_exact_must_be_0_or_1 NOTCH_EXACT=2
notch_exact_must_be_0_or_1 NOTCH_EXACT=-1
sqrt_segments_log2_must_be_at_least_3_and_below_significand_bits SQRT_SEGMENTS_LOG2=2
sqrt_segments_log2_must_be_at_least_3_and_below_significand_bits SQRT_SEGMENTS_LOG2=18
recip_segments_log2_must_be_at_least_3_and_below_significand_bits RECIP_SEGMENTS_LOG2=2
recip_segments_log2_must_be_at_least_3_and_below_significand_bits RECIP_SEGMENTS_LOG2=18
sqrt_degree_must_be_1_or_2 SQRT_DEGREE=0
sqrt_degree_must_be_1_or_2 SQRT_DEGREE=3
recip_degree_must_be_1_or_2 RECIP_DEGREE=0
recip_degree_must_be_1_or_2 RECIP_DEGREE=3
align_guard_bits_must_be_0_to_6 ALIGN_GUARD_BITS=-1
align_guard_bits_must_be_0_to_6 ALIGN_GUARD_BITS=7
attribute_slots_must_be_1_to_8 ATTRIBUTE_SLOTS=0
attribute_slots_must_be_1_to_8 ATTRIBUTE_SLOTS=9
attribute_int_bits_must_be_1_to_15 ATTRIBUTE_INT_BITS=0
attribute_int_bits_must_be_1_to_15 ATTRIBUTE_INT_BITS=16
attribute_frac_bits_must_be_significand_bits_to_30 ATTRIBUTE_FRAC_BITS=17
attribute_frac_bits_must_be_significand_bits_to_30 ATTRIBUTE_FRAC_BITS=31
depth_bits_must_be_8_to_30 DEPTH_BITS=7
depth_bits_must_be_8_to_30 DEPTH_BITS=31
tile_log2_must_be_2_to_4 TILE_LOG2=1
tile_log2_must_be_2_to_4 TILE_LOG2=5
pixels_per_clock_must_be_1_2_or_4 PIXELS_PER_CLOCK=3
dot_units_must_be_2_or_4 DOT_UNITS=1
dot_units_must_be_2_or_4 DOT_UNITS=3
dot_units_must_be_2_or_4 DOT_UNITS=8
hierarchical_z_bits_must_be_0_or_4_to_16 HIERARCHICAL_Z_BITS=3
hierarchical_z_bits_must_be_0_or_4_to_16 HIERARCHICAL_Z_BITS=17
hierarchical_z_bits_must_be_at_most_depth_bits HIERARCHICAL_Z_BITS=12 DEPTH_BITS=10
hierarchical_z_tiles_log2_must_be_6_to_16 HIERARCHICAL_Z_TILES_LOG2=5
hierarchical_z_tiles_log2_must_be_6_to_16 HIERARCHICAL_Z_TILES_LOG2=17
plane_quads_must_be_0_or_1 PLANE_QUADS=2
plane_tolerance_bits_was_removed_plane_quads_takes_exactly_plane_ones PLANE_TOLERANCE_BITS=31
plane_quads_must_be_0_or_1 PLANE_QUADS=-1
quad_slots_log2_must_be_1_to_4 QUAD_SLOTS_LOG2=0
quad_slots_log2_must_be_1_to_4 QUAD_SLOTS_LOG2=5
tile_slots_log2_must_be_1_to_4 TILE_SLOTS_LOG2=0
tile_slots_log2_must_be_1_to_4 TILE_SLOTS_LOG2=5
stamp_fifo_log2_must_be_1_to_5 STAMP_FIFO_LOG2=0
stamp_fifo_log2_must_be_1_to_5 STAMP_FIFO_LOG2=6
performance_counters_must_be_0_or_1 PERFORMANCE_COUNTERS=-1
performance_counters_must_be_0_or_1 PERFORMANCE_COUNTERS=2
quad_id_bits_must_be_8_to_32 QUAD_ID_BITS=7
quad_id_bits_must_be_8_to_32 QUAD_ID_BITS=33
a_d_and_r2_must_fit_64_bits_fewer_viewport_guard_or_fraction_bits HOMOGENEOUS_FRAC_BITS=10
a_block_over_the_edge_of_the_viewport_must_not_overflow_smaller_tile_log2_or_more_guard_bits VIEWPORT_BITS=6 GUARD_BITS=1 TILE_LOG2=3
tables_must_be_of_this_significand_bits SIGNIFICAND_BITS=12
tables_must_be_of_this_sqrt_segments_log2 SQRT_SEGMENTS_LOG2=6
tables_must_be_of_this_sqrt_degree SQRT_DEGREE=1 SQRT_SEGMENTS_LOG2=5
tables_must_be_of_this_recip_segments_log2 RECIP_SEGMENTS_LOG2=7
tables_must_be_of_this_recip_degree RECIP_DEGREE=1 RECIP_SEGMENTS_LOG2=6
RULES

# No rule without a case.
missing=$(grep -oE '[a-z][a-z0-9_]+_[a-z0-9_]+\)$' config_check.sv | tr -d ')' | sort -u | grep -vxFf "$work/seen" || true)
[ -z "$missing" ] || { echo "rules without a case: $missing" >&2; exit 1; }

# Among the other modules, whose widths are nonsense then.
refuses significand_bits_must_be_8_to_26 quadrille "$work/tables.sv" SIGNIFICAND_BITS=99
echo "$checks elaborations, $(sort -u "$work/seen" | wc -l) rules"
