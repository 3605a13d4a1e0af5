/* Tests of rough surfaces on random paths: the model's albedo under a white sky, lamps of all sizes by quadrature of
 * Walter's f over them, and the same light by chance, without a lamp, and by photons. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "base/counters.h"
#include "optics/multilayer.h"
#include "path_fixture.h"
#include "walter.h"
#include "whole.h"

#define COUNT(a) (sizeof(a) / sizeof((a)[0]))

/* The camera looks at the middle of a plane at an angle of incidence with cosine 0.8. */
static const char plane_scene[] =
    "render: {width: 1, height: 1, depth: 1, integrator: path, paths: 65536, beyond: black}\n"
    "camera: {position: [0, 80, -60], target: [0, 0, 0], fov_deg: 0.001}\n"
    "background: {color: [0, 0, 0]}\n"
    "lights: {lamp: {position: [0, 3.2, 2.4], intensity: 0, reach: 2, radius: 1}}\n"
    "solids: {floor: {shape: plane, reflectivity: 1, roughness: 0.3}}\n";
static const double alphas[] = {0.05, 0.2, 0.5, 1.0};

static void set_number(scene *s, const char *path, double value)
{
    char text[96];
    snprintf(text, sizeof text, "%s=%.17g", path, value);
    set(s, text);
}

/* Towards the camera, in the frame of the plane's normal. */
static void look_from(scene *s, double cosine)
{
    s->camera.position = vec3_make(0.0, 100.0 * cosine, -100.0 * sqrt(1.0 - cosine * cosine));
}

static vec3 towards_eye(double cosine)
{
    return vec3_make(sqrt(1.0 - cosine * cosine), 0.0, cosine);
}

/* --- white sky --- */

typedef struct model {
    double alpha;
    vec3 i;
    facet_reflectance *F;
    const void *of;
    two_media n;
} model;

static double sent_back(vec3 m, const void *context)
{
    const model *s = context;
    const double i_m = vec3_dot(s->i, m);
    const vec3 o = vec3_sub(vec3_scale(m, 2.0 * i_m), s->i);
    return i_m > 0.0 && o.z > 0.0 ? walter_reflection(s->alpha, s->F, s->of, s->i, o) * o.z * 4.0 * i_m : 0.0;
}

static double sent_on(vec3 m, const void *context)
{
    const model *s = context;
    const double i_m = vec3_dot(s->i, m);
    const fresnel f = fresnel_dielectric(i_m, s->n.n_i, s->n.n_o);
    if (!(i_m > 0.0) || f.total)
        return 0.0;
    const vec3 o = direction_refract(vec3_scale(s->i, -1.0), m, i_m, f.eta, f.cos_t);
    const double o_m = vec3_dot(o, m), sum = s->n.n_i * i_m + s->n.n_o * o_m;
    return o.z < 0.0 ? walter_refraction(s->alpha, s->n, s->i, o) * -o.z * sum * sum / (s->n.n_o * s->n.n_o * -o_m)
                     : 0.0;
}

static void check_albedo(scene *s, const char *what, model m, bool clear)
{
    double expected = over_normals(sent_back, &m, 2000, 100);
    if (clear)
        expected += over_normals(sent_on, &m, 2000, 100);
    const estimate e = look_by_chance(s, 1);
    if (!(fabs(e.value - expected) <= 1e-3 + (s->render.spectrum == SPECTRUM_SPECTRAL ? 2.0 * e.standard_error : 0.0)))
        fail_msg("%s, alpha %g, cosine %g: %.6f instead of %.6f", what, m.alpha, m.i.z, e.value, expected);
}

static double constant_metal(double cos_i, const void *of)
{
    const complex_pair *n = of;
    const sp_amplitudes a = conductor_amplitudes(cos_i, 1.0, *n);
    return 0.5 * (complex_norm2(a.r_s) + complex_norm2(a.r_p));
}

static double one_third(double cos_i, const void *of)
{
    (void)cos_i, (void)of;
    return 1.0 / 3.0;
}

