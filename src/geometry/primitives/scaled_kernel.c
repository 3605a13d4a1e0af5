/* Any other primitive, scaled along its own axes, or mirrored: an ellipsoid is a sphere in such a frame. Rays are
 * divided by the scale; a ray's parameter t stays the same, because their directions keep no length. Faces are those of
 * the primitive within.
 *
 * A normal n of the primitive within becomes n divided by the scale, since n . v = 0 holds for tangents v that are
 * multiplied by it (Pharr, Jakob and Humphreys, Physically Based Rendering, 3.11.3). */
#include "geometry/primitives/kind.h"

static local_ray ray_within(const primitive *p, local_ray r)
{
    const scaled_primitive *d = p->details;
    const vec3 k = d->inverse;
    return (local_ray){k.x * r.x, k.y * r.y, k.z * r.z, k.x * r.dx, k.y * r.dy, k.z * r.dz};
}

static vec3 point_within(const primitive *p, vec3 q)
{
    const scaled_primitive *d = p->details;
    return vec3_make(d->inverse.x * q.x, d->inverse.y * q.y, d->inverse.z * q.z);
}

static const primitive_functions *functions_of(const scaled_primitive *d)
{
    return d->inner.rule->KERNEL_ISA;
}

/* A ray of a batch as a batch of its own, for the primitive within. */
typedef struct ray_alone {
    local_ray r;
    int64_t start;
    uint64_t inside;
} ray_alone;

static ray_alone ray_alone_of(const primitive *p, const ray_batch *rays, int i)
{
    const local_ray r =
        ray_to_local(p, p->turned, rays->ox[i], rays->oy[i], rays->oz[i], rays->dx[i], rays->dy[i], rays->dz[i]);
    const int64_t at = rays->start[i] - p->first_face;
    return (ray_alone){ray_within(p, r), at >= 0 && at < FACES_MAX ? at : FACE_NONE, rays->inside[i]};
}

static ray_batch batch_alone(const ray_alone *a)
{
    return (ray_batch){1, &a->r.x, &a->r.y, &a->r.z, &a->r.dx, &a->r.dy, &a->r.dz, &a->start, &a->inside};
}

static void one(const primitive *p, const ray_batch *rays, int i, bool inside, const ray_scratch *s, interval *found)
{
    const scaled_primitive *d = p->details;
    const ray_alone alone = ray_alone_of(p, rays, i);
    const ray_batch batch = batch_alone(&alone);
    functions_of(d)->one(&d->inner, &batch, 0, inside, s, found);
}

/* Ray by ray, as few rays hit a scaled solid. */
static void rows(const primitive *p, int bit, const ray_batch *rays, ray_scratch *s)
{
    for (int i = 0; i < rays->count; i++) {
        interval found[CHORDS_MAX];
        one(p, rays, i, rays->inside[i] >> bit & 1, s, found);
        for (int k = 0; k < p->rows; k++)
            s->in[bit + k][i] = found[k].in, s->out[bit + k][i] = found[k].out;
    }
}

/* The error of a point within is multiplied by the largest scale; the frame adds its own. */
static void point_of_ray(const primitive *p, const ray_batch *rays, const double *t, int i, int bit, surface_batch *out)
{
    const scaled_primitive *d = p->details;
    const ray_alone alone = ray_alone_of(p, rays, i);
    const ray_batch batch = batch_alone(&alone);
    surface_batch within;
    functions_of(d)->points(&d->inner, &batch, &t[i], bit, &within);
    const vec3 k = d->scale, by = d->inverse,
               normal = vec3_normalize(vec3_make(by.x * within.nx[0], by.y * within.ny[0], by.z * within.nz[0])),
               point = vec3_make(k.x * within.px[0], k.y * within.py[0], k.z * within.pz[0]);
    const vec3 n = mat3_apply(p->rotation, normal), q = vec3_add(mat3_apply(p->rotation, point), p->origin);
    const double most = greater(magnitude(k.x), greater(magnitude(k.y), magnitude(k.z)));
    const double cosine = -(rays->dx[i] * n.x + rays->dy[i] * n.y + rays->dz[i] * n.z);
    const double path = t[i] * (magnitude(rays->dx[i]) + magnitude(rays->dy[i]) + magnitude(rays->dz[i]));
    const double size = magnitude(rays->ox[i] - p->origin.x) + magnitude(rays->oy[i] - p->origin.y) +
                        magnitude(rays->oz[i] - p->origin.z) + magnitude(path);
    out->px[i] = q.x, out->py[i] = q.y, out->pz[i] = q.z;
    out->nx[i] = n.x, out->ny[i] = n.y, out->nz[i] = n.z;
    out->cos_i[i] = lesser(greater(cosine, DBL_MIN), 1.0);
    out->error[i] = most * within.error[0] + POINT_ERROR * (size + p->extent);
    out->face[i] = p->first_face + within.face[0];
}

static void points(const primitive *__restrict p, const ray_batch *rays, const double *t, int bit, surface_batch *out)
{
    for (int i = 0; i < rays->count; i++)
        point_of_ray(p, rays, t, i, bit, out);
}

static bool contains(const primitive *p, vec3 q)
{
    const scaled_primitive *d = p->details;
    return functions_of(d)->contains(&d->inner, point_within(p, q));
}

static int chords(const primitive *p, local_ray r, interval found[CHORDS_MAX])
{
    const scaled_primitive *d = p->details;
    return functions_of(d)->chords(&d->inner, ray_within(p, r), found);
}

static int flats(const primitive *p, flat_face flat[FLATS_MAX])
{
    const scaled_primitive *d = p->details;
    const int count = functions_of(d)->flats ? functions_of(d)->flats(&d->inner, flat) : 0;
    for (int i = 0; i < count; i++) {
        const double k = flat[i].axis == 0 ? d->scale.x : flat[i].axis == 1 ? d->scale.y : d->scale.z;
        flat[i].at *= k;
        flat[i].outwards *= k < 0.0 ? -1.0 : 1.0;
    }
    return count;
}

/* A texture is scaled with its solid. */
static surface_mapping mapping(const primitive *p, int64_t face, vec3 q, double size)
{
    const scaled_primitive *d = p->details;
    const vec3 k = d->scale;
    surface_mapping m = functions_of(d)->mapping(&d->inner, face, point_within(p, q), size);
    m.per_length /= lesser(magnitude(k.x), lesser(magnitude(k.y), magnitude(k.z)));
    return m;
}

/* By the number of intervals of a line in the primitive within. */
#define SCALED_FUNCTIONS(most)                                                                      \
    const primitive_functions KERNEL(scaled_##most##_functions) = {most,     rows,   one,   points, \
                                                                   contains, chords, flats, mapping}
SCALED_FUNCTIONS(1);
SCALED_FUNCTIONS(2);
SCALED_FUNCTIONS(3);
SCALED_FUNCTIONS(5);
SCALED_FUNCTIONS(7);
SCALED_FUNCTIONS(9);
