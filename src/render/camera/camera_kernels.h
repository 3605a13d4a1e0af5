/* The kernels of camera rays, compiled once for each instruction set. The caller owns all arrays, of at most ROW
 * elements; nothing fails. */
#pragma once

#include "base/isa.h"
#include "scene/model/camera.h"

/* Points on the lens, as uniform random numbers: the share of its area nearer to the centre, and of a turn. */
typedef struct lens_points {
    const double *area, *turn;
} lens_points;

typedef struct camera_rays_out {
    double *ox, *oy, *oz, *dx, *dy, *dz;
} camera_rays_out;

typedef struct camera_kernels {
    /* Directions of the rays of a perspective pinhole camera through the image points (u, v). */
    void (*directions)(const camera_frame *view, int count, const double *u, const double *v, double *dx, double *dy,
                       double *dz);
    /* Rays of any camera. A lens radius of 0 gives the chief rays. */
    void (*rays)(const camera_frame *view, int count, const double *u, const double *v, lens_points lens,
                 camera_rays_out out);
} camera_kernels;

/* camera_rays.c: the chief rays of any camera. */
struct tracer;
void camera_chief_rays(const struct tracer *t, int count, const double *u, const double *v, camera_rays_out out);

ISA_DECLARE(const camera_kernels, camera_kernels)
