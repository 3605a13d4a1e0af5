/* Tests of render.radiance: basic. L / n^2 is invariant along a ray, except for reflection and absorption: Nicodemus,
 * "Radiance", American Journal of Physics 31 (1963); Veach, Robust Monte Carlo Methods for Light Transport Simulation
 * (1997), 5.2. Reflectances are those of realism/theory.h, from sines and tangents of angles, not the tracer's. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "optics/spectrum.h"
#include "path_fixture.h"
#include "probe_fixture.h"
#include "realism/theory.h"
#include "whole.h"

#define NEAR 1e-10

static double through(double angle, double n_from, double n_to)
{
    return n_from == n_to ? 1.0 : 1.0 - theory_fresnel(angle, n_from, n_to);
}

/* The value of the single pixel; asserts that all channels are equal. */
static double see(const scene *s)
{
    const vec3 l = look(s);
    assert_true(fabs(l.y - l.x) < NEAR && fabs(l.z - l.x) < NEAR);
    return l.x;
}

/* --- a sky of 1, from under water */

static const char diver[] = "background: {color: [1, 1, 1]}\n"
                            "render: {width: 1, height: 1, depth: 1, beyond: black}\n"
                            "camera: {fov_deg: 0.001}\n"
                            "solids: {water: {shape: box, size: [1e4, 2, 1e4], transparency: 1}}\n";

static scene *diver_at(double degrees, double n, double n_around, const char *settings)
{
    char pose[256];
    snprintf(pose, sizeof pose, "water.ior=%g background.ior=%g camera.position=0,0.5,0 camera.target=%.17g,%.17g,0", n,
             n_around, sin(degrees * DEGREE), 0.5 + cos(degrees * DEGREE));
    scene *s = scene_from(diver);
    set_all(s, pose);
    set_all(s, settings);
    return s;
}

static void the_sky_from_under_water_has_the_square_of_the_index(void **state)
{
    (void)state;
    static const struct {
        double n, n_around;
    } media[] = {{1.333, 1.0}, {1.5, 1.0}, {1.8, 1.2}, {1.0, 1.5}, {1.0, 1.0}};
    static const char *const modes[] = {"", "render.polarisation=on", "render.samples=4"};
    for (size_t k = 0; k < COUNT(media); k++)
        for (int degrees = 0; degrees <= 80; degrees += 8)
            for (size_t w = 0; w < COUNT(modes); w++) {
                const double n = media[k].n, n_around = media[k].n_around, T = through(degrees * DEGREE, n, n_around);
                scene *s = diver_at(degrees, n, n_around, modes[w]);
                assert_true(fabs(see(s) - T) < 1e-5 * T + NEAR); /* a pixel has a width */
                set(s, "render.radiance=basic");
                assert_true(fabs(see(s) - n * n / (n_around * n_around) * T) < 2e-5 * T + NEAR);
                scene_destroy(s);
            }
}

static void random_paths_see_the_same_sky(void **state)
{
    (void)state;
    for (int degrees = 0; degrees <= 60; degrees += 20) {
        scene *s = diver_at(degrees, 1.5, 1.0,
                            "render.integrator=path render.filter=centre render.sampler=philox render.paths=4096 "
                            "render.radiance=basic");
        expect_estimate(look_by_chance(s, 1), 2.25 * through(degrees * DEGREE, 1.5, 1.0));
        scene_destroy(s);
    }
}

/* In a dispersive medium each wavelength has its own index: the film sums X, Y and Z over them. Straight up R is ((n -
 * 1) / (n + 1))^2, and of a white sky, which has daylight's spectrum, the observer sees the sum of n^2 T D65 y over the
 * sum of D65 y in luminance. */
