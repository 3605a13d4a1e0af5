/* A height field mesh. */
#include "geometry/mesh_generators_parts.h"

#include "base/cancel.h"

typedef struct field {
    const double *heights;
    size_t columns, rows;
    double size_x, size_z, depth;
} field;

static status check(const field *f, diagnostic *why)
{
    if (f->columns < 2 || f->rows < 2)
        return diagnose(why, STATUS_BAD_INPUT, "use at least 2 by 2", "too few heights in a height field");
    if (!generate_is_length(f->size_x) || !generate_is_length(f->size_z))
        return diagnose(why, STATUS_BAD_INPUT, "use sizes greater than 0, at most 1e9",
                        "invalid height field size %g x %g", f->size_x, f->size_z);
    if (!(f->depth >= 0.0 && f->depth <= MESH_FAR))
        return diagnose(why, STATUS_BAD_INPUT, "use 0 to 1e9", "invalid height field depth %g", f->depth);
    for (size_t k = 0; k < f->columns * f->rows; k++) {
        const double height = f->heights[k];
        if (cancel_asked_at(k))
            return cancel_check(why);
        if (!(fabs(height) <= MESH_FAR))
            return diagnose(why, STATUS_BAD_INPUT, "use -1e9 to 1e9",
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

/* Numbers of the points along a side; the sides are numbered from the front to the right, as seen from outside. */
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
    TRY(check(&f, why));
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
