#include "scene/model/layers.h"

#include <stddef.h>

#define WORD(name, word, channels) #word,
const char *const layer_words[] = {LAYERS(WORD) NULL};

#define CHANNELS(name, word, channels) channels,
const int layer_channels[LAYER_COUNT] = {LAYERS(CHANNELS)};
