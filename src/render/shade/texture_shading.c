/* Textures on what rays met: coordinates of the point, how far a pixel reaches there, and the picture's colour. */
#include "render/shade/shading.h"

#include "base/elementary.h"

typedef struct mapped {
    double u, v, per_length;
} mapped;

/* Flat faces: along two of the local axes, from the face's lower left corner seen from outside; size 0 spreads one
 * picture over it. */
static mapped on_flat(double x, double y, double width, double height, double size)
{
    const double across = size > 0.0 ? size : width, up = size > 0.0 ? size : height;
    return (mapped){x / across, y / up, 1.0 / (across < up ? across : up)};
}

static mapped on_box(const primitive *p, int64_t face, vec3 q, double size)
{
    const vec3 h = p->half;
    const double x = q.x + h.x, y = q.y + h.y, z = q.z + h.z, w = 2.0 * h.x, t = 2.0 * h.y, d = 2.0 * h.z;
    switch (face) {
    case 0: return on_flat(d - z, y, d, t, size);
    case 1: return on_flat(z, y, d, t, size);
    case 2: return on_flat(x, d - z, w, d, size);
    case 3: return on_flat(x, z, w, d, size);
    case 4: return on_flat(x, y, w, t, size);
    default: return on_flat(w - x, y, w, t, size);
    }
}

/* Around the axis by the angle, with one picture, or as the length of the arc: to the right as seen from outside, the
 * picture's middle in front, at -z, as on the bodies of geometry/bodies.h. */
static mapped around(double x, double z, double radius, double v, double height, double size)
{
    const double turn = 0.5 + elementary_atan2_deg(x, -z) / 360.0, arc = 6.283185307179586 * radius;
    return on_flat(turn * arc, v, arc, height, size);
}

/* A cup's hollow has no top; it is seen from within. */
static mapped on_cylinder(const primitive *p, int64_t face, vec3 q, double size)
{
    const double r = p->radius, whole = 2.0 * r;
    const bool hollow = !(p->top < HUGE_VAL);
    if (face == 0)
        return around(hollow ? -q.x : q.x, q.z, r, q.y - p->bottom, hollow ? whole : p->top - p->bottom, size);
    return on_flat(q.x + r, face == 1 && !hollow ? r - q.z : q.z + r, whole, whole, size);
}

static mapped on_primitive(const primitive *p, int64_t face, vec3 point, double size)
{
    const vec3 moved = vec3_sub(point, p->origin), q = p->turned ? mat3_apply_transposed(p->rotation, moved) : moved;
    const double r = p->radius;
    switch (p->kind) {
    case PRIMITIVE_HALFSPACE: return on_flat(q.x, q.z, 1.0, 1.0, size);
    case PRIMITIVE_BOX: return on_box(p, face - p->first_face, q, size);
    case PRIMITIVE_CYLINDER: return on_cylinder(p, face - p->first_face, q, size);
    case PRIMITIVE_SPHERE: {
        const double latitude = 90.0 + elementary_atan2_deg(q.y, sqrt(q.x * q.x + q.z * q.z));
        return around(q.x, q.z, r, latitude / 180.0 * 3.141592653589793 * r, 3.141592653589793 * r, size);
    }
    case PRIMITIVE_MESH: break;
    }
    return (mapped){0.0, 0.0, 0.0};
}

/* Width of a pixel at the point, across the ray: the camera's rays spread by the pixel's angle. Of a ray of a deeper
 * level the way from the eye is taken for straight; so it is too narrow there by what mirrors and lenses add. */
static double pixel_width(const plan *p, vec3 point)
{
    return 2.0 * p->view.half_height / (double)p->render.height * vec3_length(vec3_sub(point, p->view.eye));
}

void texture_colors(tracer *t, const primitive *surface)
{
    const plan *p = t->target.scene;
    group *g = &t->surface.gathered;
    const double size = t->surface.look->surface.texture_size;
    for (int k = 0; k < g->count; k++) {
        const vec3 point = vec3_make(g->points.px[k], g->points.py[k], g->points.pz[k]);
        const mapped m =
            t->surface.on_mesh
                ? (mapped){t->meshes->points.tu[k], t->meshes->points.tv[k], t->meshes->points.uv_per_length[k]}
                : on_primitive(surface, g->points.face[k], t->surface.texture_at ? t->surface.texture_at[k] : point,
                               size);
        const double cosine = g->points.cos_i[k] > 0.05 ? g->points.cos_i[k] : 0.05;
        const vec3 c =
            texture_sample(t->surface.look->picture, m.u, m.v, pixel_width(p, point) / cosine * m.per_length);
        g->cr[k] *= c.x, g->cg[k] *= c.y, g->cb[k] *= c.z;
    }
}
