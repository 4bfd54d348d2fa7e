#!/usr/bin/env bash
# Tries array.sbatch on a Slurm of one node, which it starts and stops: a soak in four tasks, of which one is requeued and one is killed and
# submitted again. The folders put together must be byte for byte what one run leaves. Then a sweep in three tasks likewise. As root; installs slurm-wlm and munge.
#   scripts/slurm/try.sh [--quadrille PROGRAM] [SOAK OPTIONS]    default: --units 40 --limit 20000 --machines 0
set -euo pipefail
source "$(dirname "$0")/../setup.sh"
packages=(slurm-wlm munge)
install_packages
options=("$@")
[ $# -gt 0 ] || options=(--units 40 --limit 20000 --machines 0)
work=$(mktemp -d)
node=scripts/slurm/one_node.sh
trap 'scancel --user=root 2>/dev/null; "$node" stop "$work/slurm"; rm -rf "$work"' EXIT
"$node" start "$work/slurm"
export SLURM_CONF=$work/slurm/slurm.conf

state() { squeue --noheader --array --states=all --format='%K %T' --job "$1" 2>/dev/null | sed -n "s/^$2 //p"; }
wait_for() {  # JOB TASK STATE…: at most ten minutes
  local job=$1 task=$2 i now=""
  shift 2
  for ((i = 0; i < 3000; ++i)); do
    now=$(state "$job" "$task")
    [[ " $* " == *" ${now:-gone} "* ]] && return
    sleep 0.2
  done
  echo "task $task is $now, not $*; $work/slurm has the logs" >&2
  exit 1
}
units() { find "$work/soak/$1/units" -name '*.json' 2>/dev/null | wc -l; }
some_units() {  # TASK: waits until it has done one, at most ten minutes
  local i
  for ((i = 0; i < 3000; ++i)); do [ "$(units "$1")" -gt 0 ] && return; sleep 0.2; done
  echo "task $1 did no unit" >&2
  exit 1
}
submit() { sbatch --parsable --output="$work/%a.log" --array="$1" scripts/slurm/array.sbatch scripts/soak.py "$work/soak" "${options[@]}"; }

job=$(submit 0-3)
some_units 0
before0=$(units 0)
scontrol requeue "${job}_0"
wait_for "$job" 0 PENDING
scontrol update JobId="${job}_0" StartTime=now  # or it waits two minutes
some_units 3  # the last to begin: at once, or it may be over
before3=$(units 3)
scancel --signal=KILL "${job}_3"
for task in 0 1 2 3; do wait_for "$job" $task COMPLETED CANCELLED FAILED gone; done
echo "requeued with $before0 of its units done, killed with $before3; units in the end: $(units 0) $(units 1) $(units 2) $(units 3)"
again=$(QUADRILLE_SHARDS=4 submit 3)
wait_for "$again" 3 COMPLETED FAILED
scripts/soak.py --merge "$work"/soak/? --out "$work/whole" | sed -n 1,2p
scripts/soak.py "${options[@]}" --jobs 1 --out "$work/one" >/dev/null
diff -r -x times.jsonl -x .lock "$work/one" "$work/whole"
echo "byte for byte what one run leaves"

program=build/release/quadrille
for ((i = 0; i + 1 < ${#options[@]}; ++i)); do [ "${options[i]}" = --quadrille ] && program=${options[i + 1]}; done
if "$program" sweep --help >/dev/null 2>&1; then
  grid=(sweep --scene bowtie --size 48x48 --cosim none --axis significand_bits=10:18 --axis align_guard_bits=0:2)
  job=$(sbatch --parsable --output="$work/sweep%a.log" --array=0-2 scripts/slurm/array.sbatch "$program" "$work/parts" "${grid[@]}")
  for task in 0 1 2; do wait_for "$job" $task COMPLETED FAILED gone; done
  "$program" "${grid[@]}" --quiet --merge "$work"/parts/? --out "$work/merged"
  "$program" "${grid[@]}" --quiet --out "$work/sweep"
  diff -r -x timing.csv -x stages.csv -x journal.jsonl "$work/sweep" "$work/merged"
  echo "a sweep in three tasks: byte for byte what one run leaves"
fi
