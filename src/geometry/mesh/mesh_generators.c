/* Mesh generators: common code, the box, the torus and the height field. */
#include "geometry/mesh/mesh_generators.h"
#include "base/cancel.h"
#include "base/elementary.h"
#include "geometry/mesh/mesh_private.h"

status generate_finish(mesh *m, bool must_be_closed, mesh **out, diagnostic *why)
{
    status result = cancel_check(why);
    THEN(result, mesh_finish(m, why));
    if (result == STATUS_OK && must_be_closed && (!m->closed || m->crowded))
        result = diagnose(why, STATUS_BAD_INPUT, "use lengths of similar size, or fewer segments",
                          "the generated mesh has edges too short for its size");
    if (result == STATUS_OK)
        *out = m;
    else
        mesh_release(m);
    return result;
}

bool generate_is_length(double x)
{
    return x > 0.0 && x <= MESH_FAR;
}

double generate_longitude_deg(vec3 p)
{
    return elementary_atan2_deg(p.x, -p.z);
}

double generate_latitude_v(vec3 p)
{
    return 0.5 + elementary_atan2_deg(p.y, sqrt(p.x * p.x + p.z * p.z)) / 180.0;
}

vec3 generate_azimuth(int at, int around)
{
    double sine, cosine;
    elementary_sincos_deg(360.0 * (at % around) / around, &sine, &cosine);
    /* the longitude is 180 degrees less: x is its sine, -z its cosine */
    return vec3_make(-sine, 0.0, cosine);
}

void generate_quad(mesh *m, size_t *triangle, size_t a, size_t b, size_t c, size_t d)
{
    m->triangles[(*triangle)++] = (mesh_triangle){{(uint32_t)a, (uint32_t)c, (uint32_t)b}};
    m->triangles[(*triangle)++] = (mesh_triangle){{(uint32_t)a, (uint32_t)d, (uint32_t)c}};
}

/* --- box --- */

/* The outward normal of each face, and the directions to the right and up as seen from outside. */
static const struct {
    vec3 normal, right, up;
} sides[6] = {{{0, 0, -1}, {1, 0, 0}, {0, 1, 0}}, {{1, 0, 0}, {0, 0, 1}, {0, 1, 0}},
              {{0, 0, 1}, {-1, 0, 0}, {0, 1, 0}}, {{-1, 0, 0}, {0, 0, -1}, {0, 1, 0}},
              {{0, 1, 0}, {1, 0, 0}, {0, 0, 1}},  {{0, -1, 0}, {1, 0, 0}, {0, 0, -1}}};

status generate_box(vec3 size, mesh **out, diagnostic *why)
{
    if (!generate_is_length(size.x) || !generate_is_length(size.y) || !generate_is_length(size.z))
        return diagnose(why, STATUS_BAD_INPUT, "use edges greater than 0, at most 1e9", "invalid box size %g x %g x %g",
                        size.x, size.y, size.z);
    mesh *m;
    TRY(mesh_create(24, 12, true, true, false, &m, why));
    size_t triangle = 0, v = 0;
    for (int s = 0; s < 6; s++, v += 4) {
        for (size_t k = 0; k < 4; k++) {
            const double right = k == 1 || k == 2 ? 1.0 : -1.0, up = k >= 2 ? 1.0 : -1.0;
            const vec3 p =
                vec3_add(sides[s].normal, vec3_add(vec3_scale(sides[s].right, right), vec3_scale(sides[s].up, up)));
            m->vertices[v + k] = vec3_make(0.5 * size.x * p.x, 0.5 * size.y * p.y, 0.5 * size.z * p.z);
            m->normals[v + k] = sides[s].normal;
            m->uvs[v + k] = (mesh_uv){0.5 + 0.5 * right, 0.5 + 0.5 * up};
        }
        generate_quad(m, &triangle, v, v + 1, v + 2, v + 3);
    }
    return generate_finish(m, true, out, why);
}

/* --- torus --- */

