/* Building lists and objects of jansson without a check at each step: when memory is out, the list or object is released
 * and becomes NULL, and stays so; the caller checks once, at the end. (A list that only lacks an item would be written
 * as if it were whole.) */
#pragma once

#include <jansson.h>

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
