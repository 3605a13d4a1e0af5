/* Direct light of random paths. */
#include "render/integrators/path_lights.h"

#include "render/shade/light_choice.h"

/* The same to a light that is a point; without shadows its light is added at once. */
static void sample_point(tracer *t, int k, const material *m, int lamp, double weight)
{
    const plan *p = t->target.frame_plan;
    const group *g = &t->surface.gathered;
    const light *l = &p->lights[lamp];
    const vec3 point = vec3_make(g->points.px[k], g->points.py[k], g->points.pz[k]),
               n = vec3_make(g->points.nx[k], g->points.ny[k], g->points.nz[k]), to_light = light_towards(l, point);
    const double distance2 = vec3_dot(to_light, to_light);
    const vec3 to = vec3_scale(to_light, 1.0 / sqrt(distance2));
    const double n_l = vec3_dot(n, to), share = light_share(l, &p->cones[lamp], vec3_scale(to, -1.0));
    if (!(n_l > 0.0) || share == 0.0 || !mesh_lets_out(t, k, to))
        return;
    const double falloff = l->reach > 0.0 ? l->reach * l->reach / distance2 : 1.0;
    const vec3 color = vec3_scale(light_color_of(t, lamp, g->sample_key[k]), weight * share * falloff);
    shadow_ray_enqueue(t, k, lamp, to_light, color, m->diffuse * n_l, highlight_of(g, k, m, to, n_l));
    if (p->render.shadows != SHADOWS_OFF)
        return;
    ray_queue *q = &t->queues.shadows;
    const int at = --q->count;
    shading_expose(t, q->sample_key[at], q->wr[at], q->wg[at], q->wb[at]);
}

/* All lights of every record; points first, which are not random. */
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
