#include "render/shade.h"

#include "base/counters.h"
#include "base/elementary_inline.h"
#include "base/kernel.h"
#include "optics/interface.h"
#include "render/film.h"

/* Highest whole shininess that is raised by squaring. */
enum { SHININESS_SQUARED_MAX = 4096 };

/* base[i]^exponent in place. Whole exponents by squaring (relative error below exponent half-ulps); bases so small that the power is
 * under 2^-200, far below the film's unit, are zero, which keeps the squares out of the slow subnormal range. */
static void raise_to(double exponent, int count, double *restrict base)
{
    const unsigned whole = exponent >= 1.0 && exponent <= SHININESS_SQUARED_MAX ? (unsigned)exponent : 0;
    if ((double)whole != exponent) {
        /* VECTORISE */
        for (int i = 0; i < count; i++)
            base[i] = elementary_pow_inline(base[i], exponent);
        return;
    }
    double square[ROW];
    const double least = elementary_exp2_inline(-200.0 / exponent);
    /* VECTORISE */
    for (int i = 0; i < count; i++) {
        square[i] = blend(mask_less(base[i], least), 0.0, base[i]);
        base[i] = 1.0;
    }
    for (unsigned bits = whole; bits; bits >>= 1) {
        const int64_t take = -(int64_t)(bits & 1);
        /* VECTORISE */
        for (int i = 0; i < count; i++) {
            base[i] *= blend(take, square[i], 1.0);
            square[i] *= square[i];
        }
    }
}

static void color(const material *m, const primitive *p, group *restrict g)
{
    const int count = g->padded;
    const vec3 even = m->color, odd = m->checker_color;
    if (m->checker == 0.0) {
        for (int i = 0; i < count; i++)
            g->cr[i] = even.x, g->cg[i] = even.y, g->cb[i] = even.z;
        return;
    }
    const vec3 origin = p->origin;
    const mat3 rotation = p->rotation; /* the identity where it is not turned, which changes no bit */
    const double size = m->checker;
    for (int i = 0; i < count; i++) {
        vec3 q = vec3_make(g->points.px[i] - origin.x, g->points.py[i] - origin.y, g->points.pz[i] - origin.z);
        q = mat3_apply_transposed(rotation, q);
        double cell = floor(q.x / size) + floor(q.y / size) + floor(q.z / size);
        int64_t is_even = mask_same(lanes_bits(cell * 0.5), lanes_bits(floor(cell * 0.5)));
        g->cr[i] = blend(is_even, even.x, odd.x);
        g->cg[i] = blend(is_even, even.y, odd.y);
        g->cb[i] = blend(is_even, even.z, odd.z);
    }
}

/* Phong, "Illumination for Computer Generated Pictures", CACM 18(6), 1975: k_d I_L C (N.L) + k_s I_L (R.V)^n with
 * R = 2(N.L)N - L; both terms only where the light stands on the ray's side (N.L > 0). */
static void direct(const material *m, const light *lamp, const group *g, lit_group *restrict lit)
{
    const double ir = lamp->color.x * lamp->intensity, ig = lamp->color.y * lamp->intensity, ib = lamp->color.z * lamp->intensity;
    const vec3 at = lamp->position;
    const double least = 0.5 / FILM_ONE;
    const double k_d = m->diffuse, k_s = m->specular;
    const surface_batch *p = &g->points;
    const int count = g->padded;
    double n_l[ROW], shine[ROW];
    /* VECTORISE */
    for (int i = 0; i < count; i++) {
        vec3 l = vec3_make(at.x - p->px[i], at.y - p->py[i], at.z - p->pz[i]);
        double inverse = 1.0 / vec3_length(l);
        double l_v = -(g->dx[i] * l.x + g->dy[i] * l.y + g->dz[i] * l.z) * inverse;
        n_l[i] = (p->nx[i] * l.x + p->ny[i] * l.y + p->nz[i] * l.z) * inverse;
        shine[i] = lesser(greater(2.0 * n_l[i] * p->cos_i[i] - l_v, 0.0), 1.0);
        lit->lx[i] = l.x;
        lit->ly[i] = l.y;
        lit->lz[i] = l.z;
    }
    if (k_s > 0.0)
        raise_to(m->shininess, count, shine);
    /* VECTORISE */
    for (int i = 0; i < count; i++) {
        double highlight = k_s * shine[i], diffuse = k_d * n_l[i];
        int64_t facing = mask_less(0.0, n_l[i]);
        lit->r[i] = blend(facing, g->wr[i] * ir * (diffuse * g->cr[i] + highlight), 0.0);
        lit->g[i] = blend(facing, g->wg[i] * ig * (diffuse * g->cg[i] + highlight), 0.0);
        lit->b[i] = blend(facing, g->wb[i] * ib * (diffuse * g->cb[i] + highlight), 0.0);
        lit->shows[i] = mask_less_equal(least, lit->r[i]) | mask_less_equal(least, lit->g[i]) | mask_less_equal(least, lit->b[i]);
    }
}

