/* Shared code of the loaders of a scene's files. Pure except for the diagnostic. */
#pragma once

#include "image/image.h"
#include "scene/model/open.h"

/* Passes on an error of an asset (name, for messages): located where the scene file refers to it, at line and column,
 * or, if line is 0, at bad. Returns code. */
status asset_error(const scene *s, const char *what, long line, long column, const diagnostic *bad, status code,
                   diagnostic *why);

/* Whether an image can be a sky: its radiance must not be negative, and must fit the film. path: for the diagnostic. */
status sky_check(const image *sky, const char *path, diagnostic *bad);
