#!/usr/bin/env bash
# Checks the model's lanes bit for bit where the other tests cannot: `lanes_test.sh clang` as Clang compiles them,
# `lanes_test.sh neon` as GCC does for aarch64, run by QEMU. Exit status: 0 same bits, 1 not, 2 usage.
set -euo pipefail
source "$(dirname "$0")/setup.sh"
case "${1:-}" in
  clang) packages=(clang) compiler=clang++ run=() ;;
  neon) packages=(g++-aarch64-linux-gnu qemu-user) compiler=aarch64-linux-gnu-g++ run=(qemu-aarch64) ;;
  *) sed -n '2,3s/^# //p' "$0" >&2; exit 2 ;;
esac
install_packages "${packages[@]}" libgtest-dev
out=$root/build/lanes_$1
rm -rf "$out"  # objects of files that are gone
mkdir -p "$out"
# The tests that compare lanes with the plain pipeline on every target, and what they need.
mapfile -t sources < <(git ls-files 'model/*.cpp' 'golden/scenes/*.cpp' | grep -v '_test\.cpp$\|^model/examples/\|^model/c_api/')
sources+=(model/pixel/pixel_engines_test.cpp model/fast/float_lanes_test.cpp model/fast/float_lanes_limits_test.cpp)
gtest=/usr/src/googletest/googletest
compile() { "$compiler" -std=gnu++20 -O2 -ffp-contract=off -frounding-math -Wno-psabi -I. -I"$gtest" -I"$gtest/include" -c "$1" -o "$out/$(tr / _ <<<"$1").o"; }
export -f compile
export compiler gtest out
printf '%s\n' "${sources[@]}" "$gtest/src/gtest-all.cc" "$gtest/src/gtest_main.cc" | xargs -P "$(nproc)" -I{} bash -ec 'compile {}'
"$compiler" -static "$out"/*.o -o "$out/lanes_test" 2>"$out/link.log" || { cat "$out/link.log" >&2; exit 1; }
"${run[@]}" "$out/lanes_test" --gtest_brief=1 || exit 1