static void each_wavelength_has_the_square_of_its_index(void **state)
{
    (void)state;
    scene *s =
        diver_at(0.0, 1.5, 1.0,
                 "water.medium=cauchy water.coefficients=1.3,0.06 render.spectrum=spectral render.wavelengths=400");
    const vec3 classic = look(s);
    set(s, "render.radiance=basic");
    const vec3 basic = look(s);
    double sums[2] = {0.0, 0.0}, white = 0.0;
    for (int nm = OBSERVER_LOW_NM; nm < OBSERVER_HIGH_NM; nm++) {
        double xyz[3];
        const double um = (nm + 0.5) / 1000.0, n = 1.3 + 0.06 / (um * um), r = (n - 1.0) / (n + 1.0);
        observer_xyz(nm + 0.5, xyz);
        const double y = xyz[1] * observer_d65(nm + 0.5);
        white += y, sums[0] += (1.0 - r * r) * y, sums[1] += n * n * (1.0 - r * r) * y;
    }
    double seen[2][3];
    linear_srgb_to_xyz((const double[]){classic.x, classic.y, classic.z}, seen[0]);
    linear_srgb_to_xyz((const double[]){basic.x, basic.y, basic.z}, seen[1]);
    for (int k = 0; k < 2; k++)
        if (!(fabs(seen[k][1] - sums[k] / white) < 1e-4))
            fail_msg("luminance %.9g instead of %.9g", seen[k][1], sums[k] / white);
    scene_destroy(s);
}

/* --- a closed furnace */

static const char furnace[] =
    "background: {color: [1, 1, 1]}\n"
    "camera: {position: [0.3, 1.9, -4.5], target: [0, 1, 0], fov_deg: 40}\n"
    "render: {width: 12, height: 9, depth: 6, radiance: basic}\n"
    "solids:\n"
    "  ground: {shape: plane, transparency: 1, ior: 1.3, rotation: [4, 0, -7]}\n"
    "  block: {shape: box, transparency: 1, ior: 1.7, position: [0.3, 0.9, 0.1], rotation: [20, 30, 10], "
    "size: [1.8, 1.1, 0.7], priority: 4}\n"
    "  bead: {shape: sphere, transparency: 1, ior: 2.42, position: [0.2, 0.9, 0], radius: 0.4, priority: 6}\n";

/* A uniform L / n^2 makes all media invisible: n_eye^2 in every pixel, in units of the surroundings'. */
static void a_furnace_has_the_squared_index_of_the_cameras_medium(void **state)
{
    (void)state;
    static const char *const modes[] = {"", "render.polarisation=on", "render.integrator=path render.paths=16",
                                        "render.depth=1"};
    static const struct {
        const char *pose;
        double n;
    } eyes[] = {
        {"", 1.0}, {"camera.position=0.25,0.9,0.01", 2.42}, {"camera.position=0,-3,0 background.ior=1.2", 1.3 / 1.2}};
    for (size_t w = 0; w < COUNT(modes); w++)
        for (size_t k = 0; k < COUNT(eyes); k++) {
            scene *s = scene_from(furnace);
            set_all(s, modes[w]);
            set_all(s, eyes[k].pose);
            render_result *r = render(s);
            for (int i = 0; i < 12 * 9; i++)
                assert_true(fabs(film_value(r->img, i % 12, i / 12, i % 3) - eyes[k].n * eyes[k].n) < 1e-9);
            render_result_destroy(r);
            scene_destroy(s);
        }
}

/* --- floors under water */

static const char pond[] = "background: {color: [0, 0, 0], ambient: [1, 1, 1]}\n"
                           "render: {width: 1, height: 1, depth: 1, beyond: black, radiance: basic}\n"
                           "camera: {fov_deg: 0.0001}\n"
                           "lights: {lamp: {position: [9, 40, 3], intensity: 0}}\n"
                           "solids:\n"
                           "  water: {shape: box, size: [1e4, 2, 1e4], transparency: 1, ior: 1.5}\n"
                           "  floor: {shape: plane, priority: 9}\n";

/* From a point 2 above the floor, which is 1 under water, along a ray at that angle; *at: where it hits the floor. */
static scene *pond_from_above(double degrees, double n, const char *settings, double *at)
{
    char pose[256];
    const double a = degrees * DEGREE;
    snprintf(pose, sizeof pose, "water.ior=%.17g camera.position=0,2,0 camera.target=%.17g,%.17g,0", n, sin(a),
             2.0 - cos(a));
    scene *s = scene_from(pond);
    set_all(s, pose);
    set_all(s, settings);
    *at = tan(a) + tan(asin(sin(a) / n));
    return s;
}

