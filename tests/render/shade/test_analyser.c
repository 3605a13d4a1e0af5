/* Tests of the analyser before the eye: light that a glass surface reflects at an angle of incidence, whose
 * polarisation is known (Hecht, Optics, 8.2 and 8.6): of unpolarised light the powers R_s / 2 across the plane of
 * incidence and R_p / 2 in it. A linear analyser at an angle a from s transmits (R_s cos^2 a + R_p sin^2 a) / 2: at
 * Brewster's angle Malus's law, R_s / 2 cos^2 a. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <cmocka.h>

#include "render_fixture.h"
#include "scene/model/scene.h"
#include "zbuffer_fixture.h"

#define COUNT(a) (sizeof(a) / sizeof((a)[0]))
#define assert_near(a, b, tolerance) assert_true(fabs((a) - (b)) <= (tolerance))

static const double degree = 3.14159265358979323846 / 180.0;

/* Parallel rays, so that all of the image has one angle of incidence. The sky grows with the elevation. */
static const char lake[] = "render: {width: 8, height: 6, depth: 1, beyond: black, polarisation: \"on\"}\n"
                           "camera: {position: [0, 9, 0], yaw_deg: 0, projection: orthographic, view_height: 2}\n"
                           "background: {kind: gradient, color: [1, 1, 1], horizon: [0, 0, 0]}\n"
                           "solids: {glass: {shape: plane, transparency: 1, ior: 1.5}}\n";

/* Fresnel's equations in Hecht's form, 4.42 and 4.43 squared: the reflected power behind the analyser. */
static double transmitted(double incidence, double angle)
{
    const double refraction = asin(sin(incidence) / 1.5);
    const double s = sin(incidence - refraction) / sin(incidence + refraction),
                 p = tan(incidence - refraction) / tan(incidence + refraction);
    const double along = s * cos(angle), across = p * sin(angle);
    return 0.5 * (along * along + across * across) * cos(incidence);
}

static void assert_image(const scene *s, double expected, double tolerance)
{
    render_result *r = render(s);
    for (int k = 0; k < 48; k++)
        for (int c = 0; c < 3; c++)
            assert_near(film_value(r->img, k % 8, k / 8, c), expected, tolerance);
    render_result_destroy(r);
}

static void a_linear_analyser_obeys_malus_and_fresnel(void **state)
{
    (void)state;
    static const double incidences[] = {0.3, 0.9, 0.98279372324732907 /* Brewster's, atan 1.5 */, 1.2, 1.45};
    static const double angles[] = {-90, -31, 0, 17.5, 45, 60, 90, 200};
    scene *s = scene_from(lake);
    for (size_t i = 0; i < COUNT(incidences); i++)
        for (size_t k = 0; k < COUNT(angles); k++) {
            s->camera.pitch_deg = incidences[i] / degree - 90.0;
            s->camera.analyser = ANALYSER_LINEAR;
            s->camera.analyser_angle_deg = angles[k];
            s->camera.roll_deg = 0.0;
            assert_image(s, transmitted(incidences[i], angles[k] * degree), 1e-12);
            s->camera.roll_deg = 25.0; /* the filter turns with the camera, right towards down */
            assert_image(s, transmitted(incidences[i], (angles[k] - 25.0) * degree), 1e-12);
            for (int hand = ANALYSER_CIRCULAR_LEFT; hand <= ANALYSER_CIRCULAR_RIGHT; hand++) {
                s->camera.analyser = hand; /* linearly polarised light has half of each hand */
                assert_image(s, 0.5 * (transmitted(incidences[i], 0.0) + transmitted(incidences[i], 90 * degree)),
                             1e-12);
            }
        }
    set_all(s, "camera.analyser=linear camera.analyser_angle_deg=90 camera.roll_deg=0");
    s->camera.pitch_deg = incidences[2] / degree - 90.0;
    assert_image(s, 0.0, 1e-12); /* Brewster: nothing of p is reflected */
    scene_destroy(s);
}

