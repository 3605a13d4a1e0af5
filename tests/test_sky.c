/* Tests of the sky: gradient, equirectangular image, and the mean over all directions. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "quad.h"
#include "random_stream.h"
#include "render/plan/sky.h"

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
    const background sky = {.kind = BACKGROUND_IMAGE, .img = img};
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
    const background sky = {.kind = BACKGROUND_IMAGE, .img = img};
    const double texel = 360.0 / WIDTH;
    for (int k = -4; k <= 4; k++) { /* across the seam from column 7 to column 0 */
        const double share = 0.5 + k / 8.0;
        expect_radiance(sky_radiance(&sky, towards(180.0 + k / 8.0 * texel, 22.5)), 7.0 * (1.0 - share), 1.0, 0.5);
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
    const background panorama = {.kind = BACKGROUND_IMAGE, .img = img};
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
        const background sky = {.kind = BACKGROUND_IMAGE, .img = img};
        expect_radiance(sky_mean(&sky), 2.0, 0.5 * (height - 1), 2.0);
        image_destroy(img);
    }
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
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
