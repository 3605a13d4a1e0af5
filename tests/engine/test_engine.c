/* Tests of the engine's interface, cuvette.h. Its films are compared with the renderer's, with reference film hashes,
 * and with closed forms; tests/engine/engine.sh tests its installation and linking. */
#include <math.h>
#include <pthread.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <cmocka.h>

#include "cuvette.h"
#include "engine_fixture.h"
#include "probe_fixture.h"
#include <stdatomic.h>
#include <sys/wait.h>
#include <unistd.h>

static void the_library_has_the_headers_version(void **state)
{
    (void)state;
    char text[32];
    snprintf(text, sizeof text, "%d.%d.%d", CUVETTE_VERSION_MAJOR, CUVETTE_VERSION_MINOR, CUVETTE_VERSION_PATCH);
    assert_string_equal(cuvette_version(), text);
}

/* Reference hash from the program: cuvette render experiments/scenes/rod.yaml --set render.depth=8. */
static void the_film_equals_the_programs_film(void **state)
{
    (void)state;
    cuvette_engine *engine = make_engine();
    cuvette_scene *s = rod(800, 8, 2);
    assert_true(hash_of(engine, s) == 0x804d2c54dfedd082);
    turn(s, "render.depth", "4");
    assert_true(hash_of(engine, s) == 0xb92bb012fd9c5f71);
    cuvette_scene_destroy(s);
    cuvette_engine_destroy(engine);
}

/* The frame keeps the scene as it was: later changes are not in the file. */
static void an_image_file_carries_its_scene(void **state)
{
    (void)state;
    static const float white[3] = {1, 1, 1};
    char path[] = "/tmp/cuvette-image-XXXXXX.png";
    close(mkstemps(path, 4));
    cuvette_diagnostic why;
    cuvette_engine *engine = make_engine();
    cuvette_scene *s = rod(40, 4, 2), *again;
    cuvette_frame *frame;
    fine(cuvette_engine_render(engine, s, NULL, &frame, &why), &why);
    turn(s, "liquid.ior", "1.9");
    fine(cuvette_frame_write(frame, path, 8, &why), &why);
    fine(cuvette_scene_read(path, &again, &why), &why);
    assert_true(hash_of(engine, again) == cuvette_frame_hash(frame));
    assert_true(hash_of(engine, s) != cuvette_frame_hash(frame));
    cuvette_frame_destroy(frame);
    cuvette_scene_destroy(again);
    fine(cuvette_scene_add_pixels(s, "from-memory", 1, 1, white, &why), &why);
    fine(cuvette_engine_render(engine, s, NULL, &frame, &why), &why);
    fine(cuvette_frame_write(frame, path, 16, &why), &why);
    assert_int_equal(cuvette_scene_read(path, &again, &why), CUVETTE_BAD_INPUT);
    assert_non_null(strstr(why.what, "holds no scene"));
    cuvette_frame_destroy(frame);
    cuvette_scene_destroy(s);
    cuvette_engine_destroy(engine);
    unlink(path);
}

