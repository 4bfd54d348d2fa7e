#!/usr/bin/env bash
# Tests of the model where the other tests cannot run:
#   lanes_test.sh clang   its lanes, bit for bit, as Clang compiles them
#   lanes_test.sh arm     all tests of the model and of the truth, and that generators make the same bytes, as GCC
#                         compiles them for aarch64, run by QEMU; without the slow ones
# Exit status: 0 passed, 1 not, 2 usage.
set -euo pipefail
source "$(dirname "$0")/help.sh"
source "$(dirname "$0")/setup.sh"
filter='*' reference=()
case "${1:-}" in
  clang)
    packages=(clang) compiler=clang++ run=()
    tests=(model/pixel/pixel_engines_test.cpp model/fast/float_lanes_test.cpp model/fast/float_lanes_limits_test.cpp)
    ;;
  arm)
    packages=(g++-aarch64-linux-gnu qemu-user) compiler=aarch64-linux-gnu-g++ run=(qemu-aarch64 -L /usr/aarch64-linux-gnu) reference=('golden/reference/*.cpp')
    # Minutes each under QEMU.
    filter='-TruthFilter.*:ExactCoverage.All*:Determinant.AgreesOn*:SnapExactly.*:SnapTies.*:CornerQuads.*:*.AllOfASmallGrid:*TenThousand*:CoverageRows.HoldEvery*:PaperFloat/*.AgreesWithTruth*'
    mapfile -t tests < <(git ls-files 'model/*_test.cpp' 'golden/reference/*_test.cpp' golden/scenes/{same_bytes,corner_boundaries,corner_values}_test.cpp |
      grep -v '^model/\(page\|python\|c_api\)/\|invariants_test\|key_traits_test')  # these need more than GoogleTest
    ;;
  *) usage >&2; exit 2 ;;
esac
install_packages "${packages[@]}" libgtest-dev
out=$root/build/lanes_$1
rm -rf "$out"  # objects of files that are gone
mkdir -p "$out"
mapfile -t sources < <(git ls-files 'model/*.cpp' 'golden/scenes/*.cpp' "${reference[@]}" |
  grep -v '_test\.cpp$\|^model/\(examples\|c_api\|page\|python\)/')
sources+=("${tests[@]}")
gtest=/usr/src/googletest/googletest
compile() { "$compiler" -std=gnu++20 -O2 -ffp-contract=off -frounding-math -Wno-psabi -I. -I"$gtest" -I"$gtest/include" -DQUADRILLE_SOURCE_DIR="\"$root\"" -c "$1" -o "$out/$(tr / _ <<<"$1").o"; }
export -f compile
export compiler gtest out root
printf '%s\n' "${sources[@]}" "$gtest/src/gtest-all.cc" "$gtest/src/gtest_main.cc" | xargs -P "$(nproc)" -I{} bash -ec 'compile {}'
"$compiler" "$out"/*.o -o "$out/lanes_test" 2>"$out/link.log" || { cat "$out/link.log" >&2; exit 1; }
export GTEST_TOTAL_SHARDS=$((8 * $(nproc)))  # a crash of one ends none of the others
seq 0 $((GTEST_TOTAL_SHARDS - 1)) | xargs -P "$(nproc)" -I{} \
  env GTEST_SHARD_INDEX={} sh -c '"$@" || exit 1' run "${run[@]}" "$out/lanes_test" --gtest_brief=1 --gtest_filter="$filter" || exit 1
