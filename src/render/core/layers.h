/* The named layers of a frame: numbers by pixel that an integrator gives beside the film, in its rows' order.
 * Ownership: layers_create gives, layers_destroy releases. Different pixels may be written by different threads. */
#pragma once

#include "base/vec3.h"
#include "scene/model/layers.h"
#include <stdint.h>

typedef struct layer_set {
    float *values[LAYER_COUNT]; /* [pixel * layer_channels + channel]; 0 where nothing was met */
} layer_set;

/* All 0. NULL when memory is out. */
layer_set *layers_create(int width, int height);
uint64_t layers_bytes(void);       /* a pixel */
void layers_destroy(layer_set *l); /* NULL is allowed */

/* Of a layer of one number: value.x. */
static inline void layers_put(layer_set *l, layer_rule which, int64_t pixel, vec3 value)
{
    float *at = l->values[which] + pixel * layer_channels[which];
    at[0] = (float)value.x;
    if (layer_channels[which] == 3)
        at[1] = (float)value.y, at[2] = (float)value.z;
}
