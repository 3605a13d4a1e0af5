# Speed-up by threads for frames of about 0.04, 0.4 and 4 s, by schedule; the longest are those of make experiments-full.
# The ends of an interval combine those of both times, so it contains the speed-up if both contain their medians.
# needs: tables/threads-frames.tsv wall_s_median
width = 1000; height = 430
load "plots/style.gp"

full = table("threads-frames-full")
frames = table("threads-frames")
if (readable(full)) { frames = full }
schedules = "tiles dynamic"
samples = "1 9 25"
where(schedule, rays) = sprintf("render.schedule=%s render.samples=%s", schedule, rays)
times(schedule, rays) = select(frames, where(schedule, rays), "render.threads wall_s_median wall_s_low? wall_s_high?")
one(schedule, rays, column) = first(frames, where(schedule, rays)." render.threads=1", column)
together(n) = units > 0 && n > units ? units : n

set label 100 remarks("threads-frames") at screen 0.5,0.015 center font ",8" textcolor rgb grey
set multiplot layout 1,2 margins 0.07,0.985,0.15,0.92 spacing 0.08
set logscale x 2
set xrange [0.8:1400]
set xtics rotate by 0 1,4
set yrange [0:1.25*(units > 1 ? units : 2)]
set samples 401
set key bottom right font ",9" spacing 1.05
set xlabel "threads"
do for [i=1:2] {
    schedule = word(schedules, i)
    set title "schedule: ".schedule
    set ylabel (i == 1 ? "speed-up" : "")
    array base[3]; array low[3]; array high[3]; array name[3]
    do for [k=1:3] {
        base[k] = one(schedule, word(samples, k), "wall_s_median")
        low[k] = one(schedule, word(samples, k), "wall_s_low")
        high[k] = one(schedule, word(samples, k), "wall_s_high")
        name[k] = base[k] > 0 ? sprintf("%.2g s with one thread", base[k]) : ""
    }
    plot together(x) lt 8 title units > 0 ? sprintf("ideal on %d units, min(n, %d)", units, units) : "ideal", \
         for [k=1:3] times(schedule, word(samples, k)) \
            using ($1*(1 + 0.06*(k - 2))):(base[k]/$2):(low[k]/$4):(over(high[k], $3)) with yerrorlines lt k title name[k]
    unset label 100
}
unset multiplot
