/* Tests of the orthographic camera and of the thin lens against closed forms: places and sizes under parallel rays,
 * whatever the distance; the disc to which a lens blurs a point (Potmesil and Chakravarty, "A lens and aperture camera
 * model for synthetic image generation", SIGGRAPH 1981; Hecht, Optics, 5.2): rays from the lens's point x through an
 * image point in focus at depth f cross the depth z at x (1 - z / f) from the chief ray. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <cmocka.h>

#include "lint/lint.h"
#include "random_stream.h"
#include "render/inspect/probe.h"
#include "render/inspect/ray_line.h"
#include "render_fixture.h"
#include "scene/model/camera.h"
#include "scene/model/scene.h"
#include "zbuffer_fixture.h"

#define COUNT(a) (sizeof(a) / sizeof((a)[0]))
#define PARALLEL "camera.projection=orthographic "

static const double pi = 3.14159265358979323846;

/* --- rays --- */

static void assert_at(vec3 a, vec3 b, double most)
{
    assert_true(vec3_length(vec3_sub(a, b)) <= most);
}

static vec3 in_frame(const camera_frame *f, double x, double y, double z)
{
    return vec3_add(f->eye,
                    vec3_add(vec3_scale(f->right, x), vec3_add(vec3_scale(f->up, y), vec3_scale(f->forward, z))));
}

static void rays_cross_each_depth_where_the_thin_lens_says(void **state)
{
    (void)state;
    uint64_t seed = 5;
    scene *s = rod_scene("camera.position=2,3,-5 camera.target=-0.3,1,0.4 camera.roll_deg=20");
    for (int k = 0; k < 400; k++) {
        s->camera.projection = k % 2;
        s->camera.aperture = random_real(&seed, 0.0, 2.0);
        s->camera.focus = random_real(&seed, 0.2, 9.0);
        const camera_frame f = camera_frame_of(s);
        const double u = random_real(&seed, -1.0, 1.0), v = random_real(&seed, -1.0, 1.0),
                     x = random_real(&seed, -1.0, 1.0) * f.lens_radius,
                     y = random_real(&seed, -1.0, 1.0) * f.lens_radius, z = random_real(&seed, 0.1, 20.0),
                     share = 1.0 - z / s->camera.focus, slope = k % 2 ? 1.0 : z;
        const camera_ray r = camera_ray_through(&f, u, v, x, y);
        const vec3 there = vec3_add(r.origin, vec3_scale(r.direction, z / vec3_dot(r.direction, f.forward)));
        assert_true(fabs(vec3_length(r.direction) - 1.0) < 1e-15);
        assert_true(fabs(vec3_dot(vec3_sub(r.origin, f.eye), f.forward)) < 1e-14);
        assert_at(there, in_frame(&f, slope * u + x * share, slope * v + y * share, z), 1e-12 * (1.0 + fabs(share)));
    }
    scene_destroy(s);
}

/* A pixel's single rays are chief rays, whatever the aperture: of a probe and of the laboratory. */
static void single_rays_are_chief_rays(void **state)
{
    (void)state;
    scene *s = rod_scene(PARALLEL "camera.view_height=6 camera.aperture=0.5 render.samples=4 render.width=40 "
                                  "render.height=30 camera.position=1,2,-9 camera.yaw_deg=0 camera.pitch_deg=0");
    probe *p = NULL;
    ray_tree tree = {0};
    diagnostic why = {0};
    worked(probe_create(s, isa_best(), &p, &why), &why);
    worked(probe_pixel(p, 3, 20, &tree, &why), &why);
    /* The first of four samples is a quarter pixel from the pixel's upper left corner; a pixel is 0.2 units wide. */
    assert_at(tree.node[0].origin, vec3_make(1.0 + (3.25 - 20.0) * 0.2, 2.0 + (15.0 - 20.25) * 0.2, -9.0), 1e-14);
    assert_at(tree.node[0].direction, vec3_make(0.0, 0.0, 1.0), 0.0);
    ray_tree_release(&tree);
    probe_destroy(p);
    scene_destroy(s);
}

