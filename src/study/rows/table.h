/* An append-only file of rows: one write() per block of complete lines, flushed to disk before the call returns, and
 * one process at a time (flock). The incomplete line (base/csv.h) that a killed process or a power cut left is moved
 * aside when the file is opened again: it is appended to x.torn.csv, on disk, before x.csv is truncated to its last
 * complete line. Nothing else is ever removed or changed; a file with other columns gets the missing ones before the
 * first new row (below). Ownership: table_close releases a table. Errors name the file and do not
 * damage it. */
#pragma once

#include "base/csv.h"

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

/* --- csv_layout.c ---
 *
 * Conversion of rows to another header: columns are identified by name, so files of other versions of the program, with
 * more, fewer or reordered columns, can be read, merged and continued. Ownership: csv_layout_destroy releases a
 * layout. */

typedef struct csv_layout csv_layout;

/* Converts rows under the header line `from` to rows under the header line `to`. */
status csv_layout_create(const char *from, const char *to, csv_layout **out, diagnostic *why);
void csv_layout_destroy(csv_layout *l);

/* Appends complete lines to out, converted field by field; columns that `from` does not have are "NA". */
status csv_layout_place(const csv_layout *l, const char *lines, size_t size, csv_buffer *out, diagnostic *why);

/* The header line extended by the columns of `more` that it lacks, and their number; fresh memory, NULL if memory runs
 * out or quotes are invalid. */
char *csv_header_extend(const char *header, const char *more, size_t *added);

/* Prepares a file of another version of the program for new rows. Existing values are never changed: missing columns
 * are appended with the value "NA", in a new file that atomically replaces the old one. The file has only complete
 * lines and is locked by the caller; afterwards it has all columns of header. *layout, owned by the caller, converts
 * lines under header to the file's columns; NULL if they are equal. *replaced: the path refers to a new file, which is
 * not locked. */
status csv_layout_settle(const char *path, const char *header, csv_layout **layout, bool *replaced, diagnostic *why);
