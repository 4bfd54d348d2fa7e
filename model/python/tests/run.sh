#!/usr/bin/env bash
# The tier `scripts/test.sh --python`: builds the wheel, installs it into a fresh environment under build/python and runs
# its tests through ctest. What it needs besides Debian's packages comes from PyPI. Arguments go to ctest.
set -euo pipefail
source "$(dirname "$0")/../../../scripts/help.sh"
source "$(dirname "$0")/../../../scripts/setup.sh"
install_packages g++ make cmake ninja-build iverilog libassimp-dev perl python3 python3-dev python3-venv
folder=$root/build/python
rm -rf "$folder"/{environment,wheel}
python3 -m venv "$folder/environment"
export PIP_DISABLE_PIP_VERSION_CHECK=1 PIP_NO_INPUT=1
echo "Building the wheel: about two minutes on two cores, the first time"
# With what test_speed.py compares with.
"$folder/environment/bin/pip" wheel -q --no-deps -w "$folder/wheel" -C "build.targets=quadrille_python;python_draw_time" "$root"
"$folder/environment/bin/pip" install -q "$folder"/wheel/quadrille-*.whl -r model/python/tests/requirements.txt
export QUADRILLE_DRAW_TIME
QUADRILLE_DRAW_TIME=$(ls -t "$folder"/cp*/model/python/python_draw_time | head -n 1)
echo "Build: $SECONDS s"
cmake -S model/python/tests -B "$folder/tests" -DPYTHON="$folder/environment/bin/python" >"$folder/tests.log" ||
  { cat "$folder/tests.log" >&2; exit 1; }
status=0
# From a folder without the sources, so that what is tested is what is installed.
cd "$folder/tests"
ctest --output-on-failure --no-tests=error --no-label-summary -L '^python$' -j "$(nproc)" "$@" | tee run.log || status=$?
echo "Tier python, $SECONDS s with the build"
grep -E '^[0-9]+% tests passed' run.log || true
exit "$status"
