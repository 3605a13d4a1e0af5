/* Tests of caustics by photons, against closed forms: an image source behind a mirror, a slab, and a glass ball whose
 * light a meridional ray tracer of this file follows. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "photon_fixture.h"
#include "render/caustics/emission.h"
#include "scene/model/scene.h"
#include <stdlib.h>

#define PI 3.14159265358979323846
#define COUNT(a) (sizeof(a) / sizeof((a)[0]))
#define assert_near(a, b, tolerance)                                    \
    do {                                                                \
        if (!(fabs((a) - (b)) <= (tolerance)))                          \
            fail_msg("%.9g instead of %.9g", (double)(a), (double)(b)); \
    } while (0)

/* The mean over the image, first channel. */
static double mean_of(const scene *s)
{
    render_result *r = render(s);
    double sum = 0.0;
    const int pixels = r->img->width * r->img->height;
    for (int i = 0; i < pixels; i++)
        sum += (double)r->img->sum[3 * i] / FILM_ONE;
    render_result_destroy(r);
    return sum / pixels;
}

/* A camera close above the ground at x = 1 sees about 0.2 scene units of it. */
#define PATCH                                                                         \
    "render: {width: 12, height: 12, depth: 8, caustics: photons, photons: 200000}\n" \
    "camera: {position: [1, 0.5, 0], target: [1, 0, 0.0001], fov_deg: 20}\n"          \
    "background: {color: [0, 0, 0], ambient: [0, 0, 0]}\n"
#define PATCH_SIDE (2.0 * 0.5 * 0.17632698070846498) /* 2 h tan(10 deg) */

/* Phong's I = k_d C I_L (N.L) reach^2 / d^2 of a source at (x, y, 0), averaged over the patch. */
static double lit_by(double x, double y, double reach)
{
    double sum = 0.0;
    int count = 0;
    for (double u = -0.45; u < 0.5; u += 0.1)
        for (double v = -0.45; v < 0.5; v += 0.1, count++) {
            const double dx = 1.0 + u * PATCH_SIDE - x, dz = v * PATCH_SIDE, d2 = dx * dx + y * y + dz * dz;
            sum += y / sqrt(d2) * (reach > 0.0 ? reach * reach / d2 : 1.0);
        }
    return sum / count;
}

/* A mirror at x = 3 shows the lamp at x = 6. Also of a lamp whose light does not fall off, and through a path. */
static void a_mirror_is_an_image_source(void **state)
{
    (void)state;
    static const char scene_text[] = PATCH "lights: {lamp: {position: [0, 2, 0], intensity: 1.5}}\n"
                                           "solids:\n"
                                           "  ground: {shape: plane, diffuse: 0.5}\n"
                                           "  mirror: {shape: box, position: [3.5, 1, 0], size: [1, 3, 3],\n"
                                           "    reflectivity: 0.8}\n";
    scene *s = scene_from(scene_text);
    for (int falls = 0; falls < 2; falls++) {
        const double reach = falls ? 2.5 : 0.0;
        set(s, falls ? "lamp.reach=2.5" : "lamp.reach=0");
        const double expected = 0.5 * 1.5 * (lit_by(0.0, 2.0, reach) + 0.8 * lit_by(6.0, 2.0, reach));
        set(s, "render.integrator=whitted");
        assert_near(mean_of(s), expected, 0.004 * expected);
        set(s, "render.integrator=raycast");
        assert_near(mean_of(s), expected, 0.004 * expected);
        set(s, "lamp.color=1,0,0"); /* a channel does not depend on the others */
        assert_near(mean_of(s), expected, 0.004 * expected);
        set(s, "lamp.color=1,1,1");
    }
    scene_destroy(s);
}

/* At normal incidence a lossless slab of index n and thickness t moves the lamp closer by t (1 - 1 / n), and passes
 * (1 - R) / (1 + R) with all reflections within it, R = ((n - 1) / (n + 1))^2 (Born and Wolf, 1.5.2). */
