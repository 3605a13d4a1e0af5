/* Random points of lights with a size, and the choice of one light for each gathered ray. */
#include "render/shade/light_sampling.h"

#include "base/elementary.h"
#include "render/shade/polarisation.h"
#include "render/shade/shading.h"
#include <math.h>

double area_light_radiance(const plan *p, int lamp, vec3 direction)
{
    const light *l = &p->lights[lamp];
    if (l->kind == LIGHT_SUN) /* irradiance pi I from the projected solid angle pi sin^2 */
        return 1.0 / light_sun_sine2(&p->cones[lamp]);
    if (light_is_flat(l))
        return vec3_dot(direction, p->shapes[lamp].axis) < 0.0 ? lamp_shape_radiance(&p->shapes[lamp], l->reach) : 0.0;
    return l->reach * l->reach / (l->radius * l->radius) *
           light_fraction(l, &p->cones[lamp], vec3_scale(direction, -1.0));
}

double area_light_distance(const plan *p, int lamp, vec3 origin, vec3 direction)
{
    const light *l = &p->lights[lamp];
    if (l->kind == LIGHT_SUN)
        return light_cone_off(&p->cones[lamp], vec3_scale(direction, -1.0)) <= p->cones[lamp].opening
                   ? p->sun_distance
                   : (double)HUGE_VAL;
    if (light_is_flat(l))
        return lamp_shape_hit(&p->shapes[lamp], l->position, origin, direction);
    const vec3 to_light = vec3_sub(l->position, origin);
    const double along = vec3_dot(to_light, direction), distance2 = vec3_dot(to_light, to_light);
    const vec3 across = vec3_sub(to_light, vec3_scale(direction, along));
    const double discriminant = l->radius * l->radius - vec3_dot(across, across);
    if (!(discriminant > 0.0) || distance2 <= l->radius * l->radius)
        return (double)HUGE_VAL;
    return along - sqrt(discriminant);
}

double area_light_density(const plan *p, int lamp, vec3 origin, vec3 direction, double distance)
{
    const light *l = &p->lights[lamp];
    if (l->kind == LIGHT_SUN)
        return 1.0 / (2.0 * LAMP_PI * p->cones[lamp].opening);
    if (light_is_flat(l))
        return distance * distance / (p->shapes[lamp].area * fabs(vec3_dot(direction, p->shapes[lamp].axis)));
    const vec3 to = vec3_sub(l->position, origin);
    const double sine2 = l->radius * l->radius / vec3_dot(to, to), cap = sine2 / (1.0 + sqrt(1.0 - sine2));
    return 1.0 / (2.0 * LAMP_PI * cap);
}

vec3 light_color_of(const tracer *t, int lamp, int64_t sample_key)
{
    const plan *p = t->target.frame_plan;
    const light *l = &p->lights[lamp];
    if (!p->spectral)
        return vec3_scale(l->color, l->intensity);
    const double radiance = spectra_light(p->spectral, sample_key, lamp);
    return vec3_make(radiance, radiance, radiance);
}

double highlight_of(const group *g, int k, const material *m, vec3 to, double n_l)
{
    const vec3 d = vec3_make(g->dx[k], g->dy[k], g->dz[k]);
    const double r_v = 2.0 * n_l * g->points.cos_i[k] + vec3_dot(d, to);
    return m->specular > 0.0 && r_v > 0.0 ? m->specular * elementary_pow(r_v < 1.0 ? r_v : 1.0, m->shininess) : 0.0;
}

