/* Tests of base/cancel.h: the rules of tokens; and every long kind of work, cancelled at one question after another,
 * ends with STATUS_INTERRUPTED and nothing, or is complete: never with a part of its result. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "base/cancel.h"
#include "base/file.h"
#include "base/hash.h"
#include "base/worker_pool.h"
#include "geometry/hierarchy/layout.h"
#include "geometry/mesh/mesh_generators.h"
#include "image/compare.h"
#include "image/texture.h"
#include "job/job.h"
#include "lint/lint.h"
#include "realism/realism.h"
#include "render/inspect/fan.h"
#include "render/inspect/probe.h"
#include "scene/model/scene.h"
#include "whole.h"

#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* --- the rules --- */

static bool say(void *context)
{
    return *(bool *)context;
}

static void tokens_nest_and_shields_hide_them(void **state)
{
    (void)state;
    bool outside = false, inside = false;
    cancel_token first = {.ask = say, .context = &outside}, second = {.ask = say, .context = &inside}, shield;
    assert_false(cancel_asked());
    cancel_begin(&first);
    cancel_begin(&second);
    assert_false(cancel_asked());
    outside = true;
    assert_true(cancel_asked());
    outside = false;
    assert_true(cancel_asked()); /* it stays so */
    cancel_shield(&shield);
    assert_false(cancel_asked());
    assert_true(cancel_hurries());
    cancel_token below = {.ask = say, .context = &inside};
    cancel_begin(&below);
    assert_false(cancel_asked());
    inside = true;
    assert_true(cancel_asked());
    cancel_end(&below);
    cancel_end(&shield);
    assert_false(cancel_hurries());
    diagnostic why = {0};
    assert_int_equal(cancel_check(&why), STATUS_INTERRUPTED);
    assert_string_equal(why.what, "interrupted");
    cancel_end(&second);
    cancel_end(&first);
    assert_int_equal(cancel_check(&why), STATUS_OK);
}

static void *set_token(void *token)
{
    assert_false(cancel_asked()); /* another thread begins without one */
    cancel_set(token);
    return NULL;
}

static void any_thread_can_set_a_token(void **state)
{
    (void)state;
    cancel_token t = {.ask = NULL};
    pthread_t other;
    cancel_begin(&t);
    assert_false(cancel_asked());
    assert_int_equal(pthread_create(&other, NULL, set_token, &t), 0);
    pthread_join(other, NULL);
    assert_true(cancel_asked());
    cancel_end(&t);
}

static void note(void *context, size_t index, int member)
{
    (void)member;
    ((bool *)context)[index] = cancel_asked();
}

static void members_of_a_team_have_the_token_of_their_caller(void **state)
{
    (void)state;
    enum { TASKS = 64 };
    bool asked[TASKS];
    cancel_token t = {.ask = NULL};
    thread_team *team = thread_team_create(4);
    for (int set = 0; set < 2; set++) {
        cancel_begin(&t);
        if (set)
            cancel_set(&t);
        thread_team_run(team, note, asked, TASKS);
        for (int i = 0; i < TASKS; i++)
            assert_int_equal(asked[i], set);
        cancel_end(&t);
    }
    thread_team_run(team, note, asked, TASKS); /* the token has ended, its members forget it */
    for (int i = 0; i < TASKS; i++)
        assert_false(asked[i]);
    thread_team_destroy(team);
}

/* --- all kinds of work --- */

/* Does the work, and describes its whole result by a number. */
typedef status work(const void *how, uint64_t *result);

typedef struct countdown {
    long left;
} countdown;

static bool count_down(void *context)
{
    countdown *c = context;
    return --c->left < 0;
}

static status do_until(work *act, const void *how, long questions, uint64_t *result, bool *asked)
{
    countdown c = {questions};
    cancel_token t = {.ask = count_down, .context = &c};
    cancel_begin(&t);
    const status code = act(how, result);
    cancel_end(&t);
    *asked = c.left < 0;
    return code;
}

static void sweep(const char *name, work *act, const void *how)
{
    uint64_t right = 0, found;
    long stopped = 0;
    bool asked = true;
    assert_int_equal(act(how, &right), STATUS_OK);
    for (long questions = 0; asked; questions += 1 + questions / 6) {
        found = 0;
        const status code = do_until(act, how, questions, &found, &asked);
        if (code == STATUS_OK && found == right)
            continue; /* the last question came after the result */
        if (code != STATUS_INTERRUPTED)
            fail_msg("%s, cancelled at question %ld: status %d, result %llx instead of %llx", name, questions,
                     (int)code, (unsigned long long)found, (unsigned long long)right);
        stopped++;
    }
    if (stopped == 0)
        fail_msg("%s never asks", name);
    assert_int_equal(act(how, &found), STATUS_OK);
    assert_true(found == right);
}

