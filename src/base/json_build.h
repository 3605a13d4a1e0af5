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

/* json_loadb. Without memory jansson may lose an item, or blame the text, which is therefore read twice. Sets
 * *no_memory if there is no room for the value. */
json_t *json_parse(const char *text, size_t size, size_t flags, json_error_t *error, bool *no_memory);

/* json_dumps into memory that the caller releases with free, whichever functions jansson allocates with; NULL when out
 * of memory. */
char *json_text(const json_t *value, size_t flags);

/* The text as a value: null for NULL and for what is not UTF-8, which JSON cannot hold; NULL when out of memory. */
json_t *json_text_or_null(const char *text);

/* Building lists and objects without a check at each step: when memory is out, the list or object is released and
 * becomes NULL, and stays so; the caller checks once, at the end. (A list that only lacks an item would be written as
 * if it were complete.) */

/* Adds an item to a list, or as the member of an object; takes over the reference to it. item NULL: it could not be
 * made. */
void json_add(json_t **list, json_t *item);
void json_add_as(json_t **object, const char *key, json_t *item);

/* Adds the members of another object, which is released. */
void json_add_all(json_t **object, json_t *others);
