/* Rays of random paths: shadow rays to lamps; and continuations, which are enqueued for the next depth unless Russian
 * roulette or the depth limit ends them. */
#include "render/integrators/path.h"

#include "base/lanes.h"
#include "render/shade/exposure.h"
#include "render/shade/polarisation.h"
#include "render/shade/shading.h"

/* --- points of lamps as seen from the gathered group, and shadow rays to them --- */

#define PI 3.14159265358979323846

void path_lamp_samples(tracer *t, int lamp, int depth, lamp_samples *s)
{
    const plan *p = t->target.frame_plan;
    const group *g = &t->surface.gathered;
    for (int k = 0; k < g->count; k++)
        s->lamp[k] = lamp, s->weight[k] = 1.0;
    if (light_has_area(p, lamp)) {
        t->sampling->draw(&p->draws, g->count, g->sample_key, depth, DRAW_LIGHT + lamp, s->spheres.u, s->spheres.v);
        area_lights_aim_at_spheres(t, s);
    }
}

bool path_lamp_is_outside(const plan *p, const lamp_samples *s, int k)
{
    return s->lamp[k] >= 0 &&
           (!light_has_area(p, s->lamp[k]) || light_is_flat(&p->lights[s->lamp[k]]) || s->spheres.cap[k] > 0.0);
}

static lamp_aim at_flat(const plan *p, const lamp_samples *s, int lamp, int k, vec3 from)
{
    const vec3 to =
        vec3_sub(lamp_shape_point(&p->shapes[lamp], p->lights[lamp].position, s->spheres.u[k], s->spheres.v[k]), from);
    lamp_aim a = {.distance = vec3_length(to)};
    a.to = vec3_scale(to, 1.0 / a.distance);
    a.light = area_light_radiance(p, lamp, a.to);
    a.density = area_light_density(p, lamp, from, a.to, a.distance) / s->weight[k];
    return a;
}

static lamp_aim at_point(const plan *p, const lamp_samples *s, int lamp, int k, vec3 from)
{
    const light *l = &p->lights[lamp];
    const vec3 to = light_towards(l, from);
    lamp_aim a = {.distance = vec3_length(to)};
    a.to = vec3_scale(to, 1.0 / a.distance);
    const double falls = l->reach / a.distance;
    a.light = PI * s->weight[k] * (l->reach > 0.0 ? falls * falls : 1.0) *
              light_fraction(l, &p->cones[lamp], vec3_scale(a.to, -1.0));
    return a;
}

lamp_aim path_lamp_aim(const tracer *t, const lamp_samples *s, int k)
{
    const plan *p = t->target.frame_plan;
    const surface_batch *at = &t->surface.gathered.points;
    const vec3 from = vec3_make(at->px[k], at->py[k], at->pz[k]);
    const int lamp = s->lamp[k];
    if (!light_has_area(p, lamp))
        return at_point(p, s, lamp, k, from);
    if (light_is_flat(&p->lights[lamp]))
        return at_flat(p, s, lamp, k, from);
    const vec3 to = vec3_make(s->spheres.dx[k], s->spheres.dy[k], s->spheres.dz[k]);
    return (lamp_aim){.to = to,
                      .distance = s->spheres.reach[k],
                      .light = area_light_radiance(p, lamp, to),
                      .density = 1.0 / (2.0 * PI * s->spheres.cap[k] * s->weight[k])};
}

double path_lamp_ahead(const plan *p, int lamp, vec3 origin, vec3 direction, double *distance)
{
    *distance = light_has_area(p, lamp) ? area_light_distance(p, lamp, origin, direction) : (double)HUGE_VAL;
    return *distance > 0.0 && *distance < (double)HUGE_VAL ? area_light_radiance(p, lamp, direction) : 0.0;
}

void path_enqueue_lamp(tracer *t, int k, int lamp, vec3 to_lamp, double index, uint64_t inside, vec3 factor)
{
    const plan *p = t->target.frame_plan;
    const group *g = &t->surface.gathered;
    const int64_t sample_key = g->sample_key[k];
    const vec3 color = vec3_scale(light_color_of(t, lamp, sample_key), radiance_scale_at_index(p, sample_key, index));
    const double r = g->wr[k] * factor.x * color.x, gr = g->wg[k] * factor.y * color.y,
                 b = g->wb[k] * factor.z * color.z;
    if (p->render.shadows == SHADOWS_OFF && !light_has_area(p, lamp)) {
        shading_expose(t, sample_key, r, gr, b);
        return;
    }
    ray_queue *q = &t->queues.shadows;
    const int at = q->count++;
    q->ox[at] = g->points.px[k], q->oy[at] = g->points.py[k], q->oz[at] = g->points.pz[k];
    q->dx[at] = to_lamp.x, q->dy[at] = to_lamp.y, q->dz[at] = to_lamp.z;
    q->wr[at] = r, q->wg[at] = gr, q->wb[at] = b;
    q->start[at] = g->points.face[k], q->sample_key[at] = sample_key;
    q->inside[at] = inside;
    if (p->sheets)
        sheets_shadow_ray(t, lamp, at);
}

