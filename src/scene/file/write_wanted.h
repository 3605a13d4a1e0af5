/* Selects the parameters that a scene's file must contain. Pure. */
#pragma once

#include "scene/model/params_path.h"

/* Whether a reader would have another value without the line. all: or the same value, unless the line would replace a
 * setting in use. value is the row's, as text. */
status write_is_wanted(const scene *s, const param_place *at, const char *value, bool all, bool *wanted,
                       diagnostic *why);
