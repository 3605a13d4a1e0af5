# Moments of the recorded grab.
# needs: tables/slime-grab.tsv toy.time_s
# needs: slime-grab/images/*.png
width = 1000; height = 425
load "plots/style.gp"

load "plots/image_panels.gp"
rows = table("slime-grab")
said = "'at rest' 'drawn out' 'drawn out' 'held' 'held' 'released' 'back' 'at rest again'"
set title offset 0,-0.7
set multiplot layout 2,4 margins 0.004,0.996,0.005,0.94 spacing 0.006,0.075
do for [i=0:7] {
    file = image("slime-grab", i)
    set title sprintf("%.1f s, %s", first(rows, sprintf("cell=%d", i), "toy.time_s"), word(said, i + 1))
    if (readable(file)) {
        plot file binary filetype=png with rgbimage notitle
    } else {
        @empty
    }
}
unset multiplot
