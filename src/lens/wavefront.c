/* Wavefronts of one field, and what diffraction makes of them: the Strehl ratio, the MTF and the point image.
 *
 * Rays are aimed so that they sample the cosines of direction at the image uniformly: the pupil of the diffraction
 * integral in its Debye form, in which a ray with the optical path W and the direction d adds exp(2 pi i (n (d - d0)
 * . x / lambda - W)) at x (Born and Wolf, Principles of Optics, ch. 8). Samples at the pupil's edge have the part of
 * their cell that lies within the stop. The point image is the square of this sum's transform, by KissFFT in single
 * precision (2^-24; errors below 1e-5 of the peak); the MTF is the transform of its line images, which the padding to
 * twice the pupil makes exact for the samples. */
#include "lens/lens_private.h"

#include "base/cancel.h"
#include <kissfft/kiss_fftnd.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The samples of a pupil, n x n, row by row. */
typedef struct pupil {
    int n;
    double step;           /* of the cosines, between samples */
    double centre[2];      /* cosines at the middle */
    double *cover, *waves; /* part of the cell that passes; OPD */
} pupil;

/* Cosines along the field's direction and across. */
static void cosines_of(const lens_beam *bundle, const lens_ray *r, double at[2])
{
    at[0] = r->direction.x * bundle->t[0] + r->direction.y * bundle->t[1];
    at[1] = r->direction.y * bundle->t[0] - r->direction.x * bundle->t[1];
}

/* The pupil's extent in cosines, from rays along the stop's edge, or as near to it as they pass. */
static status pupil_extent(lens_beam *bundle, pupil *out, bool *any, diagnostic *why)
{
    enum { AROUND = 24, INWARDS = 10 };
    double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
    for (int i = 0; i < AROUND; i++) {
        const double angle = 2.0 * M_PI * i / AROUND;
        lens_ray r = {.loss = LENS_LOST};
        double p = 1.0, at[2];
        for (int k = 0; k < INWARDS && r.loss != LENS_PASSES; k++) {
            p = 1.0 - 0.05 * k;
            TRY(lens_beam_ray(bundle, p * cos(angle), p * sin(angle), NULL, &r, why));
        }
        if (r.loss != LENS_PASSES)
            continue;
        cosines_of(bundle, &r, at);
        for (int k = 0; k < 2; k++)
            low[k] = fmin(low[k], at[k]), high[k] = fmax(high[k], at[k]);
    }
    const double size = fmax(high[0] - low[0], high[1] - low[1]);
    out->step = size / (out->n - 3); /* more than a sample beyond each edge */
    out->centre[0] = 0.5 * (low[0] + high[0]), out->centre[1] = 0.5 * (low[1] + high[1]);
    *any = size > 1e-12;
    return STATUS_OK;
}

/* The part of a sample's cell within the stop, whose edge is straight within a cell. per_cosine: the stop's coordinates
 * by the cosines. */
static double cover_of(const lens_beam *bundle, const lens_ray *r, const double per_cosine[4], double step)
{
    const double rho = hypot(r->stop_x, r->stop_y), R = bundle->stop_radius;
    if (!(rho > 0.5 * R))
        return 1.0;
    const double x = r->stop_x / rho, y = r->stop_y / rho;
    const double width = step * hypot(x * per_cosine[0] + y * per_cosine[2], x * per_cosine[1] + y * per_cosine[3]);
    return fmin(1.0, fmax(0.0, 0.5 + (R - rho) / width));
}

/* a b^-1 of two matrices. */
static void divide(const double a[4], const double b[4], double out[4])
{
    const double det = b[0] * b[3] - b[1] * b[2];
    out[0] = (a[0] * b[3] - a[1] * b[2]) / det, out[1] = (a[1] * b[0] - a[0] * b[1]) / det;
    out[2] = (a[2] * b[3] - a[3] * b[2]) / det, out[3] = (a[3] * b[0] - a[2] * b[1]) / det;
}