/* A perfect conductor, a metal of one index at all wavelengths, a weak mirror, and glass from either side. */
static void a_white_sky_shows_the_albedo(void **state)
{
    (void)state;
    static const double cosines[] = {1.0, 0.8, 0.4, 0.1};
    static const complex_pair metal = {0.8, 5.0};
    static const two_media in = {1.0, 1.5}, out = {1.5, 1.0};
    scene *s = scene_from(plane_scene);
    set_all(s, "background.color=1,1,1");
    for (size_t a = 0; a < COUNT(alphas); a++)
        for (size_t c = is_whole() ? 0 : a % 2; c < COUNT(cosines); c += is_whole() ? 1 : 2) {
            model m = {alphas[a], towards_eye(cosines[c]), perfect_mirror, NULL, in};
            set_number(s, "floor.roughness", m.alpha);
            look_from(s, cosines[c]);
            set_all(s, "floor.reflectivity=1 floor.transparency=0 floor.ior=1 floor.extinction=0 background.ior=1");
            check_albedo(s, "mirror", m, false);
            set_all(s, "floor.reflectivity=0.33333333333333333");
            m.F = one_third;
            check_albedo(s, "weak mirror", m, false);
            set_all(s, "floor.ior=0.8 floor.extinction=5");
            m.F = constant_metal, m.of = &metal;
            check_albedo(s, "metal", m, false);
            set_all(s, "floor.extinction=0 floor.reflectivity=0 floor.transparency=1 floor.ior=1.5");
            m.F = dielectric, m.of = &in;
            check_albedo(s, "into glass", m, true);
            set_all(s, "background.ior=1.5 floor.ior=1");
            m.of = &out, m.n = out;
            check_albedo(s, "out of glass", m, true);
        }
    scene_destroy(s);
}

/* A spectral film of an index without dispersion is that of the rgb film. */
static void a_spectral_film_has_the_same_albedo(void **state)
{
    (void)state;
    static const two_media in = {1.0, 1.5};
    const model m = {0.4, towards_eye(0.6), dielectric, &in, in};
    scene *s = scene_from(plane_scene);
    set_all(s, "background.color=1,1,1 render.spectrum=spectral floor.reflectivity=0 floor.transparency=1 "
               "floor.ior=1.5 floor.roughness=0.4");
    look_from(s, 0.6);
    check_albedo(s, "spectral", m, true);
    scene_destroy(s);
}

/* Towards alpha 0 a plane mirrors a lamp as a smooth one does, and a glass plate transmits it. */
static void the_limit_is_smooth(void **state)
{
    (void)state;
    scene *s = scene_from(plane_scene);
    set_all(s, "lamp.position=0,4,3 lamp.intensity=1 lamp.radius=1 lamp.reach=1 floor.transparency=1 floor.ior=1.5 "
               "floor.reflectivity=0 floor.roughness=0");
    const double smooth = look_by_chance(s, 0).value;
    assert_true(fabs(smooth - fresnel_dielectric(0.8, 1.0, 1.5).R) < 1e-3);
    set_all(s, "floor.roughness=1e-4");
    expect_estimate(look_by_chance(s, 0), smooth);
    scene_destroy(s);
}

/* --- lamps --- */

/* The integral of f cos over the cone of directions to a sphere whose centre is in direction `to` and of sine `sine`,
 * in the frame of the normal. Nodes uniform in solid angle. */
static double over_lamp(const model *m, vec3 to, double sine)
{
    enum { RINGS = 600, SECTORS = 600 };
    const vec3 side = fabs(to.x) < 0.9 ? vec3_make(1.0, 0.0, 0.0) : vec3_make(0.0, 1.0, 0.0),
               x = vec3_normalize(vec3_cross(to, side)), y = vec3_cross(to, x);
    const double cap = sine * sine / (1.0 + sqrt(1.0 - sine * sine));
    double sum = 0.0;
    for (int k = 0; k < RINGS; k++)
        for (int j = 0; j < SECTORS; j++) {
            const double off = cap * (k + 0.5) / RINGS, s = sqrt(off * (2.0 - off)),
                         phi = 2.0 * WALTER_PI * (j + 0.5) / SECTORS;
            const vec3 o =
                vec3_add(vec3_scale(to, 1.0 - off), vec3_add(vec3_scale(x, s * cos(phi)), vec3_scale(y, s * sin(phi))));
            if (o.z > 0.0)
                sum += walter_reflection(m->alpha, m->F, m->of, m->i, o) * o.z;
            else if (m->n.n_o > 0.0)
                sum += walter_refraction(m->alpha, m->n, m->i, o) * -o.z;
        }
    return sum * 2.0 * WALTER_PI * cap / RINGS / SECTORS;
}

