/* Where two scenes differ: their parameters, by path. Ownership: scenes are borrowed, the list is the caller's. */
#ifndef CUVETTE_WEB_SESSION_CHANGED_H
#define CUVETTE_WEB_SESSION_CHANGED_H

#include "scene/model/open.h"
#include <jansson.h>

/* [{"path", "a", "b"}]: values as number, list or word, null where that scene has no such parameter or it is out of use
 * there; b's in their order, then those that only a has. What a solid has from its material in both is said of the
 * material alone. NULL when memory is out. */
json_t *changed_params(const scene *a, const scene *b);

#endif
