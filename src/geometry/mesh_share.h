/* The shared state of a mesh's owners: their count, and the hierarchies built for the mesh. mesh.c creates it (all zero
 * but owners and the mutex) and, at the last release, calls `destroy` on each hierarchy before it frees the mesh;
 * hierarchy.c builds under the mutex and stores finished hierarchies. owners and hierarchies are accessed only with the
 * compiler's __atomic operations; destroy is set under the mutex before the first hierarchy is stored. */
#pragma once

#include "geometry/hierarchy.h"
#include <pthread.h>

/* Whether triangles use all vertices of a mesh; mesh_move computes it once. */
enum mesh_used { MESH_USED_UNKNOWN, MESH_USED_ALL, MESH_USED_SOME };

struct mesh_share {
    long owners;
    enum mesh_used used;                          /* read and written only by the owner that moves the mesh */
    pthread_mutex_t mutex;                        /* held while a hierarchy is built, so that each is built only once */
    hierarchy *hierarchies[HIERARCHY_KIND_COUNT]; /* NULL until first used */
    void (*destroy)(hierarchy *h);                /* NULL while there is no hierarchy */
};