typedef struct lamp_place {
    vec3 position; /* x to the right, y up, z away from the camera */
    double radius; /* 0: a point */
} lamp_place;

static double lamp_light(const model *m, lamp_place l, double intensity, double reach)
{
    const double d = vec3_length(l.position), sine = l.radius / d;
    /* the camera is in the plane y, -z, in the model's x, z */
    const vec3 to = vec3_scale(vec3_make(-l.position.z, l.position.x, l.position.y), 1.0 / d);
    if (l.radius > 0.0)
        return intensity * reach * reach / (l.radius * l.radius) * over_lamp(m, to, sine);
    const double f =
        to.z > 0.0 ? walter_reflection(m->alpha, m->F, m->of, m->i, to) : walter_refraction(m->alpha, m->n, m->i, to);
    return f * fabs(to.z) * WALTER_PI * intensity * reach * reach / (d * d);
}

/* Near the mirror direction, aside, grazing, cut by the horizon, and below the plane, in the glass. */
static const lamp_place places[] = {
    {{0.0, 3.2, 2.4}, 0.02}, {{0.0, 3.2, 2.4}, 0.5},  {{0.5, 3.0, 2.9}, 1.5},   {{2.0, 2.0, -1.0}, 0.3},
    {{0.0, 0.5, 3.0}, 0.2},  {{0.3, 0.1, 3.0}, 0.8},  {{0.0, -3.5, 1.8}, 0.05}, {{0.2, -3.0, 1.0}, 1.0},
    {{1.0, 3.0, 2.0}, 0.0},  {{0.4, -3.0, 1.0}, 0.0},
};

static void a_lamp_is_its_quadrature(void **state)
{
    (void)state;
    static const two_media in = {1.0, 1.5}, none = {1.0, 0.0};
    agreement all = {0};
    scene *s = scene_from(plane_scene);
    set_all(s, "lamp.intensity=1 render.paths=4096 render.sampler=philox");
    for (size_t a = 0; a < COUNT(alphas); a++)
        for (size_t k = 0; k < COUNT(places); k++)
            for (int clear = 0; clear < 2; clear++) {
                const model m = {alphas[a], towards_eye(0.8), clear ? dielectric : perfect_mirror, &in,
                                 clear ? in : none};
                if (!clear && places[k].position.y < 0.0)
                    continue;
                set_all(s, clear ? "floor.reflectivity=0 floor.transparency=1 floor.ior=1.5"
                                 : "floor.reflectivity=1 floor.transparency=0 floor.ior=1");
                set_number(s, "floor.roughness", m.alpha);
                s->lights[0].position = places[k].position;
                s->lights[0].radius = places[k].radius;
                s->render.seed++;
                const double expected = lamp_light(&m, places[k], 1.0, 2.0);
                const estimate e = look_by_chance(s, 0);
                if (!(fabs(e.value - expected) <= 8.0 * e.standard_error + 2e-3 * expected + 1e-7))
                    fail_msg("alpha %g, place %zu, %s: %.6g +- %.2g instead of %.6g", m.alpha, k,
                             clear ? "glass" : "mirror", e.value, e.standard_error, expected);
                assert_true(e.standard_error <= 0.06 * expected + 1e-6);
                if (places[k].radius > 0.0)
                    agreement_add(&all, e, expected, 1e-6);
            }
    print_message("%d lamps: %.0f%% in their 95%% interval, mean off by %.2f\n", all.count,
                  100.0 * agreement_share(&all), agreement_off(&all));
    assert_true(agreement_share(&all) > 0.8);
    scene_destroy(s);
}