static void radiance_of_a_floor_decreases_on_leaving_water(void **state)
{
    (void)state;
    static const char *const modes[] = {"", "render.polarisation=on", "render.spectrum=spectral render.wavelengths=64"};
    for (int degrees = 0; degrees <= 80; degrees += 10)
        for (size_t w = 0; w < COUNT(modes); w++) {
            double at;
            scene *s = pond_from_above(degrees, 1.333, modes[w], &at);
            set(s, degrees % 20 ? "floor.ambient=1" : "floor.emission=1");
            const double T = through(degrees * DEGREE, 1.0, 1.333), seen = look(s).y;
            assert_true(fabs(seen - T / (1.333 * 1.333)) < (w == 2 ? 1e-6 : 1e-9));
            set(s, "render.radiance=classic");
            assert_true(fabs(look(s).y - T) < (w == 2 ? 1e-6 : 1e-9));
            scene_destroy(s);
        }
}

/* A camera in the water sees the unchanged floor, with raycast too. */
static void radiance_is_unchanged_within_one_medium(void **state)
{
    (void)state;
    static const char *const modes[] = {"whitted", "raycast"};
    for (size_t w = 0; w < COUNT(modes); w++) {
        scene *s = scene_from(pond);
        char mode[64];
        snprintf(mode, sizeof mode, "render.integrator=%s", modes[w]);
        set_all(s, "camera.position=0,0.5,0 camera.target=0.1,0,0 floor.ambient=0.7 water.ior=1.6");
        set(s, mode);
        assert_true(fabs(see(s) - 0.7) < NEAR);
        scene_destroy(s);
    }
}

/* E_straight T, T by the straight line's angle on the side of the lower index: for a lamp above, and for one whose
 * light goes from water up. */
static void direct_light_through_the_surface_has_its_transmittance(void **state)
{
    (void)state;
    for (int degrees = 0; degrees <= 60; degrees += 15) {
        double at;
        scene *s =
            pond_from_above(degrees, 1.5, "lamp.intensity=1 floor.diffuse=0.5 water.absorb_per_m=0.2,0.2,0.2", &at);
        const double across = hypot(9.0 - at, 3.0), angle = atan2(across, 40.0),
                     T = through(degrees * DEGREE, 1.0, 1.5);
        const double length = 1.0 / cos(angle) + 1.0 / cos(asin(sin(degrees * DEGREE) / 1.5));
        const double E = 0.5 * cos(angle) * through(angle, 1.0, 1.5) * exp(-0.2 * length);
        assert_true(fabs(see(s) - T * E / 2.25) < 1e-9);
        set(s, "render.shadows=off");
        assert_true(fabs(see(s) - T * 0.5 * cos(angle) / 2.25 * exp(-0.2 / cos(asin(sin(degrees * DEGREE) / 1.5)))) <
                    1e-9);
        set_all(s, "render.shadows=attenuated render.radiance=classic");
        assert_true(fabs(see(s) - T * 0.5 * cos(angle) * exp(-0.2 * length)) < 1e-9);
        scene_destroy(s);
    }
}

/* --- interfaces in a shadow ray's path */

/* The camera looks straight down from between lamp and floor; the occluder is next to its ray. */
static const char window[] = "background: {color: [0, 0, 0]}\n"
                             "render: {width: 1, height: 1, depth: 3, beyond: black, radiance: basic}\n"
                             "camera: {position: [0, 1, 0.01], target: [0, 0, 0], fov_deg: 0.0001}\n"
                             "lights: {lamp: {position: [30, 40, 0], intensity: 1}}\n"
                             "solids:\n"
                             "  floor: {shape: plane, diffuse: 1, priority: 9}\n"
                             "  %s\n";

static double shaded(const char *shade, const char *settings)
{
    char text[2048];
    snprintf(text, sizeof text, window, shade);
    scene *s = scene_from(text);
    set_all(s, settings);
    const double seen = see(s);
    scene_destroy(s);
    return seen;
}

