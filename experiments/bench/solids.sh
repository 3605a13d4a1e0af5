# shellcheck shell=bash
# solids: rays a second among 64, 1000 and 100 000 spheres, and of the rod in its vessel; ten random scenes of each
# SIZE=800x600, SEED=101 (of the first random scene), SCENES=10, COUNTS="64 1000 100000", STEPS="12 16 ... 80" (numbers
# of spheres around the change from the list of solids to the tree). On one thread. A random rod has another camera,
# liquid and rod than rod.yaml. "worst" is the scene with the lowest rate or the highest ratio; a
# scene's value is the median of its rounds.
size=${SIZE:-800x600} seed=${SEED:-101} scenes=${SCENES:-10} counts=${COUNTS:-64 1000 100000}
steps=${STEPS:-12 16 24 32 48 64 65 80}
seeds=$(seq "$seed" $((seed + scenes - 1)))

random_rod() { # random_rod SEED: parameters, one a line
    awk -v seed="$1" '
        function uniform(a, b) {
            state = state * 16807 % 2147483647
            return a + (b - a) * state / 2147483647
        }
        BEGIN {
            state = seed * 48271 % 2147483647
            uniform(); uniform()
            turn = uniform(0, 6.2832)
            far = uniform(4, 8)
            printf "camera.position=%.4f,%.4f,%.4f\n", far * sin(turn), uniform(0.5, 5), -far * cos(turn)
            printf "camera.fov_deg=%.2f\n", uniform(30, 60)
            printf "liquid.height=%.3f\n", uniform(0.8, 2.7)
            printf "liquid.ior=%.3f\n", uniform(1.2, 1.7)
            printf "rod.rotation=0,%.1f,%.1f\n", uniform(0, 90), uniform(-8, 8)
        }'
}
frame() { traced "$1" cpu_s "$ours" "$2" --set render.threads=1 "${@:3}"; }
# The JSON of a scene lists all parameters of all solids, 25 s for 100 000 of them: the line of the summary is enough.
frame_of_many() {
    "$ours" render "$2" -o "$work/image.png" --set render.threads=1 --set "render.width=${size%x*}" \
        --set "render.height=${size#*x}" >"$work/out" 2>"$work/err" || failed "$1" "$work/err"
    note "$1" "$(sed -n 's/.* rays in \([0-9.]*\) s .*/\1/p' "$work/out")" \
        "$(sed -n 's/.*: \([0-9]*\) rays in .*/\1/p' "$work/out")"
}
round() {
    local s n set sets
    for n in $steps; do frame "step $n" "$(spheres 1 "$n" 1)"; done
    for s in 1 $seeds; do
        sets=(--set render.depth=8)
        ((s == 1)) || while read -r set; do sets+=(--set "$set"); done < <(random_rod "$s")
        frame "rod $s" "$here/scenes/rod.yaml" "${sets[@]}"
        for n in $counts; do
            "$( ((n > 1000)) && echo frame_of_many || echo frame)" "spheres $n $s" "$(spheres "$s" "$n" 1)"
        done
    done
}

report() {
    local rate='$2 / $1 / 1e6' ray='$1 / $2' first=${counts%% *} n s
    each() { for s in $seeds; do "$@"; done; } # each COMMAND...: the command once a random scene, $s its seed
    rates() { row "$1 $s" "$rate" "$1"; }
    times() { ratio "spheres $1 $s" "spheres $first $s" "$1" "$ray"; }
    for n in $steps; do row "step $n" '1e9 * $1 / $2' "$n spheres: ns a ray"; done
    row 'rod 1' "$rate" 'rod, depth 8: M rays/s'
    each rates rod | random_scenes low
    for n in $counts; do
        row "spheres $n 1" "$rate" "$n spheres: M rays/s"
        each rates "spheres $n" | random_scenes low
        [ "$n" != "$first" ] || continue
        ratio "spheres $n 1" "spheres $first 1" "$n spheres: time a ray / that of $first" "$ray"
        each times "$n" | random_scenes high
    done
}
