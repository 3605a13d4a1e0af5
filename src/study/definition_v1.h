/* Version 1 of the definition hash: a hash of all parameters of the program of that time, including defaults, of the
 * number of each solid's shape, and of the contents of files. It identifies old rows. */
#pragma once

#include "study/study.h"

/* The hash that the old program would have computed; false if it could not have read the study: a newer parameter is
 * not at its default, or a solid has a newer shape. Files must be loaded. */
bool definition_v1(const study *s, uint64_t *hash);