static void panes_shade_by_fresnel_on_both_faces(void **state)
{
    (void)state;
    const double angle = atan(0.75), T = through(angle, 1.0, 1.5), half = 0.5 * T * T;
    const char *const pane = "pane: {shape: box, position: [9, 12, 0], size: [4, 0.5, 4], transparency: 1, ior: 1.5}";
    const char *const leaning =
        "pane: {shape: box, position: [9, 12, 0], rotation: [0, 0, -36.86989764584402], size: [4, 0.5, 4], "
        "transparency: 1, ior: 1.5}";
    assert_true(fabs(shaded(pane, "") - 0.8 * T * T) < 1e-9);
    assert_true(fabs(shaded(leaning, "") - 0.8 * 0.96 * 0.96) < 1e-9); /* normal incidence */
    assert_true(fabs(shaded(pane, "pane.transparency=0.7071067811865476") - 0.8 * half) < 1e-9);
    assert_true(fabs(shaded(pane, "pane.reflectivity=0.3") - 0.8 * T * T * 0.49) < 1e-9); /* a coating on both faces */
    assert_true(fabs(shaded(pane, "render.radiance=classic") - 0.8) < 1e-9);
    assert_true(fabs(shaded(pane, "render.weights=constant") - 0.8) < 1e-9);
    assert_true(fabs(shaded(pane, "render.transmission=simple") - 0.8) < 1e-9);
    assert_true(fabs(shaded(pane, "render.integrator=path render.filter=centre render.paths=1") - 0.8 * T * T) < 1e-9);
    assert_true(fabs(shaded(pane, "render.integrator=raycast") - 0.8 * T * T) < 1e-9);
    assert_true(shaded(pane, "render.shadows=opaque") == 0.0);
}

/* Round surfaces: the ray hits a sphere of radius r at a distance b from its middle, at sin i = b / r, and leaves it at
 * the same angle. */
static void spheres_and_cylinders_shade_by_the_angle_of_the_straight_ray(void **state)
{
    (void)state;
    for (double b = 0.0; b < 0.95; b += 0.2) {
        char text[256];
        const double x = 9.0 + 0.8 * b, y = 12.0 - 0.6 * b, T = through(asin(b), 1.0, 1.4);
        snprintf(text, sizeof text,
                 "ball: {shape: sphere, radius: 1, position: [%.17g, %.17g, 0], transparency: 1, ior: 1.4}", x, y);
        assert_true(fabs(shaded(text, "") - 0.8 * T * T) < 1e-9);
        snprintf(text, sizeof text,
                 "rod: {shape: cylinder, radius: 1, height: 4, rotation: [90, 0, 0], position: [%.17g, %.17g, -2], "
                 "transparency: 1, ior: 1.4}",
                 x, y);
        assert_true(fabs(shaded(text, "") - 0.8 * T * T) < 1e-9);
    }
}

/* A drop of water in a pane: each interface counts once, with the indices on both of its sides; matched media count
 * nothing. */
static void each_interface_counts_once_with_its_own_indices(void **state)
{
    (void)state;
    const double angle = atan(0.75), T = through(angle, 1.0, 1.5), inner = through(0.0, 1.33, 1.5);
    const char *const two =
        "pane: {shape: box, position: [9, 12, 0], size: [8, 4, 4], transparency: 1, ior: 1.5}\n"
        "  drop: {shape: sphere, radius: 1, position: [9, 12, 0], transparency: 1, ior: 1.33, priority: 1}";
    assert_true(fabs(shaded(two, "") - 0.8 * T * T * inner * inner) < 1e-9);
    assert_true(fabs(shaded(two, "drop.ior=1.5") - 0.8 * T * T) < 1e-9);
    assert_true(fabs(shaded(two, "drop.ior=1 pane.ior=1") - 0.8) < 1e-9);
}

