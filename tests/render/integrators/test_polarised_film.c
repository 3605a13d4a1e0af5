/* Tests of films whose rays carry Stokes vectors: Brewster, Malus, the pile of plates, chains of total reflections,
 * energy. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "polarised_chain.h"
#include "render/inspect/probe.h"
#include "render_fixture.h"
#include "scene/model/scene.h"

#define COUNT(a) (sizeof(a) / sizeof((a)[0]))
#define assert_near(a, b, tolerance) assert_true(fabs((a) - (b)) <= (tolerance))

static double degrees(double radians)
{
    return radians * (180.0 / acos(-1.0));
}

static vec3 look_with(scene *s, int64_t polarisation)
{
    s->render.polarisation = polarisation;
    return look(s);
}

/* --- one interface --- */

static const char surface_scene[] = "render: {width: 1, height: 1, depth: 1, beyond: black}\n"
                                    "camera: {position: [0, 0.1, 0], fov_deg: 0.0001}\n"
                                    "background: {kind: gradient, color: [1, 1, 1], horizon: [0, 0, 0]}\n"
                                    "solids: {water: {shape: plane, transparency: 1, ior: 1.5}}\n";

/* Unpolarised light reflected by one surface, seen without a polariser: the mean of R_s and R_p. */
static void one_surface_reflects_the_mean(void **state)
{
    (void)state;
    scene *s = scene_from(surface_scene);
    const double brewster = atan(1.5);
    const double incidences[] = {0.2, 0.7, brewster, 1.2, 1.5};
    for (size_t k = 0; k < COUNT(incidences); k++) {
        s->camera.aimed = 0;
        s->camera.pitch_deg = degrees(incidences[k]) - 90.0;
        const reflectances R = reflectances_at(incidences[k], 1.5);
        const vec3 on = look_with(s, 1), off = look_with(s, 0);
        assert_near(on.x, off.x, 1e-12);
        assert_near(on.x, 0.5 * (R.s + R.p) * cos(incidences[k]), 1e-12);
    }
    assert_true(reflectances_at(brewster, 1.5).p < 1e-30);
    scene_destroy(s);
}

/* --- two reflections --- */

/* The camera sees a lake at Brewster's angle, and in it a ball of the same glass, again at Brewster's angle; a matte
 * wall that only emits light is in the direction of the last ray. The plane of the second reflection is rotated by
 * `turn` about the ray between. */
static scene *two_mirrors(double turn, double n)
{
    const double b = atan(n), at = 5.0, radius = 1.0;
    scene *s = scene_from("render: {width: 1, height: 1, depth: 2, beyond: black, shadows: off}\n"
                          "background: {color: [0, 0, 0], ambient: [1, 1, 1]}\n"
                          "solids:\n"
                          "  lake: {shape: plane, transparency: 1}\n"
                          "  ball: {shape: sphere, transparency: 1}\n"
                          "  wall: {shape: sphere, ambient: 1, radius: 0.2}\n");
    const vec3 d0 = vec3_make(0.0, -cos(b), sin(b)), d1 = vec3_make(0.0, cos(b), sin(b));
    const vec3 in_plane = vec3_make(0.0, sin(b), -cos(b)), across = vec3_make(1.0, 0.0, 0.0);
    const vec3 side = vec3_add(vec3_scale(in_plane, cos(turn)), vec3_scale(across, sin(turn)));
    const vec3 normal = vec3_add(vec3_scale(d1, -cos(b)), vec3_scale(side, sin(b))); /* -d1.normal = cos b */
    const vec3 hit_point = vec3_scale(d1, at), d2 = vec3_add(d1, vec3_scale(normal, 2.0 * cos(b)));
    s->solids[0].surface.ior = s->solids[1].surface.ior = n;
    s->solids[1].shape.radius = radius;
    s->solids[1].shape.position = vec3_sub(hit_point, vec3_scale(normal, radius));
    s->solids[2].shape.position = vec3_add(hit_point, vec3_scale(d2, 2.0));
    s->camera.position = vec3_scale(d0, -3.0);
    s->camera.target = vec3_make(0.0, 0.0, 0.0);
    s->camera.aimed = 1;
    s->camera.fov_deg = 0.0001;
    return s;
}

/* The lake reflects R_s / 2 polarised along s, of which the ball reflects R_s cos^2 (Malus); nothing when crossed. */
static void two_reflections_at_brewsters_angle_obey_malus(void **state)
{
    (void)state;
    static const double indices[] = {1.33, 1.5, 2.0};
    for (size_t i = 0; i < COUNT(indices); i++)
        for (int k = 0; k <= 12; k++) {
            const double turn = (k - 6) * acos(-1.0) / 12.0, R_s = reflectances_at(atan(indices[i]), indices[i]).s;
            scene *s = two_mirrors(turn, indices[i]);
            assert_near(look_with(s, 0).x, 0.25 * R_s * R_s, 1e-9);
            assert_near(look_with(s, 1).y, 0.5 * R_s * R_s * cos(turn) * cos(turn), 1e-9);
            if (k % 12 == 0)
                assert_true(look_with(s, 1).z < 1e-12);
            scene_destroy(s);
        }
}

