/* Builds the tree of a YAML file from libyaml's events, reports its errors as diagnostics, and answers queries. */
#include "scene/data/document.h"
#include "base/array.h"
#include "base/budget.h"
#include "base/file.h"
#include "base/status.h"
#include "scene/model/names.h"

#include <stdarg.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <yaml.h>

/* --- events --- */

typedef struct event_reader {
    yaml_parser_t parser;
    const char *name, *text; /* the name and the content of the file */
    size_t size, node_count;
    document *tree; /* the result */
    node **stack;   /* entries of lists and maps that are not complete yet */
    size_t stack_count, stack_room;
    diagnostic *why;
} event_reader;

static status events_error(event_reader *r, yaml_mark_t mark, const char *remedy, const char *what)
{
    diagnostic_locate(r->why, r->name, (long)mark.line + 1, (long)mark.column + 1);
    return diagnose(r->why, STATUS_BAD_INPUT, remedy, "%s", what);
}

static bool is_utf8_follower(char c)
{
    return ((unsigned char)c & 0xc0) == 0x80;
}

/* The line and column (in characters) of a byte: libyaml reports only the byte at which decoding failed. */
static yaml_mark_t mark_of_byte(const event_reader *r, size_t offset)
{
    yaml_mark_t mark = {.index = 0, .line = 0, .column = 0};
    for (size_t i = 0; i < offset && i < r->size; i++) {
        if (r->text[i] == '\n') {
            mark.line++;
            mark.column = 0;
        } else if (!is_utf8_follower(r->text[i])) {
            mark.column++;
        }
    }
    return mark;
}

static bool is_tab_at(const event_reader *r, yaml_mark_t mark)
{
    size_t line = 0, i = 0;
    while (i < r->size && line < mark.line)
        line += r->text[i++] == '\n';
    for (size_t column = 0; i < r->size && r->text[i] != '\n' && column < mark.column; column++)
        i++;
    return i < r->size && r->text[i] == '\t';
}

static status syntax_error(event_reader *r)
{
    const yaml_parser_t *p = &r->parser;
    switch (p->error) {
    case YAML_MEMORY_ERROR: return out_of_memory(r->why);
    case YAML_READER_ERROR:
        return events_error(r, mark_of_byte(r, p->problem_offset), "save the file as plain UTF-8 text",
                            p->problem ? p->problem : "the file is not text");
    case YAML_NO_ERROR:
    case YAML_SCANNER_ERROR:
    case YAML_PARSER_ERROR:
    case YAML_COMPOSER_ERROR:
    case YAML_WRITER_ERROR:
    case YAML_EMITTER_ERROR: break;
    }
    const char *remedy = is_tab_at(r, p->problem_mark) ? "indent with spaces instead of tabs"
                                                       : "check the indentation, colons, brackets and quotes here";
    diagnostic_locate(r->why, r->name, (long)p->problem_mark.line + 1, (long)p->problem_mark.column + 1);
    return diagnose(r->why, STATUS_BAD_INPUT, remedy, "%s%s%s", p->context ? p->context : "", p->context ? ", " : "",
                    p->problem ? p->problem : "invalid YAML");
}

/* Reads the next event; refuses aliases, anchors and tags (document.h). */
static status events_next(event_reader *r, yaml_event_t *event)
{
    if (!yaml_parser_parse(&r->parser, event))
        return syntax_error(r);
    const yaml_char_t *anchor = NULL, *tag = NULL;
    if (event->type == YAML_ALIAS_EVENT)
        anchor = event->data.alias.anchor;
    else if (event->type == YAML_SCALAR_EVENT)
        anchor = event->data.scalar.anchor, tag = event->data.scalar.tag;
    else if (event->type == YAML_SEQUENCE_START_EVENT)
        anchor = event->data.sequence_start.anchor, tag = event->data.sequence_start.tag;
    else if (event->type == YAML_MAPPING_START_EVENT)
        anchor = event->data.mapping_start.anchor, tag = event->data.mapping_start.tag;
    if (!anchor && !tag)
        return STATUS_OK;
    status code = events_error(r, event->start_mark, "write the value where it is used",
                               anchor ? "anchors and aliases (& and *) are not allowed" : "tags (!) are not allowed");
    yaml_event_delete(event);
    return code;
}

/* --- the tree --- */

/* A value takes sizeof(node) bytes, its text and its place in a list of its parent, 8 to 16 bytes: a file that keeps
 * the limits needs at most 1.3 GiB. */
enum { SIZE_LIMIT = 256 << 20, DEPTH_LIMIT = 16, NODE_LIMIT = 1 << 24 };

/* Memory is reserved in blocks, each at least as large as all before it up to BLOCK_MAX, and released as a whole. */
enum { BLOCK_MIN = 4096, BLOCK_MAX = 16 << 20 };

typedef struct block {
    struct block *before;
    size_t size, used; /* bytes after this head */
} block;

struct document {
    char *name;
    node *root;
    block *newest;
    size_t reserved; /* bytes of all blocks */
};

