#!/bin/bash
# The sources of the numbers in experiments/published: each row has `where` and `quote`, the quote contains the row's
# numbers (except a label 0 of polygons2004, which is an interpretation and not printed), and README.md there lists the
# report. With SOURCES=DIR, a folder of the plain texts named by that page, also that the quote is in its line. One line
# per check ("ok ...", "not ok ...").
set -uo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
folder=$root/experiments/published
# shellcheck source=tests/shell/verdict.sh
source "$root/tests/shell/verdict.sh"
columns() { # FILE NAMES: the columns, separated by tabs; rows without a value for one of them are omitted
    awk -f "$root/plots/select.awk" -v columns="$2" "$1"
}
text_of() { sed -n "s/^| \`$1\` |.*| \`\([^\`]*\.txt\)\` |\$/\1/p" "$folder/README.md"; } # KEY

# The quote may have a decimal comma; parts of longer numbers do not match.
is_in() { # NUMBER QUOTE
    grep -qE "(^|[^0-9.,])${1//./[.,]}($|[^0-9.,])" <<<"$2"
}
check_rows() { # FILE KEY_COLUMN TIME_COLUMN: prints the errors of its rows
    local label time where quote key line found=0
    while IFS=$'\t' read -r label time where quote; do
        found=$((found + 1))
        is_in "$time" "$quote" || echo "$label: $time is not in '$quote'"
        [[ $label == 0 && $where == polygons2004:* ]] || is_in "$label" "$quote" ||
            echo "$label is not in '$quote'"
        key=${where%%:*} line=${where##*line }
        [[ -n $(text_of "$key") && $line =~ ^[0-9]+$ ]] ||
            echo "$label: '$where' names no report of README.md or no line"
        [[ -z ${SOURCES:-} ]] ||
            sed -n "${line}p" "$SOURCES/$(text_of "$key")" | tr '\t' ' ' | grep -qF -- "$quote" ||
            echo "$label: '$quote' is not in line $line of $key"
    done < <(columns "$1" "$2 $3 where quote")
    local rows=$(($(wc -l <"$1") - 1))
    ((found > 0 && found == rows)) || echo "$found rows of $rows have $2, $3, where and quote"
}

empty "depth.csv quotes the source of every number" "$(check_rows "$folder/depth.csv" depth cpu_s 2>&1)"
empty "threads.csv quotes the source of every number" "$(check_rows "$folder/threads.csv" threads wall_s 2>&1)"
empty "triangles.csv quotes the source of every number" "$(check_rows "$folder/triangles.csv" triangles time_s 2>&1)"
empty "coverage.csv quotes the source of every number" "$(check_rows "$folder/coverage.csv" pixels time_s 2>&1)"
empty "crowding.csv quotes the source of every number" "$(check_rows "$folder/crowding.csv" triangles time_s 2>&1)"
# polygons2004 prints six times, then five labels: row i has the i-th time and the label i - 1.
check_order() { # FILE KEY_COLUMN
    columns "$1" "$2 time_s quote" | tr ',' '.' | awk -F'\t' '{
        printed = split($3, part, " ")
        if (printed == 11 && ($2 != part[NR] || $1 != (NR == 1 ? 0 : part[NR + 5])))
            print $1 ", " $2 " is not number " NR " of " $3
    } END { if (NR != 6) print NR " rows for six times" }'
}
for series in triangles:triangles coverage:pixels crowding:triangles; do
    empty "${series%:*}.csv pairs times and labels as printed" \
        "$(check_order "$folder/${series%:*}.csv" "${series#*:}" 2>&1)"
done
empty "there are no other series" \
    "$(cd "$folder" && printf '%s\n' *.csv | grep -vxE '(depth|threads|triangles|coverage|crowding)\.csv')"
empty "README.md describes every column" \
    "$(for name in $(head -q -n 1 "$folder"/*.csv | tr ',' '\n' | sort -u); do
        grep -q "^| \`$name\` |" "$folder/README.md" || echo "$name"
    done)"
# shellcheck disable=SC2016
keys=$(sed -n 's/^| `\([a-z0-9]*\)` |.*\.txt` |$/\1/p' "$folder/README.md")
empty "paper or supplement cite every report" "$(for key in ${keys:-none}; do
    grep -q "^@[a-z]*{$key," "$root/paper/references.bib" || echo "$key is not in the bibliography"
    grep -qE "\\\\cite\{([a-z0-9]*,)*${key}[,}]" "$root"/paper/{paper,supplement}.tex || echo "$key is not cited"
done)"

# select.awk, which reads these files, must preserve commas and quotes within quoted fields.
sheet=$(mktemp --suffix=.csv) || exit 1
trap 'rm -f "$sheet"' EXIT
printf 'a,b,c\n"1,5 2",3,"x ""y"" z"\n' >"$sheet"
empty "select.awk reads quoted fields" "$(diff <(printf '1,5 2\tx "y" z\t3\n') <(columns "$sheet" "a c b"))"

if [[ -n ${SOURCES:-} ]]; then
    empty "the plain texts exist" "$(for key in $keys; do
        [[ -r $SOURCES/$(text_of "$key") ]] || echo "$SOURCES/$(text_of "$key")"
    done)"
else
    skip "comparison of quotes with the texts: set SOURCES to their folder"
fi
conclude