static status pupil_trace(const lens_study *s, lens_beam *bundle, pupil *out, diagnostic *why)
{
    const double unit[4] = {1.0, 0.0, 0.0, 1.0};
    double per_cosine[4], launch_per[4];
    divide(bundle->per, bundle->cosines_per, per_cosine);
    divide(unit, bundle->cosines_per, launch_per);
    for (int j = 0; j < out->n; j++) {
        lens_row_launch row = {.count = 0};
        for (int i = 0; i < out->n; i++) {
            const double target[2] = {out->centre[0] + (j - 0.5 * (out->n - 1)) * out->step,
                                      out->centre[1] + (i - 0.5 * (out->n - 1)) * out->step};
            const double off[2] = {target[0] - bundle->base_cosines[0], target[1] - bundle->base_cosines[1]};
            double launch[2];
            lens_ray r;
            TRY(cancel_check(why));
            for (int k = 0; k < 2; k++)
                launch[k] = bundle->base[k] + launch_per[2 * k] * off[0] + launch_per[2 * k + 1] * off[1];
            lens_row_guess(&row, launch);
            TRY(lens_beam_cosines(bundle, target, 1e-6 * out->step, launch, &r, why));
            const bool passes = r.loss == LENS_PASSES;
            lens_row_add(&row, passes, launch);
            out->cover[j * out->n + i] = passes ? cover_of(bundle, &r, per_cosine, out->step) : 0.0;
            out->waves[j * out->n + i] = passes ? lens_opd(bundle, &s->first, &r) : 0.0;
        }
    }
    return STATUS_OK;
}

/* --- the wavefront --- */

typedef struct wave_sum {
    double cover, mean, square, low, high;
    int samples;
} wave_sum;

static wave_sum sum_waves(const pupil *p)
{
    wave_sum sum = {.low = INFINITY, .high = -INFINITY};
    for (int i = 0; i < p->n * p->n; i++) {
        const double c = p->cover[i], w = p->waves[i];
        sum.cover += c, sum.mean += c * w, sum.square += c * w * w;
        if (c > 0.0)
            sum.samples++;
        if (c >= 0.5)
            sum.low = fmin(sum.low, w), sum.high = fmax(sum.high, w);
    }
    sum.mean /= sum.cover;
    sum.square = sqrt(fmax(0.0, sum.square / sum.cover - sum.mean * sum.mean));
    return sum;
}

/* The intensity at x (mm, along and across the field's direction) from the chief ray's image, as a part of the peak
 * without aberrations; scale: n / lambda, 1 / mm. */
static double intensity_at(const pupil *p, double cover, double scale, double x, double y)
{
    double re = 0.0, im = 0.0;
    for (int j = 0; j < p->n; j++)
        for (int i = 0; i < p->n; i++) {
            const double c = p->cover[j * p->n + i];
            if (c == 0.0)
                continue;
            const double turns = scale * p->step * (j * x + i * y) - p->waves[j * p->n + i];
            re += c * cos(2.0 * M_PI * turns), im += c * sin(2.0 * M_PI * turns);
        }
    return (re * re + im * im) / (cover * cover);
}

/* The peak near a point, by parabolas along both axes in turn. */
static double peak_near(const pupil *p, double cover, double scale, double at[2], double h)
{
    double best = intensity_at(p, cover, scale, at[0], at[1]);
    for (int i = 0; i < 8; i++, h *= i % 2 ? 1.0 : 0.5) {
        const int k = i % 2;
        double to[2] = {at[0], at[1]};
        to[k] = at[k] - h;
        const double low = intensity_at(p, cover, scale, to[0], to[1]);
        to[k] = at[k] + h;
        const double high = intensity_at(p, cover, scale, to[0], to[1]), bend = low - 2.0 * best + high;
        to[k] = at[k] + (bend < 0.0 ? 0.5 * h * (low - high) / bend : 0.0);
        const double now = intensity_at(p, cover, scale, to[0], to[1]);
        if (now > best)
            best = now, at[k] = to[k];
    }
    return best;
}

