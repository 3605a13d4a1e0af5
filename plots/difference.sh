#!/bin/sh
# The luminance of one PFM minus that of another, one line a pixel: x, y from the bottom, difference; then the
# differences of red, green and blue.
#   plots/difference.sh IMAGE FROM
# Luminance: Y = 0.2126 R + 0.7152 G + 0.0722 B (ITU-R BT.709), of the linear light in a PFM.
export LC_ALL=C
set -eu

numbers() {
    tail -c +$(($(head -n 3 "$1" | wc -c) + 1)) "$1" | od -An -v -t f4 -w12
}

size=$(head -n 2 "$1" | tail -n 1)
[ "$size" = "$(head -n 2 "$2" | tail -n 1)" ] || {
    echo "$0: $1 and $2 differ in size" >&2
    exit 1
}
pipe=$(mktemp -u)
mkfifo -m 600 "$pipe"
trap 'rm -f "$pipe"' EXIT
numbers "$2" >"$pipe" &
numbers "$1" | paste - "$pipe" | awk -v width="${size% *}" '{
    red = $1 - $4; green = $2 - $5; blue = $3 - $6
    printf "%d %d %.6g %.6g %.6g %.6g\n", (NR - 1) % width, int((NR - 1) / width),
        0.2126 * red + 0.7152 * green + 0.0722 * blue, red, green, blue
}'