static status check_torus(double major, double minor, int around, int tube, diagnostic *why)
{
    if (!generate_is_length(major) || !generate_is_length(minor) || !(minor < major) || !(major + minor <= MESH_FAR))
        return diagnose(why, STATUS_BAD_INPUT, "use radii above 0, at most 1e9 in sum, with the tube's the smaller one",
                        "invalid torus radii %g and %g", major, minor);
    if (around < 3 || tube < 3)
        return diagnose(why, STATUS_BAD_INPUT, "use at least 3 segments",
                        "a torus cannot have %d segments around and %d around the tube", around, tube);
    return STATUS_OK;
}

status generate_torus(double major, double minor, int around, int tube, mesh **out, diagnostic *why)
{
    status result = check_torus(major, minor, around, tube, why);
    const size_t columns = (size_t)around + 1, rows = (size_t)tube + 1;
    mesh *m = NULL;
    THEN(result, mesh_create(columns * rows, 2 * (columns - 1) * (rows - 1), true, true, false, &m, why));
    if (result != STATUS_OK)
        return result;
    size_t triangle = 0;
    for (size_t i = 0; i < columns && !cancel_asked(); i++) {
        const vec3 outward = generate_azimuth((int)i, around);
        for (size_t j = 0; j < rows; j++) {
            if (j % 64 == 0 && cancel_asked()) /* the first columns touch all pages of the mesh, which takes time */
                break;
            double sine, cosine; /* from the innermost circle down, out and up again */
            elementary_sincos_deg(360.0 * (double)(j % (size_t)tube) / tube, &sine, &cosine);
            const vec3 normal = vec3_make(-cosine * outward.x, -sine, -cosine * outward.z);
            const size_t v = j * columns + i;
            m->vertices[v] = vec3_add(vec3_scale(outward, major), vec3_scale(normal, minor));
            m->normals[v] = normal;
            m->uvs[v] = (mesh_uv){(double)i / around, (double)j / tube};
            if (i > 0 && j > 0)
                generate_quad(m, &triangle, v - columns - 1, v - columns, v, v - 1);
        }
    }
    return generate_finish(m, true, out, why);
}

/* --- height field --- */

typedef struct field {
    const double *heights;
    size_t columns, rows;
    double size_x, size_z, depth;
} field;

static status check_field(const field *f, diagnostic *why)
{
    if (f->columns < 2 || f->rows < 2)
        return diagnose(why, STATUS_BAD_INPUT, "use at least 2 by 2 heights", "too few heights in a height field");
    if (!generate_is_length(f->size_x) || !generate_is_length(f->size_z))
        return diagnose(why, STATUS_BAD_INPUT, "use sizes greater than 0, at most 1e9",
                        "invalid height field size %g x %g", f->size_x, f->size_z);
    if (!(f->depth >= 0.0 && f->depth <= MESH_FAR))
        return diagnose(why, STATUS_BAD_INPUT, "use a depth of 0 to 1e9", "invalid height field depth %g", f->depth);
    for (size_t k = 0; k < f->columns * f->rows; k++) {
        const double height = f->heights[k];
        if (cancel_asked_at(k))
            return cancel_check(why);
        if (!(fabs(height) <= MESH_FAR))
            return diagnose(why, STATUS_BAD_INPUT, "use heights of -1e9 to 1e9",
                            "height %g in column %zu of row %zu is out of range", height, k % f->columns,
                            k / f->columns);
        if (f->depth > 0.0 && !(height > -f->depth))
            return diagnose(why, STATUS_BAD_INPUT, "use a greater depth",
                            "height %g in column %zu of row %zu is not above the bottom at %g", height, k % f->columns,
                            k / f->columns, -f->depth);
    }
    return STATUS_OK;
}

/* Slope of the surface along one axis at point k, from the neighbours that exist: k is number `at` of count points,
 * which are stride apart in memory. */
static double slope(const field *f, size_t k, size_t at, size_t count, size_t stride, double spacing)
{
    const size_t before = at > 0 ? stride : 0, after = at + 1 < count ? stride : 0;
    return (f->heights[k + after] - f->heights[k - before]) / (before && after ? 2.0 * spacing : spacing);
}

