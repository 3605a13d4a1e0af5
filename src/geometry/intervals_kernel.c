/* First pass over a batch: for every primitive the interval [in, out] in which each ray is inside it.
 *
 * The set that a ray carries is trusted where arithmetic cannot tell: a ray that is inside a primitive has no entry
 * (in = -inf) and leaves it at once if its exit lies behind; a ray that is outside a convex primitive whose
 * face it starts on never meets it again; one that is outside another primitive although the interval says otherwise is
 * at its edge to within rounding: it enters now if more of the interval lies ahead than behind, else it has just left.
 */
#include "geometry/kernels.h"

#include "geometry/roots.h"

ALWAYS_INLINE void store_interval(double near, double far, int64_t hit, int64_t own, int64_t inside, double *in,
                                  double *out)
{
    int64_t ahead = hit & ~own & mask_less(0.0, near + far);
    double outside_in = blend(ahead, greater(near, 0.0), HUGE_VAL), outside_out = blend(ahead, far, -HUGE_VAL);
    *in = blend(inside, -HUGE_VAL, outside_in);
    *out = blend(inside, blend(hit, greater(far, 0.0), 0.0), outside_out);
}

ALWAYS_INLINE int64_t inside_mask(uint64_t set, int shift)
{
    return -(int64_t)((set & (uint64_t)1 << shift) != 0);
}

ALWAYS_INLINE void halfspaces(const primitive *p, bool turned, int bit, const ray_batch *rays, ray_scratch *s)
{
    double *restrict in = s->in[bit], *restrict out = s->out[bit];
    const int64_t first = p->first_face;
    /* VECTORISE */
    for (int i = 0; i < rays->count; i++) {
        local_ray r =
            ray_to_local(p, turned, rays->ox[i], rays->oy[i], rays->oz[i], rays->dx[i], rays->dy[i], rays->dz[i]);
        int64_t own = mask_same(rays->start[i], first);
        double inverse = turned ? inverse_of_component(r.dy) : s->inverse_y[i];
        double t = blend(own, 0.0, -r.y * inverse);
        int64_t down = mask_less(inverse, 0.0);
        store_interval(blend(down, t, -HUGE_VAL), blend(down, HUGE_VAL, t), -1, own, inside_mask(rays->inside[i], bit),
                       &in[i], &out[i]);
    }
}

ALWAYS_INLINE void cylinders(const primitive *p, bool turned, int bit, const ray_batch *rays, ray_scratch *s)
{
    double *restrict in = s->in[bit], *restrict out = s->out[bit];
    const int64_t first = p->first_face;
    /* VECTORISE */
    for (int i = 0; i < rays->count; i++) {
        local_ray r =
            ray_to_local(p, turned, rays->ox[i], rays->oy[i], rays->oz[i], rays->dx[i], rays->dy[i], rays->dz[i]);
        int64_t on_side = mask_same(rays->start[i], first), on_bottom = mask_same(rays->start[i], first + 1),
                on_top = mask_same(rays->start[i], first + 2);
        double dx = turned ? cylinder_dx(r.dx, r.dz) : s->axial_dx[i];
        double a = turned ? cylinder_axial(dx, r.dz, p->m2) : s->axial[i]; /* upright round cylinders share it */
        double inverse_a = turned ? 1.0 / a : s->inverse_axial[i];
        double inverse_y = turned ? inverse_of_component(r.dy) : s->inverse_y[i];
        quadric_roots side = cylinder_side(p, r.x, r.z, dx, r.dz, a, inverse_a, on_side);
        slab_roots caps = slab_cross(r.y, inverse_y, p->bottom, p->top, on_bottom, on_top);
        double near = greater(side.in, caps.in), far = lesser(side.out, caps.out);
        store_interval(near, far, side.hit & mask_less(near, far), on_side | on_bottom | on_top,
                       inside_mask(rays->inside[i], bit), &in[i], &out[i]);
    }
}

