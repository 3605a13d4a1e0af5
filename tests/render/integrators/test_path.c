/* Tests of random paths against Whitted ray tracing where both compute the same light, and elsewhere against closed
 * forms. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "path_fixture.h"
#include "scene/model/scene.h"

#define COUNT(a) (sizeof(a) / sizeof((a)[0]))

static const char *sampler; /* of all scenes */

/* Through the centres of the pixels, for which closed forms and Whitted ray tracing are exact. */
static scene *path_scene(const char *text)
{
    scene *s = scene_from(text);
    set(s, "render.filter=centre");
    set(s, sampler);
    return s;
}

/* --- the whole tree, sampled at random --- */

static const char clear_scene[] =
    "render: {width: 32, height: 24, depth: 6, shadows: off}\n"
    "camera: {position: [0.3, 2.5, -5], target: [0, 1, 0], fov_deg: 40}\n"
    "background: {kind: gradient, color: [1, 0.2, 0.5], horizon: [0.1, 0.9, 0.4]}\n"
    "materials: {clear: {transparency: 1}}\n"
    "solids:\n"
    "  vessel: {shape: cup, material: clear, ior: 1.5, radius: 1, inner_radius: 0.9, height: 3, floor: 0.1, priority: "
    "2}\n"
    "  liquid: {shape: cylinder, material: clear, ior: 1.33, position: [0, 0.05, 0], radius: 0.95, height: 1.95, "
    "priority: 1}\n"
    "  ball: {shape: sphere, material: clear, ior: 2.4, position: [0.2, 1.2, 0.1], radius: 0.5, priority: 3}\n"
    "  block: {shape: box, material: clear, ior: 1.6, transparency: 0.8, position: [-1.5, 0.5, -1], size: [0.8, 1, "
    "0.8], "
    "rotation: [10, 20, 30], priority: 5}\n"
    "  mirror: {shape: sphere, reflectivity: 0.9, position: [1.7, 0.5, -1], radius: 0.4, priority: 6}\n";

static void paths_through_clear_solids_have_the_mean_of_whitted_ray_tracing(void **state)
{
    (void)state;
    scene *s = path_scene(clear_scene);
    static const char *const settings[] = {"render.paths=512 render.depth=6", "render.paths=512 render.depth=2",
                                           "render.paths=512 render.depth=12 render.beyond=black render.roulette=on",
                                           "render.paths=512 render.depth=6 render.samples=4 render.beyond=sky"};
    for (size_t k = 0; k < COUNT(settings); k++)
        expect_mean_of_trees(s, settings[k]);
    scene_destroy(s);
}

/* Under a black sky a matte floor is lit only by the lamp, and a mirror involves no random choice. */
static const char certain_scene[] = "render: {width: 32, height: 24, depth: 5, integrator: path, paths: 16}\n"
                                    "camera: {position: [0.3, 2.5, -5], target: [0, 1, 0], fov_deg: 50}\n"
                                    "background: {color: [0, 0, 0]}\n"
                                    "lights: {lamp: {position: [3, 7, -4], intensity: 0.8, color: [1, 0.7, 0.4]}}\n"
                                    "solids:\n"
                                    "  floor: {shape: plane, color: [0.8, 0.5, 0.3], checker: 0.7, checker_color: "
                                    "[0.1, 0.2, 0.9], diffuse: 0.7, specular: 0.3}\n";

static void deterministic_light_is_exact(void **state)
{
    (void)state;
    scene *s = path_scene(certain_scene);
    assert_int_equal(agree(s, "lamp.reach=0", ROUNDINGS).count, 0);
    assert_int_equal(agree(s, "lamp.reach=5", ROUNDINGS).count, 0);
    set_all(s, "floor.diffuse=0 floor.reflectivity=0.7 background.kind=gradient background.color=1,0.5,0.2");
    assert_int_equal(agree(s, "render.depth=0", ROUNDINGS).count, 0);
    assert_int_equal(agree(s, "render.depth=3", ROUNDINGS).count, 0);
    scene_destroy(s);
}

/* render.lighting affects only trees: paths have the same light under each, including highlights of point lights. */
static void paths_have_highlights_under_every_lighting(void **state)
{
    (void)state;
    static const char *const rules[] = {"render.lighting=lambert", "render.lighting=phong"};
    scene *s = path_scene(certain_scene);
    render_result *expected = render(s);
    for (size_t k = 0; k < COUNT(rules); k++) {
        set(s, rules[k]);
        render_result *r = render(s);
        assert_true(film_hash(r->img) == film_hash(expected->img));
        render_result_destroy(r);
    }
    render_result_destroy(expected);
    /* At normal incidence R.V is 1: k_s I C of the lamp behind the camera, and nothing else without k_d. */
    set_all(
        s,
        "floor.diffuse=0 camera.position=0,2,0 camera.target=0,0,0 lamp.position=0,7,0 render.width=1 render.height=1");
    for (size_t k = 0; k < COUNT(rules); k++) {
        set(s, rules[k]);
        const vec3 seen = look(s);
        assert_true(fabs(seen.x - 0.24) < ROUNDINGS && fabs(seen.y - 0.168) < ROUNDINGS &&
                    fabs(seen.z - 0.096) < ROUNDINGS);
    }
    scene_destroy(s);
}

