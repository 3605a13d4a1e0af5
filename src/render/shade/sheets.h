/* Polarising filters and wave plates in the tracer (scene/model/medium.h). They act once at each passage: what the ray
 * carries is multiplied where it leaves the region, or ends in it, so that a reflection in it starts another passage.
 * Between regions of equal index there is no interface: the ray goes straight on, at the same depth.
 *
 * A ray carries its analyser's row. A shadow ray starts with that of a matte surface, which sees the intensity alone,
 * or of a rough one's facet, and ends at a lamp, whose Stokes vector waits in its queue (lamp_polarisation.h): two
 * crossed polarisers leave nothing of unpolarised light, one that is crossed with a polarised lamp is enough. Without
 * polarisation every passage keeps the mean of a polariser's transmittances.
 * Ownership: sheet_list_create allocates, free releases. */
#pragma once

#include "optics/mueller.h"
#include "render/core/queue.h"
#include "scene/model/open.h"
#include "scene/model/medium.h"

struct tracer;
struct scene_geometry;

/* What a region does to light that passes it. */
typedef struct region_sheet {
    sheet_kind kind;
    vec3 axis; /* in the world, of any length */
    double pass, block;
    double retardance_deg, birefringence;
} region_sheet;

/* By priority index; *out is NULL if there are none. False when out of memory. */
bool sheet_list_create(const scene *s, const struct scene_geometry *geometry, region_sheet **out);

/* A ray's passage. */
typedef struct sheet_passage {
    stokes row;    /* at its start; the first element: the share of unpolarised light so far */
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
void sheets_shadow_ray(struct tracer *t, int lamp, int at);

/* sheets_announce: before a batch of a queue is traced; sheets_begin: with that work. sheets_segment: the next segment
 * of a ray. sheets_leave: ends the passages and multiplies the shares by theirs. sheets_store: the rows into the queue.
 * sheets_share_within: the share of unpolarised light from a point of the next segment, at that length of it. */
void sheets_announce(struct tracer *t, const ray_queue *q, int first, int count);
void sheets_begin(const struct tracer *t, sheet_work *w, const ray_queue *q, int first, int count);
void sheets_segment(const struct tracer *t, sheet_work *w, const medium_segment *s);
void sheets_leave(struct tracer *t, int count, double share[3][ROW]);
void sheets_store(struct tracer *t, ray_queue *q, int first, int count);
double sheets_share_within(const struct tracer *t, const sheet_work *w, const medium_segment *s, double length);
