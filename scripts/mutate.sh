#!/usr/bin/env bash
# Puts the generated faults of RTL and model through the checks (tb/verify/faults/README.md). One build has them all, selected at run
# time. Prints which check sees how many, and each survivor with file, line and change.
#   scripts/mutate.sh                   all 330
#   scripts/mutate.sh --count N         so many, drawn by the seed, half of them in the RTL
#   scripts/mutate.sh --seed S          another draw
#   scripts/mutate.sh --file F          those of one file
#   scripts/mutate.sh --class C         those of one class: operator constant width sign index enable reset priority comparison
#   scripts/mutate.sh --jobs J          so many at a time (default: one per processor)
#   scripts/mutate.sh --json FILE       keeps the results; after a stop the same command resumes (folder FILE.part)
#   scripts/mutate.sh --shard I/N --json PART      every N-th mutant, on one of N machines
#   scripts/mutate.sh --record          tries every check in turn and writes what saw each to tb/verify/faults/caught_by.json
#   tb/verify/faults/report_mutants.py --from PART… --json FILE      merges kept results and prints the table
# Exit status: 0 each is seen by a check or argued equivalent, 1 not, 2 usage, 3 a tool is missing.
set -euo pipefail
case "${1:-}" in -h | --help) sed -n '2,/^set/{/^set/d;s/^# \{0,1\}//;p}' "$0"; exit 0 ;; esac
caller=$PWD
report=()
while [ $# -gt 0 ]; do
  if [ "$1" = --record ]; then report+=("$1"); shift; continue; fi
  [ $# -ge 2 ] || { echo "mutate.sh: $1 needs a value, or is no option (--help)" >&2; exit 2; }
  case $1 in
    --json) case $2 in /*) report+=("$1" "$2") ;; *) report+=("$1" "$caller/$2") ;; esac ;;
    --count | --seed | --file | --class | --jobs | --shard) report+=("$1" "$2") ;;
    *) echo "mutate.sh: no option $1 (--help)" >&2; exit 2 ;;
  esac
  shift 2
done
source "$(dirname "$0")/setup.sh"
mkdir -p build
exec {lock}>build/.mutate.lock
flock "$lock"  # of several at a time, such as an array's tasks, one sets up and builds, and the others find it done
set_up mutate
exec {lock}>&-
exec tb/verify/faults/report_mutants.py build/release/tb/verify/faults ${report[@]+"${report[@]}"}
