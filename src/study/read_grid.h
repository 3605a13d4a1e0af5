/* The part of a study file that names parameters: what is set, and the grid. For study/read.c. */
#pragma once

#include "scene/file/document.h"
#include "study/study.h"

/* Tries every path and value on s->base, sets the fixed ones in it, and fills s->fixed and s->axes. set and grid
 * may be NULL. */
status read_grid(study *s, const document *d, const node *set, const node *grid, diagnostic *why);

/* Tries the reference's paths and values, on a copy of s->base, and fills s->reference. reference may be NULL. */
status read_reference(study *s, const document *d, const node *reference, diagnostic *why);

/* Reads a study from its text into s, which has its path; what read makes of it is *out, else s is released. context is
 * read's. */
typedef status study_parts(study *s, const document *d, const void *context, diagnostic *why);
status study_parse(study *s, const char *text, size_t size, study_parts *read, const void *context, study **out,
                   diagnostic *why);

/* Has the text no control characters? A row is one line. */
bool read_grid_plain(const char *text);
