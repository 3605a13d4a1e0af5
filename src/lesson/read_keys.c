/* The keys of a lesson that several of its parts have, and the errors of what the lesson sets (lesson.h). */
#include "base/number.h"
#include "lesson/lesson.h"
#include "scene/data/document.h"

#include <string.h>

enum { TEXT_BYTES_MAX = 2000 };

status lesson_read_text(const lesson_reader *r, const node *map, const char *key, bool needed, char **out)
{
    const node *n = node_get(map, key);
    if (!n && !needed)
        return STATUS_OK;
    if (!n)
        return node_error(r->file, map, r->why, "add it; cuvette-lesson(5) shows an example", "'%s' is missing", key);
    if (n->kind != NODE_SCALAR || !n->text[0] || strlen(n->text) > TEXT_BYTES_MAX)
        return node_error(r->file, n, r->why, "write a text of at most 2000 bytes", "'%s' is not a text", key);
    return (*out = strdup(n->text)) ? STATUS_OK : out_of_memory(r->why);
}

status lesson_read_number(const lesson_reader *r, const node *map, const char *key, double *out)
{
    const node *n = node_get(map, key);
    if (!n)
        return node_error(r->file, map, r->why, "add it; cuvette-lesson(5) shows an example", "'%s' is missing", key);
    if (n->kind != NODE_SCALAR || !number_parse_real(n->text, out))
        return node_error(r->file, n, r->why, "write a number such as 1.5", "'%s' is not a number", key);
    return STATUS_OK;
}

status lesson_expect_map(const lesson_reader *r, const node *parent, const char *key, const node **out)
{
    const node *n = node_get(parent, key);
    if (n && n->kind == NODE_MAP) {
        *out = n;
        return STATUS_OK;
    }
    return node_error(r->file, n ? n : parent, r->why, "write keys and values; cuvette-lesson(5) shows an example",
                      n ? "'%s' has no keys" : "'%s' is missing", key);
}

status lesson_relay(const lesson_reader *r, const node *at, status code, const char *remedy, const diagnostic *refused)
{
    if (code == STATUS_BAD_INPUT)
        return node_error(r->file, at, r->why, remedy, "%s", refused->what);
    if (code != STATUS_OK && r->why)
        *r->why = *refused;
    return code;
}
