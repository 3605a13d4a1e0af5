/* The named layers of a frame: arrays of per-pixel values that an integrator writes in addition to the film, row by row
 * as in the film. Ownership: layers_create allocates, layers_destroy releases. Different threads may write different
 * pixels. */
#pragma once

#include "base/vec3.h"
#include "scene/model/integrators.h"
#include <stdint.h>

typedef struct layer_set {
    float *values[LAYER_COUNT]; /* [pixel * layer_channels + channel]; 0 where rays hit nothing */
} layer_set;

/* All values are 0. Returns NULL when out of memory. */
layer_set *layers_create(int width, int height);
uint64_t layers_bytes(void);       /* per pixel */
void layers_destroy(layer_set *l); /* NULL is allowed */

/* A layer of one channel takes value.x. */
static inline void layers_put(layer_set *l, layer_rule which, int64_t pixel, vec3 value)
{
    float *at = l->values[which] + pixel * layer_channels[which];
    at[0] = (float)value.x;
    if (layer_channels[which] == 3)
        at[1] = (float)value.y, at[2] = (float)value.z;
}
