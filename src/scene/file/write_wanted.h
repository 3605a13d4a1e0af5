/* Which of a scene's parameters its file needs to say. Pure. */
#pragma once

#include "scene/model/params_path.h"

/* Would a reader have another value without the line? all: or the same one, unless the line would set aside what is in
 * use. value is the row's, as text. */
status write_is_wanted(const scene *s, const param_place *at, const char *value, bool all, bool *wanted,
                       diagnostic *why);