static uint64_t hash_mesh(const mesh *m)
{
    uint64_t h = hash_numbers(HASH_START, m->vertices, 3 * m->vertex_count, sizeof(double));
    h = hash_numbers(h, m->triangles, 3 * m->triangle_count, sizeof(uint32_t));
    if (m->normals)
        h = hash_numbers(h, m->normals, 3 * m->vertex_count, sizeof(double));
    return h + (uint64_t)m->closed + hash_numbers(h, &m->bounds, 6, sizeof(double));
}

/* how: the mesh in a scene. */
static status load_mesh(const void *how, uint64_t *result)
{
    scene *s = NULL;
    status code = scene_read_text("cancel", how, strlen(how), &s, NULL);
    assert_int_equal(code, STATUS_OK);
    code = scene_load(s, NULL);
    if (code == STATUS_OK)
        *result = hash_mesh(s->meshes[0].data);
    scene_destroy(s);
    return code;
}

static void meshes_are_whole_or_not_there(void **state)
{
    (void)state;
    static const char *const made[] = {
        "meshes: {m: {generate: sparse, count: 60000}}",
        "meshes: {m: {generate: dense, count: 30000}}",
        "meshes: {m: {generate: sphere, count: 50000}}",
        "meshes: {m: {generate: icosphere, level: 5}}",
        "meshes: {m: {generate: torus, around: 200, tube: 100}}",
        "meshes: {m: {generate: lathe, around: 9000}}",
        "meshes: {m: {generate: terrain, around: 200, tube: 150, depth: 1}}",
    };
    for (size_t i = 0; i < sizeof made / sizeof *made; i++)
        sweep(made[i], load_mesh, made[i]);
}

typedef struct building {
    const mesh *m;
    hierarchy_kind kind;
    int threads;
} building;

static status build(const void *how, uint64_t *result)
{
    const building *b = how;
    hierarchy *h = NULL;
    TRY(hierarchy_build(b->m, b->kind, b->threads, &h, NULL));
    const hierarchy_report r = hierarchy_describe(h);
    const int64_t counts[] = {(int64_t)r.nodes, (int64_t)r.leaves, r.depth};
    const size_t block = h->single ? sizeof(block_single) : sizeof(block_double);
    *result = hash_bytes(hash_words(HASH_START, counts, 3), h->blocks, h->block_count * block);
    if (h->nodes)
        *result = hash_bytes(*result, h->nodes, h->node_count * sizeof *h->nodes);
    if (h->spheres)
        *result = hash_bytes(*result, h->spheres, h->node_count * sizeof *h->spheres);
    hierarchy_destroy(h);
    return STATUS_OK;
}

static void hierarchies_are_whole_or_not_there(void **state)
{
    (void)state;
    mesh *m = NULL;
    assert_int_equal(generate_dense_soup(60000, &m, NULL), STATUS_OK);
    for (int kind = HIERARCHY_NONE; kind <= HIERARCHY_BVH; kind++)
        for (int threads = is_whole() ? 1 : 3; threads <= 3; threads += 2) {
            char name[64];
            snprintf(name, sizeof name, "hierarchy %d, %d threads", kind, threads);
            sweep(name, build, &(building){m, (hierarchy_kind)kind, threads});
        }
    mesh_release(m);
}

static image *make_image(void)
{
    image *img = NULL;
    assert_int_equal(image_create(160, 120, &img, NULL), STATUS_OK);
    for (size_t i = 0; i < 3 * 160 * 120; i++)
        img->pixel[i] = (float)(i * 2654435761u % 1000) / 1000.0f;
    return img;
}

typedef struct coding {
    const image *img;
    image_format format;
    const char *path;
} coding;

static status encode(const void *how, uint64_t *result)
{
    const coding *c = how;
    unsigned char *bytes = NULL;
    size_t size = 0;
    const status code = image_encode(c->img, c->format, 8, false, &bytes, &size, NULL);
    if (code == STATUS_OK)
        *result = hash_bytes(HASH_START, bytes, size);
    free(bytes);
    return code;
}

static status decode(const void *how, uint64_t *result)
{
    image *img = NULL;
    TRY(image_read(((const coding *)how)->path, &img, NULL, NULL));
    *result = hash_numbers(HASH_START, img->pixel, 3 * (size_t)img->width * (size_t)img->height, sizeof(float));
    image_destroy(img);
    return STATUS_OK;
}

static status write_file(const void *how, uint64_t *result)
{
    const coding *c = how;
    const status code = image_write(c->img, c->path, 8, NULL);
    *result = 1;
    if (code != STATUS_OK)
        assert_int_not_equal(access(c->path, F_OK), 0);
    unlink(c->path);
    return code;
}

static status compare(const void *how, uint64_t *result)
{
    const coding *c = how;
    image *map = NULL;
    image_comparison found;
    TRY(image_compare(c->img, c->img, &found, NULL));
    TRY(image_compare_map(c->img, c->img, &map, NULL));
    image_destroy(map);
    *result = hash_numbers(HASH_START, (double[]){found.mse, found.ssim, found.flip}, 3, sizeof(double));
    return STATUS_OK;
}

