/* Tests of suns: lights infinitely far away, of an angular diameter. A matte white surface under a disc of radiance L
 * has the radiance L F, with F the projected solid angle over pi. A sun of angular radius a whose irradiance across its
 * light is pi I has the radiance I / sin^2 a. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "render_fixture.h"
#include "scene/model/scene.h"

#define PI 3.14159265358979323846
#define RAD (PI / 180.0)
#define assert_near(a, b, tolerance)                                    \
    do {                                                                \
        if (!(fabs((a) - (b)) <= (tolerance)))                          \
            fail_msg("%.9g instead of %.9g", (double)(a), (double)(b)); \
    } while (0)

/* A small patch of a white floor at x, seen obliquely. */
#define PATCH                                                                                               \
    "render: {width: 24, height: 24, depth: 0, paths: 64, samples: 64, integrator: %s, soft_shadows: on}\n" \
    "camera: {position: [%.17g, 0.5, 0], target: [%.17g, 0, 0], fov_deg: 0.1}\n"                            \
    "background: {color: [0, 0, 0], ambient: [0, 0, 0]}\n"                                                  \
    "lights: {sun: {kind: sun, %s}}\n"                                                                      \
    "solids: {ground: {shape: plane, diffuse: 1}%s}\n"

typedef struct patch {
    const char *integrator, *sun, *solids, *assignments;
    double x;
} patch;

/* The mean over the image, first channel. */
static double mean_of(const patch *p)
{
    char text[1200];
    snprintf(text, sizeof text, PATCH, p->integrator, p->x + 3.0, p->x, p->sun, p->solids ? p->solids : "");
    scene *s = scene_from(text);
    set_all(s, p->assignments ? p->assignments : "");
    const double mean = mean_radiance(s);
    scene_destroy(s);
    return mean;
}

static const char *const integrators[] = {"path", "whitted", "raycast"};

/* Of a disc wholly above the horizon F / sin^2 a is the cosine to its centre (Siegel and Howell, appendix C), whatever
 * its size, and wherever the surface is. */
static void it_lights_by_its_cosine_everywhere(void **state)
{
    (void)state;
    static const double diameters[] = {0.0, 0.53, 50.0}, places[] = {0.0, 900.0};
    for (int k = 0; k < 3; k++)
        for (int d = 0; d < 3; d++)
            for (int x = 0; x < 2; x++) {
                char sun[120];
                snprintf(sun, sizeof sun,
                         "position: [3, 4, 0], target: [0, 0, 0], intensity: 2, angular_diameter_deg: %g",
                         diameters[d]);
                const double tolerance = diameters[d] > 1.0 ? 0.004 : 1e-5;
                assert_near(mean_of(&(patch){integrators[k], sun, NULL, NULL, places[x]}), 2.0 * 0.8, tolerance);
            }
    assert_near(mean_of(&(patch){"whitted", "position: [3, 4, 0]", NULL, "render.soft_shadows=off", 0.0}), 0.8, 1e-6);
    assert_near(mean_of(&(patch){"zbuffer", "position: [3, 4, 0]", NULL, "render.soft_shadows=off", 0.0}), 0.8, 1e-6);
}

/* Half of it above the horizon: F = (a - sin a cos a) / pi, the sphere's form factor at omega = 90 degrees. Below the
 * horizon it gives nothing, and just above the ground its light is stopped by the ground, however low it is. */
static void it_sets(void **state)
{
    (void)state;
    const double a = 20.0 * RAD, expected = (a - sin(a) * cos(a)) / (PI * sin(a) * sin(a));
    for (int k = 0; k < 3; k++) {
        assert_near(mean_of(&(patch){integrators[k], "position: [1, 0, 0], target: [0, 0, 0], angular_diameter_deg: 40",
                                     NULL, NULL, 0.0}),
                    expected, 0.005 * expected);
        assert_true(mean_of(&(patch){integrators[k], "position: [1, -1, 0], target: [0, 0, 0]", NULL, NULL, 0.0}) ==
                    0.0);
        static const char top[] = ", table: {shape: box, size: [8, 1, 8], position: [0, -0.6, 0], diffuse: 1}";
        assert_true(mean_of(&(patch){integrators[k], "position: [1, -0.01, 0], target: [0, 0, 0]", top, NULL, 0.0}) ==
                    0.0);
    }
}