/* --- matte and mirror in one --- */

static const char glossy_scene[] = "render: {width: 1, height: 1, depth: 1, integrator: path, paths: 65536}\n"
                                   "camera: {position: [0, 3, -3], target: [0, 0, 0], fov_deg: 0.01}\n"
                                   "background: {kind: gradient, color: [1, 0.2, 0.5], horizon: [0, 0.8, 0.1]}\n"
                                   "solids: {floor: {shape: plane, color: [0.9, 0.6, 0.3], diffuse: 0.5}}\n";

/* A sky of h + (s - h) cos theta lights a floor like h + 2/3 (s - h), the mean of cos theta by the cosine law; at 45
 * degrees the mirror reflects it at cos theta = 1 / sqrt 2. The choice of lobe must be independent of the direction. */
static void a_matte_mirror_reflects_the_diffuse_and_the_specular_share(void **state)
{
    (void)state;
    static const double high[3] = {1.0, 0.2, 0.5}, low[3] = {0.0, 0.8, 0.1}, color[3] = {0.9, 0.6, 0.3};
    scene *s = path_scene(glossy_scene);
    for (double mirror = 0.0; mirror < 0.6; mirror += 0.25) {
        char assignment[64];
        snprintf(assignment, sizeof assignment, "floor.reflectivity=%g", mirror);
        set(s, assignment);
        for (int c = 0; c < 3; c++) {
            const double matte = low[c] + 2.0 / 3.0 * (high[c] - low[c]),
                         mirrored = low[c] + sqrt(0.5) * (high[c] - low[c]);
            const estimate e = look_by_chance(s, c);
            expect_estimate(e, 0.5 * color[c] * matte + mirror * mirrored);
            assert_true(e.standard_error < 0.004);
        }
    }
    scene_destroy(s);
}

/* --- a sphere's light --- */

/* The camera is far away, and sees the middle of a floor past the lamp. */
static const char lamp_scene[] =
    "render: {width: 1, height: 1, depth: 0, integrator: path, paths: 1024, beyond: black}\n"
    "camera: {position: [0, 60, -80], target: [0, 0, 0], fov_deg: 0.01}\n"
    "background: {color: [0, 0, 0]}\n"
    "lights: {lamp: {position: [0, 4, 0], intensity: 3, reach: 2, radius: 1}}\n"
    "solids: {floor: {shape: plane, color: [0.9, 0.6, 0.3], diffuse: 0.7}}\n";

/* E = pi L (r / d)^2 cos theta for a sphere that is entirely above the horizon, of any size: Lambert's law of spheres
 * (Howell, Siegel and Menguc, Thermal Radiation Heat Transfer, configuration B-24). L = intensity (reach / r)^2; a
 * matte surface reflects k_d C E / pi. */
static void a_sphere_lights_a_floor_by_lamberts_law(void **state)
{
    (void)state;
    static const double shares[] = {0.001, 0.1, 0.4, 0.7}, cosines[] = {1.0, 0.9, 0.75, 0.45, 0.11},
                        distances[] = {0.5, 4.0, 11.0};
    scene *s = path_scene(lamp_scene);
    agreement a = {0};
    for (size_t i = 0; i < COUNT(shares); i++)
        for (size_t j = 0; j < COUNT(cosines); j++)
            for (size_t k = 0; k < COUNT(distances); k++) {
                const double d = distances[k];
                if (cosines[j] <= shares[i])
                    continue; /* the horizon cuts it */
                s->lights[0].radius = shares[i] * d;
                s->lights[0].position = vec3_make(d * sqrt(1.0 - cosines[j] * cosines[j]), d * cosines[j], 0.0);
                const double expected = 0.7 * 0.9 * 3.0 * 4.0 / (d * d) * cosines[j];
                const estimate e = look_by_chance(s, 0);
                expect_estimate(e, expected);
                assert_true(e.standard_error < 0.03 * expected);
                agreement_add(&a, e, expected, 1e-8); /* of the smallest ones */
                s->render.seed++;
            }
    print_message("%d lamps: %.0f%% in their 95%% interval\n", a.count, 100.0 * agreement_share(&a));
    assert_true(a.count > 30 && agreement_share(&a) > 0.85);
    assert_true(fabs(agreement_off(&a)) < 4.0);
    scene_destroy(s);
}

