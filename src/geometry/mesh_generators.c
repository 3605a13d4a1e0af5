/* Functions that the mesh generators share. */
#include "geometry/mesh_generators_parts.h"

#include "base/cancel.h"
#include "base/elementary.h"

status generate_finish(mesh *m, bool must_be_closed, mesh **out, diagnostic *why)
{
    status result = cancel_check(why);
    THEN(result, mesh_finish(m, why));
    if (result == STATUS_OK && must_be_closed && !m->closed)
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
    return vec3_make(-sine, 0.0,
                     cosine); /* 180 degrees further: the sine of the longitude along x, its cosine along -z */
}

void generate_quad(mesh *m, size_t *triangle, size_t a, size_t b, size_t c, size_t d)
{
    m->triangles[(*triangle)++] = (mesh_triangle){{(uint32_t)a, (uint32_t)c, (uint32_t)b}};
    m->triangles[(*triangle)++] = (mesh_triangle){{(uint32_t)a, (uint32_t)d, (uint32_t)c}};
}
