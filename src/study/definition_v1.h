/* Version 1 of the definition hash: a hash of all parameters of the program of that time, including defaults, of the
 * number of each solid's shape, and of the contents of files. It identifies old rows. */
#pragma once

#include "study/study.h"

/* The hash that the old program would have computed. *is: whether it could have read the study; not if a newer
 * parameter is not at its default, or a solid has a newer shape. Files must be loaded. STATUS_FAILURE if the machine
 * lacks memory or cannot read a script. */
status definition_v1(const study *s, bool *is, uint64_t *hash, diagnostic *why);
