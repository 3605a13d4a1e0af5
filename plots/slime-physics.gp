# Motion of a slime compared with mechanics: loss of energy and momentum of a free slime, orders, the fall, and the
# longest stable step.
# needs: tables/slime-physics-motion.tsv measured
width = 1000; height = 760
load "plots/style.gp"

rows = table("slime-physics-motion")
integrators = "euler verlet implicit"
names = "'semi-implicit Euler' 'velocity Verlet' 'backward Euler'"
of(i, name, columns) = select(rows, sprintf("name=%s toy.stiffness=10 toy.integrator=%s", name, word(integrators, i)), columns)
by_step(i, name) = of(i, name, "toy.dt_s measured theory error")
by_stiffness(i, name) = select(rows, sprintf("name=%s toy.dt_s=0.001 toy.integrator=%s", name, word(integrators, i)), \
    "toy.stiffness measured theory")." | sort -g"
set multiplot layout 2,2 margins 0.085,0.985,0.075,0.955 spacing 0.115,0.125
set logscale xy
set format y "10^{%T}"
set xlabel "step dt / ms"
set xrange [0.2:10]
set xtics (0.25, 0.5, 1, 2, 4, 8)
set grid xtics ytics lc rgb pale lw 0.5 dt solid

set title "Energy of a free toy, 1 s, no damping"
set ylabel "largest |E - E_0| / E_0"
set yrange [1e-6:10]
set key bottom right Right noreverse
plot for [i=1:3] by_step(i, "energy.drift") using ($1*1e3):2 with linespoints lt i title word(names, i), \
     1.1e-2*x with lines lt 8 title "dt", 1.3e-4*x**2 with lines lt 8 dt (6,3) title "dt^2"

set title "Momentum and angular momentum of a free toy, 1 s"
set ylabel "largest change / sum of magnitudes"
set yrange [1e-17:10]
set key at graph 0.98,0.7 top right Right noreverse
plot for [i=1:3] by_step(i, "angular_momentum.drift") using ($1*1e3):2 with linespoints lt i title word(names, i).", angular", \
     for [i=1:3] by_step(i, "momentum.drift") using ($1*1e3):2 with points lt i pt 4+2*i title word(names, i)

set title "Fall of 1 s against g t^2 / 2, and a spring's period"
set ylabel "absolute error, m and s"
set yrange [1e-15:10]
set key at graph 0.98,0.5 top right Right noreverse
plot by_step(1, "fall.depth") using ($1*1e3):4 with linespoints lt 1 title "fall, semi-implicit and backward Euler", \
     9.81*x*1e-3/2 with lines lt 8 title "g t dt / 2", \
     by_step(2, "fall.depth") using ($1*1e3):4 with linespoints lt 2 title "fall, Verlet", \
     by_step(1, "spring.period_s") using ($1*1e3):4 with linespoints lt 4 title "period, semi-implicit and Verlet", \
     by_step(3, "spring.period_s") using ($1*1e3):4 with linespoints lt 3 title "period, backward Euler"

set title "The longest stable step"
set xlabel "stiffness k of a spring along an edge / (N / m)"
set ylabel "step / ms"
set format y "%h"
set xtics (1, 10, 100, 1000)
set xrange [0.7:1500]
set yrange [0.04:200]
set key default
set key inside bottom left Left reverse samplen 2 spacing 1.15
m = 1.0/162
plot by_stiffness(1, "stable_dt.spring_s") using 1:($2*1e3) with points lt 3 title "two masses on a spring, measured", \
     2/sqrt(2*x/m)*1e3 with lines lt 3 title "2 / ω = 2 (m / 2k)^{1/2}", \
     by_stiffness(1, "stable_dt.toy_s") using 1:($2*1e3) with linespoints lt 1 title "the toy, semi-implicit Euler", \
     by_stiffness(2, "stable_dt.toy_s") using 1:($2*1e3) with linespoints lt 2 title "the toy, Verlet", \
     for [i=1:2] by_stiffness(i, "stable_dt.toy_s") using 1:($3*1e3) with lines lt i dt (2,3) notitle, \
     NaN with lines lc rgb ink dt (2,3) title "lower bounds (Gershgorin)"
unset multiplot
