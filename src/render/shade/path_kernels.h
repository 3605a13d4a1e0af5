/* The kernels of random paths: random numbers and directions of a group of rays, compiled once for each instruction
 * set. The caller owns all arrays, of at most ROW elements; nothing fails. */
#pragma once

#include "base/isa.h"
#include "render/core/path_sampling.h"
#include "render/shade/shade.h"

/* Points of spheres, as seen from the points of a group. */
typedef struct sphere_samples {
    double x[ROW], y[ROW], z[ROW], radius[ROW]; /* the sphere; its centre from the point */
    double u[ROW], v[ROW];                      /* random numbers */
    /* Results: the unit direction, uniform over the cone that the sphere fills; 1 - the cosine of the cone's half
     * angle; the distance to the sphere; the cosine to the normal, 0 from within the sphere. */
    double dx[ROW], dy[ROW], dz[ROW], cap[ROW], reach[ROW], n_l[ROW];
} sphere_samples;

/* The lights' parameters as arrays, of whole blocks, padded with lights of strength 0. */
enum { LAMP_BLOCK = 8, LAMPS_MAX = (SCENE_LIGHTS_MAX + LAMP_BLOCK - 1) / LAMP_BLOCK * LAMP_BLOCK };
typedef struct lamp_table {
    int blocks;
    bool cones; /* some are cone lights that are points */
    bool suns;  /* some are suns, whose strength here is 0: light_choice.c weighs them */
    double x[LAMPS_MAX], y[LAMPS_MAX], z[LAMPS_MAX];
    float radius[LAMPS_MAX], strength[LAMPS_MAX]; /* intensity; with falloff, times the square of the reach */
    float even[LAMPS_MAX], falling[LAMPS_MAX];    /* 1 and 0 for a light without falloff, otherwise 0 and 1 */
} lamp_table;

typedef struct path_kernels {
    /* path_draw for each sample key. */
    void (*draw)(const path_sampling *p, int count, const int64_t *sample_key, int depth, int purpose, double *u,
                 double *v);
    /* Unit directions about the normals of g's points by the cosine law. */
    void (*cosine)(const group *g, const double *u, const double *v, double *dx, double *dy, double *dz);
    void (*spheres)(const group *g, sphere_samples *s);
    /* The rays, -1 each, whose lines ahead pass within the radius of a centre, and some that just miss; returns whether
     * there are any. */
    bool (*near_sphere)(const ray_batch *rays, vec3 centre, double radius, int64_t *near);
    /* An estimate of each light's radiance at a point with normal n, for the choice of one:
     * weight[blocks * LAMP_BLOCK]. Lights below the horizon have none, unless n is 0 and `least` below 0. */
    void (*light_weights)(const lamp_table *lamps, vec3 point, vec3 n, float k_d, float k_s, float least,
                          float *weight);
} path_kernels;

ISA_DECLARE(const path_kernels, path_kernels)
