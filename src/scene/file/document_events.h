/* libyaml's events for document.c, with its errors as diagnostics. Ownership: the reader borrows its text; events_next
 * returns an event to release with yaml_event_delete. */
#pragma once

#include "base/status.h"
#include <yaml.h>

typedef struct event_reader {
    yaml_parser_t parser;
    const char *name, *text; /* the file name and the whole file */
    size_t size, node_count;
    diagnostic *why;
} event_reader;

/* STATUS_BAD_INPUT, located at mark. */
status events_error(event_reader *r, yaml_mark_t mark, const char *remedy, const char *what);
/* The next event. Aliases, anchors, tags, invalid YAML and invalid UTF-8 are refused. */
status events_next(event_reader *r, yaml_event_t *event);
