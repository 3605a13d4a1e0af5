/* Tests of ray trees, fans, optics, comparisons and layers through cuvette.h: they equal the film, closed forms and
 * what the library's own functions give; wrong arguments are refused. test_probe.c and test_fan.c test the tracing
 * itself. */
#include <jansson.h>
#include <math.h>
#include <pthread.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <cmocka.h>

#include "cuvette.h"
#include "engine_fixture.h"

enum { WIDTH = 40, HEIGHT = 30 };
static const char ROD[] = "experiments/scenes/rod.yaml";

static cuvette_scene *small_rod(void)
{
    cuvette_diagnostic why;
    cuvette_scene *s;
    fine(cuvette_scene_read(ROD, &s, &why), &why);
    fine(cuvette_scene_set_int(s, "render.width", WIDTH, &why), &why);
    fine(cuvette_scene_set_int(s, "render.height", HEIGHT, &why), &why);
    return s;
}

static cuvette_query *query_of(cuvette_scene *s)
{
    cuvette_diagnostic why;
    cuvette_query *q;
    fine(cuvette_query_create(s, NULL, &q, &why), &why);
    cuvette_scene_destroy(s);
    return q;
}

static cuvette_frame *frame_of(const cuvette_scene *s, cuvette_request *request)
{
    cuvette_diagnostic why;
    cuvette_engine *engine;
    cuvette_frame *frame;
    fine(cuvette_engine_create(NULL, &engine, &why), &why);
    fine(cuvette_engine_render(engine, s, request, &frame, &why), &why);
    cuvette_engine_destroy(engine);
    return frame;
}

static void test_radiance_of_a_tree_is_the_film(void **state)
{
    (void)state;
    static float rgb[3 * WIDTH * HEIGHT];
    cuvette_diagnostic why;
    cuvette_scene *s = small_rod();
    cuvette_request request = CUVETTE_REQUEST;
    request.width = WIDTH, request.height = HEIGHT, request.rgb = rgb;
    cuvette_frame_destroy(frame_of(s, &request));
    cuvette_query *q = query_of(s);
    for (int i = 0; i < WIDTH * HEIGHT; i += 37) {
        cuvette_tree *tree;
        double radiance[3];
        size_t count = 0;
        fine(cuvette_query_trace_pixel(q, i % WIDTH, i / WIDTH, &tree, &why), &why);
        fine(cuvette_tree_radiance(tree, radiance, &why), &why);
        const cuvette_node *nodes = cuvette_tree_nodes(tree, &count);
        assert_true(count > 0);
        assert_int_equal(nodes[0].kind, CUVETTE_RAY_CAMERA);
        assert_int_equal(nodes[0].parent, -1);
        for (int channel = 0; channel < 3; channel++)
            assert_true((float)radiance[channel] == rgb[3 * i + channel]);
        cuvette_tree_destroy(tree);
    }
    cuvette_query_destroy(q);
}

static void test_a_tree_outlives_its_query(void **state)
{
    (void)state;
    cuvette_diagnostic why;
    cuvette_tree *tree;
    cuvette_query *q = query_of(small_rod());
    fine(cuvette_query_trace_pixel(q, 20, 15, &tree, &why), &why);
    cuvette_query_destroy(q);
    size_t count;
    const cuvette_node *nodes = cuvette_tree_nodes(tree, &count);
    assert_string_equal(nodes[0].medium_name, "air");
    assert_int_equal(nodes[0].end, CUVETTE_END_HIT);
    assert_string_equal(nodes[0].solid_name, "vessel");
    assert_non_null(nodes[0].face_name);
    const double sin_in = sqrt(1 - nodes[0].cos_in * nodes[0].cos_in),
                 sin_out = sqrt(1 - nodes[0].cos_out * nodes[0].cos_out);
    assert_true(fabs(nodes[0].n_before * sin_in - nodes[0].n_after * sin_out) < 1e-12);
    assert_true(fabs(sin(nodes[0].angle_in_deg * (M_PI / 180)) - sin_in) < 1e-12 &&
                fabs(sin(nodes[0].angle_out_deg * (M_PI / 180)) - sin_out) < 1e-12);
    char path[] = "/tmp/cuvette-tree-XXXXXX.json";
    close(mkstemps(path, 5));
    fine(cuvette_tree_write(tree, path, &why), &why);
    assert_int_equal(unlink(path), 0);
    assert_int_equal(cuvette_tree_write(tree, "tree.png", &why), CUVETTE_BAD_INPUT);
    assert_string_equal(why.remedy, "use .txt, .json, .csv or .svg");
    cuvette_tree_destroy(tree);
}