/* Strides whose last row would lie beyond all memory, where an address would overflow into the memory before it. */
static void impossible_strides_are_refused(void **state)
{
    (void)state;
    enum { W = 16, H = 12, ROW = 3 * W };
    static float around[3 * ROW * H];
    static unsigned char bytes_around[3 * ROW * H];
    float *const rgb = around + ROW * H;
    unsigned char *const srgb = bytes_around + ROW * H;
    const size_t wrong[] = {
        1, ROW - 1, SIZE_MAX, SIZE_MAX - ROW + 1, SIZE_MAX / 2, SIZE_MAX / 4 + 1, (size_t)PTRDIFF_MAX / H + 1};
    cuvette_diagnostic why;
    cuvette_engine *engine = make_engine();
    cuvette_scene *s = rod(W, 2, 1);
    cuvette_frame *frame, *none;
    fine(cuvette_engine_render(engine, s, NULL, &frame, &why), &why);
    for (size_t i = 0; i < COUNT(wrong); i++) {
        cuvette_request linear = CUVETTE_REQUEST, encoded = CUVETTE_REQUEST;
        linear.width = encoded.width = W, linear.height = encoded.height = H;
        linear.rgb = rgb, linear.rgb_stride = wrong[i], encoded.srgb = srgb, encoded.srgb_stride = wrong[i];
        assert_int_equal(cuvette_engine_render(engine, s, &linear, &none, &why), CUVETTE_BAD_INPUT);
        assert_non_null(strstr(why.what, "a stride of "));
        assert_int_equal(cuvette_engine_render(engine, s, &encoded, &none, &why), CUVETTE_BAD_INPUT);
        assert_int_equal(cuvette_frame_rgb(frame, 0, 0, W, H, rgb, wrong[i], &why), CUVETTE_BAD_INPUT);
        assert_int_equal(cuvette_frame_srgb(frame, 0, 0, W, H, srgb, wrong[i], &why), CUVETTE_BAD_INPUT);
    }
    for (size_t i = 0; i < COUNT(around); i++)
        assert_true(around[i] == 0.0F && bytes_around[i] == 0);
    /* one row has no next row */
    fine(cuvette_frame_rgb(frame, 0, 3, W, 4, rgb, (size_t)PTRDIFF_MAX / sizeof *rgb, &why), &why);
    cuvette_frame_destroy(frame);
    cuvette_scene_destroy(s);
    cuvette_engine_destroy(engine);
}

/* fork copies the calling thread only: workers and their states are the parent's. ThreadSanitizer ends a child that
 * starts threads. */
static void a_child_of_fork_renders_with_its_parents_engine(void **state)
{
    (void)state;
#if defined(__SANITIZE_THREAD__)
    skip();
#endif
    static const char *const settings[] = {"on", "off"};
    for (int threads = 1; threads <= 5; threads += 2)
        for (size_t k = 0; k < COUNT(settings); k++) {
            cuvette_diagnostic why;
            cuvette_engine *engine = make_engine();
            cuvette_scene *s = rod(16, 4, threads);
            turn(s, "render.pool", settings[k]);
            const uint64_t right = hash_of(engine, s);
            const pid_t child = fork();
            if (child == 0) {
                cuvette_frame *frame;
                alarm(100); /* a thread that does not exist is waited for without end */
                for (int round = 0; round < 2; round++) {
                    if (cuvette_engine_render(engine, s, NULL, &frame, &why) != CUVETTE_OK ||
                        cuvette_frame_hash(frame) != right)
                        _exit(2);
                    cuvette_frame_destroy(frame);
                    cuvette_scene_set_int(s, "render.threads", threads + 1, NULL);
                }
                cuvette_engine_destroy(engine);
                _exit(0);
            }
            int ended;
            assert_int_equal(waitpid(child, &ended, 0), child);
            assert_true(WIFEXITED(ended) && WEXITSTATUS(ended) == 0);
            assert_true(hash_of(engine, s) == right);
            cuvette_scene_destroy(s);
            cuvette_engine_destroy(engine);
        }
}

