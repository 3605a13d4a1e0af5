#!/bin/bash
# experiments/reference.sh [RESULTS]: makes results/reference, the committed run, from a complete run in RESULTS
# (results). It keeps what cannot be computed again from it: rows, runs, comparisons and metrics of cells, and figures
# of images; not the images of single cells. `make setup experiments-full` in a fresh clone comes first.
# experiments/reference.sh --quick [RESULTS]: makes results/reference/quick, the rows and runs of `make experiments
# QUICK=1`, for films and counts.
set -euo pipefail
cd "$(dirname "$0")/.."
to=results/reference

need_rows() { # COMMAND FILE.study...
    local study name
    for study in "${@:2}"; do
        name=$(basename "$study" .study)
        [[ -e $from/$name/rows.csv ]] || {
            echo "reference.sh: $from has no rows of $name; run $1" >&2
            exit 1
        }
    done
}
if [[ ${1-} == --quick ]]; then
    from=${2:-results/quick}
    need_rows 'make experiments QUICK=1' experiments/*.study
    rm -rf "$to/quick"
    for study in experiments/*.study; do
        name=$(basename "$study" .study)
        mkdir -p "$to/quick/$name"
        cp "$from/$name/rows.csv" "$to/quick/$name/"
        # Without the description of the machine, which is most of it.
        python3 -c 'import json, sys
runs = json.load(sys.stdin)
runs["machine"]["hwloc_xml"] = ""
json.dump(runs, sys.stdout, indent=2, ensure_ascii=False)' <"$from/$name/runs.json" >"$to/quick/$name/runs.json"
    done
    printf '%s: %s\n' "$to/quick" "$(du -sh "$to/quick" | cut -f1)"
    exit
fi
from=${1:-results}
need_rows 'make experiments-full' experiments/*.study experiments/full/*.study
# The committed quick run (below) stays.
find "$to" -mindepth 1 -maxdepth 1 ! -name quick -exec rm -rf {} +
mkdir -p "$to/tables" "$to/figures"
for rows in "$from"/*/rows.csv; do
    name=$(basename "$(dirname "$rows")")
    [[ $from/$name == "$to" ]] && continue
    mkdir -p "$to/$name"
    for file in rows.csv workers.csv compare.csv runs.json excluded.csv; do
        [[ ! -e $from/$name/$file ]] || cp "$from/$name/$file" "$to/$name/"
    done
done
for table in "$from"/tables/*-{metrics,curve-errors,motion}.tsv; do
    [[ ! -e $table ]] || cp "$table" "$to/tables/"
done
# Of the curves those of the pair of indices that plots/realism.gp draws.
awk -F '\t' 'NR == 1 || ($3 == 1.5 && $4 == 1.33)' "$from/tables/realism-curves.tsv" >"$to/tables/realism-curves.tsv"
# Of studies that only measure the edges of the rod, these metrics.
for name in ior-images visible-grid; do
    awk 'NR == 1 || $5 ~ /^edges[.]/' FS='\t' "$from/tables/$name-metrics.tsv" >"$to/tables/$name-metrics.tsv"
done
mkdir -p "$to/displacement"
cp "$from/displacement/points.csv" "$to/displacement/"
# Small float images that numbers of the paper are read from.
for name in absorber slime-light; do
    mkdir -p "$to/$name/images"
    cp "$from/$name"/images/*.pfm "$to/$name/images/"
done
# Figures that need images; the others are drawn from the rows. And those of the README.
for script in plots/*.gp; do
    name=$(basename "$script" .gp)
    if [[ $(sed -n 's/^# needs: *//p' "$script") == */images/* || $(<README.md) == */figures/"$name".png* ]]; then
        cp "$from/figures/$name.png" "$to/figures/"
    fi
done
cp "$from"/figures/{fan,trace}.svg "$to/figures/"
printf '%s: %s files, %s\n' "$to" "$(find "$to" -type f | wc -l)" "$(du -sh "$to" | cut -f1)"
