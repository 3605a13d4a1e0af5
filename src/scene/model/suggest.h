/* Suggestions for a wrong word of a scene file, a study file or a path. Pure. */
#pragma once

#include <stdbool.h>
#include <stddef.h>

/* The word of words[0..count-1] that was probably meant: a synonym (n and index for ior, opacity for transparency), the
 * only word that begins with wrong (fov for fov_deg), or the nearest in spelling. NULL if there is none; numbers and
 * words of one or two characters, to which every short word is near, match only synonyms. */
const char *suggest_word(const char *wrong, const char *const *words, size_t count);

/* The remedy for a wrong key if words[] are the valid ones; returns text. */
char *suggest_key(const char *wrong, const char *const *words, size_t count, char *text, size_t size);

/* "prefix" and "a, b, c"; what has no room in the buffer is left out: "a, b, ...". */
void suggest_list(const char *prefix, const char *const *words, size_t count, char *text, size_t size);
