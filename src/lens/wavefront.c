/* Wavefronts of one field, and what diffraction makes of them: the Strehl ratio, the MTF and the point image.
 *
 * Rays are aimed so that they sample the cosines of direction at the image uniformly: the pupil of the diffraction
 * integral in its Debye form, in which a ray with the optical path W and the direction d adds exp(2 pi i (n (d - d0)
 * . x / lambda - W)) at x (Born and Wolf, Principles of Optics, ch. 8). The sums are over the fine grid of pupil.c. The
 * point image is the square of this sum's transform, by KissFFT in single precision (2^-24; errors below 1e-5 of the
 * peak); the MTF is the transform of its line images, which the padding to twice the pupil makes exact for the grid. */
#include "lens/lens_private.h"

#include <kissfft/kiss_fftnd.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* --- the wavefront --- */

typedef struct wave_sum {
    double mean, square, low, high;
} wave_sum;

static wave_sum sum_waves(const lens_pupil *p)
{
    wave_sum sum = {.low = INFINITY, .high = -INFINITY};
    for (int i = 0; i < p->n * p->n; i++) {
        const double c = p->cover[i], w = p->waves[i];
        sum.mean += c * w, sum.square += c * w * w;
        if (c >= 0.5)
            sum.low = fmin(sum.low, w), sum.high = fmax(sum.high, w);
    }
    sum.mean /= p->area;
    sum.square = sqrt(fmax(0.0, sum.square / p->area - sum.mean * sum.mean));
    return sum;
}

/* The intensity at x (mm, along and across the field's direction) from the chief ray's image, as a part of the peak
 * without aberrations; scale: n / lambda, 1 / mm. */
static double intensity_at(const lens_pupil *p, double scale, double x, double y)
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
    return (re * re + im * im) / (p->area * p->area);
}

/* The peak near a point, by parabolas along both axes in turn. */
static double peak_near(const lens_pupil *p, double scale, double at[2], double h)
{
    double best = intensity_at(p, scale, at[0], at[1]);
    for (int i = 0; i < 8; i++, h *= i % 2 ? 1.0 : 0.5) {
        const int k = i % 2;
        double to[2] = {at[0], at[1]};
        to[k] = at[k] - h;
        const double low = intensity_at(p, scale, to[0], to[1]);
        to[k] = at[k] + h;
        const double high = intensity_at(p, scale, to[0], to[1]), bend = low - 2.0 * best + high;
        to[k] = at[k] + (bend < 0.0 ? 0.5 * h * (low - high) / bend : 0.0);
        const double now = intensity_at(p, scale, to[0], to[1]);
        if (now > best)
            best = now, at[k] = to[k];
    }
    return best;
}

/* --- the point image --- */

/* The intensity on a grid of 4 n x 4 n points, `spacing` mm apart, with the chief ray's image at its first; NULL when
 * out of memory. */
