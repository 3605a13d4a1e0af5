/* A file of rows that only grows: one write() a block of whole lines, flushed to disk before the call returns, and one
 * process at a time (flock). What a killed process left half written is moved aside when the file is opened again: the
 * torn end of x.csv is appended to x.torn.csv, on disk, before x.csv is cut back to its last whole line. Nothing else
 * is ever taken out of the file or changed in it; one with other columns gets what it lacks before the first new row
 * (study/csv_layout.h). Ownership: table_open gives, table_close releases. Errors name the file, and leave whole
 * what is in it. */
#pragma once

#include "base/status.h"

typedef struct table table;

/* Opens or makes the file, locks it, moves a torn end aside, and writes header (a whole line) if there is none.
 * STATUS_BAD_INPUT when another process holds it. */
status table_open(const char *path, const char *header, table **out, diagnostic *why);

/* Adds whole lines, which stand under the header that the table was opened with. When the disk is full the file is cut
 * back to what it was: a line is there whole or not at all. */
status table_append(table *t, const char *lines, size_t size, diagnostic *why);

/* Moves everything from offset (the start of a line) on aside, as a torn end. */
status table_set_aside(table *t, size_t offset, diagnostic *why);

void table_close(table *t);
