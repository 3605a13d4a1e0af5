/* New rows in a file whose header is another one, of an earlier version of the program or a later one. Rows are never
 * changed: a file that lacks columns gets them behind its own, its rows "NA" in them, in a new file that takes the old
 * one's place at once. */
#ifndef CUVETTE_STUDY_TABLE_COLUMNS_H
#define CUVETTE_STUDY_TABLE_COLUMNS_H

#include "study/csv_layout.h"

/* Brings the file, whose lines are whole and which its caller has locked, to where it has all columns of header.
 * *layout, the caller's, places lines under header into it; NULL when they fit as they are. *replaced: another file
 * lies there now, which is not locked. */
status table_columns_settle(const char *path, const char *header, csv_layout **layout, bool *replaced, diagnostic *why);

#endif
