/* The tracer's inside, shared by tracer.c (which rays when), by what shades (render/shade) and by the integrators. */
#pragma once

#include "render/core/sample_key.h"
#include "render/integrators/integrator.h"
#include "render/shade/absorption.h"
#include "render/shade/mesh_shading.h"
#include "render/shade/radiance.h"
#include "render/shade/shade.h"

/* Rays that wait until there is a batch of them. */
typedef struct tracer_queues {
    int depth_limit, made;
    ray_queue *waiting; /* by depth, 0 .. depth_limit */
    ray_queue shadows;
} tracer_queues;

/* What was counted since the frame began. */
typedef struct tracer_account {
    ray_counters counters;
    int64_t visibility_ns; /* of a scene with meshes: in the geometry's kernels */
    uint64_t frame;        /* of its tracer_pool, in which it was last begun; 0 before */
    int64_t overflow;      /* negative: a sum or contribution left the film's range */
} tracer_account;

/* A batch of rays, and what it met. */
typedef struct tracer_batch {
    ray_scratch scratch;
    /* crossed is -1 for rays that met nothing, below it for those that ended at what only the integrator knows */
    _Alignas(64) hit_batch hits;
    _Alignas(64) double transmitted[ROW];                          /* of shadow rays */
    int list[PRIMITIVES_MAX + 2][ROW], listed[PRIMITIVES_MAX + 2]; /* see sort_by_primitive */
} tracer_batch;

/* Stokes vectors relative to their first element, of a group and of its two branches. */
typedef struct polar_group {
    double q[ROW], u[ROW], v[ROW], rq[ROW], ru[ROW], rv[ROW], tq[ROW], tu[ROW], tv[ROW];
} polar_group;

/* Rays of the batch that met one surface, gathered, and what is worked out about them. */
typedef struct tracer_surface {
    group gathered;
    _Alignas(64) lit_group lit;
    _Alignas(64) branch_group branches;
    polar_group polar;
    const shading_material *mat;
    const vec3 *texture_at; /* where the texture is looked up, unless at the points themselves: then NULL */
    bool on_mesh;
} tracer_surface;

struct tracer {
    const geometry_kernels *geometry;
    const shade_kernels *shade;
    tracer_target target;
    const integrator *rule; /* of the frame; NULL before the first */
    void *own;              /* the integrator's, of this worker */
    double least_weight;    /* a branch that weighs less is not followed: render.min_weight, for its share of the camera
                               ray */
    bool by_sample_key;     /* the film wants more of a ticket than its pixel */
    tracer_queues queues;
    tracer_account account;
    mesh_work *meshes;               /* once a scene with meshes has been traced; NULL before, and so on */
    media_work *media;               /* one that absorbs */
    radiance_work *basic;            /* one of basic radiance */
    _Alignas(64) tracer_batch batch; /* whole vectors on whole cache lines, here and above */
    _Alignas(64) tracer_surface surface;
};

/* A build without counters compiles the statement and throws it away. */
#define COUNT(statement) ((void)(CUVETTE_COUNTERS ? (statement) : 0))

/* Runs one batch of a queue (depth -1: shadow rays), and gives each pixel its share of the time and its rays if that is
 * wanted. */
void tracer_run_batch(tracer *t, int depth);

/* Puts the camera rays of one pixel of an rgb film in line; returns how many. */
int tracer_camera_rays(tracer *t, int x, int y);

/* camera_rays.c: rays first .. first + count - 1 of a row of pixels from x0 on. */
void camera_rays_put_in_line(tracer *t, int y, int x0, int64_t first, int count);