/* Unpolarised light: half of it, whatever the filter; and by samples and wavelengths too. */
static void unpolarised_light_is_halved(void **state)
{
    (void)state;
    static const char *const filters[] = {"camera.analyser=linear camera.analyser_angle_deg=33",
                                          "camera.analyser=circular_left", "camera.analyser=circular_right",
                                          "render.samples=9", "render.spectrum=spectral render.wavelengths=16"};
    scene *s = scene_from("render: {width: 8, height: 6, polarisation: \"on\"}\n"
                          "background: {color: [0.8, 0.8, 0.8]}\n");
    assert_image(s, 0.8, 1e-9);
    for (size_t k = 0; k < COUNT(filters); k++) {
        set_all(s, filters[k]);
        assert_image(s, 0.4, k < 4 ? 1e-10 : 1e-3);
    }
    scene_destroy(s);
}

static render_result *seen_with(scene *s, const char *filter)
{
    set_all(s, filter);
    return render(s);
}

/* Two crossed linear analysers and the two circular ones pass all light; total reflections in glass turn some of the
 * light circular, of one hand on the left and of the other on the right of a scene that is its own mirror image. */
static void crossed_analysers_add_up(void **state)
{
    (void)state;
    static const char *const filters[] = {"camera.analyser=none", "camera.analyser=linear camera.analyser_angle_deg=30",
                                          "camera.analyser=linear camera.analyser_angle_deg=120",
                                          "camera.analyser=circular_left", "camera.analyser=circular_right"};
    scene *s = scene_from("render: {width: 40, height: 30, depth: 6, polarisation: \"on\"}\n"
                          "camera: {position: [0, 2, -6], target: [0, 0.8, 0], fov_deg: 30}\n"
                          "background: {kind: gradient, color: [0.2, 0.3, 0.8], horizon: [1, 1, 1]}\n"
                          "solids:\n"
                          "  glass: {shape: box, size: [1.6, 1.6, 1.6], rotation: [30, 0, 0], position: [0, 0.8, 0],"
                          " transparency: 1, ior: 1.6}\n");
    render_result *r[COUNT(filters)];
    double most = 0.0, mirrored = 0.0;
    for (size_t k = 0; k < COUNT(filters); k++)
        r[k] = seen_with(s, filters[k]);
    for (int y = 0; y < 30; y++)
        for (int x = 0; x < 40; x++) {
            double v[COUNT(filters)];
            for (size_t k = 0; k < COUNT(filters); k++)
                v[k] = film_value(r[k]->img, x, y, 1);
            assert_near(v[1] + v[2], v[0], 1e-10);
            assert_near(v[3] + v[4], v[0], 1e-10);
            most = fmax(most, fabs(v[3] - v[4]));
            mirrored = fmax(mirrored, fabs(v[3] - film_value(r[4]->img, 39 - x, y, 1)));
        }
    assert_true(most > 0.01);
    assert_true(mirrored < 1e-9);
    for (size_t k = 0; k < COUNT(filters); k++)
        render_result_destroy(r[k]);
    scene_destroy(s);
}

static void one_film_for_threads_and_instruction_sets(void **state)
{
    (void)state;
    one_film_only(rod_scene("render.width=48 render.height=36 render.depth=4 render.polarisation=on "
                            "camera.analyser=linear camera.analyser_angle_deg=70"));
    scene *s = rod_scene("render.width=48 render.height=36 render.depth=4");
    const uint64_t plain = film_hash_at(s, isa_best());
    set(s, "camera.analyser=linear"); /* without polarisation it does nothing */
    assert_true(film_hash_at(s, isa_best()) == plain);
    scene_destroy(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_linear_analyser_obeys_malus_and_fresnel),
        cmocka_unit_test(unpolarised_light_is_halved),
        cmocka_unit_test(crossed_analysers_add_up),
        cmocka_unit_test(one_film_for_threads_and_instruction_sets),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
