# Common settings of figures made of images: no axes, the aspect ratio of the image, labels above.
unset border
unset tics
unset grid
unset key
set size ratio -1
set autoscale xfix
set autoscale yfix
set title offset 0,-0.9
cell_value(rows, cell, column) = first(rows, sprintf("cell=%d", cell), column)
# A caption, or nothing where one of its numbers is unknown.
caption(text) = strstrt(text, "nan") > 0 ? "" : text
# Size of a PNG, from its header.
png_side(path, at) = int(system(sprintf("od -An -tu1 -j %d -N 4 '%s' | awk '{ print (($1*256 + $2)*256 + $3)*256 + $4 }'", at, path)))
png_width(path) = png_side(path, 16)
png_height(path) = png_side(path, 20)