static void counters_and_pixels_equal_the_renderers(void **state)
{
    (void)state;
    enum { W = 80, H = 60, WIDE = 300 };
    static float rgb[H * WIDE], again[3 * W * H];
    static unsigned char srgb[H * WIDE], bytes[3 * W * H];
    cuvette_diagnostic why;
    cuvette_engine *engine = make_engine();
    cuvette_scene *s = rod(W, 4, 2);
    scene *model = rod_scene("render.width=80 render.height=60 render.depth=4 render.threads=1");
    render_result *result = render(model);
    const ray_counters *c = &result->counters;

    for (size_t i = 0; i < COUNT(rgb); i++)
        rgb[i] = -7.0F, srgb[i] = 77;
    cuvette_request request = CUVETTE_REQUEST;
    request.width = W, request.height = H, request.rgb = rgb, request.rgb_stride = WIDE, request.srgb = srgb,
    request.srgb_stride = WIDE;
    cuvette_frame *frame;
    fine(cuvette_engine_render(engine, s, &request, &frame, &why), &why);
    assert_true(cuvette_frame_width(frame) == W && cuvette_frame_height(frame) == H);
    fine(cuvette_frame_rgb(frame, 0, 0, W, H, again, 0, &why), &why);
    fine(cuvette_frame_srgb(frame, 0, 0, W, H, bytes, 0, &why), &why);
    for (int y = 0; y < H; y++)
        for (int x = 0; x < WIDE; x++) {
            const float value = rgb[y * WIDE + x];
            const int byte = srgb[y * WIDE + x];
            if (x >= 3 * W) {
                assert_true(value == -7.0F && byte == 77); /* memory after the row is the caller's */
                continue;
            }
            const double truth = film_value(result->img, x / 3, y, x % 3);
            assert_true(value == (float)truth && again[y * 3 * W + x] == value && bytes[y * 3 * W + x] == byte);
            assert_true(fabs(255.0 * srgb_encode((double)value) - byte) <= 0.5000001);
        }
    cuvette_counters counters = {.size = sizeof counters};
    fine(cuvette_frame_counters(frame, &counters, &why), &why);
    assert_true(counters.camera == c->camera && counters.reflect == c->reflect && counters.refract == c->refract &&
                counters.shadow == c->shadow);
    assert_true(counters.total_internal == c->total_internal && counters.cut_depth == c->cut_depth);
    assert_memory_equal(counters.by_depth, c->by_depth, sizeof counters.by_depth);
    assert_true(counters.cut_depth_throughput[1] == (double)c->cut_depth_throughput[1] / COUNTERS_CUT_ONE);
    assert_true(!CUVETTE_COUNTERS || (counters.camera == W * H && counters.cut_depth_throughput[1] > 0.0));
    for (size_t i = 0; i < 4; i++) {
        cuvette_solid_counters one = {.size = sizeof one};
        fine(cuvette_frame_solid_counters(frame, i, &one, &why), &why);
        assert_true(one.tests == c->tests[i] && one.hits == c->hits[i] && one.first_hits == c->first_hits[i]);
    }
    cuvette_statistics statistics = {.size = sizeof statistics};
    fine(cuvette_frame_statistics(frame, &statistics, &why), &why);
    assert_true(statistics.wall_s > 0.0 && statistics.cpu_s > 0.0 && statistics.preview_s == 0.0 &&
                statistics.threads == 2);
    assert_true(isnan(statistics.noise_rms));
    cuvette_frame_destroy(frame);
    render_result_destroy(result);
    scene_destroy(model);
    cuvette_scene_destroy(s);
    cuvette_engine_destroy(engine);
}

/* A program that was compiled with an earlier, shorter struct. */
static void a_shorter_struct_is_filled_up_to_its_size(void **state)
{
    (void)state;
    cuvette_diagnostic why;
    cuvette_engine *engine = make_engine();
    cuvette_scene *s = rod(40, 1, 1);
    cuvette_frame *frame;
    fine(cuvette_engine_render(engine, s, NULL, &frame, &why), &why);
    cuvette_counters counters = {.size = offsetof(cuvette_counters, refract), .refract = 4711};
    fine(cuvette_frame_counters(frame, &counters, &why), &why);
    assert_true(!CUVETTE_COUNTERS || (counters.camera == 40 * 30 && counters.reflect > 0));
    assert_true(counters.refract == 4711);
    counters.size = 0;
    assert_int_equal(cuvette_frame_counters(frame, &counters, &why), CUVETTE_BAD_INPUT);
    cuvette_solid_counters one = {.size = sizeof one};
    assert_int_equal(cuvette_frame_solid_counters(frame, 4, &one, &why), CUVETTE_BAD_INPUT);
    float rgb[3];
    assert_int_equal(cuvette_frame_rgb(frame, 39, 29, 41, 30, rgb, 0, &why), CUVETTE_BAD_INPUT);
    assert_int_equal(cuvette_frame_rgb(frame, 3, 3, 3, 4, rgb, 0, &why), CUVETTE_BAD_INPUT);
    fine(cuvette_frame_rgb(frame, 39, 29, 40, 30, rgb, 0, &why), &why);
    cuvette_request request = CUVETTE_REQUEST;
    request.rgb = rgb, request.width = 1, request.height = 1;
    /* The image is larger. */
    assert_int_equal(cuvette_engine_render(engine, s, &request, NULL, &why), CUVETTE_BAD_INPUT);
    request = CUVETTE_REQUEST;
    request.preview = 1;
    assert_int_equal(cuvette_engine_render(engine, s, &request, NULL, &why), CUVETTE_BAD_INPUT);
    cuvette_frame_destroy(frame);
    cuvette_scene_destroy(s);
    cuvette_engine_destroy(engine);
}

