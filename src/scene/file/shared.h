/* Shared scenes: a text in the metadata of a PNG image, in a link or in a shared page. They come from strangers, so
 * they may name no files, and are bounded in size and work. The writer obeys the same rules as the reader, so that
 * everything shared can be opened. The text is written by scene/file/write.h, without parameters that only affect how
 * fast a machine renders, such as render.threads (render.accel is kept), so that the same image has the same file on
 * every machine. Ownership: the caller frees texts. Errors: STATUS_BAD_INPUT with the reason. */
#pragma once

#include "image/image.h"
#include "scene/model/open.h"

/* Limits: bytes of the text; pixels; triangles; rays (scene/model/scene.h); steps times masses of slimes. */
enum { SHARED_TEXT_MAX = 1 << 20, SHARED_PIXELS_MAX = 16777216, SHARED_TRIANGLES_MAX = 4000000 };
#define SHARED_RAYS_MAX 1e12
#define SHARED_MOTION_MAX 1e10

/* Whether the scene may be shared: it names no files, and is within the limits. */
status shared_scene_check(const scene *s, diagnostic *why);
/* The shared text of a scene. */
status shared_scene_text(const scene *s, char **text, diagnostic *why);

/* The text compressed (zlib, RFC 1950) as base64url, for the fragment of a link: #scene=CODE. */
#define SHARED_FRAGMENT "#scene="
status shared_scene_code(const char *text, char **code, diagnostic *why);

#define SHARED_KEYWORD "Cuvette scene" /* keyword of the PNG text chunk */

/* The texts of a PNG image of the scene: the program's version, and the scene unless it cannot be shared. The caller
 * frees `scene`. STATUS_FAILURE: out of memory. */
typedef struct shared_texts {
    image_text item[2];
    int count;
    char *scene;
} shared_texts;
status shared_texts_make(const scene *s, shared_texts *texts, diagnostic *why);

/* A shared page has the code between these two texts. */
#define SHARED_PAGE_BEGIN "<script type=\"text/plain\" id=\"cuvette-scene\">"
#define SHARED_PAGE_END "</script>"

/* Whether a path is a link to a shared scene; whether the bytes are a PNG image or a shared page. */
bool shared_is_link(const char *path);
bool shared_is_file(const char *bytes, size_t size);

/* Read a link, or the bytes of an image or page; name is used in diagnostics. */
status shared_read_link(const char *link, scene **out, diagnostic *why);
status shared_read_file(const char *name, const char *bytes, size_t size, scene **out, diagnostic *why);
/* Reads the text of a shared scene, and checks that it may be shared. */
status shared_read_text(const char *name, const char *text, size_t size, scene **out, diagnostic *why);
