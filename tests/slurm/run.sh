#!/usr/bin/env bash
# A sweep as a Slurm job array on a cluster of one node that this script sets up and takes down: one task is killed and
# requeued, the merge waits for all, and the result must be that of a single process, byte for byte. Then the same with the sweep
# and the command that src/guide/cluster.md tells its reader to save and run.
#
#   tests/slurm/run.sh PROGRAM
#   STUDY=RELEASE tests/slurm/run.sh PROGRAM    20,000 cases on 16 tasks as well, by a release build
#
# Everything (keys, sockets, ports, states, logs) is the script's own, in a temporary folder. Needs root and Debian's
# slurm-wlm and munge, which are installed where that is possible. Exit code 77: they are not to be had here.
set -euo pipefail
program=$(realpath "${1:?the program to test}")
root=$(cd "$(dirname "$0")/../.." && pwd)

if [ "$(id -u)" != 0 ]; then
    echo "slurm: skipped, it takes root" >&2
    exit 77
fi
if ! command -v slurmctld slurmd munged sbatch >/dev/null; then
    echo "slurm: installing slurm-wlm and munge" >&2
    if ! { apt-get update && apt-get install -y --no-install-recommends slurm-wlm munge; } >/dev/null 2>&1; then
        echo "slurm: skipped, slurm-wlm and munge cannot be installed here" >&2
        exit 77
    fi
fi

