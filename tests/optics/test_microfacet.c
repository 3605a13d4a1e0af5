/* Tests of the facets of rough surfaces against the formulas of Walter et al. (walter.h) and Heitz, by quadrature. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "optics/microfacet.h"
#include "random_stream.h"
#include "walter.h"
#include "whole.h"

#define COUNT(a) (sizeof(a) / sizeof((a)[0]))
#define assert_near(a, b, tolerance) assert_true(fabs((a) - (b)) <= (tolerance))

static const double alphas[] = {0.02, 0.1, 0.3, 0.6, 1.0};
static const double angles[] = {0.0, 0.4, 0.9, 1.3, 1.5};
static const two_media media[] = {{1.0, 1.5}, {1.5, 1.0}, {1.33, 1.5}, {1.0, 2.4}};

typedef struct facets {
    double alpha;
    vec3 i;
    int moment;
} facets;

static double projected(vec3 m, const void *context)
{
    const facets *f = context;
    return ggx_distribution(f->alpha, m) * m.z;
}

/* Walter et al., (4): the facets' projected area is that of the surface. */
static void facets_cover_the_surface_once(void **state)
{
    (void)state;
    for (size_t a = 0; a < COUNT(alphas); a++) {
        const facets f = {alphas[a], {0.0, 0.0, 1.0}, 0};
        assert_near(over_normals(projected, &f, 2000, 4), 1.0, 1e-6);
        for (size_t k = 0; k < COUNT(angles); k++) {
            const vec3 m = at_angles(angles[k], 0.7);
            assert_near(ggx_distribution(alphas[a], m) / walter_D(alphas[a], m), 1.0, 1e-9);
            assert_near(ggx_masking(alphas[a], m), walter_G1(alphas[a], m, m), 1e-12);
        }
    }
}

static double visible(vec3 m, const void *context)
{
    const facets *f = context;
    return ggx_masking(f->alpha, f->i) * ggx_distribution(f->alpha, m) * fmax(vec3_dot(f->i, m), 0.0);
}

/* Heitz, "Understanding the masking-shadowing function in microfacet-based BRDFs", JCGT 3(2), 2014, (14): the visible
 * facets' area across any direction is the surface's. */
static void visible_facets_have_the_area_of_the_surface(void **state)
{
    (void)state;
    for (size_t a = 0; a < COUNT(alphas); a++)
        for (size_t k = 0; k < COUNT(angles); k++) {
            const facets f = {alphas[a], at_angles(angles[k], 0.3), 0};
            assert_near(over_normals(visible, &f, 800, 400), cos(angles[k]), 3e-6);
        }
}

static double moment_of(int number, vec3 m)
{
    const double all[] = {1.0, m.x, m.y, m.z, m.x * m.x, m.x * m.y, m.y * m.y, m.x * m.z, m.z * m.z, m.z * m.z * m.z};
    return all[number];
}

static double visible_moment(vec3 m, const void *context)
{
    const facets *f = context;
    return moment_of(f->moment, m) * ggx_visible_distribution(f->alpha, f->i, m);
}

/* Ten moments of 512 x 512 normals from the midpoints of a grid of random numbers. */
static void drawn_normals_have_their_density(void **state)
{
    (void)state;
    enum { GRID = 512, MOMENTS = 10 };
    for (size_t a = 0; a < COUNT(alphas); a++)
        for (size_t k = is_whole() ? 0 : a % 2; k < COUNT(angles); k += is_whole() ? 1 : 2) {
            facets f = {alphas[a], at_angles(angles[k], 2.1), 0};
            double sum[MOMENTS] = {0.0};
            for (int c = 0; c < GRID * GRID; c++) {
                const vec3 m = ggx_sample_normal(f.alpha, f.i, (c / GRID + 0.5) / GRID, (c % GRID + 0.5) / GRID);
                assert_true(m.z > 0.0 && vec3_dot(m, f.i) > -1e-12);
                for (int j = 0; j < MOMENTS; j++)
                    sum[j] += moment_of(j, m) / GRID / GRID;
            }
            for (f.moment = 0; f.moment < MOMENTS; f.moment++)
                assert_near(sum[f.moment], over_normals(visible_moment, &f, 800, 400), 2e-4);
        }
}

static double pass(double alpha, vec3 i, vec3 o, two_media n)
{
    return o.z > 0.0 ? reflecting_facet(alpha, i, o).density * ggx_masking(alpha, o)
                     : refracting_facet(alpha, i, o, n.n_i, n.n_o).density * ggx_masking(alpha, o);
}

