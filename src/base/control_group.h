/* The control groups of this process (cgroups(7)), such as a slice of systemd: the innermost group and all groups that
 * contain it, because their limits apply as well. Version 2 has one tree, version 1 one tree per controller. Files are
 * read below `root`, "" for this machine, so that a test can use recorded files. A group without files limits nothing.
 * Without /proc/self/cgroup the roots of the trees are used. */
#pragma once

#include <stdint.h>

/* folder: the group's folder below root, such as "/sys/fs/cgroup/user.slice"; version: 1 or 2. */
typedef void control_group_visit(void *context, const char *folder, int version);

/* Calls visit for each group that the process is in for a controller ("cpu", "memory"), the innermost of a tree first.
 * Returns 0, or an errno if the list of groups exists but cannot be read now. */
int control_group_each(const char *root, const char *controller, control_group_visit *visit, void *context);

/* The tightest limits of all groups. */
typedef struct control_group_limits {
    long long quota_us, period_us; /* CPU time per period; 0: no limit */
    uint64_t memory_bytes;         /* UINT64_MAX: no limit */
} control_group_limits;

/* Returns 0, or an errno if the list of groups or a file with a limit exists but cannot be read now. */
int control_group_read(const char *root, control_group_limits *out);
