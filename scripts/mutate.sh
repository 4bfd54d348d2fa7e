#!/usr/bin/env bash
# Generates faults in every file of rtl/ and model/, builds them in, each selected at run time, and puts each through the checks
# (tb/mutants/README.md): a table of which check sees how many, and every survivor with file, line and change.
#   scripts/mutate.sh                   the draw that the tests sample
#   scripts/mutate.sh --count N         another number of mutants, half of them in the RTL
#   scripts/mutate.sh --seed S          another draw
#   scripts/mutate.sh --file F          those of one file: all that --count allows
#   scripts/mutate.sh --class C         those of one class: operator constant width sign index enable reset priority comparison
#   scripts/mutate.sh --jobs J          so many at a time (all processors)
#   scripts/mutate.sh --json FILE       keeps the results; stopped, the same command goes on (folder FILE.part)
#   scripts/mutate.sh --shard I/N --json PART      every N-th mutant, on one of N machines
#   tb/mutants/report_mutants.py --from PART… --json FILE      puts kept results together and prints the table
# Exit status: 0 each is seen by a check or argued equivalent in tb/mutants/equivalent.toml, 1 not, 2 usage, 3 a tool is missing.
set -euo pipefail
case "${1:-}" in -h | --help) sed -n '2,/^set/{/^set/d;s/^# \{0,1\}//;p}' "$0"; exit 0 ;; esac
caller=$PWD
draw=() report=()
while [ $# -gt 0 ]; do
  [ $# -ge 2 ] || { echo "mutate.sh: $1 needs a value, or is no option (--help)" >&2; exit 2; }
  case $1 in
    --count | --seed | --file | --class) draw+=("$1" "$2") ;;
    --json) case $2 in /*) report+=("$1" "$2") ;; *) report+=("$1" "$caller/$2") ;; esac ;;
    --jobs | --shard) report+=("$1" "$2") ;;
    *) echo "mutate.sh: no option $1 (--help)" >&2; exit 2 ;;
  esac
  shift 2
done
source "$(dirname "$0")/setup.sh"
python3 tb/mutants/generate_mutants.py /dev/null ${draw[@]+"${draw[@]}"} || exit 2
mkdir -p build
exec {lock}>build/.mutate.lock
flock "$lock"  # of several at a time, such as an array's tasks, one sets up and builds, and the others find it done
if [ ${#draw[@]} -eq 0 ]; then
  set_up mutate
  folder=build/release
else
  install_packages "${packages[@]}"
  folder=build/mutate  # another draw has its own copies: those of the tests stay as they are
  cmake -S . -B $folder -G Ninja -DCMAKE_BUILD_TYPE=Release -DQUADRILLE_MUTATE_OPTIONS="${draw[*]}" >/dev/null
  cmake --build $folder --target mutate -j "$(nproc)"
fi
exec {lock}>&-
exec tb/mutants/report_mutants.py $folder/tb/mutants ${report[@]+"${report[@]}"}
