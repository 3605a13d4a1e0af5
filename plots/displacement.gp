# Displacement field of the filled vessel, by experiments/displacement.sh: an arrow begins where a point is seen, and
# points to where it would be seen without vessel and liquid, at a tenth of the distance. The rims of vessel and liquid
# are drawn as the camera projects them. Where there is no arrow, the ray is totally reflected or ends in the sky.
# needs: displacement/points.csv x
width = 318; height = 330
scale = 0.1
load "plots/style.gp"

points = results."/displacement/points.csv"
unset label 9999
set size ratio -1
set xrange [255:545]
set yrange [540:100]
set xtics 250,100,550
set ytics 100,100,600
unset grid
set border 15 lc rgb pale
set xlabel "x / px" offset 0,0.6
set ylabel "y / px" offset 0.3,0
set key at graph 0.5,1.005 center bottom horizontal Left reverse samplen 1.5 font ",7.2"
set lmargin 7; set rmargin 0.8; set tmargin 1.6; set bmargin 2.6

# The camera of experiments/scenes/rod.yaml: at (0, 2.75, -6), towards (0, 1.5, 0), 45 degrees high; 800 by 600 pixels.
focal = 300/tan(pi/8)
long = sqrt(1.25**2 + 36)
ahead(y, z) = ((y - 2.75)*(-1.25) + (z + 6)*6)/long
above(y, z) = ((y - 2.75)*6 + (z + 6)*1.25)/long
px(x, y, z) = 400 + focal*x/ahead(y, z)
py(x, y, z) = 300 - focal*above(y, z)/ahead(y, z)
set parametric
set trange [0:2*pi]
set samples 200
side = asin(1.0/6) # where the line of sight touches the outer wall, seen from above
array X[2] = [-cos(side), cos(side)]
do for [i=1:2] {
    set arrow i from px(X[i], 0.001, -sin(side)), py(0, 0.001, -sin(side)) \
        to px(X[i], 3.001, -sin(side)), py(0, 3.001, -sin(side)) nohead lw 0.8 lc rgb grey back
}
shift(which) = select(points, "solid=".which, "x y bare_x bare_y")
set style arrow 1 head filled size 3,20,60 fixed lw 0.7 lc rgb blue
set style arrow 2 head filled size 3,20,60 fixed lw 0.9 lc rgb vermillion
set arrow 9 from 460,515 rto 200*scale,0 arrowstyle 1
set label 9 "200 px" at 465 + 200*scale,515 left font ",7.2"
plot px(cos(t), 3.001, sin(t)), py(cos(t), 3.001, sin(t)) with lines lw 0.8 lc rgb grey notitle, \
     px(cos(t), 0.001, sin(t)), py(cos(t), 0.001, sin(t)) with lines lw 0.8 lc rgb grey notitle, \
     px(0.95*cos(t), 2.001, 0.95*sin(t)), py(0.95*cos(t), 2.001, 0.95*sin(t)) \
         with lines lw 0.8 dt (4,2) lc rgb sky notitle, \
     shift("ground") using 1:2:(($3 - $1)*scale):(($4 - $2)*scale) with vectors arrowstyle 1 title "ground", \
     shift("rod") using 1:2:(($3 - $1)*scale):(($4 - $2)*scale) with vectors arrowstyle 2 title "rod"
