/* Tests of where the rays of beams start: patterns over a disc and a cone, grids of field points, many beams; and of
 * what is cut from a tree. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <cmocka.h>

#include "render/inspect/beams.h"
#include "render/plan/sampling.h"
#include "render_fixture.h"

#define PI 3.14159265358979323846

static const ray_axes upright = {.axis = {0, 0, 1}, .across = {1, 0, 0}, .normal = {0, 1, 0}};

/* Ray i on a disc of radius 1. */
static vec3 on_disc(const ray_pattern *p, int i)
{
    vec3 origin, direction;
    ray_axes_round(&upright, p, false, 2.0, i, &origin, &direction);
    assert_true(direction.z == 1.0 && origin.z == 0.0);
    return origin;
}

static double radius2(vec3 v)
{
    return v.x * v.x + v.y * v.y;
}

/* Each ring ends where its ray's radius halves its area; the parts of the disc between rings then are equal. */
static void rings_have_six_more_rays_each_and_equal_areas(void **state)
{
    static const int asked[] = {1, 6, 7, 18, 19, 100, 1000000}, got[] = {1, 1, 7, 7, 19, 91, 997057};
    (void)state;
    for (int i = 0; i < 7; i++)
        assert_int_equal(ray_pattern_of(PATTERN_RINGS, asked[i]).count, got[i]);
    const ray_pattern p = ray_pattern_of(PATTERN_RINGS, 91);
    assert_true(radius2(on_disc(&p, 0)) == 0.0);
    double inner = 1.0 / 91;
    for (int ring = 1, i = 1; ring <= 5; ring++) {
        const double middle = radius2(on_disc(&p, i)), outer = 2.0 * middle - inner;
        assert_true(fabs((outer - inner) / (6 * ring) - 1.0 / 91) < 1e-15);
        for (int k = 0; k < 6 * ring; k++, i++) {
            const vec3 at = on_disc(&p, i);
            assert_true(fabs(radius2(at) - middle) < 1e-15);
            assert_true(fabs(at.x - sqrt(middle) * cos(k * PI / 3.0 / ring)) < 1e-14);
            assert_true(fabs(at.y - sqrt(middle) * sin(k * PI / 3.0 / ring)) < 1e-14);
        }
        inner = outer;
    }
    assert_true(fabs(inner - 1.0) < 1e-14);
}

/* Compared with a list of all centres, in order. */
static void a_square_grid_has_every_centre_within_the_disc(void **state)
{
    (void)state;
    for (int side = 1; side <= 40; side++) {
        int count = 0, next = 0;
        for (int pass = 0; pass < 2; pass++) {
            const ray_pattern p = ray_pattern_of(PATTERN_SQUARE, count > 0 ? count : 1);
            for (int row = 0; row < side; row++)
                for (int column = 0; column < side; column++) {
                    const int a = 2 * column + 1 - side, b = 2 * row + 1 - side;
                    if (a * a + b * b > side * side)
                        continue;
                    if (pass == 0) {
                        count++;
                        continue;
                    }
                    const vec3 at = on_disc(&p, next++);
                    assert_true(fabs(at.x - (double)a / side) < 1e-15 && fabs(at.y - (double)b / side) < 1e-15);
                }
        }
        assert_int_equal(ray_pattern_of(PATTERN_SQUARE, count).count, count);
        assert_true(ray_pattern_of(PATTERN_SQUARE, count - (count > 1)).count < count || count == 1);
    }
}

/* The first points of Sobol's sequence in natural order, by Joe and Kuo's direction numbers, in eighths. */
static void sobol_points_are_those_of_the_published_sequence(void **state)
{
    static const int known[8][2] = {{0, 0}, {4, 4}, {2, 6}, {6, 2}, {1, 5}, {5, 1}, {3, 3}, {7, 7}};
    const ray_pattern p = ray_pattern_of(PATTERN_SOBOL, 1000);
    (void)state;
    assert_int_equal(p.count, 1000);
    for (int i = 0; i < 8; i++) {
        const double r = sqrt(known[i][0] / 8.0), turn = 2.0 * PI * known[i][1] / 8.0;
        const vec3 at = on_disc(&p, i);
        assert_true(fabs(at.x - r * cos(turn)) < 1e-15 && fabs(at.y - r * sin(turn)) < 1e-15);
    }
    /* Of the first 512 points, one lies in each of 512 equal parts. */
    int seen[512] = {0};
    for (int i = 0; i < 512; i++) {
        const vec3 at = on_disc(&p, i);
        seen[(int)floor(512.0 * radius2(at) + 1e-9)]++;
    }
    for (int i = 0; i < 512; i++)
        assert_int_equal(seen[i], 1);
}

/* Over equal parts, the mean of r^2 is 1/2 on a disc, and that of the cosine (1 + cos c) / 2 in a cone of half angle
 * c. */
