#!/bin/sh
# What sixteenths of the image cost, at other fields of view of the rod's scene: the published picture is not known,
# and the wider the view, the fewer columns have the vessel. Prints a table: the field of view (degrees), and the rays
# of each sixteenth of the columns, from left to right. The model of the speed-up reads it (paper/scaling.sh).
#   experiments/views.sh [CUVETTE] >results/reference/tables/maps-views.tsv
export LC_ALL=C
set -eu

program=${1:-build/cuvette}
here=$(cd "$(dirname "$0")" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
printf 'fov_deg\trays\n'
for view in 30 40 45 50 55 60 65 70 75 80 90 100 110; do
    "$program" render --set render.depth=4 --set "camera.fov_deg=$view" --rays="$work/rays.pfm" \
        --output="$work/image.png" "$here/scenes/rod.yaml" >/dev/null 2>&1
    "$here/../paper/cost.sh" "$work/rays.pfm" |
        awk -v view="$view" '$1 == "column" { sum[int(i++ * 16 / 800)] += $2 }
            END { printf "%s\t", view; for (b = 0; b < 16; b++) printf "%d%s", sum[b], b < 15 ? " " : "\n" }'
done
