/* The groups of /proc/self/cgroup, and the limits in their folders. */
#include "base/os_process.h"
#include <errno.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { PATH_SIZE = 1200 };

/* Returns an error that may be temporary; 0 for others, such as a missing or unreadable file. */
static int temporary_error(int error)
{
    return error == EMFILE || error == ENFILE || error == ENOMEM || error == EIO || error == EINTR ? error : 0;
}

/* Whether a word is in a list separated by commas. */
static bool has_word(const char *list, const char *word)
{
    const size_t length = strlen(word);
    for (const char *at = list; (at = strstr(at, word)) != NULL; at += length)
        if ((at == list || at[-1] == ',') && (at[length] == 0 || at[length] == ','))
            return true;
    return false;
}

/* Visits the group and the groups that contain it, up to the root of the tree; cuts `group` at its slashes. In a
 * container the tree begins at the container's group, and the outer folders do not exist. */
static void visit_with_ancestors(const char *tree, char *group, int version, control_group_visit *visit, void *context)
{
    for (;;) {
        char folder[PATH_SIZE];
        const size_t length = strlen(group);
        if (length == 0 || group[length - 1] != '/') {
            snprintf(folder, sizeof folder, "%s%s", tree, group);
            visit(context, folder, version);
        }
        char *slash = strrchr(group, '/');
        if (!slash)
            return;
        *slash = 0;
    }
}

int control_group_each(const char *root, const char *controller, control_group_visit *visit, void *context)
{
    char path[PATH_SIZE], line[1000], tree[64];
    snprintf(path, sizeof path, "%.200s/proc/self/cgroup", root);
    FILE *file = fopen(path, "re");
    if (!file) {
        const int error = temporary_error(errno);
        snprintf(tree, sizeof tree, "/sys/fs/cgroup/%s", controller);
        visit(context, "/sys/fs/cgroup", 2);
        visit(context, tree, 1);
        return error;
    }
    /* version 2 writes "0::/path", version 1 "5:cpu,cpuacct:/path" */
    while (fgets(line, sizeof line, file)) {
        char *controllers = strchr(line, ':'), *group = controllers ? strchr(controllers + 1, ':') : NULL;
        if (!group)
            continue;
        *group++ = 0;
        group[strcspn(group, "\n")] = 0;
        if (controllers[1] == 0) {
            visit_with_ancestors("/sys/fs/cgroup", group, 2, visit, context);
        } else if (has_word(controllers + 1, controller)) {
            snprintf(tree, sizeof tree, "/sys/fs/cgroup/%s", controller);
            visit_with_ancestors(tree, group, 1, visit, context);
        }
    }
    const int error = ferror(file) ? temporary_error(errno) : 0;
    fclose(file);
    return error;
}

typedef struct reader {
    const char *root;
    control_group_limits *limits;
    int error;
} reader;

static bool read_text(reader *r, const char *folder, const char *name, char *text, size_t size)
{
    char path[PATH_SIZE + 300];
    snprintf(path, sizeof path, "%.200s%s/%s", r->root, folder, name);
    FILE *file = fopen(path, "re");
    if (!file) {
        r->error = r->error ? r->error : temporary_error(errno);
        return false;
    }
    const bool found = fgets(text, (int)size, file) != NULL;
    if (ferror(file) && !r->error)
        r->error = temporary_error(errno);
    fclose(file);
    return found;
}

static void add_cpu(void *context, const char *folder, int version)
{
    reader *r = context;
    char text[64], period_text[64] = "";
    long long quota = 0, period = 0;
    if (version == 2 && read_text(r, folder, "cpu.max", text, sizeof text)) {
        char *end;
        quota = strtoll(text, &end, 10); /* "max 100000" reads as 0 */
        period = strtoll(end, NULL, 10);
    } else if (version == 1 && read_text(r, folder, "cpu.cfs_quota_us", text, sizeof text) &&
               read_text(r, folder, "cpu.cfs_period_us", period_text, sizeof period_text)) {
        quota = strtoll(text, NULL, 10); /* -1: none */
        period = strtoll(period_text, NULL, 10);
    }
    const control_group_limits *tightest = r->limits;
    if (quota > 0 && period > 0 &&
        (!tightest->quota_us ||
         (double)quota / (double)period < (double)tightest->quota_us / (double)tightest->period_us)) {
        r->limits->quota_us = quota;
        r->limits->period_us = period;
    }
}

static void add_memory(void *context, const char *folder, int version)
{
    /* without a limit, version 1 shows the largest multiple of a page that fits into a signed number */
    const uint64_t none = (uint64_t)1 << 62;
    reader *r = context;
    char text[64];
    if (!read_text(r, folder, version == 2 ? "memory.max" : "memory.limit_in_bytes", text, sizeof text))
        return;
    const uint64_t bytes = text[0] >= '0' && text[0] <= '9' ? strtoull(text, NULL, 10) : UINT64_MAX;
    if (bytes < none && bytes < r->limits->memory_bytes)
        r->limits->memory_bytes = bytes;
}

int control_group_read(const char *root, control_group_limits *out)
{
    reader r = {.root = root, .limits = out};
    *out = (control_group_limits){.memory_bytes = UINT64_MAX};
    const int cpu = control_group_each(root, "cpu", add_cpu, &r);
    const int memory = control_group_each(root, "memory", add_memory, &r);
    return r.error ? r.error : cpu ? cpu : memory;
}
