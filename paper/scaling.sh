#!/bin/sh
# Predict the speed-up by threads from the cost of pieces of the image, and compare it with the published and the
# measured one (paper/scaling.awk): writes OUT/tables/scaling.tsv and scaling-errors.tsv, and prints \setval lines.
#   paper/scaling.sh RESULTS OUT COST       after tables.sh; COST: a table of paper/cost.sh
# Every folder of results/machines with a study threads is another machine; its rows need the program CUVETTE.
export LC_ALL=C
set -eu

results=$1
out=$2
here=$(cd "$(dirname "$0")" && pwd)
program=${CUVETTE:-$here/../build/cuvette}
select=$here/../plots/select.awk
work=$out/scaling
rm -rf "$work"
mkdir -p "$work"

# The yield of a core with two busy units, in the throughput of one thread alone: lowest, assumed, highest. Never
# fitted to the published curve. Intel's first Hyper-Threading gained 0 to 35 % (https://www.anandtech.com/show/2658),
# and three ray tracers on it 15 % in the mean:
#   12 %  Shade, 219 and 196 s      http://trueway.blue.coocan.jp/cgi/acc.cgi?page=special
#   14 %  LightWave 7.5             http://www.tecchannel.de/server/prozessoren/402013
#   19 %  Shade, 144 and 121 s      http://www.asahi-net.or.jp/~fb3y-nkmr/zakki/z_03_10.htm
# Its engineers state 25 % (Koufaty and Marr 2003, doi:10.1109/MM.2003.1196115).
yields='1.00	1.15	1.35'

# The table of a study in a folder, of the environment with most rows.
table() { # RESULTS STUDY
    if [ "$1" = "$results" ]; then
        cat "$out/tables/$2.tsv" 2>/dev/null || :
        return
    fi
    [ -x "$program" ] && [ -r "$1/$2/rows.csv" ] || return 0
    "$program" study summary --results "$1" "$here/../experiments/$2.study" >"$work/summary" 2>/dev/null || return 0
    environment=$(awk -f "$here/environment.awk" "$work/summary")
    awk -v chosen="$environment" -f "$here/join.awk" /dev/null "$work/summary"
}
fact() { # RESULTS NAME: a number from the list of runs of the study threads
    sed -n "s/^ *\"$2\": *\"\\{0,1\\}\\([0-9]*\\).*/\\1/p" "$1/threads/runs.json" 2>/dev/null | head -n 1
}

# What starting (pool off) or waking (on) a thread costs, from 64 and 1024 threads of the study pool; these counts are
# not tested. A negative cost is noise. Prints the median and the ends.
each_thread() { # POOL-TABLE on|off
    awk -f "$select" -v where="render.pool=$2" -v columns='render.threads wall_s_median wall_s_low wall_s_high' "$1" |
        awk '{ mid[$1] = $2; low[$1] = $3; high[$1] = $4 }
            function least(v) { return v > 0 ? v / 960 : 0 }
            END { if (64 in mid && 1024 in mid)
                print least(mid[1024] - mid[64]), least(low[1024] - high[64]), least(high[1024] - low[64]) }'
}
# CPU time of a frame alone (the best serial run) by that with 64 threads, both of the study threads, because machines
# that are shared differ from study to study: the rate of a unit while all are busy.
busy_rate() { # THREADS-TABLE
    alone=$(awk -f "$select" -v where=render.threads=1 -v columns=cpu_s_median "$1" | sort -g | head -n 1)
    awk -f "$select" -v where='render.schedule=dynamic render.threads=64' -v columns=cpu_s_median "$1" |
        awk -v alone="$alone" '$1 > 0 { rate = alone / $1; print rate < 1 ? rate : 1 }'
}

