#!/bin/sh
# The middle row of a PFM image of a ball of radius 1, seen from a distance towards its center: for each pixel that
# the ball covers the length
# of the chord, 2 sqrt(1 - b^2) with b the distance of the chord from the center; then red, green and
# blue, linear; tab separated.
#   plots/chord.sh IMAGE.pfm DISTANCE FOV_DEG        fov: vertical
export LC_ALL=C
set -eu

[ "$(head -c 2 "$1")" = PF ] || {
    echo "$0: $1 is no PFM in colour" >&2
    exit 1
}
read -r width height <<END
$(head -n 2 "$1" | tail -n 1)
END
od -An -v -t f4 -w12 -j $(($(head -n 3 "$1" | wc -c) + 12 * (height / 2) * width)) -N $((12 * width)) "$1" |
    awk -v width="$width" -v height="$height" -v distance="$2" -v fov_deg="$3" '
        {
            half = fov_deg * atan2(0, -1) / 360
            slope = (NR - 0.5 - width / 2) / (height / 2) * sin(half) / cos(half)
            b = distance * slope / sqrt(1 + slope ^ 2)
            if (b * b < 1) printf "%.9g\t%s\t%s\t%s\n", 2 * sqrt(1 - b * b), $1, $2, $3
        }'
