/* The sampling kernels, compiled once for each instruction set. */
#include "render/shade/kernels.h"

#include "base/isa.h"
#include "base/lanes.h"
#include "optics/mueller.h"
#include <math.h>

/* Conversions between integers below 2^52 and doubles by the bits of 2^52 + n, which work with every instruction
 * set. */
ALWAYS_INLINE double real_of(int64_t n)
{
    return lanes_double(n | 0x4330000000000000) - 0x1p52;
}

ALWAYS_INLINE int64_t integer_of(double n)
{
    return lanes_bits(n + 0x1p52) & 0xfffffffffffff;
}

/* floor(n / by) of integers below 2^26; their rounded quotient is an integer only if the exact quotient is. */
ALWAYS_INLINE double divided(double n, double by)
{
    const double quotient = n / by, nearest = quotient + 0x1p52 - 0x1p52;
    return nearest - blend(mask_less(quotient, nearest), 1.0, 0.0);
}

static void draw_sobol(const path_sampling *p, int count, const int64_t *sample_key, int depth, int purpose,
                       double *restrict u, double *restrict v)
{
    double per_replicate[ROW];
    uint32_t index[ROW];
    uint32_t order[ROW], seed_x[ROW], seed_y[ROW];
    for (int i = 0; i < count; i++)
        per_replicate[i] = (double)path_replicate_count(p, sample_key_pixel(sample_key[i]));
    const path_sampling sampling = *p;
    /* VECTORISE */
    for (int i = 0; i < count; i++) {
        const double sample = real_of(sample_key_sample(sample_key[i])), replicate = divided(sample, per_replicate[i]);
        const sobol_seeds seeds = sobol_seeds_of(
            path_draw_key(&sampling, sample_key_pixel(sample_key[i]), (uint64_t)integer_of(replicate), depth, purpose));
        index[i] = (uint32_t)integer_of(sample - replicate * per_replicate[i]);
        order[i] = seeds.order, seed_x[i] = seeds.x, seed_y[i] = seeds.y;
    }
    /* VECTORISE */
    for (int i = 0; i < count; i++) {
        const sobol_point s = sobol_scrambled(index[i], (sobol_seeds){order[i], seed_x[i], seed_y[i]});
        seed_x[i] = s.x, seed_y[i] = s.y;
    }
    /* VECTORISE */
    for (int i = 0; i < count; i++) { /* random_unit */
        u[i] = (real_of(seed_x[i]) + 0.5) * 0x1p-32;
        v[i] = (real_of(seed_y[i]) + 0.5) * 0x1p-32;
    }
}

static void draw_each(const path_sampling *p, int count, const int64_t *sample_key, int depth, int purpose,
                      double *restrict u, double *restrict v)
{
    if (p->sampler == SAMPLER_SOBOL) {
        draw_sobol(p, count, sample_key, depth, purpose, u, v);
        return;
    }
    for (int i = 0; i < count; i++) {
        const unit_pair drawn = path_draw(p, sample_key[i], depth, purpose);
        u[i] = drawn.u, v[i] = drawn.v;
    }
}

/* --- camera rays --- */

static void camera_directions(const camera_frame *view, int count, const double *u, const double *v,
                              double *restrict dx, double *restrict dy, double *restrict dz)
{
    const camera_frame f = *view;
    /* VECTORISE */
    for (int i = 0; i < count; i++) {
        const vec3 d = camera_toward(&f, u[i], v[i]);
        dx[i] = d.x;
        dy[i] = d.y;
        dz[i] = d.z;
    }
}

/* Uniform over the lens's disc: the area within a radius grows as its square. */
static void camera_rays(const camera_frame *view, int count, const double *u, const double *v, lens_points lens,
                        camera_rays_out out)
{
    const camera_frame f = *view;
    const double *area = lens.area, *turn = lens.turn;
    double *restrict ox = out.ox, *restrict oy = out.oy, *restrict oz = out.oz;
    double *restrict dx = out.dx, *restrict dy = out.dy, *restrict dz = out.dz;
    /* VECTORISE */
    INDEPENDENT_LANES
    for (int i = 0; i < count; i++) {
        const double radius = f.lens_radius * sqrt(area[i]);
        double sine, cosine;
        elementary_sincos_turn_inline(turn[i], &sine, &cosine);
        const camera_ray r = camera_ray_through(&f, u[i], v[i], radius * cosine, radius * sine);
        ox[i] = r.origin.x, oy[i] = r.origin.y, oz[i] = r.origin.z;
        dx[i] = r.direction.x, dy[i] = r.direction.y, dz[i] = r.direction.z;
    }
}