/* --- the pile of plates --- */

/* Two plates, inclined by 60 degrees, and a distant emitting wall. */
static const char plates_scene[] =
    "render: {width: 1, height: 1, depth: 5, beyond: black, shadows: off}\n"
    "camera: {position: [0, 0, -50], target: [0, 0, 0], fov_deg: 0.0001}\n"
    "background: {color: [0, 0, 0], ambient: [1, 1, 1]}\n"
    "materials: {glass: {transparency: 1, ior: 1.5}}\n"
    "solids:\n"
    "  one: {shape: box, material: glass, size: [60, 60, 0.01], rotation: [60, 0, 0]}\n"
    "  two: {shape: box, material: glass, size: [60, 60, 0.01], rotation: [60, 0, 0], position: [0, 0, 0.1]}\n"
    "  wall: {shape: box, ambient: 1, size: [100, 100, 1], position: [0, 0, 60]}\n";

/* Direct transmission through four interfaces: each polarisation separately, and unpolarised at each. */
static void direct_transmission_keeps_polarisations_separate(void **state)
{
    (void)state;
    scene *s = scene_from(plates_scene);
    const reflectances R = reflectances_at(acos(-1.0) / 3.0, 1.5);
    const double kept_s = pow(1.0 - R.s, 4.0), kept_p = pow(1.0 - R.p, 4.0);
    for (int on = 0; on <= 1; on++) {
        const double expected = on ? 0.5 * (kept_s + kept_p) : pow(1.0 - 0.5 * (R.s + R.p), 4.0);
        s->render.polarisation = on;
        probe *p = NULL;
        ray_tree tree = {0};
        diagnostic why = {0};
        worked(probe_create(s, isa_best(), &p, &why), &why);
        worked(probe_path(p, vec3_make(0.0, 0.0, -50.0), vec3_make(0.0, 0.0, 1.0), -1, &tree, &why), &why);
        assert_int_equal(tree.count, 5);
        assert_near(tree.node[4].throughput[0], expected, 1e-12);
        const double q = on ? (kept_s - kept_p) / (kept_s + kept_p) : 0.0;
        assert_near(hypot(tree.node[4].stokes[1], tree.node[4].stokes[2]), fabs(q), 1e-12);
        assert_near(tree.node[4].stokes[3], 0.0, 1e-12);
        ray_tree_release(&tree);
        probe_destroy(p);
        s->render.depth = 4; /* the film: direct transmission, plus what two reflections add later */
        assert_near(look_with(s, on).x, expected, 1e-12);
        s->render.depth = 5;
    }
    scene_destroy(s);
}

/* All reflections between m plates: (1 - R) / (1 + (2 m - 1) R) for each polarisation (Stokes, Proc. R. Soc. 11, 545,
 * 1862). The counted weights that depth and weight limits cut off bound the missing light. */
static void a_pile_of_plates_obeys_stokes_formula(void **state)
{
    (void)state;
    need_counters();
    scene *s = scene_from(plates_scene);
    const reflectances R = reflectances_at(acos(-1.0) / 3.0, 1.5);
    const double mean = 0.5 * (R.s + R.p), by_s = (1.0 - R.s) / (1.0 + 3.0 * R.s),
                 by_p = (1.0 - R.p) / (1.0 + 3.0 * R.p);
    set_all(s, "render.depth=40 render.min_weight=1e-7");
    for (int on = 0; on <= 1; on++) {
        const double expected = on ? 0.5 * (by_s + by_p) : (1.0 - mean) / (1.0 + 3.0 * mean);
        s->render.polarisation = on;
        render_result *r = render(s);
        const double cut =
            (double)(r->counters.cut_depth_throughput[0] + r->counters.cut_weight_throughput[0]) / COUNTERS_CUT_ONE;
        const double seen = film_value(r->img, 0, 0, 0);
        print_message("pile of plates, polarisation %d: %.7f + at most %.1e, expected %.7f\n", on, seen, cut, expected);
        assert_true(cut < 1e-3);
        assert_true(seen <= expected + 1e-10 && seen + cut >= expected - 1e-10);
        render_result_destroy(r);
    }
    /* the values differ measurably */
    assert_true(fabs(0.5 * (by_s + by_p) - (1.0 - mean) / (1.0 + 3.0 * mean)) > 0.01);
    scene_destroy(s);
}