static void all_patterns_fill_the_disc_and_the_cone_evenly(void **state)
{
    (void)state;
    for (beam_pattern kind = PATTERN_SPIRAL; kind <= PATTERN_SOBOL; kind++) {
        const ray_pattern p = ray_pattern_of(kind, 20000);
        double square = 0.0, cosine = 0.0;
        for (int i = 0; i < p.count; i++) {
            vec3 origin, direction;
            square += radius2(on_disc(&p, i)) / p.count;
            ray_axes_round(&upright, &p, true, 120.0, i, &origin, &direction);
            cosine += direction.z / p.count;
            assert_true(direction.z >= 0.5 - 1e-12 && fabs(vec3_dot(direction, direction) - 1.0) < 1e-12);
        }
        assert_true(fabs(square - 0.5) < 5e-4 && fabs(cosine - 0.75) < 3e-4);
    }
}

/* --- field points --- */

typedef struct start {
    beam_ray ray;
    vec3 origin, direction;
} start;

typedef struct starts {
    start at[64];
    int count;
    double power;
} starts;

static status note_start(void *context, const beam_ray *ray, const ray_tree *tree, const probe *p, diagnostic *why)
{
    starts *s = context;
    (void)p, (void)why;
    if (s->count < 64)
        s->at[s->count] = (start){*ray, tree->node[0].origin, tree->node[0].direction};
    s->count++;
    s->power += ray->power;
    return STATUS_OK;
}

static void trace_all(const char *beams, starts *all)
{
    char text[512];
    diagnostic why = {.line = 0};
    snprintf(text, sizeof text, "beams: {%s}\nsolids: {}\n", beams);
    scene *s = scene_from(text);
    *all = (starts){.count = 0};
    worked(beams_each_ray(s, isa_best(), 0, note_start, all, &why), &why);
    scene_destroy(s);
}

static void assert_near(vec3 a, double x, double y, double z)
{
    assert_true(fabs(a.x - x) < 1e-14 && fabs(a.y - y) < 1e-14 && fabs(a.z - z) < 1e-14);
}

/* Each direction fills the same disc; the angles from the axis are 10 degrees in both directions. */
static void field_points_of_parallel_rays_share_the_pupil(void **state)
{
    starts all;
    const double t = tan(PI / 18.0), length = sqrt(1.0 + 2.0 * t * t);
    (void)state;
    trace_all("b: {kind: bundle, rays: 7, pattern: rings, position: [0, 0, 0], target: [0, 0, 1], power: 3, "
              "field_columns: 3, field_rows: 3, field_deg: 20}",
              &all);
    assert_int_equal(all.count, 63);
    assert_true(fabs(all.power - 3.0) < 1e-12);
    for (int i = 0; i < 63; i++) {
        const start *one = &all.at[i], *first = &all.at[i % 7];
        assert_true(one->ray.field == i / 7 && one->ray.number == i % 7 && one->ray.rays == 7);
        assert_near(one->origin, first->origin.x, first->origin.y, first->origin.z);
        const int column = i / 7 % 3 - 1, row = i / 7 / 3 - 1;
        const double right = one->direction.x / one->direction.z, up = one->direction.y / one->direction.z;
        assert_true(fabs(right - column * t) < 1e-14 && fabs(up - row * t) < 1e-14);
    }
    assert_true(fabs(all.at[62].direction.z - 1.0 / length) < 1e-14);
}

static void field_points_of_a_pencil_aim_at_its_target(void **state)
{
    starts all;
    (void)state;
    trace_all("b: {position: [0, 0, -4], target: [0, 0, 0], field_rows: 3, field_width: 6}", &all);
    assert_int_equal(all.count, 3);
    assert_near(all.at[0].origin, 0, -3, -4);
    assert_near(all.at[0].direction, 0, 0.6, 0.8);
    assert_near(all.at[1].origin, 0, 0, -4);
    assert_near(all.at[2].direction, 0, -0.6, 0.8);
    trace_all("b: {position: [0, 0, -4], direction: [0, 0, 1], field_columns: 2, field_width: 6}", &all);
    assert_int_equal(all.count, 2);
    assert_near(all.at[0].direction, 0, 0, 1);
    assert_near(all.at[0].origin, -3, 0, -4);
    assert_near(all.at[1].origin, 3, 0, -4);
}

