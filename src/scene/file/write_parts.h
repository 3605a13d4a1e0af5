/* Parts of scene/file/write.c: scalars that YAML reads back, and relative paths. Ownership: fresh memory is the
 * caller's. */
#pragma once

#include "base/status.h"
#include <stdio.h>

/* STATUS_BAD_INPUT if the text of the item called label is not UTF-8. */
status write_check_text(const char *label, const char *text, diagnostic *why);

/* A word or text, quoted if a YAML reader would interpret it otherwise. It must be UTF-8. */
void write_word(FILE *out, const char *text);

/* "0,1,2" or "[0,1,2]" as [0, 1, 2]. */
void write_list(FILE *out, const char *numbers);

/* Converts path, relative to the folder of old_file, to a path relative to the folder of new_file. "" means a file in
 * the working folder. */
status write_moved_path(const char *path, const char *old_file, const char *new_file, char **moved, diagnostic *why);
