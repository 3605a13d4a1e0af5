/* Films of scenes with 2 to 1000 solids: they do not depend on how the solids are found, nor on threads, schedule,
 * tiles and instruction set; and laws that a change without an effect preserves them. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <cmocka.h>

#include "random_scene.h"

enum { SOLIDS = 1000, LINE = 1600, SCENES = 60 };

/* A scene as lines, one a solid. */
typedef struct crowd {
    int count;
    double reach; /* solids are within it, around the origin */
    char line[SOLIDS + 2][LINE];
} crowd;

static int random_count(uint64_t *seed)
{
    return (int)pow(10.0, random_real(seed, log10(2.0), 3.0));
}

/* A solid of any kind but a plane: some overlap, some are in others, some share their medium. */
static void write_solid(crowd *c, uint64_t *seed, int i, double size, vec3 position)
{
    solid_shape s = random_shape(seed);
    while (s.kind == SHAPE_PLANE)
        s = random_shape(seed);
    scene_text t = {.length = 0};
    const int look = random_below(seed, 4);
    s.position = position;
    s.radius *= size, s.height *= size, s.inner_radius *= size, s.floor *= size, s.top_radius *= size;
    s.tube_radius *= size, s.size = vec3_scale(s.size, size);
    s.radius_1 *= size, s.radius_2 *= size, s.thickness *= size, s.diameter *= size;
    add(&t, "  s%d: {priority: %d, ", i, random_below(seed, 5));
    if (look == 0)
        add(&t, "diffuse: 0.7, reflectivity: 0.2, color: [0.9, 0.5, 0.2], ");
    else
        add(&t, "transparency: 1, reflectivity: 0, ior: %s, absorb_per_m: [%d, 0, 1], ",
            look == 1   ? "1.33"
            : look == 2 ? "1.5"
                        : "2",
            random_below(seed, 3));
    add_shape(&t, &s);
    add(&t, "}\n");
    assert_true(t.length < LINE);
    memcpy(c->line[i], t.at, t.length + 1);
}

static void fill(crowd *c, uint64_t *seed, int count)
{
    c->count = count;
    c->reach = 2.0;
    const double size = 1.2 * pow((double)count, -1.0 / 3.0);
    for (int i = 0; i < count; i++)
        write_solid(c, seed, i, size, random_point(seed, c->reach));
}

static scene *scene_of_crowd(const crowd *c, const int *order, const char *more)
{
    static char text[(SOLIDS + 8) * LINE];
    int used = sprintf(text, "render: {width: 24, height: 18, depth: 4}\n"
                             "camera: {position: [0.3, 1, -5], target: [0, 0, 0], fov_deg: 60}\n"
                             "background: {color: [0.5, 0.7, 1], ambient: [0.2, 0.2, 0.2]}\n"
                             "lights:\n  lamp: {position: [4, 6, -5]}\nsolids:\n"
                             "  ground: {shape: plane, position: [0, -2.5, 0], diffuse: 0.5, priority: -9}\n");
    for (int i = 0; i < c->count; i++)
        used += sprintf(text + used, "%s", c->line[order ? order[i] : i]);
    sprintf(text + used, "%s", more);
    return scene_from(text);
}

static uint64_t hash_with(scene *s, const char *assignments, isa level)
{
    set_all(s, assignments);
    render_result *result = render_at(s, level, NULL);
    const uint64_t hash = film_hash(result->img);
    render_result_destroy(result);
    return hash;
}

/* With more than 64 solids accel none has no effect; with fewer all solids are then tested directly. */
static void the_film_does_not_depend_on_how_solids_are_found(void **state)
{
    (void)state;
    static crowd c;
    uint64_t seed = 401;
    int direct = 0;
    for (int k = 0; k < SCENES; k++) {
        fill(&c, &seed, random_count(&seed));
        direct += c.count > 24 && c.count < 32;
        scene *s = scene_of_crowd(&c, NULL, "");
        static const char *const settings[] = {"render.radiance=basic", "render.shadows=opaque", "render.samples=4",
                                               "render.integrator=path render.paths=4", "render.polarisation=on"};
        set_all(s, settings[k % (int)COUNT(settings)]);
        const uint64_t hash = hash_with(s, "render.accel=bvh render.threads=1", isa_best());
        assert_true(hash_with(s, "render.accel=none", isa_best()) == hash);
        assert_true(hash_with(s, "render.accel=bvh render.threads=3 render.tile=5", isa_best()) == hash);
        assert_true(hash_with(s, "render.schedule=rows", isa_best()) == hash);
        for (int level = ISA_BASE; k % 8 == 0 && level < (int)isa_best(); level++)
            assert_true(hash_with(s, "render.threads=1", (isa)level) == hash);
        scene_destroy(s);
    }
    assert_true(direct > 0);
}

