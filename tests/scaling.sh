#!/bin/bash
# The model of the speed-up by threads (paper/share.awk) against closed forms of processor sharing, the laws that it is
# compared with (paper/law.awk) against curves of known parameters, and the tables that paper/scaling.sh makes of them.
# One line per check ("ok ...", "not ok ...").
set -uo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
cd "$root" || exit 1
export LC_ALL=C CUVETTE=${CUVETTE:-$root/build/cuvette}
# shellcheck source=tests/shell/verdict.sh
source tests/shell/verdict.sh
work=$(mktemp -d "${TMPDIR:-/tmp}/cuvette-scaling.XXXXXX") || exit 1
trap 'rm -rf "$work"' EXIT

share() { # CORES UNITS YIELD BUSY PROGRAM: what an awk program prints
    awk -f paper/share.awk -f <(echo "BEGIN { cores = $1; logical = $2; yield = $3; busy = $4; $5 }")
}
# The time in which blocks of the given lengths end.
ends() { # CORES UNITS YIELD LENGTHS
    share "$1" "$2" "$3" 1 "n = split(\"$4\", a, \" \"); for (i = 1; i <= n; i++) a[i] += 0
        printf \"%.9g\", finish(a, n)"
}
# The speed-up of N equal blocks.
gain() { # CORES UNITS YIELD N
    share "$1" "$2" "$3" 1 "for (i = 1; i <= $4; i++) a[i] = 1; printf \"%.9g\", $4 / finish(a, $4)"
}

# --- processor sharing
for units in 1 2 7 16; do
    for n in 1 2 5 16 64; do
        equal "$n equal blocks on $units units gain min(n, units)" "$(gain $units $units 1 $n)" \
            $((n < units ? n : units))
    done
done
equal "a block with all the work gains nothing" "$(ends 8 8 1 "12 0 0 0 0 0")" 12
equal "blocks of 1, 2 and 3 on one unit end after 6" "$(ends 1 1 1 "2 3 1")" 6
equal "the first two of them, cut at the first end, after 3" "$(ends 1 1 1 "1 1 1")" 3
equal "at the second after 5" "$(ends 1 1 1 "1 2 2")" 5
# n blocks of a and one of b > a: all share until (n + 1) a, then b - a is left.
equal "two levels on one unit end after all the work" "$(ends 1 1 1 "2 2 2 2 7")" 15
equal "two levels on two units: 5 * 2 / 2, then alone" "$(ends 2 2 1 "2 2 2 2 7")" 10
equal "one long block among short ones on enough units ends after itself" "$(ends 5 5 1 "2 2 2 2 7")" 7
equal "blocks need no more than the work divided by units, plus the longest (Graham 1966)" \
    "$(share 3 3 1 1 'srand(1); for (t = 0; t < 200; t++) { split("", a); sum = big = 0
        for (i = 1; i <= 20; i++) { a[i] = rand(); sum += a[i]; if (a[i] > big) big = a[i] }
        end = finish(a, 20); if (end < sum / 3 - 1e-9 || end < big || end > sum / 3 + big) bad++ } printf "%d", bad')" 0
# --- cores with two units
equal "eight threads on four cores gain four yields" "$(gain 4 8 1.3 8)" 5.2
equal "more threads do not gain more" "$(gain 4 8 1.3 4096)" 5.2
equal "four threads have a core each" "$(gain 4 8 1.3 4)" 4
equal "six fill two cores: 2 + 2 yields" "$(gain 4 8 1.3 6)" 4.6
equal "with a yield of 2 a unit is a core" "$(gain 4 8 2 7)" 7
equal "a busy unit's rate counts in full where all units are busy" \
    "$(share 4 4 1 0.5 'printf "%g %g", capacity(1), capacity(4)')" "1 2"
# --- what threads get
loads() { # CALL: the loads of pieces that cost 1 to 10
    share 1 1 1 1 "for (i = 0; i < 10; i++) c[i] = i + 1; n = $1
        for (i = 1; i <= n; i++) printf \"%g%s\", a[i], i < n ? \" \" : \"\""
}
equal "blocks have ceil(10 / 4) pieces" "$(loads 'loads_of_blocks(c, 10, 4, a)')" "6 15 24 10"
equal "and may leave threads without any" "$(loads 'loads_of_blocks(c, 10, 6, a)')" "3 7 11 15 19"
equal "fixed tiles go round" "$(loads 'loads_of_tiles(c, 10, 4, a)')" "15 18 10 12"
equal "tiles on demand go to the thread that ends first" \
    "$(loads 'loads_on_demand(c, 10, 3, a)' | tr ' ' '\n' | sort -n | tr '\n' ' ')" "15 18 22 "
equal "more threads than tiles: one each" "$(loads 'loads_on_demand(c, 10, 99, a)' | wc -w)" 10

# --- laws
fit() { # S K TWO UNITS: the parameters found for a curve of these parameters
    awk -f paper/law.awk -f <(echo "BEGIN { many = split(\"2 4 8 16 64 256 1024\", n, \" \")
        for (i = 1; i <= many; i++) v[i] = law(n[i], $1, $2, $4)
        fit_law(n, v, many, $3, $4); printf \"%.4g %.4g\", law_s, law_k }")
}
equal "Amdahl's law gives 1 / s for many threads" "$(awk -f paper/law.awk -f <(echo 'BEGIN {
    printf "%.3f", law(1e9, 0.25, 0, 0) }'))" 4.000
equal "Amdahl's law is found" "$(fit 0.1 0 0 0)" "0.1 0"
equal "Gunther's law is found" "$(fit 0.03 2e-6 1 0)" "0.03 2e-06"
equal "also on 16 units" "$(fit 0.05 1e-5 1 16)" "0.05 1e-05"

