/* Texture coordinates on surfaces: u to the right and v up as seen from outside, in pictures; per_length is how many of
 * the nearer repeated ones lie on a scene unit. size is what a picture covers, in scene units; 0 spreads one picture
 * over a face. Pure; cannot fail. */
#pragma once

#include "base/elementary.h"

typedef struct surface_mapping {
    double u, v, per_length;
} surface_mapping;

/* Flat faces: along two of the local axes, from the face's lower left corner seen from outside. */
static inline surface_mapping mapping_flat(double x, double y, double width, double height, double size)
{
    const double across = size > 0.0 ? size : width, up = size > 0.0 ? size : height;
    return (surface_mapping){x / across, y / up, 1.0 / (across < up ? across : up)};
}

/* Around the axis by the angle, with one picture, or as the length of the arc: to the right as seen from outside, the
 * picture's middle in front, at -z, as on the bodies of geometry/mesh_generators.h. */
static inline surface_mapping mapping_around(double x, double z, double radius, double v, double height, double size)
{
    const double turn = 0.5 + elementary_atan2_deg(x, -z) / 360.0, arc = 6.283185307179586 * radius;
    return mapping_flat(turn * arc, v, arc, height, size);
}
