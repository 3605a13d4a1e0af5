# Which worker rendered which tile of the image when, for each schedule without pinning.
# needs: tables/profile.tsv profile/images/*-timeline.json
width = 1000; height = 560
load "plots/style.gp"

rows = table("profile")
schedules = "columns rows tiles dynamic"
timeline(schedule) = sprintf("%s/profile/images/%04d-timeline.json", results, \
    int(first(rows, "render.pin=none render.schedule=".schedule, "cell")))
pieces(schedule) = sprintf("< plots/timeline.sh '%s'", timeline(schedule))

end = 0
workers = 1
set datafile separator whitespace
do for [i=1:4] {
    if (readable(timeline(word(schedules, i)))) {
        stats pieces(word(schedules, i)) using 2 nooutput
        if (STATS_max > end) { end = STATS_max }
        stats pieces(word(schedules, i)) using 3 nooutput
        if (STATS_max + 1 > workers) { workers = STATS_max + 1 }
    }
}
set palette defined @viridis
set cbrange [0:1]
set cbtics ("first" 0, "last" 1) scale 0
set cblabel "position of the tile, in reading order" offset -2.5,0
unset key
unset grid
set border 1
set xrange [0:end*1.02]
set yrange [workers - 0.5:-0.5]
set ytics 1 scale 0
if (workers > 8) { set ytics autofreq }
set ylabel "worker"
set style fill solid 1.0 border lc rgb "#ffffff"
set multiplot layout 4,1 margins 0.075,0.865,0.09,0.95 spacing 0,0.07
set colorbox user origin 0.885,0.09 size 0.014,0.86
do for [i=1:4] {
    set title word(schedules, i) offset 0,-0.8
    set format x (i == 4 ? "%h" : "")
    set xlabel (i == 4 ? "time since the frame's start / ms" : "")
    if (readable(timeline(word(schedules, i)))) {
        plot pieces(word(schedules, i)) using (($1 + $2)/2):3:(($2 - $1)/2):(0.4):4 with boxxyerror lw 0.15 fc palette
    } else {
        plot NaN
    }
    unset colorbox
}
unset multiplot
