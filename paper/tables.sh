#!/bin/sh
# Write the tables that paper and claims read: OUT/tables/STUDY.tsv, the summary of each study in one environment, with
# intervals of more columns than `cuvette study summary` gives; and OUT/environments, the environment of each study.
#   paper/tables.sh RESULTS OUT         run from anywhere
# CUVETTE: the program (default: build/cuvette); without it, or without any rows, the tables in RESULTS/tables are used,
# which have fewer intervals. ENVIRONMENT: show this one (8 hex digits) instead of the one with most rows in each study.
export LC_ALL=C
set -eu

results=$(cd "$1" && pwd)
mkdir -p "$2/tables"
out=$(cd "$2" && pwd)
here=$(cd "$(dirname "$0")" && pwd)
program=${CUVETTE:-$here/../build/cuvette}
# Measured columns that have no interval in a summary; quotients are formed row by row.
more='build_s imbalance visibility_s_sum motion_s visibility_s_sum/wall_s rays_total/cpu_s
    visibility_s_sum/rays_total motion_s/motion_steps query_rays query_boxes query_triangles
    query_boxes/query_rays query_triangles/query_rays'

rows_of() { ls "$results"/$1/rows*.csv >/dev/null 2>&1; }
summaries=1
[ -x "$program" ] && rows_of '*' || summaries=0

# Those of them that the rows of a study have, separated by commas; rows of earlier versions lack some.
measured_in() { # STUDY
    head -qn 1 "$results/$1"/rows*.csv | awk -v wanted="$more" '{
            columns = split($0, column, ",")
            for (i = 1; i <= columns; i++) has[column[i]] = 1
        }
        END {
            count = split(wanted, name, " ")
            for (i = 1; i <= count; i++) {
                split(name[i], part, "/")
                if ((part[1] in has) && (name[i] !~ /\// || (part[2] in has))) {
                    printf "%s%s", comma, name[i]
                    comma = ","
                }
            }
        }'
}

summarise() { # STUDY: its table and the intervals; returns 1 if it has no rows
    summary=$results/tables/$1.tsv
    : >"$out/spread"
    if [ $summaries = 1 ]; then
        rows_of "$1" || return 1
        summary=$out/summary
        "$program" study summary --results "$results" "$here/../experiments/$1.study" >"$summary" 2>"$out/message" ||
            sed "s|^|$1: |" "$out/message" >&2
        "$program" study summary --results "$results" --interval "$(measured_in "$1")" "$here/../experiments/$1.study" \
            >"$out/spread" 2>/dev/null || : # the summary has said why
    fi
    [ -s "$summary" ] || return 1
    environment=$(awk -v wanted="${ENVIRONMENT:-}" -f "$here/environment.awk" "$summary")
    awk -v chosen="$environment" -f "$here/join.awk" "$out/spread" "$summary" >"$out/tables.new/$1.tsv"
    printf '%s\t%s\n' "$1" "$environment" >>"$out/environments"
}

rm -rf "$out/tables.new"
mkdir "$out/tables.new"
: >"$out/environments"
for file in "$here"/../experiments/*.study; do
    study=$(basename "$file" .study)
    summarise "$study" || continue
    for kind in metrics curves motion; do
        if ls "$results/$study/images/"*-$kind.tsv >/dev/null 2>&1; then
            awk 'NR == 1 || FNR > 1' "$results/$study/images/"*-$kind.tsv >"$out/tables.new/$study-$kind.tsv"
        elif [ -r "$results/tables/$study-$kind.tsv" ]; then
            cp "$results/tables/$study-$kind.tsv" "$out/tables.new/"
        fi
    done
done
for file in "$here"/../experiments/published/*.csv; do
    tr -d '\r' <"$file" | awk -f "$here/published.awk" >"$out/tables.new/published-$(basename "$file" .csv).tsv"
done
"$here/determinism.sh" "$results" "$out/tables.new"
# Tables that did not change stay as they are: figures are drawn again only if their tables are newer.
for file in "$out"/tables/*.tsv; do
    [ -r "$out/tables.new/$(basename "$file")" ] || rm -f "$file"
done
for file in "$out"/tables.new/*.tsv; do
    cmp -s "$file" "$out/tables/$(basename "$file")" || mv "$file" "$out/tables/"
done
rm -rf "$out/tables.new"
rm -f "$out/spread" "$out/summary" "$out/message"
