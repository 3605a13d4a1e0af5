/* Direct light of random paths. */
#include "render/integrators/path_lights.h"

#include "base/elementary.h"
#include "render/shade/light_choice.h"
#include "render/shade/path_kernels.h"

double path_light_radiance(const plan *p, int lamp, vec3 direction)
{
    const light *l = &p->lights[lamp];
    return l->reach * l->reach / (l->radius * l->radius) * light_share(l, &p->cones[lamp], vec3_scale(direction, -1.0));
}

double path_light_distance(const light *l, vec3 origin, vec3 direction)
{
    const vec3 to_light = vec3_sub(l->position, origin);
    const double along = vec3_dot(to_light, direction), distance2 = vec3_dot(to_light, to_light);
    const vec3 across = vec3_sub(to_light, vec3_scale(direction, along));
    const double discriminant = l->radius * l->radius - vec3_dot(across, across);
    if (!(discriminant > 0.0) || distance2 <= l->radius * l->radius)
        return (double)HUGE_VAL;
    return along - sqrt(discriminant);
}

vec3 path_light_color(const tracer *t, int lamp, int64_t sample_key)
{
    const plan *p = t->target.frame_plan;
    const light *l = &p->lights[lamp];
    if (!p->spectral)
        return vec3_scale(l->color, l->intensity);
    const double radiance = spectra_light(p->spectral, sample_key, lamp);
    return vec3_make(radiance, radiance, radiance);
}

/* Phong's highlight k_s (R.V)^n of the light along the unit vector `to`, whose cosine is n_l. */
static double highlight(const group *g, int k, const material *m, vec3 to, double n_l)
{
    const vec3 d = vec3_make(g->dx[k], g->dy[k], g->dz[k]);
    const double r_v = 2.0 * n_l * g->points.cos_i[k] + vec3_dot(d, to);
    return m->specular > 0.0 && r_v > 0.0 ? m->specular * elementary_pow(r_v < 1.0 ? r_v : 1.0, m->shininess) : 0.0;
}

/* Enqueues a shadow ray from record k that brings light of that colour, as Phong's model reflects it. */
static void enqueue_light(tracer *t, int k, vec3 to_light, vec3 color, double diffuse, double shine)
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
}

/* Enqueues a shadow ray from record k to its point of a light's sphere. */
static void enqueue_sphere(tracer *t, int k, const material *m, bool opaque, const lamp_samples *l)
{
    const sphere_samples *s = &l->spheres;
    const group *g = &t->surface.gathered;
    const int lamp = l->lamp[k];
    const vec3 to = vec3_make(s->dx[k], s->dy[k], s->dz[k]);
    const double n_l = s->n_l[k];
    if (!(n_l > 0.0))
        return;
    const double radiance = path_light_radiance(t->target.frame_plan, lamp, to);
    if (radiance == 0.0 || !mesh_lets_out(t, k, to))
        return;
    /* (k_d C / pi) L (N.L) over the density 1 / (2 pi (1 - least_cos)), plus Phong's highlight from the same light. */
    const double shine = opaque ? highlight(g, k, m, to, n_l) : 0.0;
    const double seen = 2.0 * s->cap[k] * radiance * l->weight[k], diffuse = m->diffuse * n_l;
    const vec3 color = vec3_scale(path_light_color(t, lamp, g->sample_key[k]), seen);
    enqueue_light(t, k, vec3_scale(to, s->reach[k]), color, diffuse, shine);
}

static bool is_sphere(const plan *p, int lamp)
{
    return lamp >= 0 && p->lights[lamp].radius > 0.0;
}

void path_aim_at_spheres(const tracer *t, lamp_samples *l)
{
    const plan *p = t->target.frame_plan;
    for (int k = 0; k < t->surface.gathered.count; k++) {
        const light *one = &p->lights[l->lamp[k] < 0 ? 0 : l->lamp[k]];
        l->spheres.x[k] = one->position.x, l->spheres.y[k] = one->position.y, l->spheres.z[k] = one->position.z;
        l->spheres.radius[k] = one->radius;
    }
    t->path->spheres(&t->surface.gathered, &l->spheres);
}

/* From every record whose light is a sphere; u and v of the samples are set. */
static void sample_spheres(tracer *t, const material *m, bool opaque, lamp_samples *l)
{
    path_aim_at_spheres(t, l);
    for (int k = 0; k < t->surface.gathered.count; k++)
        if (is_sphere(t->target.frame_plan, l->lamp[k]))
            enqueue_sphere(t, k, m, opaque, l);
}

/* The same to a light that is a point; without shadows its light is added at once. */
static void sample_point(tracer *t, int k, const material *m, int lamp, double weight)
{
    const plan *p = t->target.frame_plan;
    const group *g = &t->surface.gathered;
    const light *l = &p->lights[lamp];
    const vec3 point = vec3_make(g->points.px[k], g->points.py[k], g->points.pz[k]),
               n = vec3_make(g->points.nx[k], g->points.ny[k], g->points.nz[k]),
               to_light = vec3_sub(l->position, point);
    const double distance2 = vec3_dot(to_light, to_light);
    const vec3 to = vec3_scale(to_light, 1.0 / sqrt(distance2));
    const double n_l = vec3_dot(n, to), share = light_share(l, &p->cones[lamp], vec3_scale(to, -1.0));
    if (!(n_l > 0.0) || share == 0.0 || !mesh_lets_out(t, k, to))
        return;
    const double falloff = l->reach > 0.0 ? l->reach * l->reach / distance2 : 1.0;
    const vec3 color = vec3_scale(path_light_color(t, lamp, g->sample_key[k]), weight * share * falloff);
    enqueue_light(t, k, to_light, color, m->diffuse * n_l, highlight(g, k, m, to, n_l));
    if (p->render.shadows != SHADOWS_OFF)
        return;
    ray_queue *q = &t->queues.shadows;
    const int at = --q->count;
    shading_expose(t, q->sample_key[at], q->wr[at], q->wg[at], q->wb[at]);
}

/* All lights of every record; points first, which are not random. */
static void sample_all(tracer *t, const material *m, bool opaque, int priority_index, int depth)
{
    const plan *p = t->target.frame_plan;
    const bool lit = m->diffuse > 0.0 || (opaque && m->specular > 0.0);
    const group *g = &t->surface.gathered;
    lamp_samples all;
    local_light(t, priority_index, (light_terms){.highlights = true});
    radiance_weigh(t);
    for (int lamp = 0; lit && lamp < p->light_count; lamp++) {
        if (!is_sphere(p, lamp))
            continue;
        for (int k = 0; k < g->count; k++)
            all.lamp[k] = lamp, all.weight[k] = 1.0;
        t->path->draw(&p->draws, g->count, g->sample_key, depth, DRAW_LIGHT + lamp, all.spheres.u, all.spheres.v);
        sample_spheres(t, m, opaque, &all);
    }
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
        if (one.lamp[k] >= 0 && !is_sphere(p, one.lamp[k]))
            sample_point(t, k, m, one.lamp[k], one.weight[k]);
    if (m->diffuse > 0.0 || opaque)
        sample_spheres(t, m, opaque, &one);
    radiance_weigh_back(t);
}

/* Light that is interpolated between the corners of triangles is that of all lights. */
void path_sample_lights(tracer *t, int priority_index, int depth)
{
    const material *m = &t->surface.mat->surface;
    const bool opaque = surface_is_opaque(t, priority_index);
    if (light_choice_applies(t->target.frame_plan) && !mesh_has_corner_light(t, priority_index))
        sample_one(t, m, opaque, priority_index, depth);
    else
        sample_all(t, m, opaque, priority_index, depth);
}
