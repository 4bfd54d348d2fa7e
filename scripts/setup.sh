#!/usr/bin/env bash
# Sets up what the other scripts need: packages, configuration, build. Works on a bare Debian 12: as root, through sudo,
# or by printing the one line to run. Sourced by the others; run by itself it builds the programs with the studies.

set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
cd "$root"
[ "${BASH_SOURCE[0]}" != "$0" ] || source scripts/help.sh

core_packages=(
  g++ cmake ninja-build verilator   # the build, and simulators on demand
  libopenexr-dev libpng-dev zlib1g-dev libssl-dev libcli11-dev nlohmann-json3-dev libtomlplusplus-dev
)
packages=(
  "${core_packages[@]}"
  make yosys iverilog          # replay of golden vectors, synthesis and round trip
  z3                           # scripts/prove.py
  opensta                      # scripts/timing.py: static timing
  libgtest-dev librapidcheck-dev
  pkg-config libcairo2-dev fonts-dejavu-core   # contact sheets of quadrille compare
  libassimp-dev                # meshes in PLY, OFF and glTF
  libegl1-mesa-dev libgl1-mesa-dri libepoxy-dev   # the engine shader: OpenGL without a window, in software
  clang-format                 # the format test
  python3 python3-matplotlib python3-plotly python3-yaml   # scripts/*.py; plots of scripts/sweep_report.py; lists of the RTL's files
  python3-numpy                # the example of the library in Python
)
# The standard cells of scripts/timing.py, which Debian 13 lacks: it says so there.
[ "$(. /etc/os-release && echo "${VERSION_CODENAME:-}")" = trixie ] || packages+=(qflow-tech-osu018)

page_packages=(nodejs chromium python3-venv)   # model/page
command -v npm >/dev/null || page_packages+=(npm)   # other packages of nodejs bring it

# install_packages PACKAGE...
install_packages() {
  local missing=() p
  for p in "$@"; do
    [ "$(dpkg-query -W -f='${db:Status-Status}' "$p" 2>/dev/null)" = installed ] || missing+=("$p")
  done
  [ ${#missing[@]} -eq 0 ] && return
  local run=()
  if [ "$(id -u)" -ne 0 ]; then
    if command -v sudo >/dev/null; then
      run=(sudo)
    else
      echo "These packages are missing. As root, run:" >&2
      echo "  apt-get update && apt-get install -y --no-install-recommends ${missing[*]}" >&2
      exit 3
    fi
  fi
  echo "Installing: ${missing[*]}"
  "${run[@]}" apt-get update -q || exit 3
  "${run[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -q -y --no-install-recommends "${missing[@]}" || exit 3
}

# configure_and_build OPTIONS TARGET...: build/release, without targets all of it; OPTIONS are cmake's, one word.
# A program that is a link was built elsewhere: scripts/run_readme.py gives its clones one.
configure_and_build() {
  local options=$1
  shift
  [ ! -L "$root/build/release/quadrille" ] || return 0
  cmake --preset release $options >"$root/.configure.log" 2>&1 || { cat "$root/.configure.log" >&2; exit 1; }
  rm -f "$root/.configure.log"
  cmake --build --preset release -j "$(nproc)" ${1:+--target "$@"}
}

# The main job alone. What a build folder was configured for before, it stays.
set_up_core() {
  local options="-DQUADRILLE_BUILD_STUDIES=OFF -DQUADRILLE_BUILD_TESTS=OFF"
  [ ! -e "$root/build/release/CMakeCache.txt" ] || options=""
  install_packages "${core_packages[@]}"
  configure_and_build "$options" quadrille
}

# set_up TARGET...: all packages, and these targets; without any everything.
set_up() {
  install_packages "${packages[@]}"
  configure_and_build "-DQUADRILLE_BUILD_STUDIES=ON -DQUADRILLE_BUILD_TESTS=ON" "$@"
}

[ "${BASH_SOURCE[0]}" != "$0" ] || set_up quadrille quadrille-studies
