/* Files of unsaved scenes: their names, their locks, and the line that describes the scene. */
#include "web/document/kept_scenes.h"
#include "base/file.h"
#include "base/json_build.h"
#include "base/text.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

static const char name_prefix[] = "unsaved-", name_suffix[] = ".yaml", partial_suffix[] = ".part";
static const char first_words[] = "# An unsaved scene of cuvette lab: ";
enum { UNFINISHED_S = 60 }; /* a younger file may still be written: it is locked only after its creation */

void kept_scene_release(kept_scene *k)
{
    if (k->path)
        close(k->fd);
    free(k->path);
    json_decref(k->about);
    *k = (kept_scene){.path = NULL};
}

void kept_scene_remove(kept_scene *k)
{
    if (k->path)
        unlink(k->path);
    kept_scene_release(k);
}

/* --- reading --- */

/* unsaved-0123456789abcdef.yaml */
static bool is_kept_name(const char *name)
{
    return strncmp(name, name_prefix, strlen(name_prefix)) == 0 &&
           strlen(name) == strlen(name_prefix) + 16 + strlen(name_suffix) &&
           strcmp(name + strlen(name_prefix) + 16, name_suffix) == 0;
}

static bool ends_with(const char *name, const char *ending)
{
    const size_t length = strlen(name), size = strlen(ending);
    return length > size && strcmp(name + length - size, ending) == 0;
}

/* Opens a file of this user and locks it. Returns -1 if another process has locked it or it was replaced meanwhile. */
static int lock_file(const char *path, struct stat *about)
{
    struct stat named;
    const int fd = open(path, O_RDWR | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK);
    if (fd < 0)
        return -1;
    if (fstat(fd, about) == 0 && S_ISREG(about->st_mode) && about->st_uid == geteuid() &&
        flock(fd, LOCK_EX | LOCK_NB) == 0 && lstat(path, &named) == 0 && named.st_ino == about->st_ino &&
        named.st_dev == about->st_dev)
        return fd;
    close(fd);
    return -1;
}

/* The JSON of the first line; NULL if it has none. The JSON is ASCII, because YAML also ends a comment at line breaks
 * outside ASCII. */
static json_t *read_about(int fd)
{
    enum { LINE_MAX_BYTES = 1 << 16 };
    char *line = malloc(LINE_MAX_BYTES + 1);
    const ssize_t got = line ? pread(fd, line, LINE_MAX_BYTES, 0) : -1;
    json_t *about = NULL;
    if (got > 0) {
        line[got] = 0;
        line[strcspn(line, "\n")] = 0;
        if (strncmp(line, first_words, strlen(first_words)) == 0)
            about = json_loads(line + strlen(first_words), 0, NULL);
    }
    free(line);
    const bool good = json_is_string(json_object_get(about, "time")) &&
                      json_is_string(json_object_get(about, "title")) &&
                      json_is_string(json_object_get(about, "folder"));
    if (good)
        return about;
    json_decref(about);
    return NULL;
}

/* Locks an unsaved scene's file and reads its first line; *k then owns path. False, with path freed, if that fails. */
static bool claim(char *path, const char *name, kept_scene *k)
{
    struct stat about;
    const int fd = lock_file(path, &about);
    json_t *line = fd >= 0 && about.st_size <= KEPT_SCENE_BYTES_MAX ? read_about(fd) : NULL;
    if (!line) {
        if (fd >= 0)
            close(fd);
        free(path);
        return false;
    }
    *k = (kept_scene){.path = path, .fd = fd, .about = line};
    snprintf(k->id, sizeof k->id, "%.16s", name + strlen(name_prefix));
    return true;
}

static const char *time_of(const kept_scene *k)
{
    return json_string_value(json_object_get(k->about, "time"));
}

/* Inserts into the sorted list; if it is full, the oldest scene is removed. */
static size_t insert(kept_scene *list, size_t count, kept_scene k)
{
    if (count == KEPT_SCENES_MAX) {
        kept_scene *last = &list[count - 1];
        const bool older = strcmp(time_of(&k), time_of(last)) < 0;
        kept_scene_remove(older ? &k : last);
        if (older)
            return count;
        count--;
    }
    size_t at = count;
    for (; at > 0 && strcmp(time_of(&list[at - 1]), time_of(&k)) < 0; at--)
        list[at] = list[at - 1];
    list[at] = k;
    return count + 1;
}

static void remove_unfinished(const char *path)
{
    struct stat about;
    const int fd = lock_file(path, &about);
    if (fd >= 0 && about.st_mtime < time(NULL) - UNFINISHED_S)
        unlink(path);
    if (fd >= 0)
        close(fd);
}

