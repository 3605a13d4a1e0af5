/* Measured data by wavelength (optical_data.h). */
#include "optics/optical_data.h"

#include "base/hash.h"
#include "optics/spectrum.h"
#include <math.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

struct optical_data {
    atomic_int holders;
    bool has_law;
    dispersion law;
    size_t count[2]; /* points of the first and the second curve */
    double point[];  /* both, one after the other */
};

static optical_data *writable(const optical_data *d)
{
    return (optical_data *)(uintptr_t)d; /* of a shared value only the count of its holders changes */
}

void optical_data_retain(const optical_data *d)
{
    atomic_fetch_add_explicit(&writable(d)->holders, 1, memory_order_relaxed);
}

void optical_data_release(const optical_data *d)
{
    if (d && atomic_fetch_sub_explicit(&writable(d)->holders, 1, memory_order_acq_rel) == 1)
        free(writable(d));
}

static const double *second(const optical_data *d)
{
    return d->point + 2 * d->count[0];
}

bool optical_data_has_first(const optical_data *d)
{
    return d->has_law || d->count[0] > 0;
}

void optical_data_range(const optical_data *d, double *low_nm, double *high_nm)
{
    const double *of = optical_data_has_first(d) ? d->point : second(d);
    const size_t count = d->count[optical_data_has_first(d) ? 0 : 1];
    *low_nm = d->has_law ? d->law.low_nm : of[0];
    *high_nm = d->has_law ? d->law.high_nm : of[2 * count - 2];
}

const dispersion *optical_data_law(const optical_data *d)
{
    return d->has_law ? &d->law : NULL;
}

size_t optical_data_points(const optical_data *d, bool of_k)
{
    return d->count[of_k];
}

double optical_data_at(const optical_data *d, double lambda_nm)
{
    if (d->has_law)
        return dispersion_index(&d->law, fmin(fmax(lambda_nm, d->law.low_nm), d->law.high_nm));
    return curve_at(d->point, d->count[0], lambda_nm);
}

double optical_data_k(const optical_data *d, double lambda_nm)
{
    return d->count[1] > 0 ? curve_at(second(d), d->count[1], lambda_nm) : 0.0;
}

bool optical_data_has_k(const optical_data *d)
{
    bool any = false;
    for (size_t i = 0; i < d->count[1]; i++)
        any |= second(d)[2 * i + 1] > 0.0;
    return any;
}

void optical_data_extremes(const optical_data *d, double *least, double *most)
{
    if (d->has_law) {
        const double a = optical_data_at(d, d->law.low_nm), b = optical_data_at(d, d->law.high_nm);
        *least = fmin(a, b), *most = fmax(a, b);
        return;
    }
    *least = (double)INFINITY, *most = -(double)INFINITY;
    for (size_t i = 0; i < d->count[0]; i++)
        *least = fmin(*least, d->point[2 * i + 1]), *most = fmax(*most, d->point[2 * i + 1]);
}

double optical_data_fraction(const void *d, double lambda_nm)
{
    return fmin(fmax(optical_data_at(d, lambda_nm), 0.0), 1.0);
}

double optical_data_emission(const void *d, double lambda_nm)
{
    double low_nm, high_nm;
    optical_data_range(d, &low_nm, &high_nm);
    return low_nm <= lambda_nm && lambda_nm <= high_nm ? fmax(optical_data_at(d, lambda_nm), 0.0) : 0.0;
}

double optical_data_coefficient(const void *d, double lambda_nm)
{
    return fmax(optical_data_at(d, lambda_nm), 0.0);
}

static double in_daylight(const void *d, double lambda_nm)
{
    return observer_d65(lambda_nm) * (d ? optical_data_fraction(d, lambda_nm) : 1.0);
}

/* Relative to the sums for white, so that a constant is grey. */
void optical_data_rgb(const optical_data *d, double rgb[3])
{
    double xyz[3], of_white[3], white[3];
    spectrum_xyz(in_daylight, d, xyz);
    spectrum_xyz(in_daylight, NULL, of_white);
    linear_srgb_to_xyz((const double[3]){1.0, 1.0, 1.0}, white);
    for (int c = 0; c < 3; c++)
        xyz[c] *= white[c] / of_white[c];
    xyz_to_linear_srgb(xyz, rgb);
    for (int c = 0; c < 3; c++)
        rgb[c] = fmin(fmax(rgb[c], 0.0), 1.0);
}

/* --- checks --- */

static status check_curve(optical_curve c, bool is_k, diagnostic *why)
{
    for (size_t i = 0; i < c.count; i++) {
        const double lambda_nm = c.point[2 * i], value = c.point[2 * i + 1];
        if (!(lambda_nm > (i > 0 ? c.point[2 * i - 2] : 0.0)) || !isfinite(lambda_nm))
            return diagnose(why, STATUS_BAD_INPUT, "give each wavelength once, above 0",
                            "it has %.10g nm after %.10g nm", lambda_nm, i > 0 ? c.point[2 * i - 2] : 0.0);
        if (!isfinite(value) || (is_k && value < 0.0))
            return diagnose(why, STATUS_BAD_INPUT,
                            is_k ? "give an extinction index that is not negative" : "give numbers",
                            "the %s at %.10g nm is %g", is_k ? "extinction index k" : "value", lambda_nm, value);
    }
    return STATUS_OK;
}

