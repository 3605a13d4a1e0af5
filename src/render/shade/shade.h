/* The kernels of shading: what happens to a group of rays that met one surface. All loops, no decisions by ray;
 * compiled once for each instruction set. Ownership: all arrays are the caller's (the tracer's scratch). */
#pragma once

#include "geometry/rays.h"
#include "render/core/plan.h"
#include "render/core/queue.h"

/* Rays gathered by index because they met the same surface, side by side. */
typedef struct group {
    double ox[ROW], oy[ROW], oz[ROW], dx[ROW], dy[ROW], dz[ROW];
    double wr[ROW], wg[ROW], wb[ROW]; /* throughput */
    double t[ROW];
    double n_from[ROW], n_to[ROW]; /* indices on the ray's side and beyond */
    int64_t start[ROW], sample_key[ROW];
    uint64_t inside_before[ROW], inside_after[ROW];
    surface_batch points;
    double cr[ROW], cg[ROW], cb[ROW]; /* the material's colour at the point */
    int count;
    int padded; /* count rounded up to whole vectors; the lanes beyond count repeat the last ray and are never read */
} group;

/* Shadow rays to one light: towards it, and the radiance it brings if nothing is in the way. */
typedef struct lit_group {
    double lx[ROW], ly[ROW], lz[ROW]; /* from the point to the light, not normalised */
    double r[ROW], g[ROW], b[ROW];
    int64_t shows[ROW]; /* -1 where that can change the film at all: half a unit in some channel */
} lit_group;

/* The two branches at an interface: directions and weights; a weight of 0 is a branch that does not exist. */
typedef struct branch_group {
    double rx[ROW], ry[ROW], rz[ROW], reflect[ROW];
    double tx[ROW], ty[ROW], tz[ROW], refract[ROW];
    int64_t total; /* how many of the group are total internal reflections */
} branch_group;

/* Fills g from rays list[0..count-1] of a batch, ascending; first is the batch's place in the queue; ior: by rank. Not
 * a kernel: copies one by one are faster than the gather instructions of the processors it was measured on. */
void group_gather(const ray_queue *q, int first, const hit_batch *hits, const double *ior, const int *list, int count,
                  group *g);

typedef struct cut_sum {
    int64_t branches, throughput[3];
} cut_sum;

typedef struct shade_kernels {
    /* The material's colour at the points of its surface on p: checker cells in the solid's own frame. */
    void (*color)(const material *m, const primitive *p, group *g);
    /* Phong's direct light of one light at every point, weighted by the throughput. */
    void (*direct)(const material *m, const light *lamp, const group *g, lit_group *lit);
    /* What a cone leaves of that light. */
    void (*spot)(const light_cone *c, bool soft, const group *g, lit_group *lit);
    /* Reflected and refracted directions with Fresnel's weights at a clear surface, and its coating, which sends back a
     * share of what would pass: R' = R + (1 - R) reflectivity. */
    void (*fresnel_branches)(const material *m, const group *g, branch_group *b);
    /* The same with the material's constant weights; opaque surfaces too. */
    void (*constant_branches)(const material *m, bool opaque, const group *g, branch_group *b);
    /* At a clear surface straight on, with the material's constant weights. */
    void (*straight_branches)(const material *m, const group *g, branch_group *b);
    /* Adds up branches that are not to be traced: their number, and their throughput in units of 1/COUNTERS_CUT_ONE. */
    void (*cut)(const group *g, const branch_group *b, cut_sum *sum);
    /* Appends all of g to q as rays along (dx, dy, dz) with throughput times weight; rays with weight 0 are then to be
     * taken out. */
    void (*append)(const group *g, const double *dx, const double *dy, const double *dz, const double *weight,
                   const uint64_t *inside, ray_queue *q);
    /* Directions of camera rays through the picture's points (u, v), in units of the half height. */
    void (*camera)(const camera_frame *view, int count, const double *u, const double *v, double *dx, double *dy,
                   double *dz);
} shade_kernels;

extern const shade_kernels shade_kernels_sse2, shade_kernels_avx2, shade_kernels_avx512;
