/* Allocation of named layers. */
#include "render/core/layers.h"

#include <stdlib.h>

layer_set *layers_create(int width, int height)
{
    layer_set *l = calloc(1, sizeof *l);
    bool missing = !l;
    for (int i = 0; l && i < LAYER_COUNT; i++)
        missing |= !(l->values[i] = calloc((size_t)width * (size_t)height * (size_t)layer_channels[i], sizeof(float)));
    if (!missing)
        return l;
    layers_destroy(l);
    return NULL;
}

uint64_t layers_bytes(void)
{
    uint64_t sum = 0;
    for (int i = 0; i < LAYER_COUNT; i++)
        sum += (uint64_t)layer_channels[i] * sizeof(float);
    return sum;
}

void layers_destroy(layer_set *l)
{
    for (int i = 0; l && i < LAYER_COUNT; i++)
        free(l->values[i]);
    free(l);
}