static status create(const dispersion *law, optical_curve first, optical_curve last, const optical_data **out,
                     diagnostic *why)
{
    const size_t points = (law ? 0 : first.count) + last.count;
    optical_data *made = calloc(1, sizeof *made + 2 * points * sizeof *made->point);
    if (!made)
        return out_of_memory(why);
    atomic_init(&made->holders, 1);
    made->has_law = law != NULL;
    if (law)
        made->law = *law;
    made->count[0] = law ? 0 : first.count;
    made->count[1] = last.count;
    if (made->count[0] > 0)
        memcpy(made->point, first.point, 2 * first.count * sizeof *made->point);
    if (last.count > 0)
        memcpy(made->point + 2 * made->count[0], last.point, 2 * last.count * sizeof *made->point);
    *out = made;
    return STATUS_OK;
}

status optical_data_create(const dispersion *law, optical_curve first, optical_curve last, const optical_data **out,
                           diagnostic *why)
{
    *out = NULL;
    if (!law && first.count == 0 && last.count == 0)
        return diagnose(why, STATUS_BAD_INPUT, "give at least one wavelength with its value", "it has no data");
    TRY(check_curve(first, false, why));
    TRY(check_curve(last, true, why));
    if (law)
        TRY(dispersion_check_range(law, why));
    return create(law, first, last, out, why);
}

/* --- hash and package --- */

typedef struct data_record {
    int64_t kind, terms; /* kind -1: no law */
    double coefficient[DISPERSION_TERMS_MAX], low_nm, high_nm;
    uint64_t count[2];
} data_record;
_Static_assert(sizeof(data_record) == (6 + DISPERSION_TERMS_MAX) * 8, "no padding");

static data_record record_of(const optical_data *d)
{
    data_record r = {.kind = -1, .count = {d->count[0], d->count[1]}};
    if (!d->has_law)
        return r;
    r.kind = (int64_t)d->law.kind, r.terms = d->law.count;
    memcpy(r.coefficient, d->law.coefficient, sizeof r.coefficient);
    r.low_nm = d->law.low_nm, r.high_nm = d->law.high_nm;
    return r;
}

uint64_t optical_data_hash(const optical_data *d, uint64_t hash)
{
    const data_record r = record_of(d);
    hash = hash_numbers(hash, &r, sizeof r / 8, 8);
    return hash_numbers(hash, d->point, 2 * (d->count[0] + d->count[1]), sizeof *d->point);
}

status optical_data_pack(const optical_data *d, pack_writer *to, diagnostic *why)
{
    const data_record r = record_of(d);
    TRY(pack_put(to, &r, sizeof r, why));
    return pack_put(to, d->point, 2 * (d->count[0] + d->count[1]) * sizeof *d->point, why);
}

static bool is_record(const data_record *r, const pack_reader *from)
{
    return r->kind >= -1 && r->kind < DISPERSION_KIND_COUNT && r->terms >= 0 && r->terms <= DISPERSION_TERMS_MAX &&
           r->count[0] <= SIZE_MAX / 64 && r->count[1] <= SIZE_MAX / 64 &&
           pack_holds(from, r->count[0] + r->count[1], 2 * sizeof(double));
}

status optical_data_unpack(pack_reader *from, const optical_data **out, diagnostic *why)
{
    data_record r;
    *out = NULL;
    TRY(pack_get(from, &r, sizeof r, why));
    if (!is_record(&r, from))
        return pack_damaged(why, "the size of optical data");
    const size_t first = (size_t)r.count[0], last = (size_t)r.count[1];
    double *points = malloc(2 * (first + last) * sizeof *points + 1);
    if (!points)
        return out_of_memory(why);
    dispersion law = {.kind = (dispersion_kind)(r.kind < 0 ? 0 : r.kind),
                      .count = (int)r.terms,
                      .low_nm = r.low_nm,
                      .high_nm = r.high_nm};
    memcpy(law.coefficient, r.coefficient, sizeof law.coefficient);
    status code = pack_get(from, points, 2 * (first + last) * sizeof *points, why);
    if (code == STATUS_OK && ((r.kind >= 0 && dispersion_check_numbers(&law, NULL) != STATUS_OK) ||
                              optical_data_create(r.kind >= 0 ? &law : NULL, (optical_curve){points, first},
                                                  (optical_curve){points + 2 * first, last}, out, NULL) != STATUS_OK))
        code = pack_damaged(why, "optical data");
    free(points);
    return code;
}