work=$(mktemp -d)
pids=()
finish() {
    code=$?
    for pid in "${pids[@]}"; do kill "$pid" 2>/dev/null || true; done
    wait 2>/dev/null || true
    if [ $code != 0 ]; then
        echo "slurm: failed; the ends of the logs:" >&2
        tail -n 15 "$work"/*.log "$work"/out/* >&2 2>/dev/null || true
    fi
    rm -rf "$work"
    exit $code
}
trap finish EXIT
mkdir -p "$work"/{state,spool,out}
chmod 755 "$work"

dd if=/dev/urandom of="$work/munge.key" bs=1024 count=1 status=none
chmod 400 "$work/munge.key"
munged --foreground --force --key-file="$work/munge.key" --socket="$work/munge.socket" --pid-file="$work/munge.pid" \
    --log-file="$work/munged.log" --seed-file="$work/munge.seed" 2>"$work/munged-start.log" &
pids+=($!)

host=$(hostname -s)
base=$((20000 + $$ % 20000))
cat >"$work/slurm.conf" <<CONF
ClusterName=test
SlurmctldHost=$host(127.0.0.1)
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
AuthInfo=socket=$work/munge.socket,cred_expire=5
CredType=cred/munge
SlurmctldPort=$base
SlurmdPort=$((base + 1))
StateSaveLocation=$work/state
SlurmdSpoolDir=$work/spool
SlurmctldPidFile=$work/slurmctld.pid
SlurmdPidFile=$work/slurmd.pid
SlurmctldLogFile=$work/slurmctld.log
SlurmdLogFile=$work/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
MpiDefault=none
ReturnToService=2
JobRequeue=1
KillWait=5
NodeName=$host NodeAddr=127.0.0.1 CPUs=$(nproc) RealMemory=1024 State=UNKNOWN
PartitionName=main Nodes=ALL Default=YES MaxTime=INFINITE State=UP
CONF
echo "CgroupAutomount=no" >"$work/cgroup.conf"
export SLURM_CONF=$work/slurm.conf

patience() { # patience SECONDS WHAT COMMAND...
    local left=$(($1 * 5)) what=$2
    shift 2
    until "$@" >/dev/null 2>&1; do
        left=$((left - 1))
        if [ "$left" -le 0 ]; then
            echo "slurm: $what" >&2
            return 1
        fi
        sleep 0.2
    done
}
patience 30 "munged does not answer" test -S "$work/munge.socket"
slurmctld -D 2>"$work/slurmctld-start.log" &
pids+=($!)
patience 60 "slurmctld does not answer" scontrol ping
slurmd -D -N "$host" 2>"$work/slurmd-start.log" &
pids+=($!)
idle() { sinfo --noheader --format=%T | grep -q -E 'idle|mix|alloc'; }
patience 60 "the node does not come up" idle

# Marched to a sharp tolerance: some seconds per case, so that a kill finds one under way.
cat >"$work/sweep.toml" <<'TOML'
title = "job array"
[material]
library = "pmma"
[indenter]
shape = "sphere"
radius = "10 mm"
[drive]
mean = "10 N"
amplitude = "5 N"
[sweep]
angular_frequency = { from = "0.003 rad/s", to = "12 rad/s", points = 16 }
[cycle]
steps = 80
method = "march"
tolerance = 1e-8
max_cycles = 100000
error_bars = false
[solver]
springs = 100
TOML

export CONTACT_DMA=$program
cd "$work/out"
submitted=$("$root/sweeps/slurm/submit.sh" "$work/sweep.toml" "$work/merged" 4)
echo "slurm: $submitted"
array=$(sed 's/array \([0-9]*\),.*/\1/' <<<"$submitted")
merge=$(sed 's/.*merge \([0-9]*\)$/\1/' <<<"$submitted")

# A task that has begun is killed by requeueing it, and comes back.
begun() { [ -e "$work/merged.parts/part-2/resolved.toml" ]; }
patience 120 "task 2 does not begin" begun
sleep 0.5
if scontrol requeue "${array}_2"; then
    echo "slurm: task 2 killed and requeued"
else
    echo "slurm: task 2 had ended already" >&2
    exit 1
fi
gone() { ! squeue --noheader --format=%i | grep -q .; }
patience 400 "the jobs do not end" gone
scontrol show job "${array}_2" | grep -E -o 'Restarts=[0-9]+' | sed 's/^/slurm: task 2 /'
scontrol show job "${array}_2" | grep -q 'Restarts=1'

"$program" sweep "$work/sweep.toml" --quiet --out "$work/single"
for file in sweep.csv summary.json figures/energy-loss.png figures/loops.svg cases/cycles.npz; do
    cmp "$work/merged/$file" "$work/single/$file"
done
echo "slurm: 4 tasks, one killed and requeued, merged: identical to a single process"

# The guide, to the letter.
guide=$root/src/guide/cluster.md
mkdir "$work/guide"
cd "$work/guide"
ln -s "$root/sweeps" sweeps
sed -n '/^Save as `many.toml`/,/^```$/p' "$guide" | sed '1,/^```toml$/d; /^```$/d' >many.toml
command=$(sed -n '/^```console$/,/^```$/s/^\$ //p' "$guide")
SCRATCH=$work/guide bash -e -c "$command"
patience 400 "the guide's jobs do not end" gone
"$program" sweep many.toml --quiet --out single
for file in sweep.csv summary.json figures/energy-loss.png cases/cycles.npz; do
    cmp "many/$file" "single/$file"
done
echo "slurm: the guide's $command: identical to a single process"

# A study of 20,000 cases on an array of 16, three of whose tasks are killed, for those who ask for it: minutes.
[ -n "${STUDY:-}" ] || exit 0
program=$(cd "$root" && realpath "$STUDY")
export CONTACT_DMA=$program
cd "$work/out"
cat >"$work/study.toml" <<'TOML'
title = "20,000 cases"
[material]
library = "pmma"
[indenter]
shape = "sphere"
radius = "10 mm"
[drive]
mean = "10 N"
amplitude = "5 N"
[sweep]
angular_frequency = { from = "1e-3 rad/s", to = "1 rad/s", points = 100, spacing = "log" }
drive.amplitude = { from = "0.05 N", to = "9.95 N", points = 200 }
TOML
begin=$SECONDS
submitted=$("$root/sweeps/slurm/submit.sh" "$work/study.toml" "$work/study" 16)
echo "slurm: study: $submitted"
array=$(sed 's/array \([0-9]*\),.*/\1/' <<<"$submitted")
for task in 2 7 12; do
    begun() { ls "$work/study.parts/part-$task/records/"* ; }
    patience 600 "task $task does not begin" begun
    scontrol requeue "${array}_$task"
done
patience 1200 "the study does not end" gone
echo "slurm: study: $((SECONDS - begin)) s with three tasks killed and requeued"
for task in 2 7 12; do
    scontrol show job "${array}_$task" | grep -q 'Restarts=1'
done
begin=$SECONDS
"$program" merge "$work"/study.parts/part-* --out "$work/again" --quiet
echo "slurm: study: merged again in $((SECONDS - begin)) s, $(du -sm "$work/study" | cut -f1) MB, parts $(du -sm "$work/study.parts" | cut -f1) MB"
begin=$SECONDS
"$program" report "$work/again" --quiet --no-figures
echo "slurm: study: read in $((SECONDS - begin)) s"
begin=$SECONDS
"$program" sweep "$work/study.toml" --quiet --out "$work/study-single"
echo "slurm: study: a single process takes $((SECONDS - begin)) s"
for file in sweep.csv summary.json figures/energy-loss.png; do
    cmp "$work/study/$file" "$work/study-single/$file"
done
echo "slurm: study: 20,000 cases on 16 tasks, three killed: identical to a single process"
