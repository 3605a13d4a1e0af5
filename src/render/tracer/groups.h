/* Groups of rays for shading, as structures of arrays.
 *
 * Rays of a batch that hit one primitive on one region's surface are a group (hit_groups). Groups of one shading class
 * (plan.h) are neighbours in the list, so that they can be shaded as one: in a scene of many solids, small groups would
 * leave most lanes of a vector empty. A kernel gathers the rays into contiguous arrays (group), in which the shading
 * kernels compute light (lit_group) and branches (branch_group).
 *
 * Ownership: values; the table of marks belongs to the tracer. Cannot fail. */
#pragma once

#include "geometry/rays.h"
#include "render/plan/film.h"
#include "render/tracer/queue.h"

/* Rays first .. first + count - 1 of the list hit that primitive on the surface of the region with that priority
 * index. */
typedef struct hit_group {
    int hit_primitive, priority_index;
    int first, count;
} hit_group;

typedef struct hit_groups {
    int count;
    hit_group group[BATCH]; /* groups of one shading class are neighbours */
    int list[ROW];          /* numbers of the batch's rays */
    int missed, miss[ROW];  /* rays that hit nothing */
} hit_groups;

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
    int padded; /* count rounded up to whole vectors; the lanes past count repeat the last ray, and are never read */
} group;

/* Shadow rays to one light: direction, and the radiance that each contributes if unblocked. */
typedef struct lit_group {
    double lx[ROW], ly[ROW], lz[ROW]; /* from the point to the light, not normalised */
    double r[ROW], g[ROW], b[ROW];
    int64_t contributes[ROW]; /* -1 if it can change the film: at least half a film unit in some channel */
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
    int64_t out_of_range; /* negative if contributions out of the film's range were omitted; otherwise 0 */
} film_light;

/* Rays from a group's points, by lane. */
typedef struct new_rays {
    const double *dx, *dy, *dz, *r, *g, *b;
    const double *weight; /* of r, g, b; NULL: 1 */
    const uint64_t *inside;
    const int64_t *sample_key;
    const int64_t *exists; /* masks; NULL: rays of weight 0 do not exist */
} new_rays;

/* The kernels, one set per instruction set. */
typedef struct group_kernels {
    /* Lists the groups of a batch's hits. shading_class: by priority index (plan.h), below the number of priority
     * indices. marks: by primitive; class_marks: by shading class; all are -1 before and after. Classes, and the groups
     * of each class, are in the order of their first rays. */
    void (*list)(const hit_batch *hits, int count, const int *shading_class, int16_t *marks, int16_t *class_marks,
                 hit_groups *out);
    /* Fills g from rays list[0 .. count - 1] of a batch; ascending: whether the list is in ascending order; first: the
     * batch's start in the queue; ior: by priority index. Fastest where neighbours in the list are neighbours in the
     * batch. */
    void (*gather)(const ray_queue *q, int first, const hit_batch *hits, const double *ior, const int *list, int count,
                   bool ascending, group *g);
    /* Appends the rays that exist to q. Returns their number, and their lanes in `list`, in ascending order. */
    int (*append)(const group *g, const new_rays *n, int *list, ray_queue *q);
} group_kernels;

ISA_DECLARE(const group_kernels, group_kernels)