void shadow_ray_enqueue(tracer *t, int k, int lamp, vec3 to_light, vec3 color, double diffuse, double shine)
{
    const group *g = &t->surface.gathered;
    ray_queue *q = &t->queues.shadows;
    const int at = q->count++;
    q->ox[at] = g->points.px[k], q->oy[at] = g->points.py[k], q->oz[at] = g->points.pz[k];
    q->dx[at] = to_light.x, q->dy[at] = to_light.y, q->dz[at] = to_light.z;
    q->wr[at] = g->wr[k] * color.x * (diffuse * g->cr[k] + shine);
    q->wg[at] = g->wg[k] * color.y * (diffuse * g->cg[k] + shine);
    q->wb[at] = g->wb[k] * color.z * (diffuse * g->cb[k] + shine);
    q->start[at] = g->points.face[k], q->sample_key[at] = g->sample_key[k], q->inside[at] = g->inside_before[k];
    if (t->target.frame_plan->sheets)
        sheets_shadow_ray(t, lamp, at);
}

/* Enqueues a shadow ray from record k to its sample point on a light's sphere. */
static void enqueue_sphere(tracer *t, int k, const material *m, bool opaque, const lamp_samples *l)
{
    const sphere_samples *s = &l->spheres;
    const group *g = &t->surface.gathered;
    const int lamp = l->lamp[k];
    const vec3 to = vec3_make(s->dx[k], s->dy[k], s->dz[k]);
    const double n_l = s->n_l[k];
    if (!(n_l > 0.0))
        return;
    const double radiance = area_light_radiance(t->target.frame_plan, lamp, to);
    if (radiance == 0.0 || !mesh_lets_out(t, k, to))
        return;
    /* (k_d C / pi) L (N.L) over the density 1 / (2 pi cap), plus Phong's highlight from the same light. */
    const double shine = opaque ? highlight_of(g, k, m, to, n_l) : 0.0;
    const double seen = 2.0 * s->cap[k] * radiance * l->weight[k], diffuse = m->diffuse * n_l;
    const vec3 color = vec3_scale(light_color_of(t, lamp, g->sample_key[k]), seen);
    shadow_ray_enqueue(t, k, lamp, vec3_scale(to, s->reach[k]), color, diffuse, shine);
}

bool light_has_area(const plan *p, int lamp)
{
    return lamp >= 0 && light_has_size(&p->lights[lamp]);
}

/* Whether the light is sampled as a sphere, as suns are, too. */
static bool is_sphere(const plan *p, int lamp)
{
    return light_has_area(p, lamp) && !light_is_flat(&p->lights[lamp]);
}

/* Enqueues a shadow ray from record k to its sample point on a flat lamp: (k_d C / pi) L (N.L) cos_l A / d^2 for points
 * that are uniform over the area A, plus Phong's highlight. */
static void enqueue_flat(tracer *t, int k, const material *m, bool opaque, const lamp_samples *l)
{
    const plan *p = t->target.frame_plan;
    const group *g = &t->surface.gathered;
    const int lamp = l->lamp[k];
    const lamp_shape *s = &p->shapes[lamp];
    const vec3 at = vec3_make(g->points.px[k], g->points.py[k], g->points.pz[k]),
               n = vec3_make(g->points.nx[k], g->points.ny[k], g->points.nz[k]),
               to_light = vec3_sub(lamp_shape_point(s, p->lights[lamp].position, l->spheres.u[k], l->spheres.v[k]), at);
    const double distance2 = vec3_dot(to_light, to_light);
    const vec3 to = vec3_scale(to_light, 1.0 / sqrt(distance2));
    const double n_l = vec3_dot(n, to), cos_l = -vec3_dot(to, s->axis);
    if (!(n_l > 0.0 && cos_l > 0.0) || !mesh_lets_out(t, k, to))
        return;
    const double seen =
        lamp_shape_radiance(s, p->lights[lamp].reach) * cos_l * s->area / (LAMP_PI * distance2) * l->weight[k];
    const vec3 color = vec3_scale(light_color_of(t, lamp, g->sample_key[k]), seen);
    shadow_ray_enqueue(t, k, lamp, to_light, color, m->diffuse * n_l, opaque ? highlight_of(g, k, m, to, n_l) : 0.0);
}

