/* The photon map, a tree over photons in Morton order, eight to a leaf and eight children to a node; and the
 * irradiance that its photons give a point, or a sample of the image. */
#include "render/photons/photon_map.h"

#include "base/array.h"
#include "base/cancel.h"
#include "base/status.h"
#include <stdlib.h>
#include <string.h>

bool photon_list_add(photon_list *l, const photon *one)
{
    if (!GROW(l->list, l->room, l->count + 1))
        return false;
    l->list[l->count++] = *one;
    return true;
}

static bool of_one_wavelength(const photon_map *m)
{
    for (size_t i = 1; i < m->count; i++)
        if (m->photons[i].wavelength != m->photons->wavelength)
            return false;
    return true;
}

status photon_map_create(const photon_list *lists, size_t count, photon_map **out, diagnostic *why)
{
    const size_t n = photon_lists_total(lists, count);
    photon_map *m = calloc(1, sizeof *m);
    *out = NULL;
    if (m) {
        m->count = n;
        m->photons = large_calloc(n + 1, sizeof *m->photons);
    }
    if (!m || !m->photons || !photon_order(lists, count, m->photons) || !photon_tree_make(m) ||
        !photon_tree_fit(m, false))
        goto failed;
    if (of_one_wavelength(m) && !(m->sums = photon_sums_make(m)))
        goto failed;
    *out = m;
    return STATUS_OK;
failed:
    photon_map_destroy(m);
    return cancelled_or_out_of_memory(why);
}

void photon_map_destroy(photon_map *m)
{
    if (!m)
        return;
    for (int k = 0; k < PHOTON_LEVELS_MAX; k++)
        free(m->level[k]), free(m->group[k]);
    photon_sums_free(m->sums);
    free(m->photons);
    free(m);
}

size_t photon_map_count(const photon_map *m)
{
    return m->count;
}

const photon *photon_map_at(const photon_map *m, size_t i)
{
    return &m->photons[i];
}

/* Bytes per photon: in a list, as a sort key, in the map, and its part of the tree. */
size_t photon_map_bytes(void)
{
    return 3 * sizeof(photon) + 2 * sizeof(void *) +
           (sizeof(photon_box) + sizeof(photon_group) + photon_sums_bytes()) / 7;
}

/* --- footprints --- */

/* The light of a photon in a sample of the image, if the photon's disc is not much wider than the sample's cell.
 *
 * A disc that is evaluated at points keeps its power only on average: the sum over a lattice of points with spacing 1
 * of a density of integral 1 is the sum of its Fourier transform over the integer frequencies (Poisson), which is 1
 * only if all but the transform at 0 vanish. So such a photon's light is a product of two densities in the image's
 * directions, x and y, and a sample sees their mean over its cell, whose width is 1. A mean over the cell multiplies
 * the transform by sin(pi f) / (pi f), which is 0 at all other integers: whatever the width and the position of the
 * density, the sum over all samples is 1. It is also the value that many samples in the cell would give.
 *
 * In each direction the density is the biweight (15 / 16) (1 - x^2)^2, whose variance is 1/7 of its half width squared;
 * a disc's is 1/8 of its radius squared. With a half width of sqrt(7/8) radii both blur equally, and are equally noisy.
 *
 * A photon's position in the image is that of the neighbouring ray that passes through the photon: exact for rays
 * through one point and for parallel rays, also after flat mirrors; else to first order. */

/* Half widths of the densities, in radii. */
#define HALF_WIDTH 0.93541434669348533
/* The greatest ratio of length to width of a footprint on the surface; beyond it, the surface is seen edge-on. */
#define LONGEST 64.0
/* Safety factor of bounds, for footprints at other points of the surface than the hit. */
#define MARGIN 1.1

/* The integral of the biweight from its middle to x. It compares by itself, because fmax and fmin are calls. */
static double within(double x)
{
    const double up = x > -1.0 ? x : -1.0, t = up < 1.0 ? up : 1.0, t2 = t * t;
    return t * (0.9375 + t2 * (-0.625 + t2 * 0.1875));
}

