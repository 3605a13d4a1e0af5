#!/bin/bash
# Every figure of plots/ is drawn, or skipped with a reason, from the reference rows and from rows as bad as they come:
# one repetition of each cell, all rows disturbed, a group of rows missing, tables without rows, no tables, rows of
# other machines. A missing column is an error that names figure, table and column; that of a script, script and line.
# With CHECK=1 each kind is drawn by itself, as PNG and SVG, also without a group of rows; and each column that a figure
# names is taken away once.
# figures.sh. One line per check ("ok ...", "not ok ...").
set -uo pipefail
export LC_ALL=C

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
CUVETTE=$(realpath "${CUVETTE:-$root/build/cuvette}")
export CUVETTE
recheck=$(realpath "${BUILD:-$root/build}")/tests/recheck
unset ENVIRONMENT
work=$(mktemp -d "${TMPDIR:-/tmp}/cuvette-figures.XXXXXX") || exit 1
trap 'rm -rf "$work"' EXIT
cd "$root" || exit 1
# shellcheck source=tests/shell/verdict.sh
source tests/shell/verdict.sh

gnuplot -e 'set terminal pngcairo' 2>/dev/null || {
    skip "gnuplot with pngcairo is not installed"
    exit 77
}
reference=results/reference
mapfile -t figures < <(grep -l '^# needs:' plots/*.gp | sed 's|.*/||; s|\.gp$||')
needed() { sed -n 's/^# needs: *//p' "plots/$1.gp"; } # FIGURE

# --- the sets of rows

# A folder of rows, each file passed through an awk program that sees the numbers of its columns in `at`; the lists of
# runs follow.
rows_of() { # SET PROGRAM
    local folder study file
    for folder in "$reference"/*/; do
        study=$(basename "$folder")
        [[ $study == figures || $study == tables ]] && continue
        mkdir -p "$work/$1/$study"
        cp "$folder"/*.csv "$folder"/*.json "$work/$1/$study/" 2>/dev/null
        for file in "$work/$1/$study"/{rows,workers}.csv; do
            [[ -e $file && -e $folder/runs.json ]] || continue
            awk -F , 'NR == 1 { for (i = 1; i <= NF; i++) at[$i] = i; print; next } '"$2" "$file" >"$file.new" &&
                mv "$file.new" "$file"
            [[ $file != */rows.csv ]] || "$recheck" "$file" "$work/$1/$study/runs.json"
        done
    done
    mkdir "$work/$1/tables"
    cp "$reference"/tables/*.tsv "$work/$1/tables/"
    experiments/tables.sh "$work/$1" >"$work/said" 2>&1 || return 1
    # Studies of which there are no reference rows.
    cp tests/data/figures/*.tsv "$work/$1/tables/"
    cp experiments/cluster/simulated/cluster.csv "$work/$1/"
    images "$1"
}

# A set whose tables are those of another passed through an awk program, its other files the same.
tables_of() { # SET OF PROGRAM
    mkdir -p "$work/$1/tables"
    local file
    (cd "$work/$2" && cp -r --parents cluster.csv ./*/*.csv ./*/*.json "$work/$1/")
    images "$1"
    for file in "$work/$2"/tables/*.tsv; do
        awk -F '\t' -v OFS='\t' 'NR == 1 { for (i = 1; i <= NF; i++) at[$i] = i } '"$3" "$file" \
            >"$work/$1/tables/$(basename "$file")"
    done
}

# Small images in the place of all that the figures show, of the cells in `cells`.
render() {
    "$CUVETTE" render experiments/scenes/rod.yaml --set render.width=64 --set render.height=48 "$@" >/dev/null 2>&1
}
render -o "$work/small.png" --timeline "$work/small.json" && render -o "$work/small.pfm"
cells=({0000..0032})
images() { # SET
    local figure pattern folder ending cell
    for figure in "${figures[@]}"; do
        while read -r pattern _; do
            [[ $pattern == */*/* ]] || continue
            folder=$work/$1/${pattern%/*} ending=${pattern##*/}
            mkdir -p "$folder"
            case $pattern in
            absorber/* | slime-light/*)
                for cell in "${cells[@]}"; do
                    ln -sf "$root/$reference/${pattern%/*}/$cell.pfm" "$folder/"
                done
                ;;
            *\**) for cell in "${cells[@]}"; do ln -sf "$work/small.${pattern##*.}" "$folder/$cell${ending#\*}"; done ;;
            *) ln -sf "$work/small.${pattern##*.}" "$work/$1/$pattern" ;;
            esac
        done < <(needed "$figure")
    done
}

# --- what must hold

# Draws all figures of a set. Each must be drawn, or skipped with a reason; then it is in the list `drawn`.
all() { # SET FORMATS
    local figure line format wrong='' out=$work/$1.figures
    plots/draw.sh --results "$work/$1" --out "$out" --format "$2" >"$work/said" 2>"$work/errors"
    verdict $? "$1: no figure fails" "$(<"$work/errors")"
    drawn=' '
    for figure in "${figures[@]}"; do
        line=$(grep "^$figure: " "$work/said" "$work/errors" -h)
        case $line in
        *$'\n'* | '') wrong+="$figure: $(grep -c . <<<"$line") lines"$'\n' ;;
        "$figure: drawn"*)
            drawn+="$figure "
            for format in ${2//,/ }; do
                [[ $(wc -c <"$out/$figure.$format") -gt 2000 ]] || wrong+="$figure.$format is empty"$'\n'
            done
            ;;
        "$figure: skipped, there is no "?* | "$figure: skipped, no row of "?* | \
            "$figure: skipped, a panel has no point that can be drawn (plots/"?*)
            [[ ! -e $out/$figure.png && ! -e $out/$figure.svg ]] || wrong+="$figure is skipped and drawn"$'\n'
            ;;
        "$figure: error: "?*) ;;
        *) wrong+=$line$'\n' ;;
        esac
    done
    empty "$1: every figure is drawn or skipped with a reason, in one line" "$wrong"
}
not_drawn() { # those of the figures that are not in `drawn`
    local figure
    for figure in "${figures[@]}"; do [[ $drawn == *" $figure "* ]] || echo "$figure"; done
}

formats=svg
[[ -z ${CHECK:-} ]] || formats=png,svg
measured='$at["warmup"] == 0'
one="$measured"' && !seen[$at["cell"], ("worker" in at) ? $at["worker"] : ""]++'
single='NR > 1 {
    for (name in at) if (name ~ /_(low|high)$/) $at[name] = "NA"
    if ("n" in at && $at["n"] > 1) $at["n"] = 1
    if ("others_fraction" in at) $at["others_fraction"] = 0.93
    if ("disturbed" in at) $at["disturbed"] = $at["n"]
    for (name in at) if (name ~ /^undisturbed_/) $at[name] = name == "undisturbed_n" ? 0 : "NA"
} { print }'
disturb='NR > 1 {
    if ("others_fraction" in at) $at["others_fraction"] = 0.93
    for (name in at) if (name ~ /^undisturbed_/) $at[name] = name == "undisturbed_n" ? 0 : "NA"
    if ("disturbed" in at) $at["disturbed"] = $at["n"]
} { print }'

rows_of whole "$measured"
verdict $? "tables are made of the reference rows" "$(<"$work/said")"
all whole "$formats"
# What another machine measured, and what nobody has measured yet.
empty "whole: every figure is drawn" "$(not_drawn)"

if [[ -n ${CHECK:-} ]]; then
    rows_of one "$one"
    all one "$formats"
    tables_of disturbed whole "$disturb"
    all disturbed "$formats"
else
    tables_of one whole "$single"
    all one "$formats"
fi
empty "one: every figure is drawn" "$(not_drawn)"

# The committed quick run: small frames, one repetition.
if [[ -n ${CHECK:-} ]]; then
    cp -r "$reference/quick" "$work/quick"
    experiments/tables.sh "$work/quick" >"$work/said" 2>&1
    images quick
    all quick "$formats"
fi

# The rows of one value of the first parameter of a study are missing, of the last value or of the first, and all images
# but the first.
all_cells=("${cells[@]}") cells=(0000)
for which in last first; do
    [[ -n ${CHECK:-} ]] || break
    tables_of "without-$which" whole '
        NR == 1 { parameter = 0
            for (i = NF; i > 0; i--) if ($i ~ /^[a-z0-9_]+[.]/ || $i == "series" || $i == "scene") parameter = i
            lines = 0; print; next }
        { line[++lines] = $0; value[lines] = $parameter }
        END { out = value['"$([[ $which == last ]] && echo lines || echo 1)"']
            for (i = 1; i <= lines; i++) if (!parameter || value[i] != out) print line[i] }'
    all "without-$which" "$formats"
done

cells=("${all_cells[@]}")

# One cell of each study; and ends of intervals, errors and counts that no logarithmic axis has.
if [[ -n ${CHECK:-} ]]; then
    tables_of cell whole 'NR <= 2'
    all cell "$formats"
    zero='NR > 1 { for (name in at)
        if (name ~ /_(low|min|throughput)$|^(imbalance|flip|error|error_rms)$|^query_/ && $at[name] != "NA")
            $at[name] = name ~ /_low$/ ? -1 : 0 } { print }'
    tables_of zero whole "$zero"
    all zero "$formats"
fi

tables_of header whole 'NR == 1'
all header "$formats"
tables_of foreign whole '"machine" in at && $at["machine"] == "this" { $at["machine"] = "another" } { print }'
plots/draw.sh --results "$work/foreign" --out "$work/foreign.figures" determinism >"$work/said" 2>&1
equal "foreign: a named figure without rows is skipped with status 0" $? 0
equal "foreign: rows of another machine are not drawn as this one's" "$(head -n 1 "$work/said")" \
    "determinism: skipped, no row of tables/determinism.tsv has machine=this scene=all and a value of price_median"
touch "$work/foreign.figures/determinism.png"
plots/draw.sh --results "$work/foreign" --out "$work/foreign.figures" determinism >"$work/said" 2>"$work/errors"
equal "foreign: an image of earlier rows is named" "$(sed -n '1s/.*; //p' "$work/said")" \
    "determinism.png is of earlier rows"
mkdir "$work/none"
all none "$formats"
equal "none: nothing is drawn" "$drawn" " "

# --- a missing column

without() { # FILE COLUMN...: a table or rows without these columns
    awk -v names="${*:2}" '
        BEGIN { FS = OFS = ARGV[1] ~ /csv$/ ? "," : "\t"; for (i = split(names, n, " "); i > 0; i--) out[n[i]] }
        NR == 1 { for (i = 1; i <= NF; i++) kept[i] = !($i in out) }
        { line = sep = ""; for (i = 1; i <= NF; i++) if (kept[i]) { line = line sep $i; sep = OFS } print line }' "$1"
}
# The last column that each figure says it needs, from all files at once.
for figure in "${figures[@]}"; do
    needed "$figure" | awk -v figure="$figure" '
        { for (i = NF; i > 1; i--) if ($i !~ /=/) { print $1, $i, figure; next } }'
done >"$work/columns"
tables_of missing whole '{ print }'
cut -d ' ' -f 1 "$work/columns" | sort -u | while read -r file; do
    # shellcheck disable=SC2046 # a list of words
    without "$work/whole/$file" $(awk -v file="$file" '$1 == file { print $2 }' "$work/columns") >"$work/new"
    mv "$work/new" "$work/missing/$file"
done
draw() { # SET [FIGURE...]
    plots/draw.sh --results "$work/$1" --out "$work/$1.figures" --format svg "${@:2}" >"$work/said" 2>"$work/errors"
}
draw missing
equal "missing: the status is 1" $? 1
empty "missing: the error names figure, table and column" "$(
    for figure in "${figures[@]}"; do
        grep -q " $figure$" "$work/columns" || continue # it is made of images alone
        line=$(grep -h "^$figure: " "$work/said" "$work/errors")
        read -r file column < <(sed -n "s/^$figure: error: \([^ ]*\) has no column \([^ ]*\)$/\1 \2/p" <<<"$line")
        needed "$figure" | grep -F "$file " | grep -qwF -- "$column" || echo "$line"
    done
)"

# One column, also one that no line names: select.awk misses it while the figure is drawn.
tables_of less whole '{ print }'
missed() { # FIGURE FILE COLUMN
    without "$work/whole/$2" "$3" >"$work/less/$2"
    draw less "$1"
    cp "$work/whole/$2" "$work/less/$2"
    [[ $(<"$work/errors") == "$1: error: $2 has no column $3" ]]
}
unchanged() { [[ ! -s $work/errors ]] && cmp -s "$work/less.figures/$1.svg" "$work/whole.figures/$1.svg"; } # FIGURE
missed depth-cut tables/depth.tsv cut_depth_throughput
verdict $? "missing: a column that a command misses is named" "$(<"$work/errors")"

# Every column whose name is in a script of a figure: without it, the figure is an error that names it, or the same.
# Without the environment, figures leave it out.
if [[ -n ${CHECK:-} ]]; then
    wrong=''
    for figure in "${figures[@]}"; do
        # shellcheck disable=SC2046 # a list of words
        text=$(cat "plots/$figure.gp" $(grep -ohE 'plots/[a-z_-]+\.(gp|awk|sh)' "plots/$figure.gp" | sort -u))
        while read -r file; do
            for column in $(head -n 1 "$work/whole/$file" | tr '\t,' '\n\n' | grep -vx environment); do
                grep -qwF -- "$column" <<<"$text" || continue
                missed "$figure" "$file" "$column" || unchanged "$figure" ||
                    wrong+="$figure, $file, $column: $(cat "$work/said" "$work/errors" | head -n 1)"$'\n'
            done
        done < <(needed "$figure" | awk '$1 !~ /\*/ && $1 ~ /[.](tsv|csv)$/ { print $1 }' | sort -u)
    done
    empty "missing: no column that a script names is missed in silence" "$wrong"
fi

# --- errors of scripts, in a copy

mkdir -p "$work/copy/experiments"
cp -r plots "$work/copy/"
cp -r experiments/published "$work/copy/experiments/"
broken() { # FIGURE FILE SED WANTED
    sed -i.good "$3" "$work/copy/plots/$2"
    "$work/copy/plots/draw.sh" --results "$work/whole" --out "$work/copy/figures" "$1" >"$work/said" 2>"$work/errors"
    equal "$2, broken: status" $? 1
    equal "$2, broken: script and line are named" "$(<"$work/errors")" "$4"
    mv "$work/copy/plots/$2.good" "$work/copy/plots/$2"
}
broken depth-time depth-time.gp '/^set xlabel/ s/.*/set xlabel = 3/' \
    "depth-time: error: plots/depth-time.gp:$(grep -n '^set xlabel' plots/depth-time.gp | cut -d : -f 1): $(
    )invalid expression"
plots/draw.sh --results "$work/whole" nowhere >"$work/said" 2>"$work/errors"
equal "an unknown figure is bad input" $? 2
[[ $(wc -l <"$work/errors") == 1 ]] && grep -q nowhere "$work/errors"
verdict $? "in one line that names it" "$(<"$work/errors")"
conclude