/* A ball above the ground, lit from 0.004 degrees below the horizon: the ground, far away, is in the way. */
static void the_ground_is_in_the_way(void **state)
{
    (void)state;
    scene *s = scene_from("render: {width: 1, height: 1, depth: 0}\n"
                          "camera: {position: [5, 1, 0], target: [0, 1, 0], fov_deg: 0.1}\n"
                          "background: {color: [0, 0, 0], ambient: [0, 0, 0]}\n"
                          "lights: {sun: {kind: sun, position: [1, 1e-4, 0]}}\n"
                          "solids: {ground: {shape: plane, diffuse: 1}, ball: {shape: sphere, position: [0, 1, 0], "
                          "radius: 0.5, diffuse: 1}}\n");
    assert_near(look(s).x, 1.0, 1e-6);
    set(s, "sun.position=1,-7e-5,0");
    assert_true(look(s).x == 0.0);
    scene_destroy(s);
}

/* An edge at height h hides the directions beyond it: of the disc, as the floor sees it in projection, a circular
 * segment at the distance s = x / (h sin a) from its middle. */
static double visible(double s)
{
    return s >= 1.0 ? 1.0 : s <= -1.0 ? 0.0 : 0.5 + (s * sqrt(1.0 - s * s) + asin(s)) / PI;
}

static double behind_the_edge(const char *integrator, double height, double x)
{
    char board[200], eye[200]; /* that looks along the edge */
    snprintf(board, sizeof board, ", board: {shape: box, size: [8, 0.0001, 8], position: [-4, %.17g, 0]}", height);
    snprintf(eye, sizeof eye, "camera.fov_deg=0.001 camera.position=%.17g,0.4,3", x);
    return mean_of(&(patch){integrator, "position: [0, 9, 0], target: [0, 0, 0]", board, eye, x});
}

static void a_penumbra_is_a_circular_segment(void **state)
{
    (void)state;
    const double a = 0.265 * RAD;
    for (int k = 0; k < 3; k++)
        for (double height = 0.5; height <= 4.5; height *= 3.0)
            for (double s = -0.9; s < 0.95; s += 0.3)
                assert_near(behind_the_edge(integrators[k], height, s * height * sin(a)), visible(s), 0.004);
}

/* Its width is the distance times the angular diameter: full light and full shadow just beyond its ends. */
static void a_penumbra_has_the_width_of_the_disc(void **state)
{
    (void)state;
    const double half = 2.0 * tan(0.265 * RAD);
    for (int k = 0; k < 3; k++) {
        assert_true(behind_the_edge(integrators[k], 2.0, -1.01 * half) == 0.0);
        assert_near(behind_the_edge(integrators[k], 2.0, 1.01 * half), 1.0, 1e-4);
        assert_true(behind_the_edge(integrators[k], 2.0, -0.96 * half) > 0.0);
        assert_true(behind_the_edge(integrators[k], 2.0, 0.96 * half) < 0.9999);
    }
}

/* Paths from the camera see its disc before the sky: with its radiance, directly, in a mirror, and through a pane,
 * which transmits (1 - R) / (1 + R). Ray trees do not, as of other lights. */
