/* Tests of light that facets of rough surfaces send to one another (render/plan/rough_energy.h): a surface that
 * absorbs nothing sends on all light from every direction, by quadrature of Walter's f, and in white furnaces; it is
 * reciprocal, so that photons and paths agree (test_rough.c); metals keep what Kulla and Conty give. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <cmocka.h>

#include "path_fixture.h"
#include "render/plan/rough_energy.h"
#include "walter.h"
#include "whole.h"

/* Of the tables, for alpha from 0.1 and ratios of indices from 1.1 to 2.4. */
#define ACCURACY 3e-3
#define COUNT(a) (sizeof(a) / sizeof((a)[0]))

static const double alphas[] = {0.1, 0.2, 0.35, 0.5, 0.7, 1.0}, ratios[] = {1.1, 1.3, 1.5, 1.77, 2.4},
                    cosines[] = {1.0, 0.9, 0.75, 0.6, 0.4, 0.2, 0.1, 0.05};

/* A surface, and the direction from which light comes. */
typedef struct rough_interface {
    double alpha;
    facet_reflectance *F;
    two_media n;
    vec3 i;
} rough_interface;

static double sent_back(vec3 m, const void *context)
{
    const rough_interface *s = context;
    const double i_m = vec3_dot(s->i, m);
    const vec3 o = vec3_sub(vec3_scale(m, 2.0 * i_m), s->i);
    return i_m > 0.0 && o.z > 0.0 ? walter_reflection(s->alpha, s->F, &s->n, s->i, o) * o.z * 4.0 * i_m : 0.0;
}

static double sent_on(vec3 m, const void *context)
{
    const rough_interface *s = context;
    const double i_m = vec3_dot(s->i, m);
    const fresnel f = fresnel_dielectric(fmin(i_m, 1.0), s->n.n_i, s->n.n_o);
    if (!(i_m > 0.0) || f.total)
        return 0.0;
    const vec3 o = direction_refract(vec3_scale(s->i, -1.0), m, i_m, f.eta, f.cos_t);
    const double o_m = vec3_dot(o, m), sum = s->n.n_i * i_m + s->n.n_o * o_m;
    return o.z < 0.0 ? walter_refraction(s->alpha, s->n, s->i, o) * -o.z * sum * sum / (s->n.n_o * s->n.n_o * -o_m)
                     : 0.0;
}

/* Of one facet. */
static double albedo(const rough_interface *s)
{
    return over_normals(sent_back, s, 800, 60) + (s->F == dielectric ? over_normals(sent_on, s, 800, 60) : 0.0);
}

static vec3 at_cosine(double cosine)
{
    return vec3_make(sqrt(1.0 - cosine * cosine), 0.0, cosine);
}

/* Of further facets, by the rule of midpoints over the roots of cosines. */
static double further(const facet_energy *e, bool refracted)
{
    enum { STEPS = 400 };
    double sum = 0.0;
    for (int k = 0; k < STEPS; k++) {
        const double x = (k + 0.5) / STEPS;
        sum += 4.0 * x * x * x / STEPS * facet_energy_towards(e, refracted, x * x);
    }
    return e->lost * e->fraction[refracted] * sum;
}

static rough_energy *finish(double alpha, bool opaque, const rough_finish **out)
{
    rough_energy *all = NULL;
    assert_true(rough_energy_add(&all, alpha, 0.0, opaque));
    *out = rough_energy_find(all, alpha, 0.0, opaque);
    assert_non_null(*out);
    return all;
}