/* A facet's share of light, times density and G_1, is f cos: Walter et al., (20) and (21). */
static void facets_scatter_by_walters_equations(void **state)
{
    (void)state;
    uint64_t seed = 7;
    int refracted = 0;
    for (int n = 0; n < 20000; n++) {
        const double alpha = alphas[n % (int)COUNT(alphas)];
        const two_media between = media[n % (int)COUNT(media)];
        vec3 i = random_direction(&seed), o = random_direction(&seed);
        i.z = fabs(i.z);
        if (n % 2 == 0) /* near the specular direction, where most light is */
            o = vec3_normalize(vec3_add(direction_refract(vec3_scale(i, -1.0), vec3_make(0.0, 0.0, 1.0), i.z,
                                                          between.n_i / between.n_o,
                                                          fresnel_dielectric(i.z, between.n_i, between.n_o).cos_t),
                                        vec3_scale(o, 0.2)));
        if (i.z < 0.01 || fabs(o.z) < 0.01)
            continue;
        double got = pass(alpha, i, o, between), expected;
        if (o.z > 0.0) {
            expected = walter_reflection(alpha, perfect_mirror, NULL, i, o) * o.z;
        } else {
            const facet f = refracting_facet(alpha, i, o, between.n_i, between.n_o);
            got *= 1.0 - dielectric(vec3_dot(i, f.m), &between);
            expected = walter_refraction(alpha, between, i, o) * -o.z;
            refracted += got > 0.0;
        }
        assert_near(got, expected, 1e-7 * expected + 1e-12);
    }
    assert_true(refracted > 2000);
}

/* The same facet from either end: f(i, o) = f(o, i), and f(i, o) / n_o^2 = f(o, i) / n_i^2 of refraction, with the
 * factor that f of L / n^2 lacks (Veach, Robust Monte Carlo Methods for Light Transport Simulation, 1997, (5.14)). */
static void light_passes_alike_both_ways(void **state)
{
    (void)state;
    uint64_t seed = 11;
    int passed = 0;
    for (int n = 0; n < 20000; n++) {
        const double alpha = alphas[n % (int)COUNT(alphas)];
        const two_media there = media[n % (int)COUNT(media)], back = {there.n_o, there.n_i};
        vec3 i = random_direction(&seed), o = random_direction(&seed);
        i.z = fabs(i.z);
        if (i.z < 0.01 || fabs(o.z) < 0.01)
            continue;
        const bool reflects = o.z > 0.0;
        const double turn = reflects ? 1.0 : -1.0,
                     ratio = reflects ? 1.0 : there.n_i * there.n_i / there.n_o / there.n_o;
        const double ahead = pass(alpha, i, o, there) / fabs(o.z) * ratio,
                     reversed = pass(alpha, vec3_scale(o, turn), vec3_scale(i, turn), reflects ? there : back) / i.z;
        assert_near(ahead, reversed, 1e-9 * reversed + 1e-14);
        passed += ahead > 0.0;
    }
    assert_true(passed > 5000);
}

typedef struct albedo {
    double reflected, refracted;
} albedo;

/* By drawn facets, as a tracer does. */
static albedo drawn_albedo(double alpha, vec3 i, two_media n)
{
    enum { GRID = 400 };
    albedo sum = {0.0, 0.0};
    for (int c = 0; c < GRID * GRID; c++) {
        const vec3 m = ggx_sample_normal(alpha, i, (c / GRID + 0.5) / GRID, (c % GRID + 0.5) / GRID),
                   d = vec3_scale(i, -1.0);
        const double cos_i = vec3_dot(i, m);
        const fresnel f = fresnel_dielectric(cos_i, n.n_i, n.n_o);
        const vec3 back = direction_reflect(d, m, cos_i), ahead = direction_refract(d, m, cos_i, f.eta, f.cos_t);
        if (back.z > 0.0)
            sum.reflected += f.R * ggx_masking(alpha, back) / GRID / GRID;
        if (!f.total && ahead.z < 0.0)
            sum.refracted += (1.0 - f.R) * ggx_masking(alpha, ahead) / GRID / GRID;
    }
    return sum;
}

typedef struct scattering {
    double alpha;
    vec3 i;
    two_media n;
} scattering;

/* f cos of the directions that facets make, per solid angle of their normals. */
static double scattered_back(vec3 m, const void *context)
{
    const scattering *s = context;
    const double i_m = vec3_dot(s->i, m);
    const vec3 o = vec3_sub(vec3_scale(m, 2.0 * i_m), s->i);
    return i_m > 0.0 && o.z > 0.0 ? walter_reflection(s->alpha, dielectric, &s->n, s->i, o) * o.z * 4.0 * i_m : 0.0;
}