/* The paraxial focus of a ball of radius 1 in air: n / (2 (n - 1)) behind its centre. */
/* Of a medium that absorbs by wavelength, the three channels are equal then, and follow Beer and Lambert. */
static void test_one_wavelength(void **state)
{
    (void)state;
    static const char text[] =
        "camera: {position: [0, 0, -6], target: [0, 0, 0]}\n"
        "solids:\n"
        "  ball: {shape: sphere, position: [0, 0, 0], radius: 1, transparency: 1, medium: water,\n"
        "         absorb_spectrum: [400, 0.1, 700, 0.7]}\n";
    const cuvette_ray axis = {.origin = {0, 0, -6}, .direction = {0, 0, 1}};
    cuvette_diagnostic why;
    cuvette_scene *s;
    cuvette_query *q;
    cuvette_tree *tree;
    fine(cuvette_scene_read_text("ball", text, sizeof text - 1, &s, &why), &why);
    fine(cuvette_query_wavelength_create(s, 500, NULL, &q, &why), &why);
    fine(cuvette_query_trace(q, &axis, &tree, &why), &why);
    const cuvette_node *node = cuvette_tree_nodes(tree, NULL);
    const cuvette_node *inside = node;
    while (inside->medium != 0)
        inside++;
    assert_true(fabs(node->n_after - 1.3374) < 1e-3);
    for (int k = 0; k < 3; k++)
        assert_true(fabs(inside->transmittance[k] - exp(-0.3 * 2)) < 1e-12);
    cuvette_tree_destroy(tree);
    cuvette_query_destroy(q);
    assert_int_equal(cuvette_query_wavelength_create(s, 10, NULL, &q, &why), CUVETTE_BAD_INPUT);
    assert_null(q);
    cuvette_scene_destroy(s);
}

typedef struct beam_tally {
    int rays, stop_after;
    cuvette_tree *first; /* kept */
    double power;
} beam_tally;

static bool take_beam_ray(void *context, const cuvette_beam_ray *ray, cuvette_tree *tree)
{
    beam_tally *t = context;
    assert_string_equal(ray->beam_name, "sun");
    assert_true(ray->number < ray->rays && ray->beam == 0);
    t->power += ray->power;
    if (t->rays++ == 0)
        t->first = tree;
    else
        cuvette_tree_destroy(tree);
    return t->rays != t->stop_after;
}

static void test_beams(void **state)
{
    (void)state;
    cuvette_diagnostic why;
    cuvette_scene *s;
    size_t count;
    beam_tally all = {0}, two = {.stop_after = 2};
    fine(cuvette_scene_read("experiments/scenes/lens.yaml", &s, &why), &why);
    cuvette_query *q = query_of(s);
    fine(cuvette_query_each_beam_ray(q, take_beam_ray, &all, &why), &why);
    fine(cuvette_query_each_beam_ray(q, take_beam_ray, &two, &why), &why);
    cuvette_query_destroy(q);
    assert_true(all.rays > 2 && two.rays == 2 && fabs(all.power - 1) < 1e-12);
    const cuvette_node *node = cuvette_tree_nodes(all.first, &count);
    assert_string_equal(node->medium_name, "air");
    assert_string_equal(node->solid_name, "vessel");
    assert_true(count > 1);
    cuvette_tree_destroy(all.first);
    cuvette_tree_destroy(two.first);
}

