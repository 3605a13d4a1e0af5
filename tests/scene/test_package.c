/* Tests of scenes as packages, complete and damaged. Run from the repository root. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "base/hash.h"
#include "geometry/hierarchy/layout.h"
#include "package_fixture.h"
#include "random_stream.h"
#include "scene/model/face_materials.h"

/* Scenes as packages: what is unpacked gives the same film, counters and mesh report without a file and
 * without building a hierarchy. Run from the repository root. */

#define SCENES "experiments/scenes/"

static void load(scene *s)
{
    diagnostic why = {0};
    worked(scene_load(s, &why), &why);
    worked(scene_build_hierarchies(s, &why), &why);
}

/* Film, counters and mesh report, whose build_s is a measured time: a hierarchy that was built again has another. */
static void assert_same_frames(const render_result *a, const render_result *b)
{
    assert_true(film_hash(a->img) == film_hash(b->img));
    assert_memory_equal(&a->counters, &b->counters, sizeof a->counters);
    assert_memory_equal(&a->meshes, &b->meshes, sizeof a->meshes);
}

/* Packs a loaded scene, destroys it, and unpacks and renders in a folder from which none of its files can be found. */
static void assert_survives(scene *s)
{
    char here[1024];
    assert_non_null(getcwd(here, sizeof here));
    const package p = packed(s);
    render_result *before = render(s);
    scene_destroy(s);
    assert_int_equal(chdir(folder), 0);
    scene *again = unpacked(&p);
    load(again);
    render_result *after = render(again);
    assert_same_frames(before, after);
    const package second = packed(again);
    assert_int_equal(chdir(here), 0);
    assert_int_equal(p.size, second.size);
    assert_memory_equal(p.at, second.at, p.size);
    scene_destroy(again);
    render_result_destroy(before);
    render_result_destroy(after);
    free(p.at);
    free(second.at);
}

static scene *committed_scene(const char *name)
{
    char path[300];
    scene *s = NULL;
    diagnostic why = {0};
    snprintf(path, sizeof path, SCENES "%s", name);
    worked(scene_read(path, &s, &why), &why);
    set_all(s, "render.width=32 render.height=24 render.samples=1 render.wavelengths=4 render.paths=2 "
               "render.photons=2000");
    return s;
}

static void every_scene_of_the_project_survives(void **state)
{
    (void)state;
    DIR *entries = opendir(SCENES);
    assert_non_null(entries);
    size_t count = 0;
    for (struct dirent *entry = readdir(entries); entry; entry = readdir(entries)) {
        if (!strstr(entry->d_name, ".yaml"))
            continue;
        scene *s = committed_scene(entry->d_name);
        load(s);
        assert_survives(s);
        count++;
    }
    closedir(entries);
    assert_true(count >= 8);
}

static void other_integrators_and_hierarchies_survive(void **state)
{
    (void)state;
    static const char *const settings[] = {"render.accel=none",     "render.accel=sphere",
                                           "render.accel=octant",   "render.integrator=path",
                                           "render.integrator=aov", "render.integrator=zbuffer"};
    for (size_t i = 0; i < sizeof settings / sizeof *settings; i++) {
        scene *s = committed_scene("models.yaml");
        set_all(s, settings[i]);
        set_all(s, "ball.level=3 torus.around=20 torus.tube=10");
        load(s);
        assert_survives(s);
    }
}

static const hierarchy *own(const mesh *m, int kind)
{
    const hierarchy *h;
    diagnostic why = {0};
    worked(hierarchy_of_mesh(m, (hierarchy_kind)kind, 1, &h, &why), &why);
    return h;
}

static void assert_same_hierarchy(const hierarchy *a, const hierarchy *b)
{
    const size_t block = a->single ? sizeof(block_single) : sizeof(block_double);
    assert_true(a != b && a->kind == b->kind && a->single == b->single && a->block_count == b->block_count);
    assert_true(a->node_count == b->node_count && a->referred == b->referred && a->built_cost == b->built_cost);
    assert_memory_equal(a->blocks, b->blocks, a->block_count * block);
    if (a->nodes)
        assert_memory_equal(a->nodes, b->nodes, a->node_count * sizeof *a->nodes);
    if (a->spheres)
        assert_memory_equal(a->spheres, b->spheres, a->node_count * sizeof *a->spheres);
    assert_memory_equal(a->reach, b->reach, sizeof a->reach);
    const hierarchy_report r = hierarchy_describe(a), q = hierarchy_describe(b);
    assert_true(r.bytes == q.bytes && r.nodes == q.nodes && r.leaves == q.leaves && r.depth == q.depth &&
                r.build_s == q.build_s && r.threads == q.threads);
}

