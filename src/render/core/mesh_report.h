/* The mesh statistics of a frame: sizes of meshes, and time and memory of their hierarchies. A plain value. */
#pragma once

#include <stdint.h>

/* A hierarchy is counted once per mesh, whatever the number of instances. */
typedef struct mesh_report {
    uint64_t triangles, instances; /* instances: copies of meshes; triangles: in all instances */
    uint64_t bytes;                /* of hierarchies */
    double build_s;                /* wall time of their builds, for this frame or before it */
    uint64_t motion_steps;         /* of slimes, from their initial states to the rendered times, substeps included */
    double motion_s;               /* wall time of these steps, when the scene was loaded */
    /* of a rasterised frame: triangles in the image, including those of analytic solids, and memory of the depth
     * buffer */
    uint64_t drawn, raster_bytes;
} mesh_report;
