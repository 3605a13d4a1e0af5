/* Tests of random scenes: invariants, and the reversal of rays. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "random_scene.h"
#include "reversal_fixture.h"

/* A thousand random scenes: invariants for all solids and camera positions. */

enum { SCENES = 1000, WIDTH = 8, HEIGHT = 6 };

/* The kinds of scenes, used in turn. */
static const char *const ways_to_render[] = {
    "render.depth=5",
    "render.depth=5 render.beyond=black",
    "render.depth=5 render.polarisation=on",
    "render.depth=4 render.weights=constant render.samples=4",
    "render.depth=7 render.min_weight=0.01 render.beyond=black",
    "render.depth=3 render.shadows=opaque",
};

static scene_text random_scene(uint64_t *seed, int number, bool lit)
{
    const room m = random_room(seed, number % 3 == 0);
    const double outside = random_below(seed, 3) ? 1.0 : random_real(seed, 1.0, 2.0);
    const vec3 eye = random_point(seed, random_below(seed, 3) ? 3.0 : 0.7), target = random_point(seed, 0.5);
    scene_text t = {.length = 0};
    add(&t, "background: {color: [1, 1, 1], ior: %.17g}\nrender: {width: %d, height: %d}\n", outside, WIDTH, HEIGHT);
    add(&t, "camera: {position: [%.17g, %.17g, %.17g], target: [%.17g, %.17g, %.17g], fov_deg: 50}\n", eye.x, eye.y,
        eye.z, target.x, target.y, target.z);
    for (int k = 0; k < 3 && lit; k++) {
        const vec3 p = random_point(seed, 4.0);
        add(&t, "%s  lamp%d: {position: [%.17g, %.17g, %.17g], reach: %d}\n", k ? "" : "lights:\n", k, p.x, p.y, p.z,
            3 * k);
    }
    add(&t, "solids:\n");
    add_room(&t, seed, &m, outside, false, random_below(seed, 3) == 0);
    return t;
}

static bool is_share(double a)
{
    return a >= 0.0 && a <= 1.0;
}

static bool is_point(vec3 p)
{
    return isfinite(p.x) && isfinite(p.y) && isfinite(p.z);
}

/* No NaN, shares in 0..1, unit vectors of length 1, and no child with more weight than its parent. */
static const char *fault_of(const ray_tree *tree, const ray_node *node)
{
    const ray_hit *h = &node->hit;
    if (!is_point(node->origin) || !(fabs(vec3_length(node->direction) - 1.0) <= 1e-14))
        return "its origin or direction";
    for (int c = 0; c < 3; c++) {
        if (!(node->throughput[c] >= 0.0 && node->contribution[c] >= 0.0 && isfinite(node->throughput[c]) &&
              isfinite(node->contribution[c])))
            return "its throughput";
        if (node->kind != RAY_SHADOW && node->parent != RAY_NONE &&
            node->throughput[c] > tree->node[node->parent].throughput[c])
            return "more throughput than its parent";
    }
    if (node->end != RAY_END_HIT)
        return NULL;
    if (!is_point(h->point) || !(fabs(vec3_length(h->normal) - 1.0) <= 1e-14) ||
        !(vec3_dot(h->normal, node->direction) <= 1e-15))
        return "the point or normal where it hits";
    if (!(h->t >= 0.0 && h->error_bound >= 0.0 && h->error_bound <= 1e-14 * (100.0 + vec3_length(node->origin) + h->t)))
        return "the distance to its hit";
    const double shares[] = {
        h->cos_i, h->cos_t, h->R_s, h->R_p, h->R, h->transmittance[0], h->transmittance[1], h->transmittance[2]};
    for (size_t k = 0; k < COUNT(shares); k++)
        if (!is_share(shares[k]))
            return "a share at its hit";
    return NULL;
}

/* The medium a small step along a direction from a point, by the solids' own shapes. Returns false if another boundary
 * is within the step, so that a near and a far step disagree, or if the point is so far out that rounding loses the
 * nearest step. */
static bool medium_along(const probe *p, vec3 point, vec3 direction, int *medium)
{
    *medium = probe_medium_at(p, vec3_add(point, vec3_scale(direction, 1e-8)));
    return vec3_length(point) < 1000.0 && *medium == probe_medium_at(p, vec3_add(point, vec3_scale(direction, 1e-6))) &&
           *medium == probe_medium_at(p, vec3_add(point, vec3_scale(direction, 1e-10)));
}

typedef struct census {
    int queries, unsure, wrong;
} census;

static void ask(census *sum, const probe *p, vec3 point, vec3 direction, int believed)
{
    int medium;
    sum->queries++;
    if (!medium_along(p, point, direction, &medium))
        sum->unsure++;
    else
        sum->wrong += medium != believed;
}