static void assert_same_mesh(const mesh *a, const mesh *b)
{
    assert_true(a->vertex_count == b->vertex_count && a->triangle_count == b->triangle_count);
    assert_memory_equal(a->vertices, b->vertices, a->vertex_count * sizeof *a->vertices);
    assert_memory_equal(a->triangles, b->triangles, a->triangle_count * sizeof *a->triangles);
    assert_true(!a->normals == !b->normals && !a->uvs == !b->uvs && !a->slots == !b->slots);
    if (a->normals)
        assert_memory_equal(a->normals, b->normals, a->vertex_count * sizeof *a->normals);
    if (a->uvs)
        assert_memory_equal(a->uvs, b->uvs, a->vertex_count * sizeof *a->uvs);
    if (a->slots)
        assert_memory_equal(a->slots, b->slots, a->triangle_count);
    assert_int_equal(a->slot_count, b->slot_count);
    for (int i = 0; i < a->slot_count; i++)
        assert_string_equal(a->slot_names[i] ? a->slot_names[i] : "-", b->slot_names[i] ? b->slot_names[i] : "-");
    assert_true(a->closed == b->closed && a->single == b->single);
    assert_memory_equal(&a->bounds, &b->bounds, sizeof a->bounds);
    assert_true(a->hole.from == b->hole.from && a->hole.to == b->hole.to && a->hole.triangle == b->hole.triangle &&
                a->hole.sharing == b->hole.sharing);
    for (int kind = HIERARCHY_NONE; kind <= HIERARCHY_BVH; kind++)
        assert_same_hierarchy(own(a, kind), own(b, kind));
}

static void all_that_is_loaded_is_the_same(void **state)
{
    (void)state;
    scene *s = whole_scene();
    diagnostic why = {0};
    worked(scene_limit(s, folder, 123456, &why), &why);
    /* a hierarchy that was refitted */
    mesh *toy = (mesh *)(uintptr_t)s->meshes[2].data;
    vec3 *moved = malloc(toy->vertex_count * sizeof *moved);
    for (size_t i = 0; i < toy->vertex_count; i++)
        moved[i] = vec3_scale(toy->vertices[i], 1.1);
    worked(mesh_move(toy, moved, NULL, &why), &why);
    free(moved);
    worked(hierarchy_update(toy, 100.0, 1, NULL, &why), &why);
    for (int kind = HIERARCHY_NONE; kind <= HIERARCHY_BVH; kind++)
        own(toy, kind);
    assert_true(s->meshes[0].data->single && !s->meshes[1].data->single);
    toy->slot_count = MESH_SLOTS_MAX; /* the most */
    face_material *masked = (face_material *)(uintptr_t)face_materials_at(s->meshes[0].shading_materials, 1);
    masked->alpha = ALPHA_MASK, masked->alpha_cutoff = 0.25;
    const package p = packed(s);
    scene *again = unpacked(&p);
    assert_string_equal(s->path, again->path);
    assert_string_equal(s->title, again->title);
    assert_string_equal(scene_root(s), scene_root(again));
    assert_int_equal(again->limits.triangles, 123456);
    assert_memory_equal(s->background.img->pixel, again->background.img->pixel, 7 * 5 * 3 * sizeof(float));
    assert_int_equal(s->background.image_line, again->background.image_line);
    for (size_t i = 0; i < s->texture_count; i++) {
        assert_true(texture_hash(s->textures[i].data, HASH_START) == texture_hash(again->textures[i].data, HASH_START));
        assert_true(s->textures[i].path_line > 0 && s->textures[i].path_line == again->textures[i].path_line);
    }
    for (size_t i = 0; i < s->mesh_count; i++) {
        assert_same_mesh(s->meshes[i].data, again->meshes[i].data);
        assert_true(s->meshes[i].path_line > 0 && s->meshes[i].path_line == again->meshes[i].path_line);
        assert_memory_equal(&s->meshes[i].account, &again->meshes[i].account, sizeof s->meshes[i].account);
        assert_true(s->meshes[i].motion_s == again->meshes[i].motion_s);
    }
    assert_true(again->meshes[2].account.steps > 0 && again->meshes[2].motion_s > 0.0);
    const face_materials *l = again->meshes[0].shading_materials;
    assert_int_equal(face_materials_count(l), 3);
    assert_string_equal(face_materials_at(l, 0)->name, face_materials_at(s->meshes[0].shading_materials, 0)->name);
    assert_true(face_materials_at(l, 0)->alpha == ALPHA_OPAQUE && face_materials_at(l, 1)->alpha == ALPHA_MASK);
    assert_true(face_materials_at(l, 1)->alpha_cutoff == 0.25);
    int images = 0;
    const texture *shared = NULL;
    for (int i = 0; i < 3; i++) {
        const texture *img = face_materials_at(l, i)->img;
        images += img != NULL;
        assert_true(!img || !shared || img == shared);
        shared = img ? img : shared;
    }
    assert_int_equal(images, 2);
    scene_destroy(s);
    scene_destroy(again);
    free(p.at);
}

