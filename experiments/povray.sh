#!/bin/bash
# povray.sh - compare our image of rod.yaml with POV-Ray's of the same scene, as 8-bit sRGB, depth 8: PSNR, and the
# number of pixels that differ by more than 8 of 255, above and below row 424, where the vessel's base begins.
#   experiments/povray.sh [CUVETTE]
# Needs povray (make setup-peers) and gnuplot; the scene is peers/rod.pov. OUT=DIR keeps the images.
# POV-Ray returns black at its depth limit, so render.beyond is black here. It has no priorities: in rod.pov the liquid
# overlaps the glass, and where the two meet at the base POV-Ray shows the ground, although total reflection is certain
# there. With both indices at 1.5, vessel and liquid are one medium, which POV-Ray can also render without any overlap,
# as a vessel filled with glass ("one body"): this shows which of the two images is wrong because of the overlap.
set -euo pipefail
export LC_ALL=C
here=$(cd "$(dirname "$0")" && pwd)
ours=${1:-${CUVETTE:-build/cuvette}}
[ -x "$ours" ] || {
    echo "povray.sh: no program $ours; run make" >&2
    exit 2
}
command -v povray >/dev/null && command -v gnuplot >/dev/null ||
    {
        echo "povray.sh: needs povray (make setup-peers) and gnuplot (make setup)" >&2
        exit 1
    }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# x, y from below, red, green, blue, alpha, type
pixels() { gnuplot -e "set table '$1.txt'; plot '$1' binary filetype=png using 1:2:3 with rgbimage" &&
    grep '^ *[0-9]' "$1.txt"; }
compare() { # compare NAME VESSEL_IOR LIQUID_IOR ONE_BODY
    povray "+I$here/peers/rod.pov" "+O$work/theirs.png" +W800 +H600 +FN8 -D -A -V Declare=DEPTH=8 Declare=ADC=0 \
        "Declare=IOR_GLASS=$2" "Declare=IOR_LIQUID=$3" "Declare=ONE_BODY=$4" >"$work/log" 2>&1 ||
        {
            echo "povray.sh: povray failed: $(tail -n 1 "$work/log")" >&2
            exit 1
        }
    "$ours" render "$here/scenes/rod.yaml" -o "$work/ours.png" --set render.depth=8 --set render.beyond=black \
        --set "vessel.ior=$2" --set "liquid.ior=$3" >"$work/log"
    if [ -n "${OUT:-}" ]; then
        cp "$work/ours.png" "$OUT/$1-ours.png"
        cp "$work/theirs.png" "$OUT/$1-povray.png"
    fi
    paste <(pixels "$work/ours.png") <(pixels "$work/theirs.png") | awk -v name="$1" '
        { part = 599 - $2 < 424 ? 0 : 1; pixels[part]++; worst = 0
          for (c = 3; c <= 5; c++) {
              d = $c - $(c + 7); if (d < 0) d = -d
              sum[part] += d * d; if (d > worst) worst = d
          }
          far[part] += worst > 8 }
        END { for (part = 0; part < 2; part++) {
            mse = sum[part] / (3 * pixels[part])
            printf "%-14s %-18s %8.2f dB %8d of %d pixels\n", name, part ? "rows 424 to 599" : "rows 0 to 423",
                mse ? 10 * log(255 * 255 / mse) / log(10) : 999, far[part], pixels[part] } }'
}

printf '%-14s %-18s %11s %s\n' indices rows PSNR "differ by more than 8"
compare 1.5-1.33 1.5 1.33 0
compare 1.5-1.5 1.5 1.5 0
compare one-body 1.5 1.5 1
