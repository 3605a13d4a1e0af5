#!/bin/sh
# Write the tables that figures, claims and the paper read, RESULTS/tables: the summary of each study with rows, in one
# environment; the tables of its single cells, concatenated; the published series; and those of experiments/tables.py.
# All are made anew; one that did not change stays as it is.
#   experiments/tables.sh RESULTS [STUDY...]      with STUDY, only the tables of these studies
# CUVETTE: the program (default: build/cuvette). ENVIRONMENT: the one to show, 8 hex digits, instead of the one with
# most rows in each study. Status: 0; 1 if the rows of a study give no table; 2 for a wrong argument.
export LC_ALL=C
set -eu

wrong() { # MESSAGE
    echo "tables: $1" >&2
    exit 2
}
[ -d "${1-}" ] || wrong "there is no folder '${1-}'; usage: experiments/tables.sh RESULTS [STUDY...]"
results=$(cd "$1" && pwd)
shift
here=$(cd "$(dirname "$0")" && pwd)
program=${CUVETTE:-$here/../build/cuvette}
[ -x "$program" ] || wrong "there is no program $program; run make, or set CUVETTE"
environment=${ENVIRONMENT:-main}
expr "$environment" : '[0-9a-f]\{8\}$\|main$\|unknown$' >/dev/null ||
    wrong "invalid environment '$environment'; give the 8 hex digits of one, as in the last column of a summary"
has_rows() { # FOLDER...: of studies
    for folder; do
        for rows in "$folder"/rows.csv "$folder"/rows.shard-*.csv; do [ ! -r "$rows" ] || return 0; done
    done
    return 1
}
has_rows "$results"/*/ || wrong "there are no rows in $results; run make experiments, or give another folder"
tables=$results/tables
mkdir -p "$tables"
work=$(mktemp -d "$tables/.new.XXXXXX")
trap 'rm -rf "$work"' EXIT
trap 'exit 130' INT TERM

replace() { # TABLE: its file in $work takes its place; an empty or missing one removes it
    if [ ! -s "$work/$1" ]; then
        rm -f "$tables/$1"
    elif ! cmp -s "$work/$1" "$tables/$1"; then
        mv "$work/$1" "$tables/$1"
    fi
}
failed=
tables_of() { # FILE.study
    study=$(basename "$1" .study)
    if has_rows "$results/$study"; then
        # Status 1 with a table: rows that are marked or not used, of which the message says which.
        "$program" study summary --results "$results" --environment "$environment" "$1" \
            >"$work/$study.tsv" 2>"$work/message" || sed "s|^|$study: |" "$work/message" >&2
        [ -s "$work/$study.tsv" ] || failed="$failed $study"
    fi
    replace "$study.tsv"
    # Where the tables of the cells were not kept, as in results/reference, the concatenated one stays.
    for kind in metrics curves motion; do
        ls "$results/$study/images/"*-$kind.tsv >/dev/null 2>&1 || continue
        awk 'NR == 1 || FNR > 1' "$results/$study/images/"*-$kind.tsv >"$work/$study-$kind.tsv"
        replace "$study-$kind.tsv"
    done
}

if [ $# -gt 0 ]; then
    for study; do
        set -- "$here/$study.study" "$here/full/$study.study"
        [ -r "$1" ] || shift
        [ -r "$1" ] || wrong "there is no study $study in experiments"
        tables_of "$1"
    done
else
    for file in "$here"/*.study "$here"/full/*.study; do tables_of "$file"; done
    for file in "$here"/published/*.csv; do
        table=published-$(basename "$file" .csv).tsv
        # The first columns are numbers and plain words, without quotes or commas; then the source and its quotation.
        tr -d '\r' <"$file" | awk -F , -v OFS='\t' '
            NR == 1 { while (columns < NF && $(columns + 1) != "source") columns++ }
            { for (i = 1; i <= columns; i++) printf "%s%s", $i, i < columns ? OFS : ORS }' >"$work/$table"
        replace "$table"
    done
    if command -v python3 >/dev/null; then
        CUVETTE=$program python3 -B "$here/tables.py" "$results" "$work" || failed="$failed tables.py"
        for table in determinism determinism-bits films machines query-tests query-exponents query-times laws; do
            replace "$table.tsv"
        done
        for table in "$work"/*-curve-errors.tsv; do [ ! -e "$table" ] || replace "${table##*/}"; done
    else
        echo 'tables: without python3 the tables of experiments/tables.py are left out' >&2
    fi
fi
[ -z "$failed" ] || {
    echo "tables: no table of$failed, for the reasons above" >&2
    exit 1
}