static void a_slab_moves_the_lamp_closer(void **state)
{
    (void)state;
    static const char scene_text[] =
        "render: {width: 8, height: 8, depth: 8, caustics: photons, photons: 400000, integrator: raycast}\n"
        "camera: {position: [0, 0.5, 0], target: [0, 0, 0.0001], fov_deg: 10}\n"
        "background: {color: [0, 0, 0], ambient: [0, 0, 0]}\n"
        "lights: {lamp: {position: [0, 8, 0], intensity: 1, reach: 8}}\n"
        "solids:\n"
        "  ground: {shape: plane, diffuse: 1}\n"
        "  slab: {shape: box, position: [0, 2, 0], size: [1.5, 1, 1.5], transparency: 1, ior: 1.6}\n";
    scene *s = scene_from(scene_text);
    const double apparent = 8.0 - 1.0 + 1.0 / 1.6, r = 0.6 * 0.6 / (2.6 * 2.6),
                 expected = 64.0 / (apparent * apparent) * (1.0 - r) / (1.0 + r);
    assert_near(mean_of(s), expected, 0.005 * expected);
    set(s, "render.spectrum=spectral");
    set(s, "render.photons=1000000");
    set(s, "render.width=24");
    set(s, "render.height=24");
    /* daylight's white in XYZ: its X is 0.9505 */
    assert_near(mean_of(s), 0.9505 * expected, 0.01 * expected);
    scene_destroy(s);
}

/* Through a slab at 70 degrees: the mean of both polarisations, each (1 - R) / (1 + R), with polarisation; without, the
 * same of their mean reflectance (Born and Wolf, 1.5.2). */
static void photons_are_polarised(void **state)
{
    (void)state;
    static const char scene_text[] =
        "render: {width: 16, height: 16, depth: 8, caustics: photons, photons: 400000, integrator: raycast}\n"
        "camera: {position: [0, 0.3, 0], target: [0, 0, 0.0001], fov_deg: 60}\n"
        "background: {color: [0, 0, 0], ambient: [0, 0, 0]}\n"
        "lights: {lamp: {position: [939.6926207859084, 342.02014332566876, 0], intensity: 1, reach: 1000}}\n"
        "solids:\n"
        "  ground: {shape: plane, diffuse: 1}\n"
        "  slab: {shape: box, position: [1, 0.45, 0], size: [6, 0.2, 1], transparency: 1, ior: 1.5}\n";
    scene *s = scene_from(scene_text);
    const double cos_i = 0.3420201433256687, cos_t = sqrt(1.0 - (1.0 - cos_i * cos_i) / 2.25),
                 r_s = (cos_i - 1.5 * cos_t) / (cos_i + 1.5 * cos_t),
                 r_p = (1.5 * cos_i - cos_t) / (1.5 * cos_i + cos_t), a = r_s * r_s, b = r_p * r_p,
                 mean = 0.5 * (a + b);
    const double without = cos_i * (1.0 - mean) / (1.0 + mean),
                 with = cos_i * 0.5 * ((1.0 - a) / (1.0 + a) + (1.0 - b) / (1.0 + b));
    assert_true(with > 1.02 * without);
    assert_near(mean_of(s), without, 0.006 * without);
    set(s, "render.polarisation=on");
    assert_near(mean_of(s), with, 0.006 * with);
    scene_destroy(s);
}

/* The sun, half a degree wide, over the slab: an even light, of which (1 - R) / (1 + R) passes. A lamp that is larger
 * than what it shines on; also of two slabs, the upper of which the lower one's cone overlaps. */
static void the_sun_passes_a_slab(void **state)
{
    (void)state;
    static const char scene_text[] =
        "render: {width: 16, height: 16, depth: 4, caustics: photons, photons: 300000, integrator: path, paths: 16}\n"
        "camera: {position: [0, 0.5, 0], target: [0, 0, 0.0001], fov_deg: 60}\n"
        "background: {color: [0, 0, 0], ambient: [0, 0, 0]}\n"
        "lights: {sun: {position: [0, 10000, 0], intensity: 0.7, reach: 10000, radius: 46.5}}\n"
        "solids:\n"
        "  ground: {shape: plane, diffuse: 0.02}\n"
        "  slab: {shape: box, position: [0, 2, 0], size: [1.5, 1, 1.5], transparency: 1, ior: 1.6}\n"
        "  upper: {shape: box, position: [0, 5, 0], size: [1, 0.2, 1], transparency: 1, ior: 1.5, visible: off}\n";
    scene *s = scene_from(scene_text);
    const double r = 0.6 * 0.6 / (2.6 * 2.6), q = 0.5 * 0.5 / (2.5 * 2.5), passes = (1.0 - r) / (1.0 + r),
                 too = (1.0 - q) / (1.0 + q);
    assert_near(mean_of(s), 0.014 * passes, 0.0002 * passes);
    set(s, "upper.visible=on");
    /* parallel plates: 1 / T = 1 / T_1 + 1 / T_2 - 1 */
    const double both = 1.0 / (1.0 / passes + 1.0 / too - 1.0);
    assert_near(mean_of(s), 0.014 * both, 0.0003 * both); /* half a percent of noise */
    scene_destroy(s);
}

