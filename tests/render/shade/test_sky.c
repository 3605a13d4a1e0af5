/* Tests of skies: gradient, equirectangular image, and the CIE standard general sky. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "optics/cie_sky.h"
#include "quad.h"
#include "random_stream.h"
#include "render/plan/sky.h"
#include "render_fixture.h"
#include "scene/model/scene.h"

/* Gradient, equirectangular image, and the mean over all directions. */

#define assert_near(a, b, tolerance) assert_true(fabs((a) - (b)) <= (tolerance))

static void expect_radiance(vec3 got, double r, double g, double b)
{
    assert_near(got.x, r, 1e-12);
    assert_near(got.y, g, 1e-12);
    assert_near(got.z, b, 1e-12);
}

/* longitude 0 is +z, 90 is +x */
static vec3 towards(double longitude, double latitude)
{
    quad s, c, sl, cl;
    quad_sincos_deg(longitude, &s, &c);
    quad_sincos_deg(latitude, &sl, &cl);
    return vec3_make((double)(cl * s), (double)sl, (double)(cl * c));
}

static void a_uniform_sky_is_constant(void **state)
{
    (void)state;
    const background sky = {.kind = BACKGROUND_UNIFORM, .color = {0.1, 0.2, 0.3}, .horizon = {1.0, 1.0, 1.0}};
    uint64_t seed = 1;
    for (int i = 0; i < 100; i++)
        expect_radiance(sky_radiance(&sky, random_direction(&seed)), 0.1, 0.2, 0.3);
}

/* Linear in the direction's height, and the horizon's colour below the horizon. */
static void a_gradient_rises_with_the_sine_of_the_height(void **state)
{
    (void)state;
    const background sky = {.kind = BACKGROUND_GRADIENT, .color = {1.0, 0.0, 0.5}, .horizon = {0.0, 1.0, 0.5}};
    expect_radiance(sky_radiance(&sky, vec3_make(0.0, 1.0, 0.0)), 1.0, 0.0, 0.5);
    expect_radiance(sky_radiance(&sky, vec3_make(0.6, 0.8, 0.0)), 0.8, 0.2, 0.5);
    expect_radiance(sky_radiance(&sky, vec3_make(0.0, 0.28, -0.96)), 0.28, 0.72, 0.5);
    expect_radiance(sky_radiance(&sky, vec3_make(1.0, 0.0, 0.0)), 0.0, 1.0, 0.5);
    expect_radiance(sky_radiance(&sky, vec3_make(0.0, -1.0, 0.0)), 0.0, 1.0, 0.5);
}

enum { WIDTH = 8, HEIGHT = 4 };

/* Column in red, row in green. */
static image *numbered(void)
{
    image *img = NULL;
    assert_int_equal(image_create(WIDTH, HEIGHT, &img, NULL), STATUS_OK);
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++) {
            float *p = &img->pixel[(y * WIDTH + x) * 3];
            p[0] = (float)x;
            p[1] = (float)y;
            p[2] = 0.5f;
        }
    return img;
}

static void each_texel_of_an_image_sky_has_its_direction(void **state)
{
    (void)state;
    image *img = numbered();
    const background sky = {.kind = BACKGROUND_IMAGE, .img = img, .brightness = 1.0};
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++) {
            /* the middle column is +z, the right half +x, the top row straight up */
            const double longitude = (x + 0.5) / WIDTH * 360.0 - 180.0, latitude = 90.0 - (y + 0.5) / HEIGHT * 180.0;
            expect_radiance(sky_radiance(&sky, towards(longitude, latitude)), x, y, 0.5);
        }
    expect_radiance(sky_radiance(&sky, vec3_make(0.0, 0.0, 1.0)), 3.5, 1.5, 0.5);
    expect_radiance(sky_radiance(&sky, vec3_make(1.0, 0.0, 0.0)), 5.5, 1.5, 0.5);
    expect_radiance(sky_radiance(&sky, vec3_make(-1.0, 0.0, 0.0)), 1.5, 1.5, 0.5);
    image_destroy(img);
}

