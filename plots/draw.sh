#!/bin/bash
# Draw the figures whose rows exist and are newer than the figure, as PNG and SVG, or as PDF for the paper.
#   plots/draw.sh [--results DIR] [--out DIR] [--format png,svg,pdf] [FIGURE...]
# DIR defaults to results; figures go to DIR/figures. A figure named on the command line is always drawn.
# The head of a figure lists its inputs (`# needs:`, paths below DIR, * allowed); if one is missing, the figure is
# skipped with one
# line.
# The same rows give the same bytes: no figure contains a time or a name of the machine.
set -euo pipefail
export LC_ALL=C.UTF-8 TZ=UTC0

fail() {
    echo "draw.sh: $*" >&2
    exit 1
}

root=$(cd "$(dirname "$0")/.." && pwd)
results=$root/results
out=
formats=(png svg)
figures=()
while [ $# -gt 0 ]; do
    case $1 in
    --results)
        results=$(cd "${2:?--results needs a folder}" && pwd) || exit 1
        shift
        ;;
    --out)
        mkdir -p "${2:?--out needs a folder}"
        out=$(cd "$2" && pwd)
        shift
        ;;
    --format)
        IFS=, read -r -a formats <<<"${2:?--format needs png, svg or pdf}"
        shift
        ;;
    -*) fail "unknown option $1; usage: plots/draw.sh [--results DIR] [--out DIR] [--format png,svg] [FIGURE...]" ;;
    *) figures+=("$1") ;;
    esac
    shift
done
cd "$root"
out=${out:-$results/figures}
named=${#figures[@]}
[ "$named" -gt 0 ] || mapfile -t figures < <(grep -l '^# needs:' plots/*.gp | sed 's|.*/||; s|\.gp$||')
command -v gnuplot >/dev/null || fail "gnuplot is missing; apt-get install --no-install-recommends gnuplot-nox"
gnuplot -e 'set terminal pngcairo' 2>/dev/null || fail \
    "this gnuplot has no pngcairo; apt-get install --no-install-recommends gnuplot-nox"

# Whether a table has a measured cell. A table without counts, of metrics or curves, needs a line.
has_rows() {
    awk -F '\t' 'NR == 1 { for (i = 1; i <= NF; i++) if ($i == "n") n = i }
        NR > 1 && (!n || $n > 0) { found = 1 } END { exit !found }' "$1"
}

# Whether a file of worker rows has one that is not a warm-up.
has_worker_rows() {
    awk -F , 'NR == 1 { for (i = 1; i <= NF; i++) if ($i == "warmup") w = i }
        NR > 1 && w && $w == 0 { found = 1; exit } END { exit !found }' "$1"
}

# Sets `missing` to the first missing input of a figure, or to nothing, and `inputs` to the files that it is drawn from.
look_for_inputs() {
    local pattern found needs
    missing=
    inputs=("plots/$1.gp" plots/{style,rows,{image,growth}_panels,media}.gp plots/*.{awk,sh}
        experiments/published/*.csv)
    read -r -a needs <<<"$(sed -n 's/^# needs: *//p' "plots/$1.gp")"
    for pattern in "${needs[@]}"; do
        mapfile -t found < <(compgen -G "$results/$pattern")
        if [ ${#found[@]} -eq 0 ]; then
            missing=${missing:-$pattern}
        elif [[ $pattern == tables/* ]] && ! has_rows "${found[0]}"; then
            missing=${missing:-measured cells in $pattern}
        elif [[ $pattern == */workers.csv ]] && ! has_worker_rows "${found[0]}"; then
            missing=${missing:-measured rows in $pattern}
        fi
        inputs+=("${found[@]}")
    done
}

is_fresh() {
    local format input
    for format in "${formats[@]}"; do
        [ -s "$out/$1.$format" ] || return 1
        for input in "${inputs[@]}"; do
            [ ! "$input" -nt "$out/$1.$format" ] || return 1
        done
    done
}

# The number of processing units of the machine that measured, 0 if no list of runs has it.
units() {
    { cat "$results"/{threads,profile,depth,pool}/{runs,manifest}.json 2>/dev/null || true; } |
        sed -n 's/.*"processing_units": *\([0-9][0-9]*\).*/\1/p' | sed -n 1p
}

# The environments of the tables among the inputs, whose rows a figure shows: "3d2be922", or several.
environments() {
    local file tables=()
    for file in "${inputs[@]}"; do
        [[ $file != */tables/*.tsv ]] || tables+=("$file")
    done
    [ ${#tables[@]} -gt 0 ] || return 0
    awk -F '\t' 'FNR == 1 { at = 0; for (i = 1; i <= NF; i++) if ($i == "environment") at = i; next }
        at && $at != "NA" && !seen[$at]++ { text = text (text ? ", " : "") $at } END { print text }' "${tables[@]}"
}

# Cairo writes the time into a PDF. Another date of the same length keeps all offsets.
undate() {
    sed -i 's|/CreationDate (D:[0-9]\{14\}|/CreationDate (D:19700101000000|' "$1"
}

draw() {
    local format scratch=$out/.$1.drawing shown
    shown=$(environments)
    for format in "${formats[@]}"; do
        if ! gnuplot -e "results = '$results'; output = '$scratch'; format = '$format'; units = ${machine_units:-0}; \
            environment = '$shown'" \
            "plots/$1.gp" \
            2>"$scratch.log" || [ ! -s "$scratch.$format" ]; then
            sed "s/^/    /" "$scratch.log" | grep -v '^ *$' | head -n 5 >&2 || true
            rm -f "$scratch".*
            return 1
        fi
        [ "$format" != pdf ] || undate "$scratch.pdf"
        mv "$scratch.$format" "$out/$1.$format"
    done
    rm -f "$scratch.log"
}

for figure in "${figures[@]}"; do
    [ -f "plots/$figure.gp" ] || fail "there is no plots/$figure.gp"
done
mkdir -p "$out"
machine_units=$(units)
drawn=0 fresh=0 failed=0
for figure in "${figures[@]}"; do
    look_for_inputs "$figure"
    if [ -n "$missing" ]; then
        echo "$figure: skipped, no $missing (run make experiments)"
    elif [ "$named" -eq 0 ] && is_fresh "$figure"; then
        fresh=$((fresh + 1))
    elif draw "$figure"; then
        drawn=$((drawn + 1))
        echo "$figure: drawn"
    else
        failed=$((failed + 1))
        echo "$figure: gnuplot failed" >&2
    fi
done
echo "figures: $drawn drawn, $fresh up to date, in ${out#"$root"/}"
[ "$failed" -eq 0 ]
