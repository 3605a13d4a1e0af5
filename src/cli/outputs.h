/* The files that a render leaves: the picture, the maps of rays and time by pixel, the timeline. Their names are
 * looked at before anything is rendered, so that an hour's work is not lost to a misspelt ending. Ownership: names
 * are borrowed. */
#pragma once

#include "render/core/renderer.h"
#include <stdio.h>

typedef struct outputs {
    const char *img, *rays, *time, *noise, *timeline, *layers; /* NULL: not wanted; layers: a prefix */
    int bits;                                                  /* of a PNG picture: 8 or 16; 0 when not said */
} outputs;

/* The folder of a path in fresh memory, "." for a bare name. */
char *outputs_folder_of(const char *path);
bool outputs_same_entry(const char *a, const char *b);
bool outputs_ends_with(const char *path, const char *ending); /* letter case ignored */

/* The files that a scene reads, as they are found from the working folder: its own, its sky, its textures, its meshes
 * and the scripts of its slimes, not those that a mesh's file names in turn. Is one of them what is looked for? Calls
 * is_it with each until it returns true. */
bool scene_files_any(const scene *s, bool (*is_it)(void *context, const char *path), void *context);

/* Endings, folders, and no file named twice or in place of one that the scene reads. */
status outputs_check(const outputs *o, const scene *s, diagnostic *why);

/* The same for one picture by itself that no scene has to do with; read are the count files that are read. option is
 * what named it. */
status outputs_check_image(const char *option, const char *path, const char *const *read, size_t count,
                           diagnostic *why);

/* Of a text file: which of the endings its name has, by index. remedy says what to do when it has none of them. */
status outputs_ending(const char *option, const char *path, const char *const *endings, size_t count,
                      const char *remedy, size_t *which, diagnostic *why);
/* Its folder alone: for what may be written in place of what was read. "-" is always right. */
status outputs_check_folder(const char *option, const char *path, diagnostic *why);
/* Its folder, and that the scene does not read it. "-" is always right. */
status outputs_check_place(const char *option, const char *path, const scene *s, diagnostic *why);
/* That no script is read from it: for what may be written in place of the scene itself. "-" is always right. */
status outputs_check_script(const char *option, const char *path, const scene *s, diagnostic *why);

/* Writes a text file, whole or not at all; path NULL or "-": to standard output. */
status outputs_write_text(const char *path, status (*write)(const void *content, FILE *out, diagnostic *why),
                          const void *content, diagnostic *why);

/* Writes them all; result has what was wanted, or a part of it. */
status outputs_write(const outputs *o, const render_result *result, diagnostic *why);