static void ask_media(census *sum, const probe *p, const ray_tree *tree)
{
    for (size_t i = 0; i < tree->count; i++) {
        const ray_node *node = &tree->node[i];
        if (node->kind == RAY_REFLECT || node->kind == RAY_REFRACT)
            ask(sum, p, node->origin, node->direction, node->medium);
        if (node->end != RAY_END_HIT || node->kind == RAY_SHADOW)
            continue;
        ask(sum, p, node->hit.point, vec3_scale(node->direction, -1.0), node->hit.from);
        ask(sum, p, node->hit.point, node->direction, node->hit.to);
    }
}

typedef struct survey {
    census media;
    size_t rays;
    int hits;
    double brightest;
} survey;

static void look_at_scene(uint64_t *seed, int number, bool lit, renderer *r, survey *sum)
{
    const scene_text text = random_scene(seed, number, lit);
    stage g = stage_of(text.at, ways_to_render[number % (int)COUNT(ways_to_render)]);
    render_result *img = NULL;
    diagnostic why = {0};
    worked(renderer_render(r, g.setting, NULL, &img, &why), &why);
    for (int y = 0; y < HEIGHT; y++) {
        for (int x = 0; x < WIDTH; x++) {
            const ray_tree *tree = stage_pixel(&g, x, y);
            for (size_t i = 0; i < tree->count; i++) {
                const char *fault = fault_of(tree, &tree->node[i]);
                if (fault)
                    fail_msg("scene %d, pixel %d,%d, ray %zu: %s", number, x, y, i, fault);
                sum->hits += tree->node[i].end == RAY_END_HIT;
            }
            sum->rays += tree->count;
            ask_media(&sum->media, g.probe, tree);
            for (int c = 0; c < 3; c++) {
                if (tree->radiance[c] != film_value(img->img, x, y, c))
                    fail_msg("scene %d, pixel %d,%d: the probe and the image differ", number, x, y);
                /* each contribution is rounded to a unit of the film */
                sum->brightest = fmax(sum->brightest, tree->radiance[c] - (double)tree->count / FILM_ONE);
            }
        }
    }
    if (sum->media.wrong)
        fail_msg("scene %d: the media of %d points are not those of the solids", number, sum->media.wrong);
    render_result_destroy(img);
    stage_close(&g);
}

static survey look_at_scenes(uint64_t seed, bool lit)
{
    survey sum = {.rays = 0};
    renderer *r = NULL;
    diagnostic why = {0};
    print_message("seed %llu\n", (unsigned long long)seed);
    worked(renderer_create(isa_best(), NULL, &r, &why), &why);
    for (int number = 0; number < SCENES / 2; number++)
        look_at_scene(&seed, number, lit, r, &sum);
    renderer_destroy(r);
    assert_true(sum.media.unsure < sum.media.queries / 1000);
    assert_true(sum.rays > 100000 && sum.hits > 50000 && sum.media.queries > 100000);
    return sum;
}

/* No interface and no opaque surface creates light: R + T <= 1, k_a + k_r <= 1. */
static void no_pixel_exceeds_a_sky_of_one(void **state)
{
    (void)state;
    assert_true(look_at_scenes(5, false).brightest <= 1.0 + 1e-12);
}

static void with_lights_the_probe_equals_the_image(void **state)
{
    (void)state;
    assert_true(look_at_scenes(6, true).brightest > 1.0);
}

/* Solids on a grid, and rays from its points along axes and diagonals: through corners, along edges, inside faces. The
 * medium is then ambiguous, but values must be numbers, and energy must be conserved. */
static void rays_through_corners_and_along_edges_are_valid(void **state)
{
    (void)state;
    uint64_t seed = 7;
    size_t rays = 0;
    double worst = 0.0;
    print_message("seed %llu\n", (unsigned long long)seed);
    for (int number = 0; number < 1500; number++) {
        const room m = random_room(&seed, true);
        scene_text text = scene_begin(1.0, 5);
        add_room(&text, &seed, &m, 1.0, true, false);
        stage g = stage_of(text.at, "render.beyond=black");
        for (int k = 0; k < 30; k++) {
            vec3 from;
            from.x = 0.125 * random_below(&seed, 33) - 2.0;
            from.y = 0.125 * random_below(&seed, 33) - 2.0;
            from.z = 0.125 * random_below(&seed, 33) - 2.0;
            const int bits = random_below(&seed, 64); /* zeros have signs too */
            const vec3 d = vec3_make((bits & 1) * (bits & 8 ? 1.0 : -1.0), (bits >> 1 & 1) * (bits & 16 ? 1.0 : -1.0),
                                     (bits >> 2 & 1) * (bits & 32 ? 1.0 : -1.0));
            if (vec3_dot(d, d) == 0.0)
                continue;
            const ray_tree *tree = stage_ray(&g, from, d);
            worst = fmax(worst, fabs(tree->radiance[0] + tree_cut(tree, 0) - 1.0));
            rays += tree->count;
            for (size_t i = 0; i < tree->count; i++)
                if (fault_of(tree, &tree->node[i]))
                    fail_msg("scene %d, ray %zu: %s", number, i, fault_of(tree, &tree->node[i]));
        }
        stage_close(&g);
    }
    assert_true(worst <= 1e-9 && rays > 150000);
}

