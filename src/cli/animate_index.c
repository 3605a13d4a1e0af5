/* The progress index of an animation: PATTERN.json next to its frames. */
#include "cli/animate.h"
#include "base/file.h"
#include "base/json_build.h"
#include "cli/outputs.h"
#include "base/text.h"
#include "report/json.h"
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { INDEX_BYTES_MAX = 1 << 26 };

static const char otherwise[] = "write to another folder, or add --restart, which removes the frames there";

static status refuse(const char *path, diagnostic *why, const char *what)
{
    return diagnose_at(why, path, STATUS_BAD_INPUT, otherwise, "%s", what);
}

static char *progress_index_path(const animate_names *names)
{
    return text_format("%s.json", names->pattern);
}

static status put_index(const void *progress_index, FILE *out, diagnostic *why)
{
    return json_write(out, progress_index, why);
}

static status write_index(const char *path, const animate_names *names, const animate_definition *d, int64_t count,
                          diagnostic *why)
{
    char hash[32];
    snprintf(hash, sizeof hash, "%016" PRIx64, d->hash);
    json_t *progress_index =
        json_pack("{s:s,s:o,s:I,s:s,s:O}", "version", CUVETTE_VERSION, "frames", json_of_text(names->pattern), "count",
                  (json_int_t)count, "definition", hash, "parameters", d->parameters);
    const status result =
        progress_index ? outputs_write_text(path, put_index, progress_index, why) : out_of_memory(why);
    json_decref(progress_index);
    return result;
}

/* The first parameter in which two definitions differ; NULL for none. */
static const char *first_difference(const json_t *there, json_t *here)
{
    const char *path;
    json_t *value;
    json_object_foreach(here, path, value)
    {
        if (!json_equal(json_object_get(there, path), value))
            return path;
    }
    return NULL;
}

static status refuse_definition(const char *path, const json_t *progress_index, const animate_definition *d,
                                diagnostic *why)
{
    const json_t *there = json_object_get(progress_index, "parameters");
    const char *differs = first_difference(there, d->parameters);
    const char *before = differs ? json_string_value(json_object_get(there, differs)) : NULL;
    char what[320];
    if (!differs)
        snprintf(what, sizeof what,
                 "the frames there belong to another animation: a file that the scene reads has changed");
    else if (!before)
        snprintf(what, sizeof what, "the frames there belong to another animation, without %.96s", differs);
    else
        snprintf(what, sizeof what, "the frames there belong to another animation: %.96s was %.64s and is now %.64s",
                 differs, before, json_string_value(json_object_get(d->parameters, differs)));
    return refuse(path, why, what);
}

static json_t *load(const char *path, status *result, diagnostic *why)
{
    char *text = NULL;
    size_t size;
    json_error_t error;
    bool no_memory = false;
    *result = file_read(path, INDEX_BYTES_MAX, &text, &size, why);
    json_t *progress_index =
        *result == STATUS_OK ? json_parse(text, size, JSON_REJECT_DUPLICATES, &error, &no_memory) : NULL;
    free(text);
    if (no_memory)
        *result = out_of_memory(why);
    return progress_index;
}

static int64_t count_of(const json_t *progress_index)
{
    const json_t *count = json_object_get(progress_index, "count");
    return json_is_integer(count) && json_object_get(progress_index, "definition") ? json_integer_value(count) : -1;
}

int64_t animate_index_count(const char *path)
{
    status result;
    json_t *progress_index = load(path, &result, NULL);
    const int64_t count = count_of(progress_index);
    json_decref(progress_index);
    return count;
}

/* *count: the number of frames in the index. */
static status compare(const char *path, const animate_definition *d, bool restart, int64_t *count, diagnostic *why)
{
    status result;
    char hash[32];
    json_t *progress_index = load(path, &result, why);
    if (result != STATUS_OK)
        return result;
    snprintf(hash, sizeof hash, "%016" PRIx64, d->hash);
    const char *definition = json_string_value(json_object_get(progress_index, "definition"));
    const char *version = json_string_value(json_object_get(progress_index, "version"));
    char what[160];
    *count = count_of(progress_index);
    if (!definition || !version || *count < 0) {
        result =
            diagnose_at(why, path, STATUS_BAD_INPUT, "write to another folder, or remove it and the frames yourself",
                        "is not the progress index of an animation");
    } else if (!restart && strcmp(version, CUVETTE_VERSION) != 0) {
        snprintf(what, sizeof what, "the frames there were rendered by version %.32s, this is version %s", version,
                 CUVETTE_VERSION);
        result = refuse(path, why, what);
    } else if (!restart && strcmp(definition, hash) != 0) {
        result = refuse_definition(path, progress_index, d, why);
    }
    json_decref(progress_index);
    return result;
}

status animate_index_check(const animate_names *names, const animate_definition *d, int64_t count, bool restart,
                           diagnostic *why)
{
    int64_t known = -1;
    char *path = progress_index_path(names);
    status result = path ? STATUS_OK : out_of_memory(why);
    if (path && access(path, F_OK) == 0)
        result = compare(path, d, restart, &known, why);
    THEN(result, animate_folder_check(names, known, count, why));
    free(path);
    return result;
}

status animate_index_begin(const animate_names *names, const animate_definition *d, int64_t count, bool restart,
                           diagnostic *why)
{
    char *path = progress_index_path(names);
    status result = path ? file_make_directory(names->folder, why) : out_of_memory(why);
    if (result == STATUS_OK && restart)
        result = animate_folder_clear(names, why);
    if (result == STATUS_OK && (restart || count > animate_index_count(path)))
        result = write_index(path, names, d, count, why);
    free(path);
    return result;
}