/* A lamp so large that random paths find it through the slab: with photons they leave its light to these, and the mean
 * is the same. */
static void paths_leave_the_light_to_the_photons(void **state)
{
    (void)state;
    scene *s = scene_from("render: {width: 12, height: 12, depth: 8, integrator: path, paths: 1024, photons: 400000}\n"
                          "camera: {position: [0, 0.5, 0], target: [0, 0, 0.0001], fov_deg: 60}\n"
                          "background: {color: [0, 0, 0], ambient: [0, 0, 0]}\n"
                          "lights: {lamp: {position: [0, 7, 0], intensity: 1, reach: 7, radius: 2}}\n"
                          "solids:\n"
                          "  ground: {shape: plane, diffuse: 0.8}\n"
                          "  slab: {shape: box, position: [0, 2, 0], size: [3, 1, 3], transparency: 1, ior: 1.6}\n");
    const double without = mean_of(s);
    assert_true(without > 0.3);
    set_all(s, "render.caustics=photons render.paths=64");
    assert_near(mean_of(s), without, 0.06 * without); /* the noise of the 1200 photons that arrive: 3 % */
    scene_destroy(s);
}

/* --- a ball --- */

/* A lamp at height LAMP above the centre of a ball of radius 1, the ground at depth GROUND below it. */
#define LAMP 6.0
#define GROUND 1.5
#define INDEX 1.5
enum { RINGS = 12, ORDERS = 12, STEPS = 400000 };

static double reflectance(double cos_i, double n)
{
    const double cos_t = sqrt(1.0 - (1.0 - cos_i * cos_i) / (n * n)), s = (cos_i - n * cos_t) / (cos_i + n * cos_t),
                 p = (n * cos_i - cos_t) / (n * cos_i + cos_t);
    return 0.5 * (s * s + p * p);
}

/* Adds the flux of a ray in the meridional plane, from (x, y) along the angle `way` from straight down. */
static void land(double x, double y, double way, double flux, double *rings, double *all)
{
    if (!(cos(way) > 0.0) || y < -GROUND)
        return;
    const double at = fabs(x + (y + GROUND) * tan(way));
    *all += flux;
    if (at < 2.0)
        rings[(int)(at / 2.0 * RINGS)] += flux;
}

/* Light that leaves the lamp at angle a meets the ball at incidence i, is reflected or refracted to r, and with each
 * reflection within the ball turns by pi - 2 r. */
static void follow(double a, double flux, double *rings, double *all)
{
    const double b = LAMP * sin(a); /* the distance of the ray from the centre */
    const double i = asin(b), r = asin(b / INDEX), share = reflectance(cos(i), INDEX);
    double place = i - a; /* the angle of the point, from straight up towards the ray's side */
    double power = (1.0 - share) * (1.0 - share);
    /* outside: the normal is at `place`, and the ray turns by pi - 2 i */
    land(sin(place), cos(place), PI - place - i, share * flux, rings, all);
    for (int k = 0; k < ORDERS; k++, power *= share) {
        place += PI - 2.0 * r; /* the chord to the next point */
        /* the ray leaves at angle i from the normal, on the far side */
        land(sin(place), cos(place), PI - (place + i), power * flux, rings, all);
    }
}

static double expected_flux(double *rings)
{
    double all = 0.0;
    const double widest = asin(1.0 / LAMP);
    for (int k = 0; k < RINGS; k++)
        rings[k] = 0.0;
    for (int k = 0; k < STEPS; k++) {
        const double a = (k + 0.5) / STEPS * widest;
        follow(a, 2.0 * PI * sin(a) * widest / STEPS, rings, &all);
    }
    return all;
}

