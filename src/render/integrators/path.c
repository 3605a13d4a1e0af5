/* Path tracing (Kajiya, "The Rendering Equation", SIGGRAPH 1986): at each surface one continuation is sampled at
 * random, weighted so that the mean over all paths is that of the whole tree. Sampling by surface:
 *   a clear surface  reflects or refracts with Fresnel's weights as probabilities, so the throughput stays the same;
 *   a matte surface  is lit by every light, at a point of the light's sphere sampled uniformly over the cone of
 *                    directions to it (Shirley, Wang and Zimmerman, "Monte Carlo Techniques for Direct Lighting
 *                    Calculations", TOG 15(1), 1996), and continues the path by the cosine law, or like a mirror
 *                    with its reflectivity.
 * Only rays from the camera and from specular surfaces hit light spheres: matte surfaces have sampled them directly.
 * This is how light through a vessel makes caustics. In a scene with light spheres, clear solids block point lights
 * too. A light's radiance is intensity (reach / radius)^2, so that a matte surface at its reach is as bright as in
 * Phong's model. There is no ambient term: light from the sky and from other surfaces replaces it. */
#include "render/shade/shading.h"

#include "base/elementary.h"
#include "optics/mueller.h"
#include <string.h>

/* Below this depth every path continues; from it on faint paths end by Russian roulette. */
enum { ROULETTE_DEPTH = 3 };

/* Radiance of a light's sphere towards a ray along a unit vector, for a colour of 1. For a cone light each point of the
 * sphere emits only into the cone, so that from far away it is the cone of a point. */
static double radiance_along(const plan *p, int lamp, vec3 direction)
{
    const light *l = &p->lights[lamp];
    return l->reach * l->reach / (l->radius * l->radius) * light_share(l, &p->cones[lamp], vec3_scale(direction, -1.0));
}

static vec3 light_color(const tracer *t, int lamp, int64_t sample_key)
{
    const plan *p = t->target.frame_plan;
    const light *l = &p->lights[lamp];
    if (!p->spectral)
        return vec3_scale(l->color, l->intensity);
    const double radiance = spectra_light(p->spectral, sample_key, lamp);
    return vec3_make(radiance, radiance, radiance);
}

/* Distance at which the ray hits the sphere from outside, or HUGE_VAL. */
static double distance_to_light(const light *l, vec3 origin, vec3 direction)
{
    const vec3 to_light = vec3_sub(l->position, origin);
    const double along = vec3_dot(to_light, direction);
    const vec3 across = vec3_sub(to_light, vec3_scale(direction, along));
    const double discriminant = l->radius * l->radius - vec3_dot(across, across);
    if (!(discriminant > 0.0) || vec3_dot(to_light, to_light) <= l->radius * l->radius || along <= 0.0)
        return (double)HUGE_VAL;
    return along - sqrt(discriminant);
}

/* Clips the medium segments of a ray at the light. */
static void clip_segments(medium_segments *w, int ray, double end)
{
    double start = 0.0;
    for (int k = 0; w && k < w->count; k++) {
        medium_segment *one = &w->segment[k];
        if (one->ray != ray)
            continue;
        const double length = one->length;
        one->length = start + length <= end ? length : start < end ? end - start : 0.0;
        start += length;
    }
}

/* Rays that end at a light's sphere have its number encoded in hits.hit_primitive. */
static int64_t mark_of(int lamp)
{
    return -2 - lamp;
}

static int lamp_of(int64_t hit_primitive)
{
    return (int)(-2 - hit_primitive);
}

static void intersect_lights(tracer *t, const ray_queue *q, int first, int i)
{
    const plan *p = t->target.frame_plan;
    const int at = first + i;
    double nearest = t->batch.hits.t[i];
    int nearest_lamp = -1;
    for (int k = 0; k < p->light_count && q->sample_key[at] & SAMPLE_KEY_SPECULAR_BOUNCE; k++) {
        if (p->lights[k].radius == 0.0)
            continue;
        const vec3 origin = vec3_make(q->ox[at], q->oy[at], q->oz[at]);
        const double distance = distance_to_light(&p->lights[k], origin, vec3_make(q->dx[at], q->dy[at], q->dz[at]));
        if (distance < nearest) {
            nearest = distance;
            nearest_lamp = k;
        }
    }
    if (nearest_lamp < 0)
        return;
    t->batch.hits.hit_primitive[i] = mark_of(nearest_lamp);
    clip_segments(t->batch.scratch.segments, i, nearest);
}

