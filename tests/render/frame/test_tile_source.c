/* Tests of frames whose tiles come from a source: put together, they are the film, the variance and the counts of the
 * whole frame, whatever the order, the size of the tiles and the worker that gets them. */
#include <math.h>
#include <pthread.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <cmocka.h>

#include "base/random.h"
#include "render/frame/renderer.h"
#include "render_fixture.h"

/* Hands out the tiles of an image in a random order and puts them together. */
typedef struct hand_out {
    pthread_mutex_t lock;
    tiled_frame whole;
    int64_t *order, given, taken, limit; /* limit: the number of tiles after which done refuses */
} hand_out;

static bool next(void *context, int worker, image_tile *out)
{
    hand_out *h = context;
    (void)worker;
    pthread_mutex_lock(&h->lock);
    const bool more = h->given < h->limit && h->given < h->whole.places.tile_count &&
                      schedule_tile(&h->whole.places, h->order[h->given], out);
    h->given += more;
    pthread_mutex_unlock(&h->lock);
    return more;
}

static void done(void *context, const image_tile *rect, const film *traced, const double *variance)
{
    hand_out *h = context;
    pthread_mutex_lock(&h->lock);
    assert_int_equal(traced->replicates, 1);
    const schedule *places = &h->whole.places;
    const int64_t tile = rect->y0 / places->tile * places->tiles_across + rect->x0 / places->tile;
    const size_t sums = 3 * (size_t)(rect->x1 - rect->x0) * (size_t)(rect->y1 - rect->y0);
    assert_int_equal(tiled_frame_values(&h->whole, tile), variance ? 2 * sums : sums);
    int64_t *message = malloc(2 * sums * sizeof *message);
    assert_non_null(message);
    memcpy(message, traced->sum, sums * sizeof *message);
    if (variance)
        memcpy(message + sums, variance, sums * sizeof *variance);
    tiled_frame_store(&h->whole, tile, message);
    free(message);
    h->taken++;
    pthread_mutex_unlock(&h->lock);
}

static hand_out hand_out_of(const scene *s, int tile)
{
    hand_out h = {.limit = INT64_MAX};
    diagnostic why = {0};
    worked(tiled_frame_begin(s, tile, &h.whole, &why), &why);
    h.order = malloc((size_t)h.whole.places.tile_count * sizeof *h.order);
    assert_non_null(h.order);
    for (int64_t i = 0; i < h.whole.places.tile_count; i++) { /* Fisher and Yates, inside out */
        const int64_t k = random_at(7, (uint32_t)i, 0, 0, 0).word[0] % (i + 1);
        h.order[i] = h.order[k];
        h.order[k] = i;
    }
    pthread_mutex_init(&h.lock, NULL);
    return h;
}

static void release(hand_out *h)
{
    pthread_mutex_destroy(&h->lock);
    tiled_frame_release(&h->whole);
    free(h->order);
}

static void expect_the_whole_frame(const char *path, const char *assignments, int tile)
{
    scene *s = NULL;
    diagnostic why = {0};
    worked(scene_read(path, &s, &why), &why);
    set_all(s, assignments);
    worked(scene_load(s, &why), &why);
    render_result *expected = render(s);
    hand_out h = hand_out_of(s, tile);
    const tile_source source = {.side = tile, .next = next, .done = done, .context = &h};
    render_result *result = render_at(s, isa_best(), &(render_options){.source = &source});
    assert_null(result->img);
    assert_int_equal(h.taken, h.whole.places.tile_count);
    if (film_hash(h.whole.img) != film_hash(expected->img))
        fail_msg("%s %s: the film of tiles of %d x %d pixels differs", path, assignments, tile, tile);
    if (memcmp(&result->counters, &expected->counters, sizeof result->counters) != 0)
        fail_msg("%s %s: the counts of tiles of %d x %d pixels differ", path, assignments, tile, tile);
    if (expected->variance)
        assert_memory_equal(h.whole.variance, expected->variance,
                            3 * (size_t)(s->render.width * s->render.height) * sizeof(double));
    release(&h);
    render_result_destroy(result);
    render_result_destroy(expected);
    scene_destroy(s);
}

#define SMALL "render.width=83 render.height=61 render.threads=3 "