static void a_ball_focuses_as_a_forward_tracer_says(void **state)
{
    (void)state;
    scene *s = scene_from("render: {caustics: photons, photons: 400000}\n"
                          "lights: {lamp: {position: [0, 7.5, 0], intensity: 1, reach: 1}}\n"
                          "solids:\n"
                          "  ground: {shape: plane, diffuse: 1}\n"
                          "  ball: {shape: sphere, position: [0, 1.5, 0], radius: 1, transparency: 1, ior: 1.5}\n");
    plan *p = NULL;
    double rings[RINGS], found[RINGS] = {0.0}, seen = 0.0;
    const double all = expected_flux(rings);
    assert_int_equal(plan_build(s, &p, NULL), STATUS_OK);
    caustics *c = photons_of(p);
    for (size_t i = 0; i < photon_map_count(p->photons); i++) {
        const photon *one = photon_map_at(p->photons, i);
        const double at = hypot(one->position.x, one->position.z);
        seen += (double)one->flux[0];
        if (at < 2.0)
            found[(int)(at / 2.0 * RINGS)] += (double)one->flux[0];
    }
    assert_near(seen, all, 1e-3 * all);
    for (int k = 0; k < RINGS; k++)
        assert_near(found[k], rings[k], 0.005 * rings[k] + 2e-4 * all);
    /* and by discs: flux within rings where light is even */
    for (int k = 3; k < RINGS; k++) {
        double sum = 0.0;
        const double step = 2.0 / RINGS / 40.0;
        for (int j = 0; j < 40; j++) {
            const double at = 2.0 * k / RINGS + (j + 0.5) * step;
            for (int turn = 0; turn < 60; turn++)
                sum += photon_map_irradiance(p->photons,
                                             vec3_make(at * cos(turn * PI / 30.0), 0.0, at * sin(turn * PI / 30.0)),
                                             vec3_make(0.0, 1.0, 0.0), -1)
                           .x *
                       2.0 * PI * at * step / 60.0;
        }
        assert_near(sum, rings[k], 0.05 * rings[k] + 5e-4 * all);
    }
    caustics_destroy(c);
    plan_destroy(p);
    scene_destroy(s);
}

/* Of light that no solid absorbs, all arrives: a closed matte room around a glass ball and a mirror receives what the
 * lamp sends to them. */
static void no_light_is_lost(void **state)
{
    (void)state;
    scene *s = scene_from("render: {caustics: photons, photons: 100000}\n"
                          "lights: {lamp: {position: [0, 3, 0], intensity: 1, reach: 1}}\n"
                          "solids:\n"
                          "  floor: {shape: plane, diffuse: 1, position: [0, -5, 0]}\n"
                          "  roof: {shape: plane, diffuse: 1, position: [0, 9, 0], rotation: [180, 0, 0]}\n"
                          "  left: {shape: box, diffuse: 1, position: [-10, 0, 0], size: [2, 60, 60]}\n"
                          "  right: {shape: box, diffuse: 1, position: [10, 0, 0], size: [2, 60, 60]}\n"
                          "  front: {shape: box, diffuse: 1, position: [0, 0, -10], size: [60, 60, 2]}\n"
                          "  back: {shape: box, diffuse: 1, position: [0, 0, 10], size: [60, 60, 2]}\n"
                          "  ball: {shape: sphere, position: [0.5, 0, 0], radius: 1, transparency: 1, ior: 1.5}\n");
    plan *p = NULL;
    assert_int_equal(plan_build(s, &p, NULL), STATUS_OK);
    caustics *c = photons_of(p);
    double seen = 0.0;
    for (size_t i = 0; i < photon_map_count(p->photons); i++)
        seen += (double)photon_map_at(p->photons, i)->flux[0];
    const double d2 = 0.5 * 0.5 + 3.0 * 3.0, angle = 2.0 * PI * (1.0 - sqrt(1.0 - 1.0 / d2));
    assert_near(seen, angle, 1e-3 * angle);
    caustics_destroy(c);
    plan_destroy(p);
    scene_destroy(s);
}

