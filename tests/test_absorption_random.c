/* Tests of absorption along rays in random scenes against the integral of the absorption coefficient (Beer and Lambert;
 * Born and Wolf, 7th ed., 4.11.4): the media along the ray are determined from the solids' own shapes, at many points,
 * and the boundaries by bisection. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "random_scene.h"
#include "scene/model/scene.h"

enum { STEPS = 300 };

static vec3 at_distance(vec3 origin, vec3 direction, double t)
{
    return vec3_add(origin, vec3_scale(direction, t));
}

/* The end of the medium at the nearer distance; the medium at the farther distance differs. */
static double border(const probe *p, vec3 origin, vec3 direction, int medium, double near, double far)
{
    while (far - near > 1e-13) {
        const double middle = 0.5 * (near + far);
        *(probe_medium_at(p, at_distance(origin, direction, middle)) == medium ? &near : &far) = middle;
    }
    return far;
}

static void add_depth(const scene *s, int medium, double length, double depth[3])
{
    if (medium == RAY_OUTSIDE || s->solids[medium].surface.transparency == 0.0)
        return;
    const vec3 a = s->solids[medium].surface.absorb_per_m;
    depth[0] += a.x * length, depth[1] += a.y * length, depth[2] += a.z * length;
}

/* The optical depth of a straight segment. A medium between two of the points, with equal media on both sides, is
 * missed. */
static void optical_depth(const probe *p, const scene *s, vec3 origin, vec3 direction, double length, double depth[3])
{
    depth[0] = depth[1] = depth[2] = 0.0;
    const double step = length / STEPS, edge = 1e-3 * step;
    double from = 0.0;
    int now = probe_medium_at(p, at_distance(origin, direction, edge));
    for (int k = 1; k <= STEPS; k++) {
        const double far = k == STEPS ? length - edge : k * step;
        const int last = probe_medium_at(p, at_distance(origin, direction, far));
        while (now != last) {
            const double to = border(p, origin, direction, now, from < edge ? edge : from, far);
            add_depth(s, now, to - from, depth);
            now = to + 1e-12 < far ? probe_medium_at(p, at_distance(origin, direction, to + 1e-12)) : last;
            from = to;
        }
        add_depth(s, now, far - from, depth);
        from = far;
    }
    add_depth(s, now, edge, depth);
}

typedef struct tally {
    int rays, unlike;
    double worst;
} tally;

static void compare(tally *sum, const double depth[3], const double transmittance[3])
{
    double error = 0.0;
    for (int c = 0; c < 3; c++)
        error = fmax(error, fabs(transmittance[c] - exp(-depth[c])));
    sum->rays++;
    sum->unlike += error > 1e-9;
    sum->worst = fmax(sum->worst, error);
}

static void check_node(const stage *g, const ray_node *node, tally *hits, tally *shadows)
{
    double depth[3], transmittance[3];
    /* a shadow ray's contribution is rounded to film units: make it large enough for nine digits */
    if (node->kind == RAY_SHADOW && node->end == RAY_END_LIT && fmin(node->throughput[0], node->throughput[2]) > 1e-3) {
        optical_depth(g->probe, g->setting, node->origin, node->direction, node->light_distance, depth);
        for (int c = 0; c < 3; c++)
            transmittance[c] = node->brought[c] / node->throughput[c];
        compare(shadows, depth, transmittance);
    }
    if (node->kind != RAY_SHADOW && node->end == RAY_END_HIT && node->hit.t < 20.0) {
        optical_depth(g->probe, g->setting, node->origin, node->direction, node->hit.t, depth);
        compare(hits, depth, node->hit.transmittance);
    }
}

static void rays_and_shadow_rays_have_the_transmittance_of_the_media_along_them(void **state)
{
    (void)state;
    uint64_t seed = 8;
    tally hits = {0}, shadows = {0};
    print_message("seed %llu\n", (unsigned long long)seed);
    for (int number = 0; number < 250; number++) {
        const room m = random_room(&seed, number % 4 == 0);
        const vec3 lamp = random_point(&seed, number % 2 ? 3.0 : 0.8);
        scene_text text = {.length = 0};
        add(&text,
            "render: {depth: 3}\nlights: {lamp: {position: [%.17g, %.17g, %.17g], color: [1000, 1000, "
            "1000]}}\nsolids:\n",
            lamp.x, lamp.y, lamp.z);
        add_room(&text, &seed, &m, 1.0, true, true);
        stage g = stage_of(text.at, "");
        for (size_t k = 0; k < g.setting->solid_count; k++)
            g.setting->solids[k].surface.diffuse = 1.0;
        stage_look(&g);
        for (int k = 0; k < 8; k++) {
            const vec3 from = random_point(&seed, k % 2 ? 3.0 : 0.8), to = random_point(&seed, 0.8);
            const ray_tree *tree = stage_ray(&g, from, vec3_sub(to, from));
            for (size_t i = 0; i < tree->count; i++)
                check_node(&g, &tree->node[i], &hits, &shadows);
        }
        stage_close(&g);
    }
    assert_true(hits.rays > 3000 && shadows.rays > 1500);
    assert_true(hits.unlike < hits.rays / 500 && hits.worst < 0.01);
    assert_true(shadows.unlike < shadows.rays / 500 && shadows.worst < 0.01);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rays_and_shadow_rays_have_the_transmittance_of_the_media_along_them),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
