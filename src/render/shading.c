/* What becomes of rays that met a surface: local light, shadow rays, reflected and refracted children, and the film. */
#include "render/tracer_private.h"

#include "render/sky.h"

/* Is it in the film's range? Not if it is no number. */
static inline bool is_exposable(double radiance)
{
    const double limit = 262144.0; /* half of what a channel holds */
    return (int)(radiance >= 0.0) & (int)(radiance < limit);
}

static inline int64_t in_film_units(double radiance)
{
    return (int64_t)(radiance * FILM_ONE + 0.5);
}

static inline void expose(tracer *t, int64_t pixel, double r, double g, double b)
{
    if (!((int)is_exposable(r) & (int)is_exposable(g) & (int)is_exposable(b))) {
        t->overflow = -1;
        return;
    }
    int64_t *sum = &t->target.picture->sum[pixel * 3];
    const int64_t red = (int64_t)((uint64_t)sum[0] + (uint64_t)in_film_units(r));
    const int64_t green = (int64_t)((uint64_t)sum[1] + (uint64_t)in_film_units(g));
    const int64_t blue = (int64_t)((uint64_t)sum[2] + (uint64_t)in_film_units(b));
    sum[0] = red, sum[1] = green, sum[2] = blue;
    t->overflow |= red | green | blue;
}

void shading_expose(tracer *t, int64_t pixel, double r, double g, double b)
{
    expose(t, pixel, r, g, b);
}

void shading_expose_sky(tracer *t, int64_t pixel, vec3 direction, double wr, double wg, double wb)
{
    const background *sky = t->target.scene->sky;
    const vec3 l = sky->kind == BACKGROUND_UNIFORM ? sky->color : sky_radiance(sky, direction);
    expose(t, pixel, wr * l.x, wg * l.y, wb * l.z);
}

static void expose_ambient(tracer *t, const material *m)
{
    const group *g = &t->gathered;
    vec3 a = vec3_scale(t->target.scene->sky->ambient, m->ambient);
    for (int i = 0; i < g->count; i++)
        expose(t, g->pixel[i], g->wr[i] * a.x * g->cr[i], g->wg[i] * a.y * g->cg[i], g->wb[i] * a.z * g->cb[i]);
}

/* A shadow ray is worth its while only if its light can change the film. */
static void put_shadow_rays_in_line(tracer *t)
{
    const group *g = &t->gathered;
    const lit_group *l = &t->lit;
    ray_queue *q = &t->shadows;
    int worth[ROW], count = 0;
    for (int i = 0; i < g->count; i++) {
        worth[count] = i;
        count -= (int)l->shows[i];
    }
    for (int k = 0; k < count; k++) {
        const int i = worth[k], at = q->count++;
        q->ox[at] = g->points.px[i], q->oy[at] = g->points.py[i], q->oz[at] = g->points.pz[i];
        q->dx[at] = l->lx[i], q->dy[at] = l->ly[i], q->dz[at] = l->lz[i];
        q->wr[at] = l->r[i], q->wg[at] = l->g[i], q->wb[at] = l->b[i];
        q->start[at] = g->points.face[i], q->pixel[at] = g->pixel[i], q->inside[at] = g->inside_before[i];
    }
}

static void local_light(tracer *t, const material *m)
{
    const plan *p = t->target.scene;
    if (m->ambient > 0.0)
        expose_ambient(t, m);
    if (m->diffuse == 0.0 && m->specular == 0.0)
        return;
    for (int k = 0; k < p->light_count; k++) {
        t->shade->direct(m, &p->lights[k], &t->gathered, &t->lit);
        if (p->render.shadows != SHADOWS_OFF) {
            put_shadow_rays_in_line(t);
            continue;
        }
        for (int i = 0; i < t->gathered.count; i++)
            expose(t, t->gathered.pixel[i], t->lit.r[i], t->lit.g[i], t->lit.b[i]);
    }
}

