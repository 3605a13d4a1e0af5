/* Double refraction in the tracer (optics/crystal.h). A ray that meets a crystal's surface, from outside or inside, has
 * up to four children instead of two. A ray in a crystal is of one mode, which its record keeps in place of Stokes's q:
 * 1 for an ordinary ray, -1 for an extraordinary one, with or without polarisation. Coatings and films are refused on
 * crystals, and a mesh's faces are flat for them. Ownership: crystals_begin allocates the tracer's memory, crystals_end
 * frees it. */
#pragma once

#include "optics/crystal.h"
#include "render/tracer/tracer.h"

/* The children of ray k of the gathered group. */
typedef struct crystal_children {
    int count;
    crystal_ray ray[CRYSTAL_RAYS_MAX];
} crystal_children;

/* Of the gathered group. */
typedef struct crystal_work {
    bool any;        /* some of its rays meet a crystal; the next arrays are of those */
    bool meets[ROW]; /* a crystal is on either side */
    optical_medium from[ROW], to[ROW];
    crystal_mode mode[ROW];
    crystal_children children[ROW];
} crystal_work;

bool crystals_begin(tracer *t); /* begins a frame; false when out of memory */
void crystals_end(tracer *t);

/* Notes the media and modes of the gathered group, which are rays list[0 ..] of the batch at `first` in their queue. */
void crystals_gather(tracer *t, const ray_queue *q, int first, const int *list);

/* The two below call these where some rays of the group meet a crystal. crystals_branches: computes their children, and
 * takes their two branches away. crystals_follow: enqueues the children, or cuts them off at the depth limit. */
void crystals_branches(tracer *t, bool opaque);
void crystals_follow(tracer *t, int depth);

/* Whether ray k of the gathered group meets a crystal. */
bool crystals_meet(const tracer *t, int k);