/* The mean over the cell around x of the density with that half width. */
static double cell_mean(double x, double half_width)
{
    return within((x + 0.5) / half_width) - within((x - 0.5) / half_width);
}

static double larger(double a, double b)
{
    return a > b ? a : b;
}

/* Where a neighbour's ray in direction d, displaced by v, meets the surface; cosine: -n.d. */
static vec3 on_surface(vec3 v, vec3 d, vec3 n, double cosine)
{
    return vec3_add(v, vec3_scale(d, vec3_dot(v, n) / cosine));
}

/* The square of the length of the vector that on_surface returns. */
static double length2_on_surface(vec3 v, vec3 d, vec3 n, double cosine)
{
    const double times = vec3_dot(v, n) / cosine;
    return vec3_dot(v, v) + times * (2.0 * vec3_dot(v, d) + times * vec3_dot(d, d));
}

/* The region in which photons contribute to the ray's sample, on a surface with that normal. */
static photon_reach footprint_reach(const photon_footprint *f, vec3 normal)
{
    const double cosine = -vec3_dot(f->toward, normal);
    const vec3 a = on_surface(f->across[0], f->toward, normal, cosine),
               b = on_surface(f->across[1], f->toward, normal, cosine);
    const double length = vec3_length(a), width = vec3_length(b), most = fmax(length, width),
                 area = vec3_length(vec3_cross(a, b));
    photon_reach r = {.known = cosine > 0.0 && area * LONGEST > most * most};
    if (!r.known)
        return r;
    /* the corner of both densities of the widest disc, by the law of cosines */
    const double corner = sqrt(2.0 + 2.0 * fabs(vec3_dot(a, b)) / (length * width));
    r.beyond = (MARGIN * corner * (HALF_WIDTH * PHOTON_RESOLVED + 0.5) - PHOTON_RESOLVED) * most;
    r.groups = r.beyond > f->reach;
    const vec3 x = vec3_cross(b, f->toward), y = vec3_cross(f->toward, a);
    r.slab[REACH_X] = vec3_scale(x, 1.0 / vec3_dot(x, a)), r.slab[REACH_Y] = vec3_scale(y, 1.0 / vec3_dot(y, b));
    r.slab[REACH_HEIGHT] = normal;
    r.within[REACH_X] = r.within[REACH_Y] = 0.5 + f->blur, r.within[REACH_HEIGHT] = 0.5 * most;
    for (int k = 0; k < REACH_SLABS; k++)
        r.within[k] *= MARGIN, r.length[k] = MARGIN * vec3_length(r.slab[k]);
    return r;
}

/* A photon in the image, in cells: its position relative to the ray's sample, the variance of its light in each
 * direction, and the radius of its disc in the direction in which cells are widest. */
typedef struct photon_place {
    double x, y, variance_x, variance_y, radius;
} photon_place;

/* The half width in cells of the density of a group of that radius. Its photons have discs of radius `disc`, whose half
 * widths are at least `blur`; variances add up. */
static double half_width(double radius, double disc, double cell, double blur)
{
    const double plain = HALF_WIDTH * radius / cell, disc_half_width = HALF_WIDTH * disc / cell;
    return disc_half_width >= blur ? plain : sqrt(blur * blur + (plain - disc_half_width) * (plain + disc_half_width));
}

/* The density per area with which a photon at point + off counts for the ray, of integral 1 over the photon's surface;
 * negative if it is wide enough to be evaluated only at the point. A group's photons have discs of radius `disc`. */
