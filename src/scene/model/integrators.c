/* The tables of integrators and layers (integrators.h). */
#include "scene/model/integrators.h"

#include <stddef.h>

#define WORD(name, word, ...) #word,
const char *const integrator_words[] = {INTEGRATORS(WORD) NULL};

#define TRAITS(name, word, ...) {__VA_ARGS__},
const integrator_traits integrator_table[] = {INTEGRATORS(TRAITS)};

const char *integrator_with_layers(void)
{
    for (int i = 0; integrator_words[i]; i++)
        if (integrator_table[i].layers)
            return integrator_words[i];
    return NULL;
}

const char *const layer_words[] = {LAYERS(WORD) NULL};

#define CHANNELS(name, word, channels) channels,
const int layer_channels[LAYER_COUNT] = {LAYERS(CHANNELS)};