/* The integral over a disc that faces the origin, by its area: L f cos cos_l dA / d^2, L = I (reach / r)^2. */
static double disc_light(const model *m, lamp_place l, double intensity, double reach)
{
    enum { RINGS = 400, SECTORS = 400 };
    const vec3 axis = vec3_normalize(vec3_scale(l.position, -1.0)),
               side = fabs(axis.x) < 0.9 ? vec3_make(1.0, 0.0, 0.0) : vec3_make(0.0, 1.0, 0.0),
               x = vec3_normalize(vec3_cross(axis, side)), y = vec3_cross(axis, x);
    double sum = 0.0;
    for (int k = 0; k < RINGS; k++)
        for (int j = 0; j < SECTORS; j++) {
            const double r = l.radius * sqrt((k + 0.5) / RINGS), phi = 2.0 * WALTER_PI * (j + 0.5) / SECTORS;
            const vec3 at = vec3_add(l.position, vec3_add(vec3_scale(x, r * cos(phi)), vec3_scale(y, r * sin(phi)))),
                       to = vec3_normalize(at), o = vec3_make(-to.z, to.x, to.y);
            const double share = -vec3_dot(to, axis) / vec3_dot(at, at);
            if (o.z > 0.0)
                sum += share * walter_reflection(m->alpha, m->F, m->of, m->i, o) * o.z;
            else if (m->n.n_o > 0.0)
                sum += share * walter_refraction(m->alpha, m->n, m->i, o) * -o.z;
        }
    return intensity * reach * reach * WALTER_PI * sum / RINGS / SECTORS;
}

static void a_disc_is_its_quadrature(void **state)
{
    (void)state;
    static const two_media in = {1.0, 1.5};
    scene *s = scene_from(plane_scene);
    set_all(s, "lamp.intensity=1 render.paths=4096 render.sampler=philox lamp.kind=disc lamp.target=0,0,0 "
               "floor.reflectivity=0 floor.transparency=1 floor.ior=1.5");
    for (size_t a = 0; a < COUNT(alphas); a++)
        for (size_t k = 0; k < COUNT(places); k++) {
            const model m = {alphas[a], towards_eye(0.8), dielectric, &in, in};
            if (places[k].radius == 0.0)
                continue;
            set_number(s, "floor.roughness", m.alpha);
            s->lights[0].position = places[k].position;
            s->lights[0].radius = places[k].radius;
            s->render.seed++;
            const double expected = disc_light(&m, places[k], 1.0, 2.0);
            const estimate e = look_by_chance(s, 0);
            if (!(fabs(e.value - expected) <= 8.0 * e.standard_error + 2e-3 * expected + 1e-7))
                fail_msg("alpha %g, place %zu: %.6g +- %.2g instead of %.6g", m.alpha, k, e.value, e.standard_error,
                         expected);
        }
    scene_destroy(s);
}

/* Five lamps on both sides: one chosen for each side, or all, is the sum of each. */
static void several_lamps_are_their_sum(void **state)
{
    (void)state;
    static const two_media in = {1.0, 1.5};
    static const size_t chosen[] = {1, 3, 7, 8, 9};
    const model m = {0.3, towards_eye(0.8), dielectric, &in, in};
    double expected = 0.0;
    for (size_t k = 0; k < COUNT(chosen); k++)
        expected += lamp_light(&m, places[chosen[k]], 1.0 + (double)k, 1.0);
    char text[2048];
    int at = snprintf(text, sizeof text, "%s",
                      "render: {width: 1, height: 1, depth: 1, integrator: path, paths: 65536, beyond: black}\n"
                      "camera: {position: [0, 80, -60], target: [0, 0, 0], fov_deg: 0.001}\n"
                      "background: {color: [0, 0, 0]}\n"
                      "solids: {floor: {shape: plane, transparency: 1, ior: 1.5, roughness: 0.3}}\n"
                      "lights:\n");
    for (size_t k = 0; k < COUNT(chosen); k++) {
        const lamp_place l = places[chosen[k]];
        at += snprintf(text + at, sizeof text - (size_t)at,
                       "  l%zu: {position: [%g, %g, %g], radius: %g, reach: 1, intensity: %g}\n", k, l.position.x,
                       l.position.y, l.position.z, l.radius, 1.0 + (double)k);
    }
    scene *s = scene_from(text);
    expect_estimate(look_by_chance(s, 0), expected);
    set(s, "render.light_sampling=all");
    expect_estimate(look_by_chance(s, 0), expected);
    scene_destroy(s);
}

