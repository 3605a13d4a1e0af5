# A torus with flat, Gouraud and Phong shading, of few polygons; the cost of each, and its fraction of the frame,
# compared with the polygons report.
# needs: tables/shading.tsv cpu_s_median
# needs: shading/images/*.png
width = 1000; height = 690
load "plots/style.gp"

rows = table("shading")
shadings = "flat gouraud smooth"
names = "'flat' 'Gouraud' 'Phong'"
arounds = "24 512"
methods = "zbuffer raycast whitted whitted"
shadows = "off off off opaque"
at(poly, m, light) = sprintf("soup.around=%s render.integrator=%s render.shadows=%s %s", word(arounds, poly), word(methods, m), word(shadows, m), light)
unlit(poly, m, column) = first(rows, at(poly, m, "model.diffuse=0"), column)
lit(poly, m, s, column) = first(rows, at(poly, m, sprintf("model.diffuse=0.6 model.shading=%s", word(shadings, s))), column)
# Time of a frame minus that without light and normals. Frames with shadows show the cost of those without: shadow
# rays are not shading.
plain(m) = m == 4 ? 3 : m
cost(poly, m, s) = lit(poly, plain(m), s, "cpu_s_median") - unlit(poly, plain(m), "cpu_s_median")
least(poly, m, s) = lit(poly, plain(m), s, "cpu_s_low") - unlit(poly, plain(m), "cpu_s_high")
most(poly, m, s) = lit(poly, plain(m), s, "cpu_s_high") - unlit(poly, plain(m), "cpu_s_low")
fraction(poly, m, s) = cost(poly, m, s)/lit(poly, m, s, "cpu_s_median")
half = 0.13
place(group, s) = group + 2*half*(s - 2)
# The groups of bars: the methods with few polygons, then with many.
poly_of(group, count) = group > count ? 2 : 1
method_of(group, count) = int(group > count ? group - count : group)

# Combined interval of the two medians.
below(s, group) = least(poly_of(group, 3), method_of(group, 3), s)
above(s, group) = most(poly_of(group, 3), method_of(group, 3), s)

set label 100 remarks("shading") at screen 0.5,0.012 center font ",8" textcolor rgb grey
set multiplot
unset border
unset tics
unset grid
unset key
set size ratio -1
set autoscale xfix
set autoscale yfix
do for [s=1:3] {
    set lmargin at screen 0.005 + 0.333*(s - 1)
    set rmargin at screen 0.325 + 0.333*(s - 1)
    set tmargin at screen 0.955
    set bmargin at screen 0.6
    set title word(names, s) offset 0,-0.7
    set label 1 sprintf("%.1f of %.1f ms, by ray casting", cost(1, 2, s)*1e3, lit(1, 2, s, "cpu_s_median")*1e3) \
        at graph 0.5, -0.05 center textcolor rgb ink
    file = image("shading", 4 + s)
    if (readable(file)) {
        plot file binary filetype=png with rgbimage notitle
    } else {
        @empty
    }
    unset label 100
}
unset label 1
set size noratio
set border 3 lc rgb ink lw 0.8
set tics nomirror out scale 0.6 textcolor rgb ink
set grid ytics lc rgb pale lw 0.5 dt solid
set boxwidth 1.8*half
set tmargin at screen 0.485
set bmargin at screen 0.14
set arrow 11 from 3.5, graph 0 to 3.5, graph 1 nohead lc rgb pale back
set label 11 "576 triangles" at graph 0.25, -0.21 center textcolor rgb ink
set label 12 "262144 triangles" at graph 0.75, -0.21 center textcolor rgb ink

set lmargin at screen 0.06
set rmargin at screen 0.485
set title "Cost of shading: time of a frame minus that without it"
set ylabel "CPU time / ms"
set xrange [0.5:6.5]
set yrange [0:*]
set offsets 0, 0, graph 0.15, 0
set xtics ("depth buffer" 1, "rays" 2, "Whitted" 3, "depth buffer" 4, "rays" 5, "Whitted" 6) scale 0 font ",9"
set ytics
set samples 6
set key top left maxrows 1 samplen 1
plot for [s=1:3] [1:6] '+' using (place($1, s)):(cost(poly_of($1, 3), method_of($1, 3), s)*1e3) with boxes lt s title word(names, s), \
     for [s=1:3] [1:6] '+' using (place($1, s)):(below(s, $1)*1e3):(0):((above(s, $1) - below(s, $1))*1e3) with vectors nohead lc rgb ink lw 1 notitle

set lmargin at screen 0.56
set rmargin at screen 0.99
set title "Shading as a fraction of the frame"
set ylabel "fraction of the CPU time / %"
set xrange [0.5:8.5]
set arrow 11 from 4.5, graph 0 to 4.5, graph 1 nohead lc rgb pale back
set xtics ("depth\nbuffer" 1, "rays" 2, "Whitted" 3, "with\nshadows" 4, "depth\nbuffer" 5, "rays" 6, "Whitted" 7, "with\nshadows" 8) scale 0 font ",9"
set samples 8
set key top right maxrows 1 samplen 1.5
plot for [s=1:3] [1:8] '+' using (place($1, s)):(fraction(poly_of($1, 4), method_of($1, 4), s)*100) with boxes lt s notitle, \
     3 lt 7 title "polygons report: Phong takes at most 3 %"
unset multiplot
