/* Queries of readers on the nodes of a document. */
#include "scene/file/document.h"
#include "scene/model/suggest.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const node *node_get(const node *map, const char *key)
{
    if (!map || map->kind != NODE_MAP)
        return NULL;
    for (size_t i = 0; i < map->count; i++)
        if (strcmp(map->keys[i]->text, key) == 0)
            return map->items[i];
    return NULL;
}

status node_error(const document *d, const node *at, diagnostic *why, const char *remedy, const char *what, ...)
{
    char text[sizeof why->what];
    va_list arguments;
    va_start(arguments, what);
    if (vsnprintf(text, sizeof text, what, arguments) < 0)
        text[0] = 0;
    va_end(arguments);
    diagnostic_locate(why, document_name(d), at->line, at->column);
    return diagnose(why, STATUS_BAD_INPUT, remedy, "%s", text);
}

static bool is_among(const char *word, const char *const *words, size_t count)
{
    for (size_t i = 0; i < count; i++)
        if (strcmp(word, words[i]) == 0)
            return true;
    return false;
}

status node_check_keys(const document *d, const node *map, const char *const *words, size_t count, diagnostic *why)
{
    for (size_t i = 0; i < map->count; i++) {
        const node *key = map->keys[i];
        if (is_among(key->text, words, count))
            continue;
        char remedy[500];
        suggest_key(key->text, words, count, remedy, sizeof remedy);
        return node_error(d, key, why, remedy, "unknown key '%.80s'", key->text);
    }
    return STATUS_OK;
}

bool node_is_value(const node *n)
{
    for (size_t i = 0; n->kind == NODE_LIST && i < n->count; i++) {
        /* A comma in an element would be read back as a separator. */
        if (n->items[i]->kind != NODE_SCALAR || strchr(n->items[i]->text, ','))
            return false;
    }
    return n->kind != NODE_MAP;
}

static char *list_text(const node *list)
{
    size_t size = 1;
    for (size_t i = 0; i < list->count; i++)
        size += strlen(list->items[i]->text) + 1;
    char *text = malloc(size), *end = text;
    if (!text)
        return NULL;
    *end = 0;
    for (size_t i = 0; i < list->count; i++) {
        if (i)
            *end++ = ',';
        end = stpcpy(end, list->items[i]->text);
    }
    return text;
}

char *node_value_text(const node *n)
{
    if (!node_is_value(n))
        return NULL;
    switch (n->kind) {
    case NODE_SCALAR: return strdup(n->text);
    case NODE_LIST: return list_text(n);
    case NODE_MAP: break;
    }
    return NULL;
}
