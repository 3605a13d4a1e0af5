/* Checks of the folder of an animation: its own frames, frames of other animations, and files that the scene reads. */
#include "cli/animate.h"
#include "base/status.h"
#include "base/file.h"
#include "base/text.h"
#include "cli/outputs.h"
#include <dirent.h>
#include <errno.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static const char elsewhere[] = "write to another folder, or use another name for the frames";

static status refuse(const animate_names *names, const char *name, const char *remedy, const char *what,
                     diagnostic *why)
{
    char *path = text_format("%s/%s", names->folder, name);
    diagnostic_locate(why, path ? path : name, 0, 0);
    free(path);
    return diagnose(why, STATUS_BAD_INPUT, remedy, "%s", what);
}

/* *out is NULL where the folder does not exist yet. */
static status open_folder(const animate_names *names, DIR **out, diagnostic *why)
{
    *out = opendir(names->folder);
    if (*out || errno == ENOENT)
        return STATUS_OK;
    return system_error(why, STATUS_FAILURE, names->folder, "cannot be listed", errno,
                        "give a folder that can be read");
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
    return animate_name_frame(names, name) < known
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
            const int64_t ours = theirs ? animate_name_frame(names, file_name_of(theirs)) : -1;
            same = ours >= 0 && ours < count;
            free(theirs);
        }
    }
    animate_names_release(&other);
    free(pattern);
    free(path);
    return same;
}

status animate_folder_check(const animate_names *names, int64_t known, int64_t wanted, diagnostic *why)
{
    DIR *folder;
    status result = open_folder(names, &folder, why);
    for (const struct dirent *entry; folder && result == STATUS_OK && (entry = readdir(folder));) {
        const char *name = entry->d_name;
        if (animate_name_frame(names, name) >= 0)
            result = check_frame(names, folder, name, known, why);
        else if (outputs_ends_with(name, ".json") && !is_own_index(names, name) &&
                 overlaps(names, name, known > wanted ? known : wanted))
            result = refuse(names, name, elsewhere, "another animation has frames with the same names", why);
    }
    if (folder)
        closedir(folder);
    return result;
}

status animate_folder_clear(const animate_names *names, diagnostic *why)
{
    DIR *folder;
    status result = open_folder(names, &folder, why);
    for (const struct dirent *entry; folder && result == STATUS_OK && (entry = readdir(folder));) {
        if (animate_name_frame(names, entry->d_name) < 0 || unlinkat(dirfd(folder), entry->d_name, 0) == 0)
            continue;
        char what[96];
        const int error = errno;
        snprintf(what, sizeof what, "cannot be removed: %s", strerrordesc_np(error));
        refuse(names, entry->d_name, system_remedy(error), what, why);
        result = STATUS_FAILURE;
    }
    if (folder) {
        fsync(dirfd(folder)); /* before a new index: it must never have the frames of another animation */
        closedir(folder);
    }
    return result;
}

typedef struct read_search {
    const animate_names *names;
    char found[256]; /* path of the file, for the message */
} read_search;

static bool is_in_place(const animate_names *names, const char *path)
{
    const char *name = file_name_of(path);
    if (animate_name_frame(names, name) < 0 && !is_own_index(names, name))
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
    char *whole = realpath(path, NULL);
    const bool same = is_in_place(x->names, path) || (whole && is_in_place(x->names, whole));
    free(whole);
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
                         "the scene is read from %s, which has the name of a frame", x.found);
}
