/* The part of a study file that refers to parameters: the fixed settings and the grid. For study/read.c. */
#pragma once

#include "scene/file/document.h"
#include "study/study.h"

/* Validates every path and value on s->base, applies the fixed ones to it, and fills s->fixed and s->axes. set and grid
 * may be NULL. */
status read_grid(study *s, const document *d, const node *set, const node *grid, diagnostic *why);

/* Validates the reference's paths and values on a copy of s->base, and fills s->reference. reference may be NULL. */
status read_reference(study *s, const document *d, const node *reference, diagnostic *why);

/* Whether the text has no control characters: a row must be one line. */
bool read_grid_plain(const char *text);