size_t kept_scenes_claim(const char *folder, kept_scene list[KEPT_SCENES_MAX])
{
    size_t count = 0;
    DIR *files = opendir(folder);
    const struct dirent *entry;
    while (files && (entry = readdir(files))) {
        const char *name = entry->d_name;
        char *path = text_format("%s/%s", folder, name);
        kept_scene k;
        if (path && is_kept_name(name)) {
            if (claim(path, name, &k))
                count = insert(list, count, k);
            continue;
        }
        if (path && ends_with(name, partial_suffix))
            remove_unfinished(path);
        free(path);
    }
    if (files)
        closedir(files);
    return count;
}

status kept_scene_read(const kept_scene *k, char **text, size_t *size, diagnostic *why)
{
    return file_read(k->path, KEPT_SCENE_BYTES_MAX, text, size, why);
}

/* --- writing --- */

/* Other users must not be able to write to the folder: the laboratory would offer their files as unsaved scenes. */
status kept_scenes_folder(const char *folder, diagnostic *why)
{
    struct stat about;
    char *above = strdup(folder), *slash = above ? strrchr(above, '/') : NULL;
    if (slash)
        *slash = 0;
    status code = !above ? out_of_memory(why) : slash > above ? file_make_directory(above, why) : STATUS_OK;
    free(above);
    if (code == STATUS_OK && mkdir(folder, 0700) != 0 && errno != EEXIST)
        code = file_make_directory(folder, why); /* fails again, with the reason */
    TRY(code);
    if (stat(folder, &about) != 0 || about.st_uid != geteuid() || (about.st_mode & 022))
        return diagnose_at(why, folder, STATUS_FAILURE, "make it yours: use chown, and chmod 700",
                           "the folder belongs to another user, or another user can write to it");
    return STATUS_OK;
}

static bool choose_name(const char *folder, kept_scene *k)
{
    uint64_t number;
    if (getrandom(&number, sizeof number, 0) != sizeof number)
        return false;
    snprintf(k->id, sizeof k->id, "%016" PRIx64, number);
    k->path = text_format("%s/%s%s%s", folder, name_prefix, k->id, name_suffix);
    return k->path != NULL;
}

static status write_locked(const char *path, const char *line, const char *text, int *fd, diagnostic *why)
{
    file_writer writer;
    TRY(file_writer_open(&writer, path, why));
    *fd = fcntl(fileno(writer.stream), F_DUPFD_CLOEXEC, 3);
    status code = STATUS_OK;
    if (*fd < 0 || fchmod(*fd, 0600) != 0 || flock(*fd, LOCK_EX | LOCK_NB) != 0)
        code = diagnose_at(why, path, STATUS_FAILURE, "set XDG_STATE_HOME to a folder on a local disk",
                           "the file cannot be locked");
    fprintf(writer.stream, "%s%s\n%s", first_words, line, text);
    code = file_writer_end(&writer, code, why);
    if (code != STATUS_OK && *fd >= 0)
        close(*fd);
    return code;
}

static bool set_time(json_t *about)
{
    const time_t now = time(NULL);
    struct tm parts;
    char text[32];
    return gmtime_r(&now, &parts) && strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &parts) > 0 &&
           json_object_set_new(about, "time", json_string(text)) == 0;
}

status kept_scene_write(const char *folder, kept_scene *kept, json_t *about, const char *text, diagnostic *why)
{
    if (strlen(text) > KEPT_SCENE_BYTES_MAX / 2)
        return diagnose(why, STATUS_BAD_INPUT, "save the scene",
                        "the scene's text is longer than %d bytes, the limit for keeping it unsaved",
                        KEPT_SCENE_BYTES_MAX / 2);
    TRY(kept_scenes_folder(folder, why));
    kept_scene fresh = {.path = NULL};
    char *line = set_time(about) ? json_text(about, JSON_COMPACT | JSON_ENSURE_ASCII) : NULL;
    const bool named = kept->path || choose_name(folder, &fresh);
    int fd = -1;
    status code =
        line && named ? write_locked(kept->path ? kept->path : fresh.path, line, text, &fd, why) : out_of_memory(why);
    free(line);
    if (code != STATUS_OK) {
        free(fresh.path);
        return code;
    }
    if (kept->path)
        close(kept->fd); /* the lock of the replaced file */
    else
        *kept = fresh;
    kept->fd = fd;
    return STATUS_OK;
}
