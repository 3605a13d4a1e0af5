# Images of the four pairs of refractive indices, each with its optical metrics.
# Old rows without metrics give only the images.
# needs: tables/ior.tsv liquid.ior
# needs: tables/ior[.-]*tsv
# needs: ior/images/*.png
width = 1000; height = 940
load "plots/style.gp"

load "plots/image_panels.gp"
rows = table("ior")
metric(cell, name) = first(table("ior-metrics"), sprintf("cell=%d metric=%s", cell, name), "measured")
# Zero has no sign; the minus sign is as long as the plus sign.
signed_number(value) = abs(value) < 5e-3 ? "0" : (value < 0 ? "−" : "+").sprintf("%.2f", abs(value))
plain(value) = value < 0.05 ? "0" : sprintf("%.1f", value)
edges(cell) = sprintf("Displacement of the rod's edges %s px and %s px, magnification %.3f\nKink of a leaning rod at the liquid's surface %s°", \
    signed_number(metric(cell, "edges.left_shift")), signed_number(metric(cell, "edges.right_shift")), \
    metric(cell, "edges.magnification"), plain(abs(metric(cell, "water_line.break"))))
# A scene without a lens has no focal length: NaN, which is not equal to itself.
focal(cell) = metric(cell, "lens.focal_length")
lens(cell) = focal(cell) == focal(cell) ? \
    sprintf("As a lens: focal length %s scene units", signed_number(focal(cell))) : "No lens: rays are not deviated"
# Fresnel reflectance at normal incidence, in percent.
normal(n_1, n_2) = 100*((n_1 - n_2)/(n_1 + n_2))**2
reflected(vessel, liquid) = sprintf("Reflected at normal incidence: vessel %.1f %%, liquid %.1f %%, wall to liquid %.1f %%", \
    normal(1, vessel), normal(1, liquid), normal(vessel, liquid))

set multiplot
do for [i=0:3] {
    file = image("ior", i)
    vessel = cell_value(rows, i, "vessel.ior"); liquid = cell_value(rows, i, "liquid.ior")
    left = i % 2 ? 0.505 : 0.005
    top = i < 2 ? 0.972 : 0.472
    set lmargin at screen left
    set rmargin at screen left + 0.49
    set tmargin at screen top
    set bmargin at screen top - 0.391
    set title caption(sprintf("pair %d: vessel %.2f, liquid %.2f", i + 1, vessel, liquid))
    numbers = readable(table("ior-metrics")) && liquid == liquid ? edges(i)."\n".lens(i)."\n".reflected(vessel, liquid) : ""
    set label 1 numbers at screen left + 0.002, top - 0.409 left font ",9" textcolor rgb ink
    if (readable(file)) {
        plot file binary filetype=png with rgbimage notitle
    } else {
        @empty
    }
}
unset multiplot