static void a_path_sees_its_disc(void **state)
{
    (void)state;
    static const char text[] =
        "render: {width: 1, height: 1, integrator: path, paths: 64, depth: 40}\n"
        "camera: {position: [0, 0, 0], target: [0, 3, 4], fov_deg: 0.01}\n"
        "background: {color: [0.25, 0.25, 0.25], ambient: [0, 0, 0]}\n"
        "lights: {sun: {kind: sun, position: [0, 3, 4], intensity: 1e-3}}\n"
        "solids: {mirror: {shape: box, position: [0, -2, 0], size: [9, 2, 9], reflectivity: 0.5}, "
        "pane: {shape: box, position: [0, 0, 4], size: [9, 9, 0.1], rotation: [-36.86989764584402, "
        "0, 0], transparency: 1, ior: 2, visible: off}}\n";
    scene *s = scene_from(text);
    const double sine = sin(0.265 * RAD), radiance = 1e-3 / (sine * sine);
    assert_near(look(s).x, 0.25 + radiance, 1e-4);
    set(s, "camera.target=0,-3,4");
    assert_near(look(s).x, 0.5 * (0.25 + radiance), 1e-4);
    set_all(s, "pane.visible=on camera.target=0,3,4 render.paths=65536");
    assert_near(look(s).x, 0.25 + radiance * 0.8, 0.01 * radiance);
    set_all(s, "pane.visible=off render.paths=64 camera.target=0,3,4.2");
    assert_near(look(s).x, 0.25, 1e-6);
    set_all(s, "camera.target=0,3,4 render.integrator=whitted");
    assert_near(look(s).x, 0.25, 1e-6);
    scene_destroy(s);
}

/* A pixel that the disc fills in part has its share of solid angle. */
static void the_disc_has_its_solid_angle(void **state)
{
    (void)state;
    scene *s = scene_from("render: {width: 9, height: 9, integrator: path, paths: 16384}\n"
                          "camera: {position: [0, 0, 0], target: [0, 3, 4], fov_deg: 0.9}\n"
                          "background: {color: [0, 0, 0]}\n"
                          "lights: {sun: {kind: sun, position: [0, 3, 4], intensity: 1e-3}}\n");
    const double sine = sin(0.265 * RAD), tangent = tan(0.265 * RAD), side = 2.0 * tan(0.45 * RAD);
    render_result *r = render(s);
    double sum = 0.0;
    for (int i = 0; i < 81; i++)
        sum += film_value(r->img, i % 9, i / 9, 0) / 81.0;
    const double expected = 1e-3 / (sine * sine) * PI * tangent * tangent / (side * side);
    assert_near(sum, expected, 0.003 * expected);
    render_result_destroy(r);
    scene_destroy(s);
}

/* Schlick's notation: what a pane transmits of unpolarised light with all reflections between its faces, the mean of
 * (1 - R) / (1 + R) over both polarisations (Born and Wolf 1.5.3 and 7.6.1 without interference). */
static double pane(double angle, double n)
{
    const double refracted = asin(sin(angle) / n), ci = cos(angle), ct = cos(refracted);
    const double s = (ci - n * ct) / (ci + n * ct), p = (n * ci - ct) / (n * ci + ct);
    return 0.5 * ((1.0 - s * s) / (1.0 + s * s) + (1.0 - p * p) / (1.0 + p * p));
}

/* Photons through a slab, straight down and obliquely, from the disc and from one direction. */
static void photons_fall_through_a_slab(void **state)
{
    (void)state;
    static const char slab[] =
        ", slab: {shape: box, position: [0, 2, 0], size: [6, 0.5, 6], transparency: 1, ior: 1.6}";
    static const char photons[] = "render.depth=12 render.caustics=photons render.photons=200000 camera.fov_deg=5 "
                                  "render.samples=16 render.polarisation=on";
    for (double angle = 0.0; angle < 45.0; angle += 40.0)
        for (int point = 0; point < 2; point++) {
            char sun[120];
            snprintf(sun, sizeof sun, "position: [0, %.17g, %.17g], target: [0, 0, 0]%s", cos(angle * RAD),
                     sin(angle * RAD), point ? ", angular_diameter_deg: 0" : "");
            const double expected = cos(angle * RAD) * pane(angle * RAD, 1.6);
            for (int k = 1; k < 3; k++) /* random paths also have light that the floor and the slab exchange */
                assert_near(mean_of(&(patch){integrators[k], sun, slab, photons, 0.0}), expected, 0.01 * expected);
        }
}