static float *point_image(const lens_pupil *p)
{
    const int wide = 4 * p->n, dims[2] = {wide, wide};
    const size_t count = (size_t)wide * (size_t)wide;
    kiss_fft_cpx *in = calloc(count, sizeof *in), *out = calloc(count, sizeof *out);
    float *intensity = calloc(count, sizeof *intensity);
    kiss_fftnd_cfg plan = kiss_fftnd_alloc(dims, 2, 1, NULL, NULL);
    const bool good = in && out && intensity && plan;
    for (int i = 0; good && i < p->n * p->n; i++) {
        kiss_fft_cpx *at = &in[(i / p->n) * wide + i % p->n];
        at->r = (float)(p->cover[i] / p->area * cos(2.0 * M_PI * p->waves[i]));
        at->i = (float)(-p->cover[i] / p->area * sin(2.0 * M_PI * p->waves[i]));
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

/* Encircled energy, within circles about the centroid of the point image, to beyond that with 95 % of the light: by
 * fifths of Airy's radius, or twice, 4, 8, ... times that. A circle's
 * edge divides the cells of the grid that it crosses. lost: what the parts of cells at the pupil's edge lack of their
 * light, as amplitudes. */
static status put_encircled(lens_study *s, lens_row key, const float *intensity, int wide, double spacing, double lost,
                            diagnostic *why)
{
    enum { RADII = 20 };
    const int half = wide / 2;
    double *ring = calloc((size_t)half + 2, sizeof *ring), all = 0.0, x = 0.0, y = 0.0;
    if (!ring)
        return out_of_memory(why);
    for (int pass = 0; pass < 2; pass++) {
        for (int i = 0; i < wide * wide; i++) {
            const int j = i / wide, k = i % wide;
            const double px = j < half ? j : j - wide, py = k < half ? k : k - wide, part = (double)intensity[i];
            if (pass == 0) {
                all += part, x += part * px, y += part * py;
                continue;
            }
            const double r = fmin(hypot(px - x / all, py - y / all) + 0.5, half); /* in the ring up to r, in part */
            const int at = (int)r;
            ring[at] += part * (1.0 - (r - at)), ring[at + 1] += part * (r - at);
        }
    }
    /* ring[i]: what the circle of the radius i has gained over that of i - 1 */
    for (int i = 1; i <= half; i++)
        ring[i] += ring[i - 1];
    int last = 1;
    while (last < half - 1 && !(ring[last] * lost > 0.95 * all))
        last++;
    double step = 0.2 * 1.2196698912665045 * key.lambda_nm * 1e-6 * s->first.working_number / spacing;
    while (step * RADII < last && 2.0 * step * RADII < half)
        step *= 2.0;
    key.section = "encircled";
    for (int q = 0; q <= RADII; q++) {
        const double r = fmin(step * q, half - 1.0);
        const int at = (int)r;
        key.x = step * q * spacing;
        put(s->out, key, "fraction", "", q ? (ring[at] + (r - at) * (ring[at + 1] - ring[at])) / all * lost : 0.0);
    }
    free(ring);
    return STATUS_OK;
}

/* The point image at a wavelength, on its grid. */
typedef struct image_grid {
    float *intensity;
    int wide;
    double spacing;
} image_grid;

/* Cuts through the point image. Returns its peak's place, mm, in at. */
static status put_point_image(lens_study *s, lens_row key, const lens_pupil *p, const image_grid *g, double at[2],
                              diagnostic *why)
{
    enum { REACH = 32 };
    const int wide = g->wide;
    const float *intensity = g->intensity;
    int best = 0;
    for (int i = 0; i < wide * wide; i++)
        best = intensity[i] > intensity[best] ? i : best;
    const int bj = best / wide, bi = best % wide;
    at[0] = (bj < wide / 2 ? bj : bj - wide) * g->spacing, at[1] = (bi < wide / 2 ? bi : bi - wide) * g->spacing;
    double square = 0.0;
    for (int i = 0; i < p->n * p->n; i++)
        square += p->cover[i] * p->cover[i];
    TRY(put_encircled(s, key, intensity, wide, g->spacing, square / p->area, why));
    key.section = "psf";
    for (int k = -REACH; k <= REACH && s->options->psf; k++) {
        key.x = k * g->spacing;
        put(s->out, key, "tangential", "", (double)intensity[((bj + k + wide) % wide) * wide + bi]);
        put(s->out, key, "sagittal", "", (double)intensity[bj * wide + (bi + k + wide) % wide]);
    }
    return STATUS_OK;
}

/* --- the MTF --- */

typedef struct transfer {
    double re, im;
} transfer;

/* The pupil's autocorrelation at shifts by 0, 1, ... n - 1 points, tangential or sagittal, over its area: the
 * transform of a line image. Products of parts of cells are areas unless the edges coincide, as without a shift. */
static status autocorrelation(const lens_pupil *p, const image_grid *g, bool sagittal, transfer *out, diagnostic *why)
{
    double *line = calloc((size_t)g->wide, sizeof *line);
    if (!line)
        return out_of_memory(why);
    for (int i = 0; i < g->wide * g->wide; i++)
        line[sagittal ? i % g->wide : i / g->wide] += (double)g->intensity[i];
    const double by = p->area / ((double)g->wide * g->wide);
    for (int j = 0; j < p->n; j++) {
        double re = 0.0, im = 0.0;
        for (int k = 0; k < g->wide; k++) {
            const double turn = 2.0 * M_PI * ((double)((long)j * k % g->wide) / g->wide);
            re += line[k] * cos(turn), im -= line[k] * sin(turn);
        }
        out[j] = j ? (transfer){by * re, by * im} : (transfer){1.0, 0.0};
    }
    free(line);
    return STATUS_OK;
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
static status add_mtf(const lens_study *s, const lens_pupil *p, const image_grid *g, double scale, double weight,
                      const double shift[2], mtf_sum *out, diagnostic *why)
{
    transfer *at = malloc((size_t)p->n * sizeof *at);
    status code = at ? STATUS_OK : out_of_memory(why);
    for (int k = 0; k < 2 && code == STATUS_OK; k++) {
        code = autocorrelation(p, g, k == 1, at, why);
        for (int i = 0; i <= MTF_STEPS && code == STATUS_OK; i++) {
            const double f = s->frequency_most * i / MTF_STEPS, turn = -2.0 * M_PI * f * shift[k];
            const transfer t = between(at, p->n, f / (scale * p->step));
            out->at[k][i].re += weight * (t.re * cos(turn) - t.im * sin(turn));
            out->at[k][i].im += weight * (t.re * sin(turn) + t.im * cos(turn));
        }
    }
    out->weight += weight;
    free(at);
    return code;
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

/* Points for each sample: neighbours on the fine grid differ by an eighth of a wave at most, as far as memory goes. */
static int fineness(const lens_samples *s)
{
    enum { POINTS = 256 };
    double most = 0.0;
    int finer = s->n <= 32 ? 4 : 2;
    for (int i = 0; i + 1 < s->n * s->n; i++)
        if (s->passes[i] && s->passes[i + 1])
            most = fmax(most, fabs(s->value[LENS_WAVES][i + 1] - s->value[LENS_WAVES][i]));
    while (finer < 16 && most / finer > 0.125)
        finer *= 2;
    while (finer > 1 && finer * s->n > POINTS)
        finer /= 2;
    return finer;
}

static status put_wave(lens_study *s, lens_row key, const lens_samples *samples, double scale, lens_pupil *p,
                       image_grid *g, diagnostic *why)
{
    const int finer = fineness(samples);
    lens_pupil coarse = {.n = 0};
    double at[2] = {0.0, 0.0};
    TRY(lens_pupil_make(samples, 1, finer, p, why));
    const wave_sum sum = sum_waves(p);
    put(s->out, key, "pv", "waves", sum.high - sum.low);
    put(s->out, key, "rms", "waves", sum.square);
    put(s->out, key, "strehl_marechal", "", exp(-4.0 * M_PI * M_PI * sum.square * sum.square));
    *g = (image_grid){point_image(p), 4 * p->n, 1.0 / (scale * 4 * p->n * p->step)};
    if (!g->intensity)
        return out_of_memory(why);
    const lens_row intensity = key;
    TRY(put_point_image(s, intensity, p, g, at, why));
    const double strehl = peak_near(p, scale, at, g->spacing);
    put(s->out, key, "strehl_diffraction", "", strehl);
    status code = lens_pupil_make(samples, 2, 2 * finer, &coarse, why);
    if (code == STATUS_OK)
        put(s->out, key, "strehl_error", "", fabs(intensity_at(&coarse, scale, at[0], at[1]) - strehl));
    put(s->out, key, "samples", "", samples->count);
    lens_pupil_release(&coarse);
    return code;
}

static status one_wave(lens_study *s, size_t field, size_t w, vec3 about, lens_samples *samples, mtf_sum *mtf,
                       diagnostic *why)
{
    const lens_field *f = &s->p->field[field];
    const lens_model *m = &s->model[w];
    const double scale = fabs(m->n_image) / (m->lambda_nm * 1e-6);
    const lens_row key = {.section = "wavefront", .field = (int)field + 1, .lambda_nm = m->lambda_nm, .x = NAN};
    lens_beam bundle;
    bool any;
    TRY(lens_beam_aim(&s->bench[w], s->p, &s->first, f->x, f->y, &bundle, why));
    TRY(lens_samples_trace(s, &bundle, samples, &any, why));
    if (!any || !samples->count) {
        put(s->out, key, "rms", "waves", NAN);
        return STATUS_OK;
    }
    const vec3 off = vec3_sub(bundle.chief.image, about);
    const double shift[2] = {off.x * bundle.t[0] + off.y * bundle.t[1], off.y * bundle.t[0] - off.x * bundle.t[1]};
    lens_pupil p = {.n = 0};
    image_grid g = {.intensity = NULL};
    status code = put_wave(s, key, samples, scale, &p, &g, why);
    if (w == s->primary)
        s->solid_angle = p.area * p.step * p.step;
    THEN(code, add_mtf(s, &p, &g, scale, s->p->wavelength[w].weight, shift, mtf, why));
    free(g.intensity);
    lens_pupil_release(&p);
    return code;
}

status lens_waves(lens_study *s, size_t field, diagnostic *why)
{
    const lens_field *f = &s->p->field[field];
    mtf_sum mtf = {.weight = 0.0};
    lens_samples samples;
    lens_beam chief;
    status code = lens_samples_make(s->options->wave_grid, &samples, why);
    THEN(code, lens_beam_aim(&s->bench[s->primary], s->p, &s->first, f->x, f->y, &chief, why));
    for (size_t w = 0; code == STATUS_OK && w < s->waves; w++)
        code = one_wave(s, field, w, chief.chief.image, &samples, &mtf, why);
    if (code == STATUS_OK)
        put_mtf(s, field, &mtf);
    lens_samples_release(&samples);
    return code;
}