static void test_focus_of_a_ball(void **state)
{
    (void)state;
    static const char text[] =
        "solids: {ball: {shape: sphere, position: [0, 0, 0], radius: 1, transparency: 1, ior: 1.5}}";
    cuvette_diagnostic why;
    cuvette_scene *s;
    fine(cuvette_scene_read_text("ball.yaml", text, strlen(text), &s, &why), &why);
    cuvette_query *q = query_of(s);
    cuvette_fan_rule rule = {.size = sizeof rule, .from = {-5, 0, 0}, .rays = 11, .width = 0.002};
    cuvette_fan *f;
    cuvette_focus focus = {.size = sizeof focus};
    size_t rays, nodes, crossings;
    fine(cuvette_query_fan(q, &rule, &f, &why), &why);
    cuvette_query_destroy(q);
    fine(cuvette_fan_focus(f, &focus, &why), &why);
    assert_true(focus.exists && !focus.is_virtual && fabs(focus.point[0] - 1.5) < 1e-5);
    assert_non_null(cuvette_fan_rays(f, &rays));
    assert_non_null(cuvette_fan_nodes(f, &nodes));
    assert_non_null(cuvette_fan_crossings(f, &crossings));
    assert_true(rays == 11 && nodes == 33 && crossings == 10);
    assert_string_equal(cuvette_fan_rays(f, NULL)[3].end_name, "sky");
    cuvette_fan_destroy(f);
}

/* The section of a ball next to its centre: a circle about the origin of the plane. */
static void test_section(void **state)
{
    (void)state;
    static const char text[] =
        "solids: {ball: {shape: sphere, position: [0, 0, 0], radius: 1, transparency: 1, ior: 1.5}}";
    const double at[] = {0, 0, 0.6}, nan_at[] = {0, NAN, 0};
    cuvette_diagnostic why;
    cuvette_scene *s;
    fine(cuvette_scene_read_text("ball.yaml", text, strlen(text), &s, &why), &why);
    cuvette_query *q = query_of(s);
    cuvette_section_rule rule = {.size = sizeof rule, .at = at, .cells = 50};
    fine(cuvette_query_write_section(q, &rule, "ball.json", &why), &why);
    json_t *o = json_load_file("ball.json", 0, NULL), *areas = json_object_get(o, "areas");
    assert_int_equal(json_array_size(areas), 1);
    const json_t *ring = json_array_get(json_object_get(json_array_get(areas, 0), "rings"), 0);
    assert_true(json_array_size(ring) > 30);
    for (size_t i = 0; i < json_array_size(ring); i++) {
        const json_t *point = json_array_get(ring, i);
        const double u = json_number_value(json_array_get(point, 0)), v = json_number_value(json_array_get(point, 1));
        assert_true(fabs(hypot(u, v) - 0.8) < 1e-9);
    }
    json_decref(o);
    fine(cuvette_query_write_section(q, &(cuvette_section_rule){.size = sizeof rule, .through = "ball"}, "ball.svg",
                                     &why),
         &why);
    const cuvette_section_rule bad[] = {{.size = 1},
                                        {.size = sizeof rule, .view = 3},
                                        {.size = sizeof rule, .at = nan_at},
                                        {.size = sizeof rule, .through = "none"},
                                        {.size = sizeof rule, .cells = 1},
                                        {.size = sizeof rule, .extent = {1, 0, 0, 1}}};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++)
        assert_int_equal(cuvette_query_write_section(q, &bad[i], "bad.json", &why), CUVETTE_BAD_INPUT);
    assert_int_equal(cuvette_query_write_section(q, &rule, "ball.txt", &why), CUVETTE_BAD_INPUT);
    remove("ball.json");
    remove("ball.svg");
    cuvette_query_destroy(q);
}

