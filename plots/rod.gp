# The rod in the vessel: the picture of depth 8 as it is.
# needs: depth/images/0008.png
width = 800; height = 600
load "plots/style.gp"

load "plots/picture.gp"
set margins 0,0,0,0
plot image("depth", 8) binary filetype=png with rgbimage
