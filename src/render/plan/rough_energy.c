/* The light that a single scattering by facets of a rough surface loses, in tables, and its redistribution. */
#include "render/plan/rough_energy.h"

#include "base/array.h"
#include "base/lanes.h"
#include "optics/interface.h"
#include "optics/microfacet.h"
#include <stdlib.h>

/* Facets per direction, a grid over both sample coordinates; half a turn suffices, since the scattered light is
 * symmetric about the plane of incidence. */
enum { ACROSS = 64, AROUND = 64 };
#define LEAST_COSINE 1e-9
/* Stands for a ratio of indices of 1, at which light is not deflected and has no density. */
#define LEAST_RATIO 1.0005

/* --- tables --- */

/* The fraction of the light from i on the facet m that leaves the surface at once. */
static double sent_by_facet(const rough_finish *finish, const double index[2], int side, vec3 i, vec3 m)
{
    const double i_m = vec3_dot(i, m);
    const vec3 mirrored = vec3_sub(vec3_scale(m, 2.0 * i_m), i);
    const fresnel f = fresnel_dielectric(lesser(i_m, 1.0), index[side], index[1 - side]);
    const double R = finish->opaque ? 1.0 : f.R + (1.0 - f.R) * finish->reflectivity;
    double sent = mirrored.z > 0.0 ? R * ggx_masking(finish->alpha, mirrored) : 0.0;
    if (finish->opaque || f.total)
        return sent;
    const vec3 refracted = direction_refract(vec3_scale(i, -1.0), m, i_m, f.eta, f.cos_t);
    if (refracted.z < 0.0)
        sent += (1.0 - R) * ggx_masking(finish->alpha, refracted);
    return sent;
}

/* The fraction of light at a cosine that one facet loses, by the midpoint rule over s and v. u = 3 s^2 - 2 s^3, du = 6
 * s (1 - s) ds, puts more points on steep facets, which are rarely drawn. */
static double lost_at(const rough_finish *finish, const double index[2], int side, double cosine)
{
    const vec3 i = vec3_make(sqrt(1.0 - cosine * cosine), 0.0, cosine);
    double sum = 0.0;
    for (int a = 0; a < ACROSS; a++) {
        const double s = (a + 0.5) / ACROSS, u = s * s * (3.0 - 2.0 * s), weight = 6.0 * s * (1.0 - s);
        for (int b = 0; b < AROUND; b++) {
            const vec3 m = ggx_sample_normal(finish->alpha, i, u, 0.25 + 0.5 * ((b + 0.5) / AROUND));
            sum += weight * sent_by_facet(finish, index, side, i, m);
        }
    }
    return lesser(greater(1.0 - sum / (ACROSS * AROUND), 0.0), 1.0);
}

/* A node's weight in twice the integral over cosines of a value times cosine: Simpson's rule over x = sqrt(cosine), 4
 * x^3 dx. */
static double weight_of(int step)
{
    const double x = (double)step / ENERGY_STEPS, simpson = step == 0 || step == ENERGY_STEPS ? 1.0
                                                            : step % 2                        ? 4.0
                                                                                              : 2.0;
    return simpson * 4.0 * x * x * x / (3.0 * ENERGY_STEPS);
}

static void fill_table(const rough_finish *finish, double ratio, energy_table *out)
{
    const double index[2] = {1.0, ratio};
    for (int side = 0; side < (finish->opaque ? 1 : 2); side++) {
        double mean = 0.0;
        for (int k = 0; k <= ENERGY_STEPS; k++) {
            const double x = (double)k / ENERGY_STEPS, cosine = greater(x * x, LEAST_COSINE);
            out->lost[side][k] = lost_at(finish, index, side, cosine);
            mean += weight_of(k) * out->lost[side][k];
        }
        out->mean[side] = mean;
    }
    out->passed = 0.0;
    for (int k = 1; k <= ENERGY_STEPS; k++) {
        const double x = (double)k / ENERGY_STEPS, R = fresnel_dielectric(x * x, 1.0, ratio).R;
        out->passed += weight_of(k) * (1.0 - R) * (1.0 - finish->reflectivity);
    }
}

bool rough_energy_add(rough_energy **all, double alpha, double reflectivity, bool opaque)
{
    if (!*all) {
        if (!(*all = calloc(1, sizeof **all)))
            return false;
        if (pthread_mutex_init(&(*all)->filling, NULL) != 0) {
            free(*all);
            *all = NULL;
            return false;
        }
    }
    if (rough_energy_find(*all, alpha, reflectivity, opaque))
        return true;
    rough_energy *e = *all;
    energy_table *tables = calloc(opaque ? 1 : ENERGY_RATIOS, sizeof *tables);
    if (!tables || !GROW(e->finishes, e->room, (size_t)e->count + 1)) {
        free(tables);
        return false;
    }
    e->finishes[e->count++] = (rough_finish){alpha, reflectivity, opaque, tables};
    return true;
}

