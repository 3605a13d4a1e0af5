/* Tests of camera roll against closed forms: Rodrigues' formula for the frame, and the image rotated by quarter turns.
 * The image of roll 90 has at column x, row y the pixel of the unrolled image at column side - 1 - y, row x: it is
 * rotated counterclockwise. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <cmocka.h>

#include "random_stream.h"
#include "render/inspect/probe.h"
#include "render_fixture.h"
#include "scene/model/camera.h"
#include "scene/model/scene.h"

#define COUNT(a) (sizeof(a) / sizeof((a)[0]))
enum { SIDE = 64 };

#define HEAD                                                                                                         \
    "render: {width: 64, height: 64, depth: 5}\n"                                                                    \
    "camera: {position: [0.25, 1, -6], yaw_deg: 0, fov_deg: 40}\n"                                                   \
    "background: {kind: gradient, color: [0.1, 0.2, 0.9], horizon: [1, 0.8, 0.6], ambient: [0.5, 0.6, 0.7]}\n"       \
    "lights: {lamp: {position: [4, 7, -5]}}\n"                                                                       \
    "materials: {dull: {diffuse: 0.7, ambient: 0.1, specular: 0.4, shininess: 40, color: [0.8, 0.3, 0.2], checker: " \
    "0.3}}\n"                                                                                                        \
    "solids:\n"

static const char room[] =
    HEAD "  ground: {shape: plane, material: dull, checker: 1}\n"
         "  glass: {shape: sphere, radius: 0.9, position: [-0.8, 1, -1], transparency: 1, ior: 1.5}\n"
         "  crate: {shape: box, material: dull, position: [1.4, 0.6, 0], rotation: [0, 30, 0]}\n"
         "  mirror: {shape: sphere, reflectivity: 1, radius: 0.6, position: [0.6, 2, 1]}\n";

/* The pixel of the unrolled image for a pixel of the rolled one. */
static void level_pixel(int quarters, int x, int y, int *to_x, int *to_y)
{
    for (int k = 0; k < quarters; k++) {
        const int old = x;
        x = SIDE - 1 - y, y = old;
    }
    *to_x = x, *to_y = y;
}

/* The number of pixels of the rolled image that differ from the unrolled one by more than a limit. Releases the
 * scene. */
static int pixels_of_scene_beyond(scene *s, int quarters, double much)
{
    diagnostic why = {0};
    char roll[64];
    worked(scene_load(s, &why), &why);
    render_result *level = render(s);
    snprintf(roll, sizeof roll, "camera.roll_deg=%d", 90 * quarters);
    set(s, roll);
    render_result *rolled = render(s);
    int beyond = 0, x0, y0;
    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++) {
            level_pixel(quarters, x, y, &x0, &y0);
            double most = 0.0;
            for (int c = 0; c < 3; c++)
                most = fmax(most, fabs(film_value(rolled->img, x, y, c) - film_value(level->img, x0, y0, c)));
            beyond += most > much;
        }
    render_result_destroy(level);
    render_result_destroy(rolled);
    scene_destroy(s);
    return beyond;
}

static int pixels_beyond(const char *text, const char *settings, int quarters, double much)
{
    scene *s = scene_from(text);
    set_all(s, settings);
    return pixels_of_scene_beyond(s, quarters, much);
}

/* The film's points are rotated up to rounding (1e-16 of its height). The remaining differences are pixels whose ray
 * then hits the other side of an edge. */
static void quarter_turns_rotate_the_image(void **state)
{
    (void)state;
    static const char *const settings[] = {"", "camera.position=2,3,-5 camera.target=-0.3,1,0.4", "render.samples=4",
                                           "render.integrator=raycast", "render.polarisation=on"};
    for (size_t k = 0; k < COUNT(settings); k++)
        for (int quarters = 1; quarters <= 3; quarters++) {
            const int beyond = pixels_beyond(room, settings[k], quarters, 1e-9);
            if (beyond > 2)
                fail_msg("%s, roll %d: %d pixels differ", settings[k], 90 * quarters, beyond);
        }
    assert_true(pixels_beyond(room, "camera.roll_deg=0", 4, 0.0) == 0); /* a full turn: bit-identical */
}

/* Paths along mirrors have no random choice; others agree up to noise. */
static void path_traced_images_rotate_with_the_roll(void **state)
{
    (void)state;
    static const char mirrors[] =
        HEAD "  ball: {shape: sphere, reflectivity: 1, radius: 0.8, position: [-0.8, 1, -1]}\n"
             "  block: {shape: box, reflectivity: 1, position: [1, 1, 1], rotation: [10, 30, 0]}\n";
    assert_true(pixels_beyond(mirrors, "render.integrator=path render.filter=centre render.paths=1", 1, 1e-12) == 0);
    assert_true(pixels_beyond(mirrors, "render.integrator=path render.filter=centre render.paths=4 render.samples=4", 3,
                              1e-12) == 0);
    assert_true(pixels_beyond(room, "render.integrator=path render.filter=centre render.paths=400", 1, 0.15) <
                SIDE * SIDE / 50);
}

