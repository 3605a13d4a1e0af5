#!/bin/bash
# growth.sh - compare the report's published times by depth (table 4) and by threads (table 5) with its algorithm.
#   experiments/peers/growth.sh [REPORT]      REPORT: the program of peers/report, build/peers/report (make peers)
# Environment: REPS=5 (rounds), SIZE=800x600, THREADS="1 4 8 ..." (table 5's), FOVS="45 110" (fields of view, degrees).
# Every round renders each depth, and then each number of threads, once. The published figures are read from
# experiments/published. Times are medians (lowest to highest), and so are
# ratios of times, formed in each round; counts are exact and the same in every round. Fits are
# least squares of relative deviations, each row weighted alike.
set -euo pipefail
export LC_ALL=C
here=$(cd "$(dirname "$0")" && pwd)
report=${1:-build/peers/report} reps=${REPS:-5} size=${SIZE:-800x600} fovs=${FOVS-45 110}
threads=${THREADS:-1 4 8 16 32 64 128 256 512 1024}
[ -x "$report" ] || {
    echo "usage: growth.sh [REPORT] (no program $report; make peers builds it)" >&2
    exit 2
}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# column FILE.csv KEY VALUE: prints "key value" of each row, columns by their names in the first line; both must be
# numbers, to the left of any quoted text
column() {
    awk -F, -v key="$2" -v value="$3" '
        NR == 1 { for (i = 1; i <= NF; i++) at[$i] = i
                  if (key in at && value in at) next
                  print "growth.sh: no " key " or " value " in " FILENAME >"/dev/stderr"; exit 1 }
        { print $at[key], $at[value] }' "$1"
}
column "$here/../published/depth.csv" depth cpu_s >"$work/depth"
column "$here/../published/threads.csv" threads wall_s >"$work/threads"

library=$(<"$here/../order.awk")

for fov in $fovs; do
    "$report" -d 0,1,2,3,4,5,6,7,8 -s "$size" -f "$fov" -r "$reps" >"$work/rows"
    awk -v fov="$fov" "$library"'
        # Fits T = offset + scale x, minimising the sum of (fitted / T - 1)^2; without an offset, it is 0.
        function fit(what, x, free,   d, w, s0, sx, sy, sxx, sxy, scale, offset, off, worst, text) {
            for (d = 0; d <= 8; d++) {
                w = 1 / (T[d] * T[d])
                s0 += w; sx += w * x[d]; sy += w * T[d]; sxx += w * x[d] * x[d]; sxy += w * x[d] * T[d]
            }
            scale = free ? (s0 * sxy - sx * sy) / (s0 * sxx - sx * sx) : sxy / sxx
            offset = free ? (sy - scale * sx) / s0 : 0
            for (d = 0; d <= 8; d++) {
                off = (offset + scale * x[d]) / T[d] - 1
                text = text sprintf(" %+4.0f", 100 * off)
                if (off < 0) off = -off
                if (off > worst) worst = off
            }
            printf "  %-26s %8.3f s %12.4g s %8.0f%%   %s\n",
                what (free ? ", offset" : ""), offset, scale, 100 * worst, text
        }
        NR == FNR { T[$1] = $2; next }
        FNR == 1 { for (i = 1; i <= NF; i++) at[$i] = i; next }
        { d = $at["depth"]; cpu[d] = cpu[d] " " $at["cpu_s"]; rays[d] = $at["rays"]; sky[d] = $at["sky"]
          shaded[d] = $at["sky"] - $at["camera"]; glass = ($at["vessel"] + $at["liquid"]) / $at["camera"] }
        END {
            printf "field of view %g degrees: %.1f %% of the camera rays hit the glass\n", fov, 100 * glass
            printf "%5s %12s %12s %12s  %-28s | %7s %7s %-22s | %10s %7s\n",
                "depth", "rays", "hits", "sky", "CPU s", "x rays", "x sky", "x CPU", "table 4", "growth"
            for (d = 0; d <= 8; d++) {
                s[d] = median(cpu[d])
                printf "%5d %12d %12d %12d  %-28s | %7.2f %7.2f %-22s | %10.4f %7.2f\n",
                    d, rays[d], shaded[d], sky[d], spread(cpu[d], "%.4f"), rays[d] / rays[0], sky[d] / sky[0],
                    spread_of_ratios(cpu[d], cpu[0], "%.2f"), T[d], T[d] / T[0]
            }
            printf "table 4 by                     offset        scale    worst    deviation by depth, %%\n"
            for (free = 0; free <= 1; free++) {
                fit("our CPU time", s, free); fit("rays", rays, free); fit("sky colours", sky, free)
            }
            print ""
        }' "$work/depth" FS='\t' "$work/rows"
done

"$report" -d 4 -t "${threads// /,}" -s "$size" -r "$reps" >"$work/rows"
awk "$library"'
    NR == FNR { T[$1] = $2; next }
    FNR == 1 { for (i = 1; i <= NF; i++) at[$i] = i; next }
    { t = $at["threads"]; if (!(t in wall)) order[++n] = t
      wall[t] = wall[t] " " $at["wall_s"]; busy[t] = busy[t] " " $at["cpu_s"] / $at["wall_s"]
      by_rays[t] = $at["rays"] / $at["busiest"]; by_sky[t] = $at["sky"] / $at["busiest_sky"] }
    END {
        print "depth 4 by threads; processors: CPU time by wall time, those that the frame had; bounds: all rays, or"
        print "colours of the sky, by those of the busiest thread: the speed-up that blocks of columns allow at best"
        printf "%7s %-28s %-22s %10s %7s %7s | %10s %9s\n",
            "threads", "wall s", "speed-up", "processors", "by rays", "by sky", "table 5", "speed-up"
        for (i = 1; i <= n; i++) {
            t = order[i]
            printf "%7d %-28s %-22s %10.2f %7.2f %7.2f |",
                t, spread(wall[t], "%.4f"), spread_of_ratios(wall[order[1]], wall[t], "%.2f"), median(busy[t]),
                by_rays[t], by_sky[t]
            if (t in T) printf " %10.4f %9.2f", T[t], T[1] / T[t]
            print ""
        }
    }' "$work/threads" FS='\t' "$work/rows"
