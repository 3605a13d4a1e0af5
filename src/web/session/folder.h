/* The folder that was chosen: names that pages give, and what may be read and written. A name is relative to it, with
 * '/', without "." or ".." or an empty part; what a symbolic link leads out of it is refused like a path that climbs.
 * Ownership: folder_open gives, folder_close releases; paths are fresh memory. Errors: STATUS_BAD_INPUT. */
#pragma once

#include "scene/model/open.h"
#include <jansson.h>

typedef struct folder folder;

status folder_open(const char *path, folder **out, diagnostic *why);
void folder_close(folder *f); /* NULL is allowed */

/* The folder itself: as it was given, and its own name. */
const char *folder_root(const folder *f);
const char *folder_title(const folder *f);
/* Where it really lies: what files are below that may be read (base/below.h). */
const char *folder_real(const folder *f);

/* The path of a file that is there, to be read; or, with must_exist false, of one whose folder is there. In the
 * program's own terms. */
status folder_path(const folder *f, const char *name, bool must_exist, char **path, diagnostic *why);
/* The name of a path, in the program's own terms; NULL where it is not in the folder. The file need not be there. */
char *folder_name(const folder *f, const char *path);

/* A name as a scene in that file gives it: relative to the file's folder, absolute where the two have nothing in
 * common. file: "" stands for one in the working folder. */
status folder_path_from(const folder *f, const char *name, const char *file, char **path, diagnostic *why);

/* Does the scene name files outside of it (textures, skies, meshes, scripts)? Files that are not there are in it when
 * their path is. */
status folder_check_scene(const folder *f, const scene *s, diagnostic *why);

/* What GET /api/files answers: three folders deep, at most FOLDER_FILES_MAX files, none that are hidden; NULL when
 * memory is out. */
enum { FOLDER_FILES_MAX = 2000 };
json_t *folder_tell(const folder *f);
