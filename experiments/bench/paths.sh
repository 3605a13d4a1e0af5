# shellcheck shell=bash
# paths: error against time of random paths on five scenes, with earlier settings and Blender's Cycles
# The defaults (new: scrambled Sobol points, box filter, one light per surface), those of earlier versions (old: Philox,
# pixel centres, all lights), and Cycles, which is left out where blender is missing (make setup-peers). Its scenes are
# alike except that its sphere light is a disc (peers/cycles.py): the means of the films, the last column, differ by 2%
# on matte and glass and by less than 1% on the others.
# 1. For each number of paths: the root mean square error of a film value, its time, and the ratio of the reported noise
#    to the error. The error is the standard deviation over SEEDS films, which needs no reference: the mean of a film is
#    exact. Required: the ratio is 0.9..1.1, except where few bright paths make up the error (glass with old).
# 2. The slopes of error against paths, and the time of new over that of old at the error that old has with the most
#    paths, on the line through the logarithms of new's errors and times. The box filter is a mean over the pixel, whose
#    edges add to its error; `box` on matte has the earlier sampler with that filter.
# 3. 64 lights over one light: time at the error that one light has with the most paths. Required: at most 4.
# SEEDS=6, COUNTS="16 64 256" (paths a pixel), SCENES="matte glass room models lights64"; TABLE=FILE: also writes the
# measured lines there, for plots/paths.gp. Times are those of the processor with one thread, medians over the seeds.
reps=1 seeds=${SEEDS:-6} counts=${COUNTS:-16 64 256}

view='camera: {position: [0, 2, -5], target: [0, 0.7, 0], fov_deg: 40}
background: {color: [0.2, 0.25, 0.3]}'
things='solids:
  floor: {shape: plane, color: [0.9, 0.6, 0.3], diffuse: 0.7}
  ball: {shape: sphere, position: [-0.8, 0.8, 0], radius: 0.7, diffuse: 0.8}
  stone: {shape: box, position: [0.8, 0.7, 0], size: [1, 1.4, 1], rotation: [0, 30, 0], diffuse: 0.8}'
lamp='lights: {lamp: {position: [3, 5, -2], intensity: 1, reach: 5, radius: 1}}'
prepare() {
    printf '%s\n' "$view" "$things" "$lamp" >"$work/matte.yaml"
    sed 's/stone:.*/glass: {shape: sphere, position: [0.8, 0.8, 0], radius: 0.7, transparency: 1, ior: 1.5}/' \
        "$work/matte.yaml" >"$work/glass.yaml"
    cat >"$work/room.yaml" <<'END'
camera: {position: [0.1, 0.2, -2], target: [0.7, 0, 1], fov_deg: 90}
background: {color: [0, 0, 0]}
solids:
  wall: {shape: sphere, radius: 9, diffuse: 0.6}
  hollow: {shape: sphere, radius: 3, transparency: 1, ior: 1, priority: 1}
  lamp: {shape: sphere, radius: 0.7, position: [0.5, 1.5, 1.5], emission: 3, priority: 2}
  stone: {shape: box, position: [-0.5, -1, 0.5], size: [0.8, 0.8, 0.8], diffuse: 0.7, priority: 3}
END
    awk -v count=64 'BEGIN { srand(5); print "lights:"
        for (k = 0; k < count; k++)
            printf "  l%d: {position: [%.3f, %.3f, %.3f], intensity: %.4f, reach: 5, radius: 0.1}\n", k,
                10 * rand() - 5, 4.5 + 2 * rand(), 8 * rand() - 5, (0.5 + rand()) / count }' >"$work/lights"
    { printf '%s\n' "$view" "$things" && cat "$work/lights"; } >"$work/lights64.yaml"
    { printf '%s\n' "$view" "$things" && sed 2q "$work/lights" | sed 's/intensity: [0-9.]*/intensity: 1/'; } \
        >"$work/lights1.yaml"
    # Without textures and highlights, which Cycles does differently.
    sed -e 's/texture: tiles, //' -e 's/specular: [0-9.]*/specular: 0/' -e '/^textures:/,/^$/d' \
        "$here/scenes/models.yaml" >"$work/models.yaml"
}

old=(render.sampler=philox render.filter=centre render.light_sampling=all)
box=(render.sampler=philox render.filter=box render.light_sampling=all)
new=(render.sampler=sobol render.filter=box render.light_sampling=one)

# Error, median time in seconds, reported noise over error.
measure() { # measure SCENE PATHS ASSIGNMENT...
    local scene=$1 paths=$2 options=() one seed
    shift 2
    for one in "$@"; do options+=(--set "$one"); done
    : >"$work/times"
    : >"$work/noise"
    for seed in $(seq 1 "$seeds"); do
        "$ours" render "$work/$scene.yaml" -o "$work/film$seed.pfm" --json --set render.width=64 \
            --set render.height=48 --set render.depth=4 --set render.integrator=path --set render.threads=1 \
            --set render.beyond=black --set render.shadows=opaque --set "render.paths=$paths" \
            --set "render.seed=$seed" "${options[@]}" >"$work/json" 2>"$work/log" ||
            failed render "$work/log"
        field cpu_s <"$work/json" >>"$work/times"
        field rms <"$work/json" >>"$work/noise"
    done
    statistics "$work"/film
}

