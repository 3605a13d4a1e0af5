#!/bin/bash
# repeat.sh - how often conclusions flip: the rows of experiments/repeat.study on the machine as it is, then under a
# load of one rendering loop for each processing unit, and the rates of `cuvette study power`.
#   experiments/repeat.sh RESULTS          writes RESULTS/repeat and RESULTS/repeat-loaded; about a minute
#   experiments/repeat.sh --rates RESULTS  only computes the rates again, from the values there; minutes
# Each folder gets values.csv (the columns of rows.csv that are needed: 3600 rows), machine.tsv (whose they are) and
# power.tsv (the rates, by contrast). CUVETTE: the program (build/cuvette).
set -euo pipefail
export LC_ALL=C
here=$(cd "$(dirname "$0")" && pwd)
program=${CUVETTE:-$here/../build/cuvette}
rates_only=
[ "${1-}" != --rates ] || { rates_only=1 && shift; }
if [ ! -x "$program" ] || [ -z "${1-}" ]; then
    echo "repeat.sh: give a folder of results, and the program in CUVETTE; make builds it" >&2
    exit 2
fi
results=$1
work=$(mktemp -d)
load=()
unload() {
    [ ${#load[@]} = 0 ] || kill "${load[@]}" 2>/dev/null || true
    wait
    load=()
}
trap 'unload; rm -rf "$work"' EXIT

measure() { # FOLDER
    "$program" study run "$here/repeat.study" --quiet --results "$work/$1"
    mkdir -p "$results/$1"
    # The run as a number, in the order of time; times to the nanosecond, below the clock's tick.
    awk -f "$here/../plots/select.awk" -v columns='cell run repetition warmup wall_s cpu_s rays_total others_share' \
        "$work/$1/repeat/rows.csv" |
        awk 'BEGIN { print "cell,process,repetition,wall_s,cpu_s,rays_total,others_share" }
            !($2 in number) { number[$2] = ++runs }
            $4 == 0 { printf "%s,%d,%s,%.9f,%.9f,%s,%.3f\n", $1, number[$2], $3, $5, $6, $7, $8 }' \
            >"$results/$1/values.csv"
    {
        printf 'name\tvalue\n'
        for name in cpu_model processing_units started_utc load build_commit flags; do
            sed -n "s/^ *\"$name\": *\"\{0,1\}\([^\"]*[^\",]\)\"\{0,1\},\{0,1\}\$/$name\t\1/p" \
                "$work/$1/repeat/runs.json" | head -n 1
        done
    } >"$results/$1/machine.tsv"
}

# The truth is what the counts of rays say, and for two threads that each does half. All at once: each has one thread.
rates() { # FOLDER
    local values=$results/$1/values.csv pid pids=()
    later() {
        contrast "$@" &
        pids+=($!)
    }
    later same "$values"
    later inert "$values" --cells=0,1 --truth=same
    later two "$values" --cells=0,2 --truth=larger
    later ten "$values" --cells=0,3 --truth=larger
    later fifty "$values" --cells=0,4 --truth=larger
    later threads "$values" --cells=0,5 --truth=smaller
    later cpu-same "$values" --column=cpu_s
    later rays-same "$values" --column=rays_total --designs=1,3,10,3x1
    later rays-two "$values" --column=rays_total --designs=1,3,10,3x1 --cells=0,2 --truth=larger
    # One side on the machine as it is, the other under the load.
    [ "$1" = repeat ] || later across "$results/repeat/values.csv" "$values" --designs=1,3,10,3x1
    for pid in "${pids[@]}"; do wait "$pid"; done
    awk 'NR == 1 || FNR > 1' "$work"/power-*.tsv >"$results/$1/power.tsv"
    rm -f "$work"/power-*.tsv
}
contrast() { # NAME ARGUMENT...: the rates of all pairs together, or of the two cells
    "$program" study power --tsv "${@:2}" >"$work/rates-$1"
    awk -v name="$1" -v OFS='\t' 'NR == 1 { print "contrast", $0; next }
        { line[++n] = $0; all = all || $1 == "all" }
        END { for (i = 1; i <= n; i++) if (!all || line[i] ~ /^all\t/) print name, line[i] }' \
        "$work/rates-$1" >"$work/power-$1.tsv"
}

if [ -z "$rates_only" ]; then
    measure repeat
    units=$("$program" machine --json | sed -n 's/^ *"units": \([0-9]*\).*/\1/p' | head -n 1)
    for ((unit = 0; unit < ${units:-1}; unit++)); do
        (
            trap 'kill $!; exit' TERM
            while :; do
                "$program" render "$here/scenes/rod.yaml" --set render.threads=1 --repeat 100 -o "$work/load$unit.png" \
                    >/dev/null 2>&1 &
                wait
            done
        ) &
        load+=($!)
    done
    sleep 1
    measure repeat-loaded
    unload
fi
rates repeat
rates repeat-loaded