# --- the cost of pieces: a map of 10 by 9 pixels of 1, the first in the file, which is the lower left one, of 3
floats() { # COUNT BYTES: little-endian floats
    local i
    for ((i = 0; i < $1; i++)); do printf '%b' "$2"; done
}
{
    printf 'Pf\n10 9\n-1.0\n'
    for ((pixel = 0; pixel < 90; pixel++)); do
        ((pixel)) && one='\0\0\0200\077' || one='\0\0\0100\0100'
        # A map has three channels; the first is read.
        floats 3 "$one"
    done
} >"$work/map.pfm"
paper/cost.sh "$work/map.pfm" >"$work/cost"
of() { awk -v kind="$1" '$1 == kind { printf "%s ", $2 }' "$work/cost"; }
equal "columns of a map" "$(of column)" "11 9 9 9 9 9 9 9 9 9 "
equal "rows, from the top" "$(of row)" "10 10 10 10 10 10 10 10 12 "
equal "squares of 8 by 8, cut off at the edges" "$(of square)" "64 16 10 2 "

# --- the tables: a machine of two units whose times are those of the model must have no error
mkdir -p "$work/out/tables" "$work/rows/threads"
printf '  "cores": 2,\n  "processing_units": 2,\n' >"$work/rows/threads/runs.json"
printf 'render.pool\trender.threads\twall_s_median\twall_s_low\twall_s_high\tcpu_s_median\n' \
    >"$work/out/tables/pool.tsv"
printf '%s\n' 'on 64 0.06 0.06 0.06 0.1' 'on 1024 0.156 0.156 0.156 0.1' 'off 64 0.06 0.05 0.07 0.1' \
    'off 1024 0.54 0.53 0.55 0.1' | tr ' ' '\t' >>"$work/out/tables/pool.tsv"
# Waking costs 0.1 ms a thread; columns of 11 and 9 * 9 in all 92 rays, so blocks of 47 and 45.
printf 'render.schedule\trender.threads\tn\twall_s_median\twall_s_low\twall_s_high\tcpu_s_median\n' \
    >"$work/out/tables/threads.tsv"
awk 'BEGIN { OFS = "\t"; print "columns", 1, 9, 0.1, 0.09, 0.11, 0.1
    t = 0.1 * 47 / 92 + 2e-4; print "columns", 2, 9, t, t * 0.9, t * 1.1, 0.1
    print "dynamic", 64, 9, 0.08, 0.07, 0.09, 0.125 }' >>"$work/out/tables/threads.tsv"
paper/scaling.sh "$work/rows" "$work/out" "$work/cost" >"$work/numbers" 2>"$work/said"
verdict $? "tables of other rows" "$(<"$work/said")"
cell() { # TABLE CONDITIONS COLUMNS
    awk -f plots/select.awk -v where="$2" -v columns="$3" "$work/out/tables/$1.tsv" | tr '\t' ' '
}
equal "times of the model have the ratio 1" \
    "$(cell scaling machine=here 'render.threads ratio_median miss_low')" "2 1 0"
equal "the ends of a ratio combine those of both times" \
    "$(cell scaling machine=here 'ratio_low ratio_high' |
        awk '{ printf "%.3f %.3f", $1 * 1.1 / 0.9, $2 * 0.9 / 1.1 }')" \
    "1.000 1.000"
grep -qxF '\setval{scaling/here/wake}{100.0}' "$work/numbers"
verdict $? "the cost of waking a thread is the slope of the pool's times" "$(grep wake "$work/numbers")"
grep -qxF '\setval{scaling/here/busy}{0.80}' "$work/numbers"
verdict $? "the rate of busy units is the CPU time alone by that with 64 threads" "$(grep busy "$work/numbers")"
grep -qxF '\setval{scaling/start}{\ensuremath{500}\within{479}{521}}' "$work/numbers"
verdict $? "the cost of starting one has the farthest ends" "$(grep start "$work/numbers")"
equal "the published counts are tested, but not the one that speed-ups refer to" \
    "$(cell scaling machine=published render.threads | tr '\n' ' ')" "4 8 16 32 64 128 256 512 1024 "
# No parameter follows the published curve: other published times change no prediction.
predicted() { cell scaling machine=published 'render.threads predicted least largest even'; }
cp -r paper plots experiments "$work/" 2>/dev/null
before=$(predicted)
sed -i 's/^64,1.08422/64,2.16844/' "$work/experiments/published/threads.csv"
(cd "$work" && paper/scaling.sh "$work/rows" "$work/out" "$work/cost") >/dev/null 2>&1
equal "other published times change the measured speed-up" \
    "$(cell scaling 'machine=published render.threads=64' speedup_median | cut -c1-4)" 2.35
equal "and no prediction" "$(predicted)" "$before"
reference=results/reference/tables
view=$(awk -f paper/share.awk -f paper/views.awk -v "rates=1	1.15	1.35" \
    <(printf 'published\tcolumns\t%s\t10\t1\t1\n' 4 8 16) "$reference/maps-views.tsv" |
    sed -n 's/.*view\/45\/.*{\(.*\)}$/\1/p' | tr '\n' ' ')
CUVETTE=/nowhere paper/scaling.sh "$work/rows" "$work/out" "$reference/maps-cost.tsv" >/dev/null 2>&1
# Without the cost of threads, which is 0.5 ms each of a frame of 5.1 s here.
equal "the view of the scene itself is the scene" "$(cell scaling machine=published 'render.threads predicted' |
    awk '$1 <= 16 { printf "%.2f ", 1 / (1 / $2 - 5e-4 * $1 / 5.10565) }')" "$view"
[[ -n $before ]]
verdict $? "of which there are some" "$before"
conclude