static void an_image_wraps_around_and_ends_at_the_poles(void **state)
{
    (void)state;
    image *img = numbered();
    const background sky = {.kind = BACKGROUND_IMAGE, .img = img, .brightness = 1.0};
    const double step = 360.0 / WIDTH;
    for (int k = -4; k <= 4; k++) { /* across the seam from column 7 to column 0 */
        const double share = 0.5 + k / 8.0;
        expect_radiance(sky_radiance(&sky, towards(180.0 + k / 8.0 * step, 22.5)), 7.0 * (1.0 - share), 1.0, 0.5);
    }
    assert_near(sky_radiance(&sky, vec3_make(0.0, 1.0, 0.0)).y, 0.0, 1e-12);
    assert_near(sky_radiance(&sky, vec3_make(0.0, -1.0, 0.0)).y, HEIGHT - 1.0, 1e-12);
    assert_near(sky_radiance(&sky, towards(10.0, 80.0)).y, 0.0, 1e-12); /* above the first row's middle */
    assert_near(sky_radiance(&sky, towards(10.0, 45.0)).y, 0.5, 1e-12); /* between the first two */
    image_destroy(img);
}

/* The mean over the sphere, by the midpoint rule on each part between texels' middles, where the interpolation is
 * smooth. */
static vec3 mean_by_quadrature(const background *sky, int parts)
{
    vec3 sum = {0.0, 0.0, 0.0};
    double weights = 0.0;
    for (int j = 0; j < parts; j++) {
        const double latitude = (j + 0.5) / parts * 180.0 - 90.0, weight = cos(latitude * 3.141592653589793 / 180.0);
        for (int i = 0; i < 2 * parts; i++)
            sum = vec3_add(
                sum, vec3_scale(sky_radiance(sky, towards((i + 0.5) / (2 * parts) * 360.0 - 180.0, latitude)), weight));
        weights += 2.0 * parts * weight;
    }
    return vec3_scale(sum, 1.0 / weights);
}

static void the_mean_is_weighted_by_solid_angle(void **state)
{
    (void)state;
    const background plain = {.kind = BACKGROUND_UNIFORM, .color = {0.1, 0.2, 0.3}, .horizon = {1.0, 1.0, 1.0}};
    expect_radiance(sky_mean(&plain), 0.1, 0.2, 0.3);
    const background rising = {.kind = BACKGROUND_GRADIENT, .color = {1.0, 0.0, 0.5}, .horizon = {0.0, 1.0, 0.5}};
    expect_radiance(sky_mean(&rising), 0.25, 0.75, 0.5);
    const vec3 seen = mean_by_quadrature(&rising, 200);
    assert_near(seen.x, 0.25, 1e-4);
    image *img = numbered();
    const background panorama = {.kind = BACKGROUND_IMAGE, .img = img, .brightness = 1.0};
    const vec3 mean = sky_mean(&panorama), close = mean_by_quadrature(&panorama, 400);
    assert_near(mean.x, 3.5, 1e-12);
    assert_near(mean.y, 1.5, 1e-12); /* symmetric rows */
    assert_near(mean.z, 0.5, 1e-12);
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++)
            img->pixel[(y * WIDTH + x) * 3 + 1] = (float)(y * y); /* asymmetric rows */
    assert_near(sky_mean(&panorama).y, mean_by_quadrature(&panorama, 400).y, 2e-5);
    assert_near(close.x, 3.5, 1e-9);
    image_destroy(img);
}

/* One row is constant over the sphere; of two rows, each covers one half. */
static void the_mean_of_images_with_one_and_two_rows(void **state)
{
    (void)state;
    for (int height = 1; height <= 3; height++) {
        image *img = NULL;
        assert_int_equal(image_create(1, height, &img, NULL), STATUS_OK);
        for (int y = 0; y < height; y++)
            for (int c = 0; c < 3; c++)
                img->pixel[y * 3 + c] = c == 1 ? (float)y : 2.0f;
        const background sky = {.kind = BACKGROUND_IMAGE, .img = img, .brightness = 1.0};
        expect_radiance(sky_mean(&sky), 2.0, 0.5 * (height - 1), 2.0);
        image_destroy(img);
    }
}

/* The CIE standard general sky: its published types, the older formulas that two of them follow, and its light
 * on a level surface by an integral of the test's own. */