static void meshes_that_entries_share_travel_once(void **state)
{
    (void)state;
    static const char text[] = "meshes: {a: {generate: icosphere, level: 3}, b: {generate: icosphere, level: 3}}\n"
                               "solids: {one: {shape: mesh, mesh: a}, two: {shape: mesh, mesh: b}}\n";
    scene *s = scene_from(text);
    load(s);
    const package twice = packed(s);
    mesh_entry_unload(&s->meshes[1]);
    s->meshes[1].data = s->meshes[0].data;
    mesh_retain(s->meshes[1].data);
    const package once = packed(s);
    assert_true(once.size < twice.size * 6 / 10);
    scene *again = unpacked(&once);
    assert_ptr_equal(again->meshes[0].data, again->meshes[1].data);
    assert_int_equal(mesh_reference_count(again->meshes[0].data), 2);
    scene_destroy(s);
    scene_destroy(again);
    free(twice.at);
    free(once.at);
}

static void an_unloaded_scene_is_loaded_by_the_receiver(void **state)
{
    (void)state;
    scene *s = scene_from("meshes: {a: {generate: icosphere, level: 3}}\nsolids: {one: {shape: mesh, mesh: a}}\n");
    s->path[0] = 0; /* as that of a scene from a link */
    const package p = packed(s);
    scene *again = unpacked(&p);
    assert_string_equal(again->path, "");
    assert_null(again->meshes[0].data);
    load(again);
    assert_non_null(again->meshes[0].data);
    scene_destroy(s);
    scene_destroy(again);
    free(p.at);
}

/* A stream, and the sizes of the calls. */
typedef struct stream {
    bytes data;
    size_t *sizes, calls, taken, next, most;
} stream;

static status give(void *context, const void *from, size_t size, diagnostic *why)
{
    (void)why;
    stream *c = context;
    c->sizes = realloc(c->sizes, (c->calls + 1) * sizeof *c->sizes);
    assert_non_null(c->sizes);
    c->sizes[c->calls++] = size;
    add(&c->data, from, size);
    return STATUS_OK;
}

static status take(void *context, void *to, size_t size, diagnostic *why)
{
    stream *c = context;
    assert_true(c->next < c->calls && c->sizes[c->next++] == size);
    if (c->taken + size > c->most)
        return diagnose(why, STATUS_INTERRUPTED, NULL, "the stream broke");
    memcpy(to, c->data.at + c->taken, size);
    c->taken += size;
    return STATUS_OK;
}

static void a_stream_has_the_same_bytes_in_calls_of_the_same_sizes(void **state)
{
    (void)state;
    scene *s = whole_scene(), *again = NULL;
    const package p = packed(s);
    stream c = {.most = SIZE_MAX};
    diagnostic why = {0};
    worked(scene_pack_to(s, give, &c, &why), &why);
    assert_int_equal(c.data.size, p.size);
    assert_memory_equal(c.data.at, p.at, p.size);
    worked(scene_unpack_from(take, &c, &again, &why), &why);
    assert_int_equal(c.next, c.calls);
    scene_destroy(again);
    for (size_t k = 0; k < 20; k++) { /* the stream's own error is passed on */
        c.next = c.taken = 0;
        c.most = p.size * k / 20;
        assert_int_equal(scene_unpack_from(take, &c, &again, &why), STATUS_INTERRUPTED);
        assert_null(again);
    }
    scene_destroy(s);
    free(p.at);
    free(c.data.at);
    free(c.sizes);
}

