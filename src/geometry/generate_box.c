/* A box mesh. */
#include "geometry/mesh_generators_parts.h"

/* Half the edges as signs: a face's outward normal, and its right and upper directions as seen from outside. */
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
