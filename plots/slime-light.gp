# Transmittance of a ball of slime by path length, compared with the Beer-Lambert law, and the error of the lengths
# against the chords of the ball.
# needs: tables/slime-light.tsv toy.level=7 jelly.transparency=1 cell
# needs: slime-light/images/*.pfm
width = 1000; height = 430
load "plots/style.gp"

rows = table("slime-light")
cell(level, fraction) = first(rows, sprintf("toy.level=%d jelly.transparency=%g", level, fraction), "cell")
float_image(cell) = cell >= 0 ? sprintf("%s/slime-light/images/%04d.pfm", results, int(cell)) : "/dev/null"
chords(level, fraction) = sprintf("< image='%s'; [ ! -s $image ] || plots/chord.sh $image 6 0.493", float_image(cell(level, fraction)))
# Rms over the row of pixels: length from the green channel, absorbed by 1 / m, minus the chord.
off(level) = number(system(chords(level, 1)[3:*]." | awk '{ e = -log($3) - $1; s += e*e } END { if (NR) print sqrt(s/NR) }'"))
set multiplot layout 1,2 margins 0.08,0.985,0.135,0.93 spacing 0.1
set title "Transmittance of the ball, level 7"
set xlabel "path length d / m"
set ylabel "transmittance"
set logscale y
set xrange [0:2.05]
set yrange [1e-3:1.3]
set key bottom left Left reverse
set samples 50
plot chords(7, 1) using 1:4 every 2 with points lt 1 title "blue, a = 0.25 / m", \
     chords(7, 1) using 1:3 every 2 with points lt 3 title "green, a = 1 / m", \
     chords(7, 1) using 1:2 every 2 with points lt 2 title "red, a = 2 / m", \
     chords(7, 0.8) using 1:3 every 2 with points lt 5 title "green, transparency t = 0.8", \
     chords(7, 0.5) using 1:3 every 2 with points lt 4 title "green, transparency t = 0.5", \
     exp(-0.25*x) with lines lt 1 notitle, exp(-x) with lines lt 3 notitle, exp(-2*x) with lines lt 2 notitle, \
     0.8**2*exp(-x) with lines lt 5 notitle, 0.5**2*exp(-x) with lines lt 4 notitle, NaN with lines lc rgb ink lw 1.6 title "t^2 exp(-ad)"
unset samples
set title "Path length from the transmittance, minus the chord"
set xlabel "level"
set ylabel "rms error / m"
set xrange [1.6:7.4]
set yrange [1e-6:1]
set format y "10^{%T}"
set xtics 1
set key top right Right noreverse
set samples 6
first_off = off(2)
plot sample [2:7] '+' using 1:(off($1)) with points lt 1 title "measured", \
     [2:7] '+' using 1:(first_off*4**(2 - $1)) with lines lt 8 title "1/4 per level: flat faces of a polyhedron"
unset multiplot
