/* The choice of one light for each gathered ray. */
#include "render/shade/light_choice.h"
#include "render/shade/path_kernels.h"

#include <math.h>

/* Lights are summed in blocks, whose order does not depend on the width of the processor's vectors. */
enum { BLOCK = LAMP_BLOCK, BLOCKS_MAX = LAMPS_MAX / BLOCK };

static double strength_of(const light *l)
{
    return l->intensity * (l->color.x + l->color.y + l->color.z);
}

static void fill_table(const plan *p, lamp_table *lamps)
{
    lamps->blocks = (p->light_count + BLOCK - 1) / BLOCK;
    lamps->cones = false;
    lamps->suns = p->has_sun;
    for (int k = p->light_count; k < lamps->blocks * BLOCK; k++) {
        lamps->x[k] = lamps->y[k] = lamps->z[k] = 0.0;
        lamps->radius[k] = lamps->strength[k] = lamps->even[k] = lamps->falling[k] = 0.0f;
    }
    for (int k = 0; k < p->light_count; k++) {
        const light *l = &p->lights[k];
        const bool falls = l->reach > 0.0;
        const double strength = l->kind == LIGHT_SUN ? 0.0 : strength_of(l);
        lamps->x[k] = l->position.x, lamps->y[k] = l->position.y, lamps->z[k] = l->position.z;
        lamps->radius[k] = (float)light_extent(l);
        lamps->strength[k] = (float)(falls ? strength * l->reach * l->reach : strength);
        lamps->even[k] = falls ? 0.0f : 1.0f, lamps->falling[k] = 1.0f - lamps->even[k];
        lamps->cones |= light_has_cone(l) && light_extent(l) == 0.0;
    }
}

/* The share of a cone light that is a point is exact. */
static void apply_cones(const plan *p, vec3 point, float *weight)
{
    for (int k = 0; k < p->light_count; k++) {
        const light *l = &p->lights[k];
        if (light_has_cone(l) && light_extent(l) == 0.0 && weight[k] > 0.0f)
            weight[k] *= (float)light_share(l, &p->cones[k], vec3_normalize(vec3_sub(point, l->position)));
    }
}

/* As light_weights of a sphere of radius sin a at distance 1: a sun's weight is the same at all points, however far the
 * place where its shadow rays end. */
static void apply_suns(const plan *p, const light_estimate *by, vec3 n, float least, float *weight)
{
    for (int k = 0; k < p->light_count; k++) {
        if (p->lights[k].kind != LIGHT_SUN)
            continue;
        const float above = (float)-vec3_dot(n, p->cones[k].axis), r = (float)sqrt(light_sun_sine2(&p->cones[k]));
        const float height = above < r ? 0.5f * (above + r) : above;
        weight[k] = height > least ? (float)strength_of(&p->lights[k]) * (by->k_d * height + by->k_s) : 0.0f;
    }
}

/* Sums of the blocks, and of all. */
static float add_up(const float *weight, int blocks, float *sum)
{
    float total = 0.0f;
    for (int b = 0; b < blocks; b++) {
        const float *w = weight + (ptrdiff_t)b * BLOCK;
        sum[b] = ((w[0] + w[1]) + (w[2] + w[3])) + ((w[4] + w[5]) + (w[6] + w[7]));
        total += sum[b];
    }
    return total;
}

static double within_unit(double u)
{
    const double least = 0x1p-33, most = 1.0 - 0x1p-33;
    return u < least ? least : u > most ? most : u;
}

/* The light in whose part of the total the number u falls, and where in the part. What rounding leaves over goes to the
 * last light with a weight. */
static int pick(const float *weight, const float *sum, int blocks, float total, double u, double *rest)
{
    double target = u * (double)total;
    int b = 0, last = -1;
    while (b < blocks - 1 && (target >= (double)sum[b] || !(sum[b] > 0.0f)))
        target -= (double)sum[b++];
    while (!(sum[b] > 0.0f)) /* there is one, as the total is above 0 */
        b--;
    for (int k = b * BLOCK; k < (b + 1) * BLOCK; k++) {
        if (!(weight[k] > 0.0f))
            continue;
        if (last >= 0)
            target -= (double)weight[last];
        last = k;
        if (target < (double)weight[k])
            break;
    }
    *rest = within_unit(target / (double)weight[last]);
    return last;
}

/* A highlight can be bright where the diffuse share is faint, so that it has a part that does not depend on the
 * angle. */
light_estimate light_estimate_of(const material *m)
{
    return (light_estimate){(float)m->diffuse, 0.25f * (float)m->specular, 1.0, DRAW_LIGHT};
}

/* The lights' weights for ray i of the group, and their sums. */
static float weigh(const tracer *t, const light_estimate *by, const lamp_table *lamps, int i, float *each, float *sum)
{
    const surface_batch *at = &t->surface.gathered.points;
    const vec3 point = vec3_make(at->px[i], at->py[i], at->pz[i]);
    const vec3 n = vec3_scale(vec3_make(at->nx[i], at->ny[i], at->nz[i]), by->side);
    const float least = by->side == 0.0 ? -1.0f : 0.0f;
    t->path->light_weights(lamps, point, n, by->k_d, by->k_s, least, each);
    if (lamps->suns)
        apply_suns(t->target.frame_plan, by, n, least, each);
    if (lamps->cones)
        apply_cones(t->target.frame_plan, point, each);
    return add_up(each, lamps->blocks, sum);
}

static bool is_usable(float total)
{
    return total > 0.0f && total < HUGE_VALF;
}

void light_choice_make(const tracer *t, const light_estimate *by, int depth, int *lamp, double *weight, double *u,
                       double *v)
{
    const plan *p = t->target.frame_plan;
    const group *g = &t->surface.gathered;
    lamp_table lamps;
    fill_table(p, &lamps);
    t->path->draw(&p->draws, g->count, g->sample_key, depth, by->purpose, u, v);
    for (int i = 0; i < g->count; i++) {
        float each[LAMPS_MAX], sum[BLOCKS_MAX];
        const float total = weigh(t, by, &lamps, i, each, sum);
        lamp[i] = -1;
        if (!is_usable(total))
            continue;
        lamp[i] = pick(each, sum, lamps.blocks, total, u[i], &u[i]);
        weight[i] = (double)total / (double)each[lamp[i]];
    }
}

double light_choice_chance(const tracer *t, const light_estimate *by, int i, int lamp)
{
    lamp_table lamps;
    float each[LAMPS_MAX], sum[BLOCKS_MAX];
    fill_table(t->target.frame_plan, &lamps);
    const float total = weigh(t, by, &lamps, i, each, sum);
    return is_usable(total) ? (double)each[lamp] / (double)total : 0.0;
}
