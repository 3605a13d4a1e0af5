#!/bin/bash
# mesh_frames.sh - whole frames of the triangle sets, one thread, 800x600, camera and shadow rays, compared with POV-Ray
# and Tachyon in the same rounds.
#   experiments/mesh_frames.sh
# Environment: CUVETTE (the program), REPS=5 (rounds), SETS="sparse:50000 ...".
# Needs povray and tachyon (make setup-peers).
# Each program reports its own time of tracing, without reading, building and writing. Ratios are computed for each
# round; the table has their medians and ranges.
set -euo pipefail
export LC_ALL=C
cuvette=${CUVETTE:-build/cuvette} reps=${REPS:-5}
sets=${SETS:-sparse:50000 dense:50000 sphere:50000}
scene=$(dirname "$0")/scenes/soup.yaml
for peer in povray tachyon; do
    command -v "$peer" >/dev/null ||
        {
            echo "mesh_frames.sh: $peer is not installed; make setup-peers installs it" >&2
            exit 2
        }
done
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

for set in $sets; do
    "$cuvette" mesh --generate "${set%:*}" --count "${set#*:}" -f obj -o "$work/$set.obj"
    awk -v peer=povray -f "$(dirname "$0")/peers/mesh_scene.awk" "$work/$set.obj" >"$work/$set.pov"
    awk -v peer=tachyon -f "$(dirname "$0")/peers/mesh_scene.awk" "$work/$set.obj" >"$work/$set.dat"
done

# Rows of "round set contestant seconds".
for ((round = 0; round < reps; round++)); do
    for set in $sets; do
        echo "$round $set cuvette $("$cuvette" render "$scene" --set soup.generate="${set%:*}" --set \
            soup.count="${set#*:}" --repeat 3 --json -o "$work/ours.png" |
            sed -n 's/^ *"wall_s": \([0-9.e-]*\),*/\1/p' | head -1)"
        povray +I"$work/$set.pov" +O"$work/pov.png" +W800 +H600 -D -A -V +WT1 >"$work/log" 2>&1
        echo "$round $set povray $(awk \
            '/Trace Time/{match($0, /\([0-9.]+/); print substr($0, RSTART + 1, RLENGTH - 1)}' "$work/log")"
        echo "$round $set tachyon $(tachyon "$work/$set.dat" -o "$work/tachyon.png" -format PNG -numthreads 1 2>&1 |
            tr '\r' '\n' |
            awk '/Ray Tracing Time/{print $(NF - 1)}')"
    done
done >"$work/rows"

awk -v sets="$sets" "$(<"$(dirname "$0")/order.awk")"'
    function ratios(set, a,   i, list) {
        for (i = 0; i < rounds; i++) list = list " " at[i, set, a] / at[i, set, "cuvette"]
        return spread(list, "%.2f")
    }
    { s[$2, $3] = s[$2, $3] " " $4; at[$1, $2, $3] = $4; rounds = $1 + 1 }
    END {
        printf "%-14s %9s %9s %9s  %-24s %s\n",
            "seconds", "cuvette", "POV-Ray", "Tachyon", "POV-Ray/cuvette", "Tachyon/cuvette"
        n = split(sets, set, " ")
        for (i = 1; i <= n; i++)
            printf "%-14s %9.3f %9.3f %9.3f  %-24s %s\n",
                set[i], median(s[set[i], "cuvette"]), median(s[set[i], "povray"]),
                median(s[set[i], "tachyon"]), ratios(set[i], "povray"), ratios(set[i], "tachyon")
    }' "$work/rows"
