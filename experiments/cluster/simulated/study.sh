#!/bin/bash
# Simulate the frames of the studies that README.md describes, and write their rows to TABLE (results/cluster.csv). Rows
# that it has are kept: the same command goes on where it was stopped.
#   study.sh [STUDY...]      strong-path strong-whitted weak-path tile stragglers serving; all of them without arguments
# JOBS (1): simulations at once. RANKS_MOST (4096): none with more ranks.
set -euo pipefail
export LC_ALL=C.UTF-8

here=$(cd "$(dirname "$0")" && pwd)
table=${TABLE:-$here/../../../results/cluster.csv} jobs=${JOBS:-1} most=${RANKS_MOST:-4096}
columns=study,platform,variant,ranks,width,height,paths,tile,tiles,wrong,check,work_s,tile_most_s,ideal_s,time_s
columns=$columns,efficiency,messages,tile_bytes,serving_s,idle_s
counts=(1 4 16 64 256 1024 4096)

# Processor time of rank 0 for a tile, measured with build/cluster/messages on 16 processors (README.md).
serving=(message_ns=2400 byte_ns=0.30)
frame=(width=7680 height=4320 scene_bytes=3500)
path=("map=$here/maps/path.pgm" paths=1024 pixel_bytes=48)
whitted=("map=$here/maps/whitted.pgm" paths=1 pixel_bytes=24)

row() { # STUDY PLATFORM VARIANT RANKS NAME=VALUE...: one line of arguments for simulate, unless the table has the row
    (($4 > most)) || grep -q "^$1,$2,$3,$4," "$table" || echo "$@"
}
simulate() {
    local study=$1 platform=$2 variant=$3 ranks=$4
    shift 4
    "$here/simulate.sh" "$platform" "$ranks" "label=$study,$platform,$variant," "$@" >>"$table" ||
        echo "study.sh: $study $platform $variant $ranks failed" >&2
}
export -f simulate
export here table

strong_path() {
    for n in "${counts[@]}"; do
        for platform in switch-100g ethernet-10g; do
            row strong-path "$platform" tile-32 "$n" "${path[@]}" "${frame[@]}" "${serving[@]}"
        done
    done
}
strong_whitted() { # its limits are reached with 16 to 64 ranks
    local n
    for n in 1 4 16 64 256 1024; do
        for platform in switch-100g ethernet-10g; do
            row strong-whitted "$platform" tile-32 "$n" "${whitted[@]}" "${frame[@]}" "${serving[@]}"
        done
        row strong-whitted switch-100g link-only "$n" "${whitted[@]}" "${frame[@]}" message_ns=1000 byte_ns=0.01
    done
    for n in 1 4 16 64 256 1024; do # OpenMPI's own limit for TCP, with which a tile leaves without waiting for rank 0
        row strong-whitted ethernet-10g eager-64k "$n" "${whitted[@]}" "${frame[@]}" "${serving[@]}" eager=65536
    done
}
weak_path() { # 120 x 68 pixels for each rank
    local side=1
    for n in "${counts[@]}"; do
        row weak-path switch-100g tile-32 "$n" "${path[@]}" width=$((120 * side)) height=$((68 * side)) \
            scene_bytes=3500 "${serving[@]}"
        side=$((2 * side))
    done
}
tile() {
    for n in 1024 4096; do
        for side in 64 32 16 8; do
            row tile switch-100g "tile-$side" "$n" "${path[@]}" "${frame[@]}" "${serving[@]}" "tile=$side" \
                tiles_per_worker=0
        done
    done
}
stragglers() {
    for n in 64 1024 4096; do
        for platform in spread-100g stragglers-100g; do
            row stragglers "$platform" tile-32 "$n" "${path[@]}" "${frame[@]}" "${serving[@]}"
        done
    done
}
# What could be gained at rank 0: by a two-level hand-out at best (messages cost nothing, bytes as before), or by a
# cheaper transport.
serving() {
    for n in 1024 4096; do
        row serving switch-100g two-level-bound "$n" "${path[@]}" "${frame[@]}" message_ns=0 byte_ns=0.30
        row serving switch-100g half-cost "$n" "${path[@]}" "${frame[@]}" message_ns=1200 byte_ns=0.15
        row serving switch-100g no-cost "$n" "${path[@]}" "${frame[@]}" message_ns=0 byte_ns=0
    done
}

studies=("$@")
(($#)) || studies=(strong-path strong-whitted weak-path stragglers serving tile)
mkdir -p "$(dirname "$table")"
[[ -s $table ]] || echo "$columns" >"$table"
for study in "${studies[@]}"; do
    case $study in
    strong-path | strong-whitted | weak-path | tile | stragglers | serving) "${study//-/_}" ;;
    *)
        echo "study.sh: there is no study $study; its head lists them" >&2
        exit 1
        ;;
    esac
done | xargs -r -d '\n' -P "$jobs" -I LINE nice -n 19 bash -c 'simulate LINE'