void area_lights_aim_at_spheres(const tracer *t, lamp_samples *l)
{
    const plan *p = t->target.frame_plan;
    const group *g = &t->surface.gathered;
    for (int k = 0; k < g->count; k++) {
        const int lamp = l->lamp[k] < 0 ? 0 : l->lamp[k];
        const light *one = &p->lights[lamp];
        const bool sun = one->kind == LIGHT_SUN; /* a sphere of radius sin(half its angular diameter) at distance 1 */
        const vec3 to = sun ? vec3_scale(p->cones[lamp].axis, -1.0)
                            : vec3_sub(one->position, vec3_make(g->points.px[k], g->points.py[k], g->points.pz[k]));
        l->spheres.x[k] = to.x, l->spheres.y[k] = to.y, l->spheres.z[k] = to.z;
        l->spheres.radius[k] = sun ? sqrt(light_sun_sine2(&p->cones[lamp])) : one->radius;
    }
    t->sampling->spheres(g, &l->spheres);
    for (int k = 0; p->has_sun && k < g->count; k++)
        if (l->lamp[k] >= 0 && p->lights[l->lamp[k]].kind == LIGHT_SUN)
            l->spheres.reach[k] = p->sun_distance;
}

void area_lights_sample(tracer *t, const material *m, bool shines, lamp_samples *l)
{
    const plan *p = t->target.frame_plan;
    area_lights_aim_at_spheres(t, l);
    for (int k = 0; k < t->surface.gathered.count; k++)
        if (is_sphere(p, l->lamp[k]))
            enqueue_sphere(t, k, m, shines, l);
        else if (light_has_area(p, l->lamp[k]))
            enqueue_flat(t, k, m, shines, l);
}

/* Enqueues shadow rays from all records to their sample points on a sphere that is equally bright from all sides. */
static void sample_sphere(tracer *t, const material *m, bool shines, int lamp, lamp_samples *all)
{
    const plan *p = t->target.frame_plan;
    const group *g = &t->surface.gathered;
    const sphere_samples *s = &all->spheres;
    lit_group *l = &t->surface.lit;
    ray_queue *q = &t->queues.shadows;
    const int first = q->count;
    double shine[ROW];
    int list[ROW];
    area_lights_aim_at_spheres(t, all);
    for (int k = 0; k < g->count; k++)
        shine[k] =
            shines && s->n_l[k] > 0.0 ? highlight_of(g, k, m, vec3_make(s->dx[k], s->dy[k], s->dz[k]), s->n_l[k]) : 0.0;
    t->sampling->sphere_light(g, s, area_light_radiance(p, lamp, vec3_make(0.0, 0.0, 1.0)),
                              vec3_scale(p->lights[lamp].color, p->lights[lamp].intensity), m->diffuse, shine, l);
    for (int k = 0; t->surface.on_mesh && k < g->count; k++)
        l->contributes[k] &= -(int64_t)mesh_lets_out(t, k, vec3_make(s->dx[k], s->dy[k], s->dz[k]));
    const new_rays rays = {l->lx,         l->ly,         l->lz, l->r, l->g, l->b, NULL, g->inside_before,
                           g->sample_key, l->contributes};
    t->grouping->append(g, &rays, list, q);
    for (int at = first; p->sheets && at < q->count; at++)
        sheets_shadow_ray(t, lamp, at);
}

void area_lights_sample_all(tracer *t, const material *m, bool shines, int depth)
{
    const plan *p = t->target.frame_plan;
    const group *g = &t->surface.gathered;
    lamp_samples all;
    for (int lamp = 0; lamp < p->light_count; lamp++) {
        if (!light_has_area(p, lamp))
            continue;
        for (int k = 0; k < g->count; k++)
            all.lamp[k] = lamp, all.weight[k] = 1.0;
        t->sampling->draw(&p->draws, g->count, g->sample_key, depth, DRAW_LIGHT + lamp, all.spheres.u, all.spheres.v);
        if (is_sphere(p, lamp) && !light_has_cone(&p->lights[lamp]) && !p->spectral)
            sample_sphere(t, m, shines, lamp, &all);
        else
            area_lights_sample(t, m, shines, &all);
    }
}

