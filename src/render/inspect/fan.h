/* Many rays of one pencil or fan, each followed along its refracted way (probe_path), and what becomes of them
 * together: where neighbours cross, which is the caustic, and the point that all exit rays pass nearest, the mean
 * focus.
 *
 * Ownership: a fan is the caller's; zero it before its first use, release it with fan_release. */
#pragma once

#include "render/inspect/probe.h"

enum { FAN_RAYS_MAX = 100000 };

typedef struct fan_rule {
    vec3 from, to; /* the axis; its rays set out around `from` */
    bool has_normal;
    vec3 normal;  /* of the plane of the rays; the part of it across the axis counts. Without it: up, where from and to
                   * are equally  high, else level, so that the plane is upright */
    int rays;     /* 1 .. FAN_RAYS_MAX */
    bool spreads; /* true: all from one point, spread_deg from the first to the last; false: parallel, width across */
    double width, spread_deg; /* scene units; degrees, less than 180 */
} fan_rule;

typedef struct fan_ray {
    double offset;                   /* from the axis: scene units, or degrees of a fan that spreads */
    size_t first, count;             /* its nodes */
    bool leaves;                     /* its way was followed to its end: into the sky, or onto something opaque */
    vec3 exit_point, exit_direction; /* of its last straight piece */
    double reach;                    /* how long that is; infinite into the sky */
    double deviation_deg;            /* between the first direction and the last */
    double weight;                   /* throughput of the last piece, mean of the channels */
    bool meets_axis;                 /* the last piece does, as seen along the plane's normal */
    double axis_at;                  /* there: distance from `from` along the axis */
    vec3 axis_point;
} fan_ray;

/* Where the last pieces of rays `ray` and `ray` + 1 cross, of neighbours that crossed the same surfaces. */
typedef struct fan_crossing {
    int ray;
    vec3 at;
} fan_crossing;

typedef struct fan {
    vec3 from, axis, across, normal; /* unit vectors at right angles */
    fan_ray *ray;
    int count;
    ray_node *node;
    size_t node_count, node_capacity;
    fan_crossing *crossing;
    int crossing_count;
    bool has_focus;   /* false when the rays that bend are parallel, or fewer than two */
    vec3 focus;       /* the point whose sum of squared distances to the lines of the bent exit rays is least */
    double focus_rms; /* root of the mean of these, scene units */
    bool is_virtual;  /* it lies behind them */
} fan;

status fan_follow(probe *p, const fan_rule *rule, fan *out, diagnostic *why);
void fan_release(fan *f);
