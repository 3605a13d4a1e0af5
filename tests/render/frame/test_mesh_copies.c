/* Tests of copies of meshes: the image is the same as with separate solids, and for every number of threads and
 * hierarchy. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "base/counters.h"
#include "geometry/mesh/mesh_generators.h"
#include "geometry/shapes/shape.h"
#include "measure/clock.h"
#include "mesh_stage.h"
#include "random_stream.h"
#include "scene/model/scene.h"

#define FRAME                                                                          \
    "background: {kind: gradient, color: [0.2, 0.4, 0.9], horizon: [0.9, 0.8, 0.6]}\n" \
    "render: {width: 96, height: 72, depth: 5}\n"                                      \
    "camera: {position: [1.1, 2.3, -5], target: [0.1, 0.4, 0], fov_deg: 42}\n"         \
    "lights: {lamp: {position: [3, 5, -4]}, other: {position: [-4, 3, -1], intensity: 0.5}}\n"

static uint64_t hash_of(const char *text, const char *assignments, isa level)
{
    scene *s = scene_with_meshes(text, assignments);
    render_result *r = render_at(s, level, NULL);
    const uint64_t hash = film_hash(r->img);
    render_result_destroy(r);
    scene_destroy(s);
    return hash;
}

static void copies_equal_separate_solids(void **state)
{
    (void)state;
    scene_text a = {.length = 0}, b = {.length = 0};
    static const char keys[] =
        "shape: mesh, mesh: ring, transparency: 1, ior: 1.5, shading: smooth, scale: [0.5, 0.75, 0.5]";
    add(&a,
        "%smeshes: {ring: {generate: torus, around: 24, tube: 12}}\nsolids:\n  rings: {%s, copies: [3, 2, 2], spacing: "
        "[1.5, 1, 2], position: [-1.5, 0, -1]}\n",
        FRAME, keys);
    add(&b, "%smeshes: {ring: {generate: torus, around: 24, tube: 12}}\nsolids:\n", FRAME);
    for (int k = 0; k < 12; k++) /* one medium for all, as for copies */
        add(&b, "  r%d: {%s, position: [%g, %g, %g]}\n", k, keys, -1.5 + 1.5 * (k % 3), 1.0 * (k / 3 % 2),
            -1.0 + 2.0 * (k / 6));
    assert_true(hash_of(a.at, "", isa_best()) == hash_of(b.at, "", isa_best()));
}

/* Solids of one mesh share the hierarchy of a frame that keeps none; an invisible one has none to share. */
static void an_invisible_solid_shares_no_hierarchy(void **state)
{
    (void)state;
    scene_text t = {.length = 0};
    add(&t,
        "%smeshes: {ring: {generate: torus, around: 24, tube: 12}}\nsolids:\n  hidden: {shape: mesh, mesh: ring}\n  "
        "seen: {shape: mesh, mesh: ring, position: [0, 0.5, 0]}\n  also: {shape: mesh, mesh: ring, position: [1, 1, "
        "1]}\n",
        FRAME);
    const uint64_t expected = hash_of(t.at, "hidden.visible=off", isa_best());
    assert_true(hash_of(t.at, "hidden.visible=off render.keep=off", isa_best()) == expected);
    assert_true(hash_of(t.at, "hidden.visible=off seen.visible=off", isa_best()) != expected);
}

/* Of all vertices of all copies: the bounding box, and the farthest in any direction, which is that of a copy at a
 * corner of the grid. */
