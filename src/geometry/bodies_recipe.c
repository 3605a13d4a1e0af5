#include "geometry/bodies.h"

const char *body_name(body_kind kind)
{
    static const char *const names[BODY_KIND_COUNT] = {"sparse", "dense", "sphere", "icosphere", "torus", "lathe", "terrain", "box"};
    return names[kind];
}

body_recipe body_recipe_default(body_kind kind)
{
    static const profile_point cone[] = {{0, 0}, {0.5, 0}, {0, 1}};
    return (body_recipe){.kind = kind, .count = 10000, .level = 3, .major = 1.0, .minor = 0.25, .around = 64, .tube = 32, .profile = cone,
                         .profile_count = sizeof cone / sizeof cone[0], .crease_deg = 30.0, .size = {1, 1, 1}};
}

status body_make(const body_recipe *r, mesh **out, diagnostic *why)
{
    switch (r->kind) {
    case BODY_SPARSE: return body_sparse(r->count, out, why);
    case BODY_DENSE: return body_dense(r->count, out, why);
    case BODY_SPHERE: return body_sphere(r->count, out, why);
    case BODY_ICOSPHERE: return body_icosphere(r->level, out, why);
    case BODY_TORUS: return body_torus(r->major, r->minor, r->around, r->tube, out, why);
    case BODY_LATHE: return body_lathe(r->profile, r->profile_count, r->around, r->crease_deg, out, why);
    case BODY_TERRAIN:
        return body_height_field(r->heights, r->columns, r->rows, r->size.x, r->size.z, r->depth, out, why);
    case BODY_BOX: return body_box(r->size, out, why);
    case BODY_KIND_COUNT: break;
    }
    return diagnose(why, STATUS_BAD_INPUT, "", "there is no such body");
}
