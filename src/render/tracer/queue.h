/* A ray queue: rays that wait to be traced, as a structure of arrays; last in, first out, which keeps the number of
 * waiting rays small. Ownership: queue_create allocates, queue_destroy releases; each queue belongs to one worker. */
#pragma once

#include "base/vec3.h"
#include "geometry/rays.h"
#include <stdbool.h>

/* The ray's neighbours, one sample of the image away in its two directions x and y (Igehy, "Tracing Ray Differentials",
 * SIGGRAPH 1999). If the ray has the origin o and the direction d, the neighbour at (x, y) passes, to first order,
 * through o + x shift[0] + y shift[1] in the direction d + x turn[0] + y turn[1]. Any multiple of d may be added to a
 * shift. All zeros: unknown. */
typedef struct ray_footprint {
    vec3 shift[2], turn[2];
    bool bent;        /* it met a curved surface */
    bool rough_guess; /* it met a surface of unknown curvature, which was treated as flat */
} ray_footprint;

typedef struct ray_queue {
    int count, capacity;
    double *ox, *oy, *oz, *dx, *dy, *dz;
    double *wr, *wg, *wb;        /* throughput; for a shadow ray the radiance that it contributes if unblocked */
    int64_t *start, *sample_key; /* start: face on which the ray starts; sample_key: see render/plan/sampling.h */
    uint64_t *inside;
    /* with polarisation: the analyser's Stokes vector relative to its first element, also for shadow rays in a scene
     * with sheets; in a crystal sq is the mode (render/shade/shading.h) */
    double *sq, *su, *sv;
    double *passed, *bent; /* for photons: lengths of the path so far, and of its part after the first surface */
    /* for shadow rays to polarised lamps: the lamp's linear Stokes elements; in the memory of passed and bent */
    double *lamp_q, *lamp_u;
    ray_footprint *footprint; /* for camera rays in scenes with photons (render/shade/footprints.h); else NULL */
    void *memory;
} ray_queue;

/* Memory of a queue, bytes. */
size_t queue_bytes(int capacity);
bool queue_create(ray_queue *q, int capacity);
/* Adds the rays' footprints, if the queue has none; false when out of memory. */
bool queue_add_footprints(ray_queue *q);
void queue_destroy(ray_queue *q);

/* Pops a batch from the end: at most BATCH rays, chosen so that the number of remaining rays is a multiple of the
 * widest vector. The view is valid until rays are added. */
ray_batch queue_pop(ray_queue *q, int *first);
