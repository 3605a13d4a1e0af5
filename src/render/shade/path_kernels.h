/* The kernels of random paths: random numbers and directions of a group of rays, compiled once for each instruction
 * set. The caller owns all arrays, of at most ROW elements; nothing fails. */
#pragma once

#include "render/core/path_sampling.h"
#include "render/shade/shade.h"

/* Points of spheres, as seen from the points of a group. */
typedef struct sphere_samples {
    double x[ROW], y[ROW], z[ROW], radius[ROW]; /* the sphere */
    double u[ROW], v[ROW];                      /* random numbers */
    /* Results: the unit direction, uniform over the cone that the sphere fills; 1 - the cosine of the cone's half
     * angle; the distance to the sphere; the cosine to the normal, 0 from within the sphere. */
    double dx[ROW], dy[ROW], dz[ROW], cap[ROW], reach[ROW], n_l[ROW];
} sphere_samples;

typedef struct path_kernels {
    /* path_draw for each sample key. */
    void (*draw)(const path_sampling *p, int count, const int64_t *sample_key, int depth, int purpose, double *u,
                 double *v);
    /* Unit directions about the normals of g's points by the cosine law. */
    void (*cosine)(const group *g, const double *u, const double *v, double *dx, double *dy, double *dz);
    void (*spheres)(const group *g, sphere_samples *s);
} path_kernels;

extern const path_kernels path_kernels_sse2, path_kernels_avx2, path_kernels_avx512;