void area_lights_soften(tracer *t, int depth)
{
    const material *m = &t->surface.mat->surface;
    const bool shines = t->target.frame_plan->render.lighting != LIGHTING_LAMBERT && m->specular > 0.0;
    if (!(m->diffuse > 0.0) && !shines)
        return;
    radiance_weigh(t);
    area_lights_sample_all(t, m, shines, depth);
    radiance_weigh_back(t);
}

/* --- the choice of one light --- */

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

/* Applies the exact fraction of cone lights that are points. */
static void apply_cones(const plan *p, vec3 point, float *weight)
{
    for (int k = 0; k < p->light_count; k++) {
        const light *l = &p->lights[k];
        if (light_has_cone(l) && light_extent(l) == 0.0 && weight[k] > 0.0f)
            weight[k] *= (float)light_fraction(l, &p->cones[k], vec3_normalize(vec3_sub(point, l->position)));
    }
}

/* Weights a sun as light_weights does a sphere of radius sin a at distance 1, so that the weight does not depend on the
 * distance at which its shadow rays end. */
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

/* Sums the weights of each block; returns the sum of all. */
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

/* Inverts the cumulative weights: the light whose interval of the total contains u, and the position within the
 * interval in *rest. If rounding leaves u beyond all intervals, it is the last light with a weight. */
static int pick(const float *weight, const float *sum, int blocks, float total, double u, double *rest)
{
    double target = u * (double)total;
    int b = 0, last = -1;
    while (b < blocks - 1 && (target >= (double)sum[b] || !(sum[b] > 0.0f)))
        target -= (double)sum[b++];
    while (!(sum[b] > 0.0f)) /* ends, because the total is above 0 */
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

/* A highlight can be bright where diffuse light is faint, so that k_s has no cosine. */
light_estimate light_estimate_of(const material *m)
{
    return (light_estimate){(float)m->diffuse, 0.25f * (float)m->specular, 1.0, DRAW_LIGHT};
}

/* The lights' weights for ray i of the group, and their sums. */
static float weigh(const tracer *t, const light_estimate *by, const lamp_table *lamps, int i, float *weights,
                   float *sum)
{
    const surface_batch *at = &t->surface.gathered.points;
    const vec3 point = vec3_make(at->px[i], at->py[i], at->pz[i]);
    const vec3 n = vec3_scale(vec3_make(at->nx[i], at->ny[i], at->nz[i]), by->side);
    const float least = by->side == 0.0 ? -1.0f : 0.0f;
    t->sampling->light_weights(lamps, point, n, by->k_d, by->k_s, least, weights);
    if (lamps->suns)
        apply_suns(t->target.frame_plan, by, n, least, weights);
    if (lamps->cones)
        apply_cones(t->target.frame_plan, point, weights);
    return add_up(weights, lamps->blocks, sum);
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
    t->sampling->draw(&p->draws, g->count, g->sample_key, depth, by->purpose, u, v);
    for (int i = 0; i < g->count; i++) {
        float weights[LAMPS_MAX], sum[BLOCKS_MAX];
        const float total = weigh(t, by, &lamps, i, weights, sum);
        lamp[i] = -1;
        if (!is_usable(total))
            continue;
        lamp[i] = pick(weights, sum, lamps.blocks, total, u[i], &u[i]);
        weight[i] = (double)total / (double)weights[lamp[i]];
    }
}

double light_choice_chance(const tracer *t, const light_estimate *by, int i, int lamp)
{
    lamp_table lamps;
    float weights[LAMPS_MAX], sum[BLOCKS_MAX];
    fill_table(t->target.frame_plan, &lamps);
    const float total = weigh(t, by, &lamps, i, weights, sum);
    return is_usable(total) ? (double)weights[lamp] / (double)total : 0.0;
}
