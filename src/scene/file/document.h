/* A YAML file as a tree whose every node knows its line and column, read through libyaml's events. Scene and
 * study files are both read through it. Anchors and aliases, tags and several documents in one file are refused:
 * a file says what it means where it says it, and cannot be cyclic or explode. Ownership: document_destroy
 * releases the whole tree. */
#pragma once

#include "base/status.h"
#include <stdbool.h>

typedef enum node_kind { NODE_SCALAR, NODE_LIST, NODE_MAP } node_kind;

typedef struct node {
    node_kind kind;
    long line, column; /* from 1 */
    char *text;        /* NODE_SCALAR */
    bool quoted;
    struct node **items; /* NODE_LIST: items; NODE_MAP: values */
    struct node **keys;  /* NODE_MAP: scalars, no two the same */
    size_t count;
} node;

typedef struct document document;

/* Limits: 1 MiB, depth 16, 65536 nodes. name is the file's, for diagnostics. */
status document_parse(const char *name, const char *text, size_t size, document **out, diagnostic *why);
/* The same from a file that lies below root (base/below.h; NULL: anywhere). */
status document_read_below(const char *path, const char *root, document **out, diagnostic *why);
void document_destroy(document *d);

const node *document_root(const document *d);
const char *document_name(const document *d);

/* The value under key in a map, or NULL. */
const node *node_get(const node *map, const char *key);
/* diagnose() located at a node. */
status node_error(const document *d, const node *at, diagnostic *why, const char *remedy, const char *what, ...)
    __attribute__((format(printf, 5, 6)));
/* Error, with the key that was meant (scene/model/suggest.h), if the map has a key that is not among words[0..count-1].
 */
status node_check_keys(const document *d, const node *map, const char *const *words, size_t count, diagnostic *why);

/* Is it a scalar, or a list of scalars, that scene_set may take? */
bool node_is_value(const node *n);
/* Such a one as text ("8", "0,2.75,-6"); fresh memory, NULL when memory is out, and for other kinds. */
char *node_value_text(const node *n);
