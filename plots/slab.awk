# The largest deviation of the measured transmittance of a slab from its closed form (plots/absorption.gp).
#   awk -f slab.awk -v R=0.02 -v absorb='200 60 10' FILE        lines: thickness in mm, then a fraction for each
#   coefficient in 1/m
BEGIN { channels = split(absorb, a, " ") }
{
    for (i = 1; i <= channels; i++) {
        e = exp(-a[i]*$1/1000)
        off = $(i + 1) - (1 - R)^2*e/(1 - R^2*e^2)
        if (off < 0) off = -off
        if (off > most) most = off
    }
}
END { print most }