/* --- any path through solids, against the field --- */

static const char solids_scene[] =
    "render: {depth: 12, polarisation: on}\n"
    "materials: {clear: {transparency: 1}}\n"
    "solids:\n"
    "  block: {shape: box, material: clear, ior: 1.5, size: [2, 2, 2]}\n"
    "  ball: {shape: sphere, material: clear, ior: 2.2, radius: 0.6, position: [0.1, -0.2, 0.3], priority: 1}\n"
    "  bubble: {shape: cylinder, material: clear, ior: 1, radius: 0.3, height: 0.8, position: [0.2, -0.3, 0.2], "
    "rotation: [20, 0, 30], priority: 2}\n"
    "  mirror: {shape: sphere, reflectivity: 0.8, radius: 0.3, position: [-0.5, 0.4, -0.3], priority: 3}\n";

/* Unpolarised light from the last ray's far end to the camera: half the powers of two orthogonal fields. */
static double share_by_fields(const ray_tree *tree, size_t last)
{
    vec3 x, y;
    double sum = 0.0;
    polarisation_frame(tree->node[last].direction, &x, &y);
    for (int k = 0; k < 2; k++) {
        field e = field_from(k ? y : x, 1.0);
        for (size_t i = last; i-- > 0;) {
            const ray_node *ray = &tree->node[i];
            const bool reflected = tree->node[i + 1].kind == RAY_REFLECT;
            const enum chain_kind kind = ray->hit.opaque ? CHAIN_MIRROR : reflected ? CHAIN_REFLECT : CHAIN_REFRACT;
            const chain_step step = {kind,           ray->direction,  ray->hit.normal, tree->node[i + 1].direction,
                                     ray->hit.cos_i, ray->hit.n_from, ray->hit.n_to};
            e = field_scale(chain_field(&step, e), ray->hit.opaque ? sqrt(0.8) : 1.0);
        }
        sum += 0.5 * field_power(e);
    }
    return sum;
}

static void the_weight_of_any_path_equals_that_of_its_fields(void **state)
{
    (void)state;
    scene *s = scene_from(solids_scene);
    probe *p = NULL;
    ray_tree tree = {0};
    diagnostic why = {0};
    worked(probe_create(s, isa_best(), &p, &why), &why);
    uint64_t seed = 5;
    int totals = 0, compared = 0, circular = 0, mirrored = 0;
    for (int trial = 0; trial < 3000; trial++) {
        const vec3 o = vec3_scale(random_direction(&seed), trial % 2 ? 0.9 : 6.0);
        const vec3 to = vec3_sub(vec3_scale(random_direction(&seed), 0.8), o);
        worked(probe_path(p, o, to, trial % 3 - 1, &tree, &why), &why);
        for (size_t i = 0; i < tree.count; i++) {
            const ray_node *n = &tree.node[i];
            if (n->end == RAY_END_CUT_DEPTH)
                continue;
            assert_near(n->throughput[0], share_by_fields(&tree, i), 1e-9);
            mirrored += i > 2 && tree.node[i - 1].hit.opaque;
            totals += n->end == RAY_END_HIT && n->hit.tir;
            circular += fabs(n->stokes[3]) > 0.01;
            compared++;
        }
    }
    print_message("%d rays, %d total reflections, %d elliptic, %d from the mirror\n", compared, totals, circular,
                  mirrored);
    assert_true(compared > 10000 && totals > 1000 && circular > 100 && mirrored > 100);
    ray_tree_release(&tree);
    probe_destroy(p);
    scene_destroy(s);
}

/* Inside a block, at 45 degrees to four faces, no light leaves: each reflection is total and loses nothing. */
static void total_internal_reflections_lose_no_light(void **state)
{
    (void)state;
    scene *s = scene_from("render: {width: 1, height: 1, depth: 30}\n"
                          "camera: {position: [0.1, 0.03, 0], target: [1.1, 1.05, 0.3], fov_deg: 0.001}\n"
                          "background: {color: [1, 1, 1]}\n"
                          "solids: {block: {shape: box, transparency: 1, ior: 1.6, size: [2, 2, 1000]}}\n");
    for (int on = 0; on <= 1; on++) {
        s->render.polarisation = on;
        render_result *r = render(s);
        assert_near(film_value(r->img, 0, 0, 0), 1.0, 1e-12);
        assert_int_equal(r->counters.total_internal, CUVETTE_COUNTERS ? 31 : 0);
        assert_int_equal(r->counters.refract, 0);
        render_result_destroy(r);
    }
    scene_destroy(s);
}

/* --- whole images --- */

