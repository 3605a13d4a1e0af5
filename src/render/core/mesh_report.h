/* What the meshes of a frame are, and what their hierarchies took. A plain value. */
#pragma once

#include <stdint.h>

/* Hierarchies count once a mesh, however often it stands there. */
typedef struct mesh_report {
    uint64_t triangles, instances; /* instances: copies of meshes; triangles: of all of them as they stand there */
    uint64_t bytes;                /* of hierarchies */
    double build_s;                /* wall time of their builds, whether for this frame or before */
    uint64_t motion_steps; /* of slimes, from their beginnings to the moments that are shown; substeps counted */
    double motion_s;       /* wall time of these, when the scene was loaded */
    uint64_t drawn,
        raster_bytes; /* of a frame that is drawn: triangles in the picture, analytic solids' too, and memory
                                    of the depth buffer */
} mesh_report;
