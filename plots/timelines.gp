# When each thread of a frame works, from two threads to a thousand, for fixed tiles and for tiles on demand, and for
# what fraction of that time it has a processing unit. One frame each, drawn from the rows of the threads.
# needs: timeline/workers.csv warmup=0 render.schedule render.threads run process repetition worker tiles running_s? start_s wall_s
# needs: tables/timeline.tsv wall_s_median
width = 318; height = 330
load "plots/style.gp"

schedules = "tiles dynamic"
titles = "'fixed tiles' 'tiles on demand'"
counts = "2 8 64 1024"
lives(schedule, threads) = sprintf("< awk -v schedule=%s -v threads=%s -f plots/lives.awk '%s/timeline/workers.csv'", \
    schedule, threads, results)
end = 0
do for [schedule in schedules] { do for [threads in counts] {
    if (int(system(lives(schedule, threads)[3:*]." | wc -l")) > 0) {
        stats lives(schedule, threads) using 3 nooutput
        if (STATS_max > end) { end = STATS_max }
    }
} }
if (end == 0) { end = 1 }
# A point at least.
longer(length) = length > 0.006*end ? length : 0.006*end
set label 9999 font ",6.5"
set label 100 remarks("timeline") at screen 0.01,0.012 left font ",6.5" textcolor rgb grey
# Viridis without its end, whose yellow is too light for thin lines.
set palette defined (0 "#440154", 1 "#3b528b", 2 "#21918c", 3 "#5ec962")
set cbrange [0:1]
set cbtics ("0" 0, "1" 1) scale 0 font ",7" offset -0.8,0
set cblabel "fraction of it with a processing unit" offset -1,0 font ",7"
unset key
unset grid
set border 1
set tics font ",7"
set style fill solid 1.0 noborder
set xrange [0:end*1.01]
set xtics 50
set multiplot layout 4,2 margins 0.1,0.875,0.115,0.945 spacing 0.04,0.035
set colorbox user origin 0.895,0.115 size 0.02,0.83
do for [i=1:4] {
    threads = word(counts, i)
    workers = int(threads)
    set yrange [workers - 0.5:-0.5]
    unset ytics
    set format x (i == 4 ? "%h" : "")
    set xlabel (i == 4 ? "time since the frame's start / ms" : "") offset 0,0.5
    do for [k=1:2] {
        schedule = word(schedules, k)
        set title (i == 1 ? word(titles, k) : "") offset 0,-0.9 font ",7.5"
        set ylabel (k == 1 ? threads." threads" : "") offset 0.5,0
        plot lives(schedule, threads) using \
            ($2 + longer($3 - $2)/2):1:(longer($3 - $2)/2):(workers > 100 ? 4 : workers > 8 ? 0.5 : 0.42):4 \
            with boxxyerror fc palette
        unset colorbox
        unset label 100
    }
}
unset multiplot