statistics() { # statistics FILMS: of FILMS1.pfm and so on, with their times and noise
    local seed
    for seed in $(seq 1 "$seeds"); do tail -n +4 "$1$seed.pfm" | od -An -v -t f4 -w4 >"$work/values$seed"; done
    paste "$work"/values* | awk -v noise="$(awk '{ s += $1 * $1 } END { print s / NR }' "$work/noise")" \
        -v time="$(sort -g "$work/times" | sed -n "$(((seeds + 1) / 2))p")" '
        { sum = squares = 0
          for (i = 1; i <= NF; i++) { sum += $i; squares += $i * $i }
          total += sum / NF
          variance += (squares - sum * sum / NF) / (NF - 1) }
        END { error = sqrt(variance / NR)
              fraction = noise > 0 ? sprintf("%.3f", sqrt(noise) / error) : "NA"
              printf "%.5g %.4g %s %.5f\n", error, time, fraction, total / NR }'
}

curve() { # curve SCENE LABEL ASSIGNMENT... - a line per number of paths
    local scene=$1 label=$2 paths
    shift 2
    for paths in $counts; do echo "$scene $label $paths $(measure "$scene" "$paths" "$@")"; done
}

# Cycles samples emitting solids like lights: it reaches the lamp of the room from the last surface as well.
cycles() { # cycles SCENE - a line per number of samples
    local depth=4 paths mesh one profile
    profile=$(sed -n 's/.*profile: \[\(.*\)\].*/\1/p' "$work/models.yaml" | tr -d ' ')
    [ "$1" != room ] || depth=3
    "$ours" params "$work/$1.yaml" --json >"$work/scene.json"
    [ "$1" != models ] || for one in floor:box:--size=16,0.1,16 ball:icosphere:--level=6 \
        torus:torus:--major=0.75:--minor=0.28:--around=160:--tube=80 \
        lathe:lathe:--around=96:--profile="$profile"; do
        IFS=: read -ra mesh <<<"$one"
        "$ours" mesh --generate "${mesh[1]}" "${mesh[@]:2}" -f obj -o "$work/${mesh[0]}.obj"
    done
    blender -b --factory-startup --python-exit-code 1 --python "$here/peers/cycles.py" -- "$work/scene.json" \
        "$work/cycles" samples="${counts// /,}" seeds="$(seq -s, 1 "$seeds")" depth="$depth" width=64 height=48 \
        meshes="$work" >"$work/log" 2>&1 || failed blender "$work/log"
    echo 0 >"$work/noise"
    for paths in $counts; do
        sed -n "s/^cycles $paths [0-9]* //p" "$work/log" >"$work/times"
        echo "$1 cycles $paths $(statistics "$work/cycles-$paths-")"
    done
}

round() {
    local scene
    echo 'scene settings paths error time_s noise/error mean'
    for scene in ${SCENES:-matte glass room models lights64}; do
        curve "$scene" old "${old[@]}"
        curve "$scene" new "${new[@]}"
        if command -v blender >/dev/null; then cycles "$scene"; fi
    done | tee "$work/table"
    curve matte box "${box[@]}" | tee -a "$work/table"
    curve lights1 new "${new[@]}" | tee -a "$work/table"
}

report() {
    awk '
        # Of a value against another, on the line between the first and the last point.
        function rise(of, by, key) {
            return log(of[key, last[key]] / of[key, 1]) / log(by[key, last[key]] / by[key, 1])
        }
        function time_at(key, e) {
            return time[key, last[key]] * exp(log(e / error[key, last[key]]) * rise(time, error, key))
        }
        { key = $1 " " $2; n = ++last[key]; paths[key, n] = $3; error[key, n] = $4; time[key, n] = $5 }
        !seen[$1]++ { order[++scenes] = $1 }
        END {
            print "\nscene slope_old slope_new time_new/time_old; slope_cycles time_cycles/time_new"
            for (i = 1; i <= scenes; i++) {
                o = order[i] " old"; w = order[i] " new"
                if (last[o])
                    printf "%s %.2f %.2f %.3f", order[i], rise(error, paths, o), rise(error, paths, w), \
                           time_at(w, error[o, last[o]]) / time[o, last[o]]
                c = order[i] " cycles"
                if (last[c])
                    printf "; %.2f %.2f", rise(error, paths, c), time[c, last[c]] / time_at(w, error[c, last[c]])
                if (last[o])
                    print ""
            }
            o = "matte box"; w = "matte new"
            printf "\nmatte, both with the box filter: slope %.2f %.2f, time %.3f\n", rise(error, paths, o), \
                   rise(error, paths, w), time_at(w, error[o, last[o]]) / time[o, last[o]]
            w = "lights1 new"
            printf "\n64 lights over one, at one error: %.2f times the time\n", \
                   time_at("lights64 new", error[w, last[w]]) / time[w, last[w]]
        }' "$work/table"
    if [ -n "${TABLE:-}" ]; then
        { echo 'scene settings paths error time_s noise/error mean' && cat "$work/table"; } | tr ' ' '\t' >"$TABLE"
    fi
}