/* --- direct light --- */

/* Enqueues a shadow ray from record k to a point light; without shadows, its light is added at once. */
static void sample_point(tracer *t, int k, const material *m, int lamp, double weight)
{
    const plan *p = t->target.frame_plan;
    const group *g = &t->surface.gathered;
    const light *l = &p->lights[lamp];
    const vec3 point = vec3_make(g->points.px[k], g->points.py[k], g->points.pz[k]),
               n = vec3_make(g->points.nx[k], g->points.ny[k], g->points.nz[k]), to_light = light_towards(l, point);
    const double distance2 = vec3_dot(to_light, to_light);
    const vec3 to = vec3_scale(to_light, 1.0 / sqrt(distance2));
    const double n_l = vec3_dot(n, to), fraction = light_fraction(l, &p->cones[lamp], vec3_scale(to, -1.0));
    if (!(n_l > 0.0) || fraction == 0.0 || !mesh_lets_out(t, k, to))
        return;
    const double falloff = l->reach > 0.0 ? l->reach * l->reach / distance2 : 1.0;
    const vec3 color = vec3_scale(light_color_of(t, lamp, g->sample_key[k]), weight * fraction * falloff);
    shadow_ray_enqueue(t, k, lamp, to_light, color, m->diffuse * n_l, highlight_of(g, k, m, to, n_l));
    if (p->render.shadows != SHADOWS_OFF)
        return;
    ray_queue *q = &t->queues.shadows;
    const int at = --q->count;
    shading_expose(t, q->sample_key[at], q->wr[at], q->wg[at], q->wb[at]);
}

/* Samples all lights from every record; point lights first, which need no random numbers. */
static void sample_all(tracer *t, const material *m, bool opaque, int priority_index, int depth)
{
    const bool lit = m->diffuse > 0.0 || (opaque && m->specular > 0.0);
    local_light(t, priority_index, (light_terms){.highlights = true});
    radiance_weigh(t);
    if (lit)
        area_lights_sample_all(t, m, opaque, depth);
    radiance_weigh_back(t);
}

static void sample_one(tracer *t, const material *m, bool opaque, int priority_index, int depth)
{
    const plan *p = t->target.frame_plan;
    lamp_samples one;
    local_light(t, priority_index, (light_terms){.emission_only = true});
    if (m->diffuse == 0.0 && m->specular == 0.0)
        return;
    const light_estimate by = light_estimate_of(m);
    light_choice_make(t, &by, depth, one.lamp, one.weight, one.spheres.u, one.spheres.v);
    radiance_weigh(t);
    for (int k = 0; k < t->surface.gathered.count; k++)
        if (one.lamp[k] >= 0 && !light_has_area(p, one.lamp[k]))
            sample_point(t, k, m, one.lamp[k], one.weight[k]);
    if (m->diffuse > 0.0 || opaque)
        area_lights_sample(t, m, opaque, &one);
    radiance_weigh_back(t);
}

/* Light that is interpolated between the corners of triangles always comes from all lights. */
void path_sample_lights(tracer *t, int priority_index, int depth)
{
    const material *m = &t->surface.mat->surface;
    const bool opaque = surface_is_opaque(t, priority_index);
    if (light_choice_applies(t->target.frame_plan) && !mesh_has_corner_light(t, priority_index))
        sample_one(t, m, opaque, priority_index, depth);
    else
        sample_all(t, m, opaque, priority_index, depth);
}

/* --- continuations --- */

/* Below this depth every path continues; from it on faint paths end by Russian roulette. */
enum { ROULETTE_DEPTH = 3 };

static bool has_roulette(const tracer *t, int depth)
{
    return depth >= (t->target.frame_plan->render.roulette ? ROULETTE_DEPTH : DEPTH_DEEP);
}

