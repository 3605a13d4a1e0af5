# What the threads of a frame did, as shares of its wall time, mean over all threads: from two threads to a thousand.
# needs: timeline/workers.csv warmup=0 render.schedule render.threads running_s? runnable_s? blocked_s? busy_s waiting_s start_s
# needs: tables/timeline.tsv wall_s_median
width = 1000; height = 400
load "plots/style.gp"

shares = sprintf("< awk -f plots/thread-states.awk '%s/timeline/workers.csv'", results)
lines = int(system(shares[3:*]." | wc -l"))
schedules = "tiles dynamic"
counts = "2 8 64 1024"
# Runnable: waiting for a processing unit. No tile left: the frame goes on in other threads.
place(threads) = threads == 2 ? 0 : threads == 8 ? 1 : threads == 64 ? 2 : threads == 1024 ? 3 : NaN
of(schedule) = strcol(1) eq schedule ? 1 : NaN
array name[5] = ["not started", "running", "runnable", "blocked", "no tile left"]
array tone[5] = [0xD9D9D9, blue, orange, vermillion, 0xEFEFEF]
# From the sum of the first k shares to that of k + 1.
sum(k) = (k > 0 ? $3 : 0) + (k > 1 ? $4 : 0) + (k > 2 ? $5 : 0) + (k > 3 ? $6 : 0) + (k > 4 ? $7 : 0)

set label 100 remarks("timeline") at screen 0.5,0.02 center font ",8" textcolor rgb grey
set multiplot layout 1,2 margins 0.09,0.985,0.16,0.82 spacing 0.05
set yrange [3.5:-0.5]
set xrange [0:100]
set xlabel "share of the frame / %" offset 0,0.3
unset grid
set border 1
set key at screen 0.52,0.985 center top horizontal maxrows 1 samplen 1 width -3
do for [i=1:2] {
    set title "schedule: ".word(schedules, i)
    if (i == 1) {
        set ylabel "threads"
        set ytics ("2" 0, "8" 1, "64" 2, "1024" 3) scale 0
    } else {
        unset ylabel
        set ytics ("" 0)
        unset key
    }
    if (lines == 0) {
        set label 1 "this system does not measure them" at graph 0.5,0.5 center textcolor rgb grey
        plot NaN notitle
    } else {
        plot for [k=1:5] shares using (100*of(word(schedules, i))*sum(k-1)):(place($2)):(100*sum(k-1)):(100*sum(k)): \
            (place($2) - 0.38):(place($2) + 0.38) with boxxyerror lc rgb tone[k] title name[k]
    }
    unset label 100
}
unset multiplot
