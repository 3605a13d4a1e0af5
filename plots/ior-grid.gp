# Images over the grid of the refractive indices of vessel and liquid, cropped to the vessel, with 16 samples a pixel.
# Below each: magnification of the rod in the image, and FLIP against the image without refraction (top left).
# needs: tables/ior-images.tsv wall_s_median
# needs: tables/ior-images-metrics.tsv metric=edges.magnification measured
# needs: ior-images/images/*.png
width = 318; height = 505
load "plots/style.gp"

load "plots/image_panels.gp"
rows = table("ior-images")
metrics = table("ior-images-metrics")
vessel = system(select(rows, "", "vessel.ior")[3:*]." | sort -gu | tr '\\n' ' '")
liquid = system(select(rows, "", "liquid.ior")[3:*]." | sort -gu | tr '\\n' ' '")
at(i, k) = sprintf("vessel.ior=%s liquid.ior=%s", word(vessel, i), word(liquid, k))
magnification(i, k) = first(metrics, at(i, k)." metric=edges.magnification", "measured")
unset label 9999
small = ",6.6"
set multiplot layout words(vessel),words(liquid) margins 0.085,0.998,0.032,0.949 spacing 0.008,0.036
set label 1 "refractive index of the liquid" at screen 0.54,0.985 center
set label 2 "refractive index of the vessel" at screen 0.02,0.49 center rotate
do for [i=1:words(vessel)] {
    do for [k=1:words(liquid)] {
        cell = first(rows, at(i, k), "cell")
        file = cell >= 0 ? image("ior-images", int(cell)) : ""
        set title (i == 1 ? word(liquid, k) : "") font ",7.5" offset 0,-0.9
        set ylabel (k == 1 ? word(vessel, i) : "") rotate by 90 offset 2.2,0
        set label 3 caption(sprintf("×%.2f", magnification(i, k))).caption(sprintf("  F %.3f", first(rows, at(i, k), "flip"))) \
            at graph 0.5,-0.065 center font small
        if (readable(file)) {
            # The vessel: fractions of the width from the left and of the height from the bottom.
            set xrange [0.315*png_width(file):0.685*png_width(file)]
            set yrange [0.12*png_height(file):0.94*png_height(file)]
            plot file binary filetype=png with rgbimage notitle
        } else {
            @empty
        }
        unset label 1
        unset label 2
    }
}
unset multiplot