/* Lamps in the direction (0, 0.6, 0.8), into which the view ray is reflected: R.V is the cosine of the angle from the
 * lamp's middle, so that Phong's highlight is k_s times the light, 2 L times the integral of cos^n over the cosines of
 * the cone, from sqrt(1 - s^2) to 1. */
static void a_sphere_light_has_phongs_highlight(void **state)
{
    (void)state;
    static const double shares[] = {0.05, 0.3, 0.55}, shininess[] = {1.0, 2.5, 40.0};
    scene *s = path_scene(lamp_scene);
    set_all(s, "floor.diffuse=0 floor.specular=0.4");
    s->lights[0].position = vec3_make(0.0, 3.0, 4.0);
    for (size_t i = 0; i < COUNT(shares); i++)
        for (size_t j = 0; j < COUNT(shininess); j++) {
            const double r = 5.0 * shares[i], n = shininess[j], least_cos = sqrt(1.0 - shares[i] * shares[i]);
            char assignment[64];
            snprintf(assignment, sizeof assignment, "floor.shininess=%g", n);
            set(s, assignment);
            s->lights[0].radius = r;
            const double expected = 0.4 * 2.0 * 3.0 * 4.0 / (r * r) * (1.0 - pow(least_cos, n + 1.0)) / (n + 1.0);
            const estimate e = look_by_chance(s, 0);
            expect_estimate(e, expected);
            assert_true(e.standard_error < 0.05 * expected);
        }
    scene_destroy(s);
}

/* In the same place, on a floor that is also a mirror: the lamp itself, of radiance L, with the mirror's share; and
 * with the matte share Lambert's law of spheres, once, because the random continuation does not count the lamp
 * again. */
static void a_matte_mirror_counts_a_visible_lamp_once_per_lobe(void **state)
{
    (void)state;
    scene *s = path_scene(lamp_scene);
    set_all(s, "lamp.position=0,3,4 lamp.radius=2 floor.reflectivity=0.25 render.depth=1 render.paths=4096");
    const double lamp = 3.0 * 4.0 / 4.0, lit = 0.7 * 0.9 * 3.0 * 4.0 / 25.0 * 0.6;
    estimate e = look_by_chance(s, 0);
    expect_estimate(e, 0.25 * lamp + lit);
    assert_true(e.standard_error < 0.03);
    set(s, "floor.reflectivity=0");
    e = look_by_chance(s, 0);
    expect_estimate(e, lit);
    assert_true(e.standard_error < 0.01 * lit);
    set_all(s, "floor.reflectivity=0.25 floor.diffuse=0");
    expect_estimate(look_by_chance(s, 0), 0.25 * lamp);
    scene_destroy(s);
}

/* In a scene with a light sphere, whatever their order, a clear pane blocks a point light; without one the point light
 * passes with the transmittance of the pane's two faces. */
static void with_a_light_sphere_clear_solids_block_point_lights(void **state)
{
    (void)state;
    static const char *const radii[] = {"one.radius=0 two.radius=0", "one.radius=0.5 two.radius=0",
                                        "one.radius=0 two.radius=0.5"};
    for (size_t k = 0; k < COUNT(radii); k++) {
        scene *s =
            path_scene("render: {width: 1, height: 1, depth: 0, integrator: path, paths: 8, beyond: black}\n"
                       "camera: {position: [0, 1, 0], target: [0, 0, 0]}\n"
                       "background: {color: [0, 0, 0]}\n"
                       "lights: {one: {position: [0, 4, 0], reach: 4}, two: {position: [0, 4, 0], reach: 4}}\n"
                       "solids:\n"
                       "  floor: {shape: plane, diffuse: 0.5}\n"
                       "  pane: {shape: box, transparency: 0.9, ior: 1.5, position: [0, 2, 0], size: [9, 0.5, 9]}\n");
        set_all(s, radii[k]);
        const vec3 seen = look(s);
        assert_true(fabs(seen.x - (k == 0 ? 2.0 * 0.5 * 0.81 : 0.0)) < ROUNDINGS);
        scene_destroy(s);
    }
}

/* A red and a green lamp in one place: if both used the same random points, red and green would be equal. With
 * independent points the variance of their difference is the sum of their variances; over 64 seeds it is between 0.5
 * and 1.5 of it. */
