# Laws fitted to the studies of many triangles; the figures draw them, the paper prints them.
#   log_a, log_b:    T = a + b ln(n / 10000), from 10000 triangles on: a is the time there, b what each factor e adds
#   power_c, power_p: T = c (n / 10000)^p over the same, fitted to the logarithms
# with the root of the mean squared relative deviation of each, log_off and power_off. `log_fits` says where there was enough. The last
# one is the published series. Lines of coverage: T = line_a + line_b pixels, line_off likewise.
hierarchies = "none sphere octant bvh"
measured_times(i) = i < 5 ? select(table("triangles"), "model.visible=on render.accel=".word(hierarchies, i), \
    "soup.count cpu_s_median cpu_s_min cpu_s_max") : select("experiments/published/triangles.csv", "", "triangles time_s time_s time_s")
long(i) = measured_times(i)." | awk '$1 >= 10000'"
lines(command) = int(system(command[3:*]." | wc -l"))
log_law(n, a, b) = a + b*log(n/1e4)
power_law(n, c, p) = c*(n/1e4)**p

array log_fits[5]; array log_a[5]; array log_b[5]; array log_off[5]; array power_c[5]; array power_p[5]; array power_off[5]
do for [i=1:5] {
    log_fits[i] = lines(long(i)) >= 4
    if (log_fits[i]) {
        a = 1; b = 0.1
        fit log_law(x, a, b) long(i) using 1:2 via a, b
        log_a[i] = a; log_b[i] = b
        k = log(a); p = 0.1
        fit k + p*log(x/1e4) long(i) using 1:(log($2)) via k, p
        power_c[i] = exp(k); power_p[i] = p
        stats long(i) using ((log_law($1, a, b)/$2 - 1)**2) nooutput
        log_off[i] = sqrt(STATS_mean)
        stats long(i) using ((power_law($1, exp(k), p)/$2 - 1)**2) nooutput
        power_off[i] = sqrt(STATS_mean)
    }
}