/* An image of the shadow of a tilted box, made of triangles or not. */
static render_result *askew(const char *shape)
{
    char scene_part[512], text[2048], yaml[4096];
    snprintf(scene_part, sizeof scene_part,
             "pane: {%s, position: [2, 3, 0], rotation: [20, 30, 10], transparency: 0.9, reflectivity: 0.1, ior: 1.5}",
             shape);
    snprintf(text, sizeof text, window, scene_part);
    snprintf(yaml, sizeof yaml, "meshes: {block: {generate: box}}\n%s", text);
    scene *s = scene_from(yaml);
    diagnostic why = {0};
    worked(scene_load(s, &why), &why);
    set_all(s, "render.width=40 render.height=30 camera.fov_deg=130");
    render_result *r = render(s);
    scene_destroy(s);
    return r;
}

/* A box of triangles is the box. */
static void meshes_cast_the_same_shadows_as_solids(void **state)
{
    (void)state;
    render_result *solids = askew("shape: box, size: [2, 1, 1.5]");
    render_result *triangles = askew("shape: mesh, mesh: block, scale: [2, 1, 1.5]");
    int shaded_pixels = 0;
    for (int i = 0; i < 40 * 30; i++) {
        const double a = film_value(solids->img, i % 40, i / 40, 1), b = film_value(triangles->img, i % 40, i / 40, 1);
        shaded_pixels += a > 0.0 && a < 0.6;
        if (!(fabs(a - b) < 1e-9))
            fail_msg("pixel %d,%d: %.12g by triangles instead of %.12g", i % 40, i / 40, b, a);
    }
    assert_true(shaded_pixels > 100);
    render_result_destroy(solids);
    render_result_destroy(triangles);
}

/* The normals of a ball's corners are its radii, so that interpolated ones are along the radius at every point of its
 * triangles: light through its middle meets both surfaces perpendicularly, whatever the triangles' own angles. */
static void smooth_meshes_shade_by_interpolated_normals(void **state)
{
    (void)state;
    char part[512], text[2048], yaml[4096];
    for (int degrees = 0; degrees < 90; degrees += 13) {
        snprintf(part, sizeof part,
                 "ball: {shape: mesh, mesh: facets, shading: smooth, position: [9, 12, 0], rotation: [%d, 30, 10], "
                 "transparency: 1, ior: 1.5}",
                 degrees);
        snprintf(text, sizeof text, window, part);
        snprintf(yaml, sizeof yaml, "meshes: {facets: {generate: icosphere, level: 1}}\n%s", text);
        scene *s = scene_from(yaml);
        diagnostic why = {0};
        worked(scene_load(s, &why), &why);
        assert_true(fabs(see(s) - 0.8 * 0.96 * 0.96) < 1e-9);
        scene_destroy(s);
    }
}

/* --- Whitted's rays compared with random paths */

/* A dark floor 1 under water, a lamp 500 above, which the water does not reflect into the camera. For Whitted's rays
 * the lamp is a point. */
static const char dark_floor[] = "background: {color: [0, 0, 0]}\n"
                                 "render: {width: 16, height: 16, depth: 3, beyond: black, radiance: basic}\n"
                                 "camera: {position: [0, 200, 80], target: [0, 0, 0], fov_deg: 0.2}\n"
                                 "lights: {lamp: {position: [0, 500, 0], intensity: 100, reach: 500}}\n"
                                 "solids:\n"
                                 "  floor: {shape: plane, diffuse: 0.01, priority: 2}\n"
                                 "  water: {shape: box, size: [4000, 2, 4000], transparency: 1}\n";

static double mean_of(const scene *s)
{
    render_result *r = render(s);
    double sum = 0.0;
    for (int i = 0; i < 256; i++)
        sum += film_value(r->img, i % 16, i / 16, 0);
    render_result_destroy(r);
    return sum / 256.0;
}