static void test_wrong_rays_and_fans(void **state)
{
    (void)state;
    cuvette_diagnostic why;
    cuvette_query *q = query_of(small_rod());
    cuvette_tree *tree = (cuvette_tree *)&why;
    cuvette_fan *f = (cuvette_fan *)&why;
    const cuvette_ray nowhere = {.origin = {0, 0, 0}};
    assert_int_equal(cuvette_query_trace(q, &nowhere, &tree, &why), CUVETTE_BAD_INPUT);
    assert_null(tree);
    assert_int_equal(cuvette_query_trace_pixel(q, WIDTH, 0, &tree, &why), CUVETTE_BAD_INPUT);
    assert_int_equal(cuvette_query_trace_pixel(NULL, 0, 0, &tree, &why), CUVETTE_BAD_INPUT);
    const cuvette_fan_rule good = {.size = sizeof good, .from = {-3, 1.5, 0}, .to = {3, 1.5, 0}, .rays = 3, .width = 1};
    cuvette_fan_rule bad[7] = {good, good, good, good, good, good, good};
    bad[0].size = 8, bad[1].rays = 0, bad[2].width = -1, bad[3].spread_deg = 180, bad[4].from[1] = (double)NAN;
    memcpy(bad[5].to, bad[5].from, sizeof bad[5].to);
    bad[6].normal[2] = (double)NAN;
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        assert_int_equal(cuvette_query_fan(q, &bad[i], &f, &why), CUVETTE_BAD_INPUT);
        assert_true(f == NULL && why.what[0] && why.remedy[0]);
    }
    assert_string_equal(why.what, "the fan's axis or normal is not finite");
    assert_null(cuvette_tree_nodes(NULL, NULL));
    assert_null(cuvette_fan_rays(NULL, NULL));
    cuvette_tree_destroy(NULL);
    cuvette_fan_destroy(NULL);
    cuvette_query_destroy(q);
}

typedef struct tally {
    int seen, passed, most;
    char first[64];
} tally;

static bool count_metric(void *context, const cuvette_metric *one)
{
    tally *t = context;
    if (!t->seen++)
        snprintf(t->first, sizeof t->first, "%s", one->name);
    t->passed += strcmp(one->verdict, "pass") == 0 && one->error <= one->tolerance;
    return t->seen < t->most;
}

static bool count_curve(void *context, const cuvette_curve *one)
{
    tally *t = context;
    t->passed += one->x[0] && one->y[0];
    return ++t->seen < t->most;
}

static void test_optics(void **state)
{
    (void)state;
    cuvette_diagnostic why;
    cuvette_scene *s;
    fine(cuvette_scene_read(ROD, &s, &why), &why);
    tally all = {.most = 1000}, some = {.most = 3}, curves = {.most = 1000};
    fine(cuvette_scene_each_metric(s, count_metric, &all, &why), &why);
    fine(cuvette_scene_each_metric(s, count_metric, &some, &why), &why);
    fine(cuvette_scene_each_curve(s, count_curve, &curves, &why), &why);
    assert_true(all.seen > 30 && all.passed == all.seen && some.seen == 3 && curves.seen == curves.passed);
    double points[1024][3];
    size_t count = 0;
    fine(cuvette_scene_curve(s, "fresnel-s", points, 1024, &count, &why), &why);
    assert_true(count > 10 && fabs(points[0][1] - 0.04) < 1e-9 && points[0][1] == points[0][1]);
    const size_t whole = count;
    assert_int_equal(cuvette_scene_curve(s, "fresnel-s", points, 3, &count, &why), CUVETTE_BAD_INPUT);
    assert_int_equal(count, whole);
    assert_int_equal(cuvette_scene_curve(s, "snell", points, 3, &count, &why), CUVETTE_BAD_INPUT);
    assert_int_equal(cuvette_scene_curve(s, "rainbow", points, 1024, &count, &why), CUVETTE_BAD_INPUT);
    assert_int_equal(cuvette_scene_each_metric(s, NULL, NULL, &why), CUVETTE_BAD_INPUT);
    cuvette_scene_destroy(s);
}

