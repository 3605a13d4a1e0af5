#!/bin/bash
# Studies on a real Slurm: slurm.sh [PROGRAM], for `make test-slurm`. In a temporary folder it starts munged,
# slurmctld and four nodes, all on this machine, and submits a study of 200 cells in 40 parts. While they run, it kills
# 20 tasks, requeues one, and takes a node away; a task of the second submission reaches its time limit; the third
# completes. Then no row may be missing, double or changed. It stops all that it started.
set -uo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
program=$(realpath "${1:-${CUVETTE:-$root/build/cuvette}}")
for tool in munged slurmctld slurmd sbatch; do
    command -v "$tool" >/dev/null || {
        echo "test-slurm: $tool is not installed; run: make setup-slurm"
        exit 77
    }
done
work=$(mktemp -d "${TMPDIR:-/tmp}/cuvette-slurm.XXXXXX") || exit 1
chmod 755 "$work"
cd "$work" || exit 1
unset CUVETTE_ISA CUVETTE_NODE_TYPE CUVETTE_MACHINE
export SLURM_CONF=$work/slurm.conf
results=$work/results
parts=40 repetitions=30 kills=20

# shellcheck source=tests/shell/verdict.sh
source "$root/tests/shell/verdict.sh"

# --- the cluster

start_cluster() {
    local port=$((20000 + RANDOM % 8000)) user
    user=$(id -un)
    mkdir state spool
    head -c 1024 /dev/urandom >munge.key
    chmod 400 munge.key
    cat >slurm.conf <<END
ClusterName=test
SlurmctldHost=$(hostname)(127.0.0.1)
SlurmUser=$user
SlurmdUser=$user
AuthType=auth/munge
AuthInfo=socket=$work/munge.sock,cred_expire=5
SlurmctldPort=$port
StateSaveLocation=$work/state
SlurmdSpoolDir=$work/spool/%n
SlurmctldPidFile=$work/slurmctld.pid
SlurmdPidFile=$work/%n.pid
SlurmctldLogFile=$work/slurmctld.log
SlurmdLogFile=$work/%n.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core_Memory
SchedulerParameters=sched_interval=1
SlurmdTimeout=10
KillWait=10
ReturnToService=2
MpiDefault=none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
SwitchType=switch/none
NodeName=DEFAULT CPUs=2 RealMemory=4000 State=UNKNOWN
NodeName=n[1-4] NodeHostname=$(hostname) NodeAddr=127.0.0.1 Port=[$((port + 1))-$((port + 4))]
PartitionName=main Nodes=n[1-4] Default=YES MaxTime=INFINITE State=UP
END
    munged --force --key-file="$work/munge.key" --socket="$work/munge.sock" --pid-file="$work/munged.pid" \
        --log-file="$work/munged.log" --seed-file="$work/munge.seed" || return
    slurmctld || return
    for node in n1 n2 n3 n4; do slurmd -N "$node" || return; done
    wait_until 60 all_nodes_idle
}
all_nodes_idle() { (($(sinfo --noheader --Node --states=idle --format=%N | wc -l) == 4)); }
stop() { # PIDFILE
    local pid
    pid=$(cat "$1" 2>/dev/null) && kill "$pid" 2>/dev/null && wait_until 20 gone "$pid"
}
gone() { ! ps -o stat= -p "$1" | grep -q "^[^Z]"; }
stop_all() {
    local node
    scancel --me --signal=KILL --full >/dev/null 2>&1
    scancel --me >/dev/null 2>&1
    for node in n1 n2 n3 n4 slurmctld munged; do stop "$work/$node.pid"; done
    process_ids '[0-9]*' | xargs -r kill -9 2>/dev/null
    rm -rf "$work"
}
trap stop_all EXIT

wait_until() { # SECONDS COMMAND...
    local end=$((SECONDS + $1))
    shift
    until "$@"; do
        ((SECONDS < end)) || return 1
        sleep 0.2
    done
}
empty_queue() { [[ -z $(squeue --noheader) ]]; }

# --- the study

cat >many.study <<END
study: many
scene: $root/experiments/scenes/rod.yaml
set: {render.width: 320, render.height: 240, render.threads: 1}
grid:
  - {render.depth: [0, 1, 2, 3, 4]}
  - {liquid.ior: [$(seq -s ', ' 1.01 0.01 1.40)]}
repetitions: $repetitions
warmups: 1
END
submit() { "$program" study submit --slurm "$work/many.study" --results "$results" --tasks $parts "$@" >out 2>err; }
process_ids() { pgrep -f -- "study run --results $results --shard $1/$parts " 2>/dev/null; } # PART
# PART...: its rows; text after the last newline is an incomplete one
rows_of() {
    local part file
    for part in "$@"; do
        file=$results/many/rows.shard-$part-of-$parts.csv
        [[ -s $file ]] || continue
        if [[ -n $(tail -c 1 "$file") ]]; then sed '1d; $d' "$file"; else sed 1d "$file"; fi
    done
}
cells() { awk -F, 'NR > 1 && !$5 { print $3, $8, $9, $10 }' "$1" | sort -u; } # cell, film and values
running() { squeue --noheader --states=RUNNING --format='%A %K %N'; }         # job, part, node

# --- 1: killed tasks, a requeued one, a lost node

began=$SECONDS
start_cluster
verdict $? "munged, slurmctld and four nodes run" "$(tail -n 5 ./*.log)"
[[ $(sinfo --noheader 2>/dev/null) ]] || {
    conclude
    exit 1
}
submit --partition nope
[[ $(cat err) == *"sbatch: invalid partition specified: nope; nothing is submitted" ]]
verdict $? "an unknown partition: Slurm's own message" "$(cat out err)"
submit
verdict $? "the study is submitted" "$(cat out err)"
submit
grep -q "still in the queue" err
verdict $? "it is not submitted twice" "$(cat out err)"