/* Without hierarchies kept between frames there is nothing to build in advance, nor for a z-buffer, nor for a hidden
 * solid. */
static void only_the_hierarchies_of_a_frame_are_built(void **state)
{
    (void)state;
    static const char *const settings[] = {"render.keep=off", "render.integrator=zbuffer", "one.visible=off"};
    for (size_t i = 0; i < 4; i++) {
        scene *s = scene_from("meshes: {a: {generate: icosphere, level: 4}}\nsolids: {one: {shape: mesh, mesh: a}}\n");
        if (i < 3)
            set(s, settings[i]);
        load(s);
        const package p = packed(s);
        const size_t bare = s->meshes[0].data->triangle_count * sizeof(mesh_triangle) +
                            s->meshes[0].data->vertex_count * 8 * sizeof(double);
        assert_true(i < 3 ? p.size < bare + 2000 : p.size > bare + 20000);
        scene_destroy(s);
        free(p.at);
    }
}

static void a_scene_without_a_text_is_refused(void **state)
{
    (void)state;
    scene *s = scene_from("meshes: {a: {generate: box}}\n");
    s->meshes[0].source = MESH_ARRAYS;
    void *at;
    size_t size;
    diagnostic why = {.what = ""};
    assert_int_equal(scene_pack(s, &at, &size, &why), STATUS_BAD_INPUT);
    assert_null(at);
    assert_non_null(strstr(why.what, "arrays"));
    scene_destroy(s);
}

/* Packages that are damaged, cut short, forged, or another build's. Run from the repository root. */

static void assert_refused(const package *p, const char *reason)
{
    scene *s = NULL;
    diagnostic why = {.what = ""};
    assert_int_equal(scene_unpack(p->at, p->size, &s, &why), STATUS_BAD_INPUT);
    assert_null(s);
    assert_non_null(strstr(why.what, reason));
}

static void other_builds_and_machines_are_refused(void **state)
{
    (void)state;
    scene *s = rod_scene("");
    package p = packed(s);
    assert_refused(&(package){p.at, 0}, "ends early");
    assert_refused(&(package){p.at, 40}, "ends early");
    const struct {
        size_t at;
        const char *reason;
    } places[] = {{0, "does not begin as a package"}, {8, "another kind of machine"}, {12, "another kind of machine"},
                  {16, "another kind of machine"},    {24, "from another build"},     {40, "from another build"},
                  {48, "it has the wrong size"}};
    for (size_t i = 0; i < sizeof places / sizeof *places; i++) {
        p.at[places[i].at] ^= 8;
        assert_refused(&p, places[i].reason);
        p.at[places[i].at] ^= 8;
    }
    scene *again = unpacked(&p);
    scene_destroy(again);
    scene_destroy(s);
    free(p.at);
}

enum { SIZE_AT = 48 };

static void put_word(const package *p, size_t at, uint64_t value)
{
    memcpy(p->at + at, &value, sizeof value);
}

/* The hash that fits the bytes. */
static void seal(const package *p)
{
    int64_t *words = malloc(p->size);
    memcpy(words, p->at, p->size);
    put_word(p, p->size - 8, hash_finish(hash_words(HASH_START, words, p->size / 8 - 1)));
    free(words);
}

/* Each prefix says that it is whole, in a block of its own size, so that a read beyond it is found. */
static void a_truncated_package_is_refused(void **state)
{
    (void)state;
    scene *s = whole_scene();
    const package p = packed(s);
    scene_destroy(s);
    const size_t step = p.size / 8 / 1500 * 8 + 8;
    for (size_t size = 64; size < p.size; size += size < 2048 ? 8 : step) {
        package part = {malloc(size), size};
        assert_non_null(part.at);
        memcpy(part.at, p.at, size);
        put_word(&part, SIZE_AT, size);
        seal(&part);
        assert_refused(&part, "");
        free(part.at);
    }
    free(p.at);
}