/* --- the point image --- */

/* The intensity on a grid of 4 n x 4 n points, `spacing` mm apart, with the chief ray's image at its first; NULL when
 * out of memory. */
static float *point_image(const pupil *p, double cover)
{
    const int wide = 4 * p->n, dims[2] = {wide, wide};
    const size_t count = (size_t)wide * (size_t)wide;
    kiss_fft_cpx *in = calloc(count, sizeof *in), *out = calloc(count, sizeof *out);
    float *intensity = calloc(count, sizeof *intensity);
    kiss_fftnd_cfg plan = kiss_fftnd_alloc(dims, 2, 1, NULL, NULL);
    const bool good = in && out && intensity && plan;
    for (int i = 0; good && i < p->n * p->n; i++) {
        kiss_fft_cpx *at = &in[(i / p->n) * wide + i % p->n];
        at->r = (float)(p->cover[i] / cover * cos(2.0 * M_PI * p->waves[i]));
        at->i = (float)(-p->cover[i] / cover * sin(2.0 * M_PI * p->waves[i]));
    }
    if (good)
        kiss_fftnd(plan, in, out);
    for (size_t i = 0; good && i < count; i++)
        intensity[i] = out[i].r * out[i].r + out[i].i * out[i].i;
    kiss_fft_free(plan);
    free(in);
    free(out);
    if (!good)
        free(intensity);
    return good ? intensity : NULL;
}

static void put(lens_report *out, lens_row key, const char *quantity, const char *unit, double value)
{
    key.quantity = quantity, key.unit = unit, key.value = value;
    lens_row_put(out, key);
}

/* Encircled energy, within circles about the centroid of the point image; a circle's edge divides the cells of the
 * grid that it crosses. lost: what the parts of cells at the pupil's edge lack of their light, as amplitudes. */
static void put_encircled(lens_study *s, lens_row key, const float *intensity, int wide, double spacing, double lost)
{
    enum { RADII = 20 };
    double within[RADII + 1] = {0.0}, all = 0.0, x = 0.0, y = 0.0;
    const double most = 4.0 * 1.2196698912665045 * key.lambda_nm * 1e-6 * s->first.working_number;
    for (int pass = 0; pass < 2; pass++) {
        if (pass == 1)
            x /= all, y /= all;
        for (int i = 0; i < wide * wide; i++) {
            const int j = i / wide, k = i % wide;
            const double px = (j < wide / 2 ? j : j - wide) * spacing, py = (k < wide / 2 ? k : k - wide) * spacing;
            const double part = (double)intensity[i], r = hypot(px - x, py - y);
            if (pass == 0)
                all += part, x += part * px, y += part * py;
            for (int q = 1; q <= RADII && pass == 1 && r < most + spacing; q++)
                within[q] += part * fmin(1.0, fmax(0.0, 0.5 + (most * q / RADII - r) / spacing));
        }
    }
    key.section = "encircled";
    for (int q = 0; q <= RADII; q++) {
        key.x = most * q / RADII;
        put(s->out, key, "fraction", "", within[q] / all * lost);
    }
}