static void whitted_ray_tracing_and_paths_agree_on_a_dark_floor_under_water(void **state)
{
    (void)state;
    static const double indices[] = {1.0, 1.333, 1.5, 1.8};
    for (size_t k = !is_whole(); k < COUNT(indices); k += is_whole() ? 1 : 2) {
        const double n = indices[k], view = atan(80.0 / 200.0);
        scene *s = scene_from(dark_floor);
        char assignment[64];
        snprintf(assignment, sizeof assignment, "water.ior=%g", n);
        set(s, assignment);
        const double tree = mean_of(s), expected = through(view, 1.0, n) * through(0.0, 1.0, n) / (n * n);
        set_all(s, "render.radiance=classic");
        const double classic = mean_of(s);
        set_all(s, "render.radiance=basic lamp.radius=150 render.integrator=path render.paths=6400");
        const double paths = mean_of(s);
        set_all(s, "render.radiance=classic");
        assert_true(n == 1.0 || mean_of(s) == paths); /* camera and lamp are in one medium */
        print_message("n %g: Whitted's over the paths' light %.4f with basic radiance, %.4f with classic\n", n,
                      tree / paths, classic / paths);
        assert_true(fabs(tree / expected - 1.0) < 1e-3);
        assert_true(fabs(tree / paths - 1.0) <= 0.01);
        scene_destroy(s);
    }
}

/* A lamp under water is unchanged for a diver, and has T / n^2 of its radiance from above. */
static void the_radiance_of_a_light_sphere_refers_to_its_medium(void **state)
{
    (void)state;
    const char *const lamp =
        "render.integrator=path render.filter=centre render.sampler=philox render.paths=4096 lamp.position=0,0.4,0 "
        "lamp.intensity=1 lamp.reach=0.2 lamp.radius=0.2";
    double unused;
    scene *s = pond_from_above(0.0, 1.5, lamp, &unused);
    expect_estimate(look_by_chance(s, 0), 0.96 / 2.25);
    set_all(s, "camera.position=0,0.9,0 camera.target=0,0,0");
    expect_estimate(look_by_chance(s, 0), 1.0);
    scene_destroy(s);
}

/* Direct light of a sphere on a floor in one medium, pi L (r / d)^2 cos theta, is emitted there: T / n^2 of it reaches
 * a camera in air. */
static void direct_light_of_a_sphere_is_emitted_into_its_medium(void **state)
{
    (void)state;
    double at;
    scene *s =
        pond_from_above(20.0, 1.5, "render.integrator=path render.paths=16384 lamp.intensity=1 lamp.reach=0.2", &at);
    char lamp[128];
    snprintf(lamp, sizeof lamp, "lamp.radius=0.05 lamp.position=%.17g,0.4,0 floor.diffuse=0.5", at + 0.3);
    set_all(s, lamp);
    const double lit = 0.5 * (0.04 / 0.25) * 0.8, T = through(20.0 * DEGREE, 1.0, 1.5);
    expect_estimate(look_by_chance(s, 0), T / 2.25 * lit);
    scene_destroy(s);
}

/* --- invariants */

static uint64_t hash_of(const char *settings)
{
    scene *s = rod_scene("render.width=80 render.height=60 render.depth=6");
    set_all(s, settings);
    render_result *r = render(s);
    const uint64_t hash = film_hash(r->img);
    render_result_destroy(r);
    scene_destroy(s);
    return hash;
}

static void basic_and_classic_radiance_agree_without_refraction(void **state)
{
    (void)state;
    static const char *const straight[] = {
        "vessel.ior=1 liquid.ior=1", "render.transmission=simple clear.transparency=0.9", "render.integrator=zbuffer"};
    for (size_t k = 0; k < COUNT(straight); k++) {
        char basic[128];
        snprintf(basic, sizeof basic, "%s render.radiance=basic", straight[k]);
        assert_true(hash_of(straight[k]) == hash_of(basic));
    }
    assert_true(hash_of("") != hash_of("render.radiance=basic"));
}

static void the_film_does_not_depend_on_threads(void **state)
{
    (void)state;
    static const char *const modes[] = {"", "camera.position=0,1.2,0", "render.spectrum=spectral",
                                        "render.integrator=path render.paths=16"};
    for (size_t k = 0; k < COUNT(modes); k++) {
        char one[160], many[160];
        snprintf(one, sizeof one, "render.radiance=basic render.threads=1 %s", modes[k]);
        snprintf(many, sizeof many, "render.radiance=basic render.threads=5 render.schedule=tiles render.tile=7 %s",
                 modes[k]);
        assert_true(hash_of(one) == hash_of(many));
    }
}

