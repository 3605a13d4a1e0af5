# Which worker rendered which tile of the image when, from two threads to a thousand, for fixed tiles and tiles on demand.
# needs: tables/timeline.tsv wall_s_median
# needs: timeline/images/*-timeline.json
width = 1000; height = 900
load "plots/style.gp"

rows = table("timeline")
schedules = "tiles dynamic"
counts = "2 8 64 1024"
cell(schedule, threads) = first(rows, "render.schedule=".schedule." render.threads=".threads, "cell")
file(schedule, threads) = sprintf("%s/timeline/images/%04d-timeline.json", results, int(cell(schedule, threads)))
known(schedule, threads) = cell(schedule, threads) >= 0 && readable(file(schedule, threads))
pieces(schedule, threads) = sprintf("< plots/timeline.py '%s' %s", file(schedule, threads), threads > 100 ? "0.5" : "")

end = 0
set datafile separator whitespace
do for [schedule in schedules] { do for [threads in counts] {
    if (known(schedule, threads)) {
        stats pieces(schedule, threads) using 2 nooutput
        if (STATS_max > end) { end = STATS_max }
    }
} }
if (end == 0) { end = 1 }
# A pixel at least.
longer(length) = length > 0.003*end ? length : 0.003*end
set label 100 remarks("timeline") at screen 0.5,0.012 center font ",8" textcolor rgb grey
set palette defined @viridis
set cbrange [0:1]
set cbtics ("first" 0, "last" 1) scale 0
set cblabel "position of the tile, in reading order" offset -2.5,0
unset key
unset grid
set border 1
set style fill solid 1.0 border lc rgb "#ffffff"
set xrange [0:end*1.02]
set multiplot layout 4,2 margins 0.065,0.885,0.08,0.965 spacing 0.05,0.035
set colorbox user origin 0.9,0.08 size 0.014,0.885
do for [i=1:4] {
    threads = word(counts, i)
    workers = int(threads)
    set yrange [workers - 0.5:-0.5]
    if (workers > 8) { set ytics 0,workers/4,workers scale 0 } else { set ytics 0,(workers > 2 ? workers/2 : 1) scale 0 }
    set format x (i == 4 ? "%h" : "")
    set xlabel (i == 4 ? "time since the frame's start / ms" : "")
    do for [k=1:2] {
        schedule = word(schedules, k)
        set title (i == 1 ? "schedule: ".schedule : "") offset 0,-0.8
        set ylabel (k == 1 ? threads." workers" : "")
        if (known(schedule, threads)) {
            if (workers > 8) {
                plot pieces(schedule, threads) using 1:3:(longer($2 - $1)):(0):4 with vectors nohead lw (workers > 64 ? 0.6 : 2) lc palette
            } else {
                plot pieces(schedule, threads) using (($1 + $2)/2):3:(($2 - $1)/2):(0.42):4 with boxxyerror lw 0.15 fc palette
            }
        } else {
            plot NaN
        }
        unset colorbox
        unset label 100
    }
}
unset multiplot