/* A ray in the plane of a face that contains its origin leaves the solid there, or later, but never through the
 * opposite face. The sign of a zero component decides its half-space. */
static void a_ray_within_a_face_does_not_leave_through_the_opposite_face(void **state)
{
    (void)state;
    static const char *const shapes[] = {"shape: box, size: [1, 1, 1], position: [0, 0.5, 0]",
                                         "shape: cylinder, radius: 0.5, height: 1"};
    for (size_t k = 0; k < COUNT(shapes); k++) {
        scene_text text = scene_begin(1.0, 2);
        add(&text, "  body: {transparency: 1, ior: 1.5, %s}\n", shapes[k]);
        stage g = stage_of(text.at, "");
        for (int top = 0; top < 2; top++) {
            for (int down = 0; down < 2; down++) {
                const vec3 from = vec3_make(0.0, top ? 1.0 : 0.0, 0.0), d = vec3_make(1.0, down ? -0.0 : 0.0, 0.0);
                const ray_hit *h = &stage_ray(&g, from, d)->node[0].hit;
                assert_int_equal(g.tree.node[0].end, RAY_END_HIT);
                assert_true(h->point.y == from.y && h->point.x == (top == down ? 0.5 : 0.0));
            }
        }
        stage_close(&g);
    }
}

/* Rays and their reversals have the same points, throughput and absorption, in random scenes. */

typedef struct tally {
    int paths, crossings, other_media, reflected;
    double farthest, unequal;
} tally;

static void take(tally *sum, reversal r)
{
    if (!r.used)
        return;
    assert_true(r.same_surfaces && r.from_closed_form <= 1e-9 && r.direction <= 1e-9);
    sum->farthest = fmax(sum->farthest, r.farthest);
    sum->unequal = fmax(sum->unequal, r.unequal);
    sum->paths++;
    sum->crossings += r.crossings;
    sum->other_media += r.other_media;
    sum->reflected += r.reflected;
}

static tally many_ways(uint64_t seed, bool absorbing)
{
    tally sum = {0};
    print_message("seed %llu\n", (unsigned long long)seed);
    for (int trial = 0; trial < 200; trial++) {
        const room m = random_room(&seed, false);
        const double outside = trial % 2 ? 1.0 : 1.2;
        scene_text text = scene_begin(outside, 64);
        add_room(&text, &seed, &m, outside, true, absorbing);
        stage g = stage_of(text.at, "");
        for (int k = 0; k < 20; k++) {
            const vec3 origin = random_point(&seed, k % 4 ? 3.0 : 0.8), target = random_point(&seed, 0.8);
            take(&sum, there_and_back(&g, origin, vec3_sub(target, origin), random_below(&seed, 12) - 4));
        }
        stage_close(&g);
    }
    return sum;
}

static void a_reversed_path_has_the_same_points_and_throughput(void **state)
{
    (void)state;
    const tally sum = many_ways(1, false);
    assert_true(sum.farthest <= 1e-9 && sum.unequal <= 1e-12);
    assert_true(sum.paths > 2000 && sum.crossings > 6000 && sum.other_media > 500 && sum.reflected > 500);
}

static void absorption_is_equal_in_both_directions(void **state)
{
    (void)state;
    const tally sum = many_ways(2, true);
    assert_true(sum.farthest <= 1e-9 && sum.unequal <= 1e-12);
    assert_true(sum.paths > 2000);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(no_pixel_exceeds_a_sky_of_one),
        cmocka_unit_test(rays_through_corners_and_along_edges_are_valid),
        cmocka_unit_test(a_ray_within_a_face_does_not_leave_through_the_opposite_face),
        cmocka_unit_test(with_lights_the_probe_equals_the_image),
        cmocka_unit_test(a_reversed_path_has_the_same_points_and_throughput),
        cmocka_unit_test(absorption_is_equal_in_both_directions),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