static void a_changed_byte_is_refused(void **state)
{
    (void)state;
    scene *s = whole_scene();
    const package p = packed(s);
    scene_destroy(s);
    const size_t step = p.size / 3000 + 1;
    for (size_t at = 0; at < p.size; at += at < 2048 ? 1 : step) {
        p.at[at] ^= (char)(1 << at % 8);
        assert_refused(&p, "");
        p.at[at] ^= (char)(1 << at % 8);
    }
    scene *again = unpacked(&p);
    scene_destroy(again);
    free(p.at);
}

/* A frame that is too bright for a film is refused. */
static void render_with_every_hierarchy(scene *s)
{
    renderer *r = NULL;
    diagnostic why = {0};
    worked(renderer_create(isa_best(), NULL, &r, &why), &why);
    static const char *const kinds[] = {"none", "sphere", "octant", "bvh"};
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++) {
        char text[64];
        snprintf(text, sizeof text, "render.accel=%s", kinds[i]);
        set(s, text);
        render_result *result = NULL;
        const status code = renderer_render(r, s, NULL, &result, &why);
        if (code != STATUS_OK && !strstr(why.what, "exceeds the film's range"))
            worked(code, &why);
        render_result_destroy(result);
    }
    renderer_destroy(r);
}

/* Changes that the hash does not show, behind the scene's text: what is accepted can be rendered. */
static void a_forged_package_is_refused_or_harmless(void **state)
{
    (void)state;
    scene *s = whole_scene();
    set_all(s, "render.threads=1 render.depth=3");
    package p = packed(s);
    scene_destroy(s);
    const char *end = memmem(p.at, p.size, "visible: off", 12);
    assert_non_null(end);
    const size_t first = ((size_t)(end - p.at) + 12) / 8 * 8 + 8, words = (p.size - 8 - first) / 8;
    static const uint64_t values[] = {0,
                                      1,
                                      2,
                                      0xffffffff,
                                      UINT64_MAX,
                                      UINT64_C(0x7ff8000000000000),
                                      UINT64_C(0x7ff0000000000000),
                                      UINT64_C(0x7f800000ff800000)};
    uint64_t seed = 1;
    size_t refused = 0, accepted = 0;
    for (size_t i = 0; i < 6000; i++) {
        /* all words of the first part, which is full of heads, then any */
        const size_t at = first + 8 * (i < 1500 && i < words ? i : random_bits(&seed) % words);
        uint64_t old, changed;
        memcpy(&old, p.at + at, sizeof old);
        changed = i % 2 ? values[random_bits(&seed) % 8] : old ^ UINT64_C(1) << random_bits(&seed) % 64;
        put_word(&p, at, changed);
        seal(&p);
        scene *again = NULL;
        diagnostic why = {.what = ""};
        const status code = scene_unpack(p.at, p.size, &again, &why);
        assert_true(code == STATUS_OK ? again != NULL : code == STATUS_BAD_INPUT && !again && why.what[0]);
        if (again)
            render_with_every_hierarchy(again);
        scene_destroy(again);
        *(code == STATUS_OK ? &accepted : &refused) += 1;
        put_word(&p, at, old);
    }
    assert_true(refused > 500 && accepted > 500);
    free(p.at);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_scene_of_the_project_survives),
        cmocka_unit_test(other_integrators_and_hierarchies_survive),
        cmocka_unit_test(all_that_is_loaded_is_the_same),
        cmocka_unit_test(meshes_that_entries_share_travel_once),
        cmocka_unit_test(an_unloaded_scene_is_loaded_by_the_receiver),
        cmocka_unit_test(only_the_hierarchies_of_a_frame_are_built),
        cmocka_unit_test(a_stream_has_the_same_bytes_in_calls_of_the_same_sizes),
        cmocka_unit_test(a_scene_without_a_text_is_refused),
        cmocka_unit_test(other_builds_and_machines_are_refused),
        cmocka_unit_test(a_truncated_package_is_refused),
        cmocka_unit_test(a_changed_byte_is_refused),
        cmocka_unit_test(a_forged_package_is_refused_or_harmless),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
