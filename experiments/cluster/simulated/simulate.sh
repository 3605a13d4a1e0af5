#!/bin/bash
# Simulate one frame of cuvette-mpi, and print its row of CSV (README.md lists the columns).
#   simulate.sh PLATFORM RANKS NAME=VALUE...      PLATFORM: one of platform.sh; NAME=VALUE: of main.c
# eager=BYTES (4096): of a message that travel before it is received; a longer one waits for its receiver.
set -euo pipefail
export LC_ALL=C

here=$(cd "$(dirname "$0")" && pwd)
program=${SIMULATED:-$here/../../../build/cluster/simulated}
platform=${1:?PLATFORM is missing} ranks=${2:?RANKS is missing}
shift 2
scratch=$(mktemp -d "${TMPDIR:-/tmp}/simulate.XXXXXX")
trap 'rm -rf "$scratch"' EXIT

if [[ $platform == two-cores ]]; then # all ranks on one host
    "$here/platform.sh" "$platform" 1 >"$scratch/platform.xml"
    hosts=$(seq 0 "$ranks" | sed 's/.*/h0/')
    speed=$((ranks < ${CORES:-2} ? ranks : ${CORES:-2}))
else # the serving rank is on the host of the first one that traces
    "$here/platform.sh" "$platform" "$ranks" >"$scratch/platform.xml"
    hosts=$(echo h0 && seq -f 'h%.0f' 0 $((ranks - 1)))
    speed=$(sed -n 's/.* speed="\([0-9.]*\)Gf".*/\1/p' "$scratch/platform.xml" |
        awk '{ s += $1 } END { printf "%.6f", s }')
fi
echo "$hosts" >"$scratch/hosts"

# The same on all platforms, so that these differ by their cables alone.
eager=4096 arguments=()
for argument; do
    if [[ $argument == eager=* ]]; then eager=${argument#*=}; else arguments+=("$argument"); fi
done

# Link and host are as the platform says: no factors fitted to other machines, no time for the program's own code, no
# time for a look for messages (the ranks wait for the time of the next look themselves).
smpirun -np $((ranks + 1)) -platform "$scratch/platform.xml" -hostfile "$scratch/hosts" \
    --cfg=smpi/simulate-computation:no --cfg=smpi/privatization:no --cfg=smpi/iprobe:0 --cfg=smpi/test:0 \
    --cfg=smpi/grow-injected-times:no --cfg=network/model:CM02 --cfg=network/bandwidth-factor:0.95 \
    --cfg=network/latency-factor:1 --cfg=network/weight-S:0 --cfg=network/TCP-gamma:0 \
    --cfg=network/loopback-bw:1e10 --cfg=network/loopback-lat:1e-6 --cfg=contexts/stack-size:256 \
    --cfg=smpi/async-small-thresh:$eager --cfg=smpi/send-is-detached-thresh:$eager --log=root.thres:warning \
    "$program" "speed=$speed" "${arguments[@]}"