killed=() requeued='' lost=()
take_node() { # a node is lost: its daemon, and the jobs on it with their managers
    local part pid
    kill -9 "$(cat n4.pid)"
    for part in $(running | awk '$3 == "n4" && $2 != "N/A" { print $2 }'); do
        pid=$(process_ids "$part") && kill -9 "$(ps -o ppid= -p "$pid" | tr -d ' ')" "$pid" && lost+=("$part")
    done
}
disturb() { # JOB PART NODE, a running task with rows
    if ((${#killed[@]} >= 4)) && [[ -z $requeued ]]; then
        scontrol requeue "$1" && requeued=$2
    elif ((${#killed[@]} >= 8 && ${#lost[@]} == 0)) && [[ $3 == n4 ]]; then
        take_node
    elif ((${#killed[@]} % 2)); then
        process_ids "$2" >here && scancel --signal=KILL --full "$1" && killed+=("$2")
    else
        process_ids "$2" | xargs kill -9 && killed+=("$2")
    fi
}
is_disturbed() { [[ " ${killed[*]} ${lost[*]} $requeued " == *" $1 "* ]]; }
: >before
while ((${#killed[@]} < kills)) && ! empty_queue; do
    while ((${#killed[@]} < kills)) && read -r job part node; do
        if [[ ! $part =~ ^[0-9]+$ ]] || is_disturbed "$part"; then continue; fi
        rows_of "$part" >here
        (($(wc -l <here) > 3)) || continue
        cat here >>before
        disturb "$job" "$part" "$node" 2>/dev/null
    done < <(running)
done
((${#killed[@]} == kills))
verdict $? "$kills tasks are killed" "${#killed[@]}"
[[ -n $requeued ]]
verdict $? "a task is requeued"
((${#lost[@]} > 0))
verdict $? "a node with tasks is lost"
wait_until 300 empty_queue
verdict $? "the queue ends" "$(squeue)"
starts() { grep -c " part $1 of " "$results/many/slurm/part-$1.log"; } # PART
(($(starts "$requeued") == 2))
verdict $? "the requeued task went on in its place" "$(cat "$results/many/slurm/part-$requeued.log")"
again=0
for part in "${lost[@]}"; do again=$((again + ($(starts "$part") >= 2))); done
((again == ${#lost[@]}))
verdict $? "the tasks of the lost node went on on others" "$again of ${#lost[*]}"
rows_of $(seq 0 $((parts - 1))) >>before
echo "# $((SECONDS - began)) s: ${#killed[@]} tasks killed, part $requeued requeued, parts ${lost[*]} on the lost" \
    "node; $(sort -u before | wc -l) rows"

# --- 2: a time limit

slurmd -N n4
wait_until 60 all_nodes_idle
verdict $? "the node comes back"
submit --time 1
missing=$(sed -n 's/.*: \([0-9]*\) of .* parts to run.*/\1/p' out)
((missing > 0 && missing <= kills))
verdict $? "only killed tasks are submitted again" "$(cat out err)"
stopped=
while [[ -z $stopped ]] && ! empty_queue; do # a task that stands still is as good as a slow one
    part=$(running | awk '$2 ~ /^[0-9]+$/ { print $2; exit }')
    pid=$(process_ids "${part:-none}") && kill -STOP "$pid" && stopped=$part
done
wait_until 400 empty_queue
verdict $? "the queue ends" "$(squeue)"
log=$results/many/slurm/part-$stopped.log
grep -q 'DUE TO TIME LIMIT' "$log" &&
    grep -q 'interrupted; its .* new rows are kept' "$log"
verdict $? "at its time limit, part $stopped keeps its rows and says so" "$(<"$log")"

# --- 3: the rest

submit
missing=$(sed -n 's/.*: \([0-9]*\) of .* parts to run.*/\1/p' out)
verdict $? "the rest is submitted" "$(cat out err)"
echo "# $((SECONDS - began)) s: ${missing:-0} parts are left after the time limit"
wait_until 300 empty_queue
submit
grep -q '^many: complete, nothing to submit' out
verdict $? "the study is complete" "$(cat out err)"

# --- the rows against the list of cells

tail -n 4 "$results/many/slurm/merge.log" >log
grep -q '^many: [0-9]* rows, 0 faults' log && grep -q '^many: 200 of 200 cells done' log
verdict $? "the last job merged and verified the rows" "$(<log)"
"$program" study verify "$work/many.study" --results "$results" >verified
verdict $? "cuvette study verify" "$(<verified)"
sed 1d "$results/many/rows.csv" | sort >after
empty "no row is lost, on disk when a task was killed or later" "$(comm -23 <(sort -u before) after)"
empty "no row is double" "$(awk -F, 'NR > 1 && seen[$3, $4]++ { print $3, $4 }' "$results/many/rows.csv")"
empty "each of the 200 cells has $repetitions repetitions" "$(awk -F, -v n=$repetitions 'NR > 1 && !$5 { count[$3]++ }
    END { for (cell = 0; cell < 200; cell++) if (count[cell] != n) print cell, count[cell] + 0 }' \
    "$results/many/rows.csv")"
sed 's/^repetitions: .*/repetitions: 1/' many.study >once.study
"$program" study run --quiet once.study --results whole
empty "cells and films are those of a run on one machine" \
    "$(diff <(cells "$results/many/rows.csv") <(cells whole/many/rows.csv))"
grep -c '^environment' verified | grep -qx 1
verdict $? "all nodes are one environment" "$(<verified)"
echo "# $((SECONDS - began)) s: $(wc -l <after) rows of 200 cells, $(awk -F, '$5' after | wc -l) of them warm-ups"

conclude
