#!/bin/sh
# The tiles of a frame from its timeline (Chrome trace JSON): begin and end in ms, worker, and the tile's
# position in the image in reading order (0 first, 1 last).
#   plots/timeline.sh TIMELINE.json [GAP]
# With GAP, tiles of one worker that follow within GAP ms are one, with their mean position: a thousand
# workers have more tiles than a figure has pixels.
export LC_ALL=C
set -eu

awk 'function value(name) {
         if (!match($0, "\"" name "\": *[-+0-9.eE]+")) return "NA"
         text = substr($0, RSTART, RLENGTH)
         sub(/.*: */, "", text)
         return text
     }
     # The name of a tile is its corner: "32,64-..." or "tile 32,64".
     function corner(which) {
         match($0, "\"name\": *\"[^\"]*\"")
         text = substr($0, RSTART + 6, RLENGTH - 6)
         gsub(/[^0-9]+/, " ", text)
         split(text, at, " ")
         return at[which]
     }
     BEGIN { RS = "}" }
     /"ph": *"X"/ { print corner(2), corner(1), value("ts") / 1e3, (value("ts") + value("dur")) / 1e3, value("tid") }' \
    "$1" |
    sort -n -k 1,1 -k 2,2 |
    awk '{ begin[NR] = $3; end[NR] = $4; worker[NR] = $5 }
         END { for (i = 1; i <= NR; i++) print begin[i], end[i], worker[i], (NR > 1 ? (i - 1) / (NR - 1) : 0) }' |
    if [ $# -lt 2 ]; then cat; else
        sort -n -k 3,3 -k 1,1 |
            awk -v gap="$2" 'function put() { if (count) print begin, end, worker, sum / count }
                NR == 1 || $3 != worker || $1 - end > gap { put(); begin = $1; count = sum = 0 }
                { end = $2; worker = $3; count++; sum += $4 }
                END { put() }'
    fi