static status add_block(event_reader *r, size_t least)
{
    document *d = r->tree;
    size_t size = d->reserved < BLOCK_MIN ? BLOCK_MIN : d->reserved < BLOCK_MAX ? d->reserved : BLOCK_MAX;
    if (size < least)
        size = least;
    TRY(memory_budget_check(size, "make the file smaller", r->why, "%.150s", r->name));
    block *new = malloc(sizeof *new + size);
    if (!new)
        return out_of_memory(r->why);
    *new = (block){.before = d->newest, .size = size};
    d->newest = new;
    d->reserved += size;
    return STATUS_OK;
}

/* Memory of the document, aligned for pointers. */
static status reserve(event_reader *r, size_t bytes, void **out)
{
    bytes = (bytes + sizeof(void *) - 1) / sizeof(void *) * sizeof(void *);
    const block *b = r->tree->newest;
    if (!b || b->size - b->used < bytes)
        TRY(add_block(r, bytes));
    block *newest = r->tree->newest;
    *out = (char *)(newest + 1) + newest->used;
    newest->used += bytes;
    return STATUS_OK;
}

/* extra: bytes for the text that follows the node. */
static status node_create(event_reader *r, node_kind kind, yaml_mark_t mark, size_t extra, node **out)
{
    if (++r->node_count > NODE_LIMIT)
        return events_error(r, mark, "make the file smaller", "the file has more than 16777216 values");
    void *memory;
    TRY(reserve(r, sizeof(node) + extra, &memory));
    *out = memory;
    **out = (node){.kind = kind, .line = (int)mark.line + 1, .column = (int)mark.column + 1};
    return STATUS_OK;
}

static status read_scalar(event_reader *r, const yaml_event_t *event, node **out)
{
    const char *value = (const char *)event->data.scalar.value;
    const size_t length = event->data.scalar.length;
    if (memchr(value, 0, length))
        return events_error(r, event->start_mark, "remove it", "a text contains a NUL character");
    node *n = NULL;
    TRY(node_create(r, NODE_SCALAR, event->start_mark, length + 1, &n));
    n->quoted = event->data.scalar.style != YAML_PLAIN_SCALAR_STYLE;
    n->text = memcpy(n + 1, value, length + 1);
    *out = n;
    return STATUS_OK;
}

static int compare_keys(const void *a, const void *b)
{
    const node *x = *(node *const *)a, *y = *(node *const *)b;
    int order = strcmp(x->text, y->text);
    if (order != 0)
        return order;
    return x->line != y->line ? (x->line > y->line) - (x->line < y->line)
                              : (x->column > y->column) - (x->column < y->column);
}

/* Whether each pair of keys differs; only for short maps, because it compares all pairs. */
static bool all_differ(const node *map)
{
    for (size_t i = 1; i < map->count; i++)
        for (size_t k = 0; k < i; k++)
            if (strcmp(map->keys[i]->text, map->keys[k]->text) == 0)
                return false;
    return true;
}

static status check_unique_keys(event_reader *r, const node *map)
{
    enum { SHORT = 12 };
    if (map->count <= SHORT && all_differ(map))
        return STATUS_OK;
    node **sorted = malloc(map->count * sizeof(node *));
    if (!sorted)
        return out_of_memory(r->why);
    memcpy(sorted, map->keys, map->count * sizeof(node *));
    qsort(sorted, map->count, sizeof(node *), compare_keys);
    status code = STATUS_OK;
    for (size_t i = 1; i < map->count && code == STATUS_OK; i++) {
        if (strcmp(sorted[i - 1]->text, sorted[i]->text) == 0) {
            diagnostic_locate(r->why, r->name, sorted[i]->line, sorted[i]->column);
            code =
                diagnose(r->why, STATUS_BAD_INPUT, "keep one of the two",
                         "duplicate key '%.80s', first used on line %ld", sorted[i]->text, (long)sorted[i - 1]->line);
        }
    }
    free(sorted);
    return code;
}

static status read_node(event_reader *r, yaml_event_t *event, int depth, node **out);

static status read_key(event_reader *r, yaml_event_t *event, node **key)
{
    if (event->type != YAML_SCALAR_EVENT || event->data.scalar.length == 0)
        return events_error(r, event->start_mark, "begin the entry with a name and a colon",
                            "a key is not a plain word");
    return read_scalar(r, event, key);
}

/* Puts a node on the stack of entries whose list or map is not complete yet. */
static status push(event_reader *r, node *entry)
{
    if (!GROW(r->stack, r->stack_room, r->stack_count + 1))
        return out_of_memory(r->why);
    r->stack[r->stack_count++] = entry;
    return STATUS_OK;
}

/* Makes the entries above `base` on the stack, keys and values in turn for a map, those of the node. */
static status adopt(event_reader *r, size_t base, node *n)
{
    const size_t step = n->kind == NODE_MAP ? 2 : 1, entries = r->stack_count - base;
    void *memory = NULL;
    if (entries > 0)
        TRY(reserve(r, entries * sizeof(node *), &memory));
    n->count = entries / step;
    n->items = memory;
    n->keys = step == 2 && memory ? n->items + n->count : NULL;
    for (size_t i = 0; i < n->count; i++) {
        n->items[i] = r->stack[base + step * i + step - 1];
        if (n->keys)
            n->keys[i] = r->stack[base + step * i];
    }
    r->stack_count = base;
    return n->keys ? check_unique_keys(r, n) : STATUS_OK;
}

