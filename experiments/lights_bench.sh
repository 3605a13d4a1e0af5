#!/bin/bash
# lights_bench.sh - time of a frame with 64 lights over that with one: Whitted, which samples all of them, and random
# paths, which sample one at a surface. (At equal noise, not at equal numbers of paths: experiments/paths.sh.)
#   experiments/lights_bench.sh [CUVETTE]
# Environment: REPS=5 (rounds), SIZE=400x300, LIGHTS=64, SEED=101 (of the first random scene), SCENES=10.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
source "$here/rounds.sh"
ours=${1:-${CUVETTE:-build/cuvette}} reps=${REPS:-5} size=${SIZE:-400x300} lights=${LIGHTS:-64}
seed=${SEED:-101} scenes=${SCENES:-10}
need "$ours" 'make builds it'
random=$(seq "$seed" $((seed + scenes - 1)))

for s in 1 $random; do
    for n in 1 "$lights"; do
        awk -v seed="$s" -v solids=64 -v lights="$n" -f "$here/random_scene.awk" >"$work/scene-$n-$s.yaml"
    done
done
for ((round = 0; round < reps; round++)); do
    for s in 1 $random; do
        for integrator in whitted path; do
            for n in 1 "$lights"; do
                note "$integrator $n $s" "$("$ours" render "$work/scene-$n-$s.yaml" --json --set render.threads=1 \
                    --set "render.width=${size%x*}" --set "render.height=${size#*x}" --set render.paths=4 \
                    --set render.integrator=$integrator | field cpu_s)"
            done
        done
    done
done
for integrator in whitted path; do
    ratio "$integrator $lights 1" "$integrator 1 1" "$integrator: frame with $lights lights / with one"
    for s in $random; do ratio "$integrator $lights $s" "$integrator 1 $s" ''; done | random_scenes high
done
