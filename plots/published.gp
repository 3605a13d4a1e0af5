# The four published series and ours on one axis each: every series relative to its own first value, so that machines
# and units cancel. The times of empty scenes are marked at the left. Bars: 95 % intervals of medians where a cell has
# six rows, else the smallest and the largest, both over the first value's other end; most are smaller than the points.
# needs: tables/depth.tsv cpu_s_median
# needs: tables/triangles.tsv cpu_s_median
# needs: tables/coverage.tsv cpu_s_median
# needs: tables/crowding.tsv cpu_s_median
width = 658; height = 222
load "plots/style.gp"

# Columns of the ends of a cell's median: an interval, or the range of fewer than six rows.
ends(study) = number(text(table(study), "", "cpu_s_low")) > 0 ? "cpu_s_low? cpu_s_high?" : "cpu_s_min cpu_s_max"
ours(study, where, x) = select(table(study), where, x." cpu_s_median ".ends(study))
# Lines of x, value and ends relative to the first line of at least `from`.
relative(command, from) = command.sprintf(" | sort -g | awk '$1 >= %g { if (!n++) { m = $2; l = $3; h = $4 } ", from). \
    "print $1, $2/m, (n > 1 ? $3/h : 1), (n > 1 ? $4/l : 1) }'"
theirs(series, columns) = select(published.series.".csv", "", columns)." | awk '{ print $0 \"\\t\" $2 \"\\t\" $2 }'"
empty_share(command, first_s) = number(system(command[3:*]." | awk '$1 == 0 { print $2 }'"))/first_s
first_s(command, from) = number(system(command[3:*].sprintf(" | sort -g | awk '$1 >= %g { print $2; exit }'", from)))
n_of(study) = first(table(study), "", "n")

set datafile separator whitespace
set label 9999 font ",6.5"
set multiplot layout 1,4 margins 0.058,0.995,0.25,0.92 spacing 0.042
set key off
set yrange [0:*]
set grid ytics lc rgb pale lw 0.5 dt solid
set tics font ",7"
set title font ",7.5" offset 0,-0.7
set xlabel offset 0,0.5 font ",7.5"

# a: recursion depth
theirs_1 = theirs("depth", "depth cpu_s")
ours_1 = ours("depth", "", "render.depth")
set label 10 "CPU time / first value" at screen 0.008,0.55 center rotate font ",7.5"
set title sprintf("a  recursion depth (n = %d)", n_of("depth"))
set xrange [-0.3:8.5]
set xtics 2
set yrange [0:*]
set label 2 "published" at 8.2,3.2 right font ",7" textcolor rgb grey
set label 3 "ours" at 6.6,9.2 right font ",7" textcolor rgb blue
plot relative(theirs_1, 0) using 1:2 with linespoints lt 7, \
     relative(ours_1, 0) using 1:2:3:4 with yerrorlines lt 1

# b, c and d: octant tree and boxes
series_names = "triangles coverage crowding"
x_columns = "'triangles time_s' 'pixels time_s' 'triangles time_s'"
our_columns = "soup.count first_hits.model soup.count"
titles = "'b  sparse triangles' 'c  covered pixels' 'd  crowded triangles'"
bases = "10000 90000 10000"
# Where the labels stand: published, octant tree, boxes, empty scene.
spots = "'51,1.45 28,2.3 48,2.35' '500,2.55 300,3.0 500,1.4' '51,2.2 36,3.7 51,1.2'"
empties = "'3,0.41 3,0.095' '20,0.62 20,0.62' '3,0.12 3,0.12'"
spot(list, i, k) = word(word(list, i), k)
across(pair) = real(pair[1:strstrt(pair, ",") - 1])
up(pair) = real(pair[strstrt(pair, ",") + 1:*])
unset label 10
do for [i=1:3] {
    study = word(series_names, i)
    from = int(word(bases, i))
    theirs_i = theirs(study, word(x_columns, i))
    visible = i == 1 ? "model.visible=on " : ""
    ours_i(accel) = ours(study, visible."render.accel=".accel, word(our_columns, i)). \
        " | awk '$1 <= 500000 && (".i." == 2 || $1 <= 50000)'"
    set title sprintf("%s (n = %d)", word(titles, i), n_of(study))
    set xrange [i == 2 ? -25 : -3 : i == 2 ? 510 : 53]
    set xtics i == 2 ? 100 : 10
    set xlabel (i == 2 ? "1000 pixels" : "1000 triangles")
    theirs_empty = empty_share(theirs_i, first_s(theirs_i, from))
    ours_empty = i == 1 ? first(table(study), "model.visible=off", "cpu_s_median")/first_s(ours_i("bvh"), from) : NaN
    set label 2 "published" at across(spot(spots, i, 1)),up(spot(spots, i, 1)) right
    set label 3 "octant tree" at across(spot(spots, i, 2)),up(spot(spots, i, 2)) right textcolor rgb green
    set label 4 "boxes" at across(spot(spots, i, 3)),up(spot(spots, i, 3)) right font ",7" textcolor rgb blue
    set label 5 "empty scene" at across(spot(empties, i, 1)),up(spot(empties, i, 1)) left font ",6.6" textcolor rgb grey
    if (i == 1) {
        set label 6 "empty, ours" \
            at across(spot(empties, i, 2)),up(spot(empties, i, 2)) left font ",6.6" textcolor rgb blue
    } else {
        unset label 6
    }
    plot relative(theirs_i, from) using ($1/1e3):2 with linespoints lt 7, \
         relative(ours_i("octant"), from) using ($1/1e3):2:3:4 with yerrorlines lt 3, \
         relative(ours_i("bvh"), from) using ($1/1e3):2:3:4 with yerrorlines lt 1, \
         '+' every ::0::0 using (0):(theirs_empty) with points pt 6 ps 1 lc rgb grey, \
         '+' every ::0::0 using (0):(ours_empty) with points pt 6 ps 1 lc rgb blue
}
unset multiplot
