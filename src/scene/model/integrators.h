/* The integrators: the words of render.integrator and the traits that the rest of the program queries. A new integrator
 * is a row here and a file in src/render/integrators; render's dispatch table is made from the same rows. Constant. */
#pragma once

#include <stdbool.h>

/* Columns: name, word, traits. */
#define INTEGRATORS(X)                 \
    X(RAYCAST, raycast, .tree = false) \
    X(WHITTED, whitted, .tree = true)  \
    X(PATH, path, .by_chance = true)   \
    X(ZBUFFER, zbuffer, .drawn = true) \
    X(AOV, aov, .unlit = true, .layers = true)

#define INTEGRATOR_NUMBER(name, word, ...) INTEGRATOR_##name,
typedef enum integrator_rule { INTEGRATORS(INTEGRATOR_NUMBER) INTEGRATOR_COUNT } integrator_rule;
#undef INTEGRATOR_NUMBER

typedef struct integrator_traits {
    bool tree;      /* traces both branches at each interface, depending on render.lighting (Whitted 1980) */
    bool by_chance; /* traces random paths, render.paths per pixel, which sample the area of lights */
    bool drawn;     /* rasterises triangles into a depth buffer; traces no rays and no light paths */
    bool unlit;     /* shows what camera rays hit, no light: lamps and tone mapping do not matter */
    bool layers;    /* writes the named layers below */
} integrator_traits;

extern const char *const integrator_words[];
extern const integrator_traits integrator_table[];

/* The word of the first integrator that writes layers; NULL if there is none. */
const char *integrator_with_layers(void);

/* Named layers, the words of render.layer: values per pixel that an integrator with layers writes. Columns: name, word,
 * number of values. */
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
