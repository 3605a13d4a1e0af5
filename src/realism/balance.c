/* The white furnace: under a sky of radiance 1, transparent media without absorption are invisible; a ray returns 1,
 * whatever its ray tree, or 1 minus what the depth limit cut off. Materials with a transparency below 1 or with
 * emission fail.
 *
 * Tolerance: half a unit of the film for each ray of the tree that ends in the sky, and the rounding of its weight, a
 * product of one factor for each interface of the path. */
#include "realism/metrics.h"
#include "scene/model/scene.h"

#include <math.h>

enum { COLUMNS = 20, ROWS = 15, DEPTH_MAX = 8 };

static scene *furnace(const scene *s, const setup *at)
{
    scene *copy = arrange_vessel(s, at);
    if (!copy)
        return NULL;
    copy->background.kind = BACKGROUND_UNIFORM;
    copy->background.color = vec3_make(1.0, 1.0, 1.0);
    copy->background.ambient = vec3_make(0.0, 0.0, 0.0);
    copy->render.beyond = DEPTH_LIMIT_BLACK;
    copy->render.depth = s->render.depth < DEPTH_MAX ? s->render.depth : DEPTH_MAX;
    for (size_t i = 0; i < copy->solid_count; i++) {
        copy->solids[i].surface.absorb_per_m = vec3_make(0.0, 0.0, 0.0);
        copy->solids[i].surface.absorb_spectrum.count = 0;
    }
    return copy;
}

static double tolerance_of(const ray_tree *tree)
{
    double sum = 0.0;
    for (size_t i = 0; i < tree->count; i++) {
        const ray_node *n = &tree->node[i];
        if (n->end == RAY_END_SKY || n->end == RAY_END_CUT_DEPTH)
            sum += BOUND_FILM + n->throughput[0] * bound_gamma(BOUND_FORM * (n->depth + 1));
    }
    return sum;
}

static double seen_and_cut(const ray_tree *tree, int channel)
{
    double sum = tree->radiance[channel];
    for (size_t i = 0; i < tree->count; i++)
        if (tree->node[i].end == RAY_END_CUT_DEPTH)
            sum += tree->node[i].throughput[channel];
    return sum;
}

status realism_balance(const metrics *m, diagnostic *why)
{
    trial t;
    worst_pair worst = WORST_NONE;
    scene *s = furnace(m->traced, &m->at);
    status code = trial_start(&t, s, m->level, why);
    for (int i = 0; i < COLUMNS * ROWS && code == STATUS_OK; i++) {
        const double x = (i % COLUMNS + 0.5) * (double)s->render.width / COLUMNS,
                     y = (i / COLUMNS + 0.5) * (double)s->render.height / ROWS;
        code = probe_ray(t.p, s->camera.position, probe_camera_direction(t.p, x, y), &t.tree, why);
        for (int c = 0; c < 3 && code == STATUS_OK; c++)
            worst_take(&worst, seen_and_cut(&t.tree, c), 1.0, tolerance_of(&t.tree));
    }
    trial_end(&t);
    metrics_add(
        m,
        (realism_value){
            "balance.furnace",
            "radiance plus the weight cut off at the depth limit, under a sky of radiance 1; largest error of 300 rays",
            "", worst.measured, worst.theory, worst.tolerance});
    return code;
}
