/* The shape prism: 0 <= y <= height over a regular polygon with `sides` corners on a circle of radius `radius` about
 * the axis, the first corner in front, at -z. Its position is the centre of its base. */
#include "geometry/shapes/parts.h"

#include "base/elementary.h"

enum { SIDES_MAX = FACES_MAX - 4 };

PRIMITIVE_RULE(prism);

static status check(const solid_shape *shape, diagnostic *why)
{
    status code = check_length(shape->radius, "radius", why);
    THEN(code, check_length(shape->height, "height", why));
    if (code == STATUS_OK && (shape->sides < 3 || shape->sides > SIDES_MAX))
        code = diagnose(why, STATUS_BAD_INPUT, "use 3 to 60, or a cylinder", "'sides' cannot be %lld",
                        (long long)shape->sides);
    return code;
}

/* The direction of k half sector angles, from -z towards +x: a corner for even k, the middle of a side for odd k. */
static vec3 direction(const solid_shape *shape, int64_t k)
{
    double sine, cosine;
    elementary_sincos_deg(180.0 * (double)k / (double)shape->sides, &sine, &cosine);
    return vec3_make(sine, 0.0, -cosine);
}

/* Radius of the inscribed circle. */
static double inscribed_radius(const solid_shape *shape)
{
    return shape->radius * -direction(shape, 1).z;
}

static bool contains(const solid_shape *shape, vec3 p)
{
    bool inside = p.y >= 0.0 && p.y <= shape->height;
    for (int64_t k = 0; k < shape->sides; k++)
        inside &= vec3_dot(direction(shape, 2 * k + 1), vec3_make(p.x, 0.0, p.z)) <= inscribed_radius(shape);
    return inside;
}

static void primitives(const solid_shape *shape, primitive *out)
{
    out[0] = primitive_placed(shape, &prism_rule, shape->height + shape->radius);
    out[0].radius = shape->radius;
    out[0].second_radius = inscribed_radius(shape);
    out[0].top = shape->height;
    out[0].sides = (int)shape->sides;
}

static bool flat(const solid_shape *shape, size_t i, vec3 *normal, vec3 *point)
{
    if (i < 2)
        return level_faces((const double[]){0.0, shape->height}, 2, i, normal, point);
    *normal = direction(shape, 2 * ((int64_t)i - 2) + 1);
    *point = vec3_scale(*normal, inscribed_radius(shape));
    return i < (size_t)shape->sides + 2;
}

static double farthest(const solid_shape *shape, vec3 d)
{
    double most = 0.0;
    for (int64_t k = 0; k < shape->sides; k++)
        most = fmax(most, vec3_dot(direction(shape, 2 * k), vec3_make(d.x, 0.0, d.z)));
    return shape->radius * most + fmax(0.0, shape->height * d.y);
}

static shape_extent extent(const solid_shape *shape)
{
    const vec3 x = vec3_make(1.0, 0.0, 0.0), z = vec3_make(0.0, 0.0, 1.0);
    const vec3 low = vec3_make(-farthest(shape, vec3_scale(x, -1.0)), 0.0, -farthest(shape, vec3_scale(z, -1.0)));
    const vec3 high = vec3_make(farthest(shape, x), shape->height, farthest(shape, z));
    /* With an odd number of sides the centre of the box is off the axis; the corner in front is the farthest from
     * it. */
    const double off = 0.5 * (low.z + high.z);
    return (shape_extent){{low, high}, hypot(shape->radius + fabs(off), 0.5 * shape->height)};
}

static double thickness(const solid_shape *shape)
{
    return fmin(shape->height, 2.0 * inscribed_radius(shape));
}

static void fit(solid_shape *shape, double size)
{
    shape->radius = 0.5 * size;
    shape->height = size;
}

static int rings(const solid_shape *shape, shape_ring *out)
{
    for (int i = 0; i < 2; i++) {
        out[i] = (shape_ring){.y = i * shape->height,
                              .x = shape->radius,
                              .z = shape->radius,
                              .corners = (int)shape->sides,
                              .from_deg = -90.0};
    }
    return 2;
}

static status tessellation(const solid_shape *shape, int part, mesh **out, diagnostic *why)
{
    (void)part;
    const uint32_t n = (uint32_t)shape->sides;
    mesh *m = NULL;
    TRY(mesh_create(2 * n, 4 * (size_t)n - 4, false, false, false, &m, why));
    mesh_triangle *next = m->triangles;
    for (uint32_t k = 0; k < n; k++) {
        const vec3 corner = vec3_scale(direction(shape, 2 * k), shape->radius);
        m->vertices[k] = corner;
        m->vertices[n + k] = vec3_add(corner, vec3_make(0.0, shape->height, 0.0));
        const uint32_t right = (k + 1) % n;
        *next++ = (mesh_triangle){{k, n + right, right}};
        *next++ = (mesh_triangle){{k, n + k, n + right}};
        if (k > 0 && right > 0) {
            *next++ = (mesh_triangle){{0, k, right}};
            *next++ = (mesh_triangle){{n, n + right, n + k}};
        }
    }
    status code = mesh_finish(m, why);
    if (code == STATUS_OK)
        *out = m;
    else
        mesh_release(m);
    return code;
}

const shape_rule shape_prism = {
    .word = "prism",
    .meaning =
        "0 <= y <= height over a regular polygon with its corners on a circle of the given radius about the axis, "
        "one of them on the -z side; its position is the centre of its base",
    .parameters = WORDS("radius", "sides", "height", "material_1", "material_2", "material_rim", "points", "scale"),
    .check = check,
    .contains = contains,
    .primitive_count = 1,
    .primitives = primitives,
    .faces = {WORDS("bottom", "top", "side")},
    .ends = {0, 1},
    .flat = flat,
    .extent = extent,
    .farthest = farthest,
    .thickness = thickness,
    .fit = fit,
    .rings = rings,
    .tessellation = tessellation,
};
