# Straight lines fitted to the times of the coverage study, T = a + b pixels: of the octant tree, of the BVH, and of the published
# series. line_off is the root of the mean squared relative deviation; figures draw them, the paper prints them.
areas(i) = i < 3 ? select(table("coverage"), "render.accel=".word("octant bvh", i), "first_hits.model cpu_s_median cpu_s_min cpu_s_max") : \
    select("experiments/published/coverage.csv", "", "pixels time_s")
line(pixels, a, b) = a + b*pixels/1e5
array line_fits[3]; array line_a[3]; array line_b[3]; array line_off[3]
do for [i=1:3] {
    line_a[i] = NaN; line_b[i] = NaN; line_off[i] = NaN
    line_fits[i] = int(system(areas(i)[3:*]." | wc -l")) >= 3
    if (line_fits[i]) {
        a = 0.1; b = 0.1
        fit line(x, a, b) areas(i) using 1:2 via a, b
        line_a[i] = a; line_b[i] = b
        stats areas(i) using ((line($1, a, b)/$2 - 1)**2) nooutput
        line_off[i] = sqrt(STATS_mean)
    }
}