static void lamps_are_sampled_independently(void **state)
{
    (void)state;
    enum { DRAWS = 64 };
    scene *s = path_scene(
        "render: {width: 1, height: 1, depth: 0, integrator: path, light_sampling: all, paths: 64, beyond: black}\n"
        "camera: {position: [0, 60, -80], target: [0, 0, 0], fov_deg: 0.01}\n"
        "background: {color: [0, 0, 0]}\n"
        "lights:\n"
        "  red: {position: [0, 4, 0], color: [1, 0, 0], reach: 2, radius: 2}\n"
        "  green: {position: [0, 4, 0], color: [0, 1, 0], reach: 2, radius: 2}\n"
        "solids: {floor: {shape: plane, diffuse: 1}}\n");
    const double expected = 0.25; /* intensity (reach / d)^2, as above */
    double own = 0.0, difference = 0.0;
    for (int seed = 0; seed < DRAWS; seed++) {
        s->render.seed = seed;
        const vec3 seen = look(s);
        own += (seen.x - expected) * (seen.x - expected) + (seen.y - expected) * (seen.y - expected);
        difference += (seen.x - seen.y) * (seen.x - seen.y);
    }
    assert_true(own > 0.0 && own / (2 * DRAWS) < 1e-4); /* a hundredth */
    assert_true(difference > 0.5 * own && difference < 1.5 * own);
    scene_destroy(s);
}

/* Only the upper half of a lamp whose middle is on the horizon contributes. B-24's other case, theta = 90 degrees: E /
 * (pi L) = (asin(s) - s sqrt(1 - s^2)) / pi with s = r / d. */
static void only_the_part_of_a_lamp_above_the_horizon_contributes(void **state)
{
    (void)state;
    scene *s = path_scene(lamp_scene);
    set_all(s, "render.paths=16384 lamp.position=2,0,0 lamp.radius=1.2");
    const double share = 0.6, factor = (asin(share) - share * sqrt(1.0 - share * share)) / acos(-1.0);
    expect_estimate(look_by_chance(s, 1), 0.7 * 0.6 * 3.0 * 4.0 / (1.2 * 1.2) * factor);
    scene_destroy(s);
}

/* A thin screen over x < 0 at height 1, the lamp above its edge at height 5: the planes through the edge that touch the
 * lamp intersect the floor at x = -+1 r / sqrt(4^2 - r^2), by similar triangles. The penumbra is between them. */
static void the_width_of_a_penumbra_follows_from_similar_triangles(void **state)
{
    (void)state;
    const double r = 1.5, edge = r / sqrt(16.0 - r * r);
    diagnostic why = {0};
    scene *shaded = path_scene("render: {width: 1, height: 1, depth: 0, integrator: path, paths: 4096, beyond: black}\n"
                               "camera: {position: [0, 0.4, -6], target: [0, 0, 0], fov_deg: 0.01}\n"
                               "background: {color: [0, 0, 0]}\n"
                               "lights: {lamp: {position: [0, 5, 0], intensity: 3, reach: 2, radius: 1.5}}\n"
                               "solids:\n"
                               "  floor: {shape: plane, color: [0.9, 0.6, 0.3], diffuse: 0.7}\n"
                               "  screen: {shape: box, position: [-50, 1, 0], size: [100, 1e-6, 100]}\n");
    static const double places[] = {-1.5, -1.02, -0.97, -0.5, 0.0, 0.5, 0.97, 1.02, 1.5};
    double before = -1.0;
    for (size_t k = 0; k < COUNT(places); k++) {
        const double x = places[k] * edge, d = sqrt(25.0 + x * x), open = 0.7 * 0.9 * 3.0 * 4.0 * 5.0 / (d * d * d);
        char text[64];
        snprintf(text, sizeof text, "%.17g,0,0", x);
        worked(scene_set(shaded, "camera.target", text, &why), &why);
        const estimate e = look_by_chance(shaded, 0);
        if (places[k] < -1.0)
            assert_true(e.value == 0.0);
        else if (places[k] > 1.0)
            expect_estimate(e, open);
        else if (places[k] == 0.0)
            expect_estimate(e, 0.5 * open); /* the halves are symmetric */
        else
            assert_true(e.value > 0.0 && e.value < open - e.t_95 * e.standard_error && e.value > before);
        before = e.value;
    }
    scene_destroy(shaded);
}

/* --- caustics: rays through clear surfaces hit the lamp --- */

static const char slab_scene[] =
    "render: {width: 1, height: 1, depth: 24, integrator: path, paths: 262144, beyond: black}\n"
    "camera: {position: [0, 0.5, -6], target: [0, 0, 0], fov_deg: 0.01}\n"
    "background: {color: [0, 0, 0]}\n"
    "lights: {lamp: {position: [0, 5, 0], intensity: 3, reach: 2, radius: 1.5}}\n"
    "solids:\n"
    "  floor: {shape: plane, diffuse: 0.01}\n"
    "  slab: {shape: box, position: [0, 1, 0], size: [100, 0.01, 100], transparency: 1, ior: 1.5}\n";