static void the_extent_of_copies_is_that_of_their_vertices(void **state)
{
    (void)state;
    static const vec3 grids[][2] = {
        {{3, 2, 4}, {2, -1.5, 0.7}}, {{1, 3, 1}, {9, 0.25, 9}}, {{5, 1, 2}, {-1, 7, -3}}, {{1, 1, 1}, {4, 4, 4}}};
    uint64_t seed = 3;
    mesh *m = NULL;
    assert_int_equal(generate_icosphere(1, &m, NULL), STATUS_OK);
    for (size_t g = 0; g < sizeof grids / sizeof *grids; g++) {
        const vec3 n = grids[g][0], step = grids[g][1], scale = {g % 2 ? -0.5 : 0.5, 1.5, g > 1 ? -0.8 : 0.8};
        const solid_shape s = {.kind = SHAPE_MESH, .mesh = m, .scale = scale, .copies = n, .spacing = step};
        const shape_rule *rule = shape_of(&s);
        const bounds3 b = rule->extent(&s).box;
        vec3 low = {HUGE_VAL, HUGE_VAL, HUGE_VAL}, high = {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL}, d[16];
        double most[16];
        for (int i = 0; i < 16; i++)
            d[i] = random_direction(&seed), most[i] = -HUGE_VAL;
        for (int copy = 0; copy < (int)(n.x * n.y * n.z); copy++)
            for (size_t v = 0; v < m->vertex_count; v++) {
                const int x = copy % (int)n.x, y = copy / (int)n.x % (int)n.y, z = copy / (int)(n.x * n.y);
                const vec3 p = {m->vertices[v].x * scale.x + x * step.x, m->vertices[v].y * scale.y + y * step.y,
                                m->vertices[v].z * scale.z + z * step.z};
                low = vec3_make(fmin(low.x, p.x), fmin(low.y, p.y), fmin(low.z, p.z));
                high = vec3_make(fmax(high.x, p.x), fmax(high.y, p.y), fmax(high.z, p.z));
                for (int i = 0; i < 16; i++)
                    most[i] = fmax(most[i], vec3_dot(d[i], p));
            }
        assert_true(vec3_length(vec3_sub(b.low, low)) < 1e-14 && vec3_length(vec3_sub(b.high, high)) < 1e-14);
        for (int i = 0; i < 16; i++)
            assert_true(fabs(rule->farthest(&s, d[i]) - most[i]) < 1e-14);
    }
    mesh_release(m);
}

/* Copies that touch form one block, bit-identical to a single one. */
static void touching_copies_equal_one_block(void **state)
{
    (void)state;
    scene_text a = {.length = 0}, b = {.length = 0};
    add(&a,
        "%smeshes: {cube: {generate: box, size: [0.3, 0.5, 0.7]}}\nsolids:\n  wall: {shape: mesh, mesh: cube, "
        "transparency: 1, ior: 1.5,"
        " copies: [4, 2, 3], spacing: [0.3, 0.5, 0.7], position: [-0.45, 0, -0.7], rotation: [0, 20, 0]}\n",
        FRAME);
    add(&b,
        "%ssolids:\n  wall: {shape: box, size: [1.2, 1, 2.1], transparency: 1, ior: 1.5, position: [%.17g, 0.25, "
        "%.17g], rotation: [0, 20, 0]}\n",
        FRAME, -0.45 + turned(vec3_make(0.45, 0.0, 0.7), vec3_make(0.0, 20.0, 0.0)).x,
        -0.7 + turned(vec3_make(0.45, 0.0, 0.7), vec3_make(0.0, 20.0, 0.0)).z);
    scene *many = scene_with_meshes(a.at, ""), *one = scene_with_meshes(b.at, "");
    render_result *x = render(many), *y = render(one);
    assert_true(rms_between(x->img, y->img) < 1e-8);
    render_result_destroy(x);
    render_result_destroy(y);
    scene_destroy(many);
    scene_destroy(one);
}

