#!/bin/bash
# mesh_bench.sh - camera and shadow rays a second through the mesh hierarchies, one thread, and Embree's beside it in the same rounds.
#   experiments/mesh_bench.sh BENCH_MESH
# Environment: PEERS=DIR (a folder with embree_bench.c; needs libembree3), REPS=5 (rounds), SETS="sparse:10000 ...", ACCEL=bvh.
# A round runs every contestant once on each set, all on processor 0, so that drift of the machine falls on all alike. Milliseconds are of CPU
# time a frame, medians; ratios are taken round by round. Hits of the two differ by rays along edges, which single precision decides otherwise.
set -euo pipefail
export LC_ALL=C
ours=${1:-build/tests/bench_mesh} peers=${PEERS:-} reps=${REPS:-5} accel=${ACCEL:-bvh}
sets=${SETS:-sparse:10000 sparse:50000 sparse:1000000 dense:10000 dense:50000 dense:1000000 sphere:10000 sphere:50000 sphere:1000000}
[ -x "$ours" ] || { echo "usage: [PEERS=DIR] mesh_bench.sh BENCH_MESH (make build/tests/bench_mesh)" >&2; exit 2; }
work=$(mktemp -d); trap 'rm -rf "$work"' EXIT
[ -z "$peers" ] || gcc -O3 -march=native -o "$work/embree" "$peers/embree_bench.c" -lembree3 -lm -lpthread

# Rows of "set contestant cpu_ms hits occluded".
for ((round = 0; round < reps; round++)); do
    for set in $sets; do
        taskset -c 0 "$ours" -m "${set%:*}" -n "${set#*:}" -a "$accel" -r 3 -k 1,128 |
            awk -F'\t' -v set="$set" -v round="$round" 'NR > 1 {print round, set, "ours" $5, $9, $7, $8}'
        [ -z "$peers" ] || "$work/embree" -m "${set%:*}" -n "${set#*:}" -t 1 -k 1,8,16 -r 3 -b 1 |
            awk -F'\t' -v set="$set" -v round="$round" '$2 ~ /^[0-9]+$/ {print round, set, "embree" $5, $10, $7, $8}'
    done
done >"$work/rows"

awk -v sets="$sets" -v with="${peers:+1}" '
    function median(list,   n, v, i, j, t) {
        n = split(list, v, " ")
        for (i = 2; i <= n; i++) for (j = i; j > 1 && v[j - 1] + 0 > v[j] + 0; j--) { t = v[j]; v[j] = v[j - 1]; v[j - 1] = t }
        return n ? (v[int((n + 1) / 2)] + v[int((n + 2) / 2)]) / 2 : 0
    }
    { ms[$2, $3] = ms[$2, $3] " " $4; at[$1, $2, $3] = $4; hits[$2, $3] = $5; occluded[$2, $3] = $6; rounds = $1 + 1 }
    function rate(set, who) { return (480000 + hits[set, who]) / median(ms[set, who]) / 1000 }
    function ratio(set, a, b,   i, list) { for (i = 0; i < rounds; i++) list = list " " at[i, set, a] / at[i, set, b]; return median(list) }
    END {
        n = split(sets, set, " ")
        printf "%-16s %9s %9s", "M rays/s", "ours", "batches"
        if (with) printf " %9s %9s %9s  %s", "Embree 1", "Embree 8", "Embree 16", "ours/E1  batches/E1  batches/E16  hits that differ (shadows)"
        print ""
        for (i = 1; i <= n; i++) {
            s = set[i]
            printf "%-16s %9.2f %9.2f", s, rate(s, "ours1"), rate(s, "ours128")
            if (with) printf " %9.2f %9.2f %9.2f  %7.2f  %10.2f  %11.2f  %d (%d)", rate(s, "embree1"), rate(s, "embree8"), rate(s, "embree16"),
                ratio(s, "embree1", "ours1"), ratio(s, "embree1", "ours128"), ratio(s, "embree16", "ours128"),
                hits[s, "ours1"] - hits[s, "embree1"], occluded[s, "ours1"] - occluded[s, "embree1"]
            print ""
        }
    }' "$work/rows"
