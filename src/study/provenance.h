/* Facts about the machine and the program that a manifest names. Fresh memory, release with free; NULL when a fact
 * is not to be had. Never fails otherwise. */
#pragma once

#include <stdbool.h>
#include <stddef.h>

/* "model name" of /proc/cpuinfo. */
char *provenance_cpu_model(void);
/* "Linux 6.1.0 x86_64". */
char *provenance_kernel(void);
/* Frequency governor of the first processing unit, "performance". */
char *provenance_governor(void);
/* The units that the process may use, "0-3,8". */
char *provenance_binding(void);
/* The commit checked out where folder lies, 40 hex digits; *dirty: tracked files differ from it. Quiet without git. */
char *provenance_git_commit(const char *folder, bool *dirty);
/* hwloc's XML without what tells one machine from another of its kind: host name, serial numbers, addresses,
 * control groups. Changes xml in place; NULL is allowed. */
void provenance_anonymize(char *xml);
