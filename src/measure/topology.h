/* The machine's processors and where threads are put on them, through hwloc. A topology belongs to who
 * created it, and threads may read it together. The process's own CPU binding (taskset, cgroup), as it is when the
 * topology is created, is respected: only those units are used. */
#pragma once

#include "base/status.h"

typedef enum pin_policy { PIN_NONE, PIN_COMPACT, PIN_SCATTER } pin_policy;

typedef struct topology topology;

/* This machine; or one described by an hwloc synthetic string such as "pack:2 core:4 pu:2", for tests
 * of placement on any laptop. */
status topology_create(topology **out, diagnostic *why);
status topology_from_synthetic(const char *description, topology **out, diagnostic *why);
void topology_destroy(topology *machine);

/* Leaves only those units, named by OS index in a list such as "0-3,8", as if the process were bound to them.
 * STATUS_BAD_INPUT, and nothing changed, when none of them is there. */
status topology_restrict(topology *machine, const char *units, diagnostic *why);

/* Processing units that this process may use, and cores and packages they lie on. At least 1. */
int topology_pu_count(const topology *machine);
int topology_core_count(const topology *machine);
int topology_package_count(const topology *machine);

/* The OS index of the processing unit for worker 0 <= i < count, or -1 for PIN_NONE. compact: neighbours in
 * the tree, threads of one core first; scatter: as far apart as can be (hwloc_distrib order), every core once
 * before any core twice. More workers than units wrap around. */
int topology_place(const topology *machine, pin_policy policy, int worker, int count);

/* Binds the calling thread to one processing unit; -1 gives it back the whole of the process's own set. On a machine
 * that is only described, nothing happens. STATUS_BAD_INPUT for a unit that is not there. */
status topology_bind_thread(const topology *machine, int pu, diagnostic *why);

/* The OS index of the unit that the calling thread runs on now; -1 if unknown. */
int topology_current_pu(void);

/* A one-line summary ("1 package, 2 cores, 2 threads, L2 1024 KiB ..."), and the whole tree as hwloc XML
 * (without host name and serial numbers). Fresh memory, release with free; NULL when there is none. */
char *topology_summary(const topology *machine);
char *topology_xml(const topology *machine);
