/* Named layers: additional values per pixel that an integrator may write besides the film, and the words of
 * render.layer. Constant. */
#pragma once

/* Name, word, values per pixel. */
#define LAYERS(X)            \
    X(NORMAL, normal, 3)     \
    X(ALBEDO, albedo, 3)     \
    X(DEPTH, depth, 1)       \
    X(SOLID, solid, 1)       \
    X(MATERIAL, material, 1) \
    X(POSITION, position, 3)

#define LAYER_NUMBER(name, word, channels) LAYER_##name,
typedef enum layer_rule { LAYERS(LAYER_NUMBER) LAYER_COUNT } layer_rule;
#undef LAYER_NUMBER

extern const char *const layer_words[]; /* ends with NULL */
extern const int layer_channels[LAYER_COUNT];
