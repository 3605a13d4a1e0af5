/* The content of a topology. Private to src/measure. */
#pragma once

#include "measure/topology.h"

#include <hwloc.h>

struct topology {
    hwloc_topology_t tree; /* restricted to the units that this process may use */
    int installed;         /* units of the whole machine, usable or not */
    int rounds;            /* largest number of units of a core */
    /* round[r]: the tree restricted to the r-th unit of every core that has more than r units */
    hwloc_topology_t *round;
};
