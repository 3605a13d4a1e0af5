/* The shading kernels, compiled once for each instruction set. */
#include "render/shade/kernels.h"

#include "base/counters.h"
#include "base/isa.h"
#include "base/lanes.h"
#include "geometry/primitives/primitive.h"
#include "optics/interface.h"
#include "render/shade/media.h"

/* Largest integer exponent that is computed by repeated squaring, with a relative error below 4.6e-13. */
enum { SHININESS_SQUARED_MAX = 4096 };

/* Multiplies by factor, which may be the same array. */
static void multiply(int count, double *product, const double *factor)
{
    /* VECTORISE */
    INDEPENDENT_LANES
    for (int i = 0; i < count; i++)
        product[i] *= factor[i];
}

/* Computes base[i]^exponent in place. Integer exponents by repeated squaring (relative error below exponent half-ulps);
 * bases whose power is below 2^-200, far below the film's unit, are set to zero, which avoids slow subnormal
 * numbers. */
static void raise_to(double exponent, int count, double *restrict base)
{
    const unsigned integer = exponent >= 1.0 && exponent <= SHININESS_SQUARED_MAX ? (unsigned)exponent : 0;
    if ((double)integer != exponent) {
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
    for (unsigned bits = integer;;) {
        if (bits & 1)
            multiply(count, base, square);
        bits >>= 1;
        if (!bits)
            return;
        multiply(count, square, square);
    }
}

/* On a flat face of a primitive one coordinate is constant, and its rounding could choose the checker cell. So it is
 * replaced for the lookup of the cell: by a value half a cell inside, or on a half-space by the value on the
 * surface. */
typedef struct flat_faces {
    int64_t face[FLATS_MAX];                                   /* FACE_NONE after the last */
    int64_t is_x[FLATS_MAX], is_y[FLATS_MAX], is_z[FLATS_MAX]; /* masks */
    double at[FLATS_MAX];
} flat_faces;

static flat_faces flat_faces_of(const primitive *p, double cell)
{
    flat_faces f = {{0}, {0}, {0}, {0}, {0}};
    flat_face flat[FLATS_MAX];
    const int count = primitive_flats(p, flat);
    for (int k = 0; k < FLATS_MAX; k++) {
        f.face[k] = FACE_NONE;
        if (k >= count)
            continue;
        f.face[k] = p->first_face + flat[k].face;
        f.is_x[k] = mask_of(flat[k].axis == 0), f.is_y[k] = mask_of(flat[k].axis == 1);
        f.is_z[k] = mask_of(flat[k].axis == 2);
        f.at[k] = flat[k].at - flat[k].outwards * (0.5 * cell);
    }
    return f;
}

static void color(const material *m, const primitive *p, group *restrict g)
{
    const int lanes = g->padded;
    const vec3 even = m->color, odd = m->checker_color;
    if (m->checker == 0.0) {
        for (int i = 0; i < lanes; i++)
            g->cr[i] = even.x, g->cg[i] = even.y, g->cb[i] = even.z;
        return;
    }
    const vec3 origin = p->origin;
    const mat3 rotation = p->rotation; /* the identity if not rotated, which leaves the result bit-identical */
    const double size = m->checker;
    const flat_faces flat = flat_faces_of(p, size);
    for (int i = 0; i < lanes; i++) {
        vec3 q = vec3_make(g->points.px[i] - origin.x, g->points.py[i] - origin.y, g->points.pz[i] - origin.z);
        q = mat3_apply_transposed(rotation, q);
        for (int k = 0; k < FLATS_MAX; k++) {
            const int64_t here = mask_same(g->points.face[i], flat.face[k]);
            q.x = blend(here & flat.is_x[k], flat.at[k], q.x);
            q.y = blend(here & flat.is_y[k], flat.at[k], q.y);
            q.z = blend(here & flat.is_z[k], flat.at[k], q.z);
        }
        double cell = floor(q.x / size) + floor(q.y / size) + floor(q.z / size);
        int64_t is_even = mask_same(lanes_bits(cell * 0.5), lanes_bits(floor(cell * 0.5)));
        g->cr[i] = blend(is_even, even.x, odd.x);
        g->cg[i] = blend(is_even, even.y, odd.y);
        g->cb[i] = blend(is_even, even.z, odd.z);
    }
}

/* Multiplies by the inverse square of the distance, 1 at the light's reach. */
static void fall_off(double reach, int count, lit_group *restrict lit)
{
    const double least = 0.5 / FILM_ONE, reach2 = reach * reach;
    /* VECTORISE */
    for (int i = 0; i < count; i++) {
        double fraction = reach2 / (lit->lx[i] * lit->lx[i] + lit->ly[i] * lit->ly[i] + lit->lz[i] * lit->lz[i]);
        lit->r[i] *= fraction;
        lit->g[i] *= fraction;
        lit->b[i] *= fraction;
        lit->contributes[i] =
            ~(mask_less(lit->r[i], least) & mask_less(lit->g[i], least) & mask_less(lit->b[i], least));
    }
}

/* Phong, "Illumination for Computer Generated Pictures", CACM 18(6), 1975: k_d I_L C (N.L) + k_s I_L (R.V)^n with R =
 * 2(N.L)N - L; both terms only if the light is on the ray's side (N.L > 0). */
ALWAYS_INLINE void direct_from(const material *m, const light *lamp, bool sun, const group *g, lit_group *restrict lit)
{
    const double ir = lamp->color.x * lamp->intensity, ig = lamp->color.y * lamp->intensity,
                 ib = lamp->color.z * lamp->intensity;
    const vec3 at = lamp->position;
    const double least = 0.5 / FILM_ONE;
    const double k_d = m->diffuse, k_s = m->specular;
    const surface_batch *p = &g->points;
    const int count = g->padded;
    double n_l[ROW], shine[ROW];
    /* VECTORISE */
    for (int i = 0; i < count; i++) {
        vec3 l = sun ? at : vec3_make(at.x - p->px[i], at.y - p->py[i], at.z - p->pz[i]);
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
        /* A NaN contributes, so that the film detects it. */
        lit->contributes[i] =
            ~(mask_less(lit->r[i], least) & mask_less(lit->g[i], least) & mask_less(lit->b[i], least));
    }
    if (lamp->reach > 0.0)
        fall_off(lamp->reach, count, lit);
}

/* Specialised for suns and other lights, so that the loops have no branches. */
static void direct(const material *m, const light *lamp, const group *g, lit_group *restrict lit)
{
    if (lamp->kind == LIGHT_SUN)
        direct_from(m, lamp, true, g, lit);
    else
        direct_from(m, lamp, false, g, lit);
}

ALWAYS_INLINE void within_cone(const light_cone *cone, bool soft, const group *g, lit_group *restrict lit)
{
    const light_cone c = *cone;
    const double least = 0.5 / FILM_ONE;
    const int count = g->padded;
    /* VECTORISE */
    for (int i = 0; i < count; i++) {
        const vec3 l = vec3_make(lit->lx[i], lit->ly[i], lit->lz[i]);
        const double fraction = light_cone_fraction(&c, soft, vec3_scale(l, -1.0 / vec3_length(l)));
        lit->r[i] *= fraction;
        lit->g[i] *= fraction;
        lit->b[i] *= fraction;
        lit->contributes[i] =
            ~(mask_less(lit->r[i], least) & mask_less(lit->g[i], least) & mask_less(lit->b[i], least));
    }
}

/* Specialised for soft and hard cones, so that the loops have no branches. */
static void spot(const light_cone *c, bool soft, const group *g, lit_group *restrict lit)
{
    if (soft)
        within_cone(c, true, g, lit);
    else
        within_cone(c, false, g, lit);
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

/* The number of total reflections of the group's rays, from their number over the padded lanes. */
static int64_t without_padding(const group *g, int64_t among_padded)
{
    const int last = g->count - 1;
    const int64_t of_last = fresnel_dielectric(g->points.cos_i[last], g->n_from[last], g->n_to[last]).total;
    return among_padded + (g->padded - g->count) * of_last;
}

static void fresnel_branches(const material *m, const group *g, branch_group *restrict b)
{
    const double transparency = m->transparency, reflectivity = m->reflectivity;
    const int count = g->padded;
    int64_t total = 0;
    /* VECTORISE */
    for (int i = 0; i < count; i++) {
        fresnel f = branch_directions(g, i, b);
        const double R = f.R + (1.0 - f.R) * reflectivity;
        b->reflect[i] = R;
        b->refract[i] = transparency * (1.0 - R);
        total -= f.total;
    }
    b->total = without_padding(g, total);
}

/* Under total internal reflection the transmitted fraction is reflected too. */
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

static void straight_branches(const material *m, const group *g, branch_group *restrict b)
{
    const double reflectivity = m->reflectivity, transparency = m->transparency;
    const surface_batch *p = &g->points;
    const int count = g->padded;
    /* VECTORISE */
    for (int i = 0; i < count; i++) {
        const vec3 d = vec3_make(g->dx[i], g->dy[i], g->dz[i]), n = vec3_make(p->nx[i], p->ny[i], p->nz[i]);
        const vec3 r = direction_reflect(d, n, p->cos_i[i]);
        b->rx[i] = r.x, b->ry[i] = r.y, b->rz[i] = r.z;
        b->tx[i] = d.x, b->ty[i] = d.y, b->tz[i] = d.z;
        b->reflect[i] = reflectivity;
        b->refract[i] = transparency;
    }
    b->total = 0;
}

static void cut(const group *g, const branch_group *b, cut_sum *sum)
{
    const int count = g->count;
    int64_t branches = 0, red = 0, green = 0, blue = 0;
    /* VECTORISE */
    for (int i = 0; i < count; i++) {
        const double reflect = b->reflect[i], refract = b->refract[i];
        branches -= mask_less(0.0, reflect) + mask_less(0.0, refract);
        red += counters_cut_units(g->wr[i] * reflect) + counters_cut_units(g->wr[i] * refract);
        green += counters_cut_units(g->wg[i] * reflect) + counters_cut_units(g->wg[i] * refract);
        blue += counters_cut_units(g->wb[i] * reflect) + counters_cut_units(g->wb[i] * refract);
    }
    *sum = (cut_sum){branches, {red, green, blue}};
}

/* Stores light i; returns -1 if it is out of range, where C does not define the conversion. AVX2 cannot convert to
 * 64-bit integers, so that loops with this function have no mark VECTORISE. */
ALWAYS_INLINE int64_t store_light(double r, double g, double b, int64_t counts, int i, film_light *out)
{
    const int64_t fits = mask_of((int)film_accepts(r) & (int)film_accepts(g) & (int)film_accepts(b)),
                  keep = fits & counts;
    out->r[i] = film_units(blend(keep, r, 0.0));
    out->g[i] = film_units(blend(keep, g, 0.0));
    out->b[i] = film_units(blend(keep, b, 0.0));
    return ~fits & counts;
}

static void own_light(const group *g, vec3 radiance, film_light *restrict out)
{
    const int count = g->padded, last = g->count - 1;
    int64_t bad = 0;
    for (int i = 0; i < count; i++)
        bad += mask_of(i <= last) & store_light(g->wr[i] * radiance.x * g->cr[i], g->wg[i] * radiance.y * g->cg[i],
                                                g->wb[i] * radiance.z * g->cb[i], -1, i, out);
    out->out_of_range = bad;
}

static void cut_light(const group *g, const branch_group *b, vec3 radiance, film_light *restrict out)
{
    const int count = g->padded, last = g->count - 1;
    int64_t bad = 0;
    for (int i = 0; i < count; i++) {
        const double both = b->reflect[i] + b->refract[i];
        bad += mask_of(i <= last) & store_light(g->wr[i] * both * radiance.x, g->wg[i] * both * radiance.y,
                                                g->wb[i] * both * radiance.z, mask_less(0.0, both), i, out);
    }
    out->out_of_range = bad;
}

static void arrived(int count, const double *fraction, const double *r, const double *g, const double *b,
                    film_light *restrict out)
{
    int64_t bad = 0;
    for (int i = 0; i < count; i++)
        bad += store_light(fraction[i] * r[i], fraction[i] * g[i], fraction[i] * b[i], mask_less(0.0, fraction[i]), i,
                           out);
    out->out_of_range = bad;
}

static void absorb(double *restrict depth, int count)
{
    /* VECTORISE */
    for (int i = 0; i < count; i++)
        depth[i] = blend(mask_less(0.0, depth[i]), absorption_left(depth[i]), 1.0);
}

const shade_kernels KERNEL(shade_kernels) = {
    color,     direct,    spot,    fresnel_branches, constant_branches,   straight_branches, cut,
    own_light, cut_light, arrived, absorb,           KERNEL(texture_tint)};
