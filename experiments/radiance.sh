#!/bin/bash
# radiance.sh - compare render.radiance with path tracing, which is exact if eye and lamp are in one medium: a matte
# floor under flat water, a lamp of radius 150 at 500 above the floor.
#   experiments/radiance.sh [CUVETTE]
# 1. The ratio of Whitted's radiance to that of path tracing, for a floor of albedo 0.01 that is 1 under water, seen
#    from air at 21.8 degrees. Required: basic is 1.00 +- 0.01.
# 2. The sky of radiance 1 seen from under water, straight up, compared with n^2 T and T.
# 3. Deeper water: a shadow ray is straight and ignores that the surface focuses light. Compared with
#    (h + d / n)^2 / (h + d)^2, the closed form for a lamp at the height h above water of depth d, near the axis.
# 4. Brighter floors: only path tracing follows light that is reflected between floor and surface. Compared with
#    1 - albedo r, where r is the reflectance of the surface for diffuse light from below.
# 3 and 4 have no required value. The figure after +- is the standard error of the mean over pixels.
# PATHS=N: paths a pixel of 256; 40960 unless given.
set -euo pipefail
export LC_ALL=C
cuvette=${1:-${CUVETTE:-build/cuvette}}
paths=${PATHS:-40960}
[ -x "$cuvette" ] || {
    echo "radiance.sh: no program $cuvette; run make" >&2
    exit 2
}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

cat >"$work/pond.yaml" <<'END'
background: {color: [0, 0, 0]}
render: {width: 16, height: 16, depth: 3, beyond: black}
camera: {fov_deg: 0.2}
lights: {lamp: {position: [0, 500, 0], intensity: 100, reach: 500}}
solids:
  floor: {shape: plane, diffuse: 0.01, priority: 2}
  water: {shape: box, size: [40000, 2, 40000], transparency: 1}
END
from_air=(camera.position=0,201,80.4 camera.target=0,0.5,0)
from_water=(camera.position=0,0.4,0.3 camera.target=0,0,0)

# The mean of the red channel and its standard error.
mean() { # mean ASSIGNMENT...
    local options=() one
    for one in "$@"; do options+=(--set "$one"); done
    "$cuvette" render "$work/pond.yaml" -o "$work/pond.pfm" "${options[@]}" >"$work/log" 2>&1 ||
        {
            cat "$work/log" >&2
            exit 1
        }
    tail -n +4 "$work/pond.pfm" | od -An -v -t f4 -w12 |
        awk '{ sum += $1; squares += $1 * $1; n++ }
             END { mean = sum / n; spread = squares / n - mean * mean
                   printf "%.9g %.2g\n", mean, sqrt((spread > 0 ? spread : 0) / (n - 1)) }'
}

ratios() { # ratios ASSIGNMENT... - Whitted / paths, classic and basic, and the relative standard error of the paths
    local random classic basic
    random=$(mean "$@" render.integrator=path "render.paths=$paths" lamp.radius=150 render.radiance=basic)
    classic=$(mean "$@") basic=$(mean "$@" render.radiance=basic)
    echo "$classic $basic $random" | awk '{ printf "%.4f %.4f %.4f\n", $1 / $5, $3 / $5, $6 / $5 }'
}

indices='1 1.333 1.5 1.8'
echo '1. Whitted / paths, dark floor 1 under water'
printf '%8s %10s %10s %10s\n' n classic basic +-
for n in $indices; do
    read -r classic basic error < <(ratios "${from_air[@]}" "water.ior=$n")
    printf '%8s %10s %10s %10s\n' "$n" "$classic" "$basic" "$error"
done

echo '2. The sky seen from under water'
printf '%8s %10s %10s %10s %10s\n' n classic T basic 'n^2 T'
for n in $indices; do
    sky=(camera.position=0,0.5,0 camera.target=0,1,0 render.depth=1 background.color=1,1,1 floor.visible=off
        "water.ior=$n")
    read -r classic _ < <(mean "${sky[@]}")
    read -r basic _ < <(mean "${sky[@]}" render.radiance=basic)
    echo "$n $classic $basic" |
        awk '{ T = 4 * $1 / ($1 + 1)^2; printf "%8s %10.6f %10.6f %10.6f %10.6f\n", $1, $2, T, $3, $1 * $1 * T }'
done

echo '3. Deeper water, dark floor: Whitted with basic radiance / paths'
printf '%8s %10s %10s %10s %10s\n' n 'd/(h+d)' basic form +-
for n in 1.333 1.5 1.8; do
    for depth in 1 10 50 150; do
        read -r _ basic error < <(ratios "${from_water[@]}" "water.ior=$n" "water.size.y=$((2 * depth))")
        echo "$n $depth $basic $error" |
            awk '{ d = $2 / 500; printf "%8s %10g %10.4f %10.4f %10s\n", $1, d, $3, (1 - d + d / $1)^2, $4 }'
    done
done

echo '4. Brighter floors, 1 under water: Whitted with basic radiance / paths'
printf '%8s %10s %10s %10s %10s\n' n albedo basic form +-
for n in 1.333 1.5 1.8; do
    for albedo in 0.01 0.1 0.5 0.9; do
        read -r _ basic error < <(ratios "${from_water[@]}" "water.ior=$n" "floor.diffuse=$albedo" render.depth=32)
        echo "$n $albedo $basic $error" | awk '
            function R(c, n,    t, s, p) { # from within
                t = 1 - n * n * (1 - c * c); if (t <= 0) return 1
                t = sqrt(t); s = (n * c - t) / (n * c + t); p = (c - n * t) / (c + n * t); return (s * s + p * p) / 2 }
            { for (k = 0; k < 4000; k++) r += R(sqrt((k + 0.5) / 4000), $1) / 4000 # the cosine law is even in cos^2
              printf "%8s %10s %10.4f %10.4f %10s\n", $1, $2, $3, 1 - $2 * r, $4 }'
    done
done