ALWAYS_INLINE void boxes(const primitive *p, bool turned, int bit, const ray_batch *rays, ray_scratch *s)
{
    double *restrict in = s->in[bit], *restrict out = s->out[bit];
    const int64_t first = p->first_face;
    const vec3 h = p->half;
    /* VECTORISE */
    for (int i = 0; i < rays->count; i++) {
        local_ray r =
            ray_to_local(p, turned, rays->ox[i], rays->oy[i], rays->oz[i], rays->dx[i], rays->dy[i], rays->dz[i]);
        int64_t at = rays->start[i] - first;
        slab_roots x = slab_cross(r.x, turned ? inverse_of_component(r.dx) : s->inverse_x[i], -h.x, h.x,
                                  mask_same(at, 0), mask_same(at, 1));
        slab_roots y = slab_cross(r.y, turned ? inverse_of_component(r.dy) : s->inverse_y[i], -h.y, h.y,
                                  mask_same(at, 2), mask_same(at, 3));
        slab_roots z = slab_cross(r.z, turned ? inverse_of_component(r.dz) : s->inverse_z[i], -h.z, h.z,
                                  mask_same(at, 4), mask_same(at, 5));
        double near = greater(greater(x.in, y.in), z.in), far = lesser(lesser(x.out, y.out), z.out);
        int64_t own = mask_same(rays->start[i] & ~(int64_t)(FACES_MAX - 1), first);
        store_interval(near, far, mask_less(near, far), own, inside_mask(rays->inside[i], bit), &in[i], &out[i]);
    }
}

ALWAYS_INLINE void spheres(const primitive *p, int bit, const ray_batch *rays, ray_scratch *s)
{
    double *restrict in = s->in[bit], *restrict out = s->out[bit];
    const int64_t first = p->first_face;
    /* VECTORISE */
    for (int i = 0; i < rays->count; i++) {
        local_ray r =
            ray_to_local(p, false, rays->ox[i], rays->oy[i], rays->oz[i], rays->dx[i], rays->dy[i], rays->dz[i]);
        int64_t own = mask_same(rays->start[i], first);
        quadric_roots q = sphere_cross(p, r, own);
        store_interval(q.in, q.out, q.hit, own, inside_mask(rays->inside[i], bit), &in[i], &out[i]);
    }
}

/* Of a mesh the set says all that is known before its triangles are asked: in it from ever to ever, or never. */
static void membership(int bit, const ray_batch *rays, ray_scratch *s)
{
    double *restrict in = s->in[bit], *restrict out = s->out[bit];
    for (int i = 0; i < rays->count; i++) {
        const int64_t inside = inside_mask(rays->inside[i], bit);
        in[i] = blend(inside, -HUGE_VAL, HUGE_VAL);
        out[i] = blend(inside, HUGE_VAL, -HUGE_VAL);
    }
}

/* What the primitives that are not turned share: inverse components, and the leading coefficient of round cylinders. */
static void shared_terms(const ray_batch *rays, ray_scratch *restrict s)
{
    /* VECTORISE */
    for (int i = 0; i < rays->count; i++) {
        local_ray r = {0.0, 0.0, 0.0, rays->dx[i], rays->dy[i], rays->dz[i]};
        s->inverse_x[i] = inverse_of_component(r.dx);
        s->inverse_y[i] = inverse_of_component(r.dy);
        s->inverse_z[i] = inverse_of_component(r.dz);
        s->axial_dx[i] = cylinder_dx(r.dx, r.dz);
        s->axial[i] = cylinder_axial(s->axial_dx[i], r.dz, 1.0);
        s->inverse_axial[i] = 1.0 / s->axial[i];
    }
}

/* An upright elliptic cylinder is turned by the identity, which changes no bit. */
static void cylinder_any(const primitive *p, int bit, const ray_batch *rays, ray_scratch *s)
{
    if (p->turned || p->m2 != 1.0)
        cylinders(p, true, bit, rays, s);
    else
        cylinders(p, false, bit, rays, s);
}

void KERNEL(intervals_of)(const arrangement *a, const ray_batch *rays, uint64_t wanted, ray_scratch *s)
{
    shared_terms(rays, s);
    for (int k = 0; k < a->primitive_count; k++) {
        if (!(wanted >> k & 1))
            continue;
        const primitive p = a->primitives[k]; /* a copy: no store below can alias it */
        switch (p.kind) {
        case PRIMITIVE_HALFSPACE:
            if (p.turned)
                halfspaces(&p, true, k, rays, s);
            else
                halfspaces(&p, false, k, rays, s);
            break;
        case PRIMITIVE_CYLINDER: cylinder_any(&p, k, rays, s); break;
        case PRIMITIVE_BOX:
            if (p.turned)
                boxes(&p, true, k, rays, s);
            else
                boxes(&p, false, k, rays, s);
            break;
        case PRIMITIVE_SPHERE: spheres(&p, k, rays, s); break;
        case PRIMITIVE_MESH: membership(k, rays, s); break;
        }
    }
}
