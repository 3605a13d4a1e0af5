/* Tests of media that scatter, on random paths, against closed forms. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "base/random.h"
#include "optics/optical_data.h"
#include "optics/phase_function.h"
#include "path_fixture.h"
#include "scene/model/medium.h"
#include "whole.h"

/* Media that scatter, on random paths, against closed forms: the phase function, free flights, single
 * scattering by quadrature, and multiple scattering by Chandrasekhar's H-functions and an independent Monte-Carlo. */

#define COUNT(a) (sizeof(a) / sizeof((a)[0]))
#define PI 3.14159265358979323846

static const double asymmetries[] = {-0.999, -0.6, -1e-9, 0.0, 1e-4, 0.3, 0.9, 0.999};

/* --- the phase function --- */

/* The integral of c^power p(c) over all directions with cosines from -1 to `to`, by Simpson's rule in
 * s = ln((1 - g)^2 + 2 g (1 - c)) where g is not small. */
static double phase_integral(double g, int power, double to)
{
    const int steps = 4000;
    const bool peaked = fabs(g) > 0.01;
    const double low = log(1.0 + g * g + 2.0 * g), high = log(1.0 + g * g - 2.0 * g * to);
    double sum = 0.0;
    for (int i = 0; i <= steps; i++) {
        const double weight = i == 0 || i == steps ? 1.0 : i % 2 ? 4.0 : 2.0, x = (double)i / steps;
        const double base = exp(low + x * (high - low));
        const double c = peaked ? (1.0 + g * g - base) / (2.0 * g) : -1.0 + x * (to + 1.0);
        const double dc = peaked ? base * (low - high) / (2.0 * g) : to + 1.0;
        sum += weight * 2.0 * PI * henyey_greenstein(c, g) * pow(c, power) * dc / (3.0 * steps);
    }
    return sum;
}

static void the_phase_function_has_its_moments(void **state)
{
    (void)state;
    for (size_t i = 0; i < COUNT(asymmetries); i++) {
        const double g = asymmetries[i];
        assert_true(fabs(phase_integral(g, 0, 1.0) - 1.0) < 1e-9);
        assert_true(fabs(phase_integral(g, 1, 1.0) - g) < 1e-9);
        assert_true(fabs(1.5 * phase_integral(g, 2, 1.0) - 0.5 - g * g) < 1e-9); /* the mean of P_2 is g^2 */
    }
}

static void cosines_are_drawn_by_the_phase_function(void **state)
{
    (void)state;
    for (size_t i = 0; i < COUNT(asymmetries); i++)
        for (double u = 0.0005; u < 1.0; u += 0.0301) {
            const double c = henyey_greenstein_cosine(u, asymmetries[i]);
            assert_true(fabs(phase_integral(asymmetries[i], 0, c) - u) < 1e-9);
        }
}

/* Gives a medium measured scattering, in 1/m, with these values at the wavelengths of the channels. */
static void scatter_by_channel(material *m, double red, double green, double blue)
{
    const double point[] = {464.3, blue, 549.1, green, 611.4, red};
    diagnostic why = {0};
    optical_data_release(m->scatter_values);
    worked(optical_data_create(NULL, (optical_curve){point, 3}, (optical_curve){NULL, 0}, &m->scatter_values, &why),
           &why);
}

static double scattering_of(const material *m, int channel)
{
    const vec3 b = material_scattering(m);
    return channel == 0 ? b.x : channel == 1 ? b.y : b.z;
}

/* --- what is not scattered --- */

/* The camera looks along z; a slab of 2 units between z = 1 and 3, an emitter behind it. No second flight. */
static const char slab_scene[] =
    "render: {width: 1, height: 1, depth: 0, integrator: path, paths: 65536, beyond: black}\n"
    "camera: {position: [0, 0, 0], target: [0, 0, 1], fov_deg: 0.001}\n"
    "background: {color: [0, 0, 0]}\n"
    "lights: {lamp: {position: [0, 0, 10], intensity: 0, reach: 1, radius: 0}}\n"
    "solids:\n"
    "  slab: {shape: box, transparency: 1, ior: 1, position: [0, 0, 2], size: [50, 50, 2], scatter_per_m: 0.4,\n"
    "    absorb_per_m: [0.3, 0.1, 0], asymmetry: 0.5}\n"
    "  core: {shape: box, transparency: 1, ior: 1, position: [0, 0, 2], size: [50, 50, 0.5], scatter_per_m: 0.4,\n"
    "    absorb_per_m: [0.3, 0.1, 0], priority: 1}\n"
    "  ember: {shape: sphere, position: [0, 0, 6], radius: 0.1, emission: 1, visible: on}\n";

