# The rod in the vessel: the image of the portrait study.
# needs: portrait/images/0000.png
width = 800; height = 600
load "plots/style.gp"

load "plots/picture.gp"
set margins 0,0,0,0
plot image("portrait", 0) binary filetype=png with rgbimage
