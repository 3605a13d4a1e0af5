/* Polarised light, traced from the camera: each ray carries the analyser's row, a Stokes vector (optics/mueller.h),
 * whose first element is part of its throughput; the others, relative to the first, are in the queue. Light from the
 * sky and from matte surfaces is unpolarised, so that only the first element weights it; that of polarised lamps meets
 * the shadow rays' own vectors.
 *
 * Lamps. A polarised lamp is one behind an ideal polariser of that degree, whose axis is across the lamp's own; of a
 * point light, which has no axis, across each ray, so that at 0 degrees its field is everywhere horizontal. What an
 * analyser sees of it is its row times the lamp's Stokes vector. A matte surface depolarises light, so that only what
 * is between lamp and surface can tell: sheets in shadow rays, all surfaces on the paths of photons, and those that a
 * random path meets last before the lamp.
 *
 * Sheets: polarising filters and wave plates (scene/model/medium.h). They act once at each passage: what the ray
 * carries is multiplied where it leaves the region, or ends in it, so that a reflection in it starts another passage.
 * Between regions of equal index there is no interface: the ray goes straight on, at the same depth. A shadow ray
 * starts with the row of a matte surface, which sees the intensity alone, or of a rough one's facet, and ends at a
 * lamp, whose Stokes vector waits in its queue: two crossed polarisers leave nothing of unpolarised light, one that is
 * crossed with a polarised lamp is enough. Without polarisation every passage keeps the mean of a polariser's
 * transmittances. Ownership: values; nothing fails. */
#pragma once

#include "optics/mueller.h"
#include "render/plan/plan.h"
#include "render/tracer/tracer.h"

/* --- at surfaces --- */

/* Gathers the group's Stokes vectors, and applies an interface to weights and vectors. */
void polarised_gather(tracer *t, const ray_queue *q, int first, const int *list);
void polarised_branches(tracer *t, const material *m, bool opaque);
/* Gives a shadow ray the Stokes vector of a branch of ray k along the same direction. */
void polarised_shadow(tracer *t, int k, bool refracted, int at);
/* Applies a layered surface to ray k, by what it reflects and transmits. */
void polarised_layered(tracer *t, int k, sp_response reflected, sp_response transmitted, double coating,
                       double transparency);

/* --- lamps --- */

/* Stokes vector, of intensity 1, of the light that a lamp emits along a unit vector, in the canonical frame of `ray`,
 * which is that vector or its opposite: of linear polarisation it is the same for both directions of travel. */
static inline stokes lamp_stokes(const plan *p, int lamp, vec3 emitted, vec3 ray)
{
    const light *l = &p->lights[lamp];
    const bool has_axis = l->kind != LIGHT_POINT;
    const vec3 axis = has_axis ? p->cones[lamp].axis : emitted;
    const vec3 right = lamp_right(axis), up = vec3_cross(axis, right);
    double sine, cosine;
    elementary_sincos_deg(l->polarisation_deg, &sine, &cosine);
    vec3 field = vec3_add(vec3_scale(right, cosine), vec3_scale(up, sine));
    if (has_axis && vec3_dot(axis, emitted) > -1.0 + 1e-12)
        field = polarisation_across_ray(field, axis, emitted);
    const stokes s = stokes_linear(ray, field);
    return (stokes){1.0, l->polarised * s.q, l->polarised * s.u, 0.0};
}

/* The lamp's light, relative to unpolarised light, that a row sees of it along a unit vector towards the lamp. */
static inline double lamp_seen(const plan *p, int lamp, stokes row, vec3 to_lamp)
{
    return greater(analyser_sees(row, lamp_stokes(p, lamp, vec3_scale(to_lamp, -1.0), to_lamp)), 0.0);
}

/* --- sheets --- */

/* A ray's passage. */
typedef struct sheet_passage {
    stokes row;    /* at its start; the first element: the fraction of unpolarised light so far */
    double length; /* its path there so far */
    int region;    /* priority index of the region that the ray is in, or -1 */
} sheet_passage;

/* The passages of a batch's rays. */
typedef struct sheet_work {
    sheet_passage passage[ROW];
    stokes lamp[ROW]; /* of shadow rays to polarised lamps: their ends' */
    bool to_lamps;    /* the rays are such */
    vec3 direction[ROW];
} sheet_work;

/* In a scene with sheets: stores the Stokes vectors of both ends of shadow ray `at` in its queue, of a matte surface,
 * which sees the intensity alone, and of the lamp. */
void sheets_shadow_ray(tracer *t, int lamp, int at);

/* sheets_announce: before a batch of a queue is traced; sheets_begin: with that work. sheets_segment: the next segment
 * of a ray. sheets_leave: ends the passages and multiplies the fractions by theirs. sheets_store: the rows into the
 * queue. sheets_fraction_within: the fraction of unpolarised light from a point of the next segment, at that length of
 * it. */
void sheets_announce(tracer *t, const ray_queue *q, int first, int count);
void sheets_begin(const tracer *t, sheet_work *w, const ray_queue *q, int first, int count);
void sheets_segment(const tracer *t, sheet_work *w, const medium_segment *s);
void sheets_leave(tracer *t, int count, double fraction[3][ROW]);
void sheets_store(tracer *t, ray_queue *q, int first, int count);
double sheets_fraction_within(const tracer *t, const sheet_work *w, const medium_segment *s, double length);
