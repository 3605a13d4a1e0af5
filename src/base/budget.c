/* Free memory: proc(5), cgroups(7), getrlimit(2); free disk space: statvfs(3); and sizes as text. */
#include "base/budget.h"

#include "base/file.h"
#include "base/number.h"
#include "base/os_process.h"
#include <errno.h>
#include <limits.h>
#include <math.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/resource.h>
#include <sys/statvfs.h>
#include <unistd.h>

static _Atomic uint64_t limit;
static _Thread_local memory_room assumed;

void memory_budget_set(uint64_t bytes)
{
    atomic_store(&limit, bytes);
}

uint64_t memory_budget_limit(void)
{
    return atomic_load(&limit);
}

/* ---- free memory ---- */

/* Reads the number after `name` at the beginning of a line of a file; with an empty name, the file's first number.
 * False if there is none ("max"). */
static bool read_number(const char *root, const char *path, const char *name, uint64_t *value)
{
    char place[1600], line[512];
    snprintf(place, sizeof place, "%.200s%.1300s", root, path);
    FILE *file = fopen(place, "re");
    bool found = false;
    while (file && !found && fgets(line, sizeof line, file)) {
        unsigned long long number;
        const size_t length = strlen(name);
        found = strncmp(line, name, length) == 0 && sscanf(line + length, "%llu", &number) == 1;
        if (found)
            *value = number;
    }
    if (file)
        fclose(file);
    return found;
}

static uint64_t least(uint64_t a, uint64_t b)
{
    return a < b ? a : b;
}

/* The names of the files of one group: cgroup 2 (Documentation/admin-guide/cgroup-v2.rst), and 1 (cgroup-v1). */
static const struct group_files {
    const char *limit, *used, *dropped; /* dropped: the key in memory.stat for pages that can be dropped */
} version[2] = {{"memory.max", "memory.current", "inactive_file "},
                {"memory.limit_in_bytes", "memory.usage_in_bytes", "total_inactive_file "}};

static uint64_t free_in_group(const char *root, const struct group_files *files, const char *folder)
{
    char path[1300];
    uint64_t most, used, dropped = 0;
    snprintf(path, sizeof path, "%.1200s/%s", folder, files->limit);
    if (!read_number(root, path, "", &most))
        return UINT64_MAX;
    snprintf(path, sizeof path, "%.1200s/%s", folder, files->used);
    if (!read_number(root, path, "", &used))
        return most;
    snprintf(path, sizeof path, "%.1200s/memory.stat", folder);
    read_number(root, path, files->dropped, &dropped);
    used -= least(used, dropped);
    return most - least(most, used);
}

typedef struct free_room {
    const char *root;
    uint64_t left;
} free_room;

static void add_group(void *context, const char *folder, int kind)
{
    free_room *room = context;
    room->left = least(room->left, free_in_group(room->root, &version[kind == 1], folder));
}

static uint64_t free_by_groups(const char *root)
{
    free_room room = {root, UINT64_MAX};
    (void)control_group_each(root, "memory", add_group, &room);
    return room.left;
}

uint64_t memory_budget_free(const char *root, uint64_t address_space)
{
    uint64_t available_kib;
    uint64_t left = least(address_space, free_by_groups(root));
    if (read_number(root, "/proc/meminfo", "MemAvailable:", &available_kib))
        left = least(left, available_kib * 1024);
    return left;
}

/* Memory of the process in bytes: all pages (0), or the resident ones (1). */
static uint64_t process_bytes(int which)
{
    unsigned long long pages[2] = {0, 0};
    FILE *file = fopen("/proc/self/statm", "re");
    if (file && fscanf(file, "%llu %llu", &pages[0], &pages[1]) != 2)
        pages[0] = pages[1] = 0;
    if (file)
        fclose(file);
    return (uint64_t)pages[which] * (uint64_t)sysconf(_SC_PAGESIZE);
}