/* Photons from mirrors without bounds: a plane that lights the ceiling with what falls on it. And a mirror that is out
 * of the light does not. */
static void photons_reach_a_ceiling_from_a_mirror(void **state)
{
    (void)state;
    static const char text[] =
        "render: {width: 12, height: 12, depth: 4, samples: 4, caustics: photons, photons: 500000}\n"
        "camera: {position: [0, 1, 0], target: [2, 3, 0.01], fov_deg: 5}\n"
        "background: {color: [0, 0, 0], ambient: [0, 0, 0]}\n"
        "lights: {sun: {kind: sun, position: [0, 3, 4], intensity: 2}}\n"
        "solids: {floor: {shape: plane, reflectivity: 0.7}, ceiling: {shape: box, position: [2, 3.1, 0], "
        "size: [2, 0.2, 2], diffuse: 1}, roof: {shape: box, position: [0, 9, 12], size: [20, 0.1, 20], visible: "
        "off}}\n";
    scene *s = scene_from(text);
    for (int shaded = 0; shaded < 2; shaded++) {
        if (shaded)
            set(s, "roof.visible=on");
        render_result *r = render(s);
        double sum = 0.0;
        for (int i = 0; i < 144; i++)
            sum += film_value(r->img, i % 12, i / 12, 0) / 144.0;
        assert_near(sum, shaded ? 0.0 : 2.0 * 0.6 * 0.7, 0.03);
        render_result_destroy(r);
    }
    scene_destroy(s);
}

/* What a sphere of the same angular radius, very far away, lights: rough surfaces, media that scatter, the choice of
 * one light of several, a glass ball's caustic. Lights of that kind have their own tests. */
static void it_is_a_sphere_at_infinity(void **state)
{
    (void)state;
    static const char text[] =
        "render: {width: 16, height: 12, depth: 6, integrator: path, paths: 512, filter: box}\n"
        "camera: {position: [0, 2, -6], target: [0, 0.6, 0], fov_deg: 40}\n"
        "background: {color: [0, 0, 0]}\n"
        "lights: {sun: {kind: %s, position: [%s], target: [0, 0, 0], intensity: 1, angular_diameter_deg: 4%s}, "
        "lamp: {position: [3, 2, -2], intensity: 0.4}}\n"
        "solids: {ground: {shape: plane, diffuse: 0.5, reflectivity: 0.3, roughness: 0.3}, "
        "glass: {shape: sphere, position: [-1.2, 0.8, 0], radius: 0.7, transparency: 1, ior: 1.5, roughness: 0.2}, "
        "milk: {shape: box, position: [1.2, 0.8, 0], size: [1.2, 1.2, 1.2], transparency: 1, ior: 1, scatter_per_m: "
        "1}}\n";
    double mean[2][3];
    for (int far = 0; far < 2; far++) {
        char all[1600], size[80];
        snprintf(size, sizeof size, ", reach: 50000, radius: %.17g", 5e4 * sin(2.0 * RAD));
        snprintf(all, sizeof all, text, far ? "point" : "sun",
                 far ? "20000, 40000, -22360.6797749979" : "2, 4, -2.23606797749979", far ? size : "");
        scene *s = scene_from(all);
        render_result *r = render(s);
        for (int part = 0; part < 3; part++) {
            mean[far][part] = 0.0;
            for (int y = 0; y < 12; y++)
                for (int x = 0; x < 16; x++)
                    mean[far][part] += x * 3 / 16 == part ? film_value(r->img, x, y, 1) / 64.0 : 0.0;
        }
        render_result_destroy(r);
        scene_destroy(s);
    }
    for (int part = 0; part < 3; part++)
        assert_near(mean[0][part], mean[1][part], 0.02 * mean[1][part]);
}

/* Absorption by the surroundings between the camera and the ground, but not on the infinite way to the sun; and by a
 * box in the way, by its own thickness. */
