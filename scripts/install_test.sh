#!/usr/bin/env bash
# Installs from a build directory: all that was built, then the program alone. Runs what was installed.
#   scripts/install_test.sh BUILD-DIRECTORY
set -euo pipefail
source "$(dirname "$0")/help.sh"
[ $# = 1 ] || { usage >&2; exit 2; }
build=$(cd "$1" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

fail() { echo "install_test: $1" >&2; exit 1; }

# Only the program: the scripts of the installation, looking for what was built in a directory that has nothing else.
mkdir -p "$work/partial"
(cd "$build" && find . \( -name cmake_install.cmake -o -name 'Quadrille*.cmake' -o -path "./include/quadrille/*.h" \) -print0 | tar -c --null -T -) | tar -x -C "$work/partial"
find "$work/partial" -name cmake_install.cmake -exec sed -i "s|$build|$work/partial|g" {} +
cp "$build/quadrille" "$work/partial/"

cmake --install "$build" --prefix "$work/all" >"$work/log" 2>&1 || { cat "$work/log" >&2; fail "cmake --install failed"; }
cmake -DCMAKE_INSTALL_PREFIX="$work/program" -P "$work/partial/cmake_install.cmake" >"$work/log" 2>&1 ||
  { cat "$work/log" >&2; fail "installing the program alone failed"; }

# Whatever was built is there.
[ ! -e "$build/tb/verify/dpi/libquadrille_dpi.so" ] || [ -n "$(find "$work/all" -name libquadrille_dpi.so)" ] ||
  fail "libquadrille_dpi.so was built but not installed"
[ -z "$(find "$work/program" -name libquadrille_dpi.so)" ] || fail "a library was installed that was not built"

for prefix in "$work/all" "$work/program"; do
  share=$prefix/share/quadrille
  for file in rtl/quadrille.sv tb/device/device_glue.cpp tb/device/device_trace.h dpi/quadrille_dpi_pkg.sv scripts/compare_plot.py; do
    [ -e "$share/$file" ] || fail "$file is missing in $prefix"
  done
  # Run without the source tree's data: the installed ones come first (tb/support/source_paths.hpp).
  (cd "$work" && "$prefix/bin/quadrille" cosim --scene bowtie --size 48x48 --no-alone >"$work/log" 2>&1) ||
    { cat "$work/log" >&2; fail "$prefix/bin/quadrille does not co-simulate"; }
  grep -q '^OK' "$work/log" || fail "no OK from $prefix/bin/quadrille"
done
echo "installed and run: everything, and the program alone"