static void tiles_of_all_integrators_are_the_whole_frame(void **state)
{
    (void)state;
    static const struct {
        const char *file, *assignments;
    } cases[] = {
        {"rod", ""},
        {"rod", "render.samples=4 render.depth=3"},
        {"rod", "render.spectrum=spectral render.wavelengths=8"},
        {"rod", "render.polarisation=on"},
        {"rod", "render.integrator=path render.paths=16"},
        {"rod", "render.integrator=path render.paths=16 render.sampler=philox render.spectrum=spectral"},
        {"rod", "render.integrator=aov"},
        {"rod", "render.integrator=raycast"},
        {"rod", "render.integrator=zbuffer"},
        {"models", ""},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        char path[64], assignments[256];
        snprintf(path, sizeof path, "experiments/scenes/%s.yaml", cases[i].file);
        snprintf(assignments, sizeof assignments, SMALL "%s", cases[i].assignments);
        static const int tiles[] = {1, 7, 16, 64, 200};
        for (size_t k = 0; k < sizeof tiles / sizeof tiles[0]; k++)
            expect_the_whole_frame(path, assignments, tiles[k]);
    }
}

/* A row of the widest image is a tile, so is a column of the highest one. */
static void places_in_a_tile_are_exact_in_the_largest_images(void **state)
{
    (void)state;
    static const struct {
        int width, x0, y0, x1, y1;
    } tiles[] = {{65536, 65472, 4032, 65536, 4096}, {65536, 0, 0, 65536, 1}, {1, 0, 0, 1, 65536},
                 {7680, 7664, 4304, 7680, 4320},    {3, 1, 100, 3, 30000},   {65535, 65534, 0, 65535, 4096}};
    for (size_t i = 0; i < sizeof tiles / sizeof tiles[0]; i++) {
        const int x0 = tiles[i].x0, y0 = tiles[i].y0, x1 = tiles[i].x1, y1 = tiles[i].y1;
        film *f = NULL;
        diagnostic why = {0};
        worked(film_create(x1 - x0, y1 - y0, 1, FILM_RGB, &f, &why), &why);
        film_begin_tile(f, tiles[i].width, x0, y0, x1, y1, 1);
        int64_t place = 0;
        for (int y = y0; y < y1; y++)
            for (int x = x0; x < x1; x++)
                assert_int_equal(film_pixel_index(f, (int64_t)y * tiles[i].width + x), place++);
        film_destroy(f);
    }
}

static void a_frame_ends_when_the_source_has_no_more(void **state)
{
    (void)state;
    scene *s = rod_scene("render.width=64 render.height=48 render.threads=1");
    hand_out h = hand_out_of(s, 16);
    h.limit = 5;
    const tile_source source = {.side = 16, .next = next, .done = done, .context = &h};
    render_result *result = render_at(s, isa_best(), &(render_options){.source = &source});
    assert_int_equal(h.taken, 5);
    assert_int_equal(result->workers[0].tiles, 5);
    assert_int_equal(result->counters.camera, CUVETTE_COUNTERS ? 5 * 16 * 16 : 0);
    release(&h);
    render_result_destroy(result);
    scene_destroy(s);
}

/* Memory is that of the tiles, not of the image. */
static void the_film_of_a_source_is_as_small_as_its_tiles(void **state)
{
    (void)state;
    scene *s = rod_scene("render.width=16384 render.height=16384 render.threads=2");
    const tile_source source = {.side = 32};
    assert_int_equal(renderer_result_bytes(s, &(render_options){.source = &source}), 2 * 32 * 32 * 24);
    assert_true(renderer_result_bytes(s, NULL) >= UINT64_C(16384) * 16384 * 24);
    const render_options maps = {.pixel_rays = true, .pixel_time = true, .pixel_cut = true}; /* a double a pixel */
    assert_int_equal(renderer_result_bytes(s, &maps) - renderer_result_bytes(s, NULL), UINT64_C(16384) * 16384 * 24);
    scene_destroy(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(tiles_of_all_integrators_are_the_whole_frame),
        cmocka_unit_test(places_in_a_tile_are_exact_in_the_largest_images),
        cmocka_unit_test(a_frame_ends_when_the_source_has_no_more),
        cmocka_unit_test(the_film_of_a_source_is_as_small_as_its_tiles),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