/* --- the same light by chance --- */

/* A rough pane of gold and of glass with two faces, and a matte floor on which both throw light. */
static const char room[] =
    "render: {width: 12, height: 9, depth: 12, integrator: path, paths: 4096, sampler: philox}\n"
    "camera: {position: [0, 1.6, -5], target: [0, 0.7, 0], fov_deg: 40}\n"
    "background: {color: [0, 0, 0]}\n"
    "solids:\n"
    "  ground: {shape: plane, color: [0.9, 0.6, 0.3], diffuse: 0.7, priority: -2}\n"
    "  ball: {shape: sphere, transparency: 1, ior: 1.5, position: [-0.7, 0.7, 0], radius: 0.6, roughness: 0.25}\n"
    "  core: {shape: sphere, transparency: 1, ior: 1.2, position: [-0.7, 0.7, 0], radius: 0.3, priority: 1}\n"
    "  bar: {shape: box, medium: gold, position: [0.8, 0.6, 0.3], size: [0.8, 0.9, 0.4], rotation: [0, 25, 0],\n"
    "    roughness: 0.3, color: [0.5, 0.5, 0.5], diffuse: 0.2}\n";

static render_result *room_with(const char *more, const char *assignments)
{
    char text[2048];
    snprintf(text, sizeof text, "%s%s", room, more);
    scene *s = scene_from(text);
    set_all(s, assignments);
    render_result *r = render(s);
    scene_destroy(s);
    return r;
}

/* Mean deviation of all values in standard errors, and their root mean square. */
static void expect_alike(const render_result *a, const render_result *b)
{
    double off = 0.0, variance = 0.0, squares = 0.0;
    int count = 0;
    for (int y = 0; y < a->img->height; y++)
        for (int x = 0; x < a->img->width; x++)
            for (int c = 0; c < 3; c++) {
                const estimate e = estimate_at(a, x, y, c), f = estimate_at(b, x, y, c);
                const double sum = e.standard_error * e.standard_error + f.standard_error * f.standard_error;
                off += e.value - f.value, variance += sum;
                if (e.standard_error > 0.0 && f.standard_error > 0.0) /* far away the ball is never hit */
                    squares += (e.value - f.value) * (e.value - f.value) / sum, count++;
            }
    print_message("mean off by %.2f standard errors, root mean square %.2f\n", off / sqrt(variance),
                  sqrt(squares / count));
    assert_true(fabs(off) <= 4.0 * sqrt(variance));
    assert_true(squares / count < 3.0);
}

/* A lamp is sampled by surfaces; a matte ball that glows as brightly is hit by chance. Through glass its light is half
 * of the scene's here. */
static void expect_lamp_as_ball(const char *assignments)
{
    char of_ball[160];
    snprintf(of_ball, sizeof of_ball, "render.paths=16384 %s", assignments);
    render_result *lamp =
        room_with("lights: {lamp: {position: [0.5, 2.4, -0.5], radius: 0.6, reach: 0.6, intensity: 3}}\n", assignments);
    render_result *ball =
        room_with("  glow: {shape: sphere, position: [0.5, 2.4, -0.5], radius: 0.6, emission: 3}\n", of_ball);
    expect_alike(lamp, ball);
    render_result_destroy(lamp);
    render_result_destroy(ball);
}

static void a_lamp_lights_as_a_glowing_ball_does(void **state)
{
    (void)state;
    expect_lamp_as_ball("");
    expect_lamp_as_ball("ball.roughness=0.7 bar.roughness=0.7 render.energy_compensation=on");
}

