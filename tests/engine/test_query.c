/* Tests of ray queries. */
#include <math.h>
#include <pthread.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <cmocka.h>

#include "cuvette.h"
#include "engine_fixture.h"
#include "probe_fixture.h"
#include "random_stream.h"

/* Ray queries: against closed forms of a sphere, against the trees of the probe, and single rays against
 * batches. */

static cuvette_query *query_of_text(const char *text, const char *instructions)
{
    cuvette_diagnostic why;
    cuvette_scene *s;
    cuvette_query *q;
    fine(cuvette_scene_read_text("test.yaml", text, strlen(text), &s, &why), &why);
    fine(cuvette_query_create(s, instructions, &q, &why), &why);
    cuvette_scene_destroy(s); /* the query does not need it */
    return q;
}

static cuvette_query *query_of_rod(const char *instructions)
{
    cuvette_diagnostic why;
    cuvette_scene *s;
    cuvette_query *q;
    fine(cuvette_scene_read(ROD_SCENE, &s, &why), &why);
    fine(cuvette_query_create(s, instructions, &q, &why), &why);
    cuvette_scene_destroy(s);
    return q;
}

static cuvette_hit nearest(const cuvette_query *q, const cuvette_ray *ray)
{
    cuvette_diagnostic why;
    cuvette_hit hit;
    fine(cuvette_query_nearest(q, ray, 1, &hit, &why), &why);
    return hit;
}

