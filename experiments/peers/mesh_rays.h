/* The rays of the mesh benches, the same for Cuvette (bench_mesh.c) and for Embree (embree.c): a camera of 800 x
 * 600 pixels in front of the sets of triangles, and a shadow ray to a point light from each hit. Single precision, so
 * that both start from the same bits. Pure functions; cannot fail. */
#pragma once

#include <math.h>

enum { MESH_RAYS_COLUMNS = 800, MESH_RAYS_ROWS = 600 };
enum {
    MESH_RAYS_TILE_COLUMNS = 16,
    MESH_RAYS_TILE_ROWS = 8
}; /* the order in which pixels are visited; the frame is whole tiles */

/* The camera looks along +z; y up, x to the right. A shadow ray is the segment from the hit to the light; its range is
 * `shadow_near` to 1 of the segment's length. */
static const float mesh_rays_eye[3] = {0.0f, 0.0f, -3.0f}, mesh_rays_light[3] = {2.0f, 3.0f, -4.0f},
                   mesh_rays_shadow_near = 1e-3f;

/* The unit vector through the centre of pixel x, y (0, 0: upper left); 45 degrees from the lower to the upper edge. */
static inline void mesh_rays_direction(int x, int y, float out[3])
{
    const float s = (float)0.41421356237309503; /* tan(22.5 degrees) */
    const float aspect = (float)MESH_RAYS_COLUMNS / (float)MESH_RAYS_ROWS;
    const float right = (((float)x + 0.5f) / (float)MESH_RAYS_COLUMNS * 2.0f - 1.0f) * s * aspect;
    const float up = (1.0f - ((float)y + 0.5f) / (float)MESH_RAYS_ROWS * 2.0f) * s;
    const float scale = 1.0f / sqrtf(right * right + up * up + 1.0f);
    out[0] = right * scale;
    out[1] = up * scale;
    out[2] = scale;
}
