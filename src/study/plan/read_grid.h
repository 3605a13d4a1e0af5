/* The part of a study file that refers to parameters: the fixed settings and the grid. For study/plan/read.c. */
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

/* Commas in place of decimal points in the list of an axis (study/plan/comma_slip.c): [1.3, 1,4] has three values, not
 * two. Such a list is valid, so there is a note, not an error; the study owns it. */
enum { COMMA_SLIP_TEXT_MAX = 64 };

/* Whether items i and i + 1, two integers, are probably one number, which is then written to joined ("1.4"): if the
 * second begins with 0, as in [1,05, 2]; if the list of a real parameter has only them, one digit and several, as in
 * [1,33]; or if the list has decimal points, and either no blank follows their comma but one follows another comma, or
 * the values increase or decrease steadily with the number but not with the integers. real: the parameter is real. */
bool comma_slip_at(const node *list, size_t i, bool real, char joined[COMMA_SLIP_TEXT_MAX]);

/* Adds a note for each decimal comma in the list of values of path. */
status comma_slip_note(study *s, const char *path, const node *list, bool real, diagnostic *why);
