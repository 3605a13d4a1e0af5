# shellcheck shell=bash
# processes: wall time of whole processes, from the scene file to the image; the speed of the build by clang
# SIZE=800x600, TRIANGLES=1000000 (of the OBJ file, generated before: the set dense); CLANG, the program by clang.
reps=${REPS:-7} size=${SIZE:-800x600} clang=${CLANG:-} triangles=${TRIANGLES:-1000000}
rod=$here/scenes/rod.yaml soup=$here/scenes/soup.yaml

prepare() {
    [ -z "$clang" ] || need "$clang" 'make CC=clang build=build/clang builds it'
    "$ours" mesh --generate dense --count "$triangles" -f obj -o "$work/soup.obj"
    sed "s|soup: {.*|soup: {file: soup.obj}|" "$soup" >"$work/soup.yaml"
}
whole() { # whole CONTESTANT SCENE [ARGUMENT...]
    note "$1" "$(seconds "$ours" render "$2" -o "$work/image.png" --set "render.width=${size%x*}" \
        --set "render.height=${size#*x}" "${@:3}")"
}
round() {
    local program
    whole 'rod 8' "$rod"
    whole 'rod 16' "$rod" --bits 16
    whole obj "$work/soup.yaml"
    [ -n "$clang" ] || return 0
    for program in ours clang; do
        traced "rod by $program" cpu_s "${!program}" "$rod" --repeat 3 --set render.depth=8
        traced "mesh by $program" cpu_s "${!program}" "$soup" --repeat 3 --set soup.generate=sphere
    done
}

report() {
    row 'rod 8' '$1 * 1e3' 'rod.yaml to a PNG of 8 bits, whole process, ms'
    row 'rod 16' '$1 * 1e3' 'rod.yaml to a PNG of 16 bits, whole process, ms'
    row obj '$1' "OBJ of $triangles triangles to a PNG, whole process, s"
    ratio 'rod by ours' 'rod by clang' 'rod, depth 8: speed of the build by clang / by gcc'
    ratio 'mesh by ours' 'mesh by clang' 'sphere of 50000 triangles: speed of the build by clang / by gcc'
}
