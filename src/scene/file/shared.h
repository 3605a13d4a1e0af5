/* Shared scenes, which consist of a text only: in the metadata of a PNG image, in a link, in a shared page. They come
 * from strangers, so they may name no files, and are bounded in size and work. What is written obeys the same rules as
 * what is read, so that everything shared can be opened. A shared text is that of scene/file/write.h without the
 * parameters that only affect how fast a machine renders, such as render.threads, so that the same image has the same
 * file on every machine. Ownership: texts are the caller's, released with free. Errors: STATUS_BAD_INPUT with the
 * reason. */
#pragma once

#include "image/image.h"
#include "scene/model/open.h"

/* Bytes of the text; pixels; triangles; rays (scene/model/work.h); steps times masses of slimes. */
enum { SHARED_TEXT_MAX = 1 << 20, SHARED_PIXELS_MAX = 16777216, SHARED_TRIANGLES_MAX = 4000000 };
#define SHARED_RAYS_MAX 1e12
#define SHARED_MOTION_MAX 1e10

status shared_scene_check(const scene *s, diagnostic *why);
status shared_scene_text(const scene *s, char **text, diagnostic *why);

/* The text compressed (zlib, RFC 1950) as base64url, for the fragment of a link: #scene=CODE. */
#define SHARED_FRAGMENT "#scene="
status shared_scene_code(const char *text, char **code, diagnostic *why);

#define SHARED_KEYWORD "Cuvette scene" /* of the PNG text */

/* The texts of a PNG image of the scene: the program's version, and the scene unless it cannot be shared. Free
 * scene. STATUS_FAILURE: out of memory. */
typedef struct shared_texts {
    image_text item[2];
    int count;
    char *scene;
} shared_texts;
status shared_texts_make(const scene *s, shared_texts *texts, diagnostic *why);

/* A shared page holds the code between these. */
#define SHARED_PAGE_BEGIN "<script type=\"text/plain\" id=\"cuvette-scene\">"
#define SHARED_PAGE_END "</script>"

/* Whether a path is a link, and whether the bytes are those of a PNG image or of a shared page. */
bool shared_is_link(const char *path);
bool shared_is_file(const char *bytes, size_t size);

/* Reads them; name is used in diagnostics. */
status shared_read_link(const char *link, scene **out, diagnostic *why);
status shared_read_file(const char *name, const char *bytes, size_t size, scene **out, diagnostic *why);
/* The same from the text of a shared scene. */
status shared_read_text(const char *name, const char *text, size_t size, scene **out, diagnostic *why);