enum { WIDTH = 162, HEIGHT = 121 }; /* not multiples of tile and preview sizes */

typedef struct audience {
    pthread_t thread;
    cuvette_engine *engine;
    cuvette_scene *scene;
    int previews, tiles, calls, covered[WIDTH * HEIGHT];
    double share, first;
    double stop_at; /* share at which progress returns false */
    float rgb[3 * WIDTH * HEIGHT], seen[3 * WIDTH * HEIGHT];
} audience;

static bool watch_progress(void *context, double share)
{
    audience *a = context;
    assert_true(pthread_equal(pthread_self(), a->thread));
    assert_true(share >= a->share && share <= 1.0);
    if (a->calls++ == 0)
        a->first = share;
    a->share = share;
    return share < a->stop_at;
}

static void watch_tiles(void *context, const cuvette_tile *tile)
{
    audience *a = context;
    assert_true(pthread_equal(pthread_self(), a->thread));
    assert_true(tile->x0 >= 0 && tile->x0 < tile->x1 && tile->x1 <= WIDTH && tile->y0 >= 0 && tile->y0 < tile->y1 &&
                tile->y1 <= HEIGHT);
    *(tile->coarse == 1 ? &a->tiles : &a->previews) += 1;
    assert_true(tile->coarse == 1 || (tile->coarse == 8 && a->tiles == 0));
    for (int y = tile->y0; y < tile->y1; y++)
        for (int x = tile->x0; x < tile->x1; x++) {
            a->covered[y * WIDTH + x] += tile->coarse == 1;
            for (int k = 0; k < 3; k++)
                a->seen[3 * (y * WIDTH + x) + k] = a->rgb[3 * (y * WIDTH + x) + k];
        }
}

static cuvette_request request_for(audience *a)
{
    cuvette_request request = CUVETTE_REQUEST;
    request.width = WIDTH, request.height = HEIGHT, request.rgb = a->rgb;
    request.preview = 8;
    request.progress = watch_progress, request.tile = watch_tiles, request.context = a;
    a->thread = pthread_self();
    return request;
}

/* With every schedule, and with the shares of random paths and of a spectrum too. */
static void each_tile_is_reported_once_and_final(void **state)
{
    (void)state;
    static const char *const how[] = {"dynamic", "tiles", "rows", "columns", "path", "spectral"};
    cuvette_diagnostic why;
    cuvette_engine *engine = make_engine();
    for (size_t i = 0; i < COUNT(how); i++) {
        cuvette_scene *s = rod(WIDTH, i < 4 ? 3 : 1, 3);
        turn(s, "render.height", "121");
        if (i < 4)
            turn(s, "render.schedule", how[i]);
        else
            turn(s, i == 4 ? "render.integrator" : "render.spectrum", how[i]);
        if (i == 4)
            turn(s, "render.paths", "16");
        audience *a = calloc(1, sizeof *a);
        a->stop_at = 2.0;
        const cuvette_request request = request_for(a);
        cuvette_frame *frame;
        fine(cuvette_engine_render(engine, s, &request, &frame, &why), &why);
        assert_true(a->first == 0.0 && a->share == 1.0 && a->calls >= 2 && a->previews == 1 && a->tiles >= 3);
        for (int k = 0; k < WIDTH * HEIGHT; k++)
            assert_int_equal(a->covered[k], 1);
        float *whole = calloc(3 * WIDTH * HEIGHT, sizeof *whole);
        fine(cuvette_frame_rgb(frame, 0, 0, WIDTH, HEIGHT, whole, 0, &why), &why);
        assert_memory_equal(a->seen, whole, sizeof a->seen);
        assert_true(cuvette_frame_hash(frame) == hash_of(engine, s));
        cuvette_statistics statistics = {.size = sizeof statistics};
        fine(cuvette_frame_statistics(frame, &statistics, &why), &why);
        assert_true(statistics.preview_s > 0.0 && isnan(statistics.noise_rms) == (i != 4));
        free(whole);
        free(a);
        cuvette_frame_destroy(frame);
        cuvette_scene_destroy(s);
    }
    cuvette_engine_destroy(engine);
}

