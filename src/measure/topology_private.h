/* The content of a topology. Private to src/measure and wasm/host.c. hwloc runs in a child process, which sends this
 * content as text (topology_discover.c), because hwloc 2.9 aborts at some failed allocations. */
#pragma once

#include "measure/topology.h"
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

/* An object of the tree. The nodes of a tree are in preorder, the machine first. */
typedef struct topology_node {
    int depth; /* 0: the machine */
    char kind; /* 'u' processing unit, 'c' core, 'p' package, 'o' any other */
    int unit;  /* of a processing unit: its OS index; otherwise -1 */
    int round; /* of a processing unit: its number within its core, from 0 */
    int end;   /* the index behind its subtree */
} topology_node;

enum { TOPOLOGY_CACHES = 3 };

struct topology {
    topology_node *nodes; /* each with at least one processing unit; only units that this process may use */
    int count;
    int installed;                  /* units of the machine, usable or not */
    bool described;                 /* by a synthetic description: binding a thread has no effect */
    bool assumed;                   /* hwloc failed: every unit counts as a core */
    int64_t cache[TOPOLOGY_CACHES]; /* bytes of the first L1d, L2 and L3; 0: unknown */
    int64_t memory;                 /* bytes; 0: unknown */
    char model[128];                /* of the processor; "": unknown */
    char *xml;                      /* of hwloc; NULL if assumed */
};

/* hwloc's description of this machine, or of a synthetic one, restricted to the units that this process may use, as
 * text. Returns the exit status of the child process: 0; STATUS_BAD_INPUT for an invalid synthetic description;
 * otherwise STATUS_FAILURE. After a failure the text may be incomplete. Only the child calls hwloc. */
int topology_discover(const char *synthetic, FILE *out);

/* The output of topology_discover in a child process; NULL, with a status, if that failed. *no_memory: memory ran out
 * in this process, not in the child. The caller frees the text. */
char *topology_discover_in_child(const char *synthetic, status *code, bool *no_memory);
