#!/bin/bash
# `cuvette study plot` as a user meets it: formats, names, scripts that redraw from any folder, sheets, errors; and the
# committed rows of every study of experiments/. Drawings need gnuplot with pngcairo; without it they are skipped.
# study_plot.sh [PROGRAM]. One line per check ("ok ...", "not ok ...").
set -uo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
program=$(realpath "${1:-${CUVETTE:-$root/build/cuvette}}")
work=$(mktemp -d "${TMPDIR:-/tmp}/cuvette-plot.XXXXXX") || exit 1
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1
gnuplot -e 'set terminal pngcairo' 2>/dev/null || {
    echo "ok 1 # SKIP gnuplot with pngcairo is not installed"
    exit 77
}

# shellcheck source=tests/shell/await.sh
source "$root/tests/shell/await.sh"

count=0 failed=0
check() { # WHAT COMMAND...
    local what=$1
    shift
    count=$((count + 1))
    if "$@"; then
        echo "ok $count - $what"
    else
        failed=$((failed + 1))
        echo "not ok $count - $what"
        sed 's/^/# /' out err
    fi
}
run() {
    "$program" study plot --results res "$@" >out 2>err
    code=$?
}
clean() { ((code == 0)) && [[ ! -s err ]]; }
refused() { ((code == 2)) && [[ $(wc -l <err) == 1 ]] && grep -q -- "$1" err; } # PART OF THE ERROR
magic() { [[ $(head -c "${#2}" "$1") == "$2" ]]; }                              # FILE TEXT
is_png() { [[ $(head -c 4 "$1" | tail -c 3) == PNG ]]; }

cat >own.study <<END
study: own
title: It's a "study" of {two} axes
scene: $root/experiments/scenes/rod.yaml
set: {render.width: 40, render.height: 30, render.threads: 1}
grid:
  - {render.depth: [0, 1, 2]}
  - {liquid.ior: [1.2, 1.33, 1.5]}
repetitions: 6
warmups: 0
keep: {image: on}
END
sed -e 's/^study: .*/study: words/' -e '/liquid.ior/d' \
    -e 's/render.depth: .*/render.schedule: [rows, tiles, dynamic]}/' \
    -e 's/repetitions: .*/repetitions: 2/' -e '/^keep/d' own.study >words.study
"$program" study run --quiet --results res own.study words.study || exit 1

