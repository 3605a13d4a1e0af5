# Cost of starting threads for every frame compared with a persistent pool.
# needs: tables/pool.tsv wall_s_median
width = 1000; height = 430
load "plots/style.gp"

rows = table("pool")
times(pool) = select(rows, "render.pool=".pool, "render.threads wall_s_median wall_s_low? wall_s_high?")
# The values of both on one line, by threads.
both = sprintf("< plots/join.sh '%s' render.threads 'render.pool=off' 'render.pool=on' 'wall_s_median wall_s_low? wall_s_high?'", rows)

set label 100 remarks("pool") at screen 0.5,0.015 center font ",8" textcolor rgb grey
set multiplot layout 1,2 margins 0.08,0.985,0.14,0.92 spacing 0.11
set logscale x 2
set xlabel "threads"
set xrange [0.9:1140]
set xtics rotate by 0 1,4
set yrange [0:*]
set title "Wall time of a frame"
set ylabel "wall time / ms"
set key bottom left
plot times("off") using 1:($2*1e3):($3*1e3):($4*1e3) with yerrorlines lt 2 title "new threads", \
     times("on") using 1:($2*1e3):($3*1e3):($4*1e3) with yerrorlines lt 1 title "persistent pool"
unset label 100
set title "Cost of new threads for each frame"
set ylabel "difference / ms"
set autoscale y
set xzeroaxis lc rgb ink lw 0.8
unset key
if (has_rows(both)) {
    plot both using 1:(($2 - $5)*1e3):(($3 - $7)*1e3):(($4 - $6)*1e3) with yerrorlines lt 4
} else {
    @empty
}
unset multiplot
