/* Writes scenes as text, in the grammar of scene/file/read.c. Only values that differ from the defaults are written
 * (for a solid with a material, from the material); sections and rows are in the order of the table, objects in the
 * order of the scene. Writing, reading and writing again produces the same bytes, and the scene that is read has the
 * same film. Numbers have the fewest digits that round-trip. Comments in the original file are lost. Ownership: the
 * caller frees texts. */
#pragma once

#include "scene/model/open.h"
#include <stdio.h>

/* path is the destination of the text: paths of files in it are written relative to the destination's folder, or
 * absolute if the two folders have only the root in common. NULL or "" means a file in the working folder. all: every
 * parameter in use is written, also with its default. STATUS_BAD_INPUT if a title or path is not valid UTF-8. */
status scene_write_text(const scene *s, const char *path, bool all, char **text, diagnostic *why);

/* scene_write_text for a file in the working folder, without defaults; *text is NULL if it would have more than `most`
 * bytes: a scene of many solids is then not written to its end. */
status scene_write_short(const scene *s, size_t most, char **text, diagnostic *why);

/* Writes the text to a file, atomically; "-" is standard output. */
status scene_write(const scene *s, const char *path, bool all, diagnostic *why);

/* --- parts of YAML texts, also for other writers: write_parts.c --- */

/* STATUS_BAD_INPUT if the text of the item called label is not UTF-8. */
status write_check_text(const char *label, const char *text, diagnostic *why);

/* Writes a word or text, with quotes if a YAML reader would need them. It must be UTF-8. */
void write_word(FILE *out, const char *text);

/* Writes "0,1,2" or "[0,1,2]" as [0, 1, 2]. */
void write_list(FILE *out, const char *numbers);

/* Converts path, relative to the folder of old_file, to a path relative to the folder of new_file. "" means a file in
 * the working folder. */
status write_moved_path(const char *path, const char *old_file, const char *new_file, char **moved, diagnostic *why);
