/* Texture coordinates on surfaces: u to the right and v up as seen from outside, in units of the texture image;
 * per_length is the number of repetitions of the texture per scene unit, in the direction where they are closer. size
 * is the extent of the texture image in scene units; 0 scales one image to a face. Pure; cannot fail. */
#pragma once

#include "base/elementary.h"

typedef struct surface_mapping {
    double u, v, per_length;
} surface_mapping;

/* Flat faces: along two local axes, from the face's lower left corner as seen from outside. */
static inline surface_mapping mapping_flat(double x, double y, double width, double height, double size)
{
    const double across = size > 0.0 ? size : width, up = size > 0.0 ? size : height;
    return (surface_mapping){x / across, y / up, 1.0 / (across < up ? across : up)};
}

/* Around the axis, by the angle (one image) or by arc length: to the right as seen from outside, the middle of the
 * image in front, at -z, as on the solids of geometry/mesh_generators.h. */
static inline surface_mapping mapping_around(double x, double z, double radius, double v, double height, double size)
{
    const double turn = 0.5 + elementary_atan2_deg(x, -z) / 360.0, arc = 6.283185307179586 * radius;
    return mapping_flat(turn * arc, v, arc, height, size);
}