static bool segment_seen(const camera_frame *view, vec3 from, vec3 to, vec3 ends[2])
{
    const ray_line line = ray_line_between(from, to);
    const image_frame frame = image_frame_of(40, 30, 0.0);
    return ray_line_seen(&line, view, &frame, ends);
}

static void segments_are_placed_without_regard_to_depth(void **state)
{
    (void)state;
    scene *s = rod_scene(PARALLEL "camera.view_height=6 render.width=40 render.height=30 camera.position=0,0,0 "
                                  "camera.yaw_deg=0 camera.pitch_deg=0");
    const camera_frame f = camera_frame_of(s);
    vec3 ends[2];
    assert_true(segment_seen(&f, vec3_make(1.0, 1.0, 2.0), vec3_make(-1.0, 2.0, 70.0), ends));
    assert_at(ends[0], vec3_make(25.0, 10.0, 2.0), 1e-12);
    assert_at(ends[1], vec3_make(15.0, 5.0, 70.0), 1e-12);
    assert_true(segment_seen(&f, vec3_make(1.0, 0.0, -1.0), vec3_make(1.0, 1.0, 1.0), ends));
    assert_at(ends[0], vec3_make(25.0, 12.5, 0.0), 1e-12); /* cut at the camera's plane */
    assert_false(segment_seen(&f, vec3_make(1.0, 0.0, -1.0), vec3_make(1.0, 1.0, -2.0), ends));
    assert_false(segment_seen(&f, vec3_make(1.0, 0.0, -1.0), vec3_make(1.0, 1.0, 0.0), ends)); /* ends there */
    scene_destroy(s);
}

/* --- orthographic images --- */

#define DARK "background: {color: [0, 0, 0], ambient: [1, 1, 1]}\n"
static const char ball[] = "render: {width: 64, height: 48, depth: 0, samples: 64, paths: 256}\n"
                           "camera: {position: [0, 0, 0], yaw_deg: 0, projection: orthographic, view_height: 6}\n" DARK
                           "solids: {ball: {shape: sphere, radius: 1, ambient: 1, emission: 0}}\n";

typedef struct moments {
    double sum, x, y, spread; /* light; its centre; the mean square of the distance from it, px */
} moments;

static moments moments_of(const film *f)
{
    moments m = {0.0, 0.0, 0.0, 0.0};
    double square = 0.0;
    for (int y = 0; y < f->height; y++)
        for (int x = 0; x < f->width; x++) {
            const double seen = film_value(f, x, y, 1), px = x + 0.5, py = y + 0.5;
            m.sum += seen, m.x += seen * px, m.y += seen * py, square += seen * (px * px + py * py);
        }
    m.x /= m.sum, m.y /= m.sum;
    m.spread = square / m.sum - m.x * m.x - m.y * m.y;
    return m;
}

/* A ball of radius 1 at (0.7, -0.4): 64 x 48 pixels of 1/8 unit. The rasteriser's ball is a polyhedron inside it. */
static void a_ball_has_its_place_and_size_at_any_distance(void **state)
{
    (void)state;
    static const char *const integrators[] = {"raycast", "whitted", "zbuffer", "path"};
    static const double distances[] = {1.5, 30.0, 3e4};
    for (size_t i = 0; i < COUNT(integrators); i++)
        for (size_t d = 0; d < COUNT(distances); d++) {
            const bool path = strcmp(integrators[i], "path") == 0, drawn = strcmp(integrators[i], "zbuffer") == 0;
            char assignment[160];
            scene *s = scene_from(ball);
            snprintf(assignment, sizeof assignment,
                     "render.integrator=%s ball.position=0.7,-0.4,%.17g ball.emission=%d", integrators[i], distances[d],
                     path);
            set_all(s, assignment);
            render_result *r = render(s);
            const moments m = moments_of(r->img);
            assert_true(fabs(m.x - (32.0 + 0.7 * 8.0)) < 0.02);
            assert_true(fabs(m.y - (24.0 + 0.4 * 8.0)) < 0.02);
            assert_true(fabs(m.sum - pi * 64.0) < (drawn ? 5e-3 : 1e-3) * pi * 64.0);
            render_result_destroy(r);
            scene_destroy(s);
        }
}