static double dot(const double *a, const double *b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

#define BALL                                                                                      \
    "render: {width: 4, height: 4}\ncamera: {position: [0, 0, -9], target: [0, 0, 0]}\nsolids:\n" \
    "  ball: {shape: sphere, radius: 2, position: [1, 2, 3], transparency: 1, ior: 1.5}\n"

/* A ray that passes a sphere's centre at distance b hits it sqrt(r^2 - b^2) before and behind its nearest point. */
static void hits_of_a_sphere_equal_the_closed_form(void **state)
{
    (void)state;
    const double centre[3] = {1.0, 2.0, 3.0}, r = 2.0;
    cuvette_query *q = query_of_text(BALL, NULL);
    uint64_t random = 7;
    int hits_found = 0;
    for (int i = 0; i < 2000; i++) {
        cuvette_ray ray = {.reach = 0.0};
        double towards[3];
        for (int k = 0; k < 3; k++) {
            ray.origin[k] = centre[k] + random_real(&random, -20.0, 20.0);
            towards[k] = centre[k] + random_real(&random, -2.2, 2.2);
            ray.direction[k] = 3.0 * (towards[k] - ray.origin[k]); /* not a unit vector */
        }
        const double away[3] = {ray.origin[0] - centre[0], ray.origin[1] - centre[1], ray.origin[2] - centre[2]};
        const double length = sqrt(dot(ray.direction, ray.direction)), along = -dot(away, ray.direction) / length;
        const double b2 = dot(away, away) - along * along, gap = r * r - b2;
        if (dot(away, away) < 1.01 * r * r || fabs(gap) < 1e-6)
            continue;
        const cuvette_hit hit = nearest(q, &ray);
        if (gap < 0.0) {
            assert_true(isinf(hit.distance) && hit.solid == CUVETTE_OUTSIDE && hit.before == CUVETTE_OUTSIDE);
            continue;
        }
        hits_found++;
        const double half = sqrt(gap), slack = 1e-12 / half;
        assert_true(fabs(hit.distance - (along - half)) <= 30.0 * slack);
        double outward[3];
        for (int k = 0; k < 3; k++)
            outward[k] = (hit.point[k] - centre[k]) / r;
        assert_true(fabs(dot(outward, outward) - 1.0) <= 1e-13 && fabs(dot(outward, hit.normal) - 1.0) <= 1e-13);
        assert_true(hit.solid == 0 && hit.before == CUVETTE_OUTSIDE && hit.after == 0 && hit.n_before == 1.0 &&
                    hit.n_after == 1.5);
        assert_true(hit.triangle == -1 && hit.face == 0 && hit.error >= 0.0 && hit.error < 1e-12);

        /* Continue through the ball: the chord is 2 half; the normal at its end faces the ray, and behind it is the
         * outside again. */
        cuvette_ray on = {.start = hit.transmitted};
        memcpy(on.origin, hit.point, sizeof on.origin);
        memcpy(on.direction, ray.direction, sizeof on.direction);
        const cuvette_hit end = nearest(q, &on);
        assert_true(fabs(end.distance - 2.0 * half) <= 30.0 * slack && end.before == 0 && end.after == CUVETTE_OUTSIDE);
        assert_true(dot(end.normal, ray.direction) < 0.0);

        /* Back along the normal there is no hit, not even at distance 0. */
        cuvette_ray back = {.start = hit.reflected};
        memcpy(back.origin, hit.point, sizeof back.origin);
        memcpy(back.direction, hit.normal, sizeof back.direction);
        assert_true(isinf(nearest(q, &back).distance));

        ray.reach = hit.distance * (1.0 - 1e-9);
        assert_true(isinf(nearest(q, &ray).distance));
        ray.reach = hit.distance * (1.0 + 1e-9);
        assert_true(nearest(q, &ray).distance == hit.distance);
    }
    assert_true(hits_found > 500);
    cuvette_query_destroy(q);
}

/* Rays into the rod's scene from all sides, some from inside its media. */
static void make_rays(cuvette_ray *rays, size_t count)
{
    uint64_t random = 99;
    for (size_t i = 0; i < count; i++) {
        rays[i] = (cuvette_ray){.reach = i % 3 == 0   ? random_real(&random, 0.1, 8.0)
                                         : i % 3 == 1 ? 0.0
                                                      : (double)INFINITY};
        for (int k = 0; k < 3; k++) {
            rays[i].origin[k] = random_real(&random, -4.0, 4.0);
            rays[i].direction[k] = random_real(&random, -1.0, 1.0);
        }
        rays[i].origin[1] += 4.2;
        rays[i].direction[1] -= 0.5;
    }
}

enum { MANY = 5000 };

static void batches_equal_single_rays_on_every_instruction_set(void **state)
{
    (void)state;
    static cuvette_ray rays[MANY];
    static cuvette_hit together[MANY], again[MANY];
    static unsigned char blocked[MANY];
    cuvette_diagnostic why;
    cuvette_query *q = query_of_rod(NULL);
    int hits = 0;
    make_rays(rays, MANY);
    memset(together, 0, sizeof together);
    fine(cuvette_query_nearest(q, rays, MANY, together, &why), &why);
    fine(cuvette_query_occluded(q, rays, MANY, blocked, &why), &why);
    for (int i = 0; i < MANY; i++) {
        const cuvette_hit alone = nearest(q, &rays[i]);
        assert_memory_equal(&alone, &together[i], sizeof alone);
        unsigned char one = 7;
        fine(cuvette_query_occluded(q, &rays[i], 1, &one, &why), &why);
        assert_int_equal(one, blocked[i]);
        assert_int_equal(one, isfinite(together[i].distance));
        hits += one;
    }
    assert_true(hits > MANY / 4 && hits < MANY);
    for (int level = 0; level <= (int)isa_best(); level++) {
        cuvette_query *other = query_of_rod(isa_name((isa)level));
        fine(cuvette_query_nearest(other, rays, MANY, again, &why), &why);
        assert_memory_equal(again, together, sizeof again);
        cuvette_query_destroy(other);
    }
    cuvette_query_destroy(q);
}

static void camera_rays_have_the_hits_of_the_probe(void **state)
{
    (void)state;
    cuvette_diagnostic why;
    cuvette_query *q = query_of_rod(NULL);
    scene *model = rod_scene("");
    stage g = {.setting = model};
    stage_look(&g);
    int hits_found = 0;
    for (int y = 5; y < 600; y += 17)
        for (int x = 5; x < 800; x += 17) {
            cuvette_ray ray;
            fine(cuvette_query_camera_ray(q, x + 0.5, y + 0.5, &ray, &why), &why);
            const vec3 d = vec3_make(ray.direction[0], ray.direction[1], ray.direction[2]);
            const vec3 o = vec3_make(ray.origin[0], ray.origin[1], ray.origin[2]);
            diagnostic inner = {0};
            worked(probe_path(g.probe, o, d, -1, &g.tree, &inner), &inner);
            const ray_node *root = &g.tree.node[0];
            const cuvette_hit hit = nearest(q, &ray);
            assert_true((root->end == RAY_END_HIT) == (bool)isfinite(hit.distance));
            if (root->end != RAY_END_HIT)
                continue;
            hits_found++;
            assert_true(hit.distance == root->hit.t && hit.point[0] == root->hit.point.x &&
                        hit.normal[1] == root->hit.normal.y);
            assert_true(hit.solid == root->hit.solid && hit.before == root->hit.from && hit.after == root->hit.to &&
                        hit.face == root->hit.face);
            assert_true(hit.n_before == root->hit.n_from && hit.n_after == root->hit.n_to &&
                        hit.error == root->hit.error_bound);
        }
    assert_true(hits_found > 500);
    stage_close(&g);
    cuvette_query_destroy(q);
}

static void the_medium_at_a_point_has_the_highest_priority(void **state)
{
    (void)state;
    static const struct {
        double at[3];
        int32_t solid;
    } known[] = {
        /* ground, vessel, liquid, rod: the scene file's order */
        {{0.0, -1.0, 0.0}, 0}, {{0.95, 1.0, 0.0}, 1}, {{0.0, 0.075, 0.0}, 1},
        {{-0.5, 1.0, 0.0}, 2}, {{0.2, 1.0, 0.0}, 3},  {{0.0, 4.0, 0.0}, -1},
    };
    cuvette_diagnostic why;
    cuvette_query *q = query_of_rod(NULL);
    for (size_t i = 0; i < COUNT(known); i++) {
        int32_t found = -7;
        fine(cuvette_query_medium(q, known[i].at, &found, &why), &why);
        assert_int_equal(found, known[i].solid);
    }
    cuvette_query_destroy(q);
}

/* The cube about 0,0,0 of edge 2: corner i at the signs of its bits. Two triangles a side, with their fronts
 * outside. */
static const float cube_vertices[] = {-1, -1, -1, 1, -1, -1, -1, 1, -1, 1, 1, -1,
                                      -1, -1, 1,  1, -1, 1,  -1, 1, 1,  1, 1, 1};
static const uint32_t cube_corners[] = {0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5, 0, 1, 5, 0, 5, 4,
                                        2, 6, 7, 2, 7, 3, 0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6};
static const unsigned char cube_slots[] = {0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 5, 5};

/* Faces have the scene's materials with their slots' names. */
static void material_slots_of_arrays_use_materials_by_name(void **state)
{
    (void)state;
    cuvette_diagnostic why;
    cuvette_scene *s;
    cuvette_engine *engine;
    fine(cuvette_scene_create(&s, &why), &why);
    fine(cuvette_engine_create(NULL, &engine, &why), &why);
    const char *const names[] = {"left", "right", "below", "above", "front", "back"};
    const cuvette_triangles t = {.size = sizeof t,
                                 .vertex_count = 8,
                                 .triangle_count = 12,
                                 .vertices_float = cube_vertices,
                                 .corners = cube_corners,
                                 .slots = cube_slots,
                                 .slot_names = names,
                                 .slot_count = 6};
    fine(cuvette_scene_add_triangles(s, "cube", &t, &why), &why);
    fine(cuvette_scene_add_material(s, "front", &why), &why);
    fine(cuvette_scene_add_solid(s, "block", "mesh", NULL, &why), &why);
    const char *const settings[][2] = {
        {"block.mesh", "cube"},        {"front.ambient", "1"},     {"front.color", "0.25,0.5,0.75"},
        {"camera.position", "0,0,-9"}, {"camera.target", "0,0,0"}, {"render.width", "1"},
        {"render.height", "1"}};
    for (size_t i = 0; i < COUNT(settings); i++)
        fine(cuvette_scene_set(s, settings[i][0], settings[i][1], &why), &why);
    float seen[3];
    cuvette_request request = CUVETTE_REQUEST;
    request.width = request.height = 1, request.rgb = seen;
    fine(cuvette_engine_render(engine, s, &request, NULL, &why), &why);
    assert_true(fabsf(seen[0] - 0.25f) < 1e-6f && fabsf(seen[1] - 0.5f) < 1e-6f && fabsf(seen[2] - 0.75f) < 1e-6f);
    fine(cuvette_scene_set(s, "camera.position", "0,0,9", &why), &why);
    fine(cuvette_engine_render(engine, s, &request, NULL, &why), &why);
    assert_true(seen[0] == 0.0f && seen[1] == 0.0f && seen[2] == 0.0f);
    cuvette_scene_destroy(s);
    cuvette_engine_destroy(engine);
}

static cuvette_query *query_of_cube(bool as_mesh)
{
    cuvette_diagnostic why;
    cuvette_scene *s;
    cuvette_query *q;
    fine(cuvette_scene_create(&s, &why), &why);
    if (as_mesh) {
        cuvette_triangles t = {.size = sizeof t,
                               .vertex_count = 8,
                               .triangle_count = 12,
                               .vertices_float = cube_vertices,
                               .corners = cube_corners,
                               .slots = cube_slots};
        fine(cuvette_scene_add_triangles(s, "cube", &t, &why), &why);
        assert_int_equal((int)cuvette_scene_count(s, CUVETTE_MESH), 1);
        fine(cuvette_scene_add_solid(s, "block", "mesh", NULL, &why), &why);
        fine(cuvette_scene_set(s, "block.mesh", "cube", &why), &why);
    } else {
        fine(cuvette_scene_add_solid(s, "block", "box", NULL, &why), &why);
        fine(cuvette_scene_set(s, "block.size", "2,2,2", &why), &why);
    }
    fine(cuvette_scene_set(s, "block.transparency", "1", &why), &why);
    fine(cuvette_scene_set(s, "block.ior", "1.5", &why), &why);
    fine(cuvette_query_create(s, NULL, &q, &why), &why);
    cuvette_scene_destroy(s);
    return q;
}

/* A rasterised scene has no hierarchies, but rays need them. */
static void rays_hit_the_meshes_of_a_rasterised_scene(void **state)
{
    (void)state;
    cuvette_query *q =
        query_of_text("render: {integrator: zbuffer}\ncamera: {position: [0, 0, -9], target: [0, 0, 0]}\n"
                      "meshes: {cube: {generate: box, size: [2, 2, 2]}}\n"
                      "solids: {block: {shape: mesh, mesh: cube, transparency: 1, ior: 1.5}}\n",
                      NULL);
    const cuvette_ray ray = {.origin = {0.1, 0.2, -9.0}, .direction = {0.0, 0.0, 1.0}};
    const cuvette_hit hit = nearest(q, &ray);
    assert_true(fabs(hit.distance - 8.0) < 1e-12 && hit.solid == 0 && hit.n_after == 1.5);
    cuvette_query_destroy(q);
}

/* Positions agree within both error bounds, media and sides exactly; then continue behind the surface. */
static void a_cube_of_triangles_is_hit_like_a_box(void **state)
{
    (void)state;
    cuvette_query *cube = query_of_cube(true), *box = query_of_cube(false);
    uint64_t random = 5;
    int hits_found = 0;
    for (int i = 0; i < 3000; i++) {
        cuvette_ray ray = {.reach = 0.0};
        for (int k = 0; k < 3; k++) {
            ray.origin[k] = random_real(&random, -3.0, 3.0);
            ray.direction[k] = random_real(&random, -1.2, 1.2) - ray.origin[k];
        }
        const cuvette_hit a = nearest(cube, &ray), b = nearest(box, &ray);
        assert_true(isfinite(a.distance) == isfinite(b.distance) && a.before == b.before && a.after == b.after &&
                    a.solid == b.solid);
        if (!isfinite(a.distance))
            continue;
        hits_found++;
        const double slope = fabs(dot(a.normal, ray.direction)) / sqrt(dot(ray.direction, ray.direction));
        assert_true(fabs(a.distance - b.distance) * slope < 1e-14 * (1.0 + a.distance) &&
                    dot(a.normal, b.normal) > 1.0 - 1e-14);
        assert_true(a.triangle >= 0 && a.triangle / 2 == b.face && a.slot == b.face && a.copy == 0 && b.triangle == -1);
        assert_true(a.u >= 0.0 && a.v >= 0.0 && a.u + a.v <= 1.0 + 1e-15);
        cuvette_ray on = {.start = a.transmitted}, on_box = {.start = b.transmitted};
        memcpy(on.origin, a.point, sizeof on.origin);
        memcpy(on_box.origin, b.point, sizeof on.origin);
        memcpy(on.direction, ray.direction, sizeof on.direction);
        memcpy(on_box.direction, ray.direction, sizeof on.direction);
        const cuvette_hit c = nearest(cube, &on), d = nearest(box, &on_box);
        assert_true(isfinite(c.distance) == isfinite(d.distance) && c.before == d.before && c.after == d.after);
        assert_true(!isfinite(c.distance) || fabs(c.distance - d.distance) < 1e-11);
    }
    assert_true(hits_found > 2000);
    cuvette_query_destroy(cube);
    cuvette_query_destroy(box);
}

/* No triangles, but several instances of them: a program may begin like this. */
static void instances_of_empty_meshes_are_never_hit(void **state)
{
    (void)state;
    cuvette_diagnostic why;
    cuvette_scene *s;
    cuvette_query *q;
    const cuvette_triangles none = {.size = sizeof none};
    fine(cuvette_scene_create(&s, &why), &why);
    fine(cuvette_scene_add_triangles(s, "nothing", &none, &why), &why);
    fine(cuvette_scene_add_solid(s, "rows", "mesh", NULL, &why), &why);
    fine(cuvette_scene_set(s, "rows.mesh", "nothing", &why), &why);
    fine(cuvette_scene_set(s, "rows.copies", "3,1,1", &why), &why);
    fine(cuvette_scene_set(s, "camera.target", "0,0,5", &why), &why);
    fine(cuvette_query_create(s, NULL, &q, &why), &why);
    const cuvette_ray ray = {.origin = {0.0, 0.0, -9.0}, .direction = {0.0, 0.0, 1.0}};
    assert_true(isinf(nearest(q, &ray).distance));
    cuvette_query_destroy(q);
    cuvette_scene_destroy(s);
}

static void invalid_triangles_are_refused_and_not_added(void **state)
{
    (void)state;
    cuvette_diagnostic why;
    cuvette_scene *s;
    fine(cuvette_scene_create(&s, &why), &why);
    const uint32_t beyond[] = {0, 1, 8};
    const cuvette_triangles right = {.size = sizeof right,
                                     .vertex_count = 8,
                                     .triangle_count = 1,
                                     .vertices_float = cube_vertices,
                                     .corners = cube_corners};
    cuvette_triangles wrong[] = {right, right, right, right};
    wrong[0].size = 0;
    wrong[1].corners = beyond;
    wrong[2].vertices_float = NULL;
    wrong[3].corners = NULL;
    for (size_t i = 0; i < COUNT(wrong); i++)
        assert_int_equal(cuvette_scene_add_triangles(s, "piece", &wrong[i], &why), CUVETTE_BAD_INPUT);
    assert_int_equal(cuvette_scene_add_triangles(s, "no name", &right, &why), CUVETTE_BAD_INPUT);
    assert_int_equal(cuvette_scene_add_pixels(s, "image", 0, 5, cube_vertices, &why), CUVETTE_BAD_INPUT);
    assert_int_equal((int)(cuvette_scene_count(s, CUVETTE_MESH) + cuvette_scene_count(s, CUVETTE_TEXTURE)), 0);
    cuvette_scene_destroy(s);
}

static void invalid_rays_are_reported(void **state)
{
    (void)state;
    cuvette_diagnostic why;
    cuvette_query *q = query_of_text(BALL, NULL);
    const cuvette_ray right = {.direction = {1, 0, 0}};
    cuvette_ray rays[3] = {right, right, right};
    cuvette_hit hits[3];
    fine(cuvette_query_nearest(q, rays, 0, NULL, &why), &why);
    fine(cuvette_query_nearest(q, rays, 3, hits, &why), &why);
    const cuvette_ray wrong[] = {{.direction = {0, 0, 0}},
                                 {.direction = {(double)NAN, 0, 0}},
                                 {.direction = {1, 0, 0}, .origin = {2e6, 0, 0}},
                                 {.direction = {1, 0, 0}, .reach = -1.0},
                                 {.direction = {1, 0, 0}, .reach = (double)NAN},
                                 {.direction = {1, 0, 0}, .start = {{1, 800, 0, 0}}},
                                 {.direction = {1, 0, 0}, .start = {{5, 0, 0, 0}}}};
    for (size_t i = 0; i < COUNT(wrong); i++) {
        unsigned char blocked[3];
        rays[2] = wrong[i];
        assert_int_equal(cuvette_query_nearest(q, rays, 3, hits, &why), CUVETTE_BAD_INPUT);
        assert_non_null(strstr(why.what, "ray 2"));
        assert_int_equal(cuvette_query_occluded(q, rays, 3, blocked, &why), CUVETTE_BAD_INPUT);
    }
    cuvette_ray ray;
    assert_int_equal(cuvette_query_camera_ray(q, (double)NAN, 0.0, &ray, &why), CUVETTE_BAD_INPUT);
    assert_int_equal(cuvette_query_medium(q, (const double[]){0, (double)INFINITY, 0}, &(int32_t){0}, &why),
                     CUVETTE_BAD_INPUT);
    assert_int_equal(cuvette_query_nearest(q, NULL, 1, hits, &why), CUVETTE_BAD_INPUT);
    cuvette_query_destroy(q);
}

typedef struct asker {
    const cuvette_query *query;
    const cuvette_ray *rays;
    cuvette_hit hits[MANY];
} asker;

static void *ask(void *context)
{
    asker *a = context;
    cuvette_diagnostic why;
    for (int i = 0; i < MANY; i += 50)
        fine(cuvette_query_nearest(a->query, a->rays + i, 50, a->hits + i, &why), &why);
    return NULL;
}

static void threads_can_share_a_query(void **state)
{
    (void)state;
    static cuvette_ray rays[MANY];
    asker *askers = calloc(4, sizeof *askers);
    pthread_t threads[4];
    cuvette_query *q = query_of_rod(NULL);
    make_rays(rays, MANY);
    for (int i = 0; i < 4; i++) {
        askers[i].query = q, askers[i].rays = rays;
        assert_int_equal(pthread_create(&threads[i], NULL, ask, &askers[i]), 0);
    }
    for (int i = 0; i < 4; i++)
        pthread_join(threads[i], NULL);
    for (int i = 1; i < 4; i++)
        assert_memory_equal(askers[i].hits, askers[0].hits, sizeof askers[0].hits);
    free(askers);
    cuvette_query_destroy(q);
}

/* cuvette_query_cancel: other threads' rays, fans and beams end soon, and later calls give what they gave
 * before. */

enum { FAN_RAYS = 100000, RAYS = 200000 }; /* 10 s and more for the fan, which is then one ray tree after another */

static cuvette_query *query_of(const char *path)
{
    cuvette_diagnostic why;
    cuvette_scene *s;
    cuvette_query *q;
    fine(cuvette_scene_read(path, &s, &why), &why);
    fine(cuvette_query_create(s, NULL, &q, &why), &why);
    cuvette_scene_destroy(s);
    return q;
}

static cuvette_fan_rule rule_of(int rays)
{
    return (cuvette_fan_rule){
        .size = sizeof(cuvette_fan_rule), .from = {-3, 1.5, 0}, .to = {3, 1.5, 0}, .rays = rays, .width = 1.5};
}

/* A call in a thread of its own. */
typedef struct work {
    cuvette_query *of;
    atomic_bool ended;
    cuvette_status code;
    bool has_reason;
} work;

static void finish(work *w, cuvette_status code, const cuvette_diagnostic *why)
{
    w->code = code;
    w->has_reason = code != CUVETTE_OK && *why->what;
    atomic_store(&w->ended, true);
}

static void *follow_fan(void *context)
{
    work *w = context;
    cuvette_diagnostic why;
    cuvette_fan *fan = NULL;
    const cuvette_fan_rule rule = rule_of(FAN_RAYS);
    finish(w, cuvette_query_fan(w->of, &rule, &fan, &why), &why);
    cuvette_fan_destroy(fan);
    return NULL;
}

static cuvette_ray *some_rays(void)
{
    cuvette_ray *rays = calloc(RAYS, sizeof *rays);
    assert_non_null(rays);
    for (int i = 0; i < RAYS; i++)
        rays[i] = (cuvette_ray){.origin = {-3, 1.5, 0}, .direction = {1, 1e-6 * i, 0.2}, .reach = i % 2 ? 100 : 0};
    return rays;
}

/* Again and again, since one call takes only a tenth of a second. */
static void *trace_rays(void *context)
{
    work *w = context;
    cuvette_diagnostic why;
    cuvette_ray *rays = some_rays();
    cuvette_hit *hits = malloc(RAYS * sizeof *hits);
    cuvette_status code = CUVETTE_OK;
    for (int i = 0; i < 1000 && hits && code == CUVETTE_OK; i++)
        code = cuvette_query_nearest(w->of, rays, RAYS, hits, &why);
    finish(w, code, &why);
    free(hits);
    free(rays);
    return NULL;
}

static void *block_rays(void *context)
{
    work *w = context;
    cuvette_diagnostic why;
    cuvette_ray *rays = some_rays();
    unsigned char *blocked = malloc(RAYS);
    cuvette_status code = CUVETTE_OK;
    for (int i = 0; i < 1000 && blocked && code == CUVETTE_OK; i++)
        code = cuvette_query_occluded(w->of, rays, RAYS, blocked, &why);
    finish(w, code, &why);
    free(blocked);
    free(rays);
    return NULL;
}

/* Cancels every 5 ms, since a call that has not begun is not cancelled. */
static void are_cancelled(cuvette_query *q, void *(*const calls[])(void *), size_t count)
{
    work works[4];
    pthread_t threads[4];
    for (size_t i = 0; i < count; i++) {
        works[i] = (work){.of = q};
        assert_int_equal(pthread_create(&threads[i], NULL, calls[i], &works[i]), 0);
    }
    for (size_t i = 0; i < count;) {
        usleep(5000);
        cuvette_query_cancel(q);
        i += atomic_load(&works[i].ended);
    }
    for (size_t i = 0; i < count; i++) {
        pthread_join(threads[i], NULL);
        assert_int_equal(works[i].code, CUVETTE_CANCELLED);
        assert_true(works[i].has_reason);
    }
}

static uint64_t hash_of_fan(const cuvette_query *q)
{
    cuvette_diagnostic why;
    cuvette_fan *fan;
    const cuvette_fan_rule rule = rule_of(50);
    fine(cuvette_query_fan(q, &rule, &fan, &why), &why);
    size_t count;
    const cuvette_fan_ray *rays = cuvette_fan_rays(fan, &count);
    assert_int_equal(count, 50);
    uint64_t hash = UINT64_C(0xcbf29ce484222325);
    for (size_t i = 0; i < count; i++)
        for (int k = 0; k < 3; k++) {
            uint64_t bits;
            memcpy(&bits, &rays[i].exit_direction[k], sizeof bits);
            hash = (hash ^ bits) * UINT64_C(0x100000001b3);
        }
    cuvette_fan_destroy(fan);
    return hash;
}

/* The second fan waits for the first, which the query's only probe follows. */
static void test_fans_and_those_that_wait(void **state)
{
    (void)state;
    cuvette_query *q = query_of("experiments/scenes/rod.yaml");
    cuvette_query_cancel(NULL);
    cuvette_query_cancel(q); /* nothing is in progress: no effect */
    const uint64_t before = hash_of_fan(q);
    are_cancelled(q, (void *(*const[])(void *)){follow_fan, follow_fan}, 2);
    assert_true(hash_of_fan(q) == before);
    cuvette_query_destroy(q);
}

static void test_the_first_trace_is_cancelled(void **state)
{
    (void)state;
    cuvette_query *q = query_of("experiments/scenes/rod.yaml"), *other = query_of("experiments/scenes/rod.yaml");
    are_cancelled(q, (void *(*const[])(void *)){follow_fan}, 1);
    assert_true(hash_of_fan(q) == hash_of_fan(other));
    cuvette_query_destroy(q);
    cuvette_query_destroy(other);
}

static void test_many_rays(void **state)
{
    (void)state;
    cuvette_query *q = query_of("experiments/scenes/rod.yaml");
    are_cancelled(q, (void *(*const[])(void *)){trace_rays, block_rays}, 2);
    cuvette_diagnostic why;
    cuvette_hit hit;
    const cuvette_ray ray = {.origin = {-3, 1.5, 0}, .direction = {1, 0, 0}};
    fine(cuvette_query_nearest(q, &ray, 1, &hit, &why), &why);
    assert_true(hit.solid >= 0);
    cuvette_query_destroy(q);
}

typedef struct visits {
    cuvette_query *of;
    int count, cancelled_at;
} visits;

static bool cancel_at(void *context, const cuvette_beam_ray *ray, cuvette_tree *tree)
{
    visits *v = context;
    (void)ray;
    cuvette_tree_destroy(tree);
    if (++v->count == v->cancelled_at)
        cuvette_query_cancel(v->of);
    return true;
}

static void test_beams(void **state)
{
    (void)state;
    cuvette_diagnostic why;
    cuvette_query *q = query_of("experiments/scenes/lens.yaml");
    visits all = {.of = q}, some = {.of = q, .cancelled_at = 2};
    fine(cuvette_query_each_beam_ray(q, cancel_at, &all, &why), &why);
    assert_true(all.count > 3);
    assert_int_equal(cuvette_query_each_beam_ray(q, cancel_at, &some, &why), CUVETTE_CANCELLED);
    assert_int_equal(some.count, 2);
    cuvette_query_destroy(q);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(hits_of_a_sphere_equal_the_closed_form),
        cmocka_unit_test(batches_equal_single_rays_on_every_instruction_set),
        cmocka_unit_test(camera_rays_have_the_hits_of_the_probe),
        cmocka_unit_test(the_medium_at_a_point_has_the_highest_priority),
        cmocka_unit_test(material_slots_of_arrays_use_materials_by_name),
        cmocka_unit_test(a_cube_of_triangles_is_hit_like_a_box),
        cmocka_unit_test(rays_hit_the_meshes_of_a_rasterised_scene),
        cmocka_unit_test(instances_of_empty_meshes_are_never_hit),
        cmocka_unit_test(invalid_triangles_are_refused_and_not_added),
        cmocka_unit_test(invalid_rays_are_reported),
        cmocka_unit_test(threads_can_share_a_query),
        cmocka_unit_test(test_fans_and_those_that_wait),
        cmocka_unit_test(test_the_first_trace_is_cancelled),
        cmocka_unit_test(test_many_rays),
        cmocka_unit_test(test_beams),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