/* Cuts through the point image. Returns its peak's place, mm, in at. */
static status put_point_image(lens_study *s, lens_row key, const pupil *p, double cover, double scale, double at[2],
                              diagnostic *why)
{
    enum { REACH = 32 };
    const int wide = 4 * p->n;
    const double spacing = 1.0 / (scale * wide * p->step);
    float *intensity = point_image(p, cover);
    if (!intensity)
        return out_of_memory(why);
    int best = 0;
    for (int i = 0; i < wide * wide; i++)
        best = intensity[i] > intensity[best] ? i : best;
    const int bj = best / wide, bi = best % wide;
    at[0] = (bj < wide / 2 ? bj : bj - wide) * spacing, at[1] = (bi < wide / 2 ? bi : bi - wide) * spacing;
    double square = 0.0;
    for (int i = 0; i < p->n * p->n; i++)
        square += p->cover[i] * p->cover[i];
    put_encircled(s, key, intensity, wide, spacing, square / cover);
    key.section = "psf";
    for (int k = -REACH; k <= REACH && s->options->psf; k++) {
        key.x = k * spacing;
        put(s->out, key, "tangential", "", (double)intensity[((bj + k + wide) % wide) * wide + bi]);
        put(s->out, key, "sagittal", "", (double)intensity[bj * wide + (bi + k + wide) % wide]);
    }
    free(intensity);
    return STATUS_OK;
}

/* --- the MTF --- */

typedef struct transfer {
    double re, im;
} transfer;

/* The pupil's autocorrelation at a shift by j samples, tangential or sagittal, over its area `cover`: products of parts
 * of cells are areas unless the edges coincide, as at j = 0. */
static transfer shifted(const pupil *p, int j, bool sagittal, double cover)
{
    transfer sum = {0.0, 0.0};
    if (j == 0)
        return (transfer){1.0, 0.0};
    for (int a = 0; a < p->n; a++)
        for (int b = 0; b + j < p->n; b++) {
            const int to = sagittal ? a * p->n + b : b * p->n + a, from = to + (sagittal ? j : j * p->n);
            const double c = p->cover[to] * p->cover[from];
            const double turns = c != 0.0 ? 2.0 * M_PI * (p->waves[to] - p->waves[from]) : 0.0;
            sum.re += c * cos(turns), sum.im += c * sin(turns);
        }
    return (transfer){sum.re / cover, sum.im / cover};
}

/* Between samples: the cubic through the four nearest, none of them below 0, where the curve has a cusp. */
static transfer between(const transfer *at, int n, double shift)
{
    const int from = (int)fmax(0.0, fmin(floor(shift) - 1.0, n - 4.0));
    transfer sum = {0.0, 0.0};
    if (shift > n - 1)
        return sum;
    for (int i = 0; i < 4; i++) {
        double w = 1.0;
        for (int j = 0; j < 4; j++)
            w *= i == j ? 1.0 : (shift - from - j) / (i - j);
        sum.re += w * at[from + i].re, sum.im += w * at[from + i].im;
    }
    return sum;
}

enum { MTF_STEPS = 40 };
typedef struct mtf_sum {
    transfer at[2][MTF_STEPS + 1];
    double weight;
} mtf_sum;

/* shift: of this wavelength's chief ray from the primary's, tangential and sagittal, mm. */
static status add_mtf(const lens_study *s, const pupil *p, double scale, double weight, const double shift[2],
                      mtf_sum *out, diagnostic *why)
{
    double cover = 0.0;
    transfer *at = malloc((size_t)p->n * sizeof *at);
    if (!at)
        return out_of_memory(why);
    for (int i = 0; i < p->n * p->n; i++)
        cover += p->cover[i];
    for (int k = 0; k < 2; k++) {
        for (int j = 0; j < p->n; j++)
            at[j] = shifted(p, j, k == 1, cover);
        for (int i = 0; i <= MTF_STEPS; i++) {
            const double f = s->frequency_most * i / MTF_STEPS, turn = -2.0 * M_PI * f * shift[k];
            const transfer t = between(at, p->n, f / (scale * p->step));
            out->at[k][i].re += weight * (t.re * cos(turn) - t.im * sin(turn));
            out->at[k][i].im += weight * (t.re * sin(turn) + t.im * cos(turn));
        }
    }
    out->weight += weight;
    free(at);
    return STATUS_OK;
}

/* Of a circular pupil without aberrations: (2 / pi) (acos v - v sqrt(1 - v^2)) (Goodman, Introduction to Fourier
 * Optics, 6.4). */
