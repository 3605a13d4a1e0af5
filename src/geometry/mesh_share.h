/* What a mesh's owners share beside its arrays: their number, and the hierarchies that have been built for it. For
 * mesh.c, which makes it (all zero but owners and the mutex) and at the last release calls `destroy` on each hierarchy
 * before it frees the mesh; and for hierarchy.c, which builds under the mutex and stores finished ones. owners and
 * hierarchies are read and written with the compiler's
 * __atomic operations alone; destroy is set under the mutex before the first hierarchy is stored. */
#pragma once

#include "geometry/hierarchy.h"
#include <pthread.h>

/* Do triangles use all vertices of a mesh? For mesh_move, who asks once. */
enum mesh_used { MESH_USED_UNKNOWN, MESH_USED_ALL, MESH_USED_SOME };

struct mesh_share {
    long owners;
    enum mesh_used used;                          /* the one owner who may move the mesh reads and writes it */
    pthread_mutex_t mutex;                        /* held while a hierarchy is built, so that each is built once */
    hierarchy *hierarchies[HIERARCHY_KIND_COUNT]; /* NULL until first used */
    void (*destroy)(hierarchy *h);                /* NULL as long as there is none */
};
