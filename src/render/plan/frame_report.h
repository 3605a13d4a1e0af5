/* Plain values that a frame reports: its meshes, and a caustic with too few photons. */
#pragma once

#include <stdint.h>

/* The mesh statistics of a frame: sizes of meshes, and time and memory of their hierarchies. A hierarchy is counted
 * once per mesh, whatever the number of instances. */
typedef struct mesh_report {
    uint64_t triangles, instances; /* instances: copies of meshes; triangles: in all instances */
    uint64_t bytes;                /* of hierarchies */
    double build_s;                /* wall time of building them, for this frame or earlier */
    uint64_t motion_steps;         /* simulation steps of slimes up to the rendered times, including substeps */
    double motion_s;               /* wall time of these steps, when the scene was loaded */
    /* only in a rasterised frame: triangles in the image, including those of analytic solids, and memory of the depth
     * buffer */
    uint64_t drawn, raster_bytes;
} mesh_report;

/* The solid with the fewest photons, if they are too few for its caustic. */
typedef struct photon_shortage {
    int solid;       /* its number in the scene; -1: every solid has enough */
    int64_t arrived; /* photons that it deflected to matte surfaces */
    int64_t enough;  /* the value of render.photons that suffices */
} photon_shortage;