/* From both sides. One facet alone loses up to half of the light. */
static void an_interface_sends_on_all_light(void **state)
{
    (void)state;
    double worst = 0.0, most = 0.0;
    for (size_t a = 0; a < COUNT(alphas); a++) {
        const rough_finish *f;
        rough_energy *all = finish(alphas[a], false, &f);
        for (size_t k = is_whole() ? 0 : a % 2; k < COUNT(ratios); k += is_whole() ? 1 : 2)
            for (size_t c = 0; c < 2 * COUNT(cosines); c++) {
                const bool dense = c % 2;
                const two_media in = {1.0, ratios[k]}, out = {ratios[k], 1.0};
                const rough_interface s = {alphas[a], dielectric, dense ? out : in, at_cosine(cosines[c / 2])};
                const facet_energy e = facet_energy_at(all, f, s.n.n_i, s.n.n_o, s.i.z);
                const double one = albedo(&s), whole = one + further(&e, false) + further(&e, true);
                if (!(fabs(whole - 1.0) < ACCURACY))
                    fail_msg("alpha %g, from %g to %g, cosine %g: %.5f; of one facet %.5f", alphas[a], s.n.n_i, s.n.n_o,
                             s.i.z, whole, one);
                assert_true(e.fraction[0] >= 0.0 && e.fraction[1] >= 0.0);
                worst = fmax(worst, fabs(whole - 1.0));
                most = fmax(most, 1.0 - one);
            }
        rough_energy_destroy(all);
    }
    print_message("largest error of the albedo %.1e; one facet loses up to %.2f\n", worst, most);
    assert_true(most > 0.4);
}

/* A mirror sends on all; one of reflectance F: F E(i) + F^2 E (1 - E(i)) / (1 - F (1 - E)), Kulla and Conty 2017, which
 * is the sum of F^n over the number of facets, if each gets the share 1 - E of the light of the one before. */
static void a_mirror_keeps_what_its_reflectance_says(void **state)
{
    (void)state;
    for (size_t a = 0; a < COUNT(alphas); a++) {
        const rough_finish *f;
        rough_energy *all = finish(alphas[a], true, &f);
        double mean = 0.0;
        for (int k = 0; k < 64; k++) {
            const rough_interface s = {alphas[a], perfect_mirror, {1.0, 1.0}, at_cosine(sqrt((k + 0.5) / 64))};
            mean += albedo(&s) / 64.0;
        }
        for (size_t c = 0; c < COUNT(cosines); c++) {
            const rough_interface s = {alphas[a], perfect_mirror, {1.0, 1.0}, at_cosine(cosines[c])};
            const facet_energy e = facet_energy_at(all, f, 1.0, 1.0, s.i.z);
            const double one = albedo(&s), F = 0.6;
            double kept = 0.0;
            for (int n = 2; n < 100; n++)
                kept += pow(F, n) * mean * pow(1.0 - mean, n - 2);
            assert_true(fabs(one + further(&e, false) - 1.0) < ACCURACY);
            assert_true(further(&e, true) == 0.0);
            assert_true(fabs(facet_energy_kept(&e, F) - kept) < ACCURACY);
            assert_true(facet_energy_kept(&e, 1.0) == 1.0 && facet_energy_kept(&e, 0.0) == 0.0);
        }
        rough_energy_destroy(all);
    }
}

/* n_i^2 f(i, o) = n_o^2 f(o, i), and f(i, o) = f(o, i) on one side. */
static void further_facets_are_reciprocal(void **state)
{
    (void)state;
    for (size_t a = 0; a < COUNT(alphas); a++) {
        const rough_finish *f;
        rough_energy *all = finish(alphas[a], false, &f);
        for (size_t k = 0; k < COUNT(ratios); k++)
            for (size_t c = 0; c < COUNT(cosines); c++) {
                const double n[2] = {1.3, 1.3 * ratios[k]}, here = 0.7, there = cosines[c];
                const facet_energy in = facet_energy_at(all, f, n[0], n[1], here),
                                   out = facet_energy_at(all, f, n[1], n[0], there),
                                   back = facet_energy_at(all, f, n[0], n[1], there);
                const double to = in.lost * in.fraction[1] * facet_energy_towards(&in, true, there),
                             from = out.lost * out.fraction[1] * facet_energy_towards(&out, true, here),
                             one = in.lost * in.fraction[0] * facet_energy_towards(&in, false, there),
                             other = back.lost * back.fraction[0] * facet_energy_towards(&back, false, here);
                assert_true(fabs(n[0] * n[0] * to - n[1] * n[1] * from) <= 1e-12 * (1.0 + to));
                assert_true(fabs(one - other) <= 1e-12 * (1.0 + one));
            }
        rough_energy_destroy(all);
    }
}

/* --- furnaces --- */