/* --- the rod in the vessel, in a matte room --- */

#define ROOM_SCENE                                                                                                   \
    "render: {caustics: photons, photons: 400000}\n"                                                                 \
    "lights: {lamp: {position: [4, 7, -5], intensity: 1, reach: 1}}\n"                                               \
    "solids:\n"                                                                                                      \
    "  ground: {shape: plane, diffuse: 1, priority: 0}\n"                                                            \
    "  roof: {shape: plane, diffuse: 1, position: [0, 20, 0], rotation: [180, 0, 0]}\n"                              \
    "  left: {shape: box, diffuse: 1, position: [-20, 0, 0], size: [2, 80, 80]}\n"                                   \
    "  right: {shape: box, diffuse: 1, position: [20, 0, 0], size: [2, 80, 80]}\n"                                   \
    "  front: {shape: box, diffuse: 1, position: [0, 0, -20], size: [80, 80, 2]}\n"                                  \
    "  back: {shape: box, diffuse: 1, position: [0, 0, 20], size: [80, 80, 2]}\n"                                    \
    "  vessel: {shape: cup, transparency: 1, ior: 1.5, position: [0, 0.001, 0], radius: 1, inner_radius: 0.9,\n"     \
    "           height: 3, floor: 0.1, priority: 2}\n"                                                               \
    "  liquid: {shape: cylinder, transparency: 1, ior: 1.33, position: [0, 0.051, 0], radius: 0.95, height: 1.95,\n" \
    "           priority: 1}\n"                                                                                      \
    "  rod: {shape: box, diffuse: 1, position: [0.2, 2.101, 0], size: [0.25, 3, 0.25], priority: 3}\n"

/* Where the line o + t d is in an upright cylinder around the y axis: from *in to *out, or false. */
static bool crosses_cylinder(vec3 o, vec3 d, double radius, double low, double high, double *in, double *out)
{
    const double a = d.x * d.x + d.z * d.z, b = o.x * d.x + o.z * d.z, c = o.x * o.x + o.z * o.z - radius * radius;
    const double root = b * b - a * c, t_low = (low - o.y) / d.y, t_high = (high - o.y) / d.y;
    if (!(root > 0.0))
        return false;
    *in = fmax((-b - sqrt(root)) / a, fmin(t_low, t_high));
    *out = fmin((-b + sqrt(root)) / a, fmax(t_low, t_high));
    return *in < *out;
}

/* Where it enters the rod, or INFINITY. */
static double meets_rod(vec3 o, vec3 d)
{
    const double low[3] = {0.075, 0.601, -0.125}, high[3] = {0.325, 3.601, 0.125};
    const double from[3] = {o.x, o.y, o.z}, way[3] = {d.x, d.y, d.z};
    double in = 0.0, out = INFINITY;
    for (int k = 0; k < 3; k++) {
        const double a = (low[k] - from[k]) / way[k], b = (high[k] - from[k]) / way[k];
        in = fmax(in, fmin(a, b)), out = fmin(out, fmax(a, b));
    }
    return in < out ? in : INFINITY;
}

/* Whether light from o along d, downwards, meets glass or liquid before the rod. What enters by the mouth meets the
 * inner wall or the liquid, whose level is y = 2.001. */
static bool meets_clear(vec3 o, vec3 d)
{
    double in, out, hollow_in, hollow_out;
    if (!crosses_cylinder(o, d, 1.0, 0.001, 3.001, &in, &out))
        return false;
    if (crosses_cylinder(o, d, 0.9, 2.001, 3.001, &hollow_in, &hollow_out) && hollow_in <= in)
        in = hollow_out;
    return in < meets_rod(o, d);
}

/* The solid angle, from the lamp, of directions whose light first meets glass or liquid: midpoints of a fine grid over
 * a cone around the vessel. */
