#!/bin/sh
# Print the range "low high" of a PFM map without 1 in 100 pixels at either end, to 2%, because the system may have
# suspended the thread during a pixel. Values of 0 or less are left out.
#   plots/range.sh MAP.pfm
export LC_ALL=C
set -eu

channels=$([ "$(head -c 2 "$1")" = PF ] && echo 3 || echo 1)
tail -c +$(($(head -n 3 "$1" | wc -c) + 1)) "$1" | od -An -v -t f4 -w$((4 * channels)) | awk '
    $1 > 0 {
        bin = int(log($1) * 50 + 5000)
        pixels[bin]++
        count++
        if (!lowest || bin < lowest) lowest = bin
        if (bin > highest) highest = bin
    }
    END {
        if (!count) { print "1 10"; exit }
        for (low = lowest; (below += pixels[low]) <= count / 100; low++);
        for (high = highest; (above += pixels[high]) <= count / 100; high--);
        printf "%.6g %.6g\n", exp((low - 5000) / 50), exp((high + 1 - 5000) / 50)
    }'