static void intersect(tracer *t, ray_queue *q, int first, int depth, const ray_batch *rays)
{
    intersect_nearest(t, q, first, depth, rays);
    for (int i = 0; i < rays->count; i++)
        intersect_lights(t, q, first, i);
}

static void expose_light(tracer *t, const ray_queue *q, int at, int lamp, int priority_index)
{
    const plan *p = t->target.frame_plan;
    const int64_t sample_key = q->sample_key[at];
    const double radiance = radiance_along(p, lamp, vec3_make(q->dx[at], q->dy[at], q->dz[at])) *
                            (p->basic ? radiance_share(p, sample_key, priority_index) : 1.0);
    const vec3 l = vec3_scale(light_color(t, lamp, sample_key), radiance);
    shading_expose(t, sample_key, q->wr[at] * l.x, q->wg[at] * l.y, q->wb[at] * l.z);
}

static void expose_background(tracer *t, const ray_queue *q, int first, const int *list, int count)
{
    for (int k = 0; k < count; k++) {
        const int i = list[k];
        const int64_t hit = t->batch.hits.hit_primitive[i];
        if (hit == -1)
            background_sky(t, q, first, &i, 1);
        else
            expose_light(t, q, first + i, lamp_of(hit), (int)t->batch.hits.before[i]);
    }
}

/* A unit vector at an angle from the axis, given by its cosine and sine; turn: azimuth as a share of a full turn. */
static vec3 direction_about(vec3 axis, double cosine, double sine, double turn)
{
    vec3 x, y;
    double s, c;
    polarisation_frame(axis, &x, &y);
    elementary_sincos_deg(360.0 * turn, &s, &c);
    const vec3 across = vec3_add(vec3_scale(x, sine * c), vec3_scale(y, sine * s));
    return vec3_normalize(vec3_add(vec3_scale(axis, cosine), across));
}

/* Enqueues a shadow ray from record k of the group to a random point of a light's sphere. */
static void sample_light(tracer *t, int k, const material *m, bool opaque, int lamp, int depth)
{
    const plan *p = t->target.frame_plan;
    const group *g = &t->surface.gathered;
    const light *l = &p->lights[lamp];
    const vec3 point = vec3_make(g->points.px[k], g->points.py[k], g->points.pz[k]);
    const vec3 n = vec3_make(g->points.nx[k], g->points.ny[k], g->points.nz[k]),
               to_light = vec3_sub(l->position, point);
    const double distance2 = vec3_dot(to_light, to_light), share2 = l->radius * l->radius / distance2;
    if (share2 >= 1.0)
        return;
    /* cap = 1 - least_cos, without cancellation. */
    const double least_cos = sqrt(1.0 - share2), cap = share2 / (1.0 + least_cos);
    const unit_pair drawn = path_draw(&p->draws, g->sample_key[k], depth, DRAW_LIGHT + lamp);
    const double below = drawn.u * cap, cosine = 1.0 - below, sine = sqrt(below * (2.0 - below));
    const vec3 to = direction_about(vec3_scale(to_light, 1.0 / sqrt(distance2)), cosine, sine, drawn.v);
    const double n_l = vec3_dot(n, to), radiance = radiance_along(p, lamp, to),
                 within = l->radius * l->radius - distance2 * sine * sine;
    if (!(n_l > 0.0) || radiance == 0.0 || !mesh_lets_out(t, k, to))
        return;
    const double reach = sqrt(distance2) * cosine - sqrt(within > 0.0 ? within : 0.0);
    /* (k_d C / pi) L (N.L) over the density 1 / (2 pi (1 - least_cos)), plus Phong's highlight from the same light. */
    const vec3 d = vec3_make(g->dx[k], g->dy[k], g->dz[k]);
    const double r_v = 2.0 * n_l * g->points.cos_i[k] + vec3_dot(d, to);
    const double shine = opaque && m->specular > 0.0 && r_v > 0.0
                             ? m->specular * elementary_pow(r_v < 1.0 ? r_v : 1.0, m->shininess)
                             : 0.0;
    const double seen = 2.0 * cap * radiance, diffuse = m->diffuse * n_l;
    const vec3 color = vec3_scale(light_color(t, lamp, g->sample_key[k]), seen);
    ray_queue *q = &t->queues.shadows;
    const int at = q->count++;
    q->ox[at] = point.x, q->oy[at] = point.y, q->oz[at] = point.z;
    q->dx[at] = to.x * reach, q->dy[at] = to.y * reach, q->dz[at] = to.z * reach;
    q->wr[at] = g->wr[k] * color.x * (diffuse * g->cr[k] + shine);
    q->wg[at] = g->wg[k] * color.y * (diffuse * g->cg[k] + shine);
    q->wb[at] = g->wb[k] * color.z * (diffuse * g->cb[k] + shine);
    q->start[at] = g->points.face[k], q->sample_key[at] = g->sample_key[k], q->inside[at] = g->inside_before[k];
}

