/* Scenes as text, in the grammar of scene/file/read.c. Only values that differ from the defaults are written, and for a
 * solid with a material only those that differ from the material; sections and rows are in the order of the table,
 * objects in the order of the scene. Writing, reading and writing again gives the same bytes, and the scene that is
 * read gives the same film. Numbers have the fewest digits that round-trip. Comments in the original file are lost.
 * Ownership: text is the caller's, released with free. */
#pragma once

#include "scene/model/open.h"

/* path is the destination of the text: paths of files in it are written relative to that folder, or absolute if the two
 * folders share only the root. NULL or "" means a file in the working folder. all writes every parameter in use,
 * including defaults. STATUS_BAD_INPUT if a title or path is not valid UTF-8. */
status scene_write_text(const scene *s, const char *path, bool all, char **text, diagnostic *why);

/* The same to a file, written atomically; "-" is standard output. */
status scene_write(const scene *s, const char *path, bool all, diagnostic *why);
