/* An append-only file of rows: one write() per block of complete lines, flushed to disk before the call returns, and
 * one process at a time (flock). The incomplete line (base/csv.h) that a killed process or a power cut left is moved
 * aside when the file is opened again: it is appended to x.torn.csv, on disk, before x.csv is truncated to its last
 * complete line. Nothing else is ever removed or changed; a file with other columns gets the missing ones before the
 * first new row (study/rows/csv_layout.h). Ownership: table_close releases a table. Errors name the file and do not
 * damage it. */
#pragma once

#include "base/status.h"

typedef struct table table;

/* Opens or creates the file, locks it, moves an incomplete end aside, and writes header (a complete line) if it is
 * missing. STATUS_BAD_INPUT if another process holds the lock. */
status table_open(const char *path, const char *header, table **out, diagnostic *why);

/* Appends complete lines, in the columns of the header given to table_open. STATUS_FAILURE if another program removed,
 * replaced, truncated or changed the file since the last lines: x.rescued.csv then has the old file and the new lines.
 * If the disk is full, the file is truncated to its old size: a line is written completely or not at all. */
status table_append(table *t, const char *lines, size_t size, diagnostic *why);

/* Moves everything from offset (the start of a line) aside, like an incomplete end. */
status table_set_aside(table *t, size_t offset, diagnostic *why);

void table_close(table *t);