/* The continuation of a path: direction, throughput factor by channel, and media. */
typedef struct continuation {
    vec3 direction, share;
    uint64_t inside;
    bool refracted, specular_bounce;
} continuation;

static bool draw_clear(const tracer *t, int k, double chance, continuation *c)
{
    const branch_group *b = &t->surface.branches;
    const double both = b->reflect[k] + b->refract[k];
    if (!(both > 0.0))
        return false;
    c->refracted = chance * both >= b->reflect[k] && b->refract[k] > 0.0;
    c->direction = c->refracted ? vec3_make(b->tx[k], b->ty[k], b->tz[k]) : vec3_make(b->rx[k], b->ry[k], b->rz[k]);
    c->inside = c->refracted ? t->surface.gathered.inside_after[k] : t->surface.gathered.inside_before[k];
    c->share = vec3_make(both, both, both);
    c->specular_bounce = true;
    return true;
}

static bool draw_matte(const tracer *t, const material *m, int k, int depth, double chance, continuation *c)
{
    const group *g = &t->surface.gathered;
    const double brightest = fmax(g->cr[k], fmax(g->cg[k], g->cb[k])), matte = m->diffuse * brightest,
                 mirror = m->reflectivity;
    if (!(matte + mirror > 0.0))
        return false;
    const bool mirrored = chance * (matte + mirror) < mirror;
    const double odds = (mirrored ? mirror : matte) / (matte + mirror);
    c->inside = g->inside_before[k];
    c->refracted = false;
    c->specular_bounce = mirrored;
    if (mirrored) {
        c->direction = vec3_make(t->surface.branches.rx[k], t->surface.branches.ry[k], t->surface.branches.rz[k]);
        c->share = vec3_make(mirror / odds, mirror / odds, mirror / odds);
        return true;
    }
    const unit_pair drawn = path_draw(&t->target.frame_plan->draws, g->sample_key[k], depth, DRAW_DIRECTION);
    const double sine2 = drawn.u;
    const vec3 n = vec3_make(g->points.nx[k], g->points.ny[k], g->points.nz[k]);
    c->direction = direction_about(n, sqrt(1.0 - sine2), sqrt(sine2), drawn.v);
    c->share = vec3_scale(vec3_make(g->cr[k], g->cg[k], g->cb[k]), m->diffuse / odds);
    return mesh_lets_out(t, k, c->direction);
}

/* Russian roulette: ends a faint path at random; the survivors take over its weight. */
static bool survives(const tracer *t, int k, int depth, vec3 *share)
{
    const render_settings *r = &t->target.frame_plan->render;
    const group *g = &t->surface.gathered;
    if (!r->roulette || depth < ROULETTE_DEPTH)
        return true;
    const double weight = fmax(g->wr[k] * share->x, fmax(g->wg[k] * share->y, g->wb[k] * share->z)) * (double)r->paths;
    if (weight >= 1.0)
        return true;
    if (path_draw(&t->target.frame_plan->draws, g->sample_key[k], depth, DRAW_ROULETTE).u >= weight)
        return false;
    *share = vec3_scale(*share, 1.0 / weight);
    return true;
}