/* The depth buffer shows what rays hit: the films differ only at outlines. */
static void the_depth_buffer_agrees_with_rays(void **state)
{
    (void)state;
    static const char text[] =
        "render: {width: 120, height: 90, depth: 3, shadows: \"off\"}\n"
        "camera: {position: [2, 4, -6], target: [0, 0.7, 0], projection: orthographic, view_height: 4}\n"
        "background: {kind: gradient, color: [0.1, 0.2, 0.9], horizon: [1, 0.8, 0.6], ambient: [0.5, 0.6, 0.7]}\n"
        "lights: {lamp: {position: [4, 7, -5]}}\n"
        "materials: {dull: {diffuse: 0.7, ambient: 0.1, color: [0.8, 0.3, 0.2], checker: 0.3}}\n"
        "solids:\n"
        "  ground: {shape: plane, material: dull, checker: 1}\n"
        "  crate: {shape: box, material: dull, position: [0.9, 0.6, 0], rotation: [0, 30, 0]}\n"
        "  cut: {shape: box, material: dull, position: [-1, 0.6, -1], rotation: [20, 10, 50]}\n";
    scene *s = scene_from(text);
    render_result *traced = render(s);
    set(s, "render.integrator=zbuffer");
    render_result *drawn = render(s);
    int beyond = 0;
    for (int y = 0; y < 90; y++)
        for (int x = 0; x < 120; x++)
            beyond += fabs(film_value(traced->img, x, y, 0) - film_value(drawn->img, x, y, 0)) > 1e-9;
    assert_true(beyond < 30); /* of 10800 */
    render_result_destroy(traced);
    render_result_destroy(drawn);
    one_film_only(s);
}

/* A clear box without interface that reaches into the image from its left: those rays start inside and lose
 * exp(-0.3 L) over the rest of it (Beer and Lambert), the others nothing. */
static void each_ray_starts_in_its_own_medium(void **state)
{
    (void)state;
    static const char text[] =
        "render: {width: 8, height: 6, depth: 3}\n"
        "camera: {position: [0, 0, 0], yaw_deg: 0, projection: orthographic, view_height: 6}\n"
        "background: {color: [1, 1, 1]}\n"
        "solids: {box: {shape: box, size: [20, 20, 20], position: [-11, 0, -7.5], transparency: 1, ior: 1,"
        " absorb_per_m: [0.3, 0.3, 0.3]}}\n";
    scene *s = scene_from(text);
    static const char *const integrators[] = {"whitted", "path"};
    for (size_t i = 0; i < COUNT(integrators); i++) {
        char assignment[64];
        snprintf(assignment, sizeof assignment, "render.integrator=%s", integrators[i]);
        set(s, assignment);
        render_result *r = render(s);
        for (int x = 0; x < 8; x++)
            assert_true(fabs(film_value(r->img, x, 3, 0) - (x < 3 ? exp(-0.3 * 2.5) : 1.0)) < 1e-9);
        render_result_destroy(r);
    }
    scene_destroy(s);
}

static void refused(scene *s, const char *assignments, const char *what)
{
    renderer *r = NULL;
    render_result *result = NULL;
    diagnostic why = {0};
    set_all(s, assignments);
    worked(renderer_create(isa_best(), NULL, &r, &why), &why);
    assert_int_equal(renderer_render(r, s, NULL, &result, &why), STATUS_BAD_INPUT);
    assert_non_null(strstr(why.what, what));
    assert_true(why.remedy[0]);
    renderer_destroy(r);
}