static double scattered_on(vec3 m, const void *context)
{
    const scattering *s = context;
    const double i_m = vec3_dot(s->i, m);
    const fresnel f = fresnel_dielectric(i_m, s->n.n_i, s->n.n_o);
    if (!(i_m > 0.0) || f.total)
        return 0.0;
    const vec3 o = direction_refract(vec3_scale(s->i, -1.0), m, i_m, f.eta, f.cos_t);
    const double o_m = vec3_dot(o, m), sum = s->n.n_i * i_m + s->n.n_o * o_m;
    return o.z < 0.0 ? walter_refraction(s->alpha, s->n, s->i, o) * -o.z * sum * sum / (s->n.n_o * s->n.n_o * -o_m)
                     : 0.0;
}

/* What facets reflect and refract, drawn and by quadrature of Walter's f; the rest, light that meets a second facet, is
 * lost: more of it with rougher surfaces (Walter et al., section 5.4). */
static void albedos_are_those_of_the_model(void **state)
{
    (void)state;
    for (size_t k = 0; k < 4; k++)
        for (size_t b = is_whole() ? 0 : k % 2; b < COUNT(media); b += is_whole() ? 1 : 2) {
            double before = 1.0;
            for (size_t a = 1; a < COUNT(alphas); a++) {
                const scattering s = {alphas[a], at_angles(angles[k], 0.6), media[b]};
                const albedo drawn = drawn_albedo(s.alpha, s.i, s.n);
                assert_near(drawn.reflected, over_normals(scattered_back, &s, 3000, 80), 5e-4);
                assert_near(drawn.refracted, over_normals(scattered_on, &s, 3000, 80), 5e-4);
                const double all = drawn.reflected + drawn.refracted;
                assert_true(all < 1.0 && all < before + 1e-4);
                before = all;
            }
        }
}

/* At normal incidence what a perfect mirror keeps is an integral over the share P of facets within an angle: tan^2 m =
 * alpha^2 P / (1 - P), and light leaves at 2 m. */
static void a_perfect_mirror_keeps_a_known_share_at_normal_incidence(void **state)
{
    (void)state;
    enum { STEPS = 100000, GRID = 400 };
    for (size_t a = 0; a < COUNT(alphas); a++) {
        double expected = 0.0, drawn = 0.0;
        for (int k = 0; k < STEPS; k++) {
            const double P = (k + 0.5) / STEPS, m = atan(alphas[a] * sqrt(P / (1.0 - P))), t = tan(2.0 * m);
            expected += t > 0.0 ? 2.0 / (1.0 + sqrt(1.0 + alphas[a] * alphas[a] * t * t)) / STEPS : 0.0;
        }
        const vec3 i = vec3_make(0.0, 0.0, 1.0);
        for (int c = 0; c < GRID * GRID; c++) {
            const vec3 m = ggx_sample_normal(alphas[a], i, (c / GRID + 0.5) / GRID, (c % GRID + 0.5) / GRID),
                       o = vec3_sub(vec3_scale(m, 2.0 * m.z), i);
            drawn += o.z > 0.0 ? ggx_masking(alphas[a], o) / GRID / GRID : 0.0;
        }
        assert_near(drawn, expected, 5e-4);
    }
}

/* Fresnel's law, also at total reflection. */
static void the_smooth_limit_is_fresnels(void **state)
{
    (void)state;
    for (size_t k = 0; k < 4; k++)
        for (size_t b = 0; b < COUNT(media); b++) {
            const albedo all = drawn_albedo(1e-5, at_angles(angles[k], 0.2), media[b]);
            const double R = dielectric(cos(angles[k]), &media[b]);
            assert_near(all.reflected, R, 1e-4);
            assert_near(all.refracted, 1.0 - R, 1e-4);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(facets_cover_the_surface_once),
        cmocka_unit_test(visible_facets_have_the_area_of_the_surface),
        cmocka_unit_test(drawn_normals_have_their_density),
        cmocka_unit_test(facets_scatter_by_walters_equations),
        cmocka_unit_test(light_passes_alike_both_ways),
        cmocka_unit_test(albedos_are_those_of_the_model),
        cmocka_unit_test(a_perfect_mirror_keeps_a_known_share_at_normal_incidence),
        cmocka_unit_test(the_smooth_limit_is_fresnels),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
