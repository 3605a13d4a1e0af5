# Every metric of optics over the pairs of refractive indices: its error over its tolerance, and whether it passes.
# needs: tables/realism-metrics.tsv metric unit error tolerance passes
width = 1000; height = 800
load "plots/style.gp"

rows = table("realism-metrics")
distinct(column, order) = system(select(rows, "", column)[3:*]." | ".order." | tr '\\n' ' '")
metrics = distinct("metric", "awk '!seen[$0]++'")
vessels = distinct("vessel.ior", "sort -gu")
liquids = distinct("liquid.ior", "sort -gu")
# Row of a metric, from 0; column of a pair, grouped by vessel.
place(list, name) = words((" ".list." ")[1:strstrt(" ".list." ", " ".name." ")])
down(metric) = place(metrics, metric)
across(vessel, liquid) = place(vessels, vessel)*words(liquids) + place(liquids, liquid)
pairs = words(vessels)*words(liquids)
lowest = -6
# Four words for each metric in order: its name, largest error and tolerance (one digit and a power of ten), and unit, with
# spaces that do not divide words.
list = system("awk -F '\\t' 'NR == 1 { for (i = 1; i <= NF; i++) at[$i] = i; next } \
    { m = $at[\"metric\"]; e = $at[\"error\"]; t = $at[\"tolerance\"]; u = $at[\"unit\"] } \
    !(m in unit) { order[++n] = m; unit[m] = \"NA\" } \
    e != \"NA\" && e + 0 > error[m] + 0 { error[m] = e } t != \"NA\" && t + 0 > tolerance[m] + 0 { tolerance[m] = t } \
    u != \"NA\" { gsub(/ /, \" \", u); unit[m] = u } \
    END { for (i = 1; i <= n; i++) printf \"%s %.0e %.0e %s \", order[i], error[order[i]], tolerance[order[i]], unit[order[i]] }' '".rows."'")
of(i, k) = word(list, 4*(i - 1) + k)
known(text) = text eq "NA" ? "" : text

set multiplot
unset key; unset grid
set border 0
set lmargin at screen 0.2
set rmargin at screen 0.75
set tmargin at screen 0.905
set bmargin at screen 0.095
set xrange [-0.5:pairs - 0.5]
set yrange [words(metrics) - 0.5:-0.5]
unset xtics
set ytics scale 0 font ",9" noenhanced
set for [i=1:words(metrics)] ytics add (word(metrics, i) i - 1)
set palette defined @viridis
set cbrange [lowest:0]
set colorbox horizontal user origin 0.2,0.045 size 0.34,0.016
set cbtics scale 0.3 font ",9" ("exact or ≤ 10^{-6}" lowest, "10^{-4}" -4, "10^{-2}" -2, "1" 0)
set label 1 "error / tolerance" at screen 0.19,0.053 right font ",9"
set label 2 "✓ passes    ✗ fails" at screen 0.6,0.053 left font ",9"
set label 3 "undefined in theory" at screen 0.757,0.053 left font ",9"
set object 3 rectangle from screen 0.735,0.044 to screen 0.752,0.062 fc rgb pale
set label 4 "refractive index of the vessel" at screen 0.193,0.952 right font ",9"
set label 5 "of the liquid" at screen 0.193,0.922 right font ",9"
do for [v=1:words(vessels)] {
    set label 10 + v sprintf("%.1f", real(word(vessels, v))) at (v - 0.5)*words(liquids) - 0.5, screen 0.952 center
    do for [l=1:words(liquids)] {
        set label 10 + v*20 + l "".word(liquids, l) at (v - 1)*words(liquids) + l - 1, screen 0.922 center font ",8"
    }
    edge = (v - 1)*words(liquids) - 0.5
    if (v > 1) { set arrow v from edge, -0.5 to edge, words(metrics) - 0.5 nohead lc rgb "white" lw 3 front }
}
set label 6 "largest error" at screen 0.83,0.922 right font ",9"
set label 7 "tolerance" at screen 0.9,0.922 right font ",9"
set label 8 "unit" at screen 0.908,0.922 left font ",9"
do for [i=1:words(metrics)] {
    set label 200 + i "".(of(i, 2) eq "0e+00" ? "0" : of(i, 2)) at screen 0.83, first i - 1 right font ",9"
    set label 300 + i "".of(i, 3) at screen 0.9, first i - 1 right font ",9"
    set label 400 + i known(of(i, 4)) at screen 0.908, first i - 1 left font ",9"
}
cells(where, columns) = select(rows, where, "metric vessel.ior liquid.ior ".columns)
level(error, tolerance) = error > 0 ? (log10(error/tolerance) < lowest ? lowest : log10(error/tolerance)) : lowest
# On the bright end of the colours the mark is dark.
colour(error, tolerance, passes) = passes == 0 ? vermillion : level(error, tolerance) > -2 ? ink : 0xffffff
half = 0.46
plot cells("", "error tolerance") using (across(strcol(2), strcol(3))):(down(strcol(1))):(half):(half):(level($4, $5)) \
        with boxxyerror palette, \
     cells("passes=NA", "cell") using (across(strcol(2), strcol(3))):(down(strcol(1))):(half):(half) with boxxyerror lc rgb pale, \
     cells("", "error tolerance passes") using (across(strcol(2), strcol(3))):(down(strcol(1))):($6 == 0 ? "✗" : "✓"):(colour($4, $5, $6)) \
        with labels font ",9" textcolor rgb variable
unset multiplot