/* Reads entries up to the end of the list or map. */
static status read_entries(event_reader *r, yaml_event_type_t end, int depth, node *n)
{
    const size_t base = r->stack_count;
    for (;;) {
        yaml_event_t event;
        TRY(events_next(r, &event));
        status code = STATUS_OK;
        if (event.type == end) {
            yaml_event_delete(&event);
            return adopt(r, base, n);
        }
        node *entry = NULL;
        if (n->kind == NODE_MAP) {
            code = read_key(r, &event, &entry);
            yaml_event_delete(&event);
            THEN(code, push(r, entry));
            TRY(code);
            TRY(events_next(r, &event));
        }
        code = read_node(r, &event, depth + 1, &entry);
        yaml_event_delete(&event);
        THEN(code, push(r, entry));
        TRY(code);
    }
}

/* Reads the node that starts with *event, which the caller deletes. */
static status read_node(event_reader *r, yaml_event_t *event, int depth, node **out)
{
    if (event->type == YAML_SCALAR_EVENT)
        return read_scalar(r, event, out);
    if (depth > DEPTH_LIMIT)
        return events_error(r, event->start_mark, "use at most 16 levels", "nested deeper than 16 levels");
    const bool map = event->type == YAML_MAPPING_START_EVENT;
    TRY(node_create(r, map ? NODE_MAP : NODE_LIST, event->start_mark, 0, out));
    return read_entries(r, map ? YAML_MAPPING_END_EVENT : YAML_SEQUENCE_END_EVENT, depth, *out);
}

/* Reads the only document, from stream start to stream end. */
static status read_stream(event_reader *r, node **root)
{
    for (;;) {
        yaml_event_t event;
        TRY(events_next(r, &event));
        status code = STATUS_OK;
        yaml_event_type_t type = event.type;
        if (type == YAML_DOCUMENT_START_EVENT && *root) {
            code = events_error(r, event.start_mark, "put it into a separate file", "a second document begins here");
        } else if (type == YAML_STREAM_END_EVENT && !*root) {
            code = events_error(
                r, (yaml_mark_t){0},
                "begin a scene with keys such as solids: and lights:, a study with study:, a script with hands:",
                "the file is empty");
        } else if (type == YAML_SCALAR_EVENT || type == YAML_SEQUENCE_START_EVENT || type == YAML_MAPPING_START_EVENT) {
            code = read_node(r, &event, 1, root);
        }
        yaml_event_delete(&event);
        if (code != STATUS_OK || type == YAML_STREAM_END_EVENT)
            return code;
    }
}

static bool is_image(const char *text, size_t size)
{
    return size >= 4 && (memcmp(text, "\x89PNG", 4) == 0 || memcmp(text, "\xff\xd8\xff", 3) == 0);
}

status document_parse(const char *name, const char *text, size_t size, document **out, diagnostic *why)
{
    *out = NULL;
    static const char byte_order_mark[] = "\xef\xbb\xbf";
    if (size >= 3 && memcmp(text, byte_order_mark, 3) == 0) { /* libyaml does not skip it if the encoding is set */
        text += 3;
        size -= 3;
    }
    event_reader r = {.name = name, .text = text, .size = size, .node_count = 0, .why = why};
    if (size > SIZE_LIMIT) {
        diagnostic_locate(why, name, 1, 1);
        return diagnose(why, STATUS_BAD_INPUT, "make the file smaller", "the file is larger than 256 MiB");
    }
    if (is_image(text, size))
        return events_error(&r, (yaml_mark_t){0}, "give the scene, study or script file instead",
                            "this is an image file, not YAML");
    if (!(r.tree = calloc(1, sizeof *r.tree)) || !(r.tree->name = strdup(name)) || !yaml_parser_initialize(&r.parser)) {
        document_destroy(r.tree);
        return out_of_memory(why);
    }
    yaml_parser_set_encoding(&r.parser, YAML_UTF8_ENCODING);
    yaml_parser_set_input_string(&r.parser, (const unsigned char *)text, size);
    const status code = read_stream(&r, &r.tree->root);
    yaml_parser_delete(&r.parser);
    free(r.stack);
    if (code == STATUS_OK)
        *out = r.tree;
    else
        document_destroy(r.tree);
    return code;
}

status document_read_below(const char *path, const char *root, document **out, diagnostic *why)
{
    *out = NULL;
    char *text;
    size_t size;
    TRY(file_read_below(path, root, SIZE_LIMIT, &text, &size, why));
    status code = document_parse(path, text, size, out, why);
    free(text);
    return code;
}

void document_destroy(document *d)
{
    if (!d)
        return;
    for (block *b = d->newest, *before; b; b = before) {
        before = b->before;
        free(b);
    }
    free(d->name);
    free(d);
}

const node *document_root(const document *d)
{
    return d->root;
}

const char *document_name(const document *d)
{
    return d->name;
}

/* --- queries --- */

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
