/* Commas in place of decimal points in the list of an axis: [1.3, 1,4] has three values, not two. Such a list is valid,
 * so there is a note, not an error. Pure except for memory; the study owns the notes. */
#pragma once

#include "scene/file/document.h"
#include "study/study.h"

enum { COMMA_SLIP_TEXT_MAX = 64 };

/* Whether items i and i + 1 of a list of values are probably one number, which is then written to joined ("1.4"). Both
 * are integers in a list with decimal points, and either the comma between them has no blank after it although another
 * one has, or the values increase or decrease steadily with the number but not with the two integers. */
bool comma_slip_at(const node *list, size_t i, char joined[COMMA_SLIP_TEXT_MAX]);

/* Adds a note for each such pair in the list of values of path. */
status comma_slip_note(study *s, const char *path, const node *list, diagnostic *why);