static void test_comparison(void **state)
{
    (void)state;
    static float one[3 * WIDTH * HEIGHT], other[3 * WIDTH * HEIGHT], map[3 * WIDTH * HEIGHT];
    cuvette_diagnostic why;
    cuvette_comparison found = {.size = sizeof found};
    for (size_t i = 0; i < sizeof one / sizeof *one; i++)
        one[i] = other[i] = 0.25F;
    fine(cuvette_compare(WIDTH, HEIGHT, one, other, NULL, &found, &why), &why);
    assert_true(found.mse == 0 && found.flip == 0 && found.ssim == 1 && isinf(found.psnr_db));
    other[3 * (5 * WIDTH + 7)] = 1.0F;
    fine(cuvette_compare(WIDTH, HEIGHT, one, other, map, &found, &why), &why);
    assert_true(found.largest > 0.4 && found.largest_x == 7 && found.largest_y == 5 && found.flip > 0);
    assert_true(map[3 * (5 * WIDTH + 7)] > map[0]);
    other[4] = (float)NAN;
    assert_int_equal(cuvette_compare(WIDTH, HEIGHT, one, other, NULL, &found, &why), CUVETTE_BAD_INPUT);
    assert_int_equal(cuvette_compare(0, HEIGHT, one, other, NULL, &found, &why), CUVETTE_BAD_INPUT);
    assert_int_equal(cuvette_compare(WIDTH, HEIGHT, one, NULL, NULL, &found, &why), CUVETTE_BAD_INPUT);
    cuvette_image *img = NULL;
    int width, height;
    fine(cuvette_image_read("experiments/scenes/chequer.png", &img, &why), &why);
    assert_non_null(cuvette_image_rgb(img, &width, &height));
    assert_true(width > 0 && height > 0);
    cuvette_image_destroy(img);
    assert_int_equal(cuvette_image_read("absent.png", &img, &why), CUVETTE_BAD_INPUT);
    assert_true(img == NULL && strcmp(why.file, "absent.png") == 0);
}

static void test_layers_and_maps(void **state)
{
    (void)state;
    static double rays[WIDTH * HEIGHT];
    cuvette_diagnostic why;
    cuvette_scene *s = small_rod();
    cuvette_request request = CUVETTE_REQUEST;
    request.layers = request.pixel_rays = true;
    const float *values = NULL;
    int channels = 0;
    cuvette_frame *frame = frame_of(s, &request);
    cuvette_counters counts = {.size = sizeof counts};
    fine(cuvette_frame_map(frame, "rays", rays, &why), &why);
    fine(cuvette_frame_counters(frame, &counts, &why), &why);
    double sum = 0;
    for (size_t i = 0; i < sizeof rays / sizeof *rays; i++)
        sum += rays[i];
    assert_true(sum == (double)(counts.camera + counts.reflect + counts.refract + counts.shadow));
    assert_int_equal(cuvette_frame_map(frame, "time", rays, &why), CUVETTE_BAD_INPUT);
    assert_int_equal(cuvette_frame_map(frame, "noise", rays, &why), CUVETTE_BAD_INPUT);
    assert_int_equal(cuvette_frame_map(frame, "heat", rays, &why), CUVETTE_BAD_INPUT);
    assert_int_equal(cuvette_frame_layer(frame, "depth", &values, &channels, &why), CUVETTE_BAD_INPUT);
    cuvette_frame_destroy(frame);
    fine(cuvette_scene_set(s, "render.integrator", "aov", &why), &why);
    frame = frame_of(s, &request);
    fine(cuvette_frame_layer(frame, "depth", &values, &channels, &why), &why);
    assert_true(channels == 1 && values[HEIGHT / 2 * WIDTH + WIDTH / 2] > 1.0F);
    fine(cuvette_frame_layer(frame, "normal", &values, &channels, &why), &why);
    assert_int_equal(channels, 3);
    assert_int_equal(cuvette_frame_layer(frame, "heat", &values, &channels, &why), CUVETTE_BAD_INPUT);
    cuvette_frame_destroy(frame);
    cuvette_scene_destroy(s);
}