/* The same flux on the floor by photons, whose discs only move it a little. */
static void expect_photons_flux(const char *lamp, const char *assignments)
{
    char by_paths[160], by_photons[160];
    snprintf(by_paths, sizeof by_paths, "%s render.radiance=basic", assignments);
    snprintf(by_photons, sizeof by_photons, "%s render.caustics=photons render.photons=400000", assignments);
    render_result *paths = room_with(lamp, by_paths), *photons = room_with(lamp, by_photons);
    double sum[2] = {0.0, 0.0}, worst = 0.0;
    for (int i = 0; i < 3 * 12 * 9; i++) {
        const double a = film_value(paths->img, i / 3 % 12, i / 36, i % 3),
                     b = film_value(photons->img, i / 3 % 12, i / 36, i % 3);
        sum[0] += a, sum[1] += b;
        worst = fmax(worst, fabs(a - b) / (a + 0.02));
    }
    print_message("photons / paths %.4f, largest difference %.3f\n", sum[1] / sum[0], worst);
    assert_true(fabs(sum[1] / sum[0] - 1.0) < 0.01);
    render_result_destroy(paths);
    render_result_destroy(photons);
}

static void photons_bring_the_light_of_rough_glass_and_metal(void **state)
{
    (void)state;
    static const char lamp[] = "lights: {lamp: {position: [0.5, 2.4, -0.5], radius: 0.6, reach: 0.6, intensity: 3}}\n";
    expect_photons_flux(lamp, "");
    expect_photons_flux(lamp, "ball.roughness=0.7 bar.roughness=0.7 render.energy_compensation=on");
}

/* Paths find a point lamp's light through rough glass by its facets: a shadow ray must not bring it too. */
static void a_point_lamps_light_through_rough_glass_counts_once(void **state)
{
    (void)state;
    expect_photons_flux("lights: {lamp: {position: [0.5, 2.4, -0.5], reach: 2, intensity: 1}}\n",
                        "core.visible=off bar.visible=off");
}

/* --- the program --- */

/* Whitted's rays meet a smooth surface. */
static void other_integrators_see_a_smooth_surface(void **state)
{
    (void)state;
    static const char *const others[] = {"whitted", "raycast", "zbuffer"};
    for (size_t k = 0; k < COUNT(others); k++) {
        char assignment[64];
        snprintf(assignment, sizeof assignment, "render.integrator=%s", others[k]);
        scene *s = scene_from(room);
        set(s, assignment);
        render_result *rough = render(s);
        set_all(s, "ball.roughness=0 bar.roughness=0");
        render_result *smooth = render(s);
        assert_true(film_hash(rough->img) == film_hash(smooth->img));
        render_result_destroy(rough);
        render_result_destroy(smooth);
        scene_destroy(s);
    }
}

/* Each of the path's rays is one that reflects or refracts, and total reflections are some of them. */
static void rays_are_counted(void **state)
{
    (void)state;
    render_result *r =
        room_with("lights: {lamp: {position: [0.5, 2.4, -0.5], radius: 0.6, reach: 0.6}}\n", "render.paths=64");
    uint64_t deeper = 0;
    for (int d = 1; d <= COUNTERS_DEPTH_MAX; d++)
        deeper += r->counters.by_depth[d];
    assert_true(!CUVETTE_COUNTERS || (deeper == r->counters.reflect + r->counters.refract && r->counters.refract > 0 &&
                                      r->counters.total_internal > 0 && r->counters.shadow > 0));
    assert_true(r->counters.total_internal <= r->counters.reflect + r->counters.cut_depth + r->counters.camera);
    render_result_destroy(r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_white_sky_shows_the_albedo),
        cmocka_unit_test(a_spectral_film_has_the_same_albedo),
        cmocka_unit_test(the_limit_is_smooth),
        cmocka_unit_test(a_lamp_is_its_quadrature),
        cmocka_unit_test(a_disc_is_its_quadrature),
        cmocka_unit_test(several_lamps_are_their_sum),
        cmocka_unit_test(a_lamp_lights_as_a_glowing_ball_does),
        cmocka_unit_test(photons_bring_the_light_of_rough_glass_and_metal),
        cmocka_unit_test(a_point_lamps_light_through_rough_glass_counts_once),
        cmocka_unit_test(other_integrators_see_a_smooth_surface),
        cmocka_unit_test(rays_are_counted),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