/* More beams, of more wavelengths, than there are kept probes: each has its own. */
static void any_number_of_beams_is_traced_in_order(void **state)
{
    enum { MANY = 20000 };
    char *text = malloc(100 * MANY);
    starts *all = calloc(1, sizeof *all);
    diagnostic why = {.line = 0};
    size_t at = 0;
    (void)state;
    at += (size_t)sprintf(text + at, "beams:\n");
    for (int i = 0; i < MANY; i++)
        at += (size_t)sprintf(text + at, "  b%d: {position: [0, %d, 0], direction: [1, 0, 0], lambda_nm: %d}\n", i, i,
                              400 + i % 200 * (i < 400));
    sprintf(text + at, "solids: {}\n");
    scene *s = scene_from(text);
    worked(beams_each_ray(s, isa_best(), 0, note_start, all, &why), &why);
    assert_int_equal(all->count, MANY);
    for (int i = 0; i < 64; i++) {
        assert_int_equal(all->at[i].ray.beam, i);
        assert_near(all->at[i].origin, 0, i, 0);
        assert_true(all->at[i].ray.lambda_nm == 400 + i % 200);
    }
    scene_destroy(s);
    free(all);
    free(text);
}

/* --- what is cut --- */

/* Ten panes before a ray. */
static scene *panes(const char *assignments)
{
    char text[2000] = "lights: {}\nsolids:\n";
    for (int i = 0; i < 10; i++)
        snprintf(text + strlen(text), sizeof text - strlen(text),
                 "  pane%d: {shape: box, size: [9, 9, 0.2], position: [0, 0, %g], transparency: 1, ior: 1.5, "
                 "priority: %d}\n",
                 i, 0.5 * i, i + 1);
    scene *s = scene_from(text);
    set_all(s, assignments);
    return s;
}

static void trace_panes(const char *assignments, ray_tree *tree)
{
    scene *s = panes(assignments);
    probe *p = NULL;
    diagnostic why = {.line = 0};
    worked(probe_create(s, isa_best(), &p, &why), &why);
    worked(probe_ray(p, vec3_make(0, 0, -3), vec3_make(0.1, 0, 1), tree, &why), &why);
    probe_destroy(p);
    scene_destroy(s);
}

static double left(const ray_tree *tree)
{
    return ray_tree_cut(tree, RAY_END_SKY).weight;
}

/* Nothing absorbs, so that what leaves and what is cut make up the whole ray; every ray of the full tree that has the
 * least weight is in the pruned one. */
static void pruning_keeps_heavier_rays_and_counts_the_rest(void **state)
{
    ray_tree full = {0}, pruned = {0};
    size_t heavy = 0, traced = 0;
    (void)state;
    trace_panes("render.depth=11 render.integrator=whitted", &full);
    trace_panes("render.depth=11 render.integrator=whitted render.min_weight=0.001", &pruned);
    const ray_cut deep = ray_tree_cut(&full, RAY_END_CUT_DEPTH), deep_pruned = ray_tree_cut(&pruned, RAY_END_CUT_DEPTH);
    const ray_cut weak = ray_tree_cut(&pruned, RAY_END_CUT_WEIGHT);
    assert_true(deep.rays > 0 && weak.rays > 0 && ray_tree_cut(&full, RAY_END_CUT_WEIGHT).rays == 0);
    assert_true(fabs(left(&full) + deep.weight - 1.0) < 1e-13);
    assert_true(fabs(left(&pruned) + deep_pruned.weight + weak.weight - 1.0) < 1e-13);
    for (size_t i = 0; i < full.count; i++)
        heavy += full.node[i].end != RAY_END_CUT_DEPTH && full.node[i].throughput[0] >= 0.001;
    for (size_t i = 0; i < pruned.count; i++)
        traced += pruned.node[i].end != RAY_END_CUT_DEPTH && pruned.node[i].end != RAY_END_CUT_WEIGHT;
    assert_true(traced == heavy && full.count > 2 * pruned.count);
    ray_tree_release(&full);
    ray_tree_release(&pruned);
}

/* The whole tree of depth 32 is refused; pruned, it is small. */
static void a_deep_tree_is_traced_with_a_least_weight(void **state)
{
    ray_tree tree = {0};
    (void)state;
    trace_panes("render.depth=32 render.integrator=whitted render.min_weight=1e-5", &tree);
    const ray_cut deep = ray_tree_cut(&tree, RAY_END_CUT_DEPTH), weak = ray_tree_cut(&tree, RAY_END_CUT_WEIGHT);
    assert_true(fabs(left(&tree) + deep.weight + weak.weight - 1.0) < 1e-12);
    assert_true(weak.weight < 0.05 && tree.count < 100000);
    ray_tree_release(&tree);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rings_have_six_more_rays_each_and_equal_areas),
        cmocka_unit_test(a_square_grid_has_every_centre_within_the_disc),
        cmocka_unit_test(sobol_points_are_those_of_the_published_sequence),
        cmocka_unit_test(all_patterns_fill_the_disc_and_the_cone_evenly),
        cmocka_unit_test(field_points_of_parallel_rays_share_the_pupil),
        cmocka_unit_test(field_points_of_a_pencil_aim_at_its_target),
        cmocka_unit_test(any_number_of_beams_is_traced_in_order),
        cmocka_unit_test(pruning_keeps_heavier_rays_and_counts_the_rest),
        cmocka_unit_test(a_deep_tree_is_traced_with_a_least_weight),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