static void place_top(const field *f, mesh *m, size_t *triangle)
{
    const double step_x = f->size_x / (double)(f->columns - 1), step_z = f->size_z / (double)(f->rows - 1);
    for (size_t row = 0, k = 0; row < f->rows && !cancel_asked(); row++) {
        for (size_t column = 0; column < f->columns; column++, k++) {
            const double u = (double)column / (double)(f->columns - 1), v = (double)row / (double)(f->rows - 1);
            m->vertices[k] = vec3_make(f->size_x * (u - 0.5), f->heights[k], f->size_z * (v - 0.5));
            m->normals[k] = vec3_make(-slope(f, k, column, f->columns, 1, step_x), 1.0,
                                      -slope(f, k, row, f->rows, f->columns, step_z));
            m->uvs[k] = (mesh_uv){u, v};
            if (row > 0 && column > 0)
                generate_quad(m, triangle, k - f->columns - 1, k - f->columns, k, k - 1);
        }
    }
}

/* The number of point `at` along a side; the sides are numbered from the front to the right, as seen from outside. */
static size_t along_side(const field *f, int side, size_t at)
{
    const size_t last_column = f->columns - 1, last_row = f->rows - 1;
    switch (side) {
    case 0: return at;
    case 1: return at * f->columns + last_column;
    case 2: return last_row * f->columns + last_column - at;
    default: return (last_row - at) * f->columns;
    }
}

/* The upper and lower edges of the sides, then the edge and centre of the bottom, all with their own normals. */
static void place_below(const field *f, mesh *m, size_t *triangle)
{
    static const vec3 normals[4] = {{0, 0, -1}, {1, 0, 0}, {0, 0, 1}, {-1, 0, 0}};
    const vec3 down = {0, -1, 0};
    const size_t top = f->columns * f->rows, middle = m->vertex_count - 1;
    size_t v = top;
    m->vertices[middle] = vec3_make(0.0, -f->depth, 0.0);
    m->normals[middle] = down;
    m->uvs[middle] = (mesh_uv){0.5, 0.5};
    for (int side = 0; side < 4; side++) {
        const size_t points = side % 2 ? f->rows : f->columns;
        for (size_t at = 0; at < points; at++, v += 3) {
            const size_t from = along_side(f, side, at);
            const double u = (double)at / (double)(points - 1);
            const vec3 p = m->vertices[from], low = vec3_make(p.x, -f->depth, p.z);
            m->vertices[v] = low, m->vertices[v + 1] = p, m->vertices[v + 2] = low;
            m->normals[v] = m->normals[v + 1] = normals[side], m->normals[v + 2] = down;
            m->uvs[v] = (mesh_uv){u, 0.0}, m->uvs[v + 1] = (mesh_uv){u, 1.0};
            m->uvs[v + 2] = (mesh_uv){m->uvs[from].u, 1.0 - m->uvs[from].v};
            if (at == 0)
                continue;
            generate_quad(m, triangle, v - 3, v, v + 1, v - 2);
            m->triangles[(*triangle)++] = (mesh_triangle){{(uint32_t)middle, (uint32_t)v - 1, (uint32_t)v + 2}};
        }
    }
}

status generate_height_field(const double *heights, int columns, int rows, double size_x, double size_z, double depth,
                             mesh **out, diagnostic *why)
{
    const field f = {heights, columns > 0 ? (size_t)columns : 0, rows > 0 ? (size_t)rows : 0, size_x, size_z, depth};
    TRY(check_field(&f, why));
    status result = STATUS_OK;
    const bool closed = depth > 0.0;
    const size_t border = 2 * (f.columns + f.rows), top = f.columns * f.rows;
    mesh *m;
    result =
        mesh_create(closed ? top + 3 * border + 1 : top,
                    2 * (f.columns - 1) * (f.rows - 1) + (closed ? 3 * (border - 4) : 0), true, true, false, &m, why);
    if (result != STATUS_OK)
        return result;
    size_t triangle = 0;
    place_top(&f, m, &triangle);
    if (closed)
        place_below(&f, m, &triangle);
    return generate_finish(m, closed, out, why);
}
