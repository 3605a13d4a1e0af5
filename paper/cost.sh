#!/bin/sh
# Print what the pieces of an image cost, as a table (kind, rays), from a map of rays by pixel (PFM): each column,
# each row, and each square of 8 by 8 pixels, in the order of the image. Larger tiles are sums of squares.
#   paper/cost.sh MAP-rays.pfm
export LC_ALL=C
set -eu

size=$(head -n 2 "$1" | tail -n 1)
tail -c +$(($(head -n 3 "$1" | wc -c) + 1)) "$1" | od -An -v -t f4 -w12 |
    awk -v width="${size% *}" -v height="${size#* }" '
    BEGIN { OFS = "\t"; across = int((width + 7) / 8) }
    {
        # PFM rows run from the bottom.
        x = (NR - 1) % width
        y = height - 1 - int((NR - 1) / width)
        column[x] += $1
        row[y] += $1
        square[int(y / 8) * across + int(x / 8)] += $1
    }
    END {
        print "kind", "rays"
        for (i = 0; i < width; i++) print "column", column[i]
        for (i = 0; i < height; i++) print "row", row[i]
        for (i = 0; i < across * int((height + 7) / 8); i++) print "square", square[i]
    }'
