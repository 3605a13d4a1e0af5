/* Basic radiance (render.radiance). Where light is refracted from a medium of index n_1 into one of index n_2 its solid
 * angle narrows or widens: n^2 cos(theta) dA d(omega) is invariant, and so, except for reflection, is L / n^2
 * (Nicodemus, "Radiance", American Journal of Physics 31, 1963; Veach, Robust Monte Carlo Methods for Light Transport
 * Simulation, 1997, 5.2). A ray's throughput is its fraction of L / n^2, so that interfaces add no factor of the index.
 * The indices matter where light is emitted, in a medium of index n, and where the camera receives it, in a medium of
 * index n_eye: emitted radiance L contributes (n_eye / n)^2 L. The camera's factor is applied at the emitting end too,
 * so that throughputs, which weight limits compare, are fractions of the camera ray whatever the camera's medium.
 *
 * A shadow ray carries irradiance, in which the square of the index cancels against the solid angle: E = E_straight T,
 * with each interface's unpolarised transmittance. It is straight, although light would be refracted. Its angle at an
 * interface is used as if on the side of the lower index: this is correct for a lamp far above water and for both faces
 * of a pane in air, and there is no total reflection on that side. */
#include "render/shade/shading.h"

#include "optics/interface.h"
#include <stdlib.h>
#include <string.h>

struct radiance_work {
    ray_crossings crossings;
    ray_batch rays;                       /* the shadow rays whose crossings are recorded, ... */
    const int64_t *sample_keys;           /* ... their sample keys, ... */
    double through[ROW];                  /* ... and the product of the interfaces' transmittances, by ray */
    double transmittances[CROSSINGS_MAX]; /* transmittances, by crossing */
    double wr[ROW], wg[ROW], wb[ROW];     /* saved throughput of the gathered group while local light is weighted */
    surface_batch points;
    mesh_points on_mesh;
};

bool radiance_begin(tracer *t)
{
    const bool basic = t->target.frame_plan->basic;
    if (basic && !t->basic && !(t->basic = malloc(sizeof *t->basic)))
        return false;
    t->batch.scratch.crossings = basic ? &t->basic->crossings : NULL;
    return true;
}

void radiance_end(tracer *t)
{
    free(t->basic);
}

static double index_of(const plan *p, int64_t sample_key, int priority_index)
{
    return p->spectral ? spectra_region(p->spectral, sample_key, priority_index)->index : p->ior[priority_index];
}

double radiance_scale(const plan *p, int64_t sample_key, int priority_index)
{
    const double ratio = index_of(p, sample_key, p->camera_priority_index) / index_of(p, sample_key, priority_index);
    return ratio * ratio;
}

double radiance_scale_at_index(const plan *p, int64_t sample_key, double index)
{
    const double ratio = p->basic ? index_of(p, sample_key, p->camera_priority_index) / index : 1.0;
    return ratio * ratio;
}

void radiance_weigh(tracer *t)
{
    const plan *p = t->target.frame_plan;
    if (!p->basic)
        return;
    group *g = &t->surface.gathered;
    radiance_work *w = t->basic;
    const size_t bytes = (size_t)g->padded * sizeof(double);
    memcpy(w->wr, g->wr, bytes), memcpy(w->wg, g->wg, bytes), memcpy(w->wb, g->wb, bytes);
    for (int k = 0; k < g->padded; k++) {
        const double fraction = radiance_scale_at_index(p, g->sample_key[k], g->n_from[k]);
        g->wr[k] *= fraction, g->wg[k] *= fraction, g->wb[k] *= fraction;
    }
}

void radiance_weigh_back(tracer *t)
{
    if (!t->target.frame_plan->basic)
        return;
    group *g = &t->surface.gathered;
    const radiance_work *w = t->basic;
    const size_t bytes = (size_t)g->padded * sizeof(double);
    memcpy(g->wr, w->wr, bytes), memcpy(g->wg, w->wg, bytes), memcpy(g->wb, w->wb, bytes);
}

