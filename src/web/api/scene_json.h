/* The scene as pages see it: its objects, and a row for each of its parameters. */
#ifndef CUVETTE_WEB_API_SCENE_JSON_H
#define CUVETTE_WEB_API_SCENE_JSON_H

#include "scene/model/open.h"
#include <jansson.h>
#include <stdint.h>

/* What GET /api/scene answers. opened: where `initial` comes from. NULL when memory is out. */
json_t *scene_json(const scene *s, const scene *opened, uint64_t generation);

#endif
