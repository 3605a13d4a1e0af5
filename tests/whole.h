/* Long cases and large numbers of random trials are for `make check`, which sets CHECK; `make test` has a part of them.
 * A slice of `make check` runs each file that includes this one. */
#pragma once

#include <stdbool.h>
#include <stdlib.h>

static inline bool is_whole(void)
{
    return getenv("CHECK") && *getenv("CHECK");
}

/* A tenth of the random trials in `make test`: the first ones of the same stream. */
static inline int trials_of(int whole)
{
    return is_whole() ? whole : whole / 10;
}

/* The first statement of a case that is left out by `make test`. */
#define ONLY_IN_CHECK() \
    if (!is_whole())    \
    skip()
