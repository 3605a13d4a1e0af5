/* How a random path goes on, from a surface or from a point where a medium scatters it. Functions of the tracer's
 * gathered group; nothing fails. */
#pragma once

#include "render/shade/shading.h"

/* The continuation of a path: direction, throughput factor by channel, and media. */
typedef struct continuation {
    vec3 direction, share;
    double q, u, v; /* with polarisation: the analyser's Stokes vector relative to its first element; 0: only the
                       intensity counts */
    uint64_t inside;
    bool refracted, matte;
    bool specular_bounce; /* the path may hit lamps */
} continuation;

/* Enqueues the continuation of ray k, unless it ends by Russian roulette or at the depth limit. */
void path_continue(tracer *t, int k, int depth, continuation *c);