film=$(awk -F, 'NR == 1 {for (i = 1; i <= NF; i++) at[$i] = i}
    $at["cell"] == 5 {print $at["film_hash"]; exit}' res/own/rows.csv)
check "the image of a cell holds its scene" grep -q "\"film_hash\": *\"${film:-none}\"" \
    <("$program" render res/own/images/0005.png --json 2>&1)

run own.study
check "a figure is drawn without a word of gnuplot" clean
check "its name is results/STUDY/figure.png" is_png res/own/figure.png
check "its script and its data are next to it" test -s res/own/figure.gp -a -s res/own/figure.tsv
check "nothing else is left" test "$(find res/own -name '*figure*' | wc -l)" = 3
run own.study -o sub/fig.svg
check "a folder is made, and the ending gives the format" magic sub/fig.svg '<?xml'
run own.study -o sub/three.png --format svg,pdf,png
check "three formats at once" clean
check "a PNG" is_png sub/three.png
check "an SVG" magic sub/three.svg '<?xml'
check "a PDF" magic sub/three.pdf '%PDF'
run own.study words.study -o many/
check "several studies go into a folder" test -s many/own.png -a -s many/words.png

mkdir elsewhere
cp many/own.gp many/own.tsv elsewhere/
(cd / && LC_ALL=C.UTF-8 gnuplot -d "$work/elsewhere/own.gp") >out 2>err
check "the script redraws from another folder" test -s elsewhere/own.png -a ! -s err
check "to the same bytes" cmp elsewhere/own.png many/own.png
(cd elsewhere && gnuplot -d -e "format = 'svg'" own.gp) >out 2>err
check "and in another format" magic elsewhere/own.svg '<?xml'
check "the script names no folder" test "$(grep -c -e "$work" -e "$root" many/own.gp)" = 0

run own.study -o lines.png --by liquid.ior --log y -w render.depth=1 -w liquid.ior=1.33
check "axes, scale and conditions" clean
run own.study -o rays.png --x rays_total --by liquid.ior
check "a column as x axis" clean
run own.study --x noise_rms
check "an x axis without values is located there" refused "--x: no cell of own has a value of 'noise_rms'"
run own.study --y noise_rms
check "and a quantity without values there" refused "--y: no cell of own has a value of 'noise_rms'"
run own.study --images
check "a contact sheet" clean
check "its name is results/STUDY/sheet.png" is_png res/own/sheet.png
check "it has every image" test "$(grep -c rgbimage res/own/sheet.gp)" = 9
check "its images are named from its folder" grep -q "here.'images/0000.png'" res/own/sheet.gp
run own.study --images -o sheet2.png
check "a sheet in another folder" clean
run "$root/experiments/depth.study" --results "$root/results/reference" --y cpu_s \
    --published "$root/experiments/published/depth.csv" -o overlay.png
check "published numbers are added" clean
check "and their source is in the caption" grep -q 'Published: cpu_s by depth.*rod2024' overlay.gp

run words.study --images
check "a sheet without images is refused" refused 'keep: {image: on}'
run own.study --y wall
check "an unknown quantity" refused "wall_s"
run own.study -f gif
check "an unknown format" refused "png"
run own.study words.study -o one.png
check "two studies in one file" refused 'folder with a slash'
run own.study --published nowhere.csv
check "a missing file of published numbers" refused 'nowhere.csv'
run own.study --images --x liquid.ior
check "a sheet has no axes" refused 'no axes'
run
check "no study" refused 'no study was given'
run own.study -o /proc/nowhere/fig.png
check "a folder that cannot be made" test "$code" = 1
mkdir bin
PATH=$work/bin "$program" study plot --results res own.study >out 2>err
check "without gnuplot, the package is named" grep -q 'gnuplot-nox' err

# --- a gnuplot that draws nothing, and one that is killed with the program
mkdir idle slow idle-figures slow-figures
printf '#!/bin/sh\nexit 0\n' >idle/gnuplot
printf '#!/bin/sh\necho $$ >%s/slow/pid\nexec sleep 100000\n' "$work" >slow/gnuplot
chmod +x idle/gnuplot slow/gnuplot
PATH=$work/idle:$PATH "$program" study plot --results res own.study -o idle-figures/fig.png >out 2>err
code=$?
check "a gnuplot that draws nothing is a failure" eval '((code == 1)) && grep -q "gnuplot drew nothing" err'
check "and leaves no figure" test -z "$(find idle-figures -name '*.png')"
PATH=$work/slow:$PATH "$program" study plot --results res own.study -o slow-figures/fig.png >out 2>err &
drawing=$!
begun() { [[ -s slow/pid && -n $(find slow-figures -name '.cuvette-*.part.png') ]]; }
await $drawing begun
kill -KILL $drawing "$(<slow/pid)"
wait $drawing 2>/dev/null
check "a killed drawing leaves a temporary file" test -n "$(find slow-figures -name '.cuvette-*.part.png')"
run own.study -o slow-figures/fig.png
check "which the next drawing removes" eval 'clean && [[ -z $(find slow-figures -name ".cuvette-*") ]]'

# --- the committed rows
drawn=0
every=${CHECK:+1} number=0 # a fourth of the studies, with CHECK=1 all
for file in "$root"/experiments/*.study "$root"/experiments/full/*.study; do
    [[ -e $root/results/reference/$(basename "$file" .study)/rows.csv ]] || continue
    ((number++ % ${every:-4} == 0)) || continue
    run "$file" --results "$root/results/reference" -o reference/
    clean || check "$(basename "$file") is drawn" false
    drawn=$((drawn + 1))
done
found=$(find reference -name '*.png' -size +2k | wc -l)
check "a figure of each of $drawn studies that have rows" test "$found" = "$drawn"
for script in reference/*.gp; do
    LC_ALL=C.UTF-8 gnuplot -d -e "output = '$work/again'" "$script" >>warnings 2>&1
done
check "gnuplot has nothing to say about any of them" test ! -s warnings
((failed == 0))
