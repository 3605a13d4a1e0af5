/* Scattering by media on random paths: airlight along rays, and direct light and continuation where a flight ends. */
#include "render/integrators/path.h"

#include "base/elementary.h"
#include "optics/mueller.h"
#include "optics/phase_function.h"
#include "render/shade/media.h"
#include "render/shade/polarisation.h"
#include "render/shade/rough.h"
#include "render/shade/shading.h"

/* The estimate for choosing a lamp: light from all directions. */
static light_estimate estimate(void)
{
    return (light_estimate){0.0f, 1.0f, 0.0, DRAW_LIGHT};
}

/* --- points of scattering as a group --- */

static vec3 direction_of(const group *g, int k)
{
    return vec3_make(g->dx[k], g->dy[k], g->dz[k]);
}

static vec3 point_of(const group *g, int k)
{
    return vec3_make(g->points.px[k], g->points.py[k], g->points.pz[k]);
}

/* Gathers rays list[0 .. count - 1] of the batch, which scatter at these distances in these media. */
static void gather(tracer *t, const ray_queue *q, int first, const int *list, int count, const double *at,
                   const int *media)
{
    const plan *p = t->target.frame_plan;
    group *g = &t->surface.gathered;
    g->count = g->padded = count;
    for (int k = 0; k < count; k++) {
        const int i = list[k], from = first + i;
        const vec3 o = vec3_make(q->ox[from], q->oy[from], q->oz[from]),
                   d = vec3_make(q->dx[from], q->dy[from], q->dz[from]), point = vec3_add(o, vec3_scale(d, at[i]));
        g->ox[k] = o.x, g->oy[k] = o.y, g->oz[k] = o.z;
        g->dx[k] = d.x, g->dy[k] = d.y, g->dz[k] = d.z;
        g->wr[k] = q->wr[from], g->wg[k] = q->wg[from], g->wb[k] = q->wb[from];
        g->t[k] = at[i];
        g->sample_key[k] = q->sample_key[from];
        g->points.px[k] = point.x, g->points.py[k] = point.y, g->points.pz[k] = point.z;
        g->points.nx[k] = g->points.ny[k] = g->points.nz[k] = 0.0;
        g->points.face[k] = FACE_NONE;
        g->inside_before[k] = g->inside_after[k] = scene_geometry_inside(p->geometry, point);
        g->n_from[k] = g->n_to[k] =
            p->spectral ? spectra_region(p->spectral, g->sample_key[k], media[i])->index : p->ior[media[i]];
    }
}

static void enqueue(tracer *t, int k, int lamp, vec3 to_lamp, double fraction)
{
    const group *g = &t->surface.gathered;
    if (fraction > 0.0)
        path_enqueue_lamp(t, k, lamp, to_lamp, g->n_from[k], g->inside_before[k],
                          vec3_make(fraction, fraction, fraction));
}

/* --- along rays --- */

/* Adds a lamp's airlight: each ray scatters its remaining throughput at its sample point for this lamp. */
static void light_along(tracer *t, int number, const ray_queue *q, int first, int count)
{
    const plan *p = t->target.frame_plan;
    const airlight *l = &t->media->flights.lamps[number];
    group *g = &t->surface.gathered;
    lamp_samples s;
    int list[ROW] = {0}, reached = 0;
    for (int i = 0; i < count; i++)
        if (l->region[i] > 0)
            list[reached++] = i;
    gather(t, q, first, list, reached, l->at, l->region);
    for (int k = 0; k < reached; k++) {
        const int i = list[k];
        const region_scatter *here = &p->scatter->region[l->region[i]];
        s.lamp[k] = p->scatter->lamps[number], s.weight[k] = 1.0;
        const lamp_aim a = path_lamp_aim(t, &s, k);
        double density[3];
        const double flights = airlight_flights(t, l, i, density),
                     phase = henyey_greenstein(vec3_dot(direction_of(g, k), a.to), here->asymmetry);
        g->wr[k] *= absorption_left(l->depth[0][i]) * l->sheet_transmittance[i];
        g->wg[k] *= absorption_left(l->depth[1][i]) * l->sheet_transmittance[i];
        g->wb[k] *= absorption_left(l->depth[2][i]) * l->sheet_transmittance[i];
        const double sum = l->density[i] + flights;
        if (a.light > 0.0 && flights > 0.0)
            path_enqueue_lamp(t, k, s.lamp[k], vec3_scale(a.to, a.distance), g->n_from[k], g->inside_before[k],
                              vec3_make(a.light * phase * density[0] / sum, a.light * phase * density[1] / sum,
                                        a.light * phase * density[2] / sum));
    }
}

