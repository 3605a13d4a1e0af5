/* Plain values that a frame reports: its meshes, and a caustic that rests on too few photons. */
#pragma once

#include <stdint.h>

/* The mesh statistics of a frame: sizes of meshes, and time and memory of their hierarchies. A hierarchy is counted
 * once per mesh, whatever the number of instances. */
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

/* The solid whose light rests on the fewest photons, if these are too few for a caustic. */
typedef struct caustics_few {
    int solid;       /* its number in the scene, -1: there is none */
    int64_t arrived; /* its photons */
    int64_t enough;  /* the render.photons that would do */
} caustics_few;
