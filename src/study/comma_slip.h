/* Commas in place of decimal points in the list of an axis: [1.3, 1,4] has three values, not two. Such a list is valid,
 * so there is a note, not an error. Pure except for memory; the study owns the notes. */
#pragma once

#include "scene/file/document.h"
#include "study/study.h"

enum { COMMA_SLIP_TEXT_MAX = 64 };

/* Whether items i and i + 1 of a list of values are probably one number, which is then written to joined ("1.4"). Both
 * are integers. Either the second begins with 0, as in [1,05, 2]; or they are the whole list of a real parameter, one
 * digit and several, as in [1,33]; or the list has decimal points, and the comma between them has no blank after it
 * although another one has, or the values increase or decrease steadily with the number but not with the two integers.
 * real: whether the parameter is a real number. */
bool comma_slip_at(const node *list, size_t i, bool real, char joined[COMMA_SLIP_TEXT_MAX]);

/* Adds a note for each such pair in the list of values of path. */
status comma_slip_note(study *s, const char *path, const node *list, bool real, diagnostic *why);
