/* What rows of an earlier version meant, from the manifest beside them. */
#include "base/file.h"
#include "study/manifest.h"
#include <jansson.h>
#include <stdlib.h>
#include <string.h>

static char *copy_text(const json_t *object, const char *key)
{
    const char *text = json_string_value(json_object_get(object, key));
    return text ? strdup(text) : NULL;
}

/* 16 hex digits under a key. */
static bool get_hash(const json_t *object, const char *key, uint64_t *out)
{
    const char *text = json_string_value(json_object_get(object, key));
    if (!text || strlen(text) != 16 || strspn(text, "0123456789abcdef") != 16)
        return false;
    *out = strtoull(text, NULL, 16);
    return true;
}

status manifest_read(const char *path, const char *root, manifest_study *out, diagnostic *why)
{
    char *text;
    size_t size;
    *out = (manifest_study){0};
    status code = file_read_below(path, root, MANIFEST_BYTES_MAX, &text, &size, why);
    if (code != STATUS_OK)
        return code;
    json_t *whole = json_loadb(text, size, 0, NULL);
    const json_t *about = json_object_get(whole, "study");
    free(text);
    out->text = copy_text(about, "text");
    out->scene_text = copy_text(about, "scene_text");
    out->has_files = get_hash(about, "files", &out->files);
    const bool has_definition = get_hash(about, "definition", &out->definition);
    json_decref(whole);
    if (out->text && out->scene_text && has_definition)
        return STATUS_OK;
    manifest_study_free(out);
    return diagnose(why, STATUS_BAD_INPUT, "", "the manifest.json beside them does not say what they mean");
}

void manifest_study_free(manifest_study *m)
{
    free(m->text);
    free(m->scene_text);
    *m = (manifest_study){0};
}
