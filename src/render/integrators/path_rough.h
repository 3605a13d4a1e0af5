/* Rough surfaces on random paths: which facet a path meets, and the lamps' direct light. Each lamp is sampled twice: a
 * point of its sphere, and the path's own direction, where that meets the sphere; the two are weighted by the balance
 * heuristic, so that lamps of any size have little noise on surfaces of any roughness (Veach and Guibas, "Optimally
 * Combining Sampling Techniques for Monte Carlo Rendering", SIGGRAPH 1995, (15)). Both send shadow rays; the path
 * itself then does not hit a lamp. Functions of the tracer's gathered group; nothing fails. */
#pragma once

#include "render/integrators/path_continue.h"
#include "render/shade/rough.h"

/* Weight of the matte branch at an opaque surface, next to that of its mirror. */
double path_matte_weight(const group *g, const material *m, int k);

/* Enqueues shadow rays to lamps, draws the paths' facets, and computes the branches there. */
void path_rough_begin(tracer *t, double alpha, bool opaque, int depth, rough_surface *r);

/* Applies the surface to the branch that was drawn at a facet; false if it ends there. */
bool path_rough_scatter(tracer *t, const rough_surface *r, int k, continuation *c);
