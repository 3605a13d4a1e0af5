/* What the loaders of a scene's files share. Pure but for the diagnostic. */
#pragma once

#include "scene/model/open.h"

/* Passes on what is wrong with an asset (its name, in messages): located where the scene file names it, at line and
 * column, or where bad is, if line is 0. Returns code. */
status asset_error(const scene *s, const char *what, long line, long column, const diagnostic *bad, status code,
                   diagnostic *why);
