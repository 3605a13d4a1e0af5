# Images over the grid of the refractive indices of vessel and liquid, cropped to the vessel.
# needs: tables/ior-grid.tsv ior-grid/images/*.png
width = 560; height = 805
load "plots/style.gp"

load "plots/image_panels.gp"
rows = table("ior-grid")
vessel = system(select(rows, "", "vessel.ior")[3:*]." | sort -gu | tr '\\n' ' '")
liquid = system(select(rows, "", "liquid.ior")[3:*]." | sort -gu | tr '\\n' ' '")
set multiplot layout words(vessel),words(liquid) margins 0.115,0.995,0.005,0.953 spacing 0.006,0.004
# Crop of each image, the vessel: fractions of the width from the left and of the height from the bottom.
set label 1 "refractive index of the liquid" at screen 0.54,0.983 center font ",10"
set label 2 "refractive index of the vessel" at screen 0.014,0.48 center rotate font ",10"
do for [i=1:words(vessel)] {
    do for [k=1:words(liquid)] {
        cell = first(rows, sprintf("vessel.ior=%s liquid.ior=%s", word(vessel, i), word(liquid, k)), "cell")
        file = cell >= 0 ? image("ior-grid", int(cell)) : ""
        set title (i == 1 ? word(liquid, k) : "")
        set ylabel (k == 1 ? word(vessel, i) : "") rotate by 0
        if (readable(file)) {
            set xrange [0.28*png_width(file):0.72*png_width(file)]
            set yrange [0.10*png_height(file):0.98*png_height(file)]
            plot file binary filetype=png with rgbimage notitle
        } else {
            @empty
        }
        unset label 1
        unset label 2
    }
}
unset multiplot