/* The traced rays do not depend on the kind of radiance: throughputs are shares of the camera ray, in any medium. */
static void the_kind_of_radiance_does_not_change_the_rays(void **state)
{
    (void)state;
    need_counters();
    scene *s =
        rod_scene("render.width=80 render.height=60 render.depth=8 render.min_weight=0.01 camera.position=0.2,1.2,0.3");
    render_result *classic = render(s);
    set(s, "render.radiance=basic");
    render_result *basic = render(s);
    assert_true(classic->counters.cut_weight > 100 && classic->counters.cut_weight == basic->counters.cut_weight);
    assert_true(classic->counters.refract == basic->counters.refract &&
                classic->counters.reflect == basic->counters.reflect);
    render_result_destroy(classic);
    render_result_destroy(basic);
    scene_destroy(s);
}

/* --- values in ray trees */

static void a_tree_contains_the_radiance_factor_of_each_refraction(void **state)
{
    (void)state;
    stage g = stage_of(diver, "water.ior=1.5 water.transparency=0.9");
    diagnostic why = {0};
    for (int settings = 0; settings < 2; settings++) {
        worked(probe_ray(g.probe, vec3_make(0.0, 0.5, 0.0), vec3_make(0.3, 1.0, 0.0), &g.tree, &why), &why);
        const double angle = atan(0.3), T = 0.9 * through(angle, 1.5, 1.0);
        const ray_hit *h = &g.tree.node[0].hit;
        assert_true(fabs(h->T - T) < 1e-14 && fabs(h->gain_classic - T) < 1e-14 &&
                    fabs(h->gain_basic - 2.25 * T) < 1e-14);
        assert_true(fabs(g.tree.radiance[0] - (settings ? h->gain_basic : h->gain_classic)) < 1e-12);
        set(g.setting, "render.radiance=basic");
        stage_look(&g);
    }
    /* Beyond the critical angle. */
    worked(probe_ray(g.probe, vec3_make(0.0, 0.5, 0.0), vec3_make(1.0, 1.0, 0.0), &g.tree, &why), &why);
    assert_true(g.tree.node[0].hit.tir && g.tree.node[0].hit.gain_basic == 0.0);
    stage_close(&g);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_sky_from_under_water_has_the_square_of_the_index),
        cmocka_unit_test(random_paths_see_the_same_sky),
        cmocka_unit_test(each_wavelength_has_the_square_of_its_index),
        cmocka_unit_test(a_furnace_has_the_squared_index_of_the_cameras_medium),
        cmocka_unit_test(radiance_of_a_floor_decreases_on_leaving_water),
        cmocka_unit_test(radiance_is_unchanged_within_one_medium),
        cmocka_unit_test(direct_light_through_the_surface_has_its_transmittance),
        cmocka_unit_test(panes_shade_by_fresnel_on_both_faces),
        cmocka_unit_test(spheres_and_cylinders_shade_by_the_angle_of_the_straight_ray),
        cmocka_unit_test(each_interface_counts_once_with_its_own_indices),
        cmocka_unit_test(meshes_cast_the_same_shadows_as_solids),
        cmocka_unit_test(smooth_meshes_shade_by_interpolated_normals),
        cmocka_unit_test(whitted_ray_tracing_and_paths_agree_on_a_dark_floor_under_water),
        cmocka_unit_test(the_radiance_of_a_light_sphere_refers_to_its_medium),
        cmocka_unit_test(direct_light_of_a_sphere_is_emitted_into_its_medium),
        cmocka_unit_test(basic_and_classic_radiance_agree_without_refraction),
        cmocka_unit_test(the_film_does_not_depend_on_threads),
        cmocka_unit_test(the_kind_of_radiance_does_not_change_the_rays),
        cmocka_unit_test(a_tree_contains_the_radiance_factor_of_each_refraction),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
