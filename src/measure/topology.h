/* The topology of the machine: its processors and the placement of threads on them. hwloc finds it, in a child process,
 * so that a crash of hwloc does no harm: then each processing unit counts as a core, and the summary says so. The
 * creator owns a topology; several threads may read it. The process's own CPU binding (taskset, cgroup) at the time of
 * creation is respected: only those units are used. */
#pragma once

#include "base/status.h"

typedef enum pin_policy { PIN_NONE, PIN_COMPACT, PIN_SCATTER } pin_policy;

typedef struct topology topology;

/* Creates the topology of this machine, or of one described by an hwloc synthetic string such as "pack:2 core:4 pu:2",
 * for tests of thread placement on any machine. */
status topology_create(topology **out, diagnostic *why);
status topology_from_synthetic(const char *description, topology **out, diagnostic *why);
void topology_destroy(topology *machine);

/* Restricts the topology to units given by OS index in a list such as "0-3,8", as if the process were bound to them.
 * STATUS_BAD_INPUT, and no change, when none of them exists. */
status topology_restrict(topology *machine, const char *units, diagnostic *why);

/* The number of processing units that this process may use, and of their cores and packages. At least 1. */
int topology_pu_count(const topology *machine);
int topology_core_count(const topology *machine);
int topology_package_count(const topology *machine);

/* The OS index of the processing unit for worker 0 <= i < count, or -1 for PIN_NONE. compact: neighbours in the tree,
 * threads of one core first; scatter: as far apart as possible (hwloc_distrib order), every core once before any core
 * twice. More workers than units wrap around. */
int topology_place(const topology *machine, pin_policy policy, int worker, int count);

/* Binds the calling thread to one processing unit; -1 restores all units of the process. Has no effect for a synthetic
 * topology. STATUS_BAD_INPUT for a unit that the process may not use; STATUS_FAILURE if the system refuses. */
status topology_bind_thread(const topology *machine, int pu, diagnostic *why);

/* The OS index of the current unit of the calling thread; -1 if unknown. */
int topology_current_pu(void);

/* A one-line summary ("1 package, 2 cores, 2 threads, L2 1024 KiB ..."), and the tree as hwloc XML as it was created
 * (without host name and serial numbers; "" if hwloc failed). The caller frees the text; NULL on failure. */
char *topology_summary(const topology *machine);
char *topology_xml(const topology *machine);