/* The world vertices of a copy as a separate mesh. */
static void placed_copies_equal_transformed_vertices(void **state)
{
    (void)state;
    scene_text a = {.length = 0}, b = {.length = 0};
    static const char keys[] = "shape: mesh, transparency: 1, ior: 1.5, specular: 0.5, shading: smooth";
    add(&a,
        "%smeshes: {ring: {generate: torus, around: 24, tube: 12}}\nsolids: {r: {%s, mesh: ring, scale: [1.25, 2, "
        "0.75], rotation: [30, 40, 50], position: [0.2, 0.4, 0.1]}}\n",
        FRAME, keys);
    add(&b, "%smeshes: {ring: {generate: torus, around: 24, tube: 12}}\nsolids: {r: {%s, mesh: ring}}\n", FRAME, keys);
    scene *placed = scene_with_meshes(a.at, ""), *moved = scene_with_meshes(b.at, "");
    const mesh *from = moved->meshes[0].data;
    mesh *m = NULL;
    assert_int_equal(mesh_create(from->vertex_count, from->triangle_count, true, false, false, &m, NULL), STATUS_OK);
    const vec3 turn = vec3_make(30.0, 40.0, 50.0);
    for (size_t i = 0; i < from->vertex_count; i++) {
        const vec3 v = from->vertices[i], n = from->normals[i];
        m->vertices[i] = vec3_add(vec3_make(0.2, 0.4, 0.1), turned(vec3_make(1.25 * v.x, 2.0 * v.y, 0.75 * v.z), turn));
        m->normals[i] = turned(vec3_normalize(vec3_make(n.x / 1.25, n.y / 2.0, n.z / 0.75)), turn);
    }
    memcpy(m->triangles, from->triangles, from->triangle_count * sizeof *m->triangles);
    assert_int_equal(mesh_finish(m, NULL), STATUS_OK);
    mesh_release(moved->meshes[0].data);
    moved->meshes[0].data = m;
    render_result *x = render(placed), *y = render(moved);
    assert_true(rms_between(x->img, y->img) < 1e-6);
    render_result_destroy(x);
    render_result_destroy(y);
    scene_destroy(placed);
    scene_destroy(moved);
}

static void a_hundred_thousand_copies_load_fast_in_little_memory(void **state)
{
    (void)state;
    scene_text t = {.length = 0};
    add(&t,
        "%smeshes: {ball: {generate: icosphere, level: 3}, slab: {generate: box, size: [200, 0.1, 200]}}\nsolids:\n"
        "  balls: {shape: mesh, mesh: ball, shading: smooth, transparency: 1, ior: 1.5, scale: [0.2, 0.2, 0.2], "
        "copies: [400, 1, 250], spacing: [0.5, 1, 0.5],"
        " position: [-100, 0.2, 0]}\n  floor: {shape: mesh, mesh: slab, diffuse: 0.8, position: [0, -0.05, 60]}\n",
        FRAME);
    scene *s = scene_with_meshes(t.at, "");
    const int64_t began = clock_wall_ns();
    render_result *r = render(s);
    const double seconds = (double)(clock_wall_ns() - began) * 1e-9;
    print_message("100001 copies: %.2f s, hierarchies %.1f KB, %llu rays\n", seconds, (double)r->meshes.bytes / 1024.0,
                  (unsigned long long)ray_counters_total(&r->counters));
    assert_int_equal(r->meshes.instances, 100001);
    assert_true(r->meshes.bytes < 1 << 20);
    assert_true(seconds < 20.0);
    render_result_destroy(r);
    scene_destroy(s);
}

static const char gallery[] = FRAME
    "meshes:\n  ring: {generate: torus, around: 40, tube: 20}\n  ball: {generate: icosphere, level: 2}\n  cube: "
    "{generate: box}\n  cloud: {generate: sparse, count: 500}\n"
    "textures: {map: {file: none.png}}\n"
    "solids:\n"
    "  ground: {shape: plane, texture: map, diffuse: 0.8, ambient: 0.1, position: [0, -0.5, 0]}\n"
    "  lens: {shape: mesh, mesh: ball, shading: smooth, transparency: 1, ior: 1.5, absorb_per_m: [0.3, 0.1, 0], "
    "position: [-1, 0.3, -0.5], priority: 2}\n"
    "  bath: {shape: box, size: [2, 0.6, 2], transparency: 0.9, ior: 1.33, position: [-0.6, -0.2, -0.2], priority: 1}\n"
    "  loop: {shape: mesh, mesh: ring, shading: gouraud, color: [0.8, 0.3, 0.2], diffuse: 0.7, specular: 0.5, "
    "shininess: 30, scale: [0.6, 0.6, 0.6],"
    " rotation: [60, 0, 20], position: [0.9, 0.5, 0]}\n"
    "  crate: {shape: mesh, mesh: cube, texture: map, diffuse: 0.7, ambient: 0.1, reflectivity: 0.2, position: [0.3, "
    "0, 0.9], rotation: [0, 30, 0]}\n"
    "  beads: {shape: mesh, mesh: ball, transparency: 1, ior: 1.5, absorb_per_m: [0, 1, 2], scale: [0.1, 0.1, 0.1], "
    "copies: [9, 2, 9], spacing: [0.21, 0.21, 0.21], position: [0.2, -0.3, -1.5]}\n"
    "  leaves: {shape: mesh, mesh: cloud, diffuse: 0.6, position: [0, 0.9, 1.6]}\n";

