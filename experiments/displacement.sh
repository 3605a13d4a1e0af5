#!/bin/bash
# displacement.sh - how far the filled vessel moves what is seen through it, as CSV for plots/displacement.gp.
#   experiments/displacement.sh [CUVETTE] >results/displacement/points.csv
# For a lattice of pixels whose camera rays hit vessel or liquid first: the point of the rod or the ground where the
# refracted ray ends, and where the camera would see that point without vessel and liquid (a pinhole's projection). Rays
# that end in the sky, or that are totally reflected on their path, are left out. STEP: distance of the pixels, 12.
#   x, y            centre of the pixel, px from the left and from the top
#   solid           where the ray ends: rod or ground
#   bare_x, bare_y  where that point is seen without vessel and liquid, px
# Exact up to rounding; a check: the first hit of each ray must project onto the pixel it was sent through.
set -euo pipefail
export LC_ALL=C
cd "$(dirname "$0")/.."
cuvette=${1:-${CUVETTE:-build/cuvette}}
scene=experiments/scenes/rod.yaml
step=${STEP:-12}
[ -x "$cuvette" ] || {
    echo "displacement.sh: no program $cuvette; run make" >&2
    exit 2
}
view=$("$cuvette" params "$scene" | sed -n 's/^camera\.\(position\|target\|fov_deg\) *\([^ ]*\).*/\2/p' | tr ',\n' '  ')
width=800 height=600

# A weight above that of any reflected ray, and below that of any refracted one, leaves one path of each tree.
paths() {
    local x y
    for ((y = step / 2; y < height; y += step)); do
        for ((x = step / 2; x < width; x += step)); do
            echo "pixel $x $y"
            "$cuvette" trace "$scene" --pixel "$x,$y" --json --depth 16 --set render.shadows=off \
                --set render.min_weight=0.3 --set render.width=$width --set render.height=$height
        done
    done
}

paths | awk -v view="$view" -v width=$width -v height=$height '
    function vector(text, name, v) {
        if (!match(text, "\"" name "\":[[][^]]*")) return 0
        split(substr(text, RSTART + length(name) + 4, RLENGTH - length(name) - 4), v, ",")
        return 1
    }
    function unit(v,   n, i) { n = sqrt(v[1]^2 + v[2]^2 + v[3]^2); for (i = 1; i <= 3; i++) v[i] /= n }
    function dot(a, b) { return a[1] * b[1] + a[2] * b[2] + a[3] * b[3] }
    # Sets px and py to where the camera sees a point; y is up in the scene and down in the image.
    function project(point,   d, i) {
        for (i = 1; i <= 3; i++) d[i] = point[i] - eye[i]
        px = width / 2 + focal * dot(d, right) / dot(d, ahead)
        py = height / 2 - focal * dot(d, up) / dot(d, ahead)
    }
    BEGIN {
        split(view, v, " ") # position, target, field of view in degrees
        for (i = 1; i <= 3; i++) { eye[i] = v[i]; target[i] = v[i + 3] }
        focal = height / 2 / tan_of(v[7] / 2 * atan2(0, -1) / 180)
        for (i = 1; i <= 3; i++) ahead[i] = target[i] - eye[i]
        unit(ahead)
        # right = (0, 1, 0) x ahead, in a left-handed frame: x to the right, y up, z away.
        right[1] = ahead[3]; right[2] = 0; right[3] = -ahead[1]; unit(right)
        up[1] = ahead[2] * right[3] - ahead[3] * right[2]
        up[2] = ahead[3] * right[1] - ahead[1] * right[3]
        up[3] = ahead[1] * right[2] - ahead[2] * right[1]
        print "x,y,solid,bare_x,bare_y"
    }
    function tan_of(a) { return sin(a) / cos(a) }
    function put() {
        if (!through || end == "" || reflected) return
        project(last)
        printf "%g,%g,%s,%.4f,%.4f\n", x, y, end, px, py
    }
    /^pixel/ { put(); x = $2 + 0.5; y = $3 + 0.5; end = ""; through = reflected = 0; next }
    /"kind":"camera"/ {
        if (vector($0, "point", hit)) {
            project(hit)
            if ((px - x)^2 + (py - y)^2 > 1e-12) {
                print "displacement.sh: wrong projection at " x "," y >"/dev/stderr"
                exit failed = 1
            }
        }
        through = /"hit":{"solid":"(vessel|liquid)"/
    }
    /"kind":"reflect"/ && /"hit":{/ { reflected = 1 }
    /"opaque":true/ {
        match($0, /"hit":{"solid":"[a-z]+/)
        end = substr($0, RSTART + 16, RLENGTH - 16)
        vector($0, "point", last)
    }
    END { if (!failed) put() }'
