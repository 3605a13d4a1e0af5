/* A YAML file as a tree whose nodes know their line and column, from libyaml's events. Scene, study, lesson and script
 * files use it. Anchors, aliases, tags and multiple documents are refused, so that a file cannot be cyclic or expand
 * exponentially. Ownership: document_destroy releases the whole tree. */
#pragma once

#include "base/status.h"
#include <stdbool.h>

typedef enum node_kind { NODE_SCALAR, NODE_LIST, NODE_MAP } node_kind;

typedef struct node {
    node_kind kind;
    bool quoted;
    int line, column;    /* from 1 */
    char *text;          /* NODE_SCALAR */
    struct node **items; /* NODE_LIST: items; NODE_MAP: values */
    struct node **keys;  /* NODE_MAP: unique scalars */
    size_t count;
} node;

typedef struct document document;

/* Parses a text. Limits: 256 MiB, depth 16, 2^24 nodes, and the memory budget (base/budget.h): a node takes 48 bytes,
 * its text and 8 to 16 bytes in its parent. name is the file name in diagnostics. */
status document_parse(const char *name, const char *text, size_t size, document **out, diagnostic *why);
/* Parses a file below root (base/file.h; NULL: no restriction). */
status document_read_below(const char *path, const char *root, document **out, diagnostic *why);
void document_destroy(document *d);

const node *document_root(const document *d);
const char *document_name(const document *d);

/* The value under key in a map, or NULL. */
const node *node_get(const node *map, const char *key);
/* diagnose() located at a node. */
status node_error(const document *d, const node *at, diagnostic *why, const char *remedy, const char *what, ...)
    __attribute__((format(printf, 5, 6)));
/* Fails, with a suggestion (scene/model/names.h), if a key of the map is not among words[0..count-1]. */
status node_check_keys(const document *d, const node *map, const char *const *words, size_t count, diagnostic *why);

/* Whether the node is a scalar, or a list of scalars, that scene_set can accept. */
bool node_is_value(const node *n);
/* A value as text ("8", "0,2.75,-6"); newly allocated; NULL for other nodes or if memory runs out. */
char *node_value_text(const node *n);