static void the_film_is_the_same_for_all_threads_schedules_and_hierarchies(void **state)
{
    (void)state;
    static const char *const settings[] = {"render.threads=1",
                                           "render.threads=2 render.schedule=rows",
                                           "render.threads=7 render.schedule=dynamic render.tile=8",
                                           "render.threads=3 render.schedule=tiles render.tile=16 render.pool=off",
                                           "render.accel=none",
                                           "render.accel=sphere",
                                           "render.accel=octant render.threads=2",
                                           "render.accel=bvh render.keep=off"};
    const uint64_t expected = hash_of(gallery, "", isa_best());
    for (size_t k = 0; k < COUNT(settings); k++)
        if (hash_of(gallery, settings[k], isa_best()) != expected)
            fail_msg("another film with %s", settings[k]);
    for (int level = ISA_BASE; level < (int)isa_best(); level++)
        assert_true(hash_of(gallery, "", (isa)level) == expected);
}

/* Shadow rays through two hundred absorbing beads each: more media than the list of a batch can hold. */
static void light_through_many_media_is_the_same_in_any_batch(void **state)
{
    (void)state;
    scene_text t = {.length = 0};
    add(&t,
        "background: {color: [0, 0, 0]}\nrender: {width: 24, height: 16, depth: 1}\ncamera: {position: [0, 2, -3], "
        "target: [0, 0, -1], fov_deg: 30}\n"
        "lights: {lamp: {position: [0.05, 0.45, 60]}}\nmeshes: {cube: {generate: box, size: [20, 3, 0.1]}}\nsolids:\n"
        "  ground: {shape: plane, diffuse: 0.9, ambient: 0, specular: 0}\n"
        "  slats: {shape: mesh, mesh: cube, transparency: 1, ior: 1, absorb_per_m: [0.01, 0.05, 0.1], copies: [1, 1, "
        "200], spacing: [1, 1, 0.25], position: [0, 1, 1], priority: -1}\n");
    const uint64_t expected = hash_of(t.at, "", isa_best());
    assert_true(hash_of(t.at, "render.threads=3 render.schedule=tiles render.tile=8", isa_best()) == expected);
    assert_true(hash_of(t.at, "render.schedule=columns render.threads=24", isa_best()) == expected);
    stage g = stage_with_meshes(t.at, "");
    const ray_tree *tree = stage_pixel(&g, 12, 8);
    assert_int_equal(tree->node[1].kind, RAY_SHADOW);
    const vec3 at = tree->node[0].hit.point, l = vec3_sub(vec3_make(0.05, 0.45, 60), at), d = vec3_normalize(l);
    const double a[3] = {0.01, 0.05, 0.1}, within = 200.0 * 0.1 / d.z;
    for (int c = 0; c < 3; c++)
        assert_true(fabs(tree->node[1].contribution[c] - tree->node[1].throughput[c] * exp(-a[c] * within)) < 1e-7);
    scene *s = scene_with_meshes(t.at, "");
    render_result *r = render(s);
    for (int c = 0; c < 3; c++)
        assert_true(fabs(film_value(r->img, 12, 8, c) - tree->radiance[c]) < 1e-9);
    render_result_destroy(r);
    scene_destroy(s);
    stage_close(&g);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(copies_equal_separate_solids),
        cmocka_unit_test(an_invisible_solid_shares_no_hierarchy),
        cmocka_unit_test(the_extent_of_copies_is_that_of_their_vertices),
        cmocka_unit_test(touching_copies_equal_one_block),
        cmocka_unit_test(placed_copies_equal_transformed_vertices),
        cmocka_unit_test(a_hundred_thousand_copies_load_fast_in_little_memory),
        cmocka_unit_test(the_film_is_the_same_for_all_threads_schedules_and_hierarchies),
        cmocka_unit_test(light_through_many_media_is_the_same_in_any_batch),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
