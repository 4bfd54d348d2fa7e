#!/usr/bin/env bash
# Runs generated mutants of RTL and model through the checks
# (tb/verify/faults/README.md). Prints how many each check sees, and survivors.
#   scripts/mutate.sh --count 20
#   scripts/mutate.sh --json FILE       after a stop the same command resumes
#   tb/verify/faults/report_mutants.py --from PART… --json FILE
# Options (default: all mutants):
#   --count N, --seed S   N mutants drawn by the seed, half of them in the RTL
#   --file F, --class C   those of a file; of a class (operator constant width
#                         sign index enable reset priority comparison)
#   --shard I/N           every N-th mutant
#   --jobs J              parallel mutants (default: processors)
#   --record              every check; writes tb/verify/faults/caught_by.json
# Exit status: 0 all seen or argued equivalent, 1 not, 2 usage error,
# 3 missing tool.
set -euo pipefail
source "$(dirname "$0")/help.sh"
caller=$PWD
report=()
while [ $# -gt 0 ]; do
  if [ "$1" = --record ]; then report+=("$1"); shift; continue; fi
  [ $# -ge 2 ] || { echo "mutate.sh: $1: unknown option or no value; --help lists options" >&2; exit 2; }
  case $1 in
    --json) case $2 in /*) report+=("$1" "$2") ;; *) report+=("$1" "$caller/$2") ;; esac ;;
    --count | --seed | --file | --class | --jobs | --shard) report+=("$1" "$2") ;;
    *) echo "mutate.sh: unknown option $1; --help lists options" >&2; exit 2 ;;
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
