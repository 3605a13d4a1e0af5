#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <cmocka.h>

#include "render_fixture.h"
#include "scene/model/camera.h"
#include "scene/model/scene.h"
#include "web/session/session.h"

/* Tests of the camera on the page: moves of a rolled camera follow the image, an image point maps to the tracer's ray,
 * zooms and orbits leave the pivot, and no move goes through the ground. */

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

/* 50 zooms and 20 orbits: the target is the same to the last bit, and so is the pivot of a camera aimed by angles. */
static void zooms_and_orbits_leave_the_pivot(void **state)
{
    (void)state;
    const char *const aims[] = {"camera.position=0,2.75,-6 camera.target=0,1.5,0",
                                "camera.yaw_deg=10 camera.pitch_deg=-12"};
    for (size_t k = 0; k < COUNT(aims); k++) {
        scene *s = rod_scene(aims[k]);
        const bool aimed = s->camera.aimed;
        camera_pivot pivot = {.known = false};
        const vec3 first = camera_pivot_of(s, pivot);
        for (int i = 0; i < 50; i++) {
            camera_move move = {.zoom = i < 25 ? 0.9 : 1.1, .pivot = pivot};
            if (i < 20)
                move.orbit_deg[0] = 7.3 * i, move.orbit_deg[1] = i % 2 ? 3.1 : -2.9;
            assert_int_equal(camera_move_apply(&move, s, NULL), STATUS_OK);
            pivot = move.pivot;
        }
        const vec3 last = camera_pivot_of(s, pivot);
        assert_true(first.x == last.x && first.y == last.y && first.z == last.z);
        assert_true(s->camera.aimed == aimed);
        scene_destroy(s);
    }
}

static double distance_of(const scene *s)
{
    return vec3_length(vec3_sub(s->camera.target, s->camera.position));
}

/* The ground of rod.yaml is y = 0. */
static void the_camera_stays_above_the_ground_and_in_reach(void **state)
{
    (void)state;
    static const camera_move moves[] = {{.orbit_deg = {0.0, -300.0}},
                                        {.orbit_deg = {170.0, -40.0}},
                                        {.step = {0.0, -5.0, 0.0}},
                                        {.zoom = 1e6},
                                        {.zoom = 1e-6},
                                        {.look = "left"},
                                        {.frame = "rod"}};
    for (size_t k = 0; k < COUNT(moves); k++) {
        scene *s = rod_scene("camera.position=0,2.75,-6 camera.target=0,-0.5,0");
        camera_move move = moves[k];
        assert_int_equal(camera_move_apply(&move, s, NULL), STATUS_OK);
        assert_true(s->camera.position.y > 0.0);
        scene_destroy(s);
    }
    scene *s = rod_scene("camera.position=0,2.75,-6 camera.target=0,1.5,0");
    camera_move out = {.zoom = 1e6}, in = {.zoom = 1e-6};
    assert_int_equal(camera_move_apply(&out, s, NULL), STATUS_OK);
    assert_true(distance_of(s) > 20.0 && distance_of(s) < 60.0);
    assert_int_equal(camera_move_apply(&in, s, NULL), STATUS_OK);
    assert_true(distance_of(s) > 1e-4 && distance_of(s) < 0.01);
    scene_destroy(s);
    s = rod_scene("ground.visible=off camera.position=0,2.75,-6 camera.target=0,1.5,0");
    camera_move down = {.orbit_deg = {0.0, -60.0}};
    assert_int_equal(camera_move_apply(&down, s, NULL), STATUS_OK);
    assert_true(s->camera.position.y < -1.0); /* without a ground nothing stops it */
    scene_destroy(s);
}

/* A framed solid's bounding ball touches no edge of the image: its angle is less than half the field of view. */
static void sides_and_frames(void **state)
{
    (void)state;
    static const struct {
        const char *side;
        vec3 forward;
    } sides[] = {
        {"front", {0, 0, 1}}, {"back", {0, 0, -1}}, {"left", {1, 0, 0}}, {"right", {-1, 0, 0}}, {"top", {0, -1, 0}}};
    scene *s = rod_scene("camera.position=1,2.75,-6 camera.target=0,1.5,0");
    const double before = distance_of(s);
    for (size_t k = 0; k < COUNT(sides); k++) {
        camera_move move = {.look = sides[k].side};
        assert_int_equal(camera_move_apply(&move, s, NULL), STATUS_OK);
        assert_true(vec3_length(vec3_sub(camera_frame_of(s).forward, sides[k].forward)) < 1e-12);
        assert_true(fabs(distance_of(s) - before) < 1e-12);
    }
    camera_move front = {.look = "front"}, frame = {.frame = "vessel"};
    assert_int_equal(camera_move_apply(&front, s, NULL), STATUS_OK);
    assert_int_equal(camera_move_apply(&frame, s, NULL), STATUS_OK);
    const double radius = sqrt(1.0 + 1.5 * 1.5), half_deg = asin(radius / distance_of(s)) * 180.0 / M_PI;
    assert_true(half_deg < 22.5 && half_deg > 19.0);
    assert_true(vec3_length(vec3_sub(s->camera.target, vec3_make(0.0, 1.501, 0.0))) < 1e-12);
    scene_destroy(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(camera_moves_follow_the_rolled_image),
        cmocka_unit_test(a_step_moves_along_the_axes_of_the_rolled_image),
        cmocka_unit_test(an_image_point_maps_to_its_ray),
        cmocka_unit_test(zooms_and_orbits_leave_the_pivot),
        cmocka_unit_test(the_camera_stays_above_the_ground_and_in_reach),
        cmocka_unit_test(sides_and_frames),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
