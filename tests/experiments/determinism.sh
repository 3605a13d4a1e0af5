#!/bin/bash
# The tables about the same bits everywhere and their price (experiments/tables.py) on small rows whose
# answers are known.
set -uo pipefail
cd "$(dirname "$0")/../.." || exit 1
# shellcheck source=tests/shell/verdict.sh
source tests/shell/verdict.sh
command -v python3 >/dev/null || {
    skip 'python3 is not installed'
    exit 77
}
work=$(mktemp -d "${TMPDIR:-/tmp}/cuvette-determinism.XXXXXX") || exit 1
trap 'rm -rf "$work"' EXIT

# The table that a function of experiments/tables.py makes of rows.
table() { # prices <ROWS | bits IMAGES BITS | films ROWS
    PYTHONPATH=experiments python3 -B -c '
import csv, pathlib, sys, tables
out = pathlib.Path(sys.argv[1])
kind, *files = sys.argv[2:]
rows = [tables.rows_of(pathlib.Path(file)) for file in files] or [list(csv.DictReader(sys.stdin))]
machine = [] if kind == "films" else ["this"]
lines = list(getattr(tables, kind)(*machine, *rows))
tables.write(out, getattr(tables, kind.upper()), lines)' "$work/table.tsv" "$@" &&
        cat "$work/table.tsv"
}

# --- prices: in round r every program takes r + 1 times as long, and what is left out saves a known share
rounds() { # NUMBER
    echo 'film,contract,compiler,isa,scene,repetition,place,cpu_s,film_hash,rays_total,others_fraction'
    awk -v n="$1" 'BEGIN { for (r = 0; r < n; r++) for (s = 1; s <= 2; s++) {
        row = sprintf("gcc,avx2,%s,%d,0", s == 1 ? "rod" : "ball", r)
        printf "fixed,off,%s,%.9g,a,1,0\n", row, 1.5 * s * (r + 1)
        printf "float,off,%s,%.9g,b,1,0\n", row, 1.5 * (r + 1) * s / (s == 1 ? 1.2 : 1.25)
        printf "float,fast,%s,%.9g,c,1,0\n", row, 1.5 * s * (r + 1) / (1 + r / 100)
        printf "fixed,fast,%s,%.9g,d,1,0\n", row, 1.5 * s * (r + 1) } }' </dev/null
}
price() { # ROUNDS PART SCENE COLUMN...
    local rows=$1 part=$2 scene=$3
    shift 3
    rounds "$rows" | table prices | awk -F'\t' -v part="$part" -v scene="$scene" -v columns="$*" '
        NR == 1 { for (i = 1; i <= NF; i++) at[$i] = i; next }
        $at["part"] == part && $at["scene"] == scene {
            n = split(columns, name, " ")
            for (i = 1; i <= n; i++) printf "%s%.6g", (i > 1 ? " " : ""), $at[name[i]]
        }'
}
equal "the price of a scene is the quotient of each round" "$(price 12 film rod n price_median price_low)" "12 1.2 1.2"
equal "that of all scenes is their geometric mean" "$(price 12 film all price_median)" \
    "$(awk 'BEGIN { printf "%.6g", sqrt(1.2 * 1.25) }')"
equal "what takes the same time costs nothing" "$(price 12 contraction all price_median price_low price_high)" "1 1 1"
# Quotients 1, 1.01, 1.02 ...: the k-th is 1 + (k - 1) / 100.
ends() { price "$1" both rod price_median price_low price_high; }
equal "12 rounds: from the 3rd to the 10th quotient" "$(ends 12)" "1.055 1.02 1.09"
equal "15 rounds: from the 4th to the 12th" "$(ends 15)" "1.07 1.03 1.11"
equal "20 rounds: from the 6th to the 15th" "$(ends 20)" "1.095 1.05 1.14"
equal "25 rounds: from the 8th to the 18th" "$(ends 25)" "1.12 1.07 1.17"
equal "6 rounds: from the first to the last" "$(ends 6)" "1.025 1 1.05"
rounds 5 | table prices | grep -q "	NA	NA	"
verdict $? "5 rounds have no interval"

# --- films
cat >"$work/images.csv" <<'END'
scene,film_hash,max_difference,differing_fraction
rod,a,0,0
rod,b,0.25,0.5
rod,c,1e-7,0.75
END
cat >"$work/bits.csv" <<'END'
film,contract,compiler,isa,scene,threads,schedule,film_hash,rays_total
fixed,off,gcc,sse2,rod,1,rows,a,1000
fixed,off,gcc,avx2,rod,2,rows,a,1000
float,off,gcc,sse2,rod,1,rows,b,1000
float,off,gcc,avx2,rod,2,rows,c,1010
float,off,gcc,avx2,rod,3,rows,c,1010
END
bits=$(table bits "$work/images.csv" "$work/bits.csv" | tail -n +2 | tr '\t' ' ')
equal "films, ray counts and largest differences of each build" "$bits" \
    $'this fixed off 1 2 2 1 1 1 0 0 0 0\nthis float off 1 3 3 2 2 2 0.25 0.75 10 0.01'

# --- one row that differs from the others of its scene
head -n 2 results/films/epyc-gcc.csv >"$work/one.csv"
{
    cat "$work/one.csv"
    tail -n 1 "$work/one.csv"
    tail -n 1 "$work/one.csv" | sed 's/,[0-9]*,80x60,/,1,80x60,/; s/,no,/,qemu,/'
} >"$work/three.csv"
equal "a row with another count is different; emulation is no processor" \
    "$(table films "$work/three.csv" | tail -n 1 | tr '\t' ' ')" "absorber 3 1 1 1 1 1 1 1 2 1"
conclude
