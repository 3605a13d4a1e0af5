#include "scene/assets/mesh_make.h"

#include "base/cancel.h"
#include "base/random.h"
#include "geometry/mesh/mesh_generators.h"
#include "scene/model/face_materials.h"
#include "scene/assets/mesh_file.h"
#include <stdlib.h>

/* Value noise: random values at the points of a grid of `cells` cells per edge, interpolated with the fade curve 6 s^5
 * - 15 s^4 + 10 s^3 (Perlin, "Improving noise", SIGGRAPH 2002). x and z in cells. Result 0 to 1. */
static double noise(int64_t seed, uint32_t octave, double x, double z)
{
    const double cx = floor(x), cz = floor(z), s = x - cx, r = z - cz;
    double corner[2][2];
    for (int k = 0; k < 4; k++) {
        const uint32_t across = (uint32_t)(int64_t)cx + (uint32_t)(k & 1),
                       down = (uint32_t)(int64_t)cz + (uint32_t)(k >> 1);
        corner[k >> 1][k & 1] = random_unit(random_at((uint64_t)seed, across, down, octave, 0).word[0]);
    }
    const double u = s * s * s * (s * (s * 6.0 - 15.0) + 10.0), v = r * r * r * (r * (r * 6.0 - 15.0) + 10.0);
    const double low = corner[0][0] + u * (corner[0][1] - corner[0][0]),
                 high = corner[1][0] + u * (corner[1][1] - corner[1][0]);
    return low + v * (high - low);
}

/* Hills: five octaves of noise, each with half the amplitude and twice the frequency of the one before. */
static status make_terrain(const mesh_entry *m, mesh **out, diagnostic *why)
{
    enum { OCTAVES = 5, CELLS = 4 };
    const int columns = (int)m->around + 1, rows = (int)m->tube + 1;
    double *heights = malloc((size_t)columns * (size_t)rows * sizeof *heights);
    if (!heights)
        return out_of_memory(why);
    for (int row = 0; row < rows && !cancel_asked(); row++) {
        for (int column = 0; column < columns; column++) {
            double sum = 0.0, weight = 0.5, fine = CELLS;
            for (uint32_t k = 0; k < OCTAVES; k++, weight *= 0.5, fine *= 2.0)
                sum += weight * noise(m->seed, k, fine * column / (columns - 1), fine * row / (rows - 1));
            heights[(size_t)row * (size_t)columns + (size_t)column] = m->size.y * sum;
        }
    }
    status code = cancel_check(why);
    THEN(code, generate_height_field(heights, columns, rows, m->size.x, m->size.z, m->depth, out, why));
    free(heights);
    return code;
}

static status make_lathe(const mesh_entry *m, mesh **out, diagnostic *why)
{
    profile_point profile[NUMBER_LIST_MAX / 2];
    const size_t count = (size_t)m->profile.count / 2;
    for (size_t i = 0; i < count; i++)
        profile[i] = (profile_point){m->profile.value[2 * i], m->profile.value[2 * i + 1]};
    return generate_lathe(profile, count, (int)m->around, m->crease_deg, out, why);
}

static status make(const mesh_entry *m, mesh **out, diagnostic *why)
{
    switch ((mesh_maker)m->source) {
    case MESH_SPARSE: return generate_sparse_soup((size_t)m->count, out, why);
    case MESH_DENSE: return generate_dense_soup((size_t)m->count, out, why);
    case MESH_SPHERE: return generate_sphere((size_t)m->count, out, why);
    case MESH_ICOSPHERE: return generate_icosphere((int)m->level, out, why);
    case MESH_TORUS: return generate_torus(m->major, m->minor, (int)m->around, (int)m->tube, out, why);
    case MESH_LATHE: return make_lathe(m, out, why);
    case MESH_TERRAIN: return make_terrain(m, out, why);
    case MESH_BOX: return generate_box(m->size, out, why);
    case MESH_FILE:
    case MESH_SLIME:
    case MESH_ARRAYS: break;
    }
    return diagnose(why, STATUS_BAD_INPUT, "set its triangles, or another source", "%.80s has no triangles", m->name);
}

/* As the generators count; 0 for those that are small anyway. A solid terrain has a few more. */
static void size_of(const mesh_entry *m, size_t *vertices, size_t *triangles)
{
    const size_t count = (size_t)m->count, around = (size_t)m->around, tube = (size_t)m->tube;
    size_t f = 0; /* triangles along an edge of the icosahedron */
    *vertices = *triangles = 0;
    switch ((mesh_maker)m->source) {
    case MESH_SPARSE:
    case MESH_DENSE: *vertices = 3 * count, *triangles = count; return;
    case MESH_SPHERE: f = (size_t)floor(sqrt((double)count / 20.0) + 0.5); break;
    case MESH_ICOSPHERE: f = (size_t)1 << m->level; break;
    case MESH_TORUS:
    case MESH_TERRAIN: *vertices = (around + 1) * (tube + 1), *triangles = 2 * around * tube; return;
    case MESH_LATHE: /* small */
    case MESH_BOX:
    case MESH_FILE:
    case MESH_SLIME:
    case MESH_ARRAYS: return;
    }
    *vertices = 10 * (f + 1) * (f + 2);
    *triangles = 20 * f * f;
}

size_t mesh_make_triangles(const mesh_entry *m)
{
    size_t vertices, triangles;
    size_of(m, &vertices, &triangles);
    return triangles;
}

status mesh_make(mesh_entry *m, diagnostic *why)
{
    mesh *made = NULL;
    size_t vertices, triangles;
    size_of(m, &vertices, &triangles);
    const bool smooth = m->source != MESH_SPARSE && m->source != MESH_DENSE;
    TRY(mesh_check_size(vertices, triangles, smooth, smooth, false, why));
    const status code = make(m, &made, why);
    m->data = made;
    return code;
}

status mesh_make_from_file(mesh_entry *m, const char *path, const load_limits *limits, diagnostic *why)
{
    const mesh_limits own = {.root = limits->root, .triangles = limits->triangles};
    mesh_import *imported;
    TRY(mesh_read_file(path, &own, &imported, why));
    status code = face_materials_create(imported, limits->root, &m->shading_materials, why);
    if (code == STATUS_OK) {
        m->data = imported->mesh;
        mesh_retain(m->data);
    }
    mesh_import_destroy(imported);
    return code;
}