static void progress_can_cancel_before_the_first_ray(void **state)
{
    (void)state;
    cuvette_diagnostic why;
    cuvette_engine *engine = make_engine();
    cuvette_scene *s = rod(WIDTH, 3, 1);
    turn(s, "render.height", "121");
    audience *a = calloc(1, sizeof *a); /* stops at 0 */
    const cuvette_request request = request_for(a);
    cuvette_frame *frame = (cuvette_frame *)a;
    assert_int_equal(cuvette_engine_render(engine, s, &request, &frame, &why), CUVETTE_CANCELLED);
    assert_true(!frame && a->calls == 1 && a->tiles == 0 && a->previews == 0);
    free(a);
    cuvette_scene_destroy(s);
    cuvette_engine_destroy(engine);
}

typedef struct other_thread {
    cuvette_engine *engine;
    atomic_bool begun;
} other_thread;

static void *cancel_soon(void *context)
{
    other_thread *o = context;
    while (!atomic_load(&o->begun))
        usleep(1000);
    cuvette_engine_cancel(o->engine);
    return NULL;
}

static bool say_begun(void *context, double share)
{
    (void)share;
    atomic_store(&((other_thread *)context)->begun, true);
    return true;
}

static void another_thread_cancels_and_the_next_frame_is_complete(void **state)
{
    (void)state;
    cuvette_diagnostic why;
    cuvette_engine *engine = make_engine();
    cuvette_scene *large = rod(4000, 8, 2), *small = rod(80, 4, 2);
    const uint64_t hash = hash_of(engine, small);
    other_thread other = {.engine = engine};
    pthread_t thread;
    cuvette_frame *frame;
    cuvette_request request = CUVETTE_REQUEST;
    request.progress = say_begun, request.context = &other;
    assert_int_equal(pthread_create(&thread, NULL, cancel_soon, &other), 0);
    assert_int_equal(cuvette_engine_render(engine, large, &request, &frame, &why), CUVETTE_CANCELLED);
    pthread_join(thread, NULL);
    cuvette_counters counters = {.size = sizeof counters};
    fine(cuvette_frame_counters(frame, &counters, &why), &why);
    assert_true(counters.camera < 4000 * 3000);
    cuvette_frame_destroy(frame);
    cuvette_engine_cancel(engine); /* without a render: no effect */
    assert_true(hash_of(engine, small) == hash);
    cuvette_scene_destroy(large);
    cuvette_scene_destroy(small);
    cuvette_engine_destroy(engine);
}

static bool try_while_busy(void *context, double share)
{
    audience *a = context;
    cuvette_diagnostic why;
    int64_t depth;
    if (share == 0.0) {
        assert_int_equal(cuvette_engine_render(a->engine, a->scene, NULL, NULL, &why), CUVETTE_BUSY);
        assert_int_equal(cuvette_scene_set(a->scene, "render.depth", "1", &why), CUVETTE_BUSY);
        assert_int_equal(cuvette_scene_remove(a->scene, "rod", &why), CUVETTE_BUSY);
        fine(cuvette_scene_get_int(a->scene, "render.depth", &depth, &why), &why);
        cuvette_engine *second = make_engine(); /* another engine may render the same scene at the same time */
        a->share = (double)(hash_of(second, a->scene) % 1000000);
        cuvette_engine_destroy(second);
        a->calls++;
    }
    return true;
}