/* A program that was compiled with the first version of the request has a smaller one. */
static void test_a_request_of_the_first_version(void **state)
{
    (void)state;
    cuvette_diagnostic why;
    cuvette_engine *engine;
    cuvette_scene *s = small_rod();
    cuvette_request request = CUVETTE_REQUEST;
    request.size = offsetof(cuvette_request, layers);
    memset((char *)&request + request.size, 0xff, sizeof request - request.size);
    cuvette_frame *frame = frame_of(s, &request);
    double rays[1];
    assert_int_equal(cuvette_frame_map(frame, "rays", rays, &why), CUVETTE_BAD_INPUT);
    cuvette_frame_destroy(frame);
    fine(cuvette_engine_create(NULL, &engine, &why), &why);
    request.size--;
    assert_int_equal(cuvette_engine_render(engine, s, &request, NULL, &why), CUVETTE_BAD_INPUT);
    cuvette_engine_destroy(engine);
    cuvette_scene_destroy(s);
}

/* Of a grid of rays, those that hit a box whose walls have holes. */
static int hits_of_holes(const char *alpha)
{
    enum { SIDE = 20 };
    cuvette_diagnostic why;
    cuvette_scene *s;
    cuvette_query *q;
    cuvette_ray rays[SIDE * SIDE] = {0};
    cuvette_hit hits[SIDE * SIDE];
    unsigned char blocked[SIDE * SIDE];
    int count = 0;
    fine(cuvette_scene_read("tests/data/acts/holes.yaml", &s, &why), &why);
    turn(s, "wall.alpha", alpha);
    turn(s, "ground.visible", "off");
    fine(cuvette_query_create(s, NULL, &q, &why), &why);
    for (int i = 0; i < SIDE * SIDE; i++)
        fine(cuvette_query_camera_ray(q, 12 + 2.0 * (i % SIDE), 9 + 1.5 * (i / SIDE), &rays[i], &why), &why);
    fine(cuvette_query_nearest(q, rays, SIDE * SIDE, hits, &why), &why);
    fine(cuvette_query_occluded(q, rays, SIDE * SIDE, blocked, &why), &why);
    for (int i = 0; i < SIDE * SIDE; i++) {
        assert_true(blocked[i] == isfinite(hits[i].distance));
        count += isfinite(hits[i].distance) != 0;
    }
    cuvette_query_destroy(q);
    cuvette_scene_destroy(s);
    return count;
}

/* A blended surface is there where its alpha is at least 1/2, as one that is cut there. */
static void rays_pass_through_what_alpha_removes(void **state)
{
    (void)state;
    const int whole = hits_of_holes("opaque"), cut = hits_of_holes("mask");
    assert_true(cut > 0 && cut < whole);
    assert_int_equal(hits_of_holes("blend"), cut);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_radiance_of_a_tree_is_the_film),
        cmocka_unit_test(test_a_tree_outlives_its_query),
        cmocka_unit_test(test_one_wavelength),
        cmocka_unit_test(test_beams),
        cmocka_unit_test(test_focus_of_a_ball),
        cmocka_unit_test(test_section),
        cmocka_unit_test(test_wrong_rays_and_fans),
        cmocka_unit_test(test_optics),
        cmocka_unit_test(test_comparison),
        cmocka_unit_test(test_layers_and_maps),
        cmocka_unit_test(test_a_request_of_the_first_version),
        cmocka_unit_test(rays_pass_through_what_alpha_removes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
