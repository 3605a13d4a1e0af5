/* Building lists and objects of jansson without a check at each step: when memory is out, the list or object is released
 * and becomes NULL, and stays so; the caller checks once, at the end. (A list that only lacks an item would be written
 * as if it were whole.) */
#pragma once

#include <jansson.h>
#include <stdbool.h>
#include <stdlib.h>

/* json_loadb, which reports most failures of memory as wrong syntax. A text is parsed again if it seems wrong, and
 * *no_memory is set if there is still no room for it. */
static inline json_t *json_parse(const char *text, size_t size, size_t flags, json_error_t *error, bool *no_memory)
{
    json_t *value = json_loadb(text, size, flags, error);
    *no_memory = false;
    if (value || (value = json_loadb(text, size, flags, error)))
        return value;
    void *room = malloc(8 * size + 4096);
    *no_memory = !room || json_error_code(error) == json_error_out_of_memory;
    free(room);
    return NULL;
}

/* Both take the reference of item; NULL: it could not be made. */
static inline void json_add(json_t **list, json_t *item)
{
    if (json_array_append_new(*list, item) != 0) {
        json_decref(*list);
        *list = NULL;
    }
}

static inline void json_add_as(json_t **object, const char *key, json_t *item)
{
    if (json_object_set_new(*object, key, item) != 0) {
        json_decref(*object);
        *object = NULL;
    }
}
