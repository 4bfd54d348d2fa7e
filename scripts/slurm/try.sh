#!/usr/bin/env bash
# Tries array.sbatch on a Slurm of one node, which it starts and stops. Of a soak and a sweep one task is requeued, and one is killed and
# submitted again. What was done by then must stay untouched, and the merged results must have the bytes of one run. Then a task of
# golden vectors is requeued after its end. Needs root; installs slurm-wlm and munge; takes minutes.
#   scripts/slurm/try.sh [--quadrille PROGRAM] [SOAK OPTIONS]    default: --units 40 --limit 20000 --machines 0
set -euo pipefail
source "$(dirname "$0")/../help.sh"
source "$(dirname "$0")/../setup.sh"
packages=(slurm-wlm munge)
install_packages
options=("$@")
[ $# -gt 0 ] || options=(--units 40 --limit 20000 --machines 0)
work=$(mktemp -d)
node=scripts/slurm/one_node.sh
export SLURM_CONF=$work/slurm/slurm.conf  # first: no job of another cluster is touched
trap 'scancel --user=root 2>/dev/null || true; "$node" stop "$work/slurm" || true; rm -rf "$work"' EXIT
"$node" start "$work/slurm"

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
program=build/release/quadrille
for ((i = 0; i + 1 < ${#options[@]}; ++i)); do [ "${options[i]}" = --quadrille ] && program=${options[i + 1]}; done

submit() {  # TASKS LOG COMMAND DIR OPTIONS…
  local tasks=$1 log=$2
  shift 2
  sbatch --parsable --output="$work/$log%a.log" --array="$tasks" scripts/slurm/array.sbatch "$@"
}
units() { find "$1/units" -name '[0-9]*.json' 2>/dev/null | wc -l; }
journal() { cat "${1%/*}/.part.${1##*/}/journal.jsonl" 2>/dev/null || cat "$1/journal.jsonl" 2>/dev/null; }
batches() { journal "$1" | wc -l; }  # and a line before the first
until_some() {  # COUNT DIR N: COUNT says how many DIR has; waits until it has N, at most ten minutes
  local i
  for ((i = 0; i < 6000; ++i)); do [ "$("$1" "$2")" -ge "$3" ] && return; sleep 0.1; done
  echo "$2: no result" >&2
  exit 1
}
requeue() {  # JOB TASK
  scontrol requeue "$1_$2"
  wait_for "$1" "$2" PENDING
  scontrol update JobId="$1_$2" StartTime=now  # or it waits two minutes
}
over() {  # JOB TASK…
  local job=$1 task
  shift
  for task in "$@"; do wait_for "$job" "$task" COMPLETED CANCELLED FAILED NODE_FAIL gone; done
}
untouched() {  # NAME DIR: notes which units are done; with a note, all in it must be as they were
  local now=$work/$1.now
  find "$2/units" -name '[0-9]*.json' -printf '%f %T@ %i\n' | sort >"$now"
  if [ ! -e "$work/$1.before" ]; then mv "$now" "$work/$1.before"; return; fi
  [ -s "$work/$1.before" ] && [ -z "$(comm -23 "$work/$1.before" "$now")" ] || { echo "$2: units that were done before are done again" >&2; exit 1; }
  [ "$(wc -l <"$work/$1.before")" -lt "$(wc -l <"$now")" ] || { echo "$2: was done before it was stopped, which tries nothing" >&2; exit 1; }
}
continues() {  # NAME DIR: the same of a journal, of which what was there must be the beginning
  if [ ! -e "$work/$1.before" ]; then journal "$2" >"$work/$1.before"; return; fi
  [ "$(wc -l <"$work/$1.before")" -ge 2 ] || { echo "$2: nothing was done before it was stopped" >&2; exit 1; }
  journal "$2" | cmp -n "$(stat -c %s "$work/$1.before")" "$work/$1.before" - || { echo "$2: points that were done before are done again" >&2; exit 1; }
  [ "$(wc -l <"$work/$1.before")" -lt "$(batches "$2")" ] || { echo "$2: was done before it was stopped, which tries nothing" >&2; exit 1; }
}
stopped() { scancel --signal=KILL --full "$1_$2"; over "$1" "$2"; }  # JOB TASK

# A soak in four tasks; two run at a time.
soak=$work/soak
job=$(submit 0-3 soak scripts/soak.py "$soak" "${options[@]}")
until_some units "$soak/0" 1
requeue "$job" 0
untouched soak0 "$soak/0"
until_some units "$soak/3" 1  # the last to begin
stopped "$job" 3
untouched soak3 "$soak/3"
over "$job" 0 1 2
again=$(QUADRILLE_SHARDS=4 submit 3 again scripts/soak.py "$soak" "${options[@]}")
over "$again" 3
echo "a soak: requeued with $(wc -l <"$work/soak0.before") units done, killed with $(wc -l <"$work/soak3.before"); in the end: $(for i in 0 1 2 3; do units "$soak/$i"; done | xargs)"
untouched soak0 "$soak/0"
untouched soak3 "$soak/3"
scripts/soak.py --merge "$soak"/? --out "$work/whole" | sed -n 1,2p
scripts/soak.py "${options[@]}" --out "$work/one" >/dev/null
diff -r -x times.jsonl -x '.lock*' "$work/one" "$work/whole"
echo "a soak in four tasks: byte for byte what one run leaves"

if "$program" sweep --help >/dev/null 2>&1; then
  grid=(sweep --scene sphere --size 512x512 --cosim none --axis significand_bits=10:18 --axis align_guard_bits=0:4 --axis subpixel_bits=4:8)
  job=$(submit 0-2 sweep "$program" "$work/parts" "${grid[@]}")
  until_some batches "$work/parts/0" 2
  requeue "$job" 0
  continues sweep0 "$work/parts/0"
  until_some batches "$work/parts/1" 2
  stopped "$job" 1
  continues sweep1 "$work/parts/1"
  again=$(QUADRILLE_SHARDS=3 submit 1 again "$program" "$work/parts" "${grid[@]}")
  over "$job" 0 2
  over "$again" 1
  continues sweep0 "$work/parts/0"
  continues sweep1 "$work/parts/1"
  "$program" "${grid[@]}" --quiet --merge "$work"/parts/? --out "$work/merged"
  "$program" "${grid[@]}" --quiet --out "$work/sweep"
  diff -r -x timing.csv -x stages.csv -x journal.jsonl "$work/sweep" "$work/merged"
  echo "a sweep: requeued with $(($(wc -l <"$work/sweep0.before") - 1)) batches done, killed with $(($(wc -l <"$work/sweep1.before") - 1)); byte for byte what one run leaves"
fi
if "$program" golden generate --help >/dev/null 2>&1; then
  vectors=(golden generate --limit 100)
  job=$(submit 0-1 golden "$program" "$work/vectors" "${vectors[@]}")
  over "$job" 0 1
  before=$(find "$work/vectors/0" -printf '%p %T@\n' | sort)
  requeue "$job" 0  # after its end
  wait_for "$job" 0 COMPLETED
  again=$(QUADRILLE_SHARDS=2 submit 0 again "$program" "$work/vectors" "${vectors[@]}")
  wait_for "$again" 0 COMPLETED
  [ "$(find "$work/vectors/0" -printf '%p %T@\n' | sort)" = "$before" ] || { echo "$work/vectors/0: was written again" >&2; exit 1; }
  "$program" golden merge "$work"/vectors/? --quiet --out "$work/set"
  "$program" "${vectors[@]}" --quiet --out "$work/one_set"
  diff -r "$work/one_set" "$work/set"
  echo "golden vectors: a task that was done is not done again; byte for byte what one run leaves"
fi
