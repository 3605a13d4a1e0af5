# How often smaller studies mislead: false claims by design and rule, and wrong signs by the difference that there is.
# Rates are those of experiments/repeat.sh, of every machine and load that has them; the intervals count the studies that
# share no process.
# needs: tables/flips.tsv
width = 318; height = 300
load "plots/style.gp"

rows = table("flips")
# Machine, load and what others used, of each population.
populations = system("awk -F'\t' 'NR > 1 && !seen[$1 $2]++ { print $1 \"/\" $2 \"/\" $3 }' '".rows."'")
part(i, k) = system("echo '".word(populations, i)."' | cut -d/ -f".k)
name(i) = (part(i, 1) eq "here" ? "" : part(i, 1).", ").sprintf("others %.0f %%", 100*part(i, 3))
where(i) = "machine=".part(i, 1)." load=".part(i, 2)
rates(i, rule) = select(rows, where(i)." contrast=same order=apart rule=".rule, \
    "processes repetitions wrong wrong_low wrong_high")
signs(i, design) = sprintf("< for c in two ten fifty; do awk -f plots/select.awk -v where='%s contrast='$c' order=together \
rule=sign design=%s' -v columns='work wrong wrong_low wrong_high' '%s'; done", where(i), design, rows)
# One process with 1, 3, 10 repetitions; 3 and 10 processes with one, 3 with ten.
place(processes, repetitions) = processes == 1 ? (repetitions == 1 ? 1 : repetitions == 3 ? 2 : 3) : \
    repetitions == 10 ? 6.4 : processes == 3 ? 4.4 : 5.4
count = words(populations)
shift(i) = 0.17*(i - 0.5*(count + 1))

set multiplot layout 2,2 margins 0.115,0.985,0.105,0.945 spacing 0.1,0.145
set bars 0
set title font ",7.5" offset 0,-0.7
set tics font ",6.5" scale 0.4
set yrange [0:104]
set ytics 0,25
set ylabel "false claims / %" font ",6.5" offset 2.2
set xrange [0.4:7]
set xtics ("1" 1, "3" 2, "10" 3, "3" 4.4, "10" 5.4, "30" 6.4) offset 0,0.4
set xlabel "repetitions" font ",6.5" offset 0,0.9
set arrow 1 from 3.7,graph 0 to 3.7,graph 1 nohead lc rgb pale lw 0.6
set label 1 "one process" at 2,graph 0.05 center font ",6.5" textcolor rgb grey
set label 2 "3, 10, 3 processes" at 5.4,graph 0.05 center font ",6.5" textcolor rgb grey
unset key
set title "medians differ by over 5 %"
plot for [i=1:count] rates(i, "effect") using (place($1,$2)+shift(i)):($3*100):($4*100):($5*100) with yerrorbars lt i ps 0.5 lw 0.9

set ylabel ""
set title "t test at 5 %"
unset label 1
unset label 2
set key top right Right noreverse font ",6.5" samplen 0.5 spacing 0.85
set arrow 2 from graph 0,first 5 to graph 1,first 5 nohead lc rgb ink lw 0.6 dt (3,3)
plot for [i=1:count] rates(i, "t") using (place($1,$2)+shift(i)):($3*100):($4*100):($5*100) with yerrorbars lt i ps 0.5 lw 0.9 title name(i)

set ylabel "false claims / %"
set title "disjoint intervals; ratio"
unset key
plot for [i=1:count] rates(i, "medians") using ($1 == 1 ? place($1,$2)+shift(i) : NaN):($3*100):($4*100):($5*100) with yerrorbars lt i ps 0.5 lw 0.9, \
     for [i=1:count] rates(i, "ratio") using (place($1,$2)+shift(i)):($3*100):($4*100):($5*100) with yerrorbars lt i ps 0.5 lw 0.9

unset arrow 1
unset arrow 2
set title "wrong sign"
set ylabel ""
set yrange [0:65]
set ytics 0,20
set logscale x 1.1
set xrange [0.98:1.75]
set xtics ("1.03" 1.027, "1.1" 1.095, "1.5" 1.504)
set xlabel "work, B / A (rays)" font ",6.5"
set label 3 "rays: never" at 1.2,2.6 center font ",6.5" textcolor rgb ink
set arrow 3 from 1.027,0 to 1.504,0 nohead lc rgb ink lw 1.6
designs = "1x1 1x3 1x10"
set for [k=1:3] label 10+k word("1 3 10", k) at 1.58,100*first(rows, where(1)." contrast=fifty order=together rule=sign design=".word(designs, k), "wrong")+(k == 2 ? 2.5 : -1.5) font ",6.5" textcolor lt k
plot for [k=1:3] signs(1, word(designs, k)) using ($1*(1 + 0.012*(k - 2))):($2*100):($3*100):($4*100) with yerrorlines lt k ps 0.5 lw 0.9
unset multiplot
