/* Adaptive numbers of random paths (render.error): a pilot render of PILOT_PATHS paths per pixel gives the variance of
 * each pixel, from which the number of paths for the requested standard error follows. The pilot's paths do not enter
 * the film: a mean that stops when its own samples look good is biased (Kirk and Arvo, "Unbiased sampling techniques
 * for image synthesis", SIGGRAPH 1991). The caller owns and frees the counts. */
#pragma once

#include "render/core/renderer.h"
#include "scene/model/render_settings.h"

enum { PILOT_PATHS = 16 };

/* Whether the number of paths differs between pixels. */
static inline bool path_counts_apply(const render_settings *r)
{
    return integrator_traits_of(r)->by_chance && r->error > 0.0 && r->paths > PILOT_PATHS;
}

/* The settings of the pilot: a seed that no scene has. */
render_settings path_counts_pilot(const render_settings *r);

/* The number of paths of each pixel: a multiple of the replicates of r, at most r->paths. */
status path_counts_create(const render_settings *r, const render_result *pilot, uint32_t **out, diagnostic *why);
