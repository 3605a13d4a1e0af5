/* The shading kernels: operations on a group of rays that hit one surface. They are loops without per-ray branches,
 * compiled once for each instruction set. Ownership: the caller owns all arrays (the tracer's scratch). */
#pragma once

#include "base/isa.h"
#include "geometry/rays.h"
#include "image/texture.h"
#include "render/core/film.h"
#include "render/core/plan.h"
#include "render/core/queue.h"

/* Rays that hit the same surface, gathered by index into contiguous arrays. */
typedef struct group {
    double ox[ROW], oy[ROW], oz[ROW], dx[ROW], dy[ROW], dz[ROW];
    double wr[ROW], wg[ROW], wb[ROW]; /* throughput */
    double t[ROW];
    double n_from[ROW], n_to[ROW]; /* refractive indices on the ray's side and behind */
    int64_t start[ROW], sample_key[ROW];
    uint64_t inside_before[ROW], inside_after[ROW];
    surface_batch points;
    double cr[ROW], cg[ROW], cb[ROW]; /* the material's colour at the point */
    int count;
    int padded; /* count rounded up to whole vectors; the lanes past count repeat the last ray and are never read */
} group;

/* Shadow rays to one light: direction, and the radiance that each contributes if unblocked. */
typedef struct lit_group {
    double lx[ROW], ly[ROW], lz[ROW]; /* from the point to the light, not normalised */
    double r[ROW], g[ROW], b[ROW];
    int64_t contributes[ROW]; /* -1 where it can change the film: at least half a film unit in some channel */
} lit_group;

/* The two branches at an interface: directions and weights; a weight of 0 is a branch that does not exist. */
typedef struct branch_group {
    double rx[ROW], ry[ROW], rz[ROW], reflect[ROW];
    double tx[ROW], ty[ROW], tz[ROW], refract[ROW];
    int64_t total; /* number of total internal reflections in the group */
} branch_group;

/* Contributions to the film, in its units. */
typedef struct film_light {
    film_sum r[ROW], g[ROW], b[ROW];
    int64_t out_of_range; /* negative if some are out of the film's range, which are left out; otherwise 0 */
} film_light;

/* Fills g from rays list[0..count-1] of a batch; ascending: the list is; first is the batch's start in the queue;
 * ior: by priority index. Not a kernel: scalar copies are faster than the gather instructions of the processors it
 * was measured on. */
void group_gather(const ray_queue *q, int first, const hit_batch *hits, const double *ior, const int *list, int count,
                  bool ascending, group *g);

typedef struct cut_sum {
    int64_t branches, throughput[3];
} cut_sum;

typedef struct shade_kernels {
    /* The material's colour at the points of its surface on p: checker cells in the solid's own frame. */
    void (*color)(const material *m, const primitive *p, group *g);
    /* Phong's direct light of one light at every point, weighted by the throughput. */
    void (*direct)(const material *m, const light *lamp, const group *g, lit_group *lit);
    /* Multiplies this light by the share that the cone emits towards the point. */
    void (*spot)(const light_cone *c, bool soft, const group *g, lit_group *lit);
    /* Reflected and refracted directions with Fresnel weights at a clear surface, including its coating, which reflects
     * a share of what would be transmitted: R' = R + (1 - R) reflectivity. */
    void (*fresnel_branches)(const material *m, const group *g, branch_group *b);
    /* The same with the material's constant weights; opaque surfaces too. */
    void (*constant_branches)(const material *m, bool opaque, const group *g, branch_group *b);
    /* Undeflected transmission at a clear surface, with the material's constant weights. */
    void (*straight_branches)(const material *m, const group *g, branch_group *b);
    /* Adds branches that the depth limit cuts off to *sum: their number, and their throughput in units of
     * 1/COUNTERS_CUT_ONE. */
    void (*cut)(const group *g, const branch_group *b, cut_sum *sum);
    /* The light of a group in film units: a surface's own, of that radiance in its colour; and that of the branches
     * that the depth limit cuts off, the same for all directions. */
    void (*own_light)(const group *g, vec3 radiance, film_light *out);
    void (*cut_light)(const group *g, const branch_group *b, vec3 radiance, film_light *out);
    /* The shares of the rays' radiance in film units. */
    void (*arrived)(int count, const double *share, const double *r, const double *g, const double *b, film_light *out);
    /* Appends all of g to q as rays along (dx, dy, dz) with throughput times weight; the caller then removes rays of
     * weight 0. */
    void (*append)(const group *g, const double *dx, const double *dy, const double *dz, const double *weight,
                   const uint64_t *inside, ray_queue *q);
    /* Transmittances of optical depths, in place: 1 for 0. */
    void (*absorb)(double *depth, int count);
    texture_tinter *tint; /* a texture's colours */
} shade_kernels;

ISA_DECLARE(const shade_kernels, shade_kernels)
