# Laws fitted to the times of the triangles study, for each hierarchy and for the published series (the last); the figure draws them,
# the paper prints them.
#   T = a + b ln(n / 10000)   a is the time at 10000 triangles, b the increase by each factor e
#   T = c (n / 10000)^p       fitted to the logarithms
# Over the report's 10000 to 50000 (log_a, log_b, power_p), and over all numbers from 10000 on (wide_a, wide_b, wide_c, wide_p), each time with
# weights that make deviations relative; *_off is the root of their mean square. log_fits and wide_fits are 1 if there were enough rows.
hierarchies = "none sphere octant bvh"
measured_times(i) = i < 5 ? select(table("triangles"), "model.visible=on render.accel=".word(hierarchies, i), \
    "soup.count cpu_s_median cpu_s_min cpu_s_max") : select("experiments/published/triangles.csv", "", "triangles time_s time_s time_s")
wide(i) = measured_times(i)." | awk '$1 >= 10000'"
few(i) = measured_times(i)." | awk '$1 >= 10000 && $1 <= 50000'"
lines(command) = int(system(command[3:*]." | wc -l"))
log_law(n, a, b) = a + b*log(n/1e4)
power_law(n, c, p) = c*(n/1e4)**p

array log_fits[5]; array log_a[5]; array log_b[5]; array log_off[5]; array power_c[5]; array power_p[5]; array power_off[5]
array wide_fits[5]; array wide_a[5]; array wide_b[5]; array wide_off[5]; array wide_c[5]; array wide_p[5]; array wide_power_off[5]
do for [i=1:5] {
    log_a[i] = NaN; log_b[i] = NaN; log_off[i] = NaN; power_c[i] = NaN; power_p[i] = NaN; power_off[i] = NaN
    wide_a[i] = NaN; wide_b[i] = NaN; wide_off[i] = NaN; wide_c[i] = NaN; wide_p[i] = NaN; wide_power_off[i] = NaN
    log_fits[i] = lines(few(i)) >= 4
    wide_fits[i] = i < 5 && lines(wide(i)) >= 6
    do for [range=1:2] {
        if (range == 1 ? log_fits[i] : wide_fits[i]) {
            series = range == 1 ? few(i) : wide(i)
            a = 1; b = 0.1
            fit log_law(x, a, b) series using 1:2:2 yerrors via a, b
            stats series using ((log_law($1, a, b)/$2 - 1)**2) nooutput
            off = sqrt(STATS_mean)
            k = log(abs(a)); p = 0.1
            fit k + p*log(x/1e4) series using 1:(log($2)) via k, p
            stats series using ((power_law($1, exp(k), p)/$2 - 1)**2) nooutput
            power = sqrt(STATS_mean)
            if (range == 1) {
                log_a[i] = a; log_b[i] = b; log_off[i] = off; power_c[i] = exp(k); power_p[i] = p; power_off[i] = power
            } else {
                wide_a[i] = a; wide_b[i] = b; wide_off[i] = off; wide_c[i] = exp(k); wide_p[i] = p; wide_power_off[i] = power
            }
        }
    }
}
