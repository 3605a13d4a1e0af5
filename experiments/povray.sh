#!/bin/bash
# povray.sh - compare our images with POV-Ray's of the same scenes, which it reads from `cuvette scene --export`:
# rod.yaml and five random still lifes (peers/table_scene.awk). One line a scene: PSNR, the share of pixels that differ
# by more than 8 of 255 in a channel, the mean difference of the channels in 255ths, and the largest; as 8-bit sRGB.
#   experiments/povray.sh [SCENE.yaml|SEED]...
# Needs povray (make setup-peers) and gnuplot. CUVETTE=build/cuvette; OUT=DIR keeps scenes, images, and their
# differences (NAME.jpg: ours, POV-Ray's, four times the difference).
# The differences and their causes are in cuvette-povray(7). POV-Ray returns black at its depth limit, and so does
# Cuvette here (render.beyond).
set -euo pipefail
export LC_ALL=C
here=$(cd "$(dirname "$0")" && pwd)
ours=${CUVETTE:-build/cuvette}
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
out=${OUT:-$work}
mkdir -p "$out"

# x, y from below, red, green, blue, alpha, type
pixels() { gnuplot -e "set table '$1.txt'; plot '$1' binary filetype=png using 1:2:3 with rgbimage" &&
    grep '^ *[0-9]' "$1.txt"; }
side_by_side() { # NAME: three images, each half as large
    gnuplot <<END
        set terminal jpeg size 960,240
        set output '$out/$1.jpg'
        set multiplot layout 1,3
        set lmargin 0
        set rmargin 0
        set tmargin 0
        set bmargin 0
        unset border
        unset tics
        unset key
        set autoscale fix
        plot '$work/ours.png' binary filetype=png using 1:2:3 with rgbimage
        plot '$work/theirs.png' binary filetype=png using 1:2:3 with rgbimage
        plot '$work/difference' using 1:2:3:4:5 with rgbimage
END
}
compare() { # NAME SCENE
    "$ours" scene "$2" --set render.depth=8 --set render.beyond=black --export "$out/$1.pov" 2>"$out/$1.notes"
    "$ours" render "$2" -o "$work/ours.png" --set render.depth=8 --set render.beyond=black >"$work/log" 2>&1 ||
        { cat "$work/log" >&2 && exit 1; }
    local size
    size=$(sed -n 's/.* \(+W[0-9]* +H[0-9]*\) .*/\1/p;/+W/q' "$out/$1.pov")
    # shellcheck disable=SC2086 # two words; images are looked for in the working folder
    (cd "$out" && povray "+I$1.pov" "+O$work/theirs.png" $size +FN8 File_Gamma=sRGB -D -A -J -V) >"$work/log" 2>&1 ||
        {
            echo "povray.sh: povray failed: $(grep -i error "$work/log" | head -n 1)" >&2
            exit 1
        }
    paste <(pixels "$work/ours.png") <(pixels "$work/theirs.png") | awk -v name="$1" -v difference="$work/difference" '
        { worst = 0; line = $1 " " $2
          for (c = 3; c <= 5; c++) {
              d = $c - $(c + 7); if (d < 0) d = -d
              sum += d; squares += d * d; if (d > worst) worst = d
              line = line " " (4 * d > 255 ? 255 : 4 * d)
          }
          print line >difference
          far += worst > 8; if (worst > largest) largest = worst }
        END { mse = squares / (3 * NR)
            printf "%-24s %8.2f dB %8.3f %% %8.4f %8d\n", name, mse ? 10 * log(255 * 255 / mse) / log(10) : 999,
                100 * far / NR, sum / (3 * NR), largest }'
    if [ -n "${OUT:-}" ]; then
        cp "$work/ours.png" "$out/$1-ours.png"
        cp "$work/theirs.png" "$out/$1-povray.png"
        side_by_side "$1"
    fi
}

printf '%-24s %11s %10s %8s %8s\n' scene PSNR 'over 8' mean largest
(($# > 0)) || set -- "$here/scenes/rod.yaml" 1 2 3 4 5
for scene; do
    if [[ $scene =~ ^[0-9]+$ ]]; then
        cp "$here/scenes/chequer.png" "$out/"
        awk -v seed="$scene" -v texture=chequer.png -f "$here/peers/table_scene.awk" >"$out/table-$scene.yaml"
        compare "table-$scene" "$out/table-$scene.yaml"
    else
        name=${scene##*/}
        compare "${name%.yaml}" "$scene"
    fi
done
