/* Tests of a single interface: Fresnel's equations, Snell's law, reflection and refraction of directions. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "optics/interface.h"
#include "quad.h"
#include "random_stream.h"

#define COUNT(a) (sizeof(a) / sizeof((a)[0]))
#define assert_near(a, b, tolerance) assert_true(quad_abs((quad)(a) - (quad)(b)) <= (quad)(tolerance))

static const struct {
    double from, to;
} pairs[] = {{1.0, 1.5},  {1.5, 1.0},  {1.0, 1.33}, {1.33, 1.0},  {1.5, 1.33},  {1.33, 1.5}, {1.0, 2.42},
             {2.42, 1.0}, {1.3, 1.31}, {1.31, 1.3}, {1.0, 100.0}, {100.0, 1.0}, {1.0, 1.0}};

/* Fresnel's sine and tangent laws, Hecht, Optics, 5th ed., eqs. 4.42 and 4.43, with Snell's law for the angle of
 * refraction. */
static void reflectances_by_angle(quad degrees, double n_from, double n_to, quad *R_s, quad *R_p)
{
    quad sin_i, cos_i;
    quad_sincos_deg(degrees, &sin_i, &cos_i);
    quad sin_t = sin_i * n_from / n_to, cos_t = quad_sqrt(1 - sin_t * sin_t);
    quad sin_less = sin_i * cos_t - cos_i * sin_t, sin_sum = sin_i * cos_t + cos_i * sin_t;
    quad cos_less = cos_i * cos_t + sin_i * sin_t, cos_sum = cos_i * cos_t - sin_i * sin_t;
    *R_s = sin_less / sin_sum * (sin_less / sin_sum);
    quad r_p = sin_less * cos_sum / (cos_less * sin_sum);
    *R_p = r_p * r_p;
}

static double cosine_deg(double degrees)
{
    quad s, c;
    quad_sincos_deg(degrees, &s, &c);
    return (double)c;
}

static void reflectances_agree_with_the_sine_and_tangent_laws(void **state)
{
    (void)state;
    for (size_t k = 0; k < COUNT(pairs); k++) {
        const double from = pairs[k].from, to = pairs[k].to;
        const double critical = to < from ? asin(to / from) * 57.295779513082321 : 90.0;
        for (double degrees = 0.5; degrees < critical - 0.01; degrees += 0.5) {
            quad R_s, R_p;
            reflectances_by_angle(degrees, from, to, &R_s, &R_p);
            fresnel f = fresnel_dielectric(cosine_deg(degrees), from, to);
            /* near the critical angle and at grazing incidence a rounding of the cosine matters more */
            const double tolerance = 4e-15 / (f.cos_t < 0.1 ? f.cos_t : 0.1) / cosine_deg(degrees);
            assert_near(f.R_s, R_s, tolerance);
            assert_near(f.R_p, R_p, tolerance);
            assert_true(f.R == 0.5 * (f.R_s + f.R_p));
            assert_true(f.total == 0);
        }
    }
}

/* Air to glass of index 1.5, the standard example (Hecht, figs. 4.47 to 4.49). At 45 degrees sin_t = sqrt(2)/3, so
 * r_s = -(9 - 2 sqrt(14)) / 5. */
static void reflectances_of_glass_equal_those_of_hecht(void **state)
{
    (void)state;
    fresnel f = fresnel_dielectric(cosine_deg(45.0), 1.0, 1.5);
    const double r_s = (9.0 - 2.0 * sqrt(14.0)) / 5.0;
    assert_near(f.R_s, 0.09201336305, 1e-11);
    assert_near(f.R_s, r_s * r_s, 1e-15);
    assert_near(f.R_p, 0.00846645898, 1e-11);
    assert_near(f.R_p, f.R_s * f.R_s, 1e-16); /* at 45 degrees, for any index */
    f = fresnel_dielectric(cosine_deg(80.0), 1.0, 1.5);
    assert_near(f.R, 0.3877, 5e-5);
    f = fresnel_dielectric(cosine_deg(60.0), 1.0, sqrt(3.0)); /* Brewster's angle: R_s = ((n^2-1)/(n^2+1))^2 */
    assert_near(f.R_s, 0.25, 1e-15);
    assert_true(f.R_p < 1e-30);
}