/* A point on a triangle's edge belongs to the triangle on its right or below, which is another one when the film is
 * rotated. The checkered ground is textured both perspective-correct and affine. */
static void rasterised_images_rotate_with_the_roll(void **state)
{
    (void)state;
    static const char *const settings[] = {"", "render.texturing=affine", "render.samples=9"};
    for (size_t k = 0; k < COUNT(settings); k++)
        for (int quarters = 1; quarters <= 3; quarters++) {
            char both[128];
            snprintf(both, sizeof both, "render.integrator=zbuffer %s", settings[k]);
            assert_true(pixels_beyond(room, both, quarters, 1e-9) <= 8);
            scene *s = NULL;
            diagnostic why = {0};
            worked(scene_read("experiments/scenes/chequer.yaml", &s, &why), &why);
            set_all(s, "render.width=64 render.height=64 render.integrator=zbuffer");
            set_all(s, settings[k]);
            assert_true(pixels_of_scene_beyond(s, quarters, 1e-9) <= 8);
        }
}

static void assert_vectors_near(vec3 a, vec3 b, double most)
{
    assert_true(vec3_length(vec3_sub(a, b)) <= most);
}

/* Rodrigues: v cos a + (n x v) sin a for v perpendicular to n. The roll rotates right towards down, which in this
 * left-handed frame (right, up, forward) is by -a. */
static void roll_rotates_the_camera_frame_about_the_view_direction(void **state)
{
    (void)state;
    uint64_t seed = 8;
    scene *s = rod_scene("camera.position=2,3,-5 camera.target=-0.3,1,0.4");
    for (int k = 0; k < 200; k++) {
        if (k == 100)
            set_all(s, "camera.yaw_deg=33 camera.pitch_deg=-20");
        s->camera.roll_deg = 0.0;
        const camera_frame level = camera_frame_of(s);
        s->camera.roll_deg = random_real(&seed, -360.0, 360.0);
        const camera_frame rolled = camera_frame_of(s), again = camera_frame_level(s);
        const double a = s->camera.roll_deg * acos(-1.0) / 180.0;
        const vec3 right =
            vec3_add(vec3_scale(level.right, cos(a)), vec3_scale(vec3_cross(level.forward, level.right), -sin(a)));
        const vec3 up =
            vec3_add(vec3_scale(level.up, cos(a)), vec3_scale(vec3_cross(level.forward, level.up), -sin(a)));
        assert_vectors_near(rolled.right, right, 1e-14);
        assert_vectors_near(rolled.up, up, 1e-14);
        assert_memory_equal(&again, &level, sizeof level);
        assert_memory_equal(&rolled.forward, &level.forward, sizeof(vec3));
    }
    s->camera.roll_deg = 90.0; /* leaning to its right: what was on the right is at the top */
    const camera_frame level = camera_frame_level(s), rolled = camera_frame_of(s);
    assert_vectors_near(rolled.up, level.right, 0.0);
    assert_vectors_near(rolled.right, vec3_scale(level.up, -1.0), 0.0);
    scene_destroy(s);
}

/* trace: the ray of a pixel follows the camera frame. */
static void the_ray_of_a_pixel_follows_the_rolled_frame(void **state)
{
    (void)state;
    scene *s = rod_scene("camera.position=2,3,-5 camera.target=-0.3,1,0.4 camera.roll_deg=37");
    probe *p = NULL;
    diagnostic why = {0};
    worked(probe_create(s, isa_best(), &p, &why), &why);
    const camera_frame f = camera_frame_of(s);
    const vec3 corner =
        vec3_add(f.forward, vec3_sub(vec3_scale(f.up, f.half_height), vec3_scale(f.right, f.half_width)));
    assert_vectors_near(probe_camera_direction(p, 0.0, 0.0), vec3_normalize(corner), 1e-15);
    assert_vectors_near(probe_camera_direction(p, 400.0, 300.0), f.forward, 1e-15);
    probe_destroy(p);
    scene_destroy(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(quarter_turns_rotate_the_image),
        cmocka_unit_test(path_traced_images_rotate_with_the_roll),
        cmocka_unit_test(rasterised_images_rotate_with_the_roll),
        cmocka_unit_test(roll_rotates_the_camera_frame_about_the_view_direction),
        cmocka_unit_test(the_ray_of_a_pixel_follows_the_rolled_frame),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
