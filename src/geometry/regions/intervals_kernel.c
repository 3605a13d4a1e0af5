/* First pass over a batch: for every primitive, the interval [in, out] in which each ray is inside it.
 *
 * The ray's set decides where rounding errors could. A ray that is inside a primitive has no entry (in = -inf) and
 * leaves it at once if its exit is behind. A ray that is outside a convex primitive and starts on its face never hits
 * it again. A ray that starts elsewhere, outside a primitive by its set although the interval contains the start, is at
 * the primitive's edge up to rounding: it enters now if more of the interval is ahead than behind; otherwise it has
 * just left. */
#include "geometry/regions/kernels.h"

#include "geometry/primitives/primitive.h"

/* For a mesh the interval follows from the set, until its triangles are tested: (-inf, inf) or empty. */
static void membership(int bit, const ray_batch *rays, ray_scratch *s)
{
    double *restrict in = s->in[bit], *restrict out = s->out[bit];
    for (int i = 0; i < rays->count; i++) {
        const int64_t inside = -(int64_t)(rays->inside[i] >> bit & 1);
        in[i] = blend(inside, -HUGE_VAL, HUGE_VAL);
        out[i] = blend(inside, HUGE_VAL, -HUGE_VAL);
    }
}

/* Terms shared by primitives that are not rotated: inverse components, and the leading coefficient of round
 * cylinders. */
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

void KERNEL(intervals_of)(const scene_geometry *g, const ray_batch *rays, uint64_t wanted, ray_scratch *s)
{
    shared_terms(rays, s);
    for (int k = 0; k < g->direct_count; k++) {
        if (!(wanted >> k & 1))
            continue;
        const primitive *p = &g->primitives[k];
        if (g->further >> k & 1)
            continue;
        if (p->rule)
            p->rule->KERNEL_ISA->rows(p, k, rays, s);
        else
            membership(k, rays, s);
    }
}