static void the_surroundings_do_not_hide_it(void **state)
{
    (void)state;
    static const char box[] = ", pool: {shape: box, position: [0, 2, 0], size: [8, 0.5, 8], transparency: 1, ior: 1, "
                              "absorb_per_m: [0.6, 0.6, 0.6]}";
    const double distance = sqrt(9.0 + 0.25);
    for (int k = 0; k < 3; k++) {
        const patch open = {integrators[k], "position: [0, 1, 0], target: [0, 0, 0], angular_diameter_deg: 0", NULL,
                            "background.absorb_per_m=0.1,0.1,0.1", 0.0};
        patch roofed = open;
        roofed.solids = box;
        assert_near(mean_of(&open), exp(-0.1 * distance), 1e-4);
        assert_near(mean_of(&roofed), exp(-0.1 * (distance + 1.75) - 0.6 * 0.5), 1e-4);
    }
}

static void one_film_on_all_instruction_sets(void **state)
{
    (void)state;
    static const char text[] =
        "render: {width: 40, height: 30, depth: 3, samples: 9, soft_shadows: on}\n"
        "camera: {position: [3, 2, 0], target: [0, 0.3, 0], fov_deg: 50}\n"
        "lights: {sun: {kind: sun, position: [1, 3, 1], target: [0, 0, 0]}, other: {kind: sun, position: [-1, 3, 1], "
        "angular_diameter_deg: 0, intensity: 0.3}}\n"
        "solids: {ground: {shape: plane, diffuse: 1}, ball: {shape: sphere, position: [0, 0.5, 0], radius: 0.5, "
        "transparency: 1, ior: 1.5, specular: 0.4}}\n";
    static const char *const modes[] = {"", "render.integrator=path render.paths=8",
                                        "render.caustics=photons render.photons=20000"};
    scene *s = scene_from(text);
    for (int mode = 0; mode < 3; mode++) {
        set_all(s, modes[mode]);
        set(s, "render.threads=1");
        render_result *best = render(s);
        for (isa level = (isa)0; level <= isa_best(); level++) {
            render_result *other = render_at(s, level, NULL);
            assert_true(film_hash(other->img) == film_hash(best->img));
            render_result_destroy(other);
        }
        set(s, "render.threads=3");
        render_result *threads = render(s);
        assert_true(film_hash(threads->img) == film_hash(best->img));
        render_result_destroy(threads);
        render_result_destroy(best);
    }
    scene_destroy(s);
}

/* Where the scene is makes no difference, nor a solid that no light meets. */
static void its_place_does_not_matter(void **state)
{
    (void)state;
    const patch here = {"path", "position: [3, 4, 0], target: [0, 0, 0]", NULL, NULL, 0.0};
    patch there = here, crowded = here;
    there.sun = "position: [1003, 504, 70], target: [1000, 500, 70]";
    crowded.solids = ", far: {shape: sphere, position: [0, -4000, 0], radius: 1, diffuse: 1}";
    assert_true(mean_of(&here) == mean_of(&crowded));
    assert_near(mean_of(&here), mean_of(&there), 1e-9);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(it_lights_by_its_cosine_everywhere),
        cmocka_unit_test(it_sets),
        cmocka_unit_test(the_ground_is_in_the_way),
        cmocka_unit_test(a_penumbra_is_a_circular_segment),
        cmocka_unit_test(a_penumbra_has_the_width_of_the_disc),
        cmocka_unit_test(a_path_sees_its_disc),
        cmocka_unit_test(the_disc_has_its_solid_angle),
        cmocka_unit_test(photons_fall_through_a_slab),
        cmocka_unit_test(photons_reach_a_ceiling_from_a_mirror),
        cmocka_unit_test(it_is_a_sphere_at_infinity),
        cmocka_unit_test(the_surroundings_do_not_hide_it),
        cmocka_unit_test(one_film_on_all_instruction_sets),
        cmocka_unit_test(its_place_does_not_matter),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
