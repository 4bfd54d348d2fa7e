#!/usr/bin/env bash
# Fails unless each rule of rtl/quadrille_config_check.sv stops Verilator, Yosys and Icarus Verilog at elaboration with its text. The whole
# machine is tried once in each; the default configuration must pass.
#   scripts/check_rules.sh PATH_TO_QUADRILLE
set -euo pipefail
source "$(dirname "$0")/help.sh"
[ $# = 1 ] || { usage >&2; exit 2; }
quadrille=$(realpath "$1")
cd "$(dirname "$0")/../rtl"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
checks=0

# elaborate TOOL TOP TABLES DEFINE...: what the tool prints goes to $work/log, its status is the function's.
elaborate() {
  local tool=$1 top=$2 tables=$3
  shift 3
  local defines=("${@/#/-DQUADRILLE_}") files=(quadrille_pkg.sv "$tables" quadrille_config_check.sv)
  [ "$top" = quadrille_config_check ] || mapfile -t files < <(echo quadrille_pkg.sv; echo "$tables"; ls ./*.sv | grep -v _pkg.sv)
  case $tool in
    verilator) verilator --lint-only -Wno-lint -Iinclude ${defines[@]+"${defines[@]}"} --top-module "$top" "${files[@]}" ;;
    yosys) yosys -q -p "read_verilog -sv -Iinclude ${defines[*]-} ${files[*]}; hierarchy -check -top $top" ;;
    icarus) iverilog -g2012 -Iinclude -t null ${defines[@]+"${defines[@]}"} -s "$top" "${files[@]}" ;;
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
passes quadrille_config_check "$work/tables.sv"
# A rule, and settings that break it first: as listed, and of every other key just outside the program's range.
cat >"$work/rules" <<'RULES'
quadratic_frac_bits_must_be_at_most_twice_the_fraction_bits QUADRATIC_FRAC_BITS=31
sqrt_segments_log2_must_be_at_least_3_and_below_significand_bits SQRT_SEGMENTS_LOG2=2
sqrt_segments_log2_must_be_at_least_3_and_below_significand_bits SQRT_SEGMENTS_LOG2=18
recip_segments_log2_must_be_at_least_3_and_below_significand_bits RECIP_SEGMENTS_LOG2=2
recip_segments_log2_must_be_at_least_3_and_below_significand_bits RECIP_SEGMENTS_LOG2=18
attribute_frac_bits_must_be_significand_bits_to_30 ATTRIBUTE_FRAC_BITS=17
attribute_frac_bits_must_be_significand_bits_to_30 ATTRIBUTE_FRAC_BITS=31
pixels_per_clock_must_be_1_2_or_4 PIXELS_PER_CLOCK=3
dot_units_must_be_2_or_4 DOT_UNITS=3
hierarchical_z_bits_must_be_0_or_4_to_16 HIERARCHICAL_Z_BITS=3
hierarchical_z_bits_must_be_0_or_4_to_16 HIERARCHICAL_Z_BITS=17
hierarchical_z_bits_must_be_at_most_depth_bits HIERARCHICAL_Z_BITS=12 DEPTH_BITS=10
plane_tolerance_bits_was_removed_plane_quads_takes_exactly_plane_ones PLANE_TOLERANCE_BITS=31
a_d_and_r2_must_fit_64_bits_fewer_viewport_guard_or_fraction_bits HOMOGENEOUS_FRAC_BITS=10
a_block_over_the_edge_of_the_viewport_must_not_overflow_smaller_tile_log2_or_more_guard_bits VIEWPORT_BITS=6 GUARD_BITS=1 TILE_LOG2=3
tables_must_be_of_this_significand_bits SIGNIFICAND_BITS=12
tables_must_be_of_this_sqrt_segments_log2 SQRT_SEGMENTS_LOG2=6
tables_must_be_of_this_sqrt_degree SQRT_DEGREE=1 SQRT_SEGMENTS_LOG2=5
tables_must_be_of_this_recip_segments_log2 RECIP_SEGMENTS_LOG2=7
tables_must_be_of_this_recip_degree RECIP_DEGREE=1 RECIP_SEGMENTS_LOG2=6
RULES
"$quadrille" config --json - | python3 -c '
import json, sys
listed = open(sys.argv[1]).read()
for key in json.load(sys.stdin)["keys"]:
    name, low, high = key["name"], key["minimum"], key["maximum"]
    between = "to" if high > low + 1 else "or"
    for value in (low - 1, high + 1) if name + "_must_be_" not in listed else ():
        print(f"{name}_must_be_{low}_{between}_{high} {name.upper()}={value}")' "$work/rules" >"$work/ranges"
while read -r rule settings; do
  # shellcheck disable=SC2086
  refuses "$rule" quadrille_config_check "$work/tables.sv" $settings
done < <(cat "$work/rules" "$work/ranges")

# No rule without a case.
missing=$(grep -oP '  `QUADRILLE_REQUIRE\(\K[a-z0-9_]+' quadrille_config_check.sv | sort -u | grep -vxFf "$work/seen" || true)
[ -z "$missing" ] || { echo "rules without a case: $missing" >&2; exit 1; }

# Among the other modules, whose widths are nonsense then.
refuses significand_bits_must_be_8_to_26 quadrille "$work/tables.sv" SIGNIFICAND_BITS=99
echo "$checks elaborations, $(sort -u "$work/seen" | wc -l) rules"
