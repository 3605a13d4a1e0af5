/* A torus mesh. */
#include "geometry/mesh_generators_parts.h"

#include "base/cancel.h"
#include "base/elementary.h"

static status check(double major, double minor, int around, int tube, diagnostic *why)
{
    if (!generate_is_length(major) || !generate_is_length(minor) || !(minor < major) || !(major + minor <= MESH_FAR))
        return diagnose(why, STATUS_BAD_INPUT, "use radii greater than 0, with the tube's the smaller one",
                        "invalid torus radii %g and %g", major, minor);
    if (around < 3 || tube < 3)
        return diagnose(why, STATUS_BAD_INPUT, "use at least 3 segments",
                        "a torus cannot have %d segments around and %d around the tube", around, tube);
    return STATUS_OK;
}

status generate_torus(double major, double minor, int around, int tube, mesh **out, diagnostic *why)
{
    status result = check(major, minor, around, tube, why);
    const size_t columns = (size_t)around + 1, rows = (size_t)tube + 1;
    mesh *m = NULL;
    THEN(result, mesh_create(columns * rows, 2 * (columns - 1) * (rows - 1), true, true, false, &m, why));
    if (result != STATUS_OK)
        return result;
    size_t triangle = 0;
    for (size_t i = 0; i < columns && !cancel_asked(); i++) {
        const vec3 outward = generate_azimuth((int)i, around);
        for (size_t j = 0; j < rows; j++) {
            if (j % 64 == 0 && cancel_asked()) /* the first columns take all pages of the mesh */
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
