#!/bin/sh
# Print the bound on the speed-up of fixed blocks, as \setval{blocks/...} lines, from a map of rays by pixel (PFM):
# all rays of the image divided by the rays of its largest block, for columns and rows divided among n threads as in
# the renderer, ceil(size / n) for each; and for columns if at most four or eight threads run at a time.
#   paper/blocks.sh MAP-rays.pfm
export LC_ALL=C
set -eu

size=$(head -n 2 "$1" | tail -n 1)
tail -c +$(($(head -n 3 "$1" | wc -c) + 1)) "$1" | od -An -v -t f4 -w12 |
    awk -v width="${size% *}" -v height="${size#* }" '
    function gain(lines, count, threads,   each, i, sum, largest) {
        each = int((count + threads - 1) / threads)
        for (i = 0; i < count; i++) {
            if (i % each == 0) sum = 0
            sum += lines[i]
            if (sum > largest) largest = sum
        }
        return all / largest
    }
    {
        column[(NR - 1) % width] += $1
        # PFM rows run from the bottom.
        row[height - 1 - int((NR - 1) / width)] += $1
        all += $1
    }
    END {
        for (n = 1; n <= 1024; n *= 2) {
            printf "\\setval{blocks/columns/%d}{%.2f}\n", n, gain(column, width, n)
            printf "\\setval{blocks/rows/%d}{%.2f}\n", n, gain(row, height, n)
            bound = gain(column, width, n)
            printf "\\setval{blocks/four/%d}{%.2f}\n", n, bound < 4 ? bound : 4
            printf "\\setval{blocks/eight/%d}{%.2f}\n", n, bound < 8 ? bound : 8
        }
    }'