static void several_media_at_the_camera_are_refused_where_one_is_needed(void **state)
{
    (void)state;
    static const char text[] = "render: {width: 8, height: 6}\ncamera: {position: [0, 0.1, 0], yaw_deg: 0}\n"
                               "solids: {sea: {shape: plane, transparency: 1, ior: 1.33}}\n";
    scene *s = scene_from(text);
    set(s, "camera.view_height=0.1");
    refused(s, PARALLEL "camera.view_height=6 render.integrator=zbuffer", "sea reaches into the camera's image");
    refused(s, "render.integrator=whitted render.radiance=basic", "sea reaches into the camera's image");
    refused(s, "camera.projection=perspective camera.aperture=0.5", "sea reaches into the camera's lens");
    set(s, "camera.aperture=0.1"); /* above the sea */
    render_result_destroy(render(s));
    scene_destroy(s);
}

/* --- the lens --- */

/* A white half space to x < edge, seen by one ray direction: rays through the lens's points (x, y). */
static const char half[] = "render: {width: 1, height: 1, depth: 0, integrator: path, paths: 4096}\n"
                           "camera: {position: [0, 0, 0], yaw_deg: 0, fov_deg: 1e-7, view_height: 1e-9}\n" DARK
                           "solids: {wall: {shape: box, size: [1000, 1000, 1e-9], emission: 1}}\n";

/* The share of a unit disc at x < edge (a circular segment). */
static double disc_below(double edge)
{
    const double e = fmin(fmax(edge, -1.0), 1.0);
    return 0.5 + (e * sqrt(1.0 - e * e) + asin(e)) / pi;
}

/* In units of the blur's radius, A |1 - z / f| / 2 at depth z: a quarter of it and so on; the ends are exact. */
static void an_edge_out_of_focus_fades_as_a_disc_does(void **state)
{
    (void)state;
    static const double edges[] = {-1.0001, -0.9, -0.5, -0.1, 0.0, 0.3, 0.7, 1.0001};
    static const double depths[] = {0.5, 1.9, 2.2, 40.0};
    static const struct {
        const char *how;
        double tolerance; /* a Sobol set of n points has an error near n^-0.75 on discs */
    } modes[] = {{"render.integrator=path render.paths=4096", 3e-3},
                 {"render.integrator=path render.paths=4096 render.sampler=philox", 0.03},
                 {"render.integrator=whitted render.samples=64", 0.05},
                 {"render.integrator=raycast render.samples=64 " PARALLEL, 0.05},
                 {"render.integrator=path render.paths=4096 render.sampler=sobol", 3e-3}};
    scene *s = scene_from(half);
    set_all(s, "camera.aperture=0.4 camera.focus=2");
    for (size_t w = 0; w < COUNT(modes); w++) {
        set_all(s, modes[w].how);
        for (size_t d = 0; d < COUNT(depths); d++)
            for (size_t k = 0; k < COUNT(edges); k++) {
                const double radius = 0.2 * fabs(1.0 - depths[d] / 2.0),
                             tolerance = fabs(edges[k]) > 1.0 ? 1e-9 : modes[w].tolerance;
                s->solids[0].shape.position = vec3_make(edges[k] * radius - 500.0, 0.0, depths[d]);
                assert_true(fabs(look(s).x - disc_below(edges[k])) < tolerance);
            }
    }
    scene_destroy(s);
}

/* The image of a small ball: its diameter is that of the circle of confusion, A |z - f| / (z f) of the image plane at
 * depth 1, or A |z - f| / f under parallel rays. The mean square of a disc's distances from its centre is r^2 / 2; the
 * ball adds its own r^2 / 2, and a pixel 1/6 px^2. */
