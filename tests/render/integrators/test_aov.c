/* Tests of the named layers of the integrator aov against closed forms: planes at known distances, a sphere's normals,
 * a checker's cells, numbers in the scene's order, nothing behind a clear surface, zeros for a miss; bit-identical for
 * any number of threads and instruction set; and the files read back. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <unistd.h>
#include <cmocka.h>

#include "image/image.h"
#include "render/frame/record.h"
#include "render/plan/film.h"
#include "render_fixture.h"

enum { WIDTH = 48, HEIGHT = 32 };
#define EYE 3.0
#define PITCH_DEG (-30.0)
#define FOV_DEG 50.0
#define DEGREE (3.14159265358979323846 / 180.0)
#define HEAD                                                                            \
    "render: {width: 48, height: 32, integrator: aov}\n"                                \
    "camera: {position: [0, 3, 0], pitch_deg: -30, fov_deg: 50}\n"                      \
    "background: {color: [0.5, 0.6, 0.7]}\n"                                            \
    "materials:\n"                                                                      \
    "  tiles: {color: [0.8, 0.7, 0.6], checker: 0.5, checker_color: [0.1, 0.2, 0.3]}\n" \
    "  red: {color: [0.9, 0.1, 0.05]}\n"                                                \
    "solids:\n"

static const char room[] = HEAD "  ground: {shape: plane, material: tiles}\n"
                                "  ball: {shape: sphere, radius: 1, position: [-1, 1, 4], material: red}\n"
                                "  own: {shape: sphere, radius: 0.5, position: [1.5, 0.5, 3], color: [0, 1, 0]}\n"
                                "  glass: {shape: sphere, radius: 0.6, position: [1, 2, 4.5], transparency: 1, "
                                "ior: 1.5, material: red}\n";

/* The textbook direction through the middle of a pixel: the camera looks along +z, pitched down. */
static vec3 direction(int x, int y)
{
    const double half = tan(0.5 * FOV_DEG * DEGREE), u = (2.0 * (x + 0.5) / WIDTH - 1.0) * half * WIDTH / HEIGHT,
                 v = (1.0 - 2.0 * (y + 0.5) / HEIGHT) * half;
    const double s = sin(PITCH_DEG * DEGREE), c = cos(PITCH_DEG * DEGREE);
    return vec3_normalize(vec3_make(u, s + v * c, c - v * s));
}

static double distance_to_sphere(vec3 d, vec3 center, double radius)
{
    const vec3 to_center = vec3_sub(center, vec3_make(0.0, EYE, 0.0));
    const double along = vec3_dot(to_center, d),
                 rest = radius * radius - vec3_dot(to_center, to_center) + along * along;
    return rest > 0.0 ? along - sqrt(rest) : (double)HUGE_VAL;
}

typedef struct ball {
    double solid, material, radius;
    vec3 center, color;
} ball;
/* Materials: tiles 1, red 2; a solid's own surface has 2 plus the solid's number. */
static const ball balls[] = {{2, 2, 1.0, {-1.0, 1.0, 4.0}, {0.9, 0.1, 0.05}},
                             {3, 2 + 3, 0.5, {1.5, 0.5, 3.0}, {0.0, 1.0, 0.0}},
                             {4, 2, 0.6, {1.0, 2.0, 4.5}, {0.9, 0.1, 0.05}}};

static render_result *layers_at(const scene *s, isa level)
{
    render_result *r = render_at(s, level, &(render_options){.layers = true});
    assert_non_null(r->layers);
    return r;
}

static vec3 value(const render_result *r, layer_rule which, int x, int y)
{
    const int channels = layer_channels[which];
    const float *at = r->layers->values[which] + ((size_t)y * WIDTH + (size_t)x) * (size_t)channels;
    return channels == 3 ? vec3_make((double)at[0], (double)at[1], (double)at[2]) : vec3_make((double)at[0], 0.0, 0.0);
}

static void near(vec3 a, vec3 b, double within)
{
    assert_true(vec3_length(vec3_sub(a, b)) <= within);
}

