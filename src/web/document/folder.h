/* The chosen folder: validates the names that pages send and confines reads and writes to the folder. A name is
 * relative to the folder, with '/', without "." or "..", without empty parts; a symbolic link that leads outside is
 * refused like a path with "..". Ownership: folder_open creates, folder_close releases; returned paths are allocated
 * memory. Errors: STATUS_BAD_INPUT; STATUS_FAILURE if memory runs out. */
#pragma once

#include "scene/model/open.h"

#include <jansson.h>

typedef struct folder folder;

status folder_open(const char *path, folder **out, diagnostic *why);
void folder_close(folder *f); /* NULL is allowed */

/* folder_root: the path of the folder as given. folder_title: the last part of its resolved path. */
const char *folder_root(const folder *f);
const char *folder_title(const folder *f);
/* The resolved path without links: the root of all reads (base/file.h). */
const char *folder_real(const folder *f);

/* The path of an existing file, for reading; with must_exist false the path of a file whose folder exists. The path
 * begins with folder_root, so it is relative to the working directory if the folder was given so. */
status folder_path(const folder *f, const char *name, bool must_exist, char **path, diagnostic *why);
/* The name in the folder of a path relative to the working directory; NULL if the path is outside. The file need
 * not exist. NULL with ENOMEM in errno: out of memory. */
char *folder_name(const folder *f, const char *path);
/* Like folder_name, with *name NULL if the path is outside. Fails only if memory runs out. */
status folder_find(const folder *f, const char *path, char **name, diagnostic *why);

/* The path by which the scene in `file` refers to the file `name`: relative to the scene's folder, absolute if the two
 * files have no common folder. file: "" is a scene in the working directory. */
status folder_path_from(const folder *f, const char *name, const char *file, char **path, diagnostic *why);

/* Checks that all files of the scene (textures, environment maps, meshes, scripts) are inside the folder. If a file
 * does not exist, its path decides. */
status folder_check_scene(const folder *f, const scene *s, diagnostic *why);

/* The reply to GET /api/files: the files of the folder and of three levels of folders below it, at most
 * FOLDER_FILES_MAX, no hidden files. The caller releases *out. STATUS_FAILURE if the list would be incomplete for lack
 * of memory or open files. */
enum { FOLDER_FILES_MAX = 2000 };
status folder_json(const folder *f, json_t **out, diagnostic *why);