#define PI 3.14159265358979323846
#define RAD (PI / 180.0)
#define assert_close(a, b, tolerance)                                   \
    do {                                                                \
        if (!(fabs((a) - (b)) <= (tolerance)))                          \
            fail_msg("%.9g instead of %.9g", (double)(a), (double)(b)); \
    } while (0)

/* Darula and Kittler 2002, table 1: groups of gradation I .. VI and of indicatrix 1 .. 6 by type, and table 2. */
static const int groups[CIE_SKY_TYPES][2] = {{1, 1}, {1, 2}, {2, 1}, {2, 2}, {3, 1}, {3, 2}, {3, 3}, {3, 4},
                                             {4, 2}, {4, 3}, {4, 4}, {5, 4}, {5, 5}, {6, 5}, {6, 6}};
static const double gradations[6][2] = {{4.0, -0.7},   {1.1, -0.8},   {0.0, -1.0},
                                        {-1.0, -0.55}, {-1.0, -0.32}, {-1.0, -0.15}};
static const double indicatrices[6][3] = {{0.0, -1.0, 0.0},   {2.0, -1.5, 0.15}, {5.0, -2.5, 0.3},
                                          {10.0, -3.0, 0.45}, {16.0, -3.0, 0.3}, {24.0, -2.8, 0.15}};

static vec3 direction_of(double zenith, double azimuth)
{
    return vec3_make(sin(zenith) * sin(azimuth), cos(zenith), sin(zenith) * cos(azimuth));
}

/* By libm. */
static double relative(int type, double zenith, double azimuth, double sun)
{
    const double *g = gradations[groups[type - 1][0] - 1], *i = indicatrices[groups[type - 1][1] - 1];
    const double cosine = cos(zenith) * cos(sun) + sin(zenith) * sin(sun) * cos(azimuth);
    const double angle = acos(fmax(-1.0, fmin(1.0, cosine)));
    const double f = 1.0 + i[0] * (exp(i[1] * angle) - exp(i[1] * PI / 2.0)) + i[2] * pow(cos(angle), 2.0),
                 f_z = 1.0 + i[0] * (exp(i[1] * sun) - exp(i[1] * PI / 2.0)) + i[2] * pow(cos(sun), 2.0);
    return f * (1.0 + g[0] * exp(g[1] / cos(zenith))) / (f_z * (1.0 + g[0] * exp(g[1])));
}

static void types_are_those_of_the_standard(void **state)
{
    (void)state;
    for (int type = 1; type <= CIE_SKY_TYPES; type++) {
        const cie_sky_type t = cie_sky_type_of(type);
        const double *g = gradations[groups[type - 1][0] - 1], *i = indicatrices[groups[type - 1][1] - 1];
        assert_true(t.a == g[0] && t.b == g[1] && t.c == i[0] && t.d == i[1] && t.e == i[2]);
        for (double sun = 5.0; sun < 90.0; sun += 20.0) {
            const cie_sky sky = cie_sky_make(type, direction_of(sun * RAD, 0.0));
            assert_close(cie_sky_relative(&sky, vec3_make(0.0, 1.0, 0.0)), 1.0, 1e-12);
            for (double zenith = 3.0; zenith < 90.0; zenith += 14.0)
                for (double azimuth = 0.0; azimuth < 360.0; azimuth += 50.0) {
                    const double expected = relative(type, zenith * RAD, azimuth * RAD, sun * RAD);
                    assert_close(cie_sky_relative(&sky, direction_of(zenith * RAD, azimuth * RAD)), expected,
                                 1e-7 * expected);
                }
        }
    }
}

/* Kittler's clear sky (CIE 22, 1973), of which type 12 is the same with its constants in full: 0.274 is 1 - exp(-0.32),
 * 0.91 is 1 - 10 exp(-3 pi / 2). */
