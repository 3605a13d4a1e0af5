#include "scene/model/integrators.h"

#include <stddef.h>

#define WORD(name, word, ...) #word,
const char *const integrator_words[] = {INTEGRATORS(WORD) NULL};

#define TRAITS(name, word, ...) {__VA_ARGS__},
const integrator_traits integrator_table[] = {INTEGRATORS(TRAITS)};