static double solid_angle_of_vessel(void)
{
    enum { ROWS = 1500 };
    const vec3 lamp = vec3_make(4.0, 7.0, -5.0), axis = vec3_normalize(vec3_sub(vec3_make(0.0, 1.5, 0.0), lamp));
    const vec3 x = vec3_normalize(vec3_cross(axis, vec3_make(0.0, 1.0, 0.0))), y = vec3_cross(x, axis);
    const double widest = 1.0 - cos(0.25); /* 2 / sqrt(71) = 0.237 rad surround it */
    long met = 0;
    for (int i = 0; i < ROWS; i++)
        for (int j = 0; j < ROWS; j++) {
            const double c = 1.0 - widest * (i + 0.5) / ROWS, s = sqrt(1.0 - c * c), turn = 2.0 * PI * (j + 0.5) / ROWS;
            met += meets_clear(lamp, vec3_add(vec3_scale(axis, c),
                                              vec3_add(vec3_scale(x, s * cos(turn)), vec3_scale(y, s * sin(turn)))));
        }
    return 2.0 * PI * widest * (double)met / ROWS / ROWS;
}

/* All light that the lamp sends to glass and water arrives somewhere: on the ground in the shadow and around it, on the
 * rod, on the walls of a room around, however often the wall of the vessel reflects it. */
static void the_vessel_loses_no_light(void **state)
{
    (void)state;
    scene *s = scene_from(ROOM_SCENE);
    plan *p = NULL;
    assert_int_equal(plan_build(s, &p, NULL), STATUS_OK);
    caustics *c = photons_of(p);
    double seen = 0.0;
    for (size_t i = 0; i < photon_map_count(p->photons); i++)
        seen += (double)photon_map_at(p->photons, i)->flux[0];
    const double angle = solid_angle_of_vessel();
    printf("# %zu photons, %.6f of %.6f, ratio - 1 = %.2e\n", photon_map_count(p->photons), seen, angle,
           seen / angle - 1.0);
    assert_near(seen, angle, 1e-3 * angle);
    caustics_destroy(c);
    plan_destroy(p);
    scene_destroy(s);
}

/* --- determinism --- */

static const char *const variants[] = {
    "render.photons=3000 lamp.reach=9",
    "render.photons=3000 vessel.absorb_per_m=1,2,3 render.polarisation=on",
    "render.photons=3000 render.integrator=path render.paths=4 lamp.radius=0.4 lamp.reach=9",
    "render.photons=3000 render.spectrum=spectral render.wavelengths=5 liquid.medium=water",
};

static void films_are_bit_identical(void **state)
{
    (void)state;
    static const int threads[] = {1, 2, 5};
    for (size_t v = 0; v < COUNT(variants); v++) {
        scene *s = rod_scene("render.width=40 render.height=30 render.depth=5 render.caustics=photons");
        set_all(s, variants[v]);
        uint64_t hash = 0, rays = 0;
        for (int level = ISA_BASE; level <= (int)isa_best(); level++)
            for (size_t t = 0; t < COUNT(threads); t++) {
                s->render.threads = threads[t];
                render_result *r = render_at(s, (isa)level, NULL);
                if (!hash)
                    hash = film_hash(r->img), rays = r->counters.photon;
                assert_true(film_hash(r->img) == hash);
                assert_true(r->counters.photon == rays && (rays > 0 || !CUVETTE_COUNTERS));
                render_result_destroy(r);
            }
        scene_destroy(s);
    }
}

/* Without anything that deflects light, the film is that of opaque shadows. */
/* --- moved scenes --- */

static const char ball_scene[] =
    "render: {width: 32, height: 24, depth: 6, caustics: photons, photons: 20000}\n"
    "camera: {position: [0.5, 3, -5], target: [0.2, 0.5, 0.3]}\n"
    "background: {color: [0, 0, 0], ambient: [0, 0, 0]}\n"
    "lights: {lamp: {position: [2, 5, 3], intensity: 1, reach: 5}}\n"
    "solids:\n"
    "  ground: {shape: plane, diffuse: 0.8}\n"
    "  ball: {shape: sphere, position: [0.3, 0.9, 0.1], radius: 0.7, transparency: 1, ior: 1.5}\n";

static void move_point(vec3 *p, vec3 by, bool turned)
{
    *p = vec3_add(turned ? vec3_make(p->z, p->y, -p->x) : *p, by);
}