/* Solids on a lattice, which do not touch. */
static void fill_apart(crowd *c, uint64_t *seed, int count)
{
    const int side = (int)ceil(pow((double)count, 1.0 / 3.0));
    const double step = 4.0 / side;
    c->count = count;
    c->reach = 2.0;
    for (int i = 0; i < count; i++)
        write_solid(c, seed, i, 0.12 * step,
                    vec3_make(step * (i % side) - 2.0, step * (i / side % side) - 2.0, step * (i / side / side) - 2.0));
}

static void the_order_of_separate_solids_preserves_the_film(void **state)
{
    (void)state;
    static crowd c;
    uint64_t seed = 402;
    int order[SOLIDS];
    for (int k = 0; k < SCENES / 3; k++) {
        fill_apart(&c, &seed, random_count(&seed));
        scene *s = scene_of_crowd(&c, NULL, "");
        const uint64_t hash = hash_with(s, "", isa_best());
        scene_destroy(s);
        for (int i = 0; i < c.count; i++) {
            const int at = random_below(&seed, i + 1);
            order[i] = order[at];
            order[at] = i;
        }
        s = scene_of_crowd(&c, order, "");
        assert_true(hash_with(s, "", isa_best()) == hash);
        scene_destroy(s);
    }
}

/* A ball of the medium around it is not there; nor is one that no ray meets. */
static void solids_without_an_effect_preserve_the_film(void **state)
{
    (void)state;
    static crowd c;
    uint64_t seed = 403;
    for (int k = 0; k < SCENES / 3; k++) {
        fill(&c, &seed, random_count(&seed));
        scene *s = scene_of_crowd(&c, NULL, "");
        const uint64_t hash = hash_with(s, "", isa_best());
        scene_destroy(s);
        s = scene_of_crowd(
            &c, NULL,
            "  air: {shape: sphere, radius: 1.5, transparency: 1, ior: 1, reflectivity: 0, priority: -1}\n"
            "  below: {shape: box, size: [9, 1, 9], position: [0, -9, 0], diffuse: 1}\n");
        assert_true(hash_with(s, "", isa_best()) == hash);
        scene_destroy(s);
    }
}

/* 300 balls of water within a ball of water: between equal media there is no interface. */
static void balls_of_one_medium_are_one_ball(void **state)
{
    (void)state;
    uint64_t seed = 404;
    static crowd c;
    c.count = 0;
    static const char one[] = "  big: {shape: sphere, radius: 1.8, transparency: 1, ior: 1.33, reflectivity: 0}\n";
    scene *s = scene_of_crowd(&c, NULL, one);
    const uint64_t hash = hash_with(s, "", isa_best());
    scene_destroy(s);
    for (; c.count < 300; c.count++) {
        const vec3 at = random_point(&seed, 0.7);
        sprintf(c.line[c.count],
                "  s%d: {shape: sphere, radius: 0.4, transparency: 1, ior: 1.33, reflectivity: 0, priority: %d, "
                "position: [%.17g, %.17g, %.17g]}\n",
                c.count, random_below(&seed, 5) - 2, at.x, at.y, at.z);
    }
    s = scene_of_crowd(&c, NULL, one);
    assert_true(hash_with(s, "", isa_best()) == hash);
    scene_destroy(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_film_does_not_depend_on_how_solids_are_found),
        cmocka_unit_test(the_order_of_separate_solids_preserves_the_film),
        cmocka_unit_test(solids_without_an_effect_preserve_the_film),
        cmocka_unit_test(balls_of_one_medium_are_one_ball),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
