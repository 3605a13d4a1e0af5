# shellcheck shell=bash
# slime: the film of a slime, whole program, and the steps of its simulation, on one thread
# SIZE=800x600, DURATION=0.4 (s, the length of the film), LEVEL=4 (of the slime). The film begins at 1.6 s, when the
# hand draws the toy out. Real time: simulated over wall time of the steps alone.
size=${SIZE:-800x600} duration=${DURATION:-0.4} level=${LEVEL:-4}

film() { # film WIDTHxHEIGHT START DURATION: frames, seconds of the program, simulated seconds, seconds of the steps
    local wall
    wall=$(seconds "$ours" animate "$here/scenes/slime.yaml" --json -o "$work/film.y4m" --start "$2" --duration "$3" \
        --set render.threads=1 --set "render.width=${1%x*}" --set "render.height=${1#*x}" --set "toy.level=$level")
    echo "$(field frames <"$work/out") $wall $(field simulated_s <"$work/out") $(field step_s <"$work/out")"
    rm -f "$work/film.y4m"
}
round() {
    local frames wall before lead simulated steps
    # The same film without its frames: the motion until then, and the start of the program.
    read -r frames wall _ < <(film "$size" 1.6 "$duration")
    read -r before lead simulated steps < <(film 1x1 1.6 "$duration")
    note film "$frames" "$wall"
    note frames "$before" "$(awk -v a="$wall" -v b="$lead" 'BEGIN { print a - b }')"
    note steps "$simulated" "$steps"
}

report() {
    row film '$1 / $2' "slime film $size, whole program, frames/s"
    row frames '$1 / $2' "slime film $size without the motion, frames/s"
    row steps '$1 / $2' "slime step, level $level: times real time"
}