static void what_passes_is_that_of_beer_and_lambert(void **state)
{
    (void)state;
    static const double scatters[] = {0.05, 0.4, 1.5, 4.0}, absorbed[] = {0.3, 0.1, 0.0};
    scene *s = scene_from(slab_scene);
    for (int metres = 1; metres <= 2; metres++) /* per scene unit */
        for (size_t i = 0; i < COUNT(scatters); i++)
            for (int c = 0; c < 3; c++) {
                s->render.unit_m = metres;
                s->solids[0].surface.scatter_per_m = scatters[i];
                const double inner = s->solids[1].surface.scatter_per_m;
                expect_estimate(look_by_chance(s, c),
                                exp(-metres * (2.0 * absorbed[c] + 1.5 * scatters[i] + 0.5 * inner)));
            }
    scene_destroy(s);
}

/* The channels fly by one of theirs, and are weighted. */
static void channels_lose_their_own_share(void **state)
{
    (void)state;
    static const double red[] = {0.05, 0.4, 0.0}, absorbed[] = {0.3, 0.1, 0.0};
    scene *s = scene_from(slab_scene);
    material *m = &s->solids[0].surface;
    for (size_t i = 0; i < COUNT(red); i++) {
        scatter_by_channel(m, red[i], 1.0, 2.5);
        for (int c = 0; c < 3; c++)
            expect_estimate(look_by_chance(s, c), exp(-2.0 * absorbed[c] - 1.5 * scattering_of(m, c) - 0.5 * 0.4));
    }
    optical_data_release(m->scatter_values);
    scene_destroy(s);
}

/* Without a second flight and with nothing around, what scatters is lost as if it were absorbed. */
static void a_wavelength_loses_its_own_share(void **state)
{
    (void)state;
    scene *s = scene_from(slab_scene);
    material *m = &s->solids[0].surface;
    set_all(s, "render.spectrum=spectral core.visible=off slab.absorb_per_m=0,0,0 render.paths=8192");
    scatter_by_channel(m, 0.1, 0.6, 2.0);
    estimate scattered_away[3];
    for (int c = 0; c < 3; c++)
        scattered_away[c] = look_by_chance(s, c);
    m->absorb_values = m->scatter_values;
    m->scatter_values = NULL;
    m->scatter_per_m = 0.0;
    for (int c = 0; c < 3; c++)
        expect_estimate(scattered_away[c], look_by_chance(s, c).value);
    optical_data_release(m->absorb_values);
    scene_destroy(s);
}

/* A lamp's sphere seen through the slab, and a matte floor behind it that the lamp on this side lights. */
static void lamps_lose_what_is_scattered(void **state)
{
    (void)state;
    scene *s = scene_from(slab_scene);
    set_all(s, "ember.visible=off lamp.intensity=1 lamp.radius=0.5 lamp.reach=0.5 lamp.position=0,0,6");
    /* a ray that scatters sees the lamp from inside the slab: only g = -0.999 turns none of it to the camera */
    set_all(s, "slab.asymmetry=-0.999 core.asymmetry=-0.999");
    const double passes = exp(-2.0 * 0.4 - 2.0 * 0.1), e = look_by_chance(s, 1).value;
    assert_true(fabs(e - passes) < 2e-3);
    set_all(s, "lamp.radius=0 lamp.reach=0 lamp.position=0,0,-1 ember.visible=on ember.radius=1 ember.emission=0 "
               "ember.diffuse=1 camera.position=0,0,4 camera.target=0,0,9");
    expect_estimate(look_by_chance(s, 1), passes); /* the camera's ray is clear */
    scene_destroy(s);
}