/* The first hit at a pixel: the nearest of the balls and the ground. */
static int check_pixel(const render_result *r, int x, int y)
{
    const vec3 d = direction(x, y), eye = vec3_make(0.0, EYE, 0.0);
    double t = d.y < 0.0 ? -EYE / d.y : (double)HUGE_VAL;
    const ball *hit_ball = NULL;
    for (size_t i = 0; i < sizeof balls / sizeof *balls; i++) {
        const double at = distance_to_sphere(d, balls[i].center, balls[i].radius);
        if (at < t)
            t = at, hit_ball = &balls[i];
    }
    if (isinf(t)) {
        for (int i = 0; i < LAYER_COUNT; i++)
            near(value(r, (layer_rule)i, x, y), vec3_make(0.0, 0.0, 0.0), 0.0);
        return 0;
    }
    const vec3 p = vec3_add(eye, vec3_scale(d, t)), expected = {t, 0.0, 0.0};
    near(value(r, LAYER_DEPTH, x, y), expected, 2e-6 * t);
    near(value(r, LAYER_POSITION, x, y), p, 2e-6 * t);
    if (hit_ball) {
        near(value(r, LAYER_NORMAL, x, y), vec3_scale(vec3_sub(p, hit_ball->center), 1.0 / hit_ball->radius), 1e-5);
        near(value(r, LAYER_ALBEDO, x, y), hit_ball->color, 1e-6);
        near(value(r, LAYER_SOLID, x, y), vec3_make(hit_ball->solid, 0.0, 0.0), 0.0);
        near(value(r, LAYER_MATERIAL, x, y), vec3_make(hit_ball->material, 0.0, 0.0), 0.0);
        return 1 << (int)hit_ball->solid;
    }
    const bool even = ((int)floor(p.x / 0.5) + (int)floor(p.z / 0.5)) % 2 == 0;
    near(value(r, LAYER_NORMAL, x, y), vec3_make(0.0, 1.0, 0.0), 0.0);
    near(value(r, LAYER_ALBEDO, x, y), even ? vec3_make(0.8, 0.7, 0.6) : vec3_make(0.1, 0.2, 0.3), 1e-6);
    near(value(r, LAYER_SOLID, x, y), vec3_make(1.0, 0.0, 0.0), 0.0);
    near(value(r, LAYER_MATERIAL, x, y), vec3_make(1.0, 0.0, 0.0), 0.0);
    return even ? 1 << 10 : 1 << 11;
}

static void layers_match_closed_forms(void **state)
{
    (void)state;
    scene *s = scene_from(room);
    set(s, "render.samples=4"); /* still the pixel's middle */
    for (int turn = 0; turn < 2; turn++) {
        int seen = 0;
        render_result *r = layers_at(s, isa_best());
        for (int y = 0; y < HEIGHT; y++)
            for (int x = 0; x < WIDTH; x++)
                seen |= check_pixel(r, x, y);
        assert_int_equal(seen, 1 << 2 | 1 << 3 | 1 << 4 | 1 << 10 | 1 << 11);
        render_result_destroy(r);
        set(s, "render.layer=solid"); /* the shown layer makes no difference */
    }
    scene_destroy(s);
}

/* Where priority gives the overlap to a solid with the medium of the surroundings, it cuts a piece off: the difference
 * of two balls is seen with the first one's material and, in the cut, with the other one's shape. */
static void a_solid_of_the_surroundings_cuts_another(void **state)
{
    (void)state;
    scene *s = scene_from(HEAD "  ball: {shape: sphere, radius: 1, position: [-1, 1, 4], material: red}\n"
                               "  bite: {shape: sphere, radius: 0.6, position: [-0.7, 1.5, 3.2], priority: 1, "
                               "transparency: 1, ior: 1}\n");
    const vec3 eye = {0.0, EYE, 0.0}, ball_center = {-1.0, 1.0, 4.0}, bite_center = {-0.7, 1.5, 3.2};
    render_result *r = layers_at(s, isa_best());
    int cut = 0, whole = 0;
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++) {
            const vec3 d = direction(x, y);
            const double in = distance_to_sphere(d, ball_center, 1.0), bite = distance_to_sphere(d, bite_center, 0.6);
            const double out = 2.0 * vec3_dot(vec3_sub(ball_center, eye), d) - in,
                         bite_out = 2.0 * vec3_dot(vec3_sub(bite_center, eye), d) - bite;
            const bool bitten = !isinf(in) && bite < in && bite_out > in;
            const double t = bitten ? bite_out : in;
            if (isinf(in) || (bitten && bite_out >= out)) {
                near(value(r, LAYER_DEPTH, x, y), vec3_make(0.0, 0.0, 0.0), 0.0);
                continue;
            }
            const vec3 p = vec3_add(eye, vec3_scale(d, t));
            near(value(r, LAYER_DEPTH, x, y), vec3_make(t, 0.0, 0.0), 2e-6 * t);
            near(value(r, LAYER_NORMAL, x, y),
                 bitten ? vec3_scale(vec3_sub(bite_center, p), 1.0 / 0.6) : vec3_sub(p, ball_center), 1e-5);
            near(value(r, LAYER_SOLID, x, y), vec3_make(1.0, 0.0, 0.0), 0.0);
            near(value(r, LAYER_ALBEDO, x, y), vec3_make(0.9, 0.1, 0.05), 1e-6);
            cut += bitten, whole += !bitten;
        }
    assert_true(cut > 20 && whole > 20);
    render_result_destroy(r);
    scene_destroy(s);
}

