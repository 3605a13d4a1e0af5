/* What the media that rays pass through leave of their light. Ownership: absorption_begin gives the tracer its memory,
 * absorption_end frees it. */
#pragma once

#include "render/core/queue.h"
#include "render/core/tracer.h"

typedef struct media_work {
    medium_segments segments;
    const int64_t *sample_keys; /* of the batch whose ways are noted */
    double kept[3][ROW];        /* share of light that the way to the hit left, by channel */
} media_work;

/* For a frame whose media absorb, if they do: false when memory is out. */
bool absorption_begin(tracer *t, bool absorbs);
void absorption_end(tracer *t);

/* Before a batch is looked at, whose ways are then noted; of one that looked for its nearest interfaces, the
 * surroundings are spared on ways to the sky; and the batch dimmed. */
void absorption_announce(tracer *t, const int64_t *sample_keys, int count);
void absorption_spare_sky(tracer *t);
void absorption_dim(tracer *t, ray_queue *q, int first, int count);
double absorption_left(double optical_depth);
