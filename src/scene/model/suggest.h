/* What to suggest in place of a wrong word of a scene or study file, or of a path. Pure. */
#pragma once

#include <stdbool.h>
#include <stddef.h>

/* The word of words[0..count-1] that was meant: another name of it (n and index for ior, opacity for transparency), the
 * only one that wrong begins (fov for fov_deg), or the nearest in spelling. NULL when there is none; for a number, and
 * for one or two characters, to which every short word is near, only another name is given. */
const char *suggest_word(const char *wrong, const char *const *words, size_t count);

/* The remedy for a wrong key where words[] are the right ones; returns text. */
char *suggest_key(const char *wrong, const char *const *words, size_t count, char *text, size_t size);

/* "prefix" and "a, b, c", cut at the end of the buffer. */
void suggest_list(const char *prefix, const char *const *words, size_t count, char *text, size_t size);
