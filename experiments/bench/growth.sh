# shellcheck shell=bash
# growth: the table of plots/growth*.gp: time and memory by solids, lights, triangles, pixels, depth (8 minutes)
# What no study can sweep: solids and lights, and the memory of fresh processes (in a study, a process has the memory of
# earlier cells as well). SIZE=400x300, SOLIDS="1 3 10 ... 1000000", LIGHTS="1 4 ... 1000" (among 64 solids),
# TRIANGLES="1000 ... 10000000", SIZES="100x75 ... 16384x12288", DEPTHS="0 ... 14" (of the tree of rays), LEVELS="0 ...
# 64" (the depth of random paths).
# Scenes: random_scene.awk with seed 1, soup.yaml, rod.yaml; one thread; depth 4, triangles 0; paths: 4 a pixel. A round
# renders every scene once. Times are CPU times of tracing, without reading the scene and building its hierarchy.
size=${SIZE:-400x300}
solids=${SOLIDS:-1 3 10 30 64 100 300 1000 3000 10000 30000 100000 300000 1000000}
lights=${LIGHTS:-1 4 16 64 256 1000}
triangles=${TRIANGLES:-1000 10000 100000 1000000 10000000} depths=${DEPTHS:-0 2 4 6 8 10 12 14}
levels=${LEVELS:-0 1 2 4 8 16 32 64}
sizes=${SIZES:-100x75 200x150 400x300 800x600 1600x1200 3200x2400 6400x4800 16384x12288}

runs=()
add() { runs+=("$*"); } # add SERIES N SCENE SIZE [SET...]
prepare() {
    local n s kind
    for n in $solids; do add solids "$n" "$(spheres 1 "$n" 1)" "$size"; done
    for n in $lights; do add lights "$n" "$(spheres 1 64 "$n")" "$size"; done
    for n in $lights; do
        add lights-path "$n" "$(spheres 1 64 "$n")" "$size" render.integrator=path render.paths=4
    done
    for kind in sparse sphere; do
        for n in $triangles; do
            add $kind "$n" "$here/scenes/soup.yaml" "$size" soup.generate=$kind soup.count="$n"
        done
    done
    for s in $sizes; do add pixels $((${s%x*} * ${s#*x})) "$here/scenes/rod.yaml" "$s"; done
    for n in $depths; do add depth "$n" "$here/scenes/rod.yaml" "$size" render.depth="$n"; done
    for n in $levels; do
        add depth-path "$n" "$here/scenes/rod.yaml" "$size" render.integrator=path render.paths=4 render.depth="$n"
    done
}
round() {
    local run series n scene frame sets row value
    for run in "${runs[@]}"; do
        read -r series n scene frame sets <<<"$run"
        # shellcheck disable=SC2086 # a list of words without blanks
        "$ours" render "$scene" --json $(printf -- ' --set %s' render.threads=1 "render.width=${frame%x*}" \
            "render.height=${frame#*x}" $sets) >"$work/json" 2>"$work/err" || {
            echo "$name: $series $n is left out: $(tail -n 1 "$work/err")" >&2 # a machine of little memory
            continue
        }
        row="$series $n"
        for value in cpu_s total camera peak_rss_bytes; do row+=" $(field $value <"$work/json")"; done
        echo "$row"
    done >>"$work/rows"
}

report() {
    awk "$order"'
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
        }' "$work/rows"
}