/* --- single scattering --- */

/* The camera within a large box of the medium, with one lamp; no second scattering. */
static const char cloud_scene[] =
    "render: {width: 1, height: 1, depth: 0, integrator: path, paths: 65536, beyond: black}\n"
    "camera: {position: [0, 0, 0], target: [0, 0, 1], fov_deg: 0.001}\n"
    "background: {color: [0, 0, 0]}\n"
    "lights:\n"
    "  lamp: {position: [0.7, 0, 3], target: [-1, 0, 4], intensity: 2, reach: 1}\n"
    "solids:\n"
    "  cloud: {shape: box, transparency: 1, ior: 1, size: [40, 40, 20], scatter_per_m: 0.2,\n"
    "    absorb_per_m: [0.3, 0.1, 0], asymmetry: 0.6}\n";

typedef struct lit_point {
    const scene *s;
    double extinction, scatters;
    vec3 at;
} lit_point;

/* Light of irradiance E across a direction to the lamp, which is scattered towards -z; times sigma_s. */
static double scattered(const lit_point *p, vec3 to, double distance, double irradiance)
{
    const material *m = &p->s->solids[0].surface;
    return p->scatters * henyey_greenstein(to.z / vec3_length(to), m->asymmetry) * irradiance *
           exp(-p->extinction * distance);
}

static double by_point(const lit_point *p)
{
    const light *l = &p->s->lights[0];
    const vec3 to = vec3_sub(l->position, p->at), axis = vec3_normalize(vec3_sub(l->target, l->position));
    const double distance = vec3_length(to), cosine = -vec3_dot(axis, to) / distance,
                 edge = cos(l->half_angle_deg * PI / 180.0);
    const double share = l->kind == LIGHT_POINT  ? 1.0
                         : cosine < edge         ? 0.0
                         : l->kind == LIGHT_CONE ? 1.0
                                                 : (cosine - edge) / (1.0 - edge);
    const double falls = l->reach > 0.0 ? l->reach * l->reach / (distance * distance) : 1.0;
    return scattered(p, to, distance, PI * l->intensity * falls * share);
}

/* Over the cone of directions to the sphere, whose radiance is I reach^2 / radius^2. */
static double by_sphere(const lit_point *p)
{
    enum { STEPS = 48 };
    const light *l = &p->s->lights[0];
    const vec3 to = vec3_sub(l->position, p->at);
    const double distance = vec3_length(to), cap = 1.0 - sqrt(1.0 - pow(l->radius / distance, 2)),
                 radiance = l->intensity * pow(l->reach / l->radius, 2);
    const vec3 z = vec3_scale(to, 1.0 / distance), x = vec3_normalize(vec3_cross(z, vec3_make(0.3, 1.0, 0.2))),
               y = vec3_cross(z, x);
    double sum = 0.0;
    for (int i = 0; i < STEPS; i++)
        for (int k = 0; k < STEPS; k++) {
            const double cosine = 1.0 - cap * (i + 0.5) / STEPS, sine = sqrt(1.0 - cosine * cosine),
                         turn = 2.0 * PI * (k + 0.5) / STEPS;
            const vec3 d = vec3_add(vec3_scale(z, cosine),
                                    vec3_add(vec3_scale(x, sine * cos(turn)), vec3_scale(y, sine * sin(turn))));
            const double off = distance * sine, meets = distance * cosine - sqrt(l->radius * l->radius - off * off);
            sum += scattered(p, d, meets, radiance * 2.0 * PI * cap / (STEPS * STEPS));
        }
    return sum;
}