/* All inner reflections of a slab together transmit (1 - R) / (1 + R) (Born and Wolf, 7.6.1, without interference); up
 * to 17.5 degrees that changes by 2e-4. The slab moves the lamp's image by t (1 - 1 / n). */
static void a_slab_reduces_the_lamps_light_by_its_reflections(void **state)
{
    (void)state;
    scene *s = path_scene(slab_scene);
    for (int k = 0; k < 2; k++) {
        set(s, k == 0 ? "slab.ior=1.5" : "slab.ior=2.4");
        const double n = s->solids[1].surface.ior, R = (n - 1.0) * (n - 1.0) / ((n + 1.0) * (n + 1.0));
        const double d = 5.0 - 0.01 * (1.0 - 1.0 / n), E = 0.01 * 3.0 * 4.0 / (d * d);
        s->render.depth = 24;
        const estimate e = look_by_chance(s, 0);
        print_message("index %g: %.5f +- %.5f of the open light, expected %.5f\n", n, e.value / E, e.standard_error / E,
                      (1.0 - R) / (1.0 + R));
        assert_true(e.standard_error < 0.01 * E);
        expect_estimate(e, E * (1.0 - R) / (1.0 + R));
        s->render.depth = 3; /* direct transmission only */
        expect_estimate(look_by_chance(s, 0), E * (1.0 - R) * (1.0 - R));
        s->render.depth = 2;
        assert_true(look_by_chance(s, 0).value < 1e-4 * E); /* light that passes next to the slab */
    }
    set(s, "slab.visible=off"); /* no refraction: the floor samples the lamp directly, and counts it once */
    expect_estimate(look_by_chance(s, 0), 0.01 * 3.0 * 4.0 / 25.0);
    scene_destroy(s);
}

/* L (1 - R) / (1 + R) along the axis of a ball; only the lamp emits light. */
static void a_lamp_behind_a_glass_ball_has_the_balls_transmittance(void **state)
{
    (void)state;
    scene *s =
        path_scene("render: {width: 1, height: 1, depth: 30, integrator: path, paths: 16384, beyond: black}\n"
                   "camera: {position: [0, 0, -6], target: [0, 0, 0], fov_deg: 0.001}\n"
                   "background: {color: [0, 0, 0]}\n"
                   "lights: {lamp: {position: [0, 0, 9], color: [1, 0.5, 0.25], intensity: 3, reach: 2, radius: 1}}\n"
                   "solids: {ball: {shape: sphere, transparency: 1, ior: 2}}\n");
    const double L = 3.0 * 4.0, R = 1.0 / 9.0;
    for (int c = 0; c < 3; c++)
        expect_estimate(look_by_chance(s, c), L / (1 << c) * (1.0 - R) / (1.0 + R));
    set(s, "render.depth=2");
    expect_estimate(look_by_chance(s, 0), L * (1.0 - R) * (1.0 - R));
    set(s, "ball.visible=off");
    expect_estimate(look_by_chance(s, 0), L);
    set(s, "lamp.position=0,0,-9"); /* behind the camera */
    expect_estimate(look_by_chance(s, 0), 0.0);
    scene_destroy(s);
}

/* --- energy --- */

/* Under a white sky everything that absorbs nothing is white: convex or not, matte, mirror, both, clear. */
static void every_pixel_of_a_white_furnace_is_white(void **state)
{
    (void)state;
    scene *s = path_scene(clear_scene);
    set_all(
        s,
        "background.kind=uniform background.color=1,1,1 block.transparency=0 block.diffuse=1 mirror.reflectivity=0.5 "
        "mirror.diffuse=0.5 render.integrator=path render.paths=16");
    for (int depth = 0; depth <= 20; depth += 5) {
        s->render.depth = depth;
        s->render.roulette = depth % 2;
        render_result *r = render(s);
        for (int i = 0; i < 32 * 24; i++)
            for (int c = 0; c < 3; c++)
                expect_estimate(estimate_at(r, i % 32, i / 32, c), 1.0);
        render_result_destroy(r);
    }
    scene_destroy(s);
}

/* A hollow ball: radiance inside is the same everywhere, so that it is a geometric series of the reflectance. */
static const char hollow_scene[] =
    "render: {width: 8, height: 6, depth: 60, integrator: path, paths: 64, beyond: black, shadows: opaque}\n"
    "camera: {position: [0.5, 0.4, -0.3], target: [0, 0, 5], fov_deg: 90}\n"
    "background: {color: [7, 7, 7]}\n"
    "lights: {lamp: {position: [0, 0, 0], intensity: 3, reach: 1, radius: 0}}\n"
    "solids:\n"
    "  stone: {shape: sphere, radius: 4, color: [1, 0.5, 0.25], diffuse: 0.8}\n"
    "  hollow: {shape: sphere, radius: 2, transparency: 1, ior: 1, priority: 1}\n";