/* The image of the scene after a quarter of a turn about y, a move, or with other random numbers. */
static render_result *render_moved(vec3 by, bool turned, int64_t seed)
{
    scene *s = scene_from(ball_scene);
    move_point(&s->camera.position, by, turned);
    move_point(&s->camera.target, by, turned);
    move_point(&s->lights[0].position, by, turned);
    for (size_t i = 0; i < s->solid_count; i++)
        move_point(&s->solids[i].shape.position, by, turned);
    s->render.seed = seed;
    render_result *r = render(s);
    scene_destroy(s);
    return r;
}

/* Root mean square of the differences over the mean, and the ratio of the means. */
static double apart(const render_result *a, const render_result *b, double *ratio)
{
    double squares = 0.0, sum[2] = {0.0, 0.0};
    const int count = a->img->width * a->img->height;
    for (int i = 0; i < count; i++) {
        const double x = film_value(a->img, i % a->img->width, i / a->img->width, 1),
                     y = film_value(b->img, i % a->img->width, i / a->img->width, 1);
        squares += (x - y) * (x - y), sum[0] += x, sum[1] += y;
    }
    *ratio = sum[1] / sum[0];
    return sqrt(squares / count) * count / sum[0];
}

/* The light stays. Its noise is another one after a turn, since directions are drawn along the axes of the world, along
 * which photons become one, too: within 0.3 of their radius, which moves the peak of light by up to a fiftieth. After a
 * move it is nearly the same: only rounding tells the scenes apart. */
static void only_the_noise_of_a_moved_scene_may_differ(void **state)
{
    (void)state;
    static const vec3 moves[] = {{3.0, 0.0, 5.0}, {1000.0, 0.0, 0.0}, {0.1, 0.0, -0.7}};
    const vec3 none = {0.0, 0.0, 0.0};
    double ratio;
    render_result *here = render_moved(none, false, 1), *other = render_moved(none, false, 2),
                  *turned = render_moved(none, true, 1);
    const double noise = apart(here, other, &ratio);
    assert_true(noise > 1e-3 && fabs(ratio - 1.0) < 0.01);
    const double of_turn = apart(here, turned, &ratio);
    print_message("noise %.4f, turned %.4f, ratio %.5f\n", noise, of_turn, ratio);
    double peak = 0.0, worst = 0.0;
    for (int i = 0; i < 32 * 24; i++) {
        const double x = film_value(here->img, i % 32, i / 32, 1);
        peak = fmax(peak, x);
        worst = fmax(worst, fabs(x - film_value(turned->img, i % 32, i / 32, 1)));
    }
    assert_true(worst < 0.03 * peak && fabs(ratio - 1.0) < 0.01);
    for (size_t k = 0; k < COUNT(moves); k++) {
        render_result *moved = render_moved(moves[k], false, 1);
        const double of_move = apart(here, moved, &ratio);
        print_message("moved %.2g, ratio %.9f\n", of_move, ratio);
        assert_true(of_move < 0.1 * noise && fabs(ratio - 1.0) < 1e-4);
        render_result_destroy(moved);
    }
    render_result_destroy(here);
    render_result_destroy(other);
    render_result_destroy(turned);
}

static void photons_change_nothing_without_mirrors_and_clear_solids(void **state)
{
    (void)state;
    scene *s = rod_scene("render.width=40 render.height=30 vessel.visible=off liquid.visible=off");
    render_result *without = render(s);
    set(s, "render.caustics=photons");
    render_result *with = render(s);
    assert_true(film_hash(with->img) == film_hash(without->img));
    assert_true(with->counters.photon == 0);
    render_result_destroy(without);
    render_result_destroy(with);
    scene_destroy(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(only_the_noise_of_a_moved_scene_may_differ),
        cmocka_unit_test(a_mirror_is_an_image_source),
        cmocka_unit_test(a_slab_moves_the_lamp_closer),
        cmocka_unit_test(photons_are_polarised),
        cmocka_unit_test(the_sun_passes_a_slab),
        cmocka_unit_test(paths_leave_the_light_to_the_photons),
        cmocka_unit_test(a_ball_focuses_as_a_forward_tracer_says),
        cmocka_unit_test(no_light_is_lost),
        cmocka_unit_test(the_vessel_loses_no_light),
        cmocka_unit_test(films_are_bit_identical),
        cmocka_unit_test(photons_change_nothing_without_mirrors_and_clear_solids),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
