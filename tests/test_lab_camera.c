#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <cmocka.h>

#include "render_fixture.h"
#include "scene/model/camera.h"
#include "scene/model/camera_moves.h"
#include "web/lab_private.h"
#include "scene/model/scene.h"

/* Tests of a rolled camera on the page: its moves follow the image, and an image point maps to the tracer's ray. */

#define COUNT(a) (sizeof(a) / sizeof((a)[0]))

static const double rolls[] = {0.0, 90.0, 180.0, -90.0, 37.0};

static scene *looking_along_z(double roll_deg)
{
    scene *s = rod_scene("camera.position=0,1,-5 camera.target=0,1,0");
    s->camera.roll_deg = roll_deg;
    return s;
}

static void camera_moves_follow_the_rolled_image(void **state)
{
    (void)state;
    for (size_t k = 0; k < COUNT(rolls); k++) {
        scene *s = looking_along_z(rolls[k]);
        const camera_frame f = camera_frame_of(s);
        const vec3 before = s->camera.position;
        camera_move around = {.orbit_deg = {1.0, 0.0}};
        assert_int_equal(camera_move_apply(&around, s, NULL), STATUS_OK);
        assert_true(vec3_dot(vec3_normalize(vec3_sub(s->camera.position, before)), f.right) < -0.999); /* to its left */
        const camera_frame now = camera_frame_of(s);
        camera_move up = {.turn_deg = {0.0, 1.0}};
        assert_int_equal(camera_move_apply(&up, s, NULL), STATUS_OK);
        assert_true(vec3_dot(vec3_normalize(vec3_sub(camera_frame_of(s).forward, now.forward)), now.up) > 0.999);
        assert_true(s->camera.roll_deg == rolls[k]);
        scene_destroy(s);
    }
}

static void a_step_moves_along_the_axes_of_the_rolled_image(void **state)
{
    (void)state;
    for (size_t k = 0; k < COUNT(rolls); k++) {
        scene *s = looking_along_z(rolls[k]);
        const vec3 before = s->camera.position, right = camera_frame_of(s).right;
        camera_move aside = {.step = {0.5, 0.0, 0.0}};
        assert_int_equal(camera_move_apply(&aside, s, NULL), STATUS_OK);
        const vec3 moved = vec3_sub(s->camera.position, before);
        assert_true(vec3_length(vec3_sub(moved, vec3_scale(right, 0.5))) < 1e-12);
        scene_destroy(s);
    }
}

/* The right edge of a camera that is rolled by 90 degrees to its right points down. */
static void an_image_point_maps_to_its_ray(void **state)
{
    (void)state;
    scene *s = looking_along_z(90.0);
    vec3 origin, direction;
    lab_camera_ray(s, (double)s->render.width, 0.5 * (double)s->render.height, &origin, &direction);
    assert_true(origin.z == -5.0 && fabs(direction.x) < 1e-15 && direction.y < -0.3);
    scene_destroy(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(camera_moves_follow_the_rolled_image),
        cmocka_unit_test(a_step_moves_along_the_axes_of_the_rolled_image),
        cmocka_unit_test(an_image_point_maps_to_its_ray),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
