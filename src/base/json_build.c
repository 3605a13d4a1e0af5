/* Lists, objects and texts of jansson, and a reserve of memory for it. */
#include "base/json_build.h"

#include <errno.h>
#include <jansson.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>

/* ---- a reserve of memory ---- */

enum { RESERVE_BYTES = 1 << 20, ALIGNMENT = 16 };

/* The reserve is handed out from its beginning, and never reused: it is for a program that is about to report that
 * memory ran out. Pages that are not used cost nothing. */
static _Alignas(ALIGNMENT) char reserve[RESERVE_BYTES];
static atomic_size_t used;

static void *allocate(size_t size)
{
    void *memory = malloc(size);
    if (memory || size > RESERVE_BYTES / 4)
        return memory;
    const size_t rounded = (size + ALIGNMENT - 1) / ALIGNMENT * ALIGNMENT, at = atomic_fetch_add(&used, rounded);
    return at + rounded <= RESERVE_BYTES ? reserve + at : NULL;
}

static void release(void *memory)
{
    const uintptr_t at = (uintptr_t)memory, start = (uintptr_t)reserve;
    if (at < start || at >= start + RESERVE_BYTES)
        free(memory);
}

void json_memory_reserve(void)
{
    json_set_alloc_funcs(allocate, release);
}

/* ---- texts ---- */

json_t *json_parse(const char *text, size_t size, size_t flags, json_error_t *error, bool *no_memory)
{
    void *volatile room = malloc(8 * size + 4096); /* volatile: else a compiler may assume success */
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

char *json_text(const json_t *value, size_t flags)
{
    const size_t size = json_dumpb(value, NULL, 0, flags);
    char *text = size ? malloc(size + 1) : NULL;
    if (text && json_dumpb(value, text, size, flags) != size) {
        free(text);
        return NULL;
    }
    if (text)
        text[size] = '\0';
    return text;
}

json_t *json_text_or_null(const char *text)
{
    errno = 0; /* json_string does not report which failure it was, and a host's allocator may not set errno */
    json_t *value = text ? json_string(text) : NULL;
    if (value || !text)
        return text ? value : json_null();
    const bool no_memory = errno == ENOMEM;
    json_t *any = no_memory ? NULL : json_string_nocheck(text);
    json_decref(any);
    return any ? json_null() : NULL;
}

/* ---- lists and objects ---- */

void json_add(json_t **list, json_t *item)
{
    if (json_array_append_new(*list, item) != 0) {
        json_decref(*list);
        *list = NULL;
    }
}

void json_add_all(json_t **object, json_t *others)
{
    if (json_object_update_new(*object, others) != 0) {
        json_decref(*object);
        *object = NULL;
    }
}

void json_add_as(json_t **object, const char *key, json_t *item)
{
    if (json_object_set_new(*object, key, item) != 0) {
        json_decref(*object);
        *object = NULL;
    }
}
