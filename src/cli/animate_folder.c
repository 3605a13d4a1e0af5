/* The files of an animation: the names of its frames, its progress index (PATTERN.json next to the frames), and checks
 * of the folder: its own frames, frames of other animations, and files that the scene reads. */
#include "base/file.h"
#include "base/json_build.h"
#include "base/status.h"
#include "base/text.h"
#include "cli/animate.h"
#include "cli/outputs.h"
#include "image/image.h"
#include "report/json.h"

#include <ctype.h>
#include <dirent.h>
#include <errno.h>
#include <inttypes.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* --- names of frames --- */

enum { DIGITS_MAX = 18 }; /* such a number fits into 64 bits */

static status refuse_name(const char *pattern, const char *remedy, const char *what, diagnostic *why)
{
    return options_wrong("-o", pattern, why, remedy, "%s", what);
}

static const char number_form[] = "write one %d, or %05d for five digits; write %% for a percent sign";

/* The length of the conversion "%d" or "%05d" at text; 0 for any other. */
static size_t conversion_length(const char *text, int *digits)
{
    size_t at = 1;
    *digits = 0;
    if (text[at] == '0')
        for (at++; isdigit((unsigned char)text[at]) && *digits <= DIGITS_MAX; at++)
            *digits = 10 * *digits + (text[at] - '0');
    bool right = text[at] == 'd' && *digits <= DIGITS_MAX && (at == 1 || *digits > 0);
    return right ? at + 1 : 0;
}

/* Splits name at its number; %% becomes %. */
static status split(const char *pattern, const char *name, animate_names *out, diagnostic *why)
{
    char *part = out->before;
    for (const char *at = name; *at;) {
        if (*at != '%' || at[1] == '%') {
            *part++ = *at;
            at += *at == '%' ? 2 : 1;
            continue;
        }
        int digits;
        size_t length = conversion_length(at, &digits);
        if (length == 0)
            return refuse_name(pattern, number_form, "invalid frame number after '%'", why);
        if (out->digits >= 0)
            return refuse_name(pattern, number_form, "the name has more than one frame number", why);
        out->digits = digits;
        part = out->after;
        at += length;
    }
    return out->digits >= 0 ? STATUS_OK : refuse_name(pattern, number_form, "the name has no frame number", why);
}

status animate_names_parse(const char *pattern, animate_names *out, diagnostic *why)
{
    const char *name = file_name_of(pattern);
    *out = (animate_names){.pattern = pattern, .digits = -1};
    if (image_format_of(name) == IMAGE_UNKNOWN)
        return refuse_name(pattern, "use " IMAGE_ENDINGS " for frames, .y4m for one video file",
                           "unknown file name ending", why);
    if (memchr(pattern, '%', (size_t)(name - pattern)))
        return refuse_name(pattern, "number the files, not their folder", "the folder's name has a %", why);
    out->folder = outputs_folder_of(pattern);
    out->before = calloc(1, strlen(name) + 1);
    out->after = calloc(1, strlen(name) + 1);
    if (!out->folder || !out->before || !out->after)
        return out_of_memory(why);
    return split(pattern, name, out, why);
}

void animate_names_release(animate_names *names)
{
    free(names->folder);
    free(names->before);
    free(names->after);
    *names = (animate_names){0};
}

char *animate_name(const animate_names *names, int64_t frame)
{
    return text_format("%s/%s%0*" PRId64 "%s", strcmp(names->folder, "/") == 0 ? "" : names->folder, names->before,
                       names->digits, frame, names->after);
}

/* The number of the frame whose file name is name, or -1. */
static int64_t frame_of_name(const animate_names *names, const char *name)
{
    const size_t before = strlen(names->before), after = strlen(names->after), length = strlen(name);
    if (length <= before + after || strncmp(name, names->before, before) != 0 ||
        strcmp(name + length - after, names->after) != 0)
        return -1;
    const char *digits = name + before;
    const size_t count = length - before - after;
    if (count > DIGITS_MAX || count < (size_t)names->digits || strspn(digits, "0123456789") < count)
        return -1;
    if (digits[0] == '0' && count > 1 && count > (size_t)names->digits)
        return -1; /* printf writes no further leading zeros */
    return strtoll(digits, NULL, 10);
}

