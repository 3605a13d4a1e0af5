/* Values of jansson, read and built so that a lack of memory is noticed. Ownership: as in jansson; a text is the
 * caller's, freed with free. */
#pragma once

#include <jansson.h>
#include <stdbool.h>
#include <stddef.h>

/* jansson 2.14 ends the program, or loses characters in silence, when memory runs out while it parses or copies a
 * value. A program that calls this before any value is made supplies a reserve for that moment, so that values stay
 * complete; the library does not, since jansson has one allocator per process. Texts of json_dumps may then not be
 * released with free: use json_text. */
void json_memory_reserve(void);

/* json_loadb, run twice: when memory runs out, jansson may lose an item or report an error in the text. *no_memory:
 * whether memory ran out. */
json_t *json_parse(const char *text, size_t size, size_t flags, json_error_t *error, bool *no_memory);

/* json_dumps into memory that the caller releases with free, whichever functions jansson allocates with; NULL when out
 * of memory. */
char *json_text(const json_t *value, size_t flags);

/* The text as a value: null for NULL and for text that is not UTF-8, which JSON cannot hold; NULL when out of
 * memory. */
json_t *json_text_or_null(const char *text);

/* Building lists and objects without a check at each step: when memory runs out, the list or object is released and
 * stays NULL; the caller checks once, at the end. (A list that only lacks an item would be written as if it were
 * complete.) */

/* Adds an item to a list, or as the member of an object, which owns it from then on. A NULL item counts as out of
 * memory. */
void json_add(json_t **list, json_t *item);
void json_add_as(json_t **object, const char *key, json_t *item);

/* Adds the members of another object, which is released. */
void json_add_all(json_t **object, json_t *others);
