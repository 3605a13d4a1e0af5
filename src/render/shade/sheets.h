/* Polarising filters and wave plates in the tracer (scene/model/sheet.h). They act once at each passage: what the ray
 * carries is multiplied where it leaves the region, or ends in it, so that a reflection in it starts another passage.
 * Between regions of equal index there is no interface: the ray goes straight on, at the same depth.
 *
 * A ray of the tree carries its analyser's row. A shadow ray starts with that of a matte surface, which sees the
 * intensity alone, and ends at a lamp, whose Stokes vector waits in its queue (lamp_polarisation.h): two crossed
 * polarisers leave nothing of unpolarised light, one that is crossed with a polarised lamp is enough. Without
 * polarisation every passage keeps the mean of a polariser's transmittances.
 * Ownership: sheet_list_create allocates, free releases. */
#pragma once

#include "optics/polarisers.h"
#include "render/core/queue.h"
#include "scene/model/open.h"
#include "scene/model/sheet.h"

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

/* The row beyond a passage of that length, in metres, along d. */
stokes sheet_row(const region_sheet *sheet, stokes row, vec3 d, double length_m, double lambda_nm);

/* The passages of a batch's rays. */
typedef struct sheet_work {
    stokes row[ROW];  /* its first element: the share of unpolarised light so far */
    stokes lamp[ROW]; /* of shadow rays to polarised lamps: their ends' */
    vec3 direction[ROW];
    int region[ROW];    /* priority index of the region that the ray is in, or -1 */
    double length[ROW]; /* its path there so far */
    bool lights;        /* the rays are shadow rays */
} sheet_work;

/* Stores the Stokes vector of the lamp at the end of shadow ray `at` in its queue. */
void sheets_shadow_ray(struct tracer *t, int lamp, int at);

/* sheets_announce: before a batch of a queue is traced. sheets_segment: the next segment of a ray. sheets_leave: ends
 * the passages and multiplies the shares by theirs. sheets_store: the rows into the queue. */
void sheets_announce(struct tracer *t, const ray_queue *q, int first, int count);
void sheets_segment(struct tracer *t, const medium_segment *s);
void sheets_leave(struct tracer *t, int count, double share[3][ROW]);
void sheets_store(struct tracer *t, ray_queue *q, int first, int count);
