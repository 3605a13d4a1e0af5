/* Rows under another header: columns are known by their names, so that files of other versions of the program, which
 * have columns more, fewer or in another order, are read, joined and gone on with. Ownership: csv_layout_create gives,
 * csv_layout_destroy releases. */
#pragma once

#include "study/csv.h"

typedef struct csv_layout csv_layout;

/* For lines of rows under the header line `from` that are to stand under the header line `to`. */
status csv_layout_create(const char *from, const char *to, csv_layout **out, diagnostic *why);
void csv_layout_destroy(csv_layout *l);

/* Whole lines, field by field in their new places; "NA" in columns that `from` does not have. */
status csv_layout_place(const csv_layout *l, const char *lines, size_t size, csv_line *out, diagnostic *why);

/* The header line with the columns of `more` that it lacks behind its own, and how many these are; fresh memory, NULL
 * when that is out or a header's quotes are wrong. */
char *csv_header_extend(const char *header, const char *more, size_t *added);

/* New rows in a file whose header is another one, of an earlier version of the program or a later one. Rows are never
 * changed: a file that lacks columns gets them behind its own, its rows "NA" in them, in a new file that takes the old
 * one's place at once. Brings the file, whose lines are whole and which its caller has locked, to where it has all
 * columns of header. *layout, the caller's, places lines under header into it; NULL when they fit as they are.
 * *replaced: another file lies there now, which is not locked. */
status csv_layout_settle(const char *path, const char *header, csv_layout **layout, bool *replaced, diagnostic *why);
