/* Direct light of random paths. */
#include "render/integrators/path_lights.h"

#include "base/elementary.h"
#include "optics/mueller.h"
#include "render/shade/light_choice.h"

double path_light_radiance(const plan *p, int lamp, vec3 direction)
{
    const light *l = &p->lights[lamp];
    return l->reach * l->reach / (l->radius * l->radius) * light_share(l, &p->cones[lamp], vec3_scale(direction, -1.0));
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

vec3 path_direction_about(vec3 axis, double cosine, double sine, double turn)
{
    vec3 x, y;
    double s, c;
    polarisation_frame(axis, &x, &y);
    elementary_sincos_deg(360.0 * turn, &s, &c);
    const vec3 across = vec3_add(vec3_scale(x, sine * c), vec3_scale(y, sine * s));
    return vec3_normalize(vec3_add(vec3_scale(axis, cosine), across));
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

/* Enqueues a shadow ray from record k of the group to a random point of a light's sphere, weighted. */
static void sample_sphere(tracer *t, int k, const material *m, bool opaque, int lamp, unit_pair drawn, double weight)
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
    const double below = drawn.u * cap, cosine = 1.0 - below, sine = sqrt(below * (2.0 - below));
    const vec3 to = path_direction_about(vec3_scale(to_light, 1.0 / sqrt(distance2)), cosine, sine, drawn.v);
    const double n_l = vec3_dot(n, to), radiance = path_light_radiance(p, lamp, to),
                 within = l->radius * l->radius - distance2 * sine * sine;
    if (!(n_l > 0.0) || radiance == 0.0 || !mesh_lets_out(t, k, to))
        return;
    const double reach = sqrt(distance2) * cosine - sqrt(within > 0.0 ? within : 0.0);
    /* (k_d C / pi) L (N.L) over the density 1 / (2 pi (1 - least_cos)), plus Phong's highlight from the same light. */
    const double shine = opaque ? highlight(g, k, m, to, n_l) : 0.0;
    const double seen = 2.0 * cap * radiance * weight, diffuse = m->diffuse * n_l;
    const vec3 color = vec3_scale(path_light_color(t, lamp, g->sample_key[k]), seen);
    enqueue_light(t, k, vec3_scale(to, reach), color, diffuse, shine);
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
    const int64_t *sample_key = t->surface.gathered.sample_key;
    local_light(t, priority_index, (light_terms){.highlights = true});
    radiance_weigh(t);
    for (int k = 0; lit && k < t->surface.gathered.count; k++)
        for (int lamp = 0; lamp < p->light_count; lamp++)
            if (p->lights[lamp].radius > 0.0)
                sample_sphere(t, k, m, opaque, lamp, path_draw(&p->draws, sample_key[k], depth, DRAW_LIGHT + lamp),
                              1.0);
    radiance_weigh_back(t);
}

static void sample_one(tracer *t, const material *m, bool opaque, int priority_index, int depth)
{
    const plan *p = t->target.frame_plan;
    const bool lit_by_spheres = m->diffuse > 0.0 || opaque;
    light_choice c;
    local_light(t, priority_index, (light_terms){.emission_only = true});
    if (m->diffuse == 0.0 && m->specular == 0.0)
        return;
    light_choice_make(t, m, depth, &c);
    radiance_weigh(t);
    for (int k = 0; k < t->surface.gathered.count; k++)
        if (c.lamp[k] >= 0 && p->lights[c.lamp[k]].radius == 0.0)
            sample_point(t, k, m, c.lamp[k], c.weight[k]);
        else if (c.lamp[k] >= 0 && lit_by_spheres)
            sample_sphere(t, k, m, opaque, c.lamp[k], c.at[k], c.weight[k]);
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
