/* Internals of the renderer, used only in this folder. */
#pragma once

#include "base/worker_pool.h"
#include "render/frame/renderer.h"
#include "render/frame/tracers.h"
#include "render/plan/plan.h"

struct renderer {
    const topology *machine;
    worker_pool *threads;
    tracer_pool *tracers;
};

/* frame.c: renders into a result of render_result_create; state: the integrator's state for the frame. */
status frame_run(renderer *r, const scene *s, const render_options *options, plan *p, void *state,
                 render_result *result, diagnostic *why);

/* render_result.c: allocates a result. render_map_create returns a map of zeros whose pages exist, or NULL when out of
 * memory. */
status render_result_create(const scene *s, const render_options *options, render_result **out, diagnostic *why);
double *render_map_create(size_t pixels);
film_space render_film_space(const scene *s);
