# shellcheck shell=bash
# lights: the time of a frame with 64 lights over that with one, by Whitted's rays and by random paths
# SIZE=400x300, LIGHTS=64, SEED=101 (of the first random scene), SCENES=10. Whitted samples all lights, a random path
# one at a surface. At equal noise, not at equal numbers of paths: the bench paths.
size=${SIZE:-400x300} lights=${LIGHTS:-64} seed=${SEED:-101} scenes=${SCENES:-10}
seeds=$(seq "$seed" $((seed + scenes - 1)))

round() {
    local s integrator n
    for s in 1 $seeds; do
        for integrator in whitted path; do
            for n in 1 "$lights"; do
                traced "$integrator $n $s" cpu_s "$ours" "$(spheres "$s" 64 "$n")" --set render.threads=1 \
                    --set render.paths=4 --set render.integrator=$integrator
            done
        done
    done
}

report() {
    local s integrator
    for integrator in whitted path; do
        ratio "$integrator $lights 1" "$integrator 1 1" "$integrator: frame with $lights lights / with one"
        for s in $seeds; do ratio "$integrator $lights $s" "$integrator 1 $s" ''; done | random_scenes high
    done
}
