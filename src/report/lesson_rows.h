/* Lessons and their results as JSON, for `cuvette lesson show` and the laboratory. NULL when out of memory. */
#pragma once

#include "lesson/lesson.h"
#include <jansson.h>

json_t *lesson_json(const lesson *l);
json_t *lesson_result_json(const lesson *l, const lesson_result *r);