/* Over the points of a disc of radiance pi I reach^2 / area. */
static double by_disc(const lit_point *p)
{
    enum { STEPS = 48 };
    const light *l = &p->s->lights[0];
    const vec3 axis = vec3_normalize(vec3_sub(l->target, l->position)),
               x = vec3_normalize(vec3_cross(axis, vec3_make(0.0, 1.0, 0.0))), y = vec3_cross(axis, x);
    double sum = 0.0;
    for (int i = 0; i < STEPS; i++)
        for (int k = 0; k < STEPS; k++) {
            const double r = l->radius * sqrt((i + 0.5) / STEPS), turn = 2.0 * PI * (k + 0.5) / STEPS;
            const vec3 on = vec3_add(vec3_scale(x, r * cos(turn)), vec3_scale(y, r * sin(turn))),
                       to = vec3_sub(vec3_add(l->position, on), p->at);
            const double distance = vec3_length(to), cosine = -vec3_dot(axis, to) / distance;
            if (cosine > 0.0)
                sum += scattered(p, to, distance,
                                 PI * l->intensity * l->reach * l->reach * cosine / (distance * distance)) /
                       (STEPS * STEPS);
        }
    return sum;
}

/* The airlight integral through 10 units of the box, which begins at z = from, by the midpoint rule. */
static double airlight_of(const scene *s, int channel, double (*lit)(const lit_point *p), double from, int steps)
{
    const material *m = &s->solids[0].surface;
    const double absorbs[] = {m->absorb_per_m.x, m->absorb_per_m.y, m->absorb_per_m.z};
    double sum = 0.0;
    const double scatters = scattering_of(m, channel);
    lit_point p = {s, scatters + absorbs[channel], scatters, {0.0, 0.0, 0.0}};
    for (int i = 0; i < steps; i++) {
        const double depth = 10.0 * (i + 0.5) / steps;
        p.at.z = from + depth;
        sum += exp(-p.extinction * depth) * lit(&p) * 10.0 / steps;
    }
    return sum;
}

static void expect_airlight_from(double from, const char *assignments, bool by_channel,
                                 double (*lit)(const lit_point *p))
{
    scene *s = scene_from(cloud_scene);
    set_all(s, assignments);
    if (by_channel)
        scatter_by_channel(&s->solids[0].surface, 0.05, 0.2, 0.7);
    for (int c = 0; c < 3; c++) {
        const estimate e = look_by_chance(s, c);
        const double expected = airlight_of(s, c, lit, from, lit == by_point ? 2000000 : 1000);
        if (!(fabs(e.value - expected) <= 2e-3 * expected + e.t_9999 * e.standard_error) ||
            !(e.standard_error < 0.02 * expected))
            fail_msg("%s: %.6f +- %.2g instead of %.6f", assignments, e.value, e.standard_error, expected);
    }
    optical_data_release(s->solids[0].surface.scatter_values);
    scene_destroy(s);
}

static void expect_airlight(const char *assignments, double (*lit)(const lit_point *p))
{
    expect_airlight_from(0.0, assignments, false, lit);
}

static void beams_have_the_airlight_integral(void **state)
{
    (void)state;
    expect_airlight("lamp.kind=point", by_point);
    expect_airlight("lamp.kind=point lamp.reach=0 cloud.asymmetry=-0.7", by_point);
    expect_airlight("lamp.kind=cone lamp.half_angle_deg=20", by_point);
    expect_airlight("lamp.kind=cone lamp.half_angle_deg=0.2", by_point); /* narrow: found by chance only if aimed at */
    expect_airlight("lamp.kind=soft_cone lamp.half_angle_deg=70 lamp.target=0,0,0", by_point);
    expect_airlight("lamp.kind=point lamp.radius=0.3", by_sphere);
    expect_airlight("lamp.kind=disc lamp.radius=0.5", by_disc);
    /* the camera 2 units before the box */
    expect_airlight_from(2.0, "lamp.kind=point cloud.size.z=10 cloud.position=0,0,7", false, by_point);
    expect_airlight_from(0.0, "lamp.kind=point", true, by_point);
    expect_airlight_from(0.0, "lamp.kind=cone lamp.half_angle_deg=2", true, by_point);
    expect_airlight_from(0.0, "lamp.kind=point lamp.radius=0.3", true, by_sphere);
}