static void misses_are_zero(void **state)
{
    (void)state;
    scene *s = scene_from(HEAD "  ball: {shape: sphere, radius: 0.5, position: [0, 1, 3]}\n");
    render_result *r = layers_at(s, isa_best());
    int empty = 0;
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++) {
            const bool miss = isinf(distance_to_sphere(direction(x, y), vec3_make(0.0, 1.0, 3.0), 0.5));
            empty += miss;
            assert_true(miss == (value(r, LAYER_SOLID, x, y).x == 0.0));
            for (int i = 0; i < LAYER_COUNT && miss; i++)
                near(value(r, (layer_rule)i, x, y), vec3_make(0.0, 0.0, 0.0), 0.0);
            for (int c = 0; c < 3 && miss; c++)
                assert_true(film_value(r->img, x, y, c) == 0.0);
        }
    assert_in_range(empty, WIDTH * HEIGHT / 2, WIDTH * HEIGHT - 9);
    render_result_destroy(r);
    scene_destroy(s);
}

/* The view of normals has the format of normal maps: (n + 1) / 2 as encoded numbers. */
static void the_view_of_normals_is_encoded_as_a_normal_map(void **state)
{
    (void)state;
    scene *s = scene_from(room);
    render_result *r = layers_at(s, isa_best());
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++) {
            const vec3 n = value(r, LAYER_NORMAL, x, y);
            const double expected[3] = {0.5 + 0.5 * n.x, 0.5 + 0.5 * n.y, 0.5 + 0.5 * n.z};
            for (int c = 0; c < 3 && value(r, LAYER_SOLID, x, y).x > 0.0; c++)
                assert_true(fabs(srgb_encode(film_value(r->img, x, y, c)) - expected[c]) < 1e-6);
        }
    render_result_destroy(r);
    scene_destroy(s);
}

/* A distance t is shown as L / (L + t), with one length L for the frame. */
static void the_view_of_distances_is_bright_near_by(void **state)
{
    (void)state;
    scene *s = scene_from(room);
    set(s, "render.layer=depth");
    render_result *r = layers_at(s, isa_best());
    double least = HUGE_VAL, most = 0.0;
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++) {
            const double t = value(r, LAYER_DEPTH, x, y).x, shown = srgb_encode(film_value(r->img, x, y, 0));
            if (!(value(r, LAYER_SOLID, x, y).x > 0.0))
                continue;
            assert_true(t > 0.0 && shown > 0.0 && shown < 1.0);
            const double length = t * shown / (1.0 - shown);
            least = fmin(least, length), most = fmax(most, length);
        }
    assert_true(least > 0.0 && most < least * (1.0 + 1e-3));
    render_result_destroy(r);
    scene_destroy(s);
}

/* A coordinate x is shown as 1/2 + x / 2 (L + |x|), with one length L for the frame, so that none is cut off. */
static void the_view_of_positions_shows_signs_and_never_clips(void **state)
{
    (void)state;
    scene *s = scene_from(room);
    set(s, "render.layer=position");
    render_result *r = layers_at(s, isa_best());
    double least = HUGE_VAL, most = 0.0;
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++) {
            const vec3 p = value(r, LAYER_POSITION, x, y);
            const double of[3] = {p.x, p.y, p.z};
            for (int c = 0; c < 3 && value(r, LAYER_SOLID, x, y).x > 0.0; c++) {
                const double offset = srgb_encode(film_value(r->img, x, y, c)) - 0.5;
                if (fabs(of[c]) < 0.1)
                    continue;
                assert_true(offset * of[c] > 0.0);
                const double length = fabs(of[c]) * (0.5 / fabs(offset) - 1.0);
                least = fmin(least, length), most = fmax(most, length);
            }
        }
    assert_true(least > 0.0 && most < least * (1.0 + 1e-3));
    render_result_destroy(r);
    scene_destroy(s);
}