static uint64_t address_space_left(void)
{
    struct rlimit space;
    if (getrlimit(RLIMIT_AS, &space) != 0 || space.rlim_cur == RLIM_INFINITY)
        return UINT64_MAX;
    const uint64_t most = (uint64_t)space.rlim_cur;
    return most - least(most, process_bytes(0));
}

memory_room memory_budget_snapshot(void)
{
    memory_room room = {.known = true};
    room.left = memory_budget_left(&room.chosen);
    return room;
}

void memory_budget_assume(memory_room room)
{
    assumed = room;
}

uint64_t memory_budget_left(bool *chosen)
{
    if (assumed.known) {
        *chosen = assumed.chosen;
        return assumed.left;
    }
    const uint64_t budget = atomic_load(&limit);
    *chosen = budget > 0;
    if (budget > 0)
        return budget - least(budget, process_bytes(1));
    const uint64_t left = memory_budget_free("", address_space_left());
    return left == UINT64_MAX ? left : left / 4 * 3;
}

status memory_budget_check(uint64_t bytes, const char *remedy, diagnostic *why, const char *what, ...)
{
    enum { SMALL = 16 << 20 };
    bool chosen;
    if (bytes < SMALL && atomic_load(&limit) == 0)
        return STATUS_OK;
    const uint64_t left = memory_budget_left(&chosen);
    if (bytes <= left)
        return STATUS_OK;
    char name[256], needed[MEMORY_TEXT_MAX], room[MEMORY_TEXT_MAX], advice[256];
    va_list list;
    va_start(list, what);
    vsnprintf(name, sizeof name, what, list);
    va_end(list);
    memory_text(bytes, needed);
    memory_text(left, room);
    snprintf(advice, sizeof advice, "%s, or %s", remedy, chosen ? "raise --memory-limit" : "set --memory-limit");
    return diagnose(why, STATUS_BAD_INPUT, advice, "%s needs about %s of memory, more than the %s that %s", name,
                    needed, room, chosen ? "--memory-limit leaves" : "are three quarters of what is free");
}

/* ---- sizes of memory as text ---- */

static const char letters[] = "KMGT";

char *memory_text(uint64_t bytes, char text[MEMORY_TEXT_MAX])
{
    double size = (double)bytes;
    int unit = -1;
    while (size >= 1000.0 && unit < 3) { /* three digits at most: 1000 KiB are 0.977 MiB */
        size /= 1024.0;
        unit++;
    }
    if (unit < 0)
        snprintf(text, MEMORY_TEXT_MAX, "%.0f bytes", size);
    else
        snprintf(text, MEMORY_TEXT_MAX, "%.3g %ciB", size, letters[unit]);
    return text;
}

bool memory_parse(const char *text, uint64_t *bytes)
{
    char digits[NUMBER_TEXT_MAX];
    double number, unit = 1.0;
    const size_t length = strspn(text, "0123456789.");
    const char *rest = text + length;
    if (length == 0 || length >= sizeof digits)
        return false;
    memcpy(digits, text, length);
    digits[length] = 0;
    if (*rest) {
        const char *letter = strchr(letters, *rest >= 'a' ? *rest - 32 : *rest);
        if (!letter || !(rest[1] == 0 || strcasecmp(rest + 1, "b") == 0 || strcasecmp(rest + 1, "ib") == 0))
            return false;
        for (int i = 0; i <= letter - letters; i++)
            unit *= 1024.0;
    }
    if (!number_parse_real(digits, &number) || !(number * unit >= 1.0 && number * unit < 0x1p63))
        return false;
    *bytes = (uint64_t)(number * unit);
    return true;
}

/* ---- disk space ---- */

enum { BLOCK_BYTES = 4096 };

void disk_room_add(disk_room *to, double count, double least_bytes, double most_bytes)
{
    to->least_bytes += count * least_bytes;
    to->most_bytes += count * (ceil(most_bytes / BLOCK_BYTES) * BLOCK_BYTES);
}

/* Shortens the path to its parent folder; false if there is none. */
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
    char folder[PATH_MAX]; /* the longest path that the kernel accepts */
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