/* Narrow, wide, near and far ones, and those next to the path. */
static void extreme_beams_have_the_airlight_integral(void **state)
{
    ONLY_IN_CHECK();
    (void)state;
    expect_airlight("lamp.kind=point lamp.position=0.01,0,3", by_point);
    expect_airlight("lamp.kind=soft_cone lamp.half_angle_deg=100", by_point);
    expect_airlight("lamp.kind=cone lamp.half_angle_deg=10 lamp.position=0.05,0,-1 lamp.target=0,0,5", by_point);
    expect_airlight("lamp.kind=cone lamp.half_angle_deg=10 lamp.position=0.05,0,8 lamp.target=0,0,-5", by_point);
    expect_airlight(
        "lamp.kind=cone lamp.half_angle_deg=5e-3 lamp.position=2000,0,3 lamp.target=0,0,3 lamp.intensity=1e4 "
        "lamp.reach=0 "
        "cloud.size.x=5000 cloud.scatter_per_m=1e-3 cloud.absorb_per_m=0,0.001,0.002",
        by_point);
    expect_airlight("lamp.kind=point lamp.radius=0.65 cloud.asymmetry=0.95", by_sphere);
    /* ahead, where the path's own direction often meets them */
    expect_airlight("lamp.kind=point lamp.radius=0.9 lamp.position=0.95,0,7 cloud.asymmetry=0.8", by_sphere);
    expect_airlight("lamp.kind=disc lamp.radius=0.9 lamp.position=0.95,0,7 lamp.target=0.5,0,0 cloud.asymmetry=0.8",
                    by_disc);
}

/* Two lamps of which each point takes one at random. */
static void lamps_are_chosen_from_all_around(void **state)
{
    (void)state;
    scene *s = scene_from(cloud_scene);
    set_all(s, "lamp.kind=point lamp.position=0.7,0.1,3");
    const double one = look_by_chance(s, 1).value;
    set_all(s, "lamp.position=-0.9,-0.4,5 lamp.radius=0.3");
    const double both = one + look_by_chance(s, 1).value;
    scene_destroy(s);
    char text[1024];
    snprintf(text, sizeof text, "%.*s  other: {position: [0.7, 0.1, 3], intensity: 2, reach: 1}\n%s",
             (int)(strstr(cloud_scene, "solids:") - cloud_scene), cloud_scene, strstr(cloud_scene, "solids:"));
    s = scene_from(text);
    set_all(s, "lamp.kind=point lamp.position=-0.9,-0.4,5 lamp.radius=0.3");
    for (int k = 0; k < 2; k++) {
        set(s, k ? "render.light_sampling=one" : "render.light_sampling=all");
        const estimate e = look_by_chance(s, 1);
        if (!(fabs(e.value - both) <= 5e-3 * both + e.t_9999 * e.standard_error))
            fail_msg("%.6f +- %.2g instead of %.6f", e.value, e.standard_error, both);
    }
    scene_destroy(s);
}

/* A spectral film: absorption by wavelength along the way. Without dispersion or colours it is that of the rgb film
 * with the same absorption in all channels. */
static void a_spectral_film_scatters_alike(void **state)
{
    (void)state;
    scene *s = scene_from(cloud_scene);
    set_all(s, "lamp.kind=point cloud.absorb_per_m=0.1,0.1,0.1 render.paths=8192");
    const double rgb = look_by_chance(s, 1).value;
    set(s, "render.spectrum=spectral");
    const estimate e = look_by_chance(s, 1);
    assert_true(fabs(e.value - rgb) <= 5e-3 * rgb + e.t_95 * e.standard_error);
    scene_destroy(s);
}

/* Seen from outside the medium, with the radiance L / n^2 that is conserved at its face: the same paths, over n^2. */
static void basic_radiance_falls_at_the_face(void **state)
{
    (void)state;
    scene *s = scene_from(cloud_scene);
    set_all(s, "lamp.kind=point lamp.intensity=1000 cloud.ior=1.33 camera.position=0,0,-30 render.depth=1 "
               "render.paths=1024 render.radiance=classic");
    const double classic = look_by_chance(s, 2).value;
    set(s, "render.radiance=basic");
    assert_true(classic > 0.1 && fabs(look_by_chance(s, 2).value * 1.33 * 1.33 - classic) < 1e-4 * classic);
    scene_destroy(s);
}

