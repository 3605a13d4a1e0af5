#!/bin/sh
# One pixel of a PFM image, by default the middle one: red, green and blue, linear, tab separated.
#   plots/pixel.sh IMAGE.pfm [X Y]        X from the left, Y from the bottom, both from 0
export LC_ALL=C
set -eu

[ "$(head -c 2 "$1")" = PF ] || {
    echo "$0: $1 is not a colour PFM" >&2
    exit 1
}
read -r width height <<END
$(head -n 2 "$1" | tail -n 1)
END
at=$((${3:-$((height / 2))} * width + ${2:-$((width / 2))}))
od -An -v -t f4 -w12 -j $(($(head -n 3 "$1" | wc -c) + 12 * at)) -N 12 "$1" |
    awk '{ printf "%s\t%s\t%s\n", $1, $2, $3 }'
