# Speed-up by threads for each schedule, with the ideal line, two laws fitted, and the published numbers.
#   Amdahl 1967:   S = p / (1 + σ (p - 1)),                 σ: the serial share
#   Gunther 1993:  S = p / (1 + σ (p - 1) + κ n (n - 1)),   κ: the exchange of each thread with each other one
# n threads on u processing units run p = min(n, u) at a time; so the serial share acts on p, while every thread
# made takes part in the exchange. For n <= u both are the laws as published.
# needs: tables/threads.tsv
width = 1000; height = 760
load "plots/style.gp"

rows = table("threads")
schedules = "columns rows tiles dynamic"
times(schedule) = select(rows, "render.schedule=".schedule, "render.threads wall_s_median wall_s_low wall_s_high")
published_1 = first(published."threads.csv", "threads=1", "wall_s")

together(n) = units > 0 && n > units ? units : n
amdahl(n) = together(n) / (1 + s_a*(together(n) - 1))
gunther(n) = together(n) / (1 + s_g*(together(n) - 1) + k_g*1e-6*n*(n - 1))

set multiplot layout 2,2 margins 0.07,0.985,0.08,0.955 spacing 0.09,0.12
set logscale x 2
set xrange [0.9:1140]
set xtics rotate by 0 1,4
set yrange [0:1.7*(units > 5 ? units : 5)]
set samples 401
set key top left font ",9" spacing 1.05
do for [i=1:words(schedules)] {
    schedule = word(schedules, i)
    lines = int(system(times(schedule)[3:*]." | wc -l"))
    one = first(rows, "render.schedule=".schedule." render.threads=1", "wall_s_median")
    law_a = "Amdahl: too few rows"; law_g = "universal scalability law: too few rows"
    s_a = 0.01; s_g = 0.01; k_g = 0.001; fitted_a = 0; fitted_g = 0
    if (units > 1 && lines >= 3) {
        fit amdahl(x) times(schedule) using 1:(one/$2) via s_a
        fitted_a = 1
        law_a = sprintf("Amdahl: σ = %.4f ± %.4f", s_a, s_a_err)
    }
    if (units > 1 && lines >= 4) {
        fit gunther(x) times(schedule) using 1:(one/$2) via s_g, k_g
        fitted_g = 1
        law_g = sprintf("Gunther: σ = %.4f ± %.4f, κ = (%.2f ± %.2f)·10^{-6}", s_g, s_g_err, k_g, k_g_err)
    }
    set title "schedule: ".schedule
    set xlabel (i > 2 ? "threads" : "")
    set ylabel (i % 2 ? "speed-up" : "")
    plot together(x) lt 8 title units > 0 ? sprintf("ideal on %d units, min(n, %d)", units, units) : "ideal", \
         select(published."threads.csv", "", "threads wall_s") using 1:(published_1/$2) with linespoints lt 7 title published_name, \
         (fitted_g ? gunther(x) : NaN) with lines lc rgb orange lw 4 title law_g, \
         (fitted_a ? amdahl(x) : NaN) with lines lc rgb ink lw 1.2 title law_a, \
         times(schedule) using 1:(one/$2):(one/$4):(one/$3) with yerrorbars lt i title "measured, wall"
}
unset multiplot
