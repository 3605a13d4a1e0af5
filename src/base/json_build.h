/* Building lists and objects of jansson without a check at each step: when memory is out, the list or object is
 * released and becomes NULL, and stays so; the caller checks once, at the end. (A list that only lacks an item would
 * be written as if it were whole.) */
#pragma once

#include <errno.h>
#include <jansson.h>
#include <stdbool.h>
#include <stdlib.h>

/* json_loadb, which does not bear a lack of memory (json_memory.h): it may lose an item, or blame the text, which is
 * therefore read twice. Sets *no_memory if there is no room for the value. */
static inline json_t *json_parse(const char *text, size_t size, size_t flags, json_error_t *error, bool *no_memory)
{
    void *volatile room = malloc(8 * size + 4096); /* volatile: the compiler may assume that it succeeds */
    *no_memory = !room;
    free(room);
    json_t *value = room ? json_loadb(text, size, flags, error) : NULL;
    *no_memory |= room && !value && json_error_code(error) == json_error_out_of_memory;
    json_error_t ignored;
    json_t *again = room ? json_loadb(text, size, flags, &ignored) : NULL;
    if (value ? !json_equal(value, again) : again != NULL) {
        *no_memory = true;
        json_decref(value);
        value = NULL;
    }
    json_decref(again);
    return value;
}

/* json_dumps into memory that the caller releases with free, whichever functions jansson allocates with; NULL when
 * out of memory. */
static inline char *json_text(const json_t *value, size_t flags)
{
    const size_t size = json_dumpb(value, NULL, 0, flags);
    char *text = size ? (char *)malloc(size + 1) : NULL;
    if (text && json_dumpb(value, text, size, flags) != size) {
        free(text);
        return NULL;
    }
    if (text)
        text[size] = '\0';
    return text;
}

/* The text as a value: null for NULL and for what is not UTF-8, which JSON cannot hold; NULL when out of memory. */
static inline json_t *json_text_or_null(const char *text)
{
    errno = 0; /* json_string does not say which it was, and a host's functions that allocate may not set errno */
    json_t *value = text ? json_string(text) : NULL;
    if (value || !text)
        return text ? value : json_null();
    const bool no_memory = errno == ENOMEM;
    json_t *any = no_memory ? NULL : json_string_nocheck(text);
    json_decref(any);
    return any ? json_null() : NULL;
}

/* Both take the reference of item; NULL: it could not be made. */
static inline void json_add(json_t **list, json_t *item)
{
    if (json_array_append_new(*list, item) != 0) {
        json_decref(*list);
        *list = NULL;
    }
}

/* The members of another object, which is released. */
static inline void json_add_all(json_t **object, json_t *others)
{
    if (json_object_update_new(*object, others) != 0) {
        json_decref(*object);
        *object = NULL;
    }
}

static inline void json_add_as(json_t **object, const char *key, json_t *item)
{
    if (json_object_set_new(*object, key, item) != 0) {
        json_decref(*object);
        *object = NULL;
    }
}
