/* Double refraction in the tracer (optics/crystal.h). A ray that meets a crystal's surface, from outside or inside, has
 * up to four children instead of two. A ray in a crystal has one mode, which is stored in place of Stokes's q: 1 for an
 * ordinary ray, -1 for an extraordinary one, with or without polarisation. Coatings and films are refused on crystals,
 * and meshes of crystals are shaded flat. Ownership: crystals_begin allocates the tracer's memory, crystals_end frees
 * it. */
#pragma once

#include "optics/crystal.h"
#include "render/tracer/tracer.h"

/* The children of ray k of the gathered group. */
typedef struct crystal_children {
    int count;
    crystal_ray ray[CRYSTAL_RAYS_MAX];
} crystal_children;

/* Media, modes and children of the gathered group's rays. */
typedef struct crystal_work {
    bool any;        /* some ray of the group meets a crystal; otherwise the following arrays are unused */
    bool meets[ROW]; /* a crystal is on at least one side */
    optical_medium from[ROW], to[ROW];
    crystal_mode mode[ROW];
    crystal_children children[ROW];
} crystal_work;

bool crystals_begin(tracer *t); /* begins a frame; false when out of memory */
void crystals_end(tracer *t);

/* Records the media and modes of the gathered group: rays list[0 ..] of the batch that starts at `first` in its
 * queue. */
void crystals_gather(tracer *t, const ray_queue *q, int first, const int *list);

/* Call these if some ray of the group meets a crystal. crystals_branches computes the children of such rays, and clears
 * their two ordinary branches; crystals_follow enqueues the children, or cuts them off. */
void crystals_branches(tracer *t, bool opaque);
void crystals_follow(tracer *t, int depth);

/* Whether ray k of the gathered group meets a crystal. */
bool crystals_meet(const tracer *t, int k);