void rough_energy_destroy(rough_energy *all)
{
    if (!all)
        return;
    for (int i = 0; i < all->count; i++)
        free(all->finishes[i].tables);
    free(all->finishes);
    pthread_mutex_destroy(&all->filling);
    free(all);
}

const rough_finish *rough_energy_find(const rough_energy *all, double alpha, double reflectivity, bool opaque)
{
    for (int i = 0; i < all->count; i++) {
        const rough_finish *f = &all->finishes[i];
        if (f->alpha == alpha && f->reflectivity == reflectivity && f->opaque == opaque)
            return f;
    }
    return NULL;
}

static double ratio_of(int number)
{
    return number == 0 ? LEAST_RATIO : elementary_exp2_inline((double)number / ENERGY_PER_OCTAVE);
}

static const energy_table *table(rough_energy *all, const rough_finish *finish, int number)
{
    energy_table *t = &finish->tables[number];
    if (atomic_load_explicit(&t->ready, memory_order_acquire))
        return t;
    pthread_mutex_lock(&all->filling);
    if (!atomic_load_explicit(&t->ready, memory_order_relaxed)) {
        fill_table(finish, ratio_of(number), t);
        atomic_store_explicit(&t->ready, true, memory_order_release);
    }
    pthread_mutex_unlock(&all->filling);
    return t;
}

/* --- at a point --- */

static double mixed(const facet_energy *e, double below, double above)
{
    return below + e->mix * (above - below);
}

/* Cubic through the four nearest nodes (Lagrange). */
static double lost_towards(const facet_energy *e, int side, double cosine)
{
    const double at = sqrt(lesser(cosine, 1.0)) * ENERGY_STEPS;
    int first = (int)at - 1;
    first = first < 0 ? 0 : first > ENERGY_STEPS - 3 ? ENERGY_STEPS - 3 : first;
    const double x = at - first, y = x - 1.0, z = x - 2.0, w = x - 3.0;
    const double weight[4] = {y * z * w / -6.0, x * z * w / 2.0, x * y * w / -2.0, x * y * z / 6.0};
    double below = 0.0, above = 0.0;
    for (int k = 0; k < 4; k++) {
        below += weight[k] * e->below->lost[side][first + k];
        above += weight[k] * e->above->lost[side][first + k];
    }
    return lesser(greater(mixed(e, below, above), 0.0), 1.0);
}

static double mean_of(const facet_energy *e, int side)
{
    return mixed(e, e->below->mean[side], e->above->mean[side]);
}

static facet_energy of_opaque(rough_energy *all, const rough_finish *finish, double cosine)
{
    const energy_table *table_used = table(all, finish, 0);
    facet_energy e = {
        .below = table_used, .above = table_used, .fraction = {1.0, 0.0}, .mean = 1.0 - table_used->mean[0]};
    e.lost = lost_towards(&e, 0, cosine);
    return e;
}

facet_energy facet_energy_at(rough_energy *all, const rough_finish *finish, double n_from, double n_to, double cosine)
{
    if (finish->opaque)
        return of_opaque(all, finish, cosine);
    const bool dense = n_from > n_to;
    const double ratio = dense ? n_from / n_to : n_to / n_from,
                 at = lesser(elementary_log2_inline(ratio) * ENERGY_PER_OCTAVE, ENERGY_RATIOS - 1.0);
    const int number = at < ENERGY_RATIOS - 2.0 ? (int)at : ENERGY_RATIOS - 2;
    facet_energy e = {.below = table(all, finish, number),
                      .above = table(all, finish, number + 1),
                      .mix = at - number,
                      .from = dense,
                      .to = !dense};
    const double mean_from = mean_of(&e, e.from), mean_to = mean_of(&e, e.to),
                 passed = mixed(&e, e.below->passed, e.above->passed) / (dense ? ratio * ratio : 1.0);
    e.lost = lost_towards(&e, e.from, cosine);
    e.fraction[1] = mean_from > 0.0 ? passed * lesser(1.0, mean_to / mean_from) : 0.0;
    e.fraction[0] = 1.0 - e.fraction[1];
    return e;
}

double facet_energy_towards(const facet_energy *e, bool refracted, double cosine)
{
    const int side = refracted ? e->to : e->from;
    const double mean = mean_of(e, side);
    return mean > 0.0 ? lost_towards(e, side, cosine) / mean : 0.0;
}

double facet_energy_kept(const facet_energy *e, double reflectance)
{
    return reflectance * reflectance * e->mean / (1.0 - reflectance * (1.0 - e->mean));
}
