/* The integrators: the words of render.integrator, and what the rest of the program asks of each. A new one is a row
 * here and its own file in src/render/integrators; render's table of what they do is made from the same rows.
 * Constant. */
#pragma once

#include <stdbool.h>

/* Name, word, and the traits that it has. */
#define INTEGRATORS(X)                 \
    X(RAYCAST, raycast, .tree = false) \
    X(WHITTED, whitted, .tree = true)  \
    X(PATH, path, .by_chance = true)   \
    X(ZBUFFER, zbuffer, .drawn = true) \
    X(AOV, aov, .layers = true)

#define INTEGRATOR_NUMBER(name, word, ...) INTEGRATOR_##name,
typedef enum integrator_rule { INTEGRATORS(INTEGRATOR_NUMBER) INTEGRATOR_COUNT } integrator_rule;
#undef INTEGRATOR_NUMBER

typedef struct integrator_traits {
    bool tree;      /* both branches of each ray are followed, where render.lighting says so (Whitted 1980) */
    bool by_chance; /* random paths, render.paths a pixel, that see the lights' size */
    bool drawn;     /* triangles are drawn into a depth buffer; no ray is traced, and no light followed */
    bool layers;    /* of what camera rays meet first it gives named layers, and follows no light */
} integrator_traits;

extern const char *const integrator_words[];
extern const integrator_traits integrator_table[];

/* The word of the first one that gives layers; NULL if none does. */
const char *integrator_with_layers(void);