static double footprint_density(const photon_footprint *f, const photon *one, double disc, vec3 off,
                                photon_place *place)
{
    const vec3 n = vec3_make((double)one->normal[0], (double)one->normal[1], (double)one->normal[2]);
    const double r = (double)one->radius;
    const double further = vec3_dot(off, f->along);
    const vec3 a = vec3_add(f->across[0], vec3_scale(f->turn[0], further)),
               b = vec3_add(f->across[1], vec3_scale(f->turn[1], further));
    /* off = x a + y b + further toward */
    const vec3 across_x = vec3_cross(b, f->toward), across_y = vec3_cross(f->toward, a);
    const double volume = vec3_dot(a, across_x), x = vec3_dot(off, across_x) / volume,
                 y = vec3_dot(off, across_y) / volume;
    const vec3 d = vec3_add(f->toward, vec3_add(vec3_scale(f->turn[0], x), vec3_scale(f->turn[1], y)));
    const double cosine = -vec3_dot(d, n);
    if (!(cosine > 0.0))
        return 0.0;
    const double length2 = length2_on_surface(a, d, n, cosine), width2 = length2_on_surface(b, d, n, cosine);
    const double most2 = larger(length2, width2);
    if (r * r >= PHOTON_RESOLVED * PHOTON_RESOLVED * most2)
        return -1.0;
    const double most = sqrt(most2);
    if (fabs(vec3_dot(off, n)) > 0.5 * (r + most))
        return 0.0;
    const double hx = half_width(r, disc, sqrt(length2), f->blur);
    if (!(fabs(x) < 0.5 + hx))
        return 0.0;
    const double hy = half_width(r, disc, sqrt(width2), f->blur);
    if (!(fabs(y) < 0.5 + hy))
        return 0.0;
    *place = (photon_place){x, y, 1.0 / 12.0 + hx * hx / 7.0, 1.0 / 12.0 + hy * hy / 7.0, r / most};
    /* cells per area of the surface */
    return cell_mean(x, hx) * cell_mean(y, hy) * cosine / fabs(vec3_dot(d, vec3_cross(a, b)));
}

/* --- irradiance --- */

/* Photons of a spectral map contribute to wavelengths up to this distance from their own, in steps of 0.1 nm. */
#define BAND 250.0
#define RANGE 4000.0 /* number of wavelengths, over which photons are distributed uniformly */

typedef struct irradiance_sum {
    vec3 point, normal, sum;
    int wavelength;
    const photon_footprint *footprint; /* or NULL */
    photon_reach reach;                /* of the footprint */
    double *narrow;                    /* or NULL */
    /* light, and its moments over the photons' positions in units of their standard deviations */
    double all, x, y, xx, yy, xy;
} irradiance_sum;

/* The density of a photon's disc at an offset from its centre: (3 / (pi r^2)) (1 - d^2 / r^2)^2, whose integral is 1
 * (biweight kernel, Silverman, 4.2.1). 0 at points more than r / 2 above or below the disc: they are on another
 * surface. */
static double disc_density(const photon *one, vec3 off)
{
    const vec3 n = vec3_make((double)one->normal[0], (double)one->normal[1], (double)one->normal[2]);
    const double r = (double)one->radius, r2 = r * r, height = vec3_dot(off, n),
                 d2 = vec3_dot(off, off) - height * height;
    if (!(d2 < r2) || fabs(height) > 0.5 * r)
        return 0.0;
    const double fraction = 1.0 - d2 / r2;
    return fraction * fraction * (3.0 / (PHOTON_PI * r2));
}

/* The weight of a photon's light at a wavelength. */
static double wavelength_weight(const photon *one, int wavelength)
{
    if (wavelength < 0)
        return 1.0;
    if (one->wavelength < 0)
        return one->wavelength == photon_of_line(wavelength) ? RANGE : 0.0;
    const double away = fabs((double)(wavelength - one->wavelength)) / BAND;
    return away < 1.0 ? (1.0 - away) * (RANGE / BAND) : 0.0;
}

/* The radius of a disc, in cells of samples, from which the sum over samples varies by less than 1 %; from
 * PHOTON_RESOLVED on, by less than 0.1 %. */
#define SAMPLED 2.5

/* The smallest integer factor below PHOTON_FACTORS that makes `cells` at least SAMPLED; 0 if there is none. */
static int factor_of(double cells)
{
    for (int k = 1; k < PHOTON_FACTORS; k++)
        if (cells * k >= SAMPLED)
            return k;
    return 0;
}