static status texturize(const void *how, uint64_t *result)
{
    texture *t = NULL;
    TRY(texture_create(((const coding *)how)->img, TEXTURE_REPEAT, TEXTURE_REPEAT, TEXTURE_TRILINEAR, &t, NULL));
    *result = texture_hash(t, HASH_START);
    texture_release(t);
    return STATUS_OK;
}

static void images_are_whole_or_not_there(void **state)
{
    (void)state;
    static const struct {
        const char *name;
        image_format format;
    } kinds[] = {
        {"cancel.png", IMAGE_PNG}, {"cancel.jpg", IMAGE_JPEG}, {"cancel.pfm", IMAGE_PFM}, {"cancel.exr", IMAGE_EXR}};
    image *img = make_image();
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++) {
        char path[64];
        snprintf(path, sizeof path, "/tmp/%ld-%s", (long)getpid(), kinds[i].name);
        const coding c = {img, kinds[i].format, path};
        sweep("encoding", encode, &c);
        sweep("writing", write_file, &c);
        assert_int_equal(image_write(img, path, 8, NULL), STATUS_OK);
        sweep("decoding", decode, &c);
        unlink(path);
    }
    sweep("comparison", compare, &(coding){.img = img});
    sweep("texture", texturize, &(coding){.img = img});
    image_destroy(img);
}

static status follow_fan(const void *how, uint64_t *result)
{
    probe *p = NULL;
    fan f = {0};
    const fan_rule rule = {.from = {-3, 1.5, 0}, .to = {3, 1.5, 0}, .rays = 200, .width = 1.6};
    status code = probe_create(how, isa_best(), &p, NULL);
    THEN(code, fan_trace(p, &rule, &f, NULL));
    *result = (uint64_t)f.node_count + hash_numbers(HASH_START, &f.focus, 3, sizeof(double));
    fan_release(&f);
    probe_destroy(p);
    return code;
}

static status trace_pixel(const void *how, uint64_t *result)
{
    probe *p = NULL;
    ray_tree tree = {0};
    status code = probe_create(how, isa_best(), &p, NULL);
    THEN(code, probe_pixel(p, 400, 300, &tree, NULL));
    *result = tree.count + hash_numbers(HASH_START, tree.radiance, 3, sizeof(double));
    ray_tree_release(&tree);
    probe_destroy(p);
    return code;
}

static status measure(const void *how, uint64_t *result)
{
    realism_report report;
    TRY(realism_measure(how, isa_best(), &report, NULL));
    *result = HASH_START;
    for (int i = 0; i < report.count; i++)
        *result = hash_numbers(*result, &report.value[i].measured, 1, sizeof(double));
    return STATUS_OK;
}

static void count_note(void *context, const scene_note *one)
{
    (void)one;
    ++*(uint64_t *)context;
}

static status look(const void *how, uint64_t *result)
{
    *result = 0;
    return lint_scene(how, isa_best(), &(note_sink){count_note, result}, NULL);
}

static void traced_rays_and_notes_are_whole_or_not_there(void **state)
{
    (void)state;
    scene *s = NULL;
    assert_int_equal(scene_read("experiments/scenes/rod.yaml", &s, NULL), STATUS_OK);
    assert_int_equal(scene_load(s, NULL), STATUS_OK);
    sweep("fan", follow_fan, s);
    sweep("tree", trace_pixel, s);
    sweep("realism", measure, s);
    sweep("lint", look, s);
    scene_destroy(s);
}

/* Setting the token from another thread ends the loading of a mesh that takes minutes. */
static void *cancel_soon(void *of)
{
    usleep(50000);
    cancel_set(of);
    return NULL;
}

static void a_job_is_cancelled_while_it_loads(void **state)
{
    (void)state;
    static const char text[] = "meshes: {m: {generate: terrain, around: 5000, tube: 5000}}\n";
    job *j = NULL;
    scene *s = NULL;
    pthread_t other;
    assert_int_equal(job_create(&(job_settings){.level = NULL}, &j, NULL), STATUS_OK);
    assert_int_equal(scene_read_text("cancel", text, sizeof text - 1, &s, NULL), STATUS_OK);
    cancel_token token = {.ask = NULL};
    cancel_begin(&token);
    assert_int_equal(pthread_create(&other, NULL, cancel_soon, &token), 0);
    assert_int_equal(job_load(j, s, NULL, NULL), STATUS_INTERRUPTED);
    assert_null(s->meshes[0].data);
    pthread_join(other, NULL);
    cancel_clear(&token);
    assert_false(cancel_asked());
    cancel_end(&token);
    scene_destroy(s);
    job_destroy(j);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(tokens_nest_and_shields_hide_them),
        cmocka_unit_test(any_thread_can_set_a_token),
        cmocka_unit_test(members_of_a_team_have_the_token_of_their_caller),
        cmocka_unit_test(meshes_are_whole_or_not_there),
        cmocka_unit_test(hierarchies_are_whole_or_not_there),
        cmocka_unit_test(images_are_whole_or_not_there),
        cmocka_unit_test(traced_rays_and_notes_are_whole_or_not_there),
        cmocka_unit_test(a_job_is_cancelled_while_it_loads),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
