#!/bin/sh
# Join lines of a table by one column: the lines of one selection with those of another.
#   plots/join.sh TABLE COLUMN WHERE WHERE COLUMNS        prints COLUMN, COLUMNS of the first, COLUMNS of the second
export LC_ALL=C
set -eu

{
    awk -f plots/select.awk -v where="$3" -v columns="$2 $5" "$1"
    echo
    awk -f plots/select.awk -v where="$4" -v columns="$2 $5" "$1"
} | awk -F '\t' '
    NF == 0 { second = 1; next }
    !second { line[$1] = $0; next }
    $1 in line { key = $1; sub(/^[^\t]*/, ""); print line[key] $0 }' | sort -n