/* --- directions from a group's points --- */

/* The unit direction at an angle to the unit vector axis, turned about it by a fraction of a full circle. */
ALWAYS_INLINE vec3 direction_about(vec3 axis, double cosine, double sine, double turn)
{
    vec3 x, y;
    double s, c;
    polarisation_frame(axis, &x, &y);
    elementary_sincos_turn_inline(turn, &s, &c);
    const vec3 across = vec3_add(vec3_scale(x, sine * c), vec3_scale(y, sine * s));
    return vec3_normalize(vec3_add(vec3_scale(axis, cosine), across));
}

static void cosine(const group *g, const double *u, const double *v, double *restrict dx, double *restrict dy,
                   double *restrict dz)
{
    const surface_batch *at = &g->points;
    const int count = g->count;
    /* VECTORISE */
    INDEPENDENT_LANES
    for (int i = 0; i < count; i++) {
        const vec3 n = vec3_make(at->nx[i], at->ny[i], at->nz[i]),
                   d = direction_about(n, sqrt(1.0 - u[i]), sqrt(u[i]), v[i]);
        dx[i] = d.x, dy[i] = d.y, dz[i] = d.z;
    }
}

/* Uniform over the cone of directions to the sphere: Shirley, Wang and Zimmerman 1996, section 3.2.2. */
static void spheres(const group *g, sphere_samples *restrict s)
{
    const surface_batch *at = &g->points;
    const int count = g->count;
    /* VECTORISE */
    INDEPENDENT_LANES
    for (int i = 0; i < count; i++) {
        const vec3 n = vec3_make(at->nx[i], at->ny[i], at->nz[i]), to_centre = vec3_make(s->x[i], s->y[i], s->z[i]);
        const double radius2 = s->radius[i] * s->radius[i], distance2 = vec3_dot(to_centre, to_centre),
                     distance = sqrt(distance2), sine2 = radius2 / distance2;
        const int64_t outside = mask_less(sine2, 1.0);
        const double within_unit = blend(outside, sine2, 0.0);
        /* cap = 1 - least_cos, without cancellation. */
        const double least_cos = sqrt(1.0 - within_unit), cap = within_unit / (1.0 + least_cos);
        const double below = s->u[i] * cap, cos_axis = 1.0 - below, sin_axis = sqrt(below * (2.0 - below));
        const vec3 d = direction_about(vec3_scale(to_centre, 1.0 / distance), cos_axis, sin_axis, s->v[i]);
        const double inside2 = radius2 - distance2 * sin_axis * sin_axis;
        s->dx[i] = d.x, s->dy[i] = d.y, s->dz[i] = d.z;
        s->cap[i] = cap;
        s->reach[i] = distance * cos_axis - sqrt(greater(inside2, 0.0));
        s->n_l[i] = blend(outside, vec3_dot(n, d), 0.0);
    }
}

/* (k_d C / pi) L (N.L) over the density 1 / (2 pi cap), plus Phong's highlight from the same light. */
static void sphere_light(const group *g, const sphere_samples *s, double radiance, vec3 color, double k_d,
                         const double *shine, lit_group *restrict lit)
{
    const int count = g->count;
    /* VECTORISE */
    INDEPENDENT_LANES
    for (int i = 0; i < count; i++) {
        const double seen = 2.0 * s->cap[i] * radiance, diffuse = k_d * s->n_l[i];
        lit->lx[i] = s->dx[i] * s->reach[i];
        lit->ly[i] = s->dy[i] * s->reach[i];
        lit->lz[i] = s->dz[i] * s->reach[i];
        lit->r[i] = g->wr[i] * (color.x * seen) * (diffuse * g->cr[i] + shine[i]);
        lit->g[i] = g->wg[i] * (color.y * seen) * (diffuse * g->cg[i] + shine[i]);
        lit->b[i] = g->wb[i] * (color.z * seen) * (diffuse * g->cb[i] + shine[i]);
        lit->contributes[i] = mask_less(0.0, s->n_l[i]);
    }
}