#define FURNACE                                                                                              \
    "render: {width: 6, height: 5, depth: 64, integrator: path, paths: 1024, energy_compensation: \"on\"}\n" \
    "camera: {position: [0.7, 1.1, -4], target: [0, 0, 0], fov_deg: 30}\n"                                   \
    "background: {color: [1, 1, 1]}\n"
#define BODY "transparency: 1, ior: 1.5, roughness: 0.5}}\n"

/* Paths draw whether light meets further facets by what each facet does, so that only the mean of A(o) / a matters. */
static void expect_white(scene *s, const char *assignments)
{
    set_all(s, assignments);
    render_result *r = render(s);
    double off = 0.0, variance = 0.0;
    const int width = r->img->width, count = width * r->img->height;
    for (int i = 0; i < count; i++) { /* green, or Y of a spectral film: 1 for white */
        const estimate e = estimate_at(r, i % width, i / width, 1);
        off += (e.value - 1.0) / count;
        variance += e.standard_error * e.standard_error / count / count;
    }
    print_message("%s: %.5f +- %.5f\n", assignments, 1.0 + off, sqrt(variance));
    assert_true(sqrt(variance) < 3e-3 && fabs(off) < 5.0 * sqrt(variance) + 2e-4);
    render_result_destroy(r);
}

static void closed_furnaces_are_white(void **state)
{
    (void)state;
    static const char *const solids[] = {FURNACE "solids: {body: {shape: box, size: [1.6, 1.6, 1.6], " BODY,
                                         FURNACE "solids: {body: {shape: sphere, radius: 1, " BODY};
    static const char *const settings[] = {"body.roughness=0.1",
                                           "body.roughness=0.3",
                                           "body.roughness=1",
                                           "body.ior=1.1",
                                           "body.ior=2.4",
                                           "body.roughness=0.3 body.ior=1.5 body.reflectivity=0.4",
                                           "render.polarisation=on body.reflectivity=0",
                                           "render.polarisation=off body.film_thickness_nm=300 body.film_ior=2",
                                           "body.film_thickness_nm=0 render.spectrum=spectral body.medium=sf11",
                                           "render.spectrum=rgb body.transparency=0 body.reflectivity=1",
                                           "body.roughness=0.1"};
    for (size_t k = 0; k < COUNT(solids); k++) {
        scene *s = scene_from(solids[k]);
        for (size_t i = 0; i < COUNT(settings); i++)
            expect_white(s, settings[i]);
        scene_destroy(s);
    }
}

/* Without it the box is as dark as one facet leaves it. */
static void light_is_lost_by_default(void **state)
{
    (void)state;
    scene *s = scene_from(FURNACE "solids: {body: {shape: box, size: [1.6, 1.6, 1.6], " BODY);
    set_all(s, "render.width=1 render.height=1 camera.fov_deg=1 render.energy_compensation=off");
    const vec3 seen = look(s);
    set(s, "render.energy_compensation=on");
    assert_true(seen.x < 0.8 && look(s).x > 0.95);
    scene_destroy(s);
}

/* A ball of gold at alpha 1 is darker than one facet and no more, and brighter than one facet alone: in a furnace each
 * facet keeps R. */
static void rough_gold_is_darker_than_smooth(void **state)
{
    (void)state;
    scene *s = scene_from(FURNACE "solids: {body: {shape: sphere, radius: 1, medium: gold, roughness: 0}}\n");
    set_all(s, "render.width=1 render.height=1 camera.fov_deg=1");
    const vec3 smooth = look(s);
    set(s, "body.roughness=1");
    const vec3 rough = look(s);
    set(s, "render.energy_compensation=off");
    const vec3 one = look(s);
    assert_true(one.x < rough.x && rough.x < smooth.x && one.z < rough.z && rough.z < smooth.z);
    assert_true(rough.z / smooth.z < rough.x / smooth.x); /* the colour deepens */
    scene_destroy(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_interface_sends_on_all_light), cmocka_unit_test(a_mirror_keeps_what_its_reflectance_says),
        cmocka_unit_test(further_facets_are_reciprocal),   cmocka_unit_test(closed_furnaces_are_white),
        cmocka_unit_test(light_is_lost_by_default),        cmocka_unit_test(rough_gold_is_darker_than_smooth),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