static void reflectance_at_normal_incidence_equals_the_closed_form(void **state)
{
    (void)state;
    for (size_t k = 0; k < COUNT(pairs); k++) {
        quad r = ((quad)pairs[k].from - pairs[k].to) / ((quad)pairs[k].from + pairs[k].to);
        fresnel f = fresnel_dielectric(1.0, pairs[k].from, pairs[k].to);
        assert_near(f.R_s, r * r, 1e-16);
        assert_near(f.R_p, r * r, 1e-16);
        assert_true(f.cos_t == 1.0);
    }
    assert_near(fresnel_dielectric(1.0, 1.0, 1.5).R, 0.04, 1e-17);
}

/* tan theta_B = n_to / n_from: no light polarised in the plane of incidence is reflected. */
static void p_light_is_not_reflected_at_brewsters_angle(void **state)
{
    (void)state;
    for (size_t k = 0; k < COUNT(pairs); k++) {
        quad ratio = (quad)pairs[k].to / pairs[k].from;
        double cos_i = (double)(1 / quad_sqrt(1 + ratio * ratio));
        fresnel f = fresnel_dielectric(cos_i, pairs[k].from, pairs[k].to);
        assert_true(f.R_p >= 0.0);
        assert_true(f.R_p <
                    (pairs[k].from > 10.0 ? 1e-16 : 2e-31)); /* 100 to 1: eta^2 magnifies the cosine's rounding */
        quad less = (quad)1 - ratio * ratio, sum = 1 + ratio * ratio;
        assert_near(f.R_s, less / sum * (less / sum), pairs[k].from > 10.0 ? 1e-9 : 1e-15);
    }
}

static void everything_is_reflected_at_grazing_incidence(void **state)
{
    (void)state;
    for (size_t k = 0; k < COUNT(pairs); k++) {
        fresnel f = fresnel_dielectric(1e-300, pairs[k].from, pairs[k].to);
        assert_true(f.R == 1.0 || pairs[k].from == pairs[k].to);
    }
    assert_true(fresnel_dielectric(1e-12, 1.0, 1.5).R > 1.0 - 1e-11);
}

static void shares_stay_in_range_and_equal_media_reflect_nothing(void **state)
{
    (void)state;
    uint64_t seed = 1;
    for (int i = 0; i < 100000; i++) {
        double cos_i = random_real(&seed, 0.0, 1.0), from = exp(random_real(&seed, -2.3, 4.6)),
               to = exp(random_real(&seed, -2.3, 4.6));
        fresnel f = fresnel_dielectric(cos_i, from, to);
        assert_true(f.R_s >= 0.0 && f.R_s <= 1.0 && f.R_p >= 0.0 && f.R_p <= 1.0 && f.R >= 0.0 && f.R <= 1.0);
        assert_true(f.cos_t >= 0.0 && f.cos_t <= 1.0);
        assert_true(f.R + (1.0 - f.R) == 1.0);
        assert_true(!f.total || (f.R == 1.0 && f.cos_t == 0.0));
        f = fresnel_dielectric(cos_i, from, from);
        assert_true(f.R < 1e-28 / (cos_i * cos_i * cos_i * cos_i)); /* cos_t differs from cos_i by a rounding */
    }
}

/* sin theta_c = n_to / n_from. The result is exact except for the roundings of 1 - eta^2 (1 - cos^2): within an ulp of
 * the cosine either result is possible, and the transmitted share there is below the square root of a rounding. */
