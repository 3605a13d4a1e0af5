/* Free space: statvfs(3). */
#include "base/disk_room.h"

#include "base/file.h"
#include "base/system_error.h"
#include <errno.h>
#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <sys/statvfs.h>

enum { BLOCK_BYTES = 4096 };

void disk_room_add(disk_room *to, double count, double least_bytes, double most_bytes)
{
    to->least_bytes += count * least_bytes;
    to->most_bytes += count * (ceil(most_bytes / BLOCK_BYTES) * BLOCK_BYTES);
}

/* The folder above; false at the end. */
static bool shorten(char *path)
{
    char *slash = strrchr(path, '/');
    if (!slash && strcmp(path, ".") == 0)
        return false;
    if (!slash)
        strcpy(path, "."); /* no path is empty */
    else if (slash == path && !path[1])
        return false;
    else
        slash[slash == path] = 0;
    return true;
}

double disk_room_free(const char *path)
{
    struct statvfs about;
    char folder[PATH_MAX]; /* the longest that the kernel takes */
    int code = -1;
    if (path[0] && strlen(path) < sizeof folder) {
        strcpy(folder, path);
        do
            code = statvfs(folder, &about);
        while (code != 0 && (errno == ENOENT || errno == ENOTDIR) && shorten(folder));
    }
    return code == 0 ? (double)about.f_bavail * (double)about.f_frsize : (double)NAN;
}

void disk_room_bytes_text(double bytes, char *text, size_t size)
{
    static const char *const units[] = {"bytes", "kB", "MB", "GB", "TB", "PB"};
    size_t unit = 0;
    for (; bytes >= 999.5 && unit + 1 < sizeof units / sizeof *units; unit++)
        bytes /= 1000;
    snprintf(text, size, unit == 0 || bytes >= 99.5 ? "%.0f %s" : "%.2g %s", bytes, units[unit]);
}

void disk_room_text(const disk_room *needed, char *text, size_t size)
{
    char least[32], most[32];
    disk_room_bytes_text(needed->least_bytes, least, sizeof least);
    disk_room_bytes_text(needed->most_bytes, most, sizeof most);
    snprintf(text, size, "%s to %s", least, most);
}

status disk_room_check(const disk_room *needed, double free_bytes, const char *place, const char *what,
                       char note[DISK_ROOM_TEXT_MAX], diagnostic *why)
{
    char least[32], most[32], left[32];
    note[0] = 0;
    if (!(needed->most_bytes > free_bytes))
        return STATUS_OK;
    disk_room_bytes_text(needed->least_bytes, least, sizeof least);
    disk_room_bytes_text(needed->most_bytes, most, sizeof most);
    disk_room_bytes_text(free_bytes, left, sizeof left);
    if (needed->least_bytes > free_bytes)
        return diagnose_at(why, place, STATUS_FAILURE, system_remedy(ENOSPC),
                           "%s writes at least %s, but only %s are free there", what, least, left);
    snprintf(note, DISK_ROOM_TEXT_MAX, "%.48s: %s may write up to %s, and only %s are free there", place, what, most,
             left);
    return STATUS_OK;
}
