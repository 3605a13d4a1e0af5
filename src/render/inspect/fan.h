/* A fan or pencil of rays, each followed along its refracted path (probe_path), and the results: the points where
 * neighbours cross, which form the caustic, and the point nearest to all exit rays, the mean focus.
 *
 * Ownership: the caller owns a fan; zero it before its first use, release it with fan_release. */
#pragma once

#include "render/inspect/probe.h"

enum { FAN_RAYS_MAX = 100000 };

typedef struct fan_rule {
    vec3 from, to; /* the axis; the rays start around `from` */
    bool has_normal;
    /* of the plane of the rays; only its part perpendicular to the axis is used. Without it: up if from and to are
     * equally high, else horizontal, so that the plane is vertical */
    vec3 normal;
    int rays; /* 1 .. FAN_RAYS_MAX */
    /* true: all rays from one point, spread_deg between the first and the last; false: parallel, over width */
    bool spreads;
    double width, spread_deg; /* scene units; degrees, less than 180 */
} fan_rule;

typedef struct fan_ray {
    double offset;                   /* from the axis: scene units, or degrees if the fan spreads */
    size_t first, count;             /* its nodes */
    bool leaves;                     /* its path was followed to its end: into the sky, or to an opaque surface */
    vec3 exit_point, exit_direction; /* start and direction of the last segment */
    double reach;                    /* length of the last segment; infinite into the sky */
    double deviation_deg;            /* between the first direction and the last */
    double weight;                   /* throughput of the last segment, mean of the channels */
    bool crosses_axis;               /* the last segment crosses the axis, in projection along the plane's normal */
    double axis_at;                  /* position of this crossing: distance from `from` along the axis */
    vec3 axis_point;
} fan_ray;

/* The crossing of the last segments of rays `ray` and `ray` + 1, which hit the same surfaces in the same order. */
typedef struct fan_crossing {
    int ray;
    vec3 at;
} fan_crossing;

typedef struct fan {
    vec3 from, axis, across, normal; /* orthonormal */
    fan_ray *ray;
    int count;
    ray_node *node;
    size_t node_count, node_capacity;
    fan_crossing *crossing;
    int crossing_count;
    bool has_focus;   /* false if the deflected rays are parallel, or fewer than two */
    vec3 focus;       /* the point with the least sum of squared distances to the lines of the deflected exit rays */
    double focus_rms; /* root mean square of these distances, scene units */
    bool is_virtual;  /* the focus is behind the exit rays */
} fan;

status fan_trace(probe *p, const fan_rule *rule, fan *out, diagnostic *why);
void fan_release(fan *f);