static void total_reflection_begins_at_the_critical_angle(void **state)
{
    (void)state;
    for (size_t k = 0; k < COUNT(pairs); k++) {
        if (pairs[k].from <= pairs[k].to)
            continue;
        quad sine = (quad)pairs[k].to / pairs[k].from;
        double critical = (double)quad_sqrt(1 - sine * sine);
        double below = critical, above = critical;
        /* roundings of eta^2 (1 - cos^2), about 1 there, and of eta^2 itself */
        const double eta = pairs[k].from / pairs[k].to, rounding = (2.0 + 2.0 * eta * eta) * 0x1p-53;
        for (int ulps = 0; ulps <= 64; ulps++) {
            fresnel low = fresnel_dielectric(below, pairs[k].from, pairs[k].to);
            fresnel high = fresnel_dielectric(above, pairs[k].from, pairs[k].to);
            /* one ulp of cos_i moves cos_t^2 by 2 eta^2 cos_i ulps */
            const double step = 2.0 * eta * eta * critical * (nextafter(critical, 2.0) - critical);
            if ((ulps - 0.5) * step > rounding) {
                assert_true(low.total == -1 && low.R == 1.0 && low.R_s == 1.0 && low.R_p == 1.0 && low.cos_t == 0.0);
                assert_true(high.total == 0 && high.R < 1.0);
                assert_near(high.cos_t * high.cos_t, ulps * step, rounding + 0.5 * step);
            }
            /* R = 1 - O(cos_t n_from / n_to cos_i), and cos_t is at most the square root of the roundings */
            const double dark = 8.0 * sqrt((ulps + 1) * step + rounding) * eta / critical;
            assert_true(low.R >= 1.0 - dark && low.R <= 1.0);
            assert_true(high.R >= 1.0 - dark && high.R <= 1.0);
            below = nextafter(below, 0.0);
            above = nextafter(above, 2.0);
        }
    }
}

/* Stokes: the reverse path through the interface reflects the same share. */
static void reflectance_is_equal_from_both_sides(void **state)
{
    (void)state;
    uint64_t seed = 2;
    for (int i = 0; i < 100000; i++) {
        double cos_i = random_real(&seed, 0.05, 1.0), from = random_real(&seed, 1.0, 3.0),
               to = random_real(&seed, 1.0, 3.0);
        fresnel there = fresnel_dielectric(cos_i, from, to);
        if (there.total || there.cos_t < 0.05)
            continue;
        fresnel back = fresnel_dielectric(there.cos_t, to, from);
        assert_near(back.cos_t, cos_i, 1e-13);
        assert_near(back.R_s, there.R_s, 1e-12);
        assert_near(back.R_p, there.R_p, 1e-12);
    }
}

typedef struct incidence {
    vec3 d, n;
    double cos_i;
} incidence;

static incidence random_incidence(uint64_t *seed)
{
    incidence w = {random_direction(seed), random_direction(seed), 0.0};
    w.cos_i = -vec3_dot(w.d, w.n);
    if (w.cos_i < 0.0) {
        w.n = vec3_scale(w.n, -1.0);
        w.cos_i = -w.cos_i;
    }
    return w;
}

static void directions_obey_snells_law(void **state)
{
    (void)state;
    uint64_t seed = 3;
    for (int i = 0; i < 100000; i++) {
        incidence w = random_incidence(&seed);
        double from = random_real(&seed, 1.0, 2.5), to = random_real(&seed, 1.0, 2.5);
        fresnel f = fresnel_dielectric(w.cos_i, from, to);
        quad3 d = quad3_from(w.d), n = quad3_from(w.n), r = quad3_from(direction_reflect(w.d, w.n, w.cos_i));
        assert_near(quad3_length(r), 1, 2.5e-16);
        quad3 across_i = quad3_cross(n, d), across_r = quad3_cross(n, r);
        assert_near(quad3_length(quad3_sub(across_i, across_r)), 0, 1e-15); /* coplanar, and at the same angle */
        assert_near(quad3_dot(n, r), w.cos_i, 1e-15);
        if (f.total)
            continue;
        quad3 t = quad3_from(direction_refract(w.d, w.n, w.cos_i, f.eta, f.cos_t));
        quad3 across_t = quad3_cross(n, t);
        assert_near(quad3_length(t), 1, 2.5e-16);
        /* n sin, as vectors. */
        assert_near(quad3_length(quad3_sub(quad3_scale(across_i, from), quad3_scale(across_t, to))), 0, 3e-15);
        assert_near(quad3_dot(n, t), -f.cos_t, 2e-15 / (f.cos_t + 1e-8));
    }
}