static void type_12_is_kittlers_clear_sky(void **state)
{
    (void)state;
    const double sun = 40.0 * RAD;
    const cie_sky sky = cie_sky_make(CIE_SKY_CLEAR, direction_of(sun, 0.0));
    for (double zenith = 0.0; zenith < 90.0; zenith += 11.0)
        for (double azimuth = 0.0; azimuth < 181.0; azimuth += 30.0) {
            const vec3 d = direction_of(zenith * RAD, azimuth * RAD);
            const double angle = acos(fmin(vec3_dot(d, sky.to_sun), 1.0)),
                         expected = (1.0 - exp(-0.32 / cos(zenith * RAD))) *
                                    (0.91 + 10.0 * exp(-3.0 * angle) + 0.45 * pow(cos(angle), 2.0)) /
                                    (0.274 * (0.91 + 10.0 * exp(-3.0 * sun) + 0.45 * pow(cos(sun), 2.0)));
            assert_close(cie_sky_relative(&sky, d), expected, 2e-3 * expected);
        }
}

/* Moon and Spencer's overcast sky, (1 + 2 sin h) / 3, a third of the zenith's luminance at the horizon; type 5 is
 * even. */
static void type_1_is_nearly_moon_and_spencers_overcast_sky(void **state)
{
    (void)state;
    const cie_sky sky = cie_sky_make(CIE_SKY_OVERCAST, direction_of(0.3, 0.0)),
                  even = cie_sky_make(CIE_SKY_UNIFORM, direction_of(0.3, 0.0));
    for (double height = 0.001; height < 90.0; height += 10.0) {
        const vec3 d = direction_of((90.0 - height) * RAD, 1.0);
        assert_close(cie_sky_relative(&sky, d), (1.0 + 2.0 * sin(height * RAD)) / 3.0, 0.1);
        assert_close(cie_sky_relative(&even, d), 1.0, 1e-15);
    }
    assert_close(cie_sky_relative(&sky, direction_of(PI / 2.0 - 1e-9, 0.0)), 1.0 / (1.0 + 4.0 * exp(-0.7)), 1e-12);
    assert_close(1.0 / (1.0 + 4.0 * exp(-0.7)), 1.0 / 3.0, 0.003);
}

/* The integral over the upper hemisphere of the relative luminance times cos^power Z, by the midpoint rule in Z and
 * azimuth. */
static double integral(int type, double sun, int power)
{
    enum { STEPS = 1200 };
    double sum = 0.0;
    for (int i = 0; i < STEPS; i++) {
        const double zenith = (i + 0.5) / STEPS * PI / 2.0;
        for (int k = 0; k < STEPS / 4; k++)
            sum += relative(type, zenith, (k + 0.5) / (STEPS / 4) * PI, sun) * pow(cos(zenith), power) * sin(zenith);
    }
    return sum * (PI / 2.0 / STEPS) * (2.0 * PI / (STEPS / 4));
}

/* A matte white floor under the sky has the radiance of its irradiance over pi. */
static void a_floor_has_its_irradiance(void **state)
{
    (void)state;
    scene *s = scene_from("render: {width: 1, height: 1, depth: 1, integrator: path, paths: 65536, beyond: black}\n"
                          "camera: {position: [0, 2, -2], target: [0, 0, 0], fov_deg: 0.01}\n"
                          "background: {kind: cie, color: [0.5, 0.25, 1], horizon: [9, 9, 9]}\n"
                          "solids: {floor: {shape: plane, diffuse: 1}}\n");
    static const int types[] = {1, 5, 8, 12, 15};
    for (int k = 0; k < 5; k++) {
        char assignment[120];
        snprintf(assignment, sizeof assignment,
                 "background.sky_type=%d background.sun_elevation_deg=50 background.sun_azimuth_deg=20", types[k]);
        set_all(s, assignment);
        const double expected = integral(types[k], 40.0 * RAD, 1) / PI;
        const vec3 seen = look(s);
        assert_close(seen.x, 0.5 * expected, 0.004 * expected);
        assert_close(seen.z, expected, 0.008 * expected);
    }
    scene_destroy(s);
}