static const char furnace_scene[] =
    "render: {width: 24, height: 18, shadows: off, polarisation: on}\n"
    "camera: {position: [0.3, 2.5, -5], target: [0, 1, 0], fov_deg: 40}\n"
    "background: {kind: uniform, color: [1, 1, 1], ambient: [0, 0, 0]}\n"
    "materials: {clear: {transparency: 1}}\n"
    "solids:\n"
    "  vessel: {shape: cup, material: clear, ior: 1.5, radius: 1, inner_radius: 0.9, height: 3, floor: 0.1, priority: "
    "2}\n"
    "  liquid: {shape: cylinder, material: clear, ior: 1.33, position: [0, 0.05, 0], radius: 0.95, height: 1.95, "
    "priority: 1}\n"
    "  ball: {shape: sphere, material: clear, ior: 2.4, position: [0.2, 1.2, 0.1], radius: 0.5, priority: 3}\n"
    "  mirror: {shape: sphere, reflectivity: 1, position: [1.5, 0.5, -1], radius: 0.4, priority: 6}\n";

/* Under a white sky everything is white: what each interface takes from one branch it adds to the other, for every
 * state of polarisation. */
static void every_pixel_of_a_white_furnace_is_white(void **state)
{
    (void)state;
    static const char *const eyes[] = {"0.3,2.5,-5", "0.1,0.5,-0.3",
                                       "0.2,1.25,0.1"}; /* in the air, the liquid, the ball */
    scene *s = scene_from(furnace_scene);
    for (size_t eye = 0; eye < COUNT(eyes); eye++) {
        diagnostic why = {0};
        worked(scene_set(s, "camera.position", eyes[eye], &why), &why);
        for (int depth = 0; depth <= 9; depth += 3) {
            s->render.depth = depth;
            render_result *r = render(s);
            for (int i = 0; i < 24 * 18; i++)
                assert_near(film_value(r->img, i % 24, i / 24, i % 3), 1.0, 1e-9);
            render_result_destroy(r);
        }
    }
    scene_destroy(s);
}

/* Solids with the index of their surroundings, and a second liquid inside the first, leave the film bit-identical. */
static void matched_media_are_invisible(void **state)
{
    (void)state;
    scene *with = scene_from(furnace_scene);
    set_all(with, "background.kind=gradient background.color=1,0.3,0.2 background.horizon=0.1,0.5,0.7 render.depth=6 "
                  "ball.ior=1.33");
    scene *without = scene_clone(with);
    set(without, "ball.visible=off");
    render_result *a = render(with), *b = render(without);
    assert_true(film_hash(a->img) == film_hash(b->img));
    set_all(with, "liquid.ior=1 ball.ior=1");
    set(without, "liquid.visible=off");
    render_result *c = render(with), *d = render(without);
    assert_true(film_hash(c->img) == film_hash(d->img));
    assert_true(film_hash(a->img) != film_hash(c->img));
    render_result *const all[] = {a, b, c, d};
    for (size_t k = 0; k < COUNT(all); k++)
        render_result_destroy(all[k]);
    scene_destroy(with);
    scene_destroy(without);
}

/* At normal incidence there is no plane of incidence, and both polarisations behave alike, however many interfaces
 * there are. */
static void polarisation_has_no_effect_at_normal_incidence(void **state)
{
    (void)state;
    scene *s = scene_from("render: {width: 1, height: 1, depth: 12, shadows: off}\n"
                          "camera: {position: [0, -5, 0], pitch_deg: 90, fov_deg: 1}\n"
                          "background: {kind: gradient, color: [1, 0, 0.5], horizon: [0, 1, 0.5]}\n"
                          "materials: {glass: {transparency: 1, ior: 1.5}}\n"
                          "solids:\n"
                          "  slab: {shape: box, material: glass, size: [50, 1, 50]}\n"
                          "  other: {shape: box, material: glass, ior: 2.1, size: [50, 1, 50], position: [0, 3, 0]}\n");
    const vec3 on = look_with(s, 1), off = look_with(s, 0);
    assert_near(on.x, off.x, 1e-12);
    assert_near(on.y, off.y, 1e-12);
    assert_near(on.x + on.y, 2.0 * on.z, 1e-10); /* thousands of contributions, each rounded to the film */
    scene_destroy(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(one_surface_reflects_the_mean),
        cmocka_unit_test(two_reflections_at_brewsters_angle_obey_malus),
        cmocka_unit_test(direct_transmission_keeps_polarisations_separate),
        cmocka_unit_test(a_pile_of_plates_obeys_stokes_formula),
        cmocka_unit_test(the_weight_of_any_path_equals_that_of_its_fields),
        cmocka_unit_test(total_internal_reflections_lose_no_light),
        cmocka_unit_test(every_pixel_of_a_white_furnace_is_white),
        cmocka_unit_test(matched_media_are_invisible),
        cmocka_unit_test(polarisation_has_no_effect_at_normal_incidence),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