void path_scatter_mark(tracer *t, ray_queue *q, int first, int count)
{
    const flight_work *w = &t->media->flights;
    for (int number = 0; number < t->target.frame_plan->scatter->lamp_count; number++)
        light_along(t, number, q, first, count);
    scattering_weigh(t, q, first, count);
    for (int i = 0; i < count; i++)
        if (w->end[i] < (double)INFINITY)
            t->batch.hits.hit_primitive[i] = PATH_SCATTERED;
}

/* --- where flights end --- */

/* The medium's properties at the group's points, by record. */
typedef struct scattering {
    double asymmetry[ROW];
    double flights[ROW]; /* density of the flight's end, per length */
} scattering;

/* Adds light from a point on each record's lamp. */
static void light_by_lamps(tracer *t, const lamp_samples *s, const scattering *media_at_points)
{
    const plan *p = t->target.frame_plan;
    const group *g = &t->surface.gathered;
    for (int k = 0; k < g->count; k++) {
        if (!path_lamp_is_outside(p, s, k))
            continue;
        const lamp_aim a = path_lamp_aim(t, s, k);
        const double phase = henyey_greenstein(vec3_dot(direction_of(g, k), a.to), media_at_points->asymmetry[k]);
        double fraction = 0.0;
        if (a.light > 0.0 && a.density > 0.0)
            fraction = a.light * phase / (a.density + phase);
        else if (a.light > 0.0)
            fraction =
                a.light * phase * media_at_points->flights[k] /
                (media_at_points->flights[k] +
                 airlight_density(p, s->lamp[k], vec3_make(g->ox[k], g->oy[k], g->oz[k]), direction_of(g, k), g->t[k]));
        enqueue(t, k, s->lamp[k], vec3_scale(a.to, a.distance), fraction);
    }
}

static void sample_lamps(tracer *t, int depth, const scattering *media_at_points)
{
    const plan *p = t->target.frame_plan;
    const light_estimate by = estimate();
    lamp_samples s;
    if (light_choice_applies(p)) {
        light_choice_make(t, &by, depth, s.lamp, s.weight, s.spheres.u, s.spheres.v);
        area_lights_aim_at_spheres(t, &s);
        light_by_lamps(t, &s, media_at_points);
        return;
    }
    for (int lamp = 0; lamp < p->light_count; lamp++) {
        path_lamp_samples(t, lamp, depth, &s);
        light_by_lamps(t, &s, media_at_points);
    }
}

/* Adds the light of lamps that the path's direction hits. */
static void light_by_direction(tracer *t, int k, vec3 direction, double phase)
{
    const plan *p = t->target.frame_plan;
    const light_estimate by = estimate();
    const vec3 point = point_of(&t->surface.gathered, k);
    for (int lamp = 0; lamp < p->light_count; lamp++) {
        double distance;
        const double radiance = path_lamp_ahead(p, lamp, point, direction, &distance);
        if (!(radiance > 0.0))
            continue;
        const double chance = light_choice_applies(p) ? light_choice_chance(t, &by, k, lamp) : 1.0,
                     density = chance * area_light_density(p, lamp, point, direction, distance);
        enqueue(t, k, lamp, vec3_scale(direction, distance), radiance * phase / (density + phase));
    }
}

/* The unit vector at an angle to the axis. */
static vec3 turned(vec3 axis, double cosine, double turn)
{
    vec3 x, y;
    double s, c;
    const double sine = sqrt((1.0 - cosine) * (1.0 + cosine));
    polarisation_frame(axis, &x, &y);
    elementary_sincos_deg(360.0 * turn, &s, &c);
    return vec3_normalize(
        vec3_add(vec3_scale(axis, cosine), vec3_add(vec3_scale(x, sine * c), vec3_scale(y, sine * s))));
}

void path_scatter(tracer *t, const ray_queue *q, int first, const int *list, int count)
{
    const plan *p = t->target.frame_plan;
    const flight_work *w = &t->media->flights;
    const group *g = &t->surface.gathered;
    const int depth = t->queues.depth;
    scattering media_at_points;
    double u[ROW], v[ROW];
    gather(t, q, first, list, count, w->end, w->region);
    for (int k = 0; k < count; k++) {
        const region_scatter *here = &p->scatter->region[w->region[list[k]]];
        media_at_points.asymmetry[k] = here->asymmetry;
        media_at_points.flights[k] = w->density[list[k]];
    }
    sample_lamps(t, depth, &media_at_points);
    t->sampling->draw(&p->draws, count, g->sample_key, depth, DRAW_PHASE, u, v);
    for (int k = 0; k < count; k++) {
        const double cosine = henyey_greenstein_cosine(u[k], media_at_points.asymmetry[k]);
        continuation c = {.direction = turned(direction_of(g, k), cosine, v[k]),
                          .factor = vec3_make(1.0, 1.0, 1.0),
                          .inside = g->inside_before[k]};
        light_by_direction(t, k, c.direction, henyey_greenstein(cosine, media_at_points.asymmetry[k]));
        path_continue(t, k, depth, &c);
    }
}
