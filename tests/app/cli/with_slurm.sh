#!/usr/bin/env bash
# with_slurm.sh FOLDER COMMAND...: runs COMMAND while Slurm serves this machine, as one node of eight
# processors, whatever it has. All of Slurm's files lie in FOLDER; its servers end with the command.
set -euo pipefail
folder=$1
shift
user=$(id -un)
PATH=$PATH:/usr/sbin:/sbin
servers=()

# Slurm's servers may miss a request to end while a job ends. Nothing that they keep is needed.
stop() {
    {
        kill -KILL "${servers[@]}" || true
        wait
    } 2>/dev/null
}
trap stop EXIT

free_port() {
    python3 -c 'import socket; s = socket.socket(); s.bind(("127.0.0.1", 0)); print(s.getsockname()[1])'
}

# until_true WHAT COMMAND...: waits up to a minute.
until_true() {
    local what=$1 tries
    shift
    for ((tries = 0; tries < 600; tries++)); do
        ! "$@" >/dev/null 2>&1 || return 0
        sleep 0.1
    done
    echo "with_slurm.sh: $what did not come" >&2
    tail -n 5 "$folder"/*.log >&2
    return 1
}

mkdir -p "$folder"/{state,spool}
head -c 1024 /dev/urandom >"$folder/munge.key"
chmod 600 "$folder/munge.key"
munge=$folder/munge.socket
munged --foreground --force --key-file="$folder/munge.key" --socket="$munge" --pid-file="$folder/munge.pid" \
    --log-file="$folder/munge.log" --seed-file="$folder/munge.seed" 2>>"$folder/munge.err" &
servers+=($!)
until_true munged test -S "$munge"

host=$(hostname -s)
cat >"$folder/slurm.conf" <<CONF
ClusterName=reljef
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=$(free_port)
SlurmdPort=$(free_port)
AuthType=auth/munge
AuthInfo=socket=$munge
CredType=cred/munge
SlurmUser=$user
SlurmdUser=$user
StateSaveLocation=$folder/state
SlurmdSpoolDir=$folder/spool
SlurmctldPidFile=$folder/slurmctld.pid
SlurmdPidFile=$folder/slurmd.pid
SlurmctldLogFile=$folder/slurmctld.log
SlurmdLogFile=$folder/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SchedulerType=sched/builtin
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
ReturnToService=2
MpiDefault=none
SlurmdParameters=config_overrides
NodeName=$host NodeAddr=127.0.0.1 CPUs=8 State=UNKNOWN
PartitionName=all Nodes=$host Default=YES MaxTime=INFINITE State=UP
CONF
export SLURM_CONF=$folder/slurm.conf
slurmctld -D -f "$SLURM_CONF" >"$folder/slurmctld.out" 2>&1 &
servers+=($!)
slurmd -D -f "$SLURM_CONF" >"$folder/slurmd.out" 2>&1 &
servers+=($!)
is_idle() { [[ $(sinfo --noheader --format=%t) == idle ]]; }
until_true "the node" is_idle
status=0
timeout 300 "$@" || status=$?
has_no_job() { [[ -z $(squeue --noheader) ]]; } # nor one whose processes are still ending
until_true "the end of all jobs" has_no_job
exit "$status"
