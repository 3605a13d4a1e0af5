/* Whether what is to be written fits on a file system, before hours of work end at a full disk. Pure values. */
#pragma once

#include "base/status.h"
#include <stdint.h>

/* Bytes that will be written: at least (what cannot be compressed or left out), and at most. */
typedef struct disk_room {
    double least_bytes, most_bytes;
} disk_room;

/* Adds count files of these sizes, each in whole blocks. */
void disk_room_add(disk_room *to, double count, double least_bytes, double most_bytes);

/* Free bytes for this user on the file system of path, which need not exist yet; NaN if unknown. Quotas are not
 * seen. */
double disk_room_free(const char *path);

enum { DISK_ROOM_TEXT_MAX = 160 };
/* STATUS_FAILURE where it cannot fit into free_bytes, with both numbers: place is what the message names, what the
 * subject that writes ("the run"). Where it may not fit, note becomes the text of a warning; otherwise "". */
status disk_room_check(const disk_room *needed, double free_bytes, const char *place, const char *what,
                       char note[DISK_ROOM_TEXT_MAX], diagnostic *why);

/* "1.2 GB to 3.4 GB": for a plan. */
void disk_room_text(const disk_room *needed, char *text, size_t size);
/* "1.2 GB", with powers of 1000. */
void disk_room_bytes_text(double bytes, char *text, size_t size);
