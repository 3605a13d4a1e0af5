#include "scene/model/integrators.h"

#include <stddef.h>

#define WORD(name, word, ...) word,
const char *const integrator_words[] = {INTEGRATORS(WORD) NULL};

#define TRAITS(name, word, ...) [INTEGRATOR_##name] = {__VA_ARGS__},
const integrator_traits integrator_table[INTEGRATOR_COUNT] = {INTEGRATORS(TRAITS)};