static void objects_in_use_return_busy(void **state)
{
    (void)state;
    cuvette_diagnostic why;
    audience *a = calloc(1, sizeof *a);
    a->engine = make_engine();
    a->scene = rod(80, 3, 1);
    cuvette_request request = CUVETTE_REQUEST;
    request.progress = try_while_busy, request.context = a;
    cuvette_frame *frame;
    fine(cuvette_engine_render(a->engine, a->scene, &request, &frame, &why), &why);
    assert_true(a->calls >= 1 && a->share == (double)(cuvette_frame_hash(frame) % 1000000));
    turn(a->scene, "render.depth", "1");
    cuvette_frame_destroy(frame);
    cuvette_scene_destroy(a->scene);
    cuvette_engine_destroy(a->engine);
    free(a);
}

typedef struct worker {
    int depth;
    uint64_t hash;
} worker;

static void *render_ten(void *context)
{
    worker *w = context;
    cuvette_engine *engine = make_engine();
    for (int i = 0; i < 10; i++) {
        cuvette_scene *s = rod(120, w->depth, 2);
        const uint64_t hash = hash_of(engine, s);
        w->hash = i == 0 || hash == w->hash ? hash : 0;
        cuvette_scene_destroy(s);
    }
    cuvette_engine_destroy(engine);
    return NULL;
}

static void two_engines_do_not_affect_each_other(void **state)
{
    (void)state;
    worker both[2] = {{2, 0}, {5, 0}};
    pthread_t threads[2];
    for (int i = 0; i < 2; i++)
        assert_int_equal(pthread_create(&threads[i], NULL, render_ten, &both[i]), 0);
    for (int i = 0; i < 2; i++)
        pthread_join(threads[i], NULL);
    for (int i = 0; i < 2; i++) {
        worker alone = {both[i].depth, 0};
        render_ten(&alone);
        assert_true(alone.hash != 0 && alone.hash == both[i].hash);
    }
}

/* A scene with meshes that are not loaded yet, rendered, checked and written by both. */
static void *render_shared(void *context)
{
    const cuvette_scene *s = context;
    char text[4096];
    cuvette_diagnostic why;
    cuvette_engine *engine = make_engine();
    fine(cuvette_scene_check(s, &why), &why);
    const uint64_t hash = hash_of(engine, s);
    fine(cuvette_scene_write_text(s, text, sizeof text, NULL, &why), &why);
    cuvette_engine_destroy(engine);
    return (void *)(uintptr_t)hash;
}

static void two_engines_may_render_one_scene_with_unloaded_meshes(void **state)
{
    (void)state;
    static const char text[] = "render: {width: 40, height: 30}\ncamera: {position: [0, 0, -3], target: [0, 0, 0]}\n"
                               "meshes: {ball: {generate: icosphere, level: 5}}\n"
                               "solids: {one: {shape: mesh, mesh: ball, transparency: 1, ior: 1.5}}\n";
    for (int i = 0; i < 5; i++) {
        cuvette_diagnostic why;
        cuvette_scene *s;
        pthread_t threads[2];
        void *hash[2];
        fine(cuvette_scene_read_text("test.yaml", text, sizeof text - 1, &s, &why), &why);
        for (int k = 0; k < 2; k++)
            assert_int_equal(pthread_create(&threads[k], NULL, render_shared, s), 0);
        for (int k = 0; k < 2; k++)
            assert_int_equal(pthread_join(threads[k], &hash[k]), 0);
        assert_true(hash[0] == hash[1] && hash[0]);
        cuvette_scene_destroy(s);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_library_has_the_headers_version),
        cmocka_unit_test(the_film_equals_the_programs_film),
        cmocka_unit_test(an_image_file_carries_its_scene),
        cmocka_unit_test(impossible_strides_are_refused),
        cmocka_unit_test(a_child_of_fork_renders_with_its_parents_engine),
        cmocka_unit_test(counters_and_pixels_equal_the_renderers),
        cmocka_unit_test(a_shorter_struct_is_filled_up_to_its_size),
        cmocka_unit_test(each_tile_is_reported_once_and_final),
        cmocka_unit_test(progress_can_cancel_before_the_first_ray),
        cmocka_unit_test(another_thread_cancels_and_the_next_frame_is_complete),
        cmocka_unit_test(objects_in_use_return_busy),
        cmocka_unit_test(two_engines_do_not_affect_each_other),
        cmocka_unit_test(two_engines_may_render_one_scene_with_unloaded_meshes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