/* Russian roulette (Arvo and Kirk, "Particle Transport and Image Synthesis", SIGGRAPH 1990): ends a faint path at
 * random; the survivors carry its weight. Deep paths are included whatever render.roulette is. */
static bool survives(const tracer *t, int k, int depth, vec3 *factor)
{
    const group *g = &t->surface.gathered;
    if (!has_roulette(t, depth))
        return true;
    const int64_t paths = path_count(&t->target.frame_plan->draws, sample_key_pixel(g->sample_key[k]));
    /* relative to the weight of a camera ray, which an analyser halves */
    const double camera_weight = t->target.frame_plan->analyser == ANALYSER_NONE ? 1.0 : 0.5;
    const double weight =
        fmax(g->wr[k] * factor->x, fmax(g->wg[k] * factor->y, g->wb[k] * factor->z)) * ((double)paths / camera_weight);
    const double odds = fmin(weight, roulette_odds_most(depth));
    if (odds >= 1.0)
        return true;
    if (path_draw(&t->target.frame_plan->draws, g->sample_key[k], depth, DRAW_ROULETTE).u >= odds)
        return false;
    *factor = vec3_scale(*factor, 1.0 / odds);
    return true;
}

static void cut(tracer *t, int k, const continuation *c)
{
    const group *g = &t->surface.gathered;
    const double r = g->wr[k] * c->factor.x, gr = g->wg[k] * c->factor.y, b = g->wb[k] * c->factor.z;
    count_cut_by_depth(t, g->sample_key[k], r, gr, b);
    shading_expose_at_depth_limit(t, g->sample_key[k], c->direction, r, gr, b);
}

static void enqueue_continuation(tracer *t, int k, int depth, const continuation *c)
{
    const group *g = &t->surface.gathered;
    ray_queue *q = tracer_queue_at(t, depth + 1);
    const int at = q->count++;
    q->ox[at] = g->points.px[k], q->oy[at] = g->points.py[k], q->oz[at] = g->points.pz[k];
    q->dx[at] = c->direction.x, q->dy[at] = c->direction.y, q->dz[at] = c->direction.z;
    q->wr[at] = g->wr[k] * c->factor.x, q->wg[at] = g->wg[k] * c->factor.y, q->wb[at] = g->wb[k] * c->factor.z;
    q->start[at] = g->points.face[k], q->inside[at] = c->inside;
    if (t->target.frame_plan->render.polarisation)
        q->sq[at] = c->q, q->su[at] = c->u, q->sv[at] = c->v;
    const bool photons = t->target.frame_plan->photons != NULL;
    const int64_t left_matte = g->sample_key[k] | (c->matte && photons ? SAMPLE_KEY_PHOTONS : 0);
    const bool meets_lights = c->specular_bounce && !(left_matte & SAMPLE_KEY_PHOTONS);
    q->sample_key[at] = (left_matte & ~SAMPLE_KEY_SPECULAR_BOUNCE) | (meets_lights ? SAMPLE_KEY_SPECULAR_BOUNCE : 0);
    COUNT(c->refracted ? t->account.counters.refract++ : t->account.counters.reflect++);
}

void path_continue(tracer *t, int k, int depth, continuation *c)
{
    if (depth == t->queues.depth_limit)
        cut(t, k, c);
    else if (survives(t, k, depth, &c->factor))
        enqueue_continuation(t, k, depth, c);
}

void path_continue_all(tracer *t, int depth, continuations *c)
{
    const group *g = &t->surface.gathered;
    for (int k = 0; has_roulette(t, depth) && k < g->count; k++) {
        vec3 factor = vec3_make(c->r[k], c->g[k], c->b[k]);
        c->exists[k] &= mask_of(survives(t, k, depth, &factor));
        c->r[k] = factor.x, c->g[k] = factor.y, c->b[k] = factor.z;
    }
    int64_t refracted = 0;
    for (int k = 0; k < g->count; k++) {
        c->r[k] *= g->wr[k], c->g[k] *= g->wg[k], c->b[k] *= g->wb[k];
        refracted -= c->refracted[k] & c->exists[k];
    }
    const new_rays rays = {c->dx, c->dy, c->dz, c->r, c->g, c->b, NULL, c->inside, c->sample_key, c->exists};
    int list[ROW];
    const int count = t->grouping->append(g, &rays, list, tracer_queue_at(t, depth + 1));
    COUNT(t->account.counters.refract += (uint64_t)refracted);
    COUNT(t->account.counters.reflect += (uint64_t)(count - refracted));
}
