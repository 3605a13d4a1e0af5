/* Polarised light, traced from the camera: each ray carries the analyser's row, a Stokes vector (optics/mueller.h),
 * whose first element is part of its throughput; the others, relative to the first, are in the queue. Light from the
 * sky and from matte surfaces is unpolarised, so that only the first element weights it; light of polarised lamps is
 * multiplied by the shadow rays' vectors.
 *
 * Lamps. Light of a polarised lamp has the lamp's degree of polarisation, as behind a partial polariser whose axis is
 * perpendicular to the lamp's axis; for a point light, which has no axis, perpendicular to each ray, so that at 0
 * degrees its field is horizontal everywhere. An analyser sees its row times the lamp's Stokes vector. A matte surface
 * depolarises light, so that the polarisation only matters between the lamp and the first matte surface: for sheets in
 * shadow rays, for all surfaces on the paths of photons, and for the last surfaces of a random path before the lamp.
 *
 * Sheets: polarising filters and wave plates (scene/model/medium.h). They act once per passage: the row is multiplied
 * where the ray leaves the region, or ends in it, so that a reflection in it starts another passage. Between regions of
 * equal index there is no interface: the ray continues undeflected at the same depth. A shadow ray starts with the row
 * of a matte surface, which sees only the intensity, or of a rough surface's facet, and ends at a lamp, whose Stokes
 * vector is in the queue: two crossed polarisers block unpolarised light, and one blocks a polarised lamp that it is
 * crossed with. Without polarisation every passage transmits the mean of a polariser's transmittances. Plain values;
 * nothing fails. */
#pragma once

#include "optics/mueller.h"
#include "render/plan/plan.h"
#include "render/tracer/tracer.h"

/* --- at surfaces --- */

/* Gathers the group's Stokes vectors, and applies an interface to weights and vectors. */
void polarised_gather(tracer *t, const ray_queue *q, int first, const int *list);
void polarised_branches(tracer *t, const material *m, bool opaque);
/* Sets the Stokes vector of shadow ray `at` to the vector of a branch of ray k along the same direction. */
void polarised_shadow(tracer *t, int k, bool refracted, int at);
/* Applies a layered surface to ray k, with its responses in reflection and transmission. */
void polarised_layered(tracer *t, int k, sp_response reflected, sp_response transmitted, double reflectivity,
                       double transparency);

/* --- lamps --- */

/* Stokes vector, of intensity 1, of a lamp's light along the unit vector `emitted`, in the canonical frame of `ray`,
 * which is `emitted` or its opposite: linear polarisation has one vector for both directions of travel. */
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

/* The light of a lamp that a row sees along the unit vector to_lamp, relative to an unpolarised lamp. */
static inline double lamp_seen(const plan *p, int lamp, stokes row, vec3 to_lamp)
{
    return greater(analyser_intensity(row, lamp_stokes(p, lamp, vec3_scale(to_lamp, -1.0), to_lamp)), 0.0);
}

/* --- sheets --- */

/* A ray's current passage through a sheet, and its row. */
typedef struct sheet_passage {
    stokes row;    /* at the passage's start; the first element: the transmitted fraction of unpolarised light so far */
    double length; /* of the passage so far, scene units */
    int region;    /* priority index of the region that the ray is in, -1 for a region without a sheet */
} sheet_passage;

/* The passages of a batch's rays. */
typedef struct sheet_work {
    sheet_passage passage[ROW];
    stokes lamp[ROW]; /* Stokes vectors of the lamps, for shadow rays to polarised lamps */
    bool to_lamps;    /* `lamp` is set */
    vec3 direction[ROW];
} sheet_work;

/* In a scene with sheets, stores both ends of shadow ray `at` in its queue: the row of a matte surface, which sees only
 * the intensity, and the lamp's Stokes vector. */
void sheets_shadow_ray(tracer *t, int lamp, int at);

/* sheets_announce: begins a batch of a queue, if the frame has sheets; sheets_begin: likewise, in the caller's memory.
 * sheets_segment: adds the next segment of a ray. sheets_leave: ends the passages, and multiplies fractions by their
 * transmittances. sheets_store: stores the rows in the queue. sheets_fraction_within: the fraction of unpolarised light
 * that arrives from the point at `length` of the next segment. */
void sheets_announce(tracer *t, const ray_queue *q, int first, int count);
void sheets_begin(const tracer *t, sheet_work *w, const ray_queue *q, int first, int count);
void sheets_segment(const tracer *t, sheet_work *w, const medium_segment *s);
void sheets_leave(tracer *t, int count, double fraction[3][ROW]);
void sheets_store(tracer *t, ray_queue *q, int first, int count);
double sheets_fraction_within(const tracer *t, const sheet_work *w, const medium_segment *s, double length);