static void photons_do_not_scatter(void **state)
{
    (void)state;
    scene *s = scene_from(cloud_scene);
    diagnostic why = {0};
    set(s, "render.caustics=photons");
    assert_int_equal(scene_check(s, &why), STATUS_BAD_INPUT);
    assert_non_null(strstr(why.what, "cloud: caustics by photons do not support its scattering medium"));
    set(s, "render.integrator=whitted");
    worked(scene_check(s, &why), &why);
    scene_destroy(s);
}

/* Light that is scattered many times: a furnace, Chandrasekhar's closed forms of a half space that scatters
 * evenly, and a slab against a Monte-Carlo of its own. */

/* A ball that scatters without loss, in uniform surroundings, is as bright as these: with and without an index of its
 * own, and with roulette. */
static void a_ball_in_a_furnace_is_invisible(void **state)
{
    (void)state;
    static const char *const variants[] = {"ball.ior=1", "ball.ior=1.33", "ball.ior=1 render.roulette=on",
                                           "ball.ior=1.33 render.radiance=basic", "ball.ior=1 ball.asymmetry=-0.9"};
    scene *s = scene_from("render: {width: 12, height: 9, depth: 64, integrator: path, paths: 256, beyond: black}\n"
                          "camera: {position: [0, 0, 4], target: [0, 0, 0], fov_deg: 30}\n"
                          "background: {color: [0.5, 0.6, 0.7]}\n"
                          "solids:\n"
                          "  ball: {shape: sphere, transparency: 1, ior: 1, scatter_per_m: 1.5, asymmetry: 0.6}\n");
    for (size_t i = 0; i < COUNT(variants); i++) {
        set_all(s, variants[i]);
        render_result *r = render(s);
        for (int k = 0; k < 12 * 9 * 3; k++) {
            const double sky = 0.5 + 0.1 * (k % 3), seen = (double)r->img->sum[k] / FILM_ONE;
            if (!(fabs(seen - sky) < 1e-3))
                fail_msg("%s: %.6f instead of %.2f", variants[i], seen, sky);
        }
        render_result_destroy(r);
    }
    scene_destroy(s);
}

/* So is one whose channels scatter differently, in the mean. */
static void a_colored_ball_in_a_furnace_is_invisible(void **state)
{
    (void)state;
    scene *s = scene_from("render: {width: 1, height: 1, depth: 64, integrator: path, paths: 65536, beyond: black}\n"
                          "camera: {position: [0, 0, 4], target: [0.3, 0, 0], fov_deg: 0.001}\n"
                          "background: {color: [0.5, 0.6, 0.7]}\n"
                          "solids: {ball: {shape: sphere, transparency: 1, ior: 1, asymmetry: 0.6}}\n");
    scatter_by_channel(&s->solids[0].surface, 0.2, 0.7, 2.0);
    for (int c = 0; c < 3; c++)
        expect_estimate(look_by_chance(s, c), 0.5 + 0.1 * c);
    optical_data_release(s->solids[0].surface.scatter_values);
    scene_destroy(s);
}

/* --- a half space --- */

enum { NODES = 600 };

/* H of a half space that scatters evenly with an albedo: Chandrasekhar, Radiative Transfer, 1960, V (16), in the form
 * 1 / H(mu) = sqrt(1 - albedo) + albedo / 2 times the integral of m H(m) / (mu + m) over m from 0 to 1. */
static double h_integral(double albedo, const double *h, double mu)
{
    double sum = 0.0;
    for (int i = 0; i < NODES; i++) {
        const double m = (i + 0.5) / NODES;
        sum += m * h[i] / (mu + m) / NODES;
    }
    return 1.0 / (sqrt(1.0 - albedo) + 0.5 * albedo * sum);
}

static double h_function(double albedo, double mu)
{
    double h[NODES], next[NODES];
    for (int i = 0; i < NODES; i++)
        h[i] = 1.0;
    for (int round = 0; round < 200; round++) {
        for (int i = 0; i < NODES; i++)
            next[i] = h_integral(albedo, h, (i + 0.5) / NODES);
        for (int i = 0; i < NODES; i++)
            h[i] = 0.5 * (h[i] + next[i]);
    }
    return h_integral(albedo, h, mu);
}