/* Solids with numbers close to each other have colours that a person tells apart. */
static void the_view_of_solids_has_distinct_colours(void **state)
{
    (void)state;
    enum { SOLIDS = 12 };
    char text[4096];
    int length = snprintf(text, sizeof text, "%s", HEAD);
    for (int i = 0; i < SOLIDS; i++)
        length += snprintf(text + length, 128, "  s%d: {shape: sphere, radius: 0.25, position: [%g, %g, 3]}\n", i,
                           -1.2 + 0.8 * (i % 4), 0.5 + 0.8 * (i / 4));
    scene *s = scene_from(text);
    set_all(s, "render.layer=solid camera.pitch_deg=-30");
    render_result *r = layers_at(s, isa_best());
    double color[SOLIDS][3];
    int seen = 0;
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++) {
            const int number = (int)value(r, LAYER_SOLID, x, y).x;
            for (int c = 0; c < 3 && number > 0; c++)
                color[number - 1][c] = srgb_encode(film_value(r->img, x, y, c));
            seen |= number > 0 ? 1 << (number - 1) : 0;
        }
    assert_int_equal(seen, (1 << SOLIDS) - 1);
    for (int i = 0; i < SOLIDS; i++)
        for (int k = 0; k < i; k++)
            assert_true(fmax(fabs(color[i][0] - color[k][0]),
                             fmax(fabs(color[i][1] - color[k][1]), fabs(color[i][2] - color[k][2]))) > 0.1);
    render_result_destroy(r);
    scene_destroy(s);
}

static void same(const render_result *a, const render_result *b)
{
    assert_true(film_hash(a->img) == film_hash(b->img));
    for (int i = 0; i < LAYER_COUNT; i++)
        assert_memory_equal(a->layers->values[i], b->layers->values[i],
                            WIDTH * HEIGHT * sizeof(float) * (size_t)layer_channels[i]);
}

static void layers_are_bit_identical_for_any_threads_and_instruction_set(void **state)
{
    (void)state;
    scene *s = scene_from(room);
    for (int layer = 0; layer < LAYER_COUNT; layer++) {
        s->render.layer = layer;
        s->render.threads = 1;
        render_result *expected = layers_at(s, ISA_BASE);
        for (int level = ISA_BASE; level <= (int)isa_best(); level++) {
            s->render.threads = 8;
            s->render.schedule = SCHEDULE_DYNAMIC, s->render.tile = 8;
            render_result *r = layers_at(s, (isa)level);
            same(r, expected);
            render_result_destroy(r);
        }
        render_result_destroy(expected);
    }
    scene_destroy(s);
}

static void written_layers_read_back(void **state)
{
    (void)state;
    char folder[] = "/tmp/cuvette-aov-XXXXXX", prefix[64];
    diagnostic why = {0};
    scene *s = scene_from(room);
    render_result *r = layers_at(s, isa_best());
    assert_non_null(mkdtemp(folder));
    snprintf(prefix, sizeof prefix, "%s/a", folder);
    worked(record_layers(r, prefix, &why), &why);
    for (int i = 0; i < LAYER_COUNT; i++) {
        image *back = NULL;
        char *path = record_layer_path(prefix, i);
        worked(image_read(path, &back, NULL, &why), &why);
        assert_true(back->width == WIDTH && back->height == HEIGHT);
        for (size_t k = 0; k < 3 * WIDTH * HEIGHT; k++) {
            const float *values = r->layers->values[i];
            assert_true(back->pixel[k] == values[layer_channels[i] == 3 ? k : k / 3]);
        }
        image_destroy(back);
        unlink(path);
        free(path);
    }
    assert_int_equal(rmdir(folder), 0);
    render_result_destroy(r);
    scene_destroy(s);
}

/* There are no layers unless requested, and none with another integrator. */
static void layers_exist_only_on_request(void **state)
{
    (void)state;
    scene *s = scene_from(room);
    render_result *r = render(s);
    assert_null(r->layers);
    render_result_destroy(r);
    set(s, "render.integrator=whitted");
    r = render_at(s, isa_best(), &(render_options){.layers = true});
    assert_null(r->layers);
    render_result_destroy(r);
    scene_destroy(s);
}

/* Three colours or coordinates in each of three layers, one number in the others, as floats. */
static void the_memory_of_a_pixel_is_that_of_its_layers(void **state)
{
    (void)state;
    assert_int_equal(layers_bytes(), (3 * 3 + 3) * sizeof(float));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(layers_match_closed_forms),
        cmocka_unit_test(the_memory_of_a_pixel_is_that_of_its_layers),
        cmocka_unit_test(a_solid_of_the_surroundings_cuts_another),
        cmocka_unit_test(misses_are_zero),
        cmocka_unit_test(the_view_of_normals_is_encoded_as_a_normal_map),
        cmocka_unit_test(the_view_of_distances_is_bright_near_by),
        cmocka_unit_test(the_view_of_positions_shows_signs_and_never_clips),
        cmocka_unit_test(the_view_of_solids_has_distinct_colours),
        cmocka_unit_test(layers_are_bit_identical_for_any_threads_and_instruction_set),
        cmocka_unit_test(written_layers_read_back),
        cmocka_unit_test(layers_exist_only_on_request),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
