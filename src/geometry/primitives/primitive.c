/* Queries of primitives in world coordinates. */
#include "geometry/primitives/primitive.h"

bool primitive_contains(const primitive *p, vec3 point)
{
    return p->rule &&
           p->rule->ISA_BASELINE->contains(p, mat3_apply_transposed(p->rotation, vec3_sub(point, p->origin)));
}

int primitive_chords(const primitive *p, vec3 origin, vec3 direction, interval chords[CHORDS_MAX])
{
    if (!p->rule)
        return 0;
    const local_ray r = ray_to_local(p, true, origin.x, origin.y, origin.z, direction.x, direction.y, direction.z);
    return p->rule->ISA_BASELINE->chords(p, r, chords);
}

int primitive_flats(const primitive *p, flat_face flat[FLATS_MAX])
{
    return p->rule && p->rule->ISA_BASELINE->flats ? p->rule->ISA_BASELINE->flats(p, flat) : 0;
}

surface_mapping primitive_mapping(const primitive *p, int64_t face, vec3 point, double size)
{
    if (!p->rule)
        return (surface_mapping){0.0, 0.0, 0.0};
    const vec3 moved = vec3_sub(point, p->origin), q = p->turned ? mat3_apply_transposed(p->rotation, moved) : moved;
    return p->rule->ISA_BASELINE->mapping(p, face - p->first_face, q, size);
}