static void add_narrow(irradiance_sum *s, const photon_place *p, double light)
{
    const double x = p->x / sqrt(p->variance_x), y = p->y / sqrt(p->variance_y);
    s->narrow[factor_of(p->radius)] += light;
    s->all += light, s->x += light * x, s->y += light * y;
    s->xx += light * x * x, s->yy += light * y * y, s->xy += light * x * y;
}

/* Whether a disc of that radius can contribute at that offset. At a point, a disc contributes up to half its radius in
 * front of its plane and behind. */
static bool can_contribute(const irradiance_sum *s, vec3 off, double radius)
{
    if (!s->footprint)
        return vec3_dot(off, off) < 1.5 * radius * radius;
    const photon_reach *reach = &s->reach;
    for (int k = 0; k < REACH_SLABS; k++)
        if (fabs(vec3_dot(off, reach->slab[k])) > reach->within[k] + radius * reach->length[k])
            return false;
    return true;
}

/* Adds a photon's light at the point, unless the normals differ: then the photon is on another surface. */
static void add(const photon *one, double disc, void *context)
{
    irradiance_sum *s = context;
    const vec3 off = vec3_sub(s->point, one->position);
    const double r = (double)one->radius;
    if (!can_contribute(s, off, r))
        return;
    const vec3 n = vec3_make((double)one->normal[0], (double)one->normal[1], (double)one->normal[2]);
    if (vec3_dot(n, s->normal) < PHOTON_FACING)
        return;
    photon_place place = {.radius = PHOTON_RESOLVED};
    double fraction = s->footprint ? footprint_density(s->footprint, one, disc, vec3_scale(off, -1.0), &place) : -1.0;
    fraction = fraction < 0.0 ? disc_density(one, off) : fraction;
    fraction = fraction > 0.0 ? fraction * wavelength_weight(one, s->wavelength) : 0.0;
    if (!(fraction > 0.0))
        return;
    const vec3 light =
        vec3_make(fraction * (double)one->flux[0], fraction * (double)one->flux[1], fraction * (double)one->flux[2]);
    s->sum = vec3_add(s->sum, light);
    place.radius *= disc / r; /* a group's light is as narrow as its photons' */
    if (s->narrow)
        add_narrow(s, &place, light.x + light.y + light.z);
}

/* Light is not narrow, however narrow the photons' discs are, if it fills a good part of the window through which the
 * sample sees it: uniform light has a variance of 1 in each direction, half a window about 1/3, and a rim a fifth as
 * wide about SPREAD. */
#define SPREAD 0.05

static bool is_spread(const irradiance_sum *s)
{
    const double x = s->x / s->all, y = s->y / s->all, a = s->xx / s->all - x * x, b = s->yy / s->all - y * y,
                 c = s->xy / s->all - x * y;
    const double least =
        0.5 * (a + b - sqrt((a - b) * (a - b) + 4.0 * c * c)); /* the least variance of any direction */
    return least >= SPREAD;
}

vec3 photon_map_irradiance(const photon_map *m, vec3 point, vec3 normal, int wavelength)
{
    irradiance_sum s = {.point = point, .normal = normal, .wavelength = wavelength};
    photon_tree_around(m, point, NULL, add, &s);
    return s.sum;
}

vec3 photon_map_seen(const photon_map *m, vec3 point, vec3 normal, int wavelength, const photon_footprint *f,
                     double *narrow)
{
    irradiance_sum s = {.point = point, .normal = normal, .wavelength = wavelength, .footprint = f, .narrow = narrow};
    s.reach = footprint_reach(f, normal);
    for (int k = 0; narrow && k < PHOTON_FACTORS; k++)
        narrow[k] = 0.0;
    if (!s.reach.known)
        s.footprint = NULL, s.narrow = NULL;
    photon_tree_around(m, point, s.reach.known ? &s.reach : NULL, add, &s);
    if (s.narrow && s.all > 0.0 && is_spread(&s)) {
        for (int k = 0; k < PHOTON_FACTORS; k++)
            narrow[k] = 0.0;
        narrow[1] = s.all;
    }
    return s.sum;
}