static void a_point_is_blurred_to_the_circle_of_confusion(void **state)
{
    (void)state;
    static const char text[] = "render: {width: 64, height: 64, depth: 0, integrator: path, paths: 1024}\n"
                               "camera: {position: [0, 0, 0], yaw_deg: 0, fov_deg: 30, view_height: 2}\n" DARK
                               "solids: {ball: {shape: sphere, emission: 1}}\n";
    static const struct {
        double aperture, focus, z;
        bool parallel;
    } cases[] = {{0.6, 3.0, 8.0, false}, {0.3, 6.0, 2.5, false}, {0.5, 4.0, 6.0, true}, {0.8, 5.0, 3.0, true}};
    scene *s = scene_from(text);
    for (size_t k = 0; k < COUNT(cases); k++) {
        const double a = cases[k].aperture, f = cases[k].focus, z = cases[k].z;
        const double units = cases[k].parallel ? 2.0 : 2.0 * tan(pi / 12.0), px = 64.0 / units;
        const double circle = cases[k].parallel ? a * fabs(z - f) / f : a * fabs(z - f) / (z * f);
        const double size = cases[k].parallel ? 0.08 : 0.02, radius = size * (cases[k].parallel ? 1.0 : z),
                     own = size * px;
        s->camera.projection = cases[k].parallel;
        s->camera.aperture = a, s->camera.focus = f;
        s->solids[0].shape.radius = radius;
        s->solids[0].shape.position = vec3_make(0.0, 0.0, z);
        render_result *r = render(s);
        const moments m = moments_of(r->img);
        const double blur = 0.5 * circle * px, expected = 0.5 * blur * blur + 0.5 * own * own + 1.0 / 6.0;
        assert_true(blur > 3.0);
        assert_true(fabs(m.spread - expected) < 0.01 * expected);
        assert_true(fabs(m.x - 32.0) < 0.15 && fabs(m.y - 32.0) < 0.15);
        render_result_destroy(r);
    }
    scene_destroy(s);
}

/* In the plane in focus, and for one ray per pixel, an aperture changes nothing. */
static void what_is_in_focus_is_sharp(void **state)
{
    (void)state;
    scene *s = scene_from(half);
    set_all(s, "render.integrator=whitted render.samples=16 render.width=8 render.height=8 camera.fov_deg=30 "
               "camera.focus=5");
    s->solids[0].shape.position = vec3_make(0.123 - 500.0, 0.05 - 500.0, 5.0);
    for (int projection = 0; projection < 2; projection++) {
        s->camera.projection = projection, s->camera.view_height = 2.0;
        s->camera.aperture = 0.0;
        render_result *sharp = render(s);
        s->camera.aperture = 2.0;
        render_result *wide = render(s);
        for (int k = 0; k < 64; k++)
            assert_true(fabs(film_value(sharp->img, k % 8, k / 8, 0) - film_value(wide->img, k % 8, k / 8, 0)) < 1e-9);
        render_result_destroy(sharp);
        render_result_destroy(wide);
    }
    scene_destroy(s);
    scene *rod = rod_scene("render.width=40 render.height=30");
    const uint64_t pinhole = film_hash_at(rod, isa_best());
    set(rod, "camera.aperture=0.3");
    assert_true(film_hash_at(rod, isa_best()) == pinhole);
    set(rod, "render.samples=4");
    const uint64_t lens = film_hash_at(rod, isa_best());
    set(rod, "camera.aperture=0");
    assert_true(film_hash_at(rod, isa_best()) != lens);
    scene_destroy(rod);
}

/* --- determinism --- */

static void one_film_for_threads_and_instruction_sets(void **state)
{
    (void)state;
    static const char *const modes[] = {
        "camera.aperture=0.3",
        "camera.aperture=0.3 render.integrator=path render.paths=8",
        "camera.aperture=0.3 render.integrator=path render.paths=8 render.sampler=philox",
        "camera.aperture=0.3 render.spectrum=spectral render.wavelengths=4",
        PARALLEL "camera.aperture=0.3 camera.position=0,1.5,-1", /* the image cuts vessel and liquid */
        PARALLEL "render.integrator=zbuffer camera.view_height=4 camera.position=0,2.75,-6",
    };
    for (size_t k = 0; k < COUNT(modes); k++) {
        scene *s = rod_scene("render.width=48 render.height=36 render.depth=4");
        set_all(s, modes[k]);
        one_film_only(s);
    }
}

