/* Scenes as text, in the grammar of scene/file/read.c. Only what differs from the defaults is written, and of a solid
 * with a material only what differs from that; sections and rows stand in the table's order, objects in the scene's.
 * Writing, reading and writing again gives the same bytes, and what is read makes the same film. Numbers have the
 * fewest digits that read back the same. Comments of the file that a scene came from are not part of the scene.
 * Ownership: text is the caller's, released with free. */
#pragma once

#include "scene/model/open.h"

/* path is where the text will stand: paths of files in it are written relative to that folder, or absolute where the
 * two folders have nothing in common. NULL or "" stands for a file in the working folder. all writes every parameter in
 * use, defaults too. STATUS_BAD_INPUT when a title or path is no text that YAML can hold (not UTF-8). */
status scene_write_text(const scene *s, const char *path, bool all, char **text, diagnostic *why);

/* The same into a file, which appears whole or not at all; "-" is standard output. */
status scene_write(const scene *s, const char *path, bool all, diagnostic *why);
