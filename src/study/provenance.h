/* Facts about the machine and the program for the list of runs. Fresh memory, release with free; NULL if a fact is not
 * available. Cannot fail otherwise. */
#pragma once

#include <stdbool.h>
#include <stddef.h>

/* "model name" of /proc/cpuinfo; the name of the board on ARM, which has none. */
char *provenance_cpu_model(void);
/* "Linux 6.1.0 x86_64". */
char *provenance_kernel(void);
/* The named line of /proc/cpuinfo, of the first processing unit. */
char *provenance_cpu_field(const char *name);
/* The processing units available to the process, "0-3,8". */
char *provenance_binding(void);
/* The commit checked out in folder, 40 hex digits; *dirty: tracked files differ from it. Silent without git. */
char *provenance_git_commit(const char *folder, bool *dirty);
/* Removes from hwloc's XML everything that distinguishes machines of the same kind: host name, serial numbers,
 * addresses, control groups. Changes xml in place; NULL is allowed. */
void provenance_anonymize(char *xml);
