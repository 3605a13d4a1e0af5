/* What scene/file/write.c puts together: words that YAML reads back, and paths that follow their file. Ownership: fresh
 * memory is the caller's. */
#pragma once

#include "base/status.h"
#include <stdio.h>

/* STATUS_BAD_INPUT when the text of what label names is not UTF-8. */
status write_check_text(const char *label, const char *text, diagnostic *why);

/* A word or text, in quotes where a YAML reader would take it for something else. It must be UTF-8. */
void write_word(FILE *out, const char *text);

/* "0,1,2" or "[0,1,2]" as [0, 1, 2]. */
void write_list(FILE *out, const char *numbers);

/* path, which is relative to the folder of the file old_file, as it reads from new_file. "" stands for a file in the
 * working folder. */
status write_moved_path(const char *path, const char *old_file, const char *new_file, char **moved, diagnostic *why);
