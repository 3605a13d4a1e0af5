#!/bin/bash
# Draw figures as PNG and SVG, or as PDF for the paper: those named, or all.
#   plots/draw.sh [--results DIR] [--out DIR] [--format png,svg,pdf] [FIGURE...]
# DIR defaults to results; figures go to DIR/figures. One line says of each figure that it was drawn, why it was
# skipped, or, with status 1, what is wrong. The same rows give the same bytes: no figure has a time or the name of a
# machine.
#
# The head of a figure has a line for each file that it is drawn from, a path below DIR (* allowed), with what at least
# one of its rows must have: columns with given values, and columns that are not NA (NAME? may be):
#   # needs: tables/determinism.tsv machine=this price_median
# A figure without such a file or row is skipped, which is no error. A column that the file lacks is one, and so is a
# column that select.awk misses while the figure is drawn.
set -euo pipefail
export LC_ALL=C.UTF-8 TZ=UTC0

fail() {
    echo "draw.sh: $*" >&2
    exit 2
}

root=$(cd "$(dirname "$0")/.." && pwd)
results=$root/results
out=
formats=(png svg)
figures=()
while [ $# -gt 0 ]; do
    case $1 in
    --results)
        results=$(cd "${2:?--results needs a folder}" && pwd) || exit 2
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
[ ${#figures[@]} -gt 0 ] || mapfile -t figures < <(grep -l '^# needs:' plots/*.gp | sed 's|.*/||; s|\.gp$||')
for figure in "${figures[@]}"; do
    grep -qs '^# needs:' "plots/$figure.gp" || fail "there is no figure $figure; the figures are the files" \
        "plots/*.gp with a line '# needs:'"
done
command -v gnuplot >/dev/null || fail "gnuplot is missing; apt-get install --no-install-recommends gnuplot-nox"
gnuplot -e 'set terminal pngcairo' 2>/dev/null || fail \
    "this gnuplot has no pngcairo; apt-get install --no-install-recommends gnuplot-nox"

# What a figure lacks, in words; nothing if it has all. Status 1: a column is missing, and the words say which.
lacking() { # FIGURE
    local pattern file words word where columns rows
    while read -r pattern words; do
        file=$(compgen -G "$results/$pattern" | sed -n 1p)
        if [ -z "$file" ]; then
            echo "there is no $pattern"
            return
        fi
        [[ $file == *.tsv || $file == *.csv ]] || continue
        where='' columns=''
        for word in $words; do
            if [[ $word == *=* ]]; then where+="$word "; else columns+="$word "; fi
        done
        rows=$(awk -f plots/select.awk -v where="$where" -v columns="$columns" "$file" 2>&1 |
            sed -n '1s/^$/a row/; 1p') || {
            echo "$rows"
            return 1
        }
        if [ -z "$rows" ]; then
            words=${where% }${where:+${columns:+ and }}${columns:+a value of ${columns% }}
            echo "no row of $pattern${words:+ has $words}"
            return
        fi
    done < <(needs "$1")
}

needs() { sed -n 's/^# needs: *//p' "plots/$1.gp"; }

# The number of processing units of the machine that measured, 0 if no list of runs has it.
units() {
    local runs
    for runs in "$results"/{threads,profile,depth,pool}/runs.json; do
        [ -r "$runs" ] && experiments/json_value.py machine.processing_units <"$runs" && return
    done 2>/dev/null
    true
}

# The environments of the tables of a figure, whose rows it shows: "3d2be922", or several; whether the run is quick.
environments() { # FIGURE
    local pattern tables=()
    while read -r pattern _; do
        [[ $pattern != tables/* ]] || mapfile -t -O ${#tables[@]} tables < <(compgen -G "$results/$pattern")
    done < <(needs "$1")
    [ ${#tables[@]} -gt 0 ] || return 0
    awk -F '\t' '
        FNR == 1 { at = 0; for (i = 1; i <= NF; i++) { if ($i == "environment") at = i; quick += $i == "quick" } }
        FNR > 1 && at && $at != "NA" && !seen[$at]++ { text = text (text ? ", " : "") $at }
        END { print text (quick ? ", quick run" : "") }' "${tables[@]}"
}

# The first error in what gnuplot and its commands said, as "plots/depth.gp:12: undefined variable: x". Warnings are not
# errors. A column that a command misses comes before others, which may follow from it.
error_in() { # LOG
    awk '
        function keep(text) {
            if (text ~ /has no column/) column = column ? column : text
            else if (sub(/^"/, "", text) && sub(/" line /, ":", text)) located = located ? located : text
            else other = other ? other : text
        }
        /^ *\^ *$/ { said = ""; next } # marks a place in the line before, a line of the script
        { keep(said); said = /[Ww]arning: |^ *$/ ? "" : $0 }
        END { keep(said); print column ? column : located ? located : other }' "$1" | sed "s|$results/||g; s/ *$//"
}

# Cairo writes the time into a PDF. Another date of the same length keeps all offsets.
undate() {
    sed -i 's|/CreationDate (D:[0-9]\{14\}|/CreationDate (D:19700101000000|' "$1"
}

# A figure of earlier rows is not taken for one of these.
skip() { # FIGURE WHY
    local format older=
    for format in "${formats[@]}"; do
        [ ! -e "$out/$1.$format" ] || older="; $1.$format is of earlier rows"
    done
    echo "$1: skipped, $2$older"
}

# Says one line. Status 0: drawn; 3: skipped; 1: something is wrong.
draw() { # FIGURE
    local format lacks shown said empty wrong files=$scratch/$1 log=$scratch/$1.log
    if ! lacks=$(lacking "$1"); then
        echo "$1: error: ${lacks#"$results/"}" >&2
        return 1
    elif [ -n "$lacks" ]; then
        skip "$1" "$lacks"
        return 3
    fi
    shown=$(environments "$1")
    for format in "${formats[@]}"; do
        wrong="gnuplot ended with an error"
        ! gnuplot -e "results = '$results'; output = '$files'; format = '$format'; units = ${machine_units:-0}; \
            environment = '$shown'" "plots/$1.gp" 2>"$log" || wrong=
        said=$(error_in "$log")
        wrong=${said:-$wrong}
        [ -n "$wrong" ] || [ -s "$files.$format" ] || wrong="gnuplot drew nothing"
        case $wrong in
        '') ;;
        *' value undefined!' | *' range is invalid' | *'_min should not equal '*)
            skip "$1" "a panel has no point that can be drawn ($wrong)"
            return 3
            ;;
        *)
            echo "$1: error: $wrong" >&2
            return 1
            ;;
        esac
        [ "$format" != pdf ] || undate "$files.pdf"
    done
    for format in "${formats[@]}"; do
        mv "$files.$format" "$out/$1.$format"
    done
    empty=$(grep -c 'warning: Skipping data file with no valid points' "$log" || true)
    echo "$1: drawn$([ "$empty" = 0 ] || echo ", $empty series without rows")"
}

mkdir -p "$out"
scratch=$(mktemp -d "$out/.drawing.XXXXXX")
trap 'rm -rf "$scratch"' EXIT
machine_units=$(units)
drawn=0 skipped=0 failed=0
finish() { # waits for one figure
    wait -n && drawn=$((drawn + 1)) && return
    if [ $? -eq 3 ]; then skipped=$((skipped + 1)); else failed=$((failed + 1)); fi
}
running=0
for figure in "${figures[@]}"; do
    if [ "$running" -ge "$(nproc)" ]; then
        finish
        running=$((running - 1))
    fi
    draw "$figure" &
    running=$((running + 1))
done
for (( ; running > 0; running--)); do finish; done
echo "figures: $drawn drawn, $skipped skipped, $failed with errors, in ${out#"$root"/}"
[ "$failed" -eq 0 ]
