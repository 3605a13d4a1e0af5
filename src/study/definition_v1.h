/* The definition as rows carried it before version 2 of it: a fingerprint of every parameter of the program of that
 * time, defaults too, of the number of each solid's shape, and of what files hold. Rows of that time are known again by
 * it. */
#pragma once

#include "study/study.h"

/* What that program would have said; false where it could not have read the study: a parameter that came later is not
 * at its default, or a solid has a later shape. Files have been loaded. */
bool definition_v1(const study *s, uint64_t *hash);
