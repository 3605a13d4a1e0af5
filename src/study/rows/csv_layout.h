/* Conversion of rows to another header: columns are identified by name, so files of other versions of the program, with
 * more, fewer or reordered columns, can be read, merged and continued. Ownership: csv_layout_destroy releases a
 * layout. */
#pragma once

#include "base/csv.h"

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
