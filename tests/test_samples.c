/* Tests of pixel samples: the middles of k x k cells. One pixel covers, at z = 1, the square from -1 to 1, with a white
 * wall that ends at an edge: the wall's share is that of the cells whose middle it covers. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "render/plan/sampling.h"
#include "render_fixture.h"
#include "scene/model/scene.h"

#define assert_near(a, b, tolerance) assert_true(fabs((a) - (b)) <= (tolerance))

static const char wall[] = "render: {width: 1, height: 1, depth: 0}\n"
                           "camera: {position: [0, 0, 0], yaw_deg: 0, fov_deg: 90}\n"
                           "background: {color: [0, 0, 0], ambient: [1, 1, 1]}\n"
                           "solids: {wall: {shape: box, size: [20, 20, 1e-6], ambient: 1}}\n";

/* The number of k cells from -1 to 1 whose middle is below the edge. */
static int covered(int k, double edge)
{
    int count = 0;
    for (int i = 0; i < k; i++)
        count += (2.0 * i + 1.0) / k - 1.0 < edge;
    return count;
}

static void an_edge_covers_the_cells_whose_centre_is_inside(void **state)
{
    (void)state;
    static const double edges[] = {-0.95, -0.6, -0.3, 0.05, 0.31, 0.55, 0.9, 1.1};
    scene *s = scene_from(wall);
    for (int k = 1; k <= 8; k++) {
        s->render.samples = (int64_t)k * k;
        for (size_t i = 0; i < sizeof edges / sizeof *edges; i++) {
            const double expected = (double)covered(k, edges[i]) / k, rounding = k * k * 0x1p-44;
            s->solids[0].shape.position = vec3_make(edges[i] - 10.0, 0.0, 1.0);
            assert_near(look(s).x, expected, rounding);
            s->solids[0].shape.position = vec3_make(0.0, edges[i] - 10.0, 1.0);
            assert_near(look(s).y, expected, rounding);
        }
    }
    scene_destroy(s);
}

/* A corner distinguishes the cells in both directions at once. */
static void a_corner_covers_a_rectangle_of_cells(void **state)
{
    (void)state;
    scene *s = scene_from(wall);
    s->solids[0].shape.position = vec3_make(-0.45 - 10.0, 0.2 - 10.0, 1.0);
    for (int k = 1; k <= 8; k++) {
        s->render.samples = (int64_t)k * k;
        assert_near(look(s).x, (double)(covered(k, -0.45) * covered(k, 0.2)) / (k * k), k * k * 0x1p-44);
    }
    scene_destroy(s);
}

/* Wavelengths and random paths use the same points; sixteen paths are too few for 64 points, and use 16. */
static void other_films_use_the_same_points(void **state)
{
    (void)state;
    scene *s = scene_from(wall);
    set_all(s, "render.samples=64 render.spectrum=spectral render.wavelengths=8");
    s->solids[0].shape.position = vec3_make(0.05 - 10.0, 0.0, 1.0);
    assert_near(look(s).y, 4.0 / 8.0, 1e-9);
    s->solids[0].shape.position = vec3_make(0.2 - 10.0, 0.0, 1.0); /* the fifth column's middle is 0.125 */
    assert_near(look(s).y, 5.0 / 8.0, 1e-9);
    /* here the wall is black in front of a white sky */
    set_all(s,
            "render.spectrum=rgb render.integrator=path render.paths=64 render.filter=centre background.color=1,1,1");
    assert_near(look(s).y, 3.0 / 8.0, 1e-9);
    s->render.paths = 16; /* middles -0.75, -0.25, 0.25, 0.75 */
    assert_near(look(s).y, 2.0 / 4.0, 1e-9);
    scene_destroy(s);
}

/* The largest number of samples and wavelengths fits with the largest pixel and wavelength. */
static void the_largest_sample_and_pixel_fit_in_a_sample_key(void **state)
{
    (void)state;
    const int64_t pixel = SCENE_PIXELS_MAX - 1, sample = (int64_t)SCENE_SAMPLES_MAX * 65536 - 1, number = 3999;
    const int64_t sample_key =
        sample_key_with_wavelength(sample_key_make(pixel, sample), number) | SAMPLE_KEY_SPECULAR_BOUNCE;
    assert_true(sample_key > 0);
    assert_true(sample_key_pixel(sample_key) == pixel && sample_key_sample(sample_key) == sample &&
                sample_key_wavelength(sample_key) == number);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_edge_covers_the_cells_whose_centre_is_inside),
        cmocka_unit_test(a_corner_covers_a_rectangle_of_cells),
        cmocka_unit_test(other_films_use_the_same_points),
        cmocka_unit_test(the_largest_sample_and_pixel_fit_in_a_sample_key),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