/* The reverse path through the interface returns along the ray. */
static void refraction_is_reversible(void **state)
{
    (void)state;
    uint64_t seed = 4;
    for (int i = 0; i < 100000; i++) {
        incidence w = random_incidence(&seed);
        double from = random_real(&seed, 1.0, 2.5), to = random_real(&seed, 1.0, 2.5);
        fresnel f = fresnel_dielectric(w.cos_i, from, to);
        if (f.total || f.cos_t < 0.05 || w.cos_i < 0.05)
            continue;
        vec3 t = direction_refract(w.d, w.n, w.cos_i, f.eta, f.cos_t), turned = vec3_scale(t, -1.0),
             other = vec3_scale(w.n, -1.0);
        double cos_back = -vec3_dot(turned, other);
        fresnel g = fresnel_dielectric(cos_back, to, from);
        vec3 back = direction_refract(turned, other, cos_back, g.eta, g.cos_t);
        assert_near(quad3_length(quad3_add(quad3_from(back), quad3_from(w.d))), 0, 1e-13);
    }
}

/* A stack of parallel interfaces: light leaving the last one obeys Snell between the first medium and the last. */
static void n_sin_theta_is_conserved_in_parallel_layers(void **state)
{
    (void)state;
    uint64_t seed = 5;
    for (int i = 0; i < 2000; i++) {
        incidence w = random_incidence(&seed);
        vec3 d = w.d;
        quad invariant = quad3_length(quad3_cross(quad3_from(w.n), quad3_from(d)));
        double from = 1.0;
        for (int layer = 0; layer < 64; layer++) {
            double to = layer == 63 ? 1.0 : random_real(&seed, 1.05, 2.5);
            double cos_i = -vec3_dot(d, w.n);
            fresnel f = fresnel_dielectric(cos_i, from, to);
            if (f.total)
                break; /* only in the last steps of a grazing direction */
            d = direction_refract(d, w.n, cos_i, f.eta, f.cos_t);
            assert_near(to * quad3_length(quad3_cross(quad3_from(w.n), quad3_from(d))), invariant, 3e-14);
            from = to;
        }
    }
}

/* 64 mirrors: a direction stays a unit vector, and agrees with quadruple precision. */
static void repeated_reflections_keep_unit_length(void **state)
{
    (void)state;
    uint64_t seed = 6;
    for (int i = 0; i < 2000; i++) {
        vec3 d = random_direction(&seed);
        quad3 exact = quad3_from(d);
        for (int bounce = 0; bounce < 64; bounce++) {
            vec3 n = random_direction(&seed);
            quad3 m = quad3_scale(quad3_from(n), 1 / quad3_length(quad3_from(n)));
            exact = quad3_sub(exact, quad3_scale(m, 2 * quad3_dot(exact, m)));
            d = direction_reflect(d, n, -vec3_dot(d, n));
        }
        assert_near(quad3_length(quad3_from(d)), 1, 2.5e-16);
        assert_near(quad3_length(quad3_sub(quad3_from(d), exact)), 0, 64 * 4e-16);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(reflectances_agree_with_the_sine_and_tangent_laws),
        cmocka_unit_test(reflectances_of_glass_equal_those_of_hecht),
        cmocka_unit_test(reflectance_at_normal_incidence_equals_the_closed_form),
        cmocka_unit_test(p_light_is_not_reflected_at_brewsters_angle),
        cmocka_unit_test(everything_is_reflected_at_grazing_incidence),
        cmocka_unit_test(shares_stay_in_range_and_equal_media_reflect_nothing),
        cmocka_unit_test(total_reflection_begins_at_the_critical_angle),
        cmocka_unit_test(reflectance_is_equal_from_both_sides),
        cmocka_unit_test(directions_obey_snells_law),
        cmocka_unit_test(refraction_is_reversible),
        cmocka_unit_test(n_sin_theta_is_conserved_in_parallel_layers),
        cmocka_unit_test(repeated_reflections_keep_unit_length),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