static void cut(tracer *t, int k, const continuation *c)
{
    const group *g = &t->surface.gathered;
    const double r = g->wr[k] * c->share.x, gr = g->wg[k] * c->share.y, b = g->wb[k] * c->share.z;
    COUNT(t->account.counters.cut_depth++);
    COUNT(t->account.counters.cut_depth_throughput[0] += counters_cut_units(r));
    COUNT(t->account.counters.cut_depth_throughput[1] += counters_cut_units(gr));
    COUNT(t->account.counters.cut_depth_throughput[2] += counters_cut_units(b));
    shading_expose_at_depth_limit(t, g->sample_key[k], c->direction, r, gr, b);
}

static void go_on(tracer *t, int k, int depth, const continuation *c)
{
    const group *g = &t->surface.gathered;
    ray_queue *q = &t->queues.waiting[depth + 1];
    const int at = q->count++;
    q->ox[at] = g->points.px[k], q->oy[at] = g->points.py[k], q->oz[at] = g->points.pz[k];
    q->dx[at] = c->direction.x, q->dy[at] = c->direction.y, q->dz[at] = c->direction.z;
    q->wr[at] = g->wr[k] * c->share.x, q->wg[at] = g->wg[k] * c->share.y, q->wb[at] = g->wb[k] * c->share.z;
    q->start[at] = g->points.face[k], q->inside[at] = c->inside;
    q->sample_key[at] =
        (g->sample_key[k] & ~SAMPLE_KEY_SPECULAR_BOUNCE) | (c->specular_bounce ? SAMPLE_KEY_SPECULAR_BOUNCE : 0);
    COUNT(c->refracted ? t->account.counters.refract++ : t->account.counters.reflect++);
}

static void continue_one(tracer *t, const material *m, bool opaque, int k, int depth)
{
    const double chance =
        path_draw(&t->target.frame_plan->draws, t->surface.gathered.sample_key[k], depth, DRAW_BRANCH).u;
    continuation c = {.refracted = false};
    if (!(opaque ? draw_matte(t, m, k, depth, chance, &c) : draw_clear(t, k, chance, &c)))
        return;
    if (depth == t->queues.depth_limit)
        cut(t, k, &c);
    else if (survives(t, k, depth, &c.share))
        go_on(t, k, depth, &c);
}

static void shade(tracer *t, int depth, int priority_index)
{
    const plan *p = t->target.frame_plan;
    const material *m = &t->surface.mat->surface;
    const bool opaque = surface_is_opaque(t, priority_index), lit = m->diffuse > 0.0 || (opaque && m->specular > 0.0);
    local_light(t, priority_index, (light_terms){.highlights = true}); /* of point lights; spheres follow */
    radiance_weigh(t);
    for (int k = 0; lit && k < t->surface.gathered.count; k++)
        for (int lamp = 0; lamp < p->light_count; lamp++)
            if (p->lights[lamp].radius > 0.0)
                sample_light(t, k, m, opaque, lamp, depth);
    radiance_weigh_back(t);
    shading_branches(t, opaque);
    for (int k = 0; k < t->surface.gathered.count; k++)
        continue_one(t, m, opaque, k, depth);
}

/* Through the centres of cells: with fewer paths than samples there are fewer cells, because with only the first rows
 * of the grid the image would shift. */
static camera_sampling paths_of(const render_settings *r)
{
    const int64_t points = r->paths < r->samples ? r->paths : r->samples;
    return (camera_sampling){.rays = r->paths,
                             .points = points,
                             .together = 1,
                             .jittered = r->filter == PIXEL_FILTER_BOX,
                             .marks = SAMPLE_KEY_SPECULAR_BOUNCE};
}

static int shares(const render_settings *r)
{
    return (int)path_sampling_of(r).replicates;
}

const integrator integrator_of_path = {.traced = true,
                                       .by_sample = true,
                                       .sampling = paths_of,
                                       .shares = shares,
                                       .intersect = intersect,
                                       .background = expose_background,
                                       .shade = shade};
