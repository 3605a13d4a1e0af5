/* What a sample of the image sees of a photon whose disc is not much wider than its cell.
 *
 * A disc that is looked up at points keeps its power on average only: the sum over a lattice of points with spacing 1
 * of a density of integral 1 is the sum of its Fourier transform over the whole frequencies (Poisson), 1 only if all
 * others vanish. So such a photon's light is a product of two densities in the image's directions, x and y, and a
 * sample sees their mean over its cell, whose width is 1. A mean over the cell multiplies the transform by sin(pi f) /
 * (pi f), which is 0 at all whole frequencies: whatever the width and the place of the density, the sum over all
 * samples is 1. It is also the value that many samples in the cell would give.
 *
 * In each direction the density is the biweight (15 / 16) (1 - x^2)^2, whose variance is 1/7 of its half width squared,
 * that of a disc 1/8 of its radius squared; with a half width of sqrt(7/8) radii both blur alike, and are equally
 * noisy.
 *
 * A photon's place in the image is that of the ray among the neighbours of the given one that passes the photon: exact
 * for rays through one point and for parallel ones, also after flat mirrors, else to first order. */
#include "render/caustics/photon_tree.h"

/* Half widths of the densities, in radii. */
#define HALF_WIDTH 0.93541434669348533
/* Of a footprint on the surface, length over width: beyond, surfaces are seen edge on. */
#define LONGEST 64.0
/* Bounds of footprints at other points of the surface than the hit. */
#define MARGIN 1.1

/* The integral of the biweight from its middle to x. */
static double within(double x)
{
    const double t = fmin(fmax(x, -1.0), 1.0), t2 = t * t;
    return t * (0.9375 + t2 * (-0.625 + t2 * 0.1875));
}

/* The mean over the cell around x of the density with that half width. */
static double cell_mean(double x, double half_width)
{
    return within((x + 0.5) / half_width) - within((x - 0.5) / half_width);
}

/* Where a neighbour's ray in direction d, displaced by v, meets the surface; cosine: -n.d. */
static vec3 on_surface(vec3 v, vec3 d, vec3 n, double cosine)
{
    return vec3_add(v, vec3_scale(d, vec3_dot(v, n) / cosine));
}

/* The length of that. */
static double length_on_surface(vec3 v, vec3 d, vec3 n, double cosine)
{
    const double times = vec3_dot(v, n) / cosine;
    return sqrt(vec3_dot(v, v) + times * (2.0 * vec3_dot(v, d) + times * vec3_dot(d, d)));
}

photon_reach photon_footprint_reach(const photon_footprint *f, vec3 normal)
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
    r.within[REACH_X] = r.within[REACH_Y] = 0.5, r.within[REACH_HEIGHT] = 0.5 * most;
    for (int k = 0; k < REACH_SLABS; k++)
        r.within[k] *= MARGIN, r.length[k] = MARGIN * vec3_length(r.slab[k]);
    return r;
}

double photon_footprint_density(const photon_footprint *f, const photon *one, vec3 off, photon_place *place)
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
    const double length = length_on_surface(a, d, n, cosine), width = length_on_surface(b, d, n, cosine);
    const double hx = HALF_WIDTH * r / length, hy = HALF_WIDTH * r / width;
    *place = (photon_place){x, y, 1.0 / 12.0 + hx * hx / 7.0, 1.0 / 12.0 + hy * hy / 7.0, r / fmax(length, width)};
    if (place->radius >= PHOTON_RESOLVED)
        return -1.0;
    if (!(fabs(x) < 0.5 + hx && fabs(y) < 0.5 + hy) || fabs(vec3_dot(off, n)) > 0.5 * (r + fmax(length, width)))
        return 0.0;
    /* cells per area of the surface */
    return cell_mean(x, hx) * cell_mean(y, hy) * cosine / fabs(vec3_dot(d, vec3_cross(a, b)));
}
