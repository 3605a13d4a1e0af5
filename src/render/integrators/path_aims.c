/* Points of lamps as seen from the gathered group, and shadow rays to them. */
#include "render/integrators/path_lights.h"

#define PI 3.14159265358979323846

void path_lamp_samples(tracer *t, int lamp, int depth, lamp_samples *s)
{
    const plan *p = t->target.frame_plan;
    const group *g = &t->surface.gathered;
    for (int k = 0; k < g->count; k++)
        s->lamp[k] = lamp, s->weight[k] = 1.0;
    if (light_has_area(p, lamp)) {
        t->path->draw(&p->draws, g->count, g->sample_key, depth, DRAW_LIGHT + lamp, s->spheres.u, s->spheres.v);
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
              light_share(l, &p->cones[lamp], vec3_scale(a.to, -1.0));
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

void path_enqueue_lamp(tracer *t, int k, int lamp, vec3 to_lamp, double index, uint64_t inside, vec3 share)
{
    const plan *p = t->target.frame_plan;
    const group *g = &t->surface.gathered;
    const int64_t sample_key = g->sample_key[k];
    const vec3 color = vec3_scale(light_color_of(t, lamp, sample_key), radiance_share_at_index(p, sample_key, index));
    const double r = g->wr[k] * share.x * color.x, gr = g->wg[k] * share.y * color.y, b = g->wb[k] * share.z * color.z;
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