static void choose_branches(const group *g, const branch_group *b, const double *chance, continuations *restrict c)
{
    const int count = g->count;
    /* VECTORISE */
    INDEPENDENT_LANES
    for (int i = 0; i < count; i++) {
        const double both = b->reflect[i] + b->refract[i];
        const int64_t refracted = mask_less_equal(b->reflect[i], chance[i] * both) & mask_less(0.0, b->refract[i]);
        c->dx[i] = blend(refracted, b->tx[i], b->rx[i]);
        c->dy[i] = blend(refracted, b->ty[i], b->ry[i]);
        c->dz[i] = blend(refracted, b->tz[i], b->rz[i]);
        c->r[i] = c->g[i] = c->b[i] = both;
        c->inside[i] = (uint64_t)blend_int(refracted, (int64_t)g->inside_after[i], (int64_t)g->inside_before[i]);
        c->sample_key[i] = g->sample_key[i] | SAMPLE_KEY_SPECULAR_BOUNCE;
        c->exists[i] = mask_less(0.0, both);
        c->refracted[i] = refracted;
    }
}

static void leave_matte(const group *g, double diffuse, continuations *restrict c)
{
    const int count = g->count;
    /* VECTORISE */
    INDEPENDENT_LANES
    for (int i = 0; i < count; i++) {
        c->r[i] = g->cr[i] * diffuse;
        c->g[i] = g->cg[i] * diffuse;
        c->b[i] = g->cb[i] * diffuse;
        c->inside[i] = g->inside_before[i];
        c->sample_key[i] = g->sample_key[i] & ~SAMPLE_KEY_SPECULAR_BOUNCE;
        c->exists[i] = mask_less(0.0, diffuse * greater(g->cr[i], greater(g->cg[i], g->cb[i])));
        c->refracted[i] = 0;
    }
}

/* The margin covers the rounding of the difference. */
static bool near_sphere(const ray_batch *rays, vec3 centre, double radius, int64_t *restrict near)
{
    const double *ox = rays->ox, *oy = rays->oy, *oz = rays->oz, *dx = rays->dx, *dy = rays->dy, *dz = rays->dz;
    const double radius2 = radius * radius;
    const int count = rays->count;
    int64_t any = 0;
    /* VECTORISE */
    for (int i = 0; i < count; i++) {
        const vec3 to_centre = vec3_sub(centre, vec3_make(ox[i], oy[i], oz[i]));
        const double along = vec3_dot(to_centre, vec3_make(dx[i], dy[i], dz[i])),
                     distance2 = vec3_dot(to_centre, to_centre);
        near[i] = mask_less(0.0, along) & ~mask_less(radius2 + 1e-12 * distance2, distance2 - along * along);
        any |= near[i];
    }
    return any != 0;
}

/* (k_d cos + k_s) / distance^2 for each light. If the horizon cuts a sphere, so that n.v is between -r and r for the
 * vector v to its centre, (n.v + r) / 2 replaces n.v: it is continuous at r, and 0 at -r. Single precision, because
 * weights need not be exact. */
static void light_weights(const lamp_table *restrict lamps, vec3 point, vec3 n, float k_d, float k_s, float least,
                          float *restrict weight)
{
    const float nx = (float)n.x, ny = (float)n.y, nz = (float)n.z;
    const int count = lamps->blocks * LAMP_BLOCK;
    /* VECTORISE */
    for (int k = 0; k < count; k++) {
        const float x = (float)(lamps->x[k] - point.x), y = (float)(lamps->y[k] - point.y),
                    z = (float)(lamps->z[k] - point.z), r = lamps->radius[k];
        const float above = nx * x + ny * y + nz * z, cut = 0.5f * (above + r), height = above < r ? cut : above,
                    distance2 = x * x + y * y + z * z, inverse = 1.0f / sqrtf(distance2);
        const float falloff = lamps->falling[k] * inverse * inverse + lamps->even[k];
        const float seen = lamps->strength[k] * falloff * (k_d * (height * inverse) + k_s);
        weight[k] = height > least ? seen : 0.0f;
    }
}

const sampling_kernels KERNEL(sampling_kernels) = {draw_each,   camera_directions, camera_rays,     cosine,
                                                   spheres,     sphere_light,      choose_branches, leave_matte,
                                                   near_sphere, light_weights};
