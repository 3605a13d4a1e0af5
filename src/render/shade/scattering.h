/* Media that scatter light, for random paths: the free flights of a batch of rays. A ray that passes media of
 * scattering coefficients s_k over lengths d_k comes through with the probability exp(-sum s_k d_k); the others scatter
 * where the sum reaches -ln u of a random number u. So a ray's throughput falls by absorption alone, by channel, up to
 * where it scatters. Rays that do not fly, those to lights, lose what is scattered out of them.
 *
 * Ownership: scatter_plan_create allocates, free releases; flights belong to the tracer's media_work. */
#pragma once

#include "geometry/mesh/mesh.h"
#include "render/core/queue.h"
#include "render/shade/sheets.h"
#include "scene/model/open.h"

struct tracer;
struct scene_geometry;

typedef struct region_scatter {
    double per_unit;  /* scattering coefficient, 1 / scene unit */
    double asymmetry; /* of the phase function, optics/phase_function.h */
} region_scatter;

/* The most lamps whose beams are sampled along each ray (airlight.h). */
enum { AIRLIGHTS_MAX = 8 };

/* A box around a solid whose medium scatters; of more solids than that, one box holds all. */
enum { SCATTER_BOXES_MAX = 8 };

typedef struct scatter_plan {
    int box_count, lamp_count, lamps[AIRLIGHTS_MAX];
    bounds3 boxes[SCATTER_BOXES_MAX];
    region_scatter region[]; /* by priority index */
} scatter_plan;

/* *out is NULL if no medium scatters in this frame. False when out of memory. */
bool scatter_plan_create(const scene *s, const struct scene_geometry *geometry, scatter_plan **out);

/* Points along the batch's rays, for one lamp. */
typedef struct airlight {
    double at[ROW], density[ROW]; /* distance, infinite if there is none; density per length */
    int region[ROW];              /* priority index of the medium there, once the ray has reached it; 0 before */
    double depth[4][ROW];         /* optical depths up to there: absorption by channel, scattering */
    double passes[ROW];           /* the share that the sheets on the way leave of its light, which is unpolarised */
} airlight;

/* The flights of a batch. */
typedef struct flight_work {
    bool flies;           /* the batch's rays scatter; otherwise they lose what scatters */
    bool flying;          /* their interfaces are being searched */
    double u[ROW];        /* the share of light that scatters beyond the end of the flight */
    double left[ROW];     /* the optical depth, by scattering, up to there */
    double passed[ROW];   /* the length of a ray's path so far */
    double end[ROW];      /* where it scatters, infinite if it does not ... */
    int region[ROW];      /* ... and the priority index of the medium there */
    double depth[4][ROW]; /* as an airlight's, of the whole path so far */
    airlight lamps[AIRLIGHTS_MAX];
    sheet_work sheets; /* of the whole path so far */
} flight_work;

/* Before and after the search for the batch's interfaces. Afterwards the medium segments end where rays scatter, and
 * the flights and airlights are complete. */
void scattering_begin(struct tracer *t, const ray_queue *q, int first, int depth, int count);
void scattering_end(struct tracer *t);
/* Follows the recorded medium segments, and removes those beyond where a ray scatters; called before they are used. */
void scattering_take(struct tracer *t);
