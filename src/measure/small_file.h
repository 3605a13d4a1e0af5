/* Readers of small files in /proc and /sys, whose size is not known in advance. Private to src/measure. */
#pragma once

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Reads at most size - 1 bytes of the file root/path into text and terminates them with 0; returns false, with
 * errno set, if there is no such file or it cannot be read. root may be "". */
bool small_file_read(const char *root, const char *path, char *text, size_t size);

/* The decimal integer after "key:" at the start of a line, as in /proc/meminfo; -1 if there is none. */
int64_t small_file_field(const char *text, const char *key);