static void the_h_function_is_that_of_the_table(void **state)
{
    (void)state;
    assert_true(fabs(h_function(1.0, 1.0) - 2.9078) < 1e-3); /* Chandrasekhar, table XI */
}

/* The camera looks down on a half space at an angle of cosine mu. */
static scene *half_space(double albedo, double mu)
{
    scene *s = scene_from("render: {width: 1, height: 1, depth: 64, integrator: path, paths: 65536, beyond: black}\n"
                          "camera: {target: [0, 0, 0], fov_deg: 0.001}\n"
                          "background: {color: [0, 0, 0]}\n"
                          "lights: {lamp: {position: [0, 1000000, 0], intensity: 0}}\n"
                          "solids: {milk: {shape: plane, transparency: 1, ior: 1}}\n");
    s->camera.position = vec3_make(0.0, 5.0 * mu, -5.0 * sqrt(1.0 - mu * mu));
    s->solids[0].surface.scatter_per_m = 2.0 * albedo;
    s->solids[0].surface.absorb_per_m = vec3_make(2.0 - 2.0 * albedo, 2.0 - 2.0 * albedo, 2.0 - 2.0 * albedo);
    return s;
}

/* Its radiance under a white sky is its albedo for light from there, 1 - H(mu) sqrt(1 - albedo). */
static void a_half_space_has_its_plane_albedo(void **state)
{
    ONLY_IN_CHECK();
    (void)state;
    static const double albedos[] = {0.3, 0.8, 0.95}, cosines[] = {1.0, 0.6, 0.2};
    for (size_t a = 0; a < COUNT(albedos); a++)
        for (size_t c = 0; c < COUNT(cosines); c++) {
            scene *s = half_space(albedos[a], cosines[c]);
            set_all(s, "background.color=1,1,1");
            const double expected = 1.0 - h_function(albedos[a], cosines[c]) * sqrt(1.0 - albedos[a]);
            const estimate e = look_by_chance(s, 1);
            if (!(fabs(e.value - expected) <= 1e-3 + e.t_95 * e.standard_error))
                fail_msg("%g, %g: %.5f instead of %.5f", albedos[a], cosines[c], e.value, expected);
            scene_destroy(s);
        }
}

/* Its radiance in the light of a lamp far away, whose irradiance across its direction is pi I:
 * albedo / 4 mu0 / (mu + mu0) H(mu) H(mu0) I (Chandrasekhar III (123)). */
static void a_half_space_reflects_a_lamp(void **state)
{
    (void)state;
    static const double suns[] = {1.0, 0.5, 0.1};
    for (size_t i = 0; i < COUNT(suns); i++) {
        const double albedo = 0.8, mu = 0.6, sun = suns[i], far = 1e6;
        scene *s = half_space(albedo, mu);
        s->lights[0].intensity = 2.0;
        s->lights[0].position = vec3_make(far * sqrt(1.0 - sun * sun), far * sun, 0.0);
        const double expected =
            2.0 * 0.25 * albedo * sun / (mu + sun) * h_function(albedo, mu) * h_function(albedo, sun);
        const estimate e = look_by_chance(s, 1);
        if (!(fabs(e.value - expected) <= 2e-3 * expected + e.t_95 * e.standard_error))
            fail_msg("%g: %.5f +- %.2g instead of %.5f", sun, e.value, e.standard_error, expected);
        scene_destroy(s);
    }
}

/* --- a slab --- */

static double chance(uint64_t *state)
{
    *state = *state * 6364136223846793005U + 1442695040888963407U;
    return ((double)(*state >> 12) + 0.5) * 0x1p-52;
}

typedef struct shares {
    double passed, returned;
} shares;

/* Photons that fall straight on a slab of optical thickness `thick`: absorbed by chance at each of the events, and
 * turned by rejection from the phase function as it was printed; only the height and the cosine to the axis matter. */