static double mtf_limit(double v)
{
    return v < 1.0 ? M_2_PI * (acos(v) - v * sqrt(1.0 - v * v)) : 0.0;
}

static void put_mtf(lens_study *s, size_t field, const mtf_sum *sum)
{
    const double cutoff = 1.0 / (s->model[s->primary].lambda_nm * 1e-6 * s->first.working_number);
    for (int i = 0; i <= MTF_STEPS; i++) {
        const double f = s->frequency_most * i / MTF_STEPS;
        const lens_row key = {.section = "mtf-diffraction", .field = (int)field + 1, .x = f};
        put(s->out, key, "tangential", "", hypot(sum->at[0][i].re, sum->at[0][i].im) / sum->weight);
        put(s->out, key, "sagittal", "", hypot(sum->at[1][i].re, sum->at[1][i].im) / sum->weight);
        put(s->out, key, "limit", "", mtf_limit(f / cutoff));
    }
}

/* --- one wavelength --- */

static status one_wave(lens_study *s, size_t field, size_t w, vec3 about, pupil *p, mtf_sum *mtf, diagnostic *why)
{
    const lens_field *f = &s->p->field[field];
    const lens_model *m = &s->model[w];
    const double scale = fabs(m->n_image) / (m->lambda_nm * 1e-6);
    lens_row key = {.section = "wavefront", .field = (int)field + 1, .lambda_nm = m->lambda_nm, .x = NAN};
    lens_beam bundle;
    bool any;
    TRY(lens_beam_aim(&s->bench[w], s->p, &s->first, f->x, f->y, &bundle, why));
    TRY(pupil_extent(&bundle, p, &any, why));
    const double *per = bundle.cosines_per;
    if (!any || per[0] * per[3] == per[1] * per[2]) { /* no bundle, or an obstruction about the chief ray */
        put(s->out, key, "rms", "waves", NAN);
        return STATUS_OK;
    }
    TRY(pupil_trace(s, &bundle, p, why));
    const wave_sum sum = sum_waves(p);
    double at[2] = {0.0, 0.0};
    put(s->out, key, "pv", "waves", sum.high - sum.low);
    put(s->out, key, "rms", "waves", sum.square);
    put(s->out, key, "strehl_marechal", "", exp(-4.0 * M_PI * M_PI * sum.square * sum.square));
    lens_row intensity = key;
    TRY(put_point_image(s, intensity, p, sum.cover, scale, at, why));
    const double h = 0.25 / (scale * p->n * p->step);
    put(s->out, key, "strehl_diffraction", "", peak_near(p, sum.cover, scale, at, h));
    put(s->out, key, "samples", "", sum.samples);
    const vec3 off = vec3_sub(bundle.chief.image, about);
    const double shift[2] = {off.x * bundle.t[0] + off.y * bundle.t[1], off.y * bundle.t[0] - off.x * bundle.t[1]};
    return add_mtf(s, p, scale, s->p->wavelength[w].weight, shift, mtf, why);
}

status lens_waves(lens_study *s, size_t field, diagnostic *why)
{
    const size_t n = (size_t)s->options->wave_grid;
    const lens_field *f = &s->p->field[field];
    double *memory = malloc(2 * n * n * sizeof *memory);
    mtf_sum mtf = {.weight = 0.0};
    pupil p = {.n = (int)n, .cover = memory, .waves = memory + n * n};
    lens_beam chief;
    if (!memory)
        return out_of_memory(why);
    status code = lens_beam_aim(&s->bench[s->primary], s->p, &s->first, f->x, f->y, &chief, why);
    for (size_t w = 0; code == STATUS_OK && w < s->waves; w++)
        code = one_wave(s, field, w, chief.chief.image, &p, &mtf, why);
    if (code == STATUS_OK)
        put_mtf(s, field, &mtf);
    free(memory);
    return code;
}