/* --- the folder --- */

static const char elsewhere[] = "write to another folder, or use another name for the frames";

static status refuse(const animate_names *names, const char *name, const char *remedy, const char *what,
                     diagnostic *why)
{
    char *path = text_format("%s/%s", names->folder, name);
    diagnostic_locate(why, path ? path : name, 0, 0);
    free(path);
    return diagnose(why, STATUS_BAD_INPUT, remedy, "%s", what);
}

/* *out is NULL if the folder does not exist yet. */
static status open_folder(const animate_names *names, DIR **out, diagnostic *why)
{
    *out = opendir(names->folder);
    if (*out || errno == ENOENT)
        return STATUS_OK;
    return system_error(why, STATUS_FAILURE, names->folder, "cannot be listed", errno, "use a folder that can be read");
}

static bool is_folder(DIR *in, const char *name)
{
    struct stat about;
    return fstatat(dirfd(in), name, &about, 0) == 0 && S_ISDIR(about.st_mode);
}

static bool is_own_index(const animate_names *names, const char *name)
{
    const char *own = file_name_of(names->pattern);
    const size_t length = strlen(own);
    return strncmp(name, own, length) == 0 && strcmp(name + length, ".json") == 0;
}

static status check_frame(const animate_names *names, DIR *in, const char *name, int64_t known, diagnostic *why)
{
    if (is_folder(in, name))
        return refuse(names, name, elsewhere, "is a folder with the name of a frame", why);
    if (known < 0)
        return diagnose_at(why, names->folder, STATUS_BAD_INPUT,
                           "remove the frames yourself, or write to another folder",
                           "the folder has frames without a progress index, for example %.96s", name);
    char what[128];
    snprintf(what, sizeof what, "has the name of a frame, but the animation there has only %" PRId64 " frames", known);
    return frame_of_name(names, name) < known
               ? STATUS_OK
               : refuse(names, name, "remove it yourself, or write to another folder", what, why);
}

/* Returns whether progress_index is the index of another animation that has a frame with the name of one of this
 * animation's first `count` frames. */
static bool overlaps(const animate_names *names, const char *progress_index, int64_t count)
{
    animate_names other = {.digits = 0};
    char *path = text_format("%s/%s", names->folder, progress_index),
         *pattern = strndup(progress_index, strlen(progress_index) - strlen(".json"));
    const int64_t frames = path ? animate_index_count(path) : -1;
    bool same = false;
    if (pattern && animate_names_parse(pattern, &other, NULL) == STATUS_OK) {
        for (int64_t k = 0; k < frames && !same; k++) {
            char *theirs = animate_name(&other, k);
            const int64_t ours = theirs ? frame_of_name(names, file_name_of(theirs)) : -1;
            same = ours >= 0 && ours < count;
            free(theirs);
        }
    }
    animate_names_release(&other);
    free(pattern);
    free(path);
    return same;
}

/* STATUS_BAD_INPUT if a file has a frame's name but is not one of the first `known` frames (known < 0: there is no
 * index, so no frame is known), or if the index of another animation covers one of the first max(known, wanted) frame
 * names. */
static status check_folder(const animate_names *names, int64_t known, int64_t wanted, diagnostic *why)
{
    DIR *folder;
    status result = open_folder(names, &folder, why);
    for (const struct dirent *entry; folder && result == STATUS_OK && (entry = readdir(folder));) {
        const char *name = entry->d_name;
        if (frame_of_name(names, name) >= 0)
            result = check_frame(names, folder, name, known, why);
        else if (outputs_ends_with(name, ".json") && !is_own_index(names, name) &&
                 overlaps(names, name, known > wanted ? known : wanted))
            result = refuse(names, name, elsewhere, "another animation has frames with the same names", why);
    }
    if (folder)
        closedir(folder);
    return result;
}

