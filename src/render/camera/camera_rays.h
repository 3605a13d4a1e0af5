/* The camera rays of a pixel's samples. Functions of the tracer; nothing fails. */
#pragma once

#include "render/shade/kernels.h"
#include "render/tracer/tracer.h"

/* The camera rays of each pixel: one per sample; with a spectral film, one per sample and wavelength. */
camera_sampling camera_samples(const render_settings *r);

/* Enqueues rays first .. first + count - 1 of a row of pixels that starts at x0. */
void camera_rays_enqueue(tracer *t, int y, int x0, int64_t first, int count);

/* The chief rays of any camera, through the image points (u, v). */
void camera_chief_rays(const tracer *t, int count, const double *u, const double *v, camera_rays_out out);