static void check_hollow_series(const char *settings)
{
    scene *s = path_scene(hollow_scene);
    set_all(s, settings);
    for (int depth = 0; depth <= 60; depth += depth < 3 ? 1 : 19) {
        s->render.depth = depth;
        render_result *r = render(s);
        for (int c = 0; c < 3; c++) {
            const double rho = 0.8 / (1 << c), expected = rho * 3.0 / 4.0 * (1.0 - pow(rho, depth + 1)) / (1.0 - rho);
            for (int i = 0; i < 48; i++)
                assert_true(fabs(film_value(r->img, i % 8, i / 8, c) - expected) < 1e-9);
        }
        render_result_destroy(r);
    }
    scene_destroy(s);
}

static void light_in_a_hollow_ball_is_a_geometric_series(void **state)
{
    (void)state;
    check_hollow_series("");
    check_hollow_series("hollow.ior=1.5"); /* filled with glass: no interface is between the lamp and the wall either */
    check_hollow_series("hollow.ior=1.5 render.shadows=attenuated");
}

/* The same with a sphere light in the middle, and with Russian roulette. */
static agreement hollow_ball(scene *s)
{
    agreement a = {0};
    render_result *r = render(s);
    for (int i = 0; i < 48; i++)
        for (int c = 0; c < 3; c++) {
            const double rho = 0.8 / (1 << c);
            agreement_add(&a, estimate_at(r, i % 8, i / 8, c), rho * 3.0 / 4.0 * (1.0 - pow(rho, 61.0)) / (1.0 - rho),
                          0.0);
        }
    render_result_destroy(r);
    return a;
}

static uint64_t rays_of(const scene *s)
{
    render_result *r = render(s);
    const uint64_t rays = ray_counters_total(&r->counters);
    render_result_destroy(r);
    return rays;
}

/* The wall is also a mirror, which light from the middle does not show: of each channel k_d C continues, and by the
 * mirror k_r. The end of a path must not depend on the choice between the two. */
static void roulette_is_independent_of_the_choice_between_matte_and_mirror(void **state)
{
    (void)state;
    scene *s = path_scene(hollow_scene);
    set_all(s, "stone.diffuse=0.5 stone.reflectivity=0.3 render.roulette=on render.paths=1024");
    agreement a = {0};
    render_result *r = render(s);
    for (int i = 0; i < 48; i++)
        for (int c = 0; c < 3; c++) {
            const double matte = 0.5 / (1 << c), on = matte + 0.3;
            agreement_add(&a, estimate_at(r, i % 8, i / 8, c), matte * 3.0 / 4.0 * (1.0 - pow(on, 61.0)) / (1.0 - on),
                          0.0);
        }
    print_message("matte mirror: %.1f%% in their 95%% interval, mean off by %.2f standard errors\n",
                  100.0 * agreement_share(&a), agreement_off(&a));
    assert_int_equal(a.count, 144);
    assert_true(agreement_share(&a) > 0.90 && fabs(agreement_off(&a)) < 4.0);
    render_result_destroy(r);
    scene_destroy(s);
}

static void roulette_keeps_the_mean_and_saves_rays(void **state)
{
    (void)state;
    scene *s = path_scene(hollow_scene);
    const uint64_t all = rays_of(s);
    set_all(s, "render.roulette=on render.paths=512");
    const agreement a = hollow_ball(s);
    print_message("roulette: %.1f%% in their 95%% interval, mean off by %.2f standard errors\n",
                  100.0 * agreement_share(&a), agreement_off(&a));
    assert_int_equal(a.count, 144);
    assert_true(agreement_share(&a) > 0.90 && fabs(agreement_off(&a)) < 4.0);
    set(s, "render.paths=64");
    assert_true(!CUVETTE_COUNTERS || rays_of(s) < all / 3);
    scene_destroy(s);
}

static void a_light_sphere_in_a_hollow_ball_is_a_geometric_series(void **state)
{
    (void)state;
    scene *s = path_scene(hollow_scene);
    set_all(s, "lamp.radius=0.05 camera.position=0,0,-1 camera.target=0.9,0,-2");
    const agreement a = hollow_ball(s);
    print_message("sphere: %.1f%% of %d in their 95%% interval, mean off by %.2f standard errors\n",
                  100.0 * agreement_share(&a), a.count, agreement_off(&a));
    assert_true(agreement_share(&a) > 0.90 && fabs(agreement_off(&a)) < 4.0);
    scene_destroy(s);
}