static void the_seed_chooses_the_points_of_the_lens(void **state)
{
    (void)state;
    scene *s = rod_scene("render.width=40 render.height=30 render.samples=4 camera.aperture=0.3 render.seed=1");
    const uint64_t one = film_hash_at(s, isa_best());
    set(s, "render.seed=2");
    assert_true(film_hash_at(s, isa_best()) != one);
    inert_answer answer;
    assert_false(param_is_inert(s, "render.seed", NULL, &answer));
    set(s, "camera.aperture=0");
    assert_true(param_is_inert(s, "render.seed", NULL, &answer));
    scene_destroy(s);
}

/* --- notes and moves --- */

static void find(void *context, const scene_note *note)
{
    if (strcmp(note->place, "camera.position") == 0)
        snprintf(context, NOTE_TEXT_MAX, "%s", note->text);
}

/* An image 4 units high about a level camera 1 unit above the ground: a quarter of its rays start below. */
static void rays_that_start_in_the_ground_are_noted(void **state)
{
    (void)state;
    diagnostic why = {0};
    char found[NOTE_TEXT_MAX] = "";
    scene *s = scene_from("camera: {position: [0, 1, -6], yaw_deg: 0, projection: orthographic, view_height: 4}\n"
                          "solids: {ground: {shape: plane, diffuse: 0.7}}\n");
    worked(lint_scene(s, isa_best(), &(note_sink){find, found}, &why), &why);
    assert_non_null(strstr(found, "25% of the orthographic camera's rays start inside ground"));
    found[0] = 0;
    set(s, "camera.view_height=1.9");
    worked(lint_scene(s, isa_best(), &(note_sink){find, found}, &why), &why);
    assert_string_equal(found, "");
    scene_destroy(s);
}

static void moves_of_an_orthographic_camera_change_its_height(void **state)
{
    (void)state;
    scene *s = scene_from(ball);
    set_all(s, "ball.position=3,1,20 ball.radius=0.5");
    camera_move framed = {.frame = "ball"};
    assert_int_equal(camera_move_apply(&framed, s, NULL), STATUS_OK);
    assert_true(fabs(s->camera.view_height - 2.0 * 1.1 * 0.5) < 1e-12); /* wider than high: by the height */
    const camera_frame f = camera_frame_of(s);
    const vec3 offset = vec3_sub(vec3_make(3.0, 1.0, 20.0), f.eye);
    assert_true(fabs(vec3_dot(offset, f.right)) < 1e-12 && fabs(vec3_dot(offset, f.up)) < 1e-12);
    assert_true(vec3_dot(offset, f.forward) > 0.5);
    camera_move nearer = {.zoom = 0.5, .pivot = framed.pivot};
    assert_int_equal(camera_move_apply(&nearer, s, NULL), STATUS_OK);
    assert_true(fabs(s->camera.view_height - 0.55) < 1e-12);
    assert_at(s->camera.position, f.eye, 0.0);
    set_all(s, "render.width=30 render.height=60");
    assert_int_equal(camera_move_apply(&framed, s, NULL), STATUS_OK);
    assert_true(fabs(s->camera.view_height - 2.0 * 2.0 * 1.1 * 0.5) < 1e-12);
    scene_destroy(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rays_cross_each_depth_where_the_thin_lens_says),
        cmocka_unit_test(single_rays_are_chief_rays),
        cmocka_unit_test(segments_are_placed_without_regard_to_depth),
        cmocka_unit_test(a_ball_has_its_place_and_size_at_any_distance),
        cmocka_unit_test(the_depth_buffer_agrees_with_rays),
        cmocka_unit_test(each_ray_starts_in_its_own_medium),
        cmocka_unit_test(several_media_at_the_camera_are_refused_where_one_is_needed),
        cmocka_unit_test(an_edge_out_of_focus_fades_as_a_disc_does),
        cmocka_unit_test(a_point_is_blurred_to_the_circle_of_confusion),
        cmocka_unit_test(what_is_in_focus_is_sharp),
        cmocka_unit_test(one_film_for_threads_and_instruction_sets),
        cmocka_unit_test(the_seed_chooses_the_points_of_the_lens),
        cmocka_unit_test(rays_that_start_in_the_ground_are_noted),
        cmocka_unit_test(moves_of_an_orthographic_camera_change_its_height),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
