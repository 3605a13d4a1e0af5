/* The parts of the renderer, for this folder alone. */
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

/* frame.c: renders into a result that is prepared; state: the integrator's for the frame. */
status frame_run(renderer *r, const scene *s, const render_options *options, plan *p, void *state,
                 render_result *result, diagnostic *why);

/* render_result.c: the memory of a result; NULL or an error when out of memory. A map is of zeros that are really
 * written. */
status render_result_create(const scene *s, const render_options *options, render_result **out, diagnostic *why);
double *render_map_create(size_t pixels);
film_space render_film_space(const scene *s);
