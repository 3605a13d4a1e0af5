/* Writing scenes: files, their text, links. */
#include "engine/engine_private.h"

#include "scene/file/shared.h"
#include "scene/file/write.h"
#include <stdlib.h>
#include <string.h>

cuvette_status engine_copy_text(char *content, char *text, size_t size, size_t *length, cuvette_diagnostic *why)
{
    const size_t needed = strlen(content);
    if (length)
        *length = needed;
    const bool fits = needed < size;
    if (fits)
        memcpy(text, content, needed + 1);
    free(content);
    if (fits)
        return CUVETTE_OK;
    diagnostic inner = {.line = 0};
    return engine_report(diagnose(&inner, STATUS_BAD_INPUT, "make room for the reported length plus 1",
                                  "the text has %zu characters, but the buffer only %zu bytes", needed, size),
                         &inner, why);
}

cuvette_status cuvette_scene_write(const cuvette_scene *s, const char *path, cuvette_diagnostic *why)
{
    ENGINE_CALL(s, path);
    cuvette_scene *held = engine_hold(s);
    const status code = scene_write(held->model, path, false, &inner);
    pthread_mutex_unlock(&held->loading);
    return engine_report(code, &inner, why);
}

static status make_text(const scene *s, char **text, diagnostic *why)
{
    return scene_write_text(s, NULL, false, text, why);
}

static status make_link(const scene *s, char **code, diagnostic *why)
{
    char *text = NULL;
    TRY(shared_scene_text(s, &text, why));
    const status result = shared_scene_code(text, code, why);
    free(text);
    return result;
}

/* Copies what make made of the scene; inner: the diagnostic of the calling function. */
static cuvette_status copy_made(const cuvette_scene *s, status (*make)(const scene *s, char **text, diagnostic *why),
                                char *text, size_t size, size_t *length, diagnostic *inner, cuvette_diagnostic *why)
{
    if (size > 0)
        ENGINE_NEED(text);
    char *content = NULL;
    cuvette_scene *held = engine_hold(s);
    const status code = make(held->model, &content, inner);
    pthread_mutex_unlock(&held->loading);
    return code == STATUS_OK ? engine_copy_text(content, text, size, length, why) : engine_report(code, inner, why);
}

cuvette_status cuvette_scene_write_text(const cuvette_scene *s, char *text, size_t size, size_t *length,
                                        cuvette_diagnostic *why)
{
    ENGINE_CALL(s);
    return copy_made(s, make_text, text, size, length, &inner, why);
}

cuvette_status cuvette_scene_write_link(const cuvette_scene *s, char *text, size_t size, size_t *length,
                                        cuvette_diagnostic *why)
{
    ENGINE_CALL(s);
    return copy_made(s, make_link, text, size, length, &inner, why);
}
