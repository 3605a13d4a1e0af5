# Solids of ten thousand and of two hundred thousand polygons by each method: images, time and memory.
# needs: tables/hidden.tsv cpu_s_median
# needs: hidden/images/*.png
width = 1000; height = 625
load "plots/style.gp"

load "plots/image_panels.gp"
rows = table("hidden")
methods = "zbuffer raycast whitted"
names = "'depth buffer' 'ray casting' 'Whitted'"
levels = "3 6"
of(level, method, column) = first(rows, sprintf("ball.level=%s render.integrator=%s", word(levels, level), word(methods, method)), column)
# Memory of the hierarchies, or of the depth buffer and the triangles that it rasterised.
drawn(bytes) = bytes == bytes ? bytes : 0
memory(l, m) = of(l, m, "accel_bytes") + drawn(of(l, m, "drawn_bytes"))
about(l, m) = sprintf("%.0f ms, %.1f MiB, FLIP %.3f", of(l, m, "cpu_s_median")*1e3, memory(l, m)/1048576, of(l, m, "flip"))
set title offset 0,-0.7
said = "time of a frame on one thread, memory in addition to triangles and film, FLIP against the Whitted image"
set label 2 said at screen 0.5,0.02 center font ",9" textcolor rgb grey
set multiplot layout 2,words(methods) margins 0.005,0.995,0.085,0.955 spacing 0.01,0.11
do for [l=1:2] {
    do for [m=1:words(methods)] {
        cell = of(l, m, "cell")
        set title word(names, m).(cell == cell ? sprintf(", %.0f triangles", of(l, m, "triangles")) : "")
        set label 1 caption(about(l, m)) at graph 0.5, -0.06 center textcolor rgb ink
        file = cell == cell ? image("hidden", cell) : ""
        if (cell == cell && readable(file)) {
            plot file binary filetype=png with rgbimage notitle
        } else {
            @empty
        }
    }
}
unset multiplot
