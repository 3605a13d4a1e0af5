#!/bin/bash
# growth.sh - time and memory against the number of solids and of lights, which no study can sweep, as a table for
# plots/growth.gp.
#   experiments/growth.sh [CUVETTE] >results/tables/growth.tsv
# Environment: REPS=5 (rounds), SIZE=400x300, SOLIDS="1 3 10 ... 100000", LIGHTS="1 4 ... 1000" (among 64 solids).
# Scenes: random_scene.awk with seed 1, depth 4, one thread; paths: 4 a pixel. A round renders every scene once. Times
# are CPU times of tracing, without reading the scene and building its hierarchy; memory is the largest of the process.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
source "$here/rounds.sh"
ours=${1:-${CUVETTE:-build/cuvette}} reps=${REPS:-5} size=${SIZE:-400x300}
solids=${SOLIDS:-1 3 10 30 64 100 300 1000 3000 10000 30000 100000} lights=${LIGHTS:-1 4 16 64 256 1000}
need "$ours" 'make builds it'

series=()
add() { # add SERIES N INTEGRATOR SOLIDS LIGHTS
    awk -v seed=1 -v solids="$4" -v lights="$5" -f "$here/random_scene.awk" >"$work/$1-$2.yaml"
    series+=("$1 $2 $3")
}
for n in $solids; do add solids "$n" whitted "$n" 1; done
for n in $lights; do add lights "$n" whitted 64 "$n"; done
for n in $lights; do add lights-path "$n" path 64 "$n"; done

for ((round = 0; round < reps; round++)); do
    for one in "${series[@]}"; do
        read -r who n integrator <<<"$one"
        json=$("$ours" render "$work/$who-$n.yaml" --json --set render.threads=1 --set "render.integrator=$integrator" \
            --set render.paths=4 --set "render.width=${size%x*}" --set "render.height=${size#*x}")
        echo "$who $n" "$(field cpu_s <<<"$json")" "$(field total <<<"$json")" "$(field camera <<<"$json")" \
            "$(field peak_rss_bytes <<<"$json")"
    done
done | awk "$order"'
    function tell(list, scale,   n, v) {
        n = sorted(list, v)
        printf "\t%.5g\t%.5g\t%.5g", median(list) * scale, v[1] * scale, v[n] * scale
    }
    !(($1, $2) in times) { who[++rows] = $1; size[rows] = $2 }
    { times[$1, $2] = times[$1, $2] " " $3; rays[$1, $2] = $4; camera[$1, $2] = $5
      memory[$1, $2] = memory[$1, $2] " " $6; rounds[$1, $2]++ }
    END {
        print "series\tcount\tn\trays_total\trays_camera\tray_ns_median\tray_ns_low\tray_ns_high" \
              "\tcamera_ray_ns_median\tcamera_ray_ns_low\tcamera_ray_ns_high" \
              "\tpeak_rss_bytes_median\tpeak_rss_bytes_low\tpeak_rss_bytes_high"
        for (i = 1; i <= rows; i++) {
            w = who[i]; c = size[i]
            printf "%s\t%d\t%d\t%d\t%d", w, c, rounds[w, c], rays[w, c], camera[w, c]
            tell(times[w, c], 1e9 / rays[w, c])
            tell(times[w, c], 1e9 / camera[w, c])
            tell(memory[w, c], 1)
            print ""
        }
    }'
