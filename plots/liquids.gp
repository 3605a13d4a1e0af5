# One glass with five liquids, by their index, and the caustic behind each.
# needs: tables/liquids.tsv water.medium
# needs: liquids/images/*.png
width = 1000; height = 286
load "plots/style.gp"

load "plots/image_panels.gp"
rows = table("liquids")
liquids = "water ethanol glycerol toluene bk7-liquid"
set multiplot layout 1,words(liquids) margins 0.003,0.997,0.055,0.915 spacing 0.006,0
do for [i=1:words(liquids)] {
    cell = first(rows, "water.medium=".word(liquids, i), "cell")
    file = cell >= 0 ? image("liquids", int(cell)) : ""
    set title word(liquids, i)
    if (readable(file)) {
        plot file binary filetype=png with rgbimage notitle
    } else {
        @empty
    }
}
unset multiplot
