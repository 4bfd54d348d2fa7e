#!/usr/bin/env bash
# A Slurm of one node and a folder of its own, for trying jobs where no cluster is: as root, without systemd, cgroups or accounting.
#   scripts/slurm/one_node.sh start DIR    then: export SLURM_CONF=DIR/slurm.conf
#   scripts/slurm/one_node.sh stop DIR
# Needs Debian's slurm-wlm and munge. Exit status: 1 it did not come up, 2 usage, 3 a missing package.
set -euo pipefail
source "$(dirname "$0")/../help.sh"
[ $# -eq 2 ] && [[ $1 =~ ^(start|stop)$ ]] || { usage >&2; exit 2; }
for tool in munged mungekey slurmctld slurmd; do
  PATH=$PATH:/usr/sbin command -v $tool >/dev/null || { echo "one_node.sh: $tool is missing: apt-get install slurm-wlm munge" >&2; exit 3; }
done
export PATH=$PATH:/usr/sbin
mkdir -p "$2"
dir=$(cd "$2" && pwd)
export SLURM_CONF=$dir/slurm.conf

if [ "$1" = stop ]; then
  for name in slurmd slurmctld munged; do
    pid=$(cat "$dir/$name.pid" 2>/dev/null) || continue
    kill "$pid" 2>/dev/null || true
    for ((i = 0; i < 100; ++i)); do kill -0 "$pid" 2>/dev/null || break; sleep 0.1; done
  done
  exit 0
fi

[ "$(id -u)" -eq 0 ] || { echo "one_node.sh: slurmd starts jobs under the users' names, so root is expected" >&2; exit 1; }
mkdir -p "$dir/state" "$dir/spool"
chmod 755 "$dir"
cat >"$SLURM_CONF" <<CONF
ClusterName=one_node
SlurmctldHost=$(hostname)(127.0.0.1)
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
AuthInfo=socket=$dir/munge.socket
CryptoType=crypto/munge
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
MpiDefault=none
ReturnToService=2
SlurmctldPidFile=$dir/slurmctld.pid
SlurmdPidFile=$dir/slurmd.pid
SlurmctldLogFile=$dir/slurmctld.log
SlurmdLogFile=$dir/slurmd.log
StateSaveLocation=$dir/state
SlurmdSpoolDir=$dir/spool
NodeName=$(hostname) NodeAddr=127.0.0.1 CPUs=$(nproc) State=UNKNOWN
PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP
CONF
[ -e "$dir/munge.key" ] || mungekey --create --keyfile="$dir/munge.key"
munged --force --key-file="$dir/munge.key" --socket="$dir/munge.socket" --pid-file="$dir/munged.pid" --log-file="$dir/munged.log" --seed-file="$dir/munged.seed"
slurmctld
slurmd
for ((i = 0; i < 300; ++i)); do
  [ "$(sinfo --noheader --format=%T 2>/dev/null)" = idle ] && exit 0
  sleep 0.1
done
echo "one_node.sh: the node is not idle after 30 s; $dir/slurmctld.log, slurmd.log and munged.log say why" >&2
exit 1
