# shellcheck shell=bash
# meshes: whole frames of the triangle sets, one thread, 800x600, compared with POV-Ray and Tachyon (make setup-peers)
# SETS="sparse:50000 ...". Camera and shadow rays. Each program reports its own time of tracing, without reading,
# building and writing. Ratios are computed for each round; the table has their medians and ranges.
sets=${SETS:-sparse:50000 dense:50000 sphere:50000} size=800x600 scene=$here/scenes/soup.yaml

prepare() {
    local set
    need povray 'make setup-peers installs it'
    need tachyon 'make setup-peers installs it'
    for set in $sets; do
        "$ours" mesh --generate "${set%:*}" --count "${set#*:}" -f obj -o "$work/$set.obj"
        awk -v peer=povray -f "$here/peers/mesh_scene.awk" "$work/$set.obj" >"$work/$set.pov"
        awk -v peer=tachyon -f "$here/peers/mesh_scene.awk" "$work/$set.obj" >"$work/$set.dat"
    done
}
round() {
    local set
    for set in $sets; do
        traced "$set cuvette" wall_s "$ours" "$scene" --set soup.generate="${set%:*}" --set soup.count="${set#*:}" \
            --repeat 3 -o "$work/ours.png"
        povray +I"$work/$set.pov" +O"$work/pov.png" +W800 +H600 -D -A -V +WT1 >"$work/log" 2>&1 ||
            failed povray "$work/log"
        note "$set povray" "$(awk \
            '/Trace Time/{match($0, /\([0-9.]+/); print substr($0, RSTART + 1, RLENGTH - 1)}' "$work/log")"
        note "$set tachyon" "$(tachyon "$work/$set.dat" -o "$work/tachyon.png" -format PNG -numthreads 1 2>&1 |
            tr '\r' '\n' | awk '/Ray Tracing Time/{print $(NF - 1)}')"
    done
}

report() {
    local set who
    for set in $sets; do
        for who in cuvette povray tachyon; do row "$set $who" '$1' "$set by $who, s"; done
        for who in povray tachyon; do ratio "$set $who" "$set cuvette" "$set: $who / cuvette"; done
    done
}