/* The medium before a lamp absorbs by exp(-a d), and the medium behind the lamp does not. */
static void the_medium_before_a_lamp_absorbs_and_the_one_behind_does_not(void **state)
{
    (void)state;
    scene *s = path_scene(
        "render: {width: 1, height: 1, depth: 1, integrator: path, paths: 16, beyond: black}\n"
        "camera: {position: [0, 0, -3.5], target: [0, 0, 0], fov_deg: 0.001}\n"
        "lights: {lamp: {position: [0, 0, 0], intensity: 3, reach: 1, radius: 0.5}}\n"
        "solids:\n"
        "  stone: {shape: sphere, radius: 7}\n"
        "  hollow: {shape: sphere, radius: 6, transparency: 1, ior: 1, priority: 1}\n"
        "  liquid: {shape: sphere, radius: 1.5, transparency: 1, ior: 1, absorb_per_m: [0.3, 0.6, 0], priority: 2}\n"
        "  gap: {shape: box, size: [0.2, 0.2, 0.4], position: [0, 0, -1], transparency: 1, ior: 1, priority: 3, "
        "visible: off}\n");
    expect_estimate(look_by_chance(s, 0), 12.0 * exp(-0.3 * 1.0));
    expect_estimate(look_by_chance(s, 1), 12.0 * exp(-0.6 * 1.0));
    expect_estimate(look_by_chance(s, 2), 12.0);
    set(s, "gap.visible=on");
    expect_estimate(look_by_chance(s, 0), 12.0 * exp(-0.3 * 0.6));
    set(s, "camera.position=0,0,-1"); /* from within the gap */
    s->camera.aimed = 1;
    expect_estimate(look_by_chance(s, 0), 12.0 * exp(-0.3 * 0.3));
    scene_destroy(s);
}

/* --- standard error of the image --- */

enum { SEEDS = 40, PIXELS = 8 * 6 };

/* A penumbra, glass and a matte floor under a sky. */
static const char unsure_scene[] =
    "render: {width: 8, height: 6, depth: 6, integrator: path, paths: 64}\n"
    "camera: {position: [0, 2, -5], target: [0, 0.7, 0], fov_deg: 40}\n"
    "background: {kind: gradient, color: [1, 0.4, 0.2], horizon: [0.3, 0.5, 0.8]}\n"
    "lights: {lamp: {position: [3, 5, -2], intensity: 1, reach: 5, radius: 1}}\n"
    "solids:\n"
    "  floor: {shape: plane, color: [0.9, 0.6, 0.3], diffuse: 0.7}\n"
    "  ball: {shape: sphere, position: [-0.8, 0.8, 0], radius: 0.7, transparency: 1, ior: 1.5}\n"
    "  stone: {shape: sphere, position: [0.8, 0.7, 0], radius: 0.7, diffuse: 0.8}\n";

/* Over many seeds: each value's own variance, and the mean of the variances that were reported. */
typedef struct spread {
    double own[3 * PIXELS], reported[3 * PIXELS];
} spread;

static void spread_over_seeds(scene *s, spread *out)
{
    double sum[3 * PIXELS] = {0}, squares[3 * PIXELS] = {0};
    *out = (spread){{0}, {0}};
    for (int seed = 0; seed < SEEDS; seed++) {
        s->render.seed = seed;
        render_result *r = render(s);
        for (int i = 0; i < 3 * PIXELS; i++) {
            const double v = (double)r->img->sum[i] / FILM_ONE;
            sum[i] += v, squares[i] += v * v;
            out->reported[i] += r->variance[i] / SEEDS;
        }
        render_result_destroy(r);
    }
    for (int i = 0; i < 3 * PIXELS; i++)
        out->own[i] = (squares[i] - sum[i] * sum[i] / SEEDS) / (SEEDS - 1);
}

/* 39 s^2 / sigma^2 is between 16.3 and 76.1 in 99.95 of 100 cases (chi-square, two-sided) for normal values and known
 * sigma; a few outliers from heavier tails are allowed. */
static void check_spread(const char *settings)
{
    scene *s = path_scene(unsure_scene);
    set_all(s, settings);
    spread d;
    spread_over_seeds(s, &d);
    int count = 0, outside = 0;
    double mean = 0.0;
    for (int i = 0; i < 3 * PIXELS; i++) {
        if (d.reported[i] < 1e-12)
            continue;
        const double chi_square = (SEEDS - 1) * d.own[i] / d.reported[i];
        count++;
        outside += chi_square < 16.3 || chi_square > 76.1;
        mean += d.own[i] / d.reported[i];
    }
    mean /= count;
    print_message("%s: %d values over %d seeds: variance is %.3f of what was reported; %d outside\n", settings, count,
                  SEEDS, mean, outside);
    assert_true(count > 100);
    assert_true(outside <= count / 50);
    assert_true(fabs(mean - 1.0) < 0.1);
    scene_destroy(s);
}

