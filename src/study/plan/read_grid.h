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

/* Whether items i and i + 1, two integers, are probably one number, which is then written to joined ("1.4"). One of
 * these is the case:
 * - No blank follows the comma, and the second integer has several digits and begins with 0: [1,05, 2].
 * - No blank follows the comma, the parameter is real (`real`), and the list has only these integers, the first of one
 *   digit and the second of several: [1,33].
 * - Another item has a decimal point, and no blank follows this comma although one follows another comma.
 * - Another item has a decimal point, and the values increase or decrease steadily if the two are one number, but not
 *   if they are two. */
bool comma_slip_at(const node *list, size_t i, bool real, char joined[COMMA_SLIP_TEXT_MAX]);

/* Adds a note for each decimal comma in the list of values of path. */
status comma_slip_note(study *s, const char *path, const node *list, bool real, diagnostic *why);