# Speed-ups over the best serial run of a table; the ends combine those of both times.
speedups() { # TABLE WHERE MACHINE COUNTS
    awk -f "$select" -v where="$2" \
        -v columns='render.schedule render.threads n wall_s_median wall_s_low wall_s_high' "$1" |
        awk -F '\t' -v OFS='\t' -v machine="$3" -v counts=" $4 " '
            { line[NR] = $0 }
            $2 == 1 && (!serial || $4 < serial) { serial = $4; low = $5; high = $6 }
            END { for (i = 1; i <= NR && serial > 0; i++) {
                split(line[i], f, "\t")
                if (index(counts, " " f[2] " ") && f[5] > 0)
                    print machine, f[1], f[2], f[3], serial, serial / f[4], low / f[6], high / f[5]
            } }'
}
machine() { # RESULTS NAME: lines of MACHINES and MEASURED
    table "$1" threads >"$work/threads"
    table "$1" pool >"$work/pool"
    table "$1" threads-frames >"$work/frames"
    table "$1" long-blocks >"$work/blocks"
    units=$(fact "$1" processing_units)
    cores=$(fact "$1" cores)
    wake=$(each_thread "$work/pool" on | cut -d ' ' -f 1)
    rate=$(busy_rate "$work/threads")
    [ -s "$work/threads" ] && [ -n "$units" ] && [ -n "$wake" ] && [ -n "$rate" ] || return 0
    cores=${cores:-$units}
    shared=$yields
    [ "$cores" -lt "$units" ] || shared='1	1	1'
    for name in "$2" "$2-long"; do
        printf '%s\t%s\t%s\t%s\t%s\t%s\n' "$name" "$cores" "$units" "$wake" "$rate" "$shared" >>"$work/machines"
    done
    speedups "$work/threads" '' "$2" '2 4 8 16 32 128 256 512' >>"$work/measured"
    speedups "$work/frames" render.samples=9 "$2-long" '2 8' >>"$work/measured"
    # The study of long frames with blocks, if it has been run; its tiles on demand would count twice.
    [ ! -s "$work/blocks" ] || speedups "$work/blocks" '' "$2-long" '2 4 8 16 32 128' | grep -v -w dynamic \
        >>"$work/measured" || :
    echo "\\setval{scaling/$2/wake}{$(awk -v s="$wake" 'BEGIN { printf "%.1f", 1e6 * s }')}"
    echo "\\setval{scaling/$2/busy}{$(printf %.2f "$rate")}"
}

: >"$work/machines"
: >"$work/measured"
machine "$results" here
for folder in "$here"/../results/machines/*/; do
    [ -r "$folder/threads/runs.json" ] || continue
    machine "${folder%/}" "$(basename "$folder")"
done
table "$results" pool >"$work/pool"
start=$(each_thread "$work/pool" off)
printf 'published\t4\t8\t%s\t1\t%s\n' "${start%% *}" "$yields" >>"$work/machines"
echo "$start" | awk '{ printf "\\setval{scaling/start}{\\ensuremath{%.0f}", 1e6 * $1
    printf "\\within{%.0f}{%.0f}}\n", 1e6 * $2, 1e6 * $3 }'
printf '%s\n' "$yields" | awk '{ printf "\\setval{scaling/yield/least}{%.2f}\n\\setval{scaling/yield}{%.2f}\n", $1, $2
    printf "\\setval{scaling/yield/largest}{%.2f}\n", $3 }'
awk -f "$here/published.awk" "$here/../experiments/published/threads.csv" |
    awk -v OFS='\t' 'NR == 2 { serial = $2 }
        NR > 2 { print "published", "columns", $1, 10, serial, serial / $2, "NA", "NA" }' >>"$work/measured"

awk -f "$here/share.awk" -f "$here/law.awk" -f "$here/scaling.awk" "$3" "$work/machines" "$work/measured" \
    >"$out/tables/scaling.tsv"
awk -f "$here/scaling_errors.awk" "$out/tables/scaling.tsv" >"$out/tables/scaling-errors.tsv"
awk -f "$here/scaling_tex.awk" "$out/tables/scaling.tsv" "$out/tables/scaling-errors.tsv"

# The picture that was published is not known: the ratio of predicted and published speed-up for other fields of view
# (experiments/views.sh). nearest: the least error that a view has with 4, 8 and 16 threads, as a factor.
if [ -r "$results/tables/maps-views.tsv" ]; then
    awk -f "$here/share.awk" -f "$here/views.awk" -v "rates=$yields" "$work/measured" "$results/tables/maps-views.tsv"
fi
rm -r "$work"
