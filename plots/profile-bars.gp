# Busy and idle time of each worker, means over the repetitions, for every schedule and pinning.
# needs: profile/workers.csv warmup=0 render.schedule render.pin worker busy_s waiting_s cpu_s
width = 1000; height = 430
load "plots/style.gp"

bars = sprintf("< awk -f plots/workers.awk '%s/profile/workers.csv'", results)
schedules = "columns rows tiles dynamic"
pins = "none compact scatter"
# Index of the words, and position of a worker's bar: schedules from the top, workers within each.
place(schedule) = schedule eq "columns" ? 0 : schedule eq "rows" ? 1 : schedule eq "tiles" ? 2 : schedule eq "dynamic" ? 3 : NaN
middle(schedule, worker, workers) = place(schedule) + 0.1 + 0.8*(worker + 0.5)/workers
half(workers) = 0.36/workers
of(pin) = strcol(2) eq pin ? 1 : NaN

stats bars using ($5 + $6)*1e3 nooutput
longest = STATS_max
set label 100 (readable(table("profile")) ? remarks("profile") : "") at screen 0.5,0.015 center font ",8" textcolor rgb grey
set multiplot layout 1,3 margins 0.08,0.985,0.13,0.86 spacing 0.02
set yrange [4:0]
set xrange [0:longest*1.08]
set xlabel "time / ms"
unset grid
set grid xtics lc rgb pale lw 0.5 dt solid
set border 1
set key at screen 0.5,0.985 center top horizontal maxrows 1 samplen 1 width -1.5
do for [i=1:3] {
    pin = word(pins, i)
    set title "pinning: ".pin
    if (i == 1) {
        set ytics ("columns" 0.5, "rows" 1.5, "tiles" 2.5, "dynamic" 3.5) scale 0
    } else {
        set ytics ("" 0.5) scale 0
        unset key
    }
    plot bars using ($5*500*of(pin)):(middle(strcol(1), $3, $4)):($5*500):(half($4)) with boxxyerror lc rgb blue title "busy", \
         bars using (($5 + $6/2)*1e3*of(pin)):(middle(strcol(1), $3, $4)):($6*500):(half($4)) with boxxyerror lc rgb 0xF3D9A0 \
            title "idle", \
         bars using ($7*1e3*of(pin)):(middle(strcol(1), $3, $4)):(0):(half($4)*1.15) with vectors nohead lc rgb ink lw 2 notitle, \
         bars using ($7*1e3*of(pin)):(middle(strcol(1), $3, $4)):(0):(-half($4)*1.15) with vectors nohead lc rgb ink lw 2 title "CPU time"
    unset label 100
}
unset multiplot
