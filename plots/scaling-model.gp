# Speed-up over the best serial run: the published one, predicted from the cost of columns (paper/share.awk), and below
# it those of our machines. Bars are 95 % intervals that combine the ends of both times.
# needs: tables/scaling.tsv
width = 318; height = 420
load "plots/style.gp"
file = table("scaling")
own = system("cut -f 1 '".file."' | sort -u | grep -v -e machine -e published -e '-long$'")
units_of(m) = first(file, "machine=".m." render.schedule=dynamic", "units")
name_of(m) = sprintf("%s, %d units", m eq "here" ? "reference" : m, units_of(m))
of(m, schedule, columns) = \
    select(file, "machine=".m." render.schedule=".schedule, "render.threads ".columns)
# The value of a curve at that number of threads.
at(m, schedule, column, n) = \
    first(file, sprintf("machine=%s render.schedule=%s render.threads=%d", m, schedule, n), column)

unset key
set logscale x 2
set xrange [1.7:1500]
set border 3
set tics font ",7"
set bars 0.4
set multiplot
# --- the published curve
set lmargin at screen 0.1; set rmargin at screen 0.985
set tmargin at screen 0.955; set bmargin at screen 0.535
set title "published: columns, 4 cores with 8 logical" font ",7.5" offset 0,-0.7
set yrange [0:6]; set ytics 1
set xtics 4
set ylabel "speed-up" font ",7.5" offset 1.6,0
m = "published"
set label 1 "equal blocks" at 4.6,4.95 left font ",7" textcolor rgb green
set label 2 "model,\nyields 1.00 to 1.35" at 90,3.35 left font ",7" textcolor rgb blue
set label 3 "Amdahl, fitted to the\nother half of the counts" at 20,1.9 left font ",7" textcolor rgb vermillion
set label 4 "published" at 14.5,2.72 left font ",7" textcolor rgb ink
set arrow 1 from 24,2.15 to 16.6,3.5 nohead lc rgb vermillion lw 0.5
plot of(m, "columns", "least largest") using 1:2:3 with filledcurves lc rgb 0xC4DDED, \
     of(m, "columns", "even") using 1:2 with lines lc rgb green lw 1.4 dt (2,2), \
     of(m, "columns", "amdahl") using 1:2 with lines lc rgb vermillion lw 1.2 dt (7,3), \
     of(m, "columns", "predicted") using 1:2 with lines lc rgb blue lw 2, \
     of(m, "columns", "speedup_median") using 1:2 with linespoints lc rgb ink lw 0.8 pt 7 ps 0.5
unset for [i=1:4] label i
unset arrow 1
# --- our machines
do for [i=1:words(own)] {
    m = word(own, i)
    wide = 0.885 / words(own)
    set lmargin at screen 0.1 + wide*(i - 1)
    set rmargin at screen 0.1 + wide*i - (i < words(own) ? 0.075 : 0)
    set tmargin at screen 0.425; set bmargin at screen 0.115
    set title name_of(m) font ",7" offset 0,-0.7
    if (units_of(m) < 4) { unset logscale y; set yrange [0:2.6]; set ytics 0.5 }
    else { set logscale y 2; set yrange [0.8:1.6*units_of(m)]; set ytics 2 }
    set xtics 8
    set xlabel "threads" font ",7.5" offset 0,0.3
    set ylabel (i == 1 ? "speed-up" : "")
    set label 1 "dynamic" at 60,1.22*at(m, "dynamic", "predicted", 32) center font ",7" textcolor rgb vermillion
    set label 2 "columns" at 11,0.78*at(m, "columns", "speedup_median", 8) left font ",7" textcolor rgb blue
    if (i == words(own)) {
        set label 3 "dotted: units slower\nwhen all are busy" at 1300,1.38 right font ",6.5" textcolor rgb grey
    }
    plot for [k=1:2] of(m, word("columns dynamic", k), "predicted") using 1:2 with lines lt k lw 1.4, \
         for [k=1:2] of(m, word("columns dynamic", k), "busy") using 1:2 with lines lt k lw 1.0 dt (2,2), \
         for [k=1:2] of(m, word("columns dynamic", k), "speedup_median speedup_low speedup_high") \
             using (k == 1 ? $1/1.06 : $1*1.06):2:3:4 with yerrorbars lt k lw 0.9 ps 0.5
}
unset multiplot