/* The shadow rays that cross one primitive, contiguous, as kernels require. */
typedef struct straight_rays {
    double ox[ROW], oy[ROW], oz[ROW], dx[ROW], dy[ROW], dz[ROW], t[ROW];
    int64_t start[ROW];
    uint64_t inside[ROW];
    instance_hit mesh[ROW];
    int64_t number[ROW]; /* in the list of crossings */
    int count;
} straight_rays;

static void add_ray(const radiance_work *w, int number, straight_rays *s)
{
    const ray_crossing *x = &w->crossings.crossings[number];
    const ray_batch *rays = &w->rays;
    const int i = x->ray, at = s->count++;
    const vec3 along = vec3_make(rays->dx[i], rays->dy[i], rays->dz[i]);
    const double length = vec3_length(along);
    s->ox[at] = rays->ox[i], s->oy[at] = rays->oy[i], s->oz[at] = rays->oz[i];
    s->dx[at] = along.x / length, s->dy[at] = along.y / length, s->dz[at] = along.z / length;
    s->t[at] = x->t * length;
    s->start[at] = rays->start[i], s->inside[at] = x->inside, s->mesh[at] = x->mesh;
    s->number[at] = number;
}

static double transmittance(const plan *p, int64_t sample_key, const ray_crossing *x, double cosine)
{
    const double before = index_of(p, sample_key, x->before), after = index_of(p, sample_key, x->after);
    const double low = before < after ? before : after, high = before < after ? after : before;
    return 1.0 - fresnel_dielectric(cosine, low, high).R;
}

/* Computes the transmittances of the listed crossings of one primitive. */
static void cross_surface(tracer *t, int hit_primitive, straight_rays *s)
{
    const plan *p = t->target.frame_plan;
    radiance_work *w = t->basic;
    const primitive *surface = &p->geometry->primitives[hit_primitive];
    const ray_batch rays = {s->count, s->ox, s->oy, s->oz, s->dx, s->dy, s->dz, s->start, s->inside};
    if (!surface->rule)
        t->geometry->mesh_surface(p->geometry->meshes, &rays, s->mesh,
                                  p->shading_materials[surface->priority_index].shading == SHADING_SMOOTH, &w->points,
                                  &w->on_mesh);
    else
        t->geometry->surface(p->geometry, hit_primitive, &rays, s->t, &w->points);
    for (int k = 0; k < s->count; k++) {
        const ray_crossing *x = &w->crossings.crossings[s->number[k]];
        w->transmittances[s->number[k]] = transmittance(p, w->sample_keys[x->ray], x, w->points.cos_i[k]);
    }
    s->count = 0;
}

/* Processes and empties the list of crossings: surfaces one primitive at a time, the product in order along each ray,
 * so that the result does not depend on the other rays of the batch. */
static void apply_crossings(void *context)
{
    tracer *t = context;
    radiance_work *w = t->basic;
    straight_rays s;
    bool done[CROSSINGS_MAX] = {false};
    s.count = 0;
    for (int first = 0; first < w->crossings.count; first++) {
        const int hit_primitive = w->crossings.crossings[first].primitive;
        for (int k = first; k < w->crossings.count && !done[first]; k++) {
            if (w->crossings.crossings[k].primitive != hit_primitive)
                continue;
            done[k] = k > first;
            add_ray(w, k, &s);
            if (s.count == BATCH)
                cross_surface(t, hit_primitive, &s);
        }
        if (s.count > 0)
            cross_surface(t, hit_primitive, &s);
    }
    for (int k = 0; k < w->crossings.count; k++)
        w->through[w->crossings.crossings[k].ray] *= w->transmittances[k];
    w->crossings.count = 0;
}

void radiance_begin_shadows(tracer *t, const ray_batch *rays, const int64_t *sample_keys)
{
    radiance_work *w = t->basic;
    if (!t->target.frame_plan->basic)
        return;
    w->rays = *rays;
    w->sample_keys = sample_keys;
    w->crossings.full = apply_crossings;
    w->crossings.context = t;
    for (int i = 0; i < rays->count; i++)
        w->through[i] = 1.0;
}

void radiance_end_shadows(tracer *t)
{
    const radiance_work *w = t->basic;
    if (!t->target.frame_plan->basic)
        return;
    apply_crossings(t);
    for (int i = 0; i < w->rays.count; i++)
        t->batch.transmitted[i] *= w->through[i];
}
