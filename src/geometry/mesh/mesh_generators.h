/* Generators of meshes: the three triangle sets of the speed studies, and parametric solids. Each mesh is in its own
 * frame about the origin, y up. Ownership: the caller becomes the mesh's only owner. STATUS_BAD_INPUT for numbers out
 * of range (the remedy gives the valid range) or more memory than the budget allows, STATUS_FAILURE if memory runs out,
 * STATUS_INTERRUPTED when cancelled. Only + - * / and sqrt, and elementary.h: identical bits on every platform. */
#pragma once

#include "geometry/mesh/mesh.h"

/* Random triangles in the cube [-1, 1]^3: sparse ones whose size decreases with their number (edge a quarter of the
 * spacing 2 / cbrt(count)), dense ones of the fixed size 1/2. A triangle's centre c = 2 u - 1 is drawn first, then its
 * corners c + size (u - 1/2), each coordinate rounded once to a float; u = the upper 24 bits of splitmix64 times 2^-24,
 * from the seed 20240101. count: 1..MESH_TRIANGLES_MAX. */
status generate_sparse_soup(size_t count, mesh **out, diagnostic *why);
status generate_dense_soup(size_t count, mesh **out, diagnostic *why);

/* An icosahedron whose faces are split into f x f, on the unit sphere; 20 f f triangles, f = round(sqrt(count / 20)),
 * at least 1. Single precision. Each of the 20 faces has its own vertices, so that texture coordinates (longitude and
 * latitude) may be discontinuous; shared edges have equal positions. Normals are the positions. */
status generate_sphere(size_t count, mesh **out, diagnostic *why);

/* Icosahedron refined by bisection of its edges `level` times, 20 * 4^level triangles, on the unit sphere; doubles.
 * Vertices as in generate_sphere. A level of 12 would exceed MESH_TRIANGLES_MAX. */
enum { ICOSPHERE_LEVEL_MAX = 11 };
status generate_icosphere(int level, mesh **out, diagnostic *why);

/* Torus about y. major: distance of the tube's centre from the axis; minor: the tube's radius; segments around the axis
 * and around the tube, at least 3. */
status generate_torus(double major, double minor, int around, int tube, mesh **out, diagnostic *why);

/* A surface of revolution: a profile of points (radius >= 0, height) rotated about the y axis in `around` >= 3
 * segments. Closed if the profile begins and ends on the axis (radius 0), or ends where it began. The surface has
 * a sharp edge (two normals) where the profile turns by more than crease_deg, 0..180. */
typedef struct profile_point {
    double radius, height;
} profile_point;
status generate_lathe(const profile_point *profile, size_t count, int around, double crease_deg, mesh **out,
                      diagnostic *why);

/* A height field: heights[row * columns + column], columns along x and rows along z from -size/2 to size/2, y = height;
 * with a depth > 0 it is closed by sides and a flat bottom at y = -depth. At least 2 x 2. */
status generate_height_field(const double *heights, int columns, int rows, double size_x, double size_z, double depth,
                             mesh **out, diagnostic *why);

/* A box with edges `size` about the origin: 12 triangles, flat normals, the whole texture on each face. */
status generate_box(vec3 size, mesh **out, diagnostic *why);
