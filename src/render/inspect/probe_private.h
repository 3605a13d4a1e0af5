/* Internals of the probe, shared by probe.c (the interface) and probe_build.c (building the tree). */
#pragma once

#include "render/frame/tracers.h"
#include "render/inspect/probe.h"
#include "render/tracer/tracer.h"

struct probe {
    scene *setting; /* a copy of the caller's scene */
    plan *frame_plan;
    tracer *rays;
    film *img;          /* one pixel */
    bool spectral;      /* the scene's film is spectral */
    const char *remedy; /* against too large a tree */
};

/* One record of a ray queue. */
typedef struct ray_record {
    vec3 origin, direction;
    double weight[3], stokes[3];
    int64_t start;
    uint64_t inside;
    int depth;
    int medium_priority_index; /* of the medium at its origin */
} ray_record;

status probe_check_ray(vec3 origin, vec3 direction, diagnostic *why);
ray_record probe_free_ray(const probe *p, vec3 origin, vec3 direction);

/* Copies record i of the queue of a depth. */
void probe_read_ray(const probe *p, int depth, int i, ray_record *out);

/* Adds a ray and all its descendants to the tree; *at is set to its index. */
status probe_build(probe *p, ray_tree *tree, const ray_record *ray, ray_kind kind, int parent, size_t *at,
                   diagnostic *why);

/* Adds a ray and one branch of each hit: see probe_path. */
status probe_follow(probe *p, ray_tree *tree, const ray_record *ray, int reflect_at, diagnostic *why);