static void its_mean_is_that_of_all_directions(void **state)
{
    (void)state;
    for (int type = 1; type <= CIE_SKY_TYPES; type += 2) {
        const cie_sky sky = cie_sky_make(type, direction_of(40.0 * RAD, 1.0));
        const double expected = integral(type, 40.0 * RAD, 0) / (2.0 * PI);
        assert_close(cie_sky_mean(&sky), expected, 2e-4 * expected);
    }
    /* render.beyond=mean: half of it the ground's colour */
    scene *s = scene_from("render: {width: 1, height: 1, depth: 0, beyond: mean}\n"
                          "camera: {position: [0, 2, -2], target: [0, 0, 0], fov_deg: 0.01}\n"
                          "background: {kind: cie, color: [0.5, 0.5, 0.5], horizon: [0.2, 0.2, 0.2]}\n"
                          "solids: {floor: {shape: plane, reflectivity: 1}}\n");
    const double expected = 0.1 + 0.25 * integral(12, 70.0 * RAD, 0) / (2.0 * PI);
    assert_close(look(s).x, expected, 2e-4);
    set_all(s, "render.spectrum=spectral render.wavelengths=64");
    assert_close(look(s).x, expected, 1e-3);
    scene_destroy(s);
}

/* Seen by the camera, in films of three channels and by wavelength; below the horizon it is the ground's colour. */
static void a_camera_sees_it(void **state)
{
    (void)state;
    scene *s = scene_from("render: {width: 1, height: 1, wavelengths: 64}\n"
                          "camera: {position: [0, 0, 0], target: [0, 1, 1], fov_deg: 0.01}\n"
                          "background: {kind: cie, color: [0.3, 0.3, 0.3], horizon: [0.1, 0.2, 0.3], "
                          "sun_elevation_deg: 30, sun_azimuth_deg: 60}\n");
    const double expected = 0.3 * relative(12, 45.0 * RAD, 60.0 * RAD, 60.0 * RAD);
    assert_close(look(s).x, expected, 1e-6);
    set(s, "render.spectrum=spectral");
    assert_close(look(s).x, expected, 1e-3);
    set_all(s, "render.spectrum=rgb camera.target=0,-1,1");
    assert_close(look(s).y, 0.2, 1e-6);
    set(s, "render.spectrum=spectral");
    assert_close(look(s).y, 0.2, 1e-3);
    scene_destroy(s);
}

/* A light of kind sun is the sky's sun; otherwise the angles are. */
static void the_sun_is_where_its_light_comes_from(void **state)
{
    (void)state;
    scene *s =
        scene_from("render: {width: 1, height: 1}\n"
                   "camera: {position: [0, 0, 0], target: [0, 1, 1], fov_deg: 0.01}\n"
                   "background: {kind: cie, color: [0.3, 0.3, 0.3], sun_elevation_deg: 30, sun_azimuth_deg: 60}\n"
                   "lights: {lamp: {}, sun: {kind: sun, position: [5, 6, 9], target: [5, 5, 8]}}\n");
    assert_close(look(s).x, 0.3 * relative(12, 45.0 * RAD, 0.0, 45.0 * RAD), 1e-6);
    const vec3 to_sun = scene_to_sun(s);
    assert_close(to_sun.y, sqrt(0.5), 1e-15);
    set(s, "sun.kind=point");
    assert_null(scene_sun(s));
    assert_close(look(s).x, 0.3 * relative(12, 45.0 * RAD, 60.0 * RAD, 60.0 * RAD), 1e-6);
    scene_destroy(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_uniform_sky_is_constant),
        cmocka_unit_test(a_gradient_rises_with_the_sine_of_the_height),
        cmocka_unit_test(each_texel_of_an_image_sky_has_its_direction),
        cmocka_unit_test(an_image_wraps_around_and_ends_at_the_poles),
        cmocka_unit_test(the_mean_is_weighted_by_solid_angle),
        cmocka_unit_test(the_mean_of_images_with_one_and_two_rows),
        cmocka_unit_test(types_are_those_of_the_standard),
        cmocka_unit_test(type_12_is_kittlers_clear_sky),
        cmocka_unit_test(type_1_is_nearly_moon_and_spencers_overcast_sky),
        cmocka_unit_test(a_floor_has_its_irradiance),
        cmocka_unit_test(its_mean_is_that_of_all_directions),
        cmocka_unit_test(a_camera_sees_it),
        cmocka_unit_test(the_sun_is_where_its_light_comes_from),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
