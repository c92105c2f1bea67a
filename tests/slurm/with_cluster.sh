#!/usr/bin/env bash
# Runs a command beside a Slurm cluster of one node, this machine, that lives as long as the command.
#
#   tests/slurm/with_cluster.sh COMMAND ...
#
# Needs Debian's slurm-wlm and munge, neither configured nor running, and no particular user. Keys, sockets, logs and
# state are in a temporary folder; a Slurm of the machine itself is not touched. Ends as the command does, or with 77
# where the machine lets no cluster come up.
set -euo pipefail
NO_CLUSTER=77

folder=$(mktemp -d /tmp/mrbd-slurm.XXXXXX)
chmod 755 "$folder"
port=$((20000 + $$ % 20000))
user=$(id -un)
host=$(hostname -s)
export SLURM_CONF=$folder/slurm.conf
mkdir "$folder/state" "$folder/spool"

stop() {
    if [ -s "$folder/slurmctld.pid" ]; then
        scancel --quiet --user="$user" || true
        for _ in $(seq 100); do
            if [ -z "$(squeue --noheader 2>/dev/null)" ]; then break; fi
            sleep 0.1
        done
    fi
    for name in slurmd slurmctld munged; do
        if [ ! -s "$folder/$name.pid" ]; then continue; fi
        pid=$(cat "$folder/$name.pid")
        kill "$pid" 2>/dev/null || continue
        # Each writes its state when it ends. One that has ended may wait for its parent to notice.
        while [ -d "/proc/$pid" ] && ! grep -q '^State:.*zombie' "/proc/$pid/status"; do sleep 0.1; done
    done
    rm -rf "$folder"
}
trap stop EXIT

# cred_expire: how long Slurm waits before a requeued job starts again; else 2 minutes.
# KillWait: from SIGTERM to SIGKILL. One node may be offered more processors than the machine has.
cat >"$SLURM_CONF" <<CONF
ClusterName=mrbd
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=$port
SlurmdPort=$((port + 1))
SlurmUser=$user
SlurmdUser=$user
AuthType=auth/munge
AuthInfo=socket=$folder/munge.socket,cred_expire=5
CredType=cred/munge
MpiDefault=none
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
JobCompType=jobcomp/none
SchedulerParameters=batch_sched_delay=1,sched_interval=2
ReturnToService=1
KillWait=5
MinJobAge=300
StateSaveLocation=$folder/state
SlurmdSpoolDir=$folder/spool
SlurmctldPidFile=$folder/slurmctld.pid
SlurmdPidFile=$folder/slurmd.pid
SlurmctldLogFile=$folder/slurmctld.log
SlurmdLogFile=$folder/slurmd.log
SlurmdParameters=config_overrides
NodeName=$host NodeAddr=127.0.0.1 CPUs=4 State=UNKNOWN
PartitionName=main Nodes=$host Default=YES MaxTime=01:00:00 State=UP
CONF

dd if=/dev/urandom of="$folder/munge.key" bs=64 count=1 status=none
chmod 600 "$folder/munge.key"
PATH=$PATH:/usr/sbin:/sbin
munged --key-file="$folder/munge.key" --socket="$folder/munge.socket" --pid-file="$folder/munged.pid" \
    --log-file="$folder/munged.log" --seed-file="$folder/munge.seed" || exit "$NO_CLUSTER"
slurmctld || exit "$NO_CLUSTER"
slurmd -N "$host" || exit "$NO_CLUSTER"
for _ in $(seq 100); do
    if [ "$(sinfo --noheader --format=%T 2>/dev/null)" = idle ]; then break; fi
    sleep 0.1
done
if [ "$(sinfo --noheader --format=%T 2>/dev/null)" != idle ]; then
    tail -n 20 "$folder"/*.log >&2
    echo "the cluster did not come up, see above" >&2
    exit "$NO_CLUSTER"
fi
"$@"
