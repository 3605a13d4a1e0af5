/* What a topology holds. Inside this room. */
#pragma once

#include "measure/topology.h"

#include <hwloc.h>

struct topology {
    hwloc_topology_t tree; /* only the units that this process may use */
    int installed;         /* units of the whole machine, usable or not */
    int rounds;            /* the most units that one core has */
    /* round[r]: the tree with the r-th unit of every core that has so many, and nothing else */
    hwloc_topology_t *round;
};