ALWAYS_INLINE fresnel branch_directions(const group *g, int i, branch_group *b)
{
    const surface_batch *p = &g->points;
    vec3 d = vec3_make(g->dx[i], g->dy[i], g->dz[i]), n = vec3_make(p->nx[i], p->ny[i], p->nz[i]);
    fresnel f = fresnel_dielectric(p->cos_i[i], g->n_from[i], g->n_to[i]);
    vec3 r = direction_reflect(d, n, p->cos_i[i]), t = direction_refract(d, n, p->cos_i[i], f.eta, f.cos_t);
    b->rx[i] = r.x, b->ry[i] = r.y, b->rz[i] = r.z;
    b->tx[i] = t.x, b->ty[i] = t.y, b->tz[i] = t.z;
    return f;
}

/* Total reflections among the group's rays, from their number among the padded lanes. */
static int64_t without_padding(const group *g, int64_t among_padded)
{
    const int last = g->count - 1;
    const int64_t of_last = fresnel_dielectric(g->points.cos_i[last], g->n_from[last], g->n_to[last]).total;
    return among_padded + (g->padded - g->count) * of_last;
}

static void fresnel_branches(const material *m, const group *g, branch_group *restrict b)
{
    const double transparency = m->transparency;
    const int count = g->padded;
    int64_t total = 0;
    /* VECTORISE */
    for (int i = 0; i < count; i++) {
        fresnel f = branch_directions(g, i, b);
        b->reflect[i] = f.R;
        b->refract[i] = transparency * (1.0 - f.R);
        total -= f.total;
    }
    b->total = without_padding(g, total);
}

/* Under total internal reflection the light that cannot pass goes back too. */
static void constant_branches(const material *m, bool opaque, const group *g, branch_group *restrict b)
{
    const double reflectivity = m->reflectivity, transparency = opaque ? 0.0 : m->transparency;
    const int count = g->padded;
    int64_t total = 0;
    /* VECTORISE */
    for (int i = 0; i < count; i++) {
        fresnel f = branch_directions(g, i, b);
        b->reflect[i] = blend(f.total, reflectivity + transparency, reflectivity);
        b->refract[i] = blend(f.total, 0.0, transparency);
        total -= f.total;
    }
    b->total = without_padding(g, total);
}

/* Rounds to the nearest unit by the bits of 1.5 2^52 + v: a conversion that every instruction set has; 0 <= throughput <= 1. */
ALWAYS_INLINE int64_t cut_units(double throughput)
{
    return lanes_bits(throughput * COUNTERS_CUT_ONE + 0x1.8p52) - lanes_bits(0x1.8p52);
}

static void cut(const group *g, const branch_group *b, cut_sum *sum)
{
    const int count = g->count;
    int64_t branches = 0, red = 0, green = 0, blue = 0;
    /* VECTORISE */
    for (int i = 0; i < count; i++) {
        const double reflect = b->reflect[i], refract = b->refract[i];
        branches -= mask_less(0.0, reflect) + mask_less(0.0, refract);
        red += cut_units(g->wr[i] * reflect) + cut_units(g->wr[i] * refract);
        green += cut_units(g->wg[i] * reflect) + cut_units(g->wg[i] * refract);
        blue += cut_units(g->wb[i] * reflect) + cut_units(g->wb[i] * refract);
    }
    *sum = (cut_sum){branches, {red, green, blue}};
}

static void append(const group *g, const double *dx, const double *dy, const double *dz, const double *weight,
                   const uint64_t *inside, ray_queue *q)
{
    const surface_batch *p = &g->points;
    const int n = g->padded, at = q->count;
    const ray_queue to = {.ox = q->ox + at, .oy = q->oy + at, .oz = q->oz + at, .dx = q->dx + at, .dy = q->dy + at, .dz = q->dz + at,
                          .wr = q->wr + at, .wg = q->wg + at, .wb = q->wb + at};
    const size_t bytes = (size_t)n * sizeof(double);
    memcpy(to.ox, p->px, bytes), memcpy(to.oy, p->py, bytes), memcpy(to.oz, p->pz, bytes);
    memcpy(to.dx, dx, bytes), memcpy(to.dy, dy, bytes), memcpy(to.dz, dz, bytes);
    memcpy(q->start + at, p->face, bytes), memcpy(q->pixel + at, g->pixel, bytes), memcpy(q->inside + at, inside, bytes);
    double *restrict wr = to.wr, *restrict wg = to.wg, *restrict wb = to.wb;
    /* VECTORISE */
    for (int i = 0; i < n; i++) {
        wr[i] = g->wr[i] * weight[i];
        wg[i] = g->wg[i] * weight[i];
        wb[i] = g->wb[i] * weight[i];
    }
    q->count += g->count;
}

static void camera_directions(const camera_frame *view, int count, const double *u, const double *v, double *restrict dx,
                              double *restrict dy, double *restrict dz)
{
    const camera_frame f = *view;
    /* VECTORISE */
    for (int i = 0; i < count; i++) {
        vec3 d = vec3_add(f.forward, vec3_add(vec3_scale(f.right, u[i]), vec3_scale(f.up, v[i])));
        d = vec3_normalize(d);
        dx[i] = d.x;
        dy[i] = d.y;
        dz[i] = d.z;
    }
}

const shade_kernels KERNEL(shade_kernels) = {color, direct, fresnel_branches, constant_branches, cut, append, camera_directions};
