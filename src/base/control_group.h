/* The control groups of this process (cgroups(7)): the innermost and those that contain it, whose limits hold as well;
 * a slice of systemd is one. Version 2 has one tree, version 1 one for each controller. Files are read below a root, ""
 * for this machine, so that a test can use recorded files. Nothing is owned; a group without files limits nothing.
 * Without /proc/self/cgroup the roots of the trees are used. */
#pragma once

#include <stdint.h>

/* folder: that of a group, below root, such as "/sys/fs/cgroup/user.slice"; version: 1 or 2. */
typedef void control_group_visit(void *context, const char *folder, int version);

/* Calls visit for each group that the process is in for a controller ("cpu", "memory"), the innermost of a tree first.
 * Returns 0, or the errno of a list of groups that exists and cannot be read now. */
int control_group_each(const char *root, const char *controller, control_group_visit *visit, void *context);

/* The tightest limits of all groups. */
typedef struct control_group_limits {
    long long quota_us, period_us; /* CPU time for each period; 0: none */
    uint64_t memory_bytes;         /* UINT64_MAX: none */
} control_group_limits;

/* Returns as control_group_each, also for the files of the limits. */
int control_group_read(const char *root, control_group_limits *out);