static void the_reported_standard_error_equals_that_over_seeds(void **state)
{
    (void)state;
    check_spread("render.paths=64");
    check_spread("render.paths=64 render.samples=4");
    check_spread("render.paths=64 render.roulette=on");
}

/* Shares with their own wavelengths differ by more than random noise: the estimate is then an upper bound. */
static void the_reported_standard_error_of_a_spectral_film_is_a_bound(void **state)
{
    (void)state;
    scene *s = path_scene(unsure_scene);
    set(s, "render.spectrum=spectral");
    spread d;
    spread_over_seeds(s, &d);
    double own = 0.0, reported = 0.0;
    for (int i = 0; i < 3 * PIXELS; i++)
        own += d.own[i], reported += d.reported[i];
    print_message("spectral: variance is %.3f of what was reported\n", own / reported);
    assert_true(own > 0.3 * reported && own < 1.05 * reported);
    scene_destroy(s);
}

/* As many shares as divide the paths, at most eight; no error with one share. */
static void any_number_of_paths_is_valid(void **state)
{
    (void)state;
    static const struct {
        int paths;
        bool known;
    } cases[] = {{1, false}, {2, true}, {7, true}, {12, true}, {17, false}, {22, true}};
    scene *s = path_scene(clear_scene);
    set_all(s, "background.kind=uniform background.color=1,1,1 block.transparency=1 mirror.reflectivity=1 "
               "render.integrator=path");
    for (size_t k = 0; k < COUNT(cases); k++) {
        s->render.paths = cases[k].paths;
        render_result *r = render(s);
        assert_true((r->variance != NULL) == cases[k].known);
        assert_int_equal(r->img->replicates, 1);
        for (int i = 0; i < 32 * 24; i++)
            assert_true(fabs(film_value(r->img, i % 32, i / 32, 1) - 1.0) < ROUNDINGS);
        render_result_destroy(r);
    }
    set_all(s, "render.paths=18 render.samples=4"); /* the pixel's points have unequal shares */
    render_result *r = render(s);
    assert_null(r->variance);
    render_result_destroy(r);
    scene_destroy(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(paths_through_clear_solids_have_the_mean_of_whitted_ray_tracing),
        cmocka_unit_test(deterministic_light_is_exact),
        cmocka_unit_test(paths_have_highlights_under_every_lighting),
        cmocka_unit_test(a_matte_mirror_reflects_the_diffuse_and_the_specular_share),
        cmocka_unit_test(a_sphere_lights_a_floor_by_lamberts_law),
        cmocka_unit_test(a_sphere_light_has_phongs_highlight),
        cmocka_unit_test(a_matte_mirror_counts_a_visible_lamp_once_per_lobe),
        cmocka_unit_test(with_a_light_sphere_clear_solids_block_point_lights),
        cmocka_unit_test(lamps_are_sampled_independently),
        cmocka_unit_test(only_the_part_of_a_lamp_above_the_horizon_contributes),
        cmocka_unit_test(the_width_of_a_penumbra_follows_from_similar_triangles),
        cmocka_unit_test(a_slab_reduces_the_lamps_light_by_its_reflections),
        cmocka_unit_test(a_lamp_behind_a_glass_ball_has_the_balls_transmittance),
        cmocka_unit_test(every_pixel_of_a_white_furnace_is_white),
        cmocka_unit_test(light_in_a_hollow_ball_is_a_geometric_series),
        cmocka_unit_test(roulette_keeps_the_mean_and_saves_rays),
        cmocka_unit_test(roulette_is_independent_of_the_choice_between_matte_and_mirror),
        cmocka_unit_test(a_light_sphere_in_a_hollow_ball_is_a_geometric_series),
        cmocka_unit_test(the_medium_before_a_lamp_absorbs_and_the_one_behind_does_not),
        cmocka_unit_test(the_reported_standard_error_equals_that_over_seeds),
        cmocka_unit_test(the_reported_standard_error_of_a_spectral_film_is_a_bound),
        cmocka_unit_test(any_number_of_paths_is_valid),
    };
    sampler = "render.sampler=philox";
    const int failed = cmocka_run_group_tests_name("philox", tests, NULL, NULL);
    sampler = "render.sampler=sobol";
    return failed + cmocka_run_group_tests_name("sobol", tests, NULL, NULL);
}