static shares shares_of_slab(double thick, double albedo, double g)
{
    const int photons = 1000000;
    const double most = (1.0 - g * g) / pow(1.0 - g, 3);
    uint64_t state = 1;
    shares s = {0.0, 0.0};
    for (int i = 0; i < photons; i++) {
        double z = 0.0, mu = 1.0;
        for (;;) {
            z -= mu * log(chance(&state));
            if (z < 0.0 || z > thick || chance(&state) > albedo)
                break;
            double c;
            do
                c = 2.0 * chance(&state) - 1.0;
            while (chance(&state) * most > (1.0 - g * g) / pow(1.0 + g * g - 2.0 * g * c, 1.5));
            mu = mu * c + sqrt((1.0 - mu * mu) * (1.0 - c * c)) * cos(2.0 * PI * chance(&state));
            mu = fmin(fmax(mu, -1.0), 1.0);
        }
        s.passed += z > thick ? 1.0 / photons : 0.0;
        s.returned += z < 0.0 ? 1.0 / photons : 0.0;
    }
    return s;
}

/* Seen from one side: the ground behind shines, or the sky in front. */
static void a_slab_passes_and_returns_its_shares(void **state)
{
    (void)state;
    static const struct {
        double thick, albedo, g;
    } slabs[] = {{1.0, 1.0, 0.0}, {3.0, 0.9, 0.5}, {4.0, 0.98, 0.8}};
    scene *s = scene_from("render: {width: 1, height: 1, depth: 64, integrator: path, paths: 65536, beyond: black}\n"
                          "camera: {position: [0, 5, 0], target: [0, 0, 0], fov_deg: 0.001}\n"
                          "background: {color: [0, 0, 0]}\n"
                          "solids:\n"
                          "  slab: {shape: box, transparency: 1, ior: 1, position: [0, 2, 0], size: [9000, 1, 9000]}\n"
                          "  ground: {shape: plane, emission: 1}\n");
    for (size_t i = 0; i < COUNT(slabs); i++) {
        material *m = &s->solids[0].surface;
        const double absorbs = slabs[i].thick * (1.0 - slabs[i].albedo);
        m->scatter_per_m = slabs[i].thick * slabs[i].albedo, m->asymmetry = slabs[i].g;
        m->absorb_per_m = vec3_make(absorbs, absorbs, absorbs);
        const shares expected = shares_of_slab(slabs[i].thick, slabs[i].albedo, slabs[i].g);
        set_all(s, "ground.emission=1 background.color=0,0,0");
        const double passed = look_by_chance(s, 1).value;
        set_all(s, "ground.emission=0 background.color=1,1,1");
        const double returned = look_by_chance(s, 1).value;
        if (!(fabs(passed - expected.passed) < 3e-3 && fabs(returned - expected.returned) < 3e-3))
            fail_msg("%g: %.5f, %.5f instead of %.5f, %.5f", slabs[i].thick, passed, returned, expected.passed,
                     expected.returned);
    }
    scene_destroy(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_phase_function_has_its_moments),
        cmocka_unit_test(cosines_are_drawn_by_the_phase_function),
        cmocka_unit_test(what_passes_is_that_of_beer_and_lambert),
        cmocka_unit_test(channels_lose_their_own_share),
        cmocka_unit_test(a_wavelength_loses_its_own_share),
        cmocka_unit_test(lamps_lose_what_is_scattered),
        cmocka_unit_test(beams_have_the_airlight_integral),
        cmocka_unit_test(extreme_beams_have_the_airlight_integral),
        cmocka_unit_test(lamps_are_chosen_from_all_around),
        cmocka_unit_test(a_spectral_film_scatters_alike),
        cmocka_unit_test(basic_radiance_falls_at_the_face),
        cmocka_unit_test(photons_do_not_scatter),
        cmocka_unit_test(a_ball_in_a_furnace_is_invisible),
        cmocka_unit_test(a_colored_ball_in_a_furnace_is_invisible),
        cmocka_unit_test(the_h_function_is_that_of_the_table),
        cmocka_unit_test(a_half_space_has_its_plane_albedo),
        cmocka_unit_test(a_half_space_reflects_a_lamp),
        cmocka_unit_test(a_slab_passes_and_returns_its_shares),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