/* Branches that the depth limit cuts off: counted, and given what lies beyond it. */
static void cut_branches(tracer *t)
{
    const group *g = &t->gathered;
    const branch_group *b = &t->branches;
    const plan *p = t->target.scene;
    if (CUVETTE_COUNTERS) {
        cut_sum sum;
        t->shade->cut(g, b, &sum);
        t->counters.cut_depth += (uint64_t)sum.branches;
        for (int c = 0; c < 3; c++)
            t->counters.cut_depth_throughput[c] += sum.throughput[c];
    }
    if (p->render.beyond == BEYOND_BLACK)
        return;
    const bool uniform = p->sky->kind == BACKGROUND_UNIFORM; /* then directions do not matter */
    for (int i = 0; i < g->count; i++) {
        const double first = uniform ? b->reflect[i] + b->refract[i] : b->reflect[i], second = uniform ? 0.0 : b->refract[i];
        if (first > 0.0)
            shading_expose_sky(t, g->pixel[i], vec3_make(b->rx[i], b->ry[i], b->rz[i]), g->wr[i] * first, g->wg[i] * first, g->wb[i] * first);
        if (second > 0.0)
            shading_expose_sky(t, g->pixel[i], vec3_make(b->tx[i], b->ty[i], b->tz[i]), g->wr[i] * second, g->wg[i] * second, g->wb[i] * second);
    }
}

static bool too_light(tracer *t, const ray_queue *q, int i, double least)
{
    if (q->wr[i] >= least || q->wg[i] >= least || q->wb[i] >= least)
        return false;
    COUNT(t->counters.cut_weight++);
    COUNT(t->counters.cut_weight_throughput[0] += counters_cut_units(q->wr[i]));
    COUNT(t->counters.cut_weight_throughput[1] += counters_cut_units(q->wg[i]));
    COUNT(t->counters.cut_weight_throughput[2] += counters_cut_units(q->wb[i]));
    return true;
}

/* Puts a kind of children in line: all of them at once, then the last one into each hole of those that do not exist or weigh
 * too little. Returns how many there are. */
static int put_children_in_line(tracer *t, int depth, const double *dx, const double *dy, const double *dz, const double *weight,
                                const uint64_t *inside)
{
    ray_queue *q = &t->waiting[depth];
    const double least = t->target.scene->render.min_weight;
    const int first = q->count;
    t->shade->append(&t->gathered, dx, dy, dz, weight, inside, q);
    for (int i = t->gathered.count - 1; i >= 0; i--)
        if (weight[i] == 0.0 || (least > 0.0 && too_light(t, q, first + i, least)))
            queue_move(q, first + i, --q->count);
    return q->count - first;
}

static void branch(tracer *t, int depth, const material *m, bool opaque)
{
    const plan *p = t->target.scene;
    group *g = &t->gathered;
    branch_group *b = &t->branches;
    if (opaque && m->reflectivity == 0.0)
        return;
    if (opaque || p->render.weights == WEIGHTS_CONSTANT)
        t->shade->constant_branches(m, opaque, g, b);
    else
        t->shade->fresnel_branches(m, g, b);
    if (!opaque)
        COUNT(t->counters.total_internal += (uint64_t)b->total);
    if (depth == t->depth_limit) {
        cut_branches(t);
        return;
    }
    int reflected = put_children_in_line(t, depth + 1, b->rx, b->ry, b->rz, b->reflect, g->inside_before);
    int refracted = put_children_in_line(t, depth + 1, b->tx, b->ty, b->tz, b->refract, g->inside_after);
    COUNT(t->counters.reflect += (uint64_t)reflected);
    COUNT(t->counters.refract += (uint64_t)refracted);
}

void shading_group(tracer *t, int depth, int first, int met, int rank, const int *list, int count)
{
    const plan *p = t->target.scene;
    const primitive *surface = &p->solids->primitives[met];
    const material *m = p->materials[rank];
    group *g = &t->gathered;
    group_gather(&t->waiting[depth], first, &t->hits, p->ior, list, count, g);
    const ray_batch rays = {g->padded, g->ox, g->oy, g->oz, g->dx, g->dy, g->dz, g->start, g->inside_before};
    t->geometry->surface(surface, &rays, g->t, met, &g->points);
    const int owner = p->solids->bodies[rank].solid;
    COUNT(t->counters.hits[owner] += (uint64_t)count);
    if (depth == 0)
        COUNT(t->counters.first_hits[owner] += (uint64_t)count);
    t->shade->color(m, surface, g);
    local_light(t, m);
    branch(t, depth, m, p->solids->bodies[rank].opaque);
}