/* Removes all frames. */
static status clear_folder(const animate_names *names, diagnostic *why)
{
    DIR *folder;
    status result = open_folder(names, &folder, why);
    for (const struct dirent *entry; folder && result == STATUS_OK && (entry = readdir(folder));) {
        if (frame_of_name(names, entry->d_name) < 0 || unlinkat(dirfd(folder), entry->d_name, 0) == 0)
            continue;
        char what[96];
        const int error = errno;
        snprintf(what, sizeof what, "cannot be removed: %s", strerrordesc_np(error));
        refuse(names, entry->d_name, system_remedy(error), what, why);
        result = STATUS_FAILURE;
    }
    if (folder) {
        fsync(dirfd(
            folder)); /* removed on disk before a new index, which would otherwise list frames of another animation */
        closedir(folder);
    }
    return result;
}

typedef struct read_search {
    const animate_names *names;
    char found[256]; /* path of the file, for the message */
} read_search;

static bool is_frame_or_index(const animate_names *names, const char *path)
{
    const char *name = file_name_of(path);
    if (frame_of_name(names, name) < 0 && !is_own_index(names, name))
        return false;
    char *folder = outputs_folder_of(path);
    const bool same = folder && outputs_same_entry(folder, names->folder);
    free(folder);
    return same;
}

/* Checks the path and, for a symbolic link, its target. */
static bool is_frame(void *context, const char *path)
{
    read_search *x = context;
    char *target = realpath(path, NULL);
    const bool same = is_frame_or_index(x->names, path) || (target && is_frame_or_index(x->names, target));
    free(target);
    if (same)
        snprintf(x->found, sizeof x->found, "%.200s", path);
    return same;
}

status animate_names_check(const animate_names *names, const scene *s, diagnostic *why)
{
    read_search x = {.names = names};
    if (!scene_files_any(s, is_frame, &x))
        return STATUS_OK;
    return options_wrong("-o", names->pattern, why, elsewhere,
                         "the scene reads %s, which has the name of a frame or of the index", x.found);
}

/* --- the index --- */

enum { INDEX_BYTES_MAX = 1 << 26 };

static const char otherwise[] = "write to another folder, or add --restart, which removes the frames there";

static status refuse_index(const char *path, diagnostic *why, const char *what)
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

/* The first parameter of `from` that has another value in `to`, or is missing there; NULL for none. */
static const char *first_difference(json_t *from, const json_t *to)
{
    const char *path;
    json_t *value;
    json_object_foreach(from, path, value)
    {
        if (!json_equal(json_object_get(to, path), value))
            return path;
    }
    return NULL;
}

static status refuse_definition(const char *path, const json_t *progress_index, const animate_definition *d,
                                diagnostic *why)
{
    json_t *there = json_object_get(progress_index, "parameters");
    const char *differs = first_difference(d->parameters, there);
    const char *removed = differs ? NULL : first_difference(there, d->parameters);
    const char *before = differs ? json_string_value(json_object_get(there, differs)) : NULL;
    char what[320];
    if (removed)
        snprintf(what, sizeof what, "the frames there belong to another animation, with %.96s", removed);
    else if (!differs)
        snprintf(what, sizeof what,
                 "the frames there belong to another animation: a file that the scene reads has changed");
    else if (!before)
        snprintf(what, sizeof what, "the frames there belong to another animation, without %.96s", differs);
    else
        snprintf(what, sizeof what, "the frames there belong to another animation: %.96s was %.64s and is now %.64s",
                 differs, before, json_string_value(json_object_get(d->parameters, differs)));
    return refuse_index(path, why, what);
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
        result = refuse_index(path, why, what);
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
    THEN(result, check_folder(names, known, count, why));
    free(path);
    return result;
}

status animate_index_begin(const animate_names *names, const animate_definition *d, int64_t count, bool restart,
                           diagnostic *why)
{
    char *path = progress_index_path(names);
    status result = path ? file_make_directory(names->folder, why) : out_of_memory(why);
    if (result == STATUS_OK && restart)
        result = clear_folder(names, why);
    if (result == STATUS_OK && (restart || count > animate_index_count(path)))
        result = write_index(path, names, d, count, why);
    free(path);
    return result;
}
