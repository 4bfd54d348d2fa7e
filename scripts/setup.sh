# Sourced by the other scripts: installs what is missing, configures and builds the release preset.
# Works on a bare Debian 12: as root, through sudo, or by printing the one line to run.

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
cd "$root"

packages=(
  g++ make cmake ninja-build   # the build, and simulators on demand; make builds those of the replay benches
  verilator yosys iverilog     # RTL simulation, synthesis and round trip, replay of golden vectors
  z3                           # scripts/prove.py
  opensta qflow-tech-osu018    # scripts/timing.py: static timing, and the standard cells that it times
  libgtest-dev librapidcheck-dev libopenexr-dev libpng-dev zlib1g-dev libssl-dev libcli11-dev nlohmann-json3-dev libtomlplusplus-dev
  pkg-config libcairo2-dev fonts-dejavu-core   # contact sheets of quadrille compare
  libegl1-mesa-dev libgl1-mesa-dri libepoxy-dev   # the engine shader: OpenGL without a window, in software
  clang-format                 # the format test
  python3 python3-matplotlib python3-plotly python3-yaml   # scripts/*.py; plots of scripts/sweep_report.py; lists of the RTL's files
  python3-numpy                # the example of the library in Python
)

install_packages() {
  local missing=() p
  for p in "${packages[@]}"; do
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

# build PRESET [TARGET]. A program that is a link was built elsewhere: scripts/run_readme.py gives its clones one.
build() {
  [ ! -L "$root/build/$1/quadrille" ] || return 0
  cmake --preset "$1" >"$root/.configure.log" 2>&1 || { cat "$root/.configure.log" >&2; exit 1; }
  rm -f "$root/.configure.log"
  cmake --build --preset "$1" -j "$(nproc)" ${2:+--target "$2"}
}
