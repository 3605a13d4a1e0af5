/* The exit pupil of one field: rays that sample the cosines of direction at the image evenly, and between them a finer
 * grid by interpolation. A wavefront is smooth, so that a cubic follows it to a thousandth of a wave where neighbours
 * differ by less than a wave; its phase is not, and the pupil's edge is sharp. So sums over the fine grid need few
 * rays. */
#include "lens/lens_private.h"

#include "base/cancel.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Cosines along the field's direction and across. */
static void cosines_of(const lens_beam *bundle, const lens_ray *r, double at[2])
{
    at[0] = r->direction.x * bundle->t[0] + r->direction.y * bundle->t[1];
    at[1] = r->direction.y * bundle->t[0] - r->direction.x * bundle->t[1];
}

/* The pupil's extent in cosines, from rays along the stop's edge, or as near to it as they pass. */
static status extent(lens_beam *bundle, lens_samples *out, double centre[2], bool *any, diagnostic *why)
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
    centre[0] = 0.5 * (low[0] + high[0]), centre[1] = 0.5 * (low[1] + high[1]);
    *any = size > 1e-12;
    return STATUS_OK;
}

/* --- samples --- */

/* Launches by cosines: the inverse of their derivatives. */
static void invert(const double a[4], double out[4])
{
    const double det = a[0] * a[3] - a[1] * a[2];
    out[0] = a[3] / det, out[1] = -a[1] / det, out[2] = -a[2] / det, out[3] = a[0] / det;
}

static void keep_sample(lens_samples *out, int at, const lens_ray *r, double waves)
{
    const bool passes = r->loss == LENS_PASSES;
    out->passes[at] = passes;
    out->count += passes;
    out->value[LENS_WAVES][at] = passes ? waves : NAN;
    out->value[LENS_STOP_X][at] = r->stop_x / out->stop_radius;
    out->value[LENS_STOP_Y][at] = r->stop_y / out->stop_radius;
}

/* What does not arrive goes on beyond the last three samples of a row or a column as a parabola: the mean of those that
 * do so from the four sides. */
static status extend(double *v, int n, diagnostic *why)
{
    static const int way[4][2] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}};
    double *next = malloc((size_t)(n * n) * sizeof *next);
    if (!next)
        return out_of_memory(why);
    for (int round = 0; round < 3; round++) {
        for (int i = 0; i < n * n; i++) {
            double sum = 0.0;
            int sides = 0;
            for (int k = 0; k < 4 && isnan(v[i]); k++) {
                const int row = i / n + 3 * way[k][0], column = i % n + 3 * way[k][1], by = way[k][0] * n + way[k][1];
                if (row < 0 || row >= n || column < 0 || column >= n)
                    continue;
                const double on = 3.0 * (v[i + by] - v[i + 2 * by]) + v[i + 3 * by];
                sum += isnan(on) ? 0.0 : on, sides += !isnan(on);
            }
            next[i] = isnan(v[i]) && sides ? sum / sides : v[i];
        }
        memcpy(v, next, (size_t)(n * n) * sizeof *v);
    }
    free(next);
    return STATUS_OK;
}

status lens_samples_trace(const lens_study *s, lens_beam *bundle, lens_samples *out, bool *any, diagnostic *why)
{
    double centre[2], per[4];
    const double *by = bundle->cosines_per;
    const int n = out->n;
    out->count = 0, out->stop_radius = bundle->stop_radius;
    out->part_x = bundle->part_x / bundle->stop_radius, out->part_y = bundle->part_y / bundle->stop_radius;
    out->half_x = bundle->half_x, out->half_y = bundle->half_y;
    TRY(extent(bundle, out, centre, any, why));
    *any = *any && by[0] * by[3] != by[1] * by[2]; /* else no bundle, or an obstruction about the chief ray */
    if (!*any)
        return STATUS_OK;
    invert(by, per);
    for (int j = 0; j < n; j++) {
        lens_row_launch row = {.count = 0};
        for (int i = 0; i < n; i++) {
            const double target[2] = {centre[0] + (j - 0.5 * (n - 1)) * out->step,
                                      centre[1] + (i - 0.5 * (n - 1)) * out->step};
            const double off[2] = {target[0] - bundle->base_cosines[0], target[1] - bundle->base_cosines[1]};
            double launch[2];
            lens_ray r;
            TRY(cancel_check(why));
            for (int k = 0; k < 2; k++)
                launch[k] = bundle->base[k] + per[2 * k] * off[0] + per[2 * k + 1] * off[1];
            lens_row_guess(&row, launch);
            TRY(lens_beam_cosines(bundle, target, 1e-6 * out->step, launch, &r, why));
            lens_row_add(&row, r.loss == LENS_PASSES, launch);
            keep_sample(out, j * n + i, &r, lens_opd(bundle, &s->first, &r));
        }
    }
    for (int k = 0; k < LENS_SAMPLE_KINDS; k++)
        TRY(extend(out->value[k], n, why));
    return STATUS_OK;
}

status lens_samples_make(int n, lens_samples *out, diagnostic *why)
{
    const size_t count = (size_t)n * (size_t)n;
    *out = (lens_samples){.n = n, .passes = calloc(count, sizeof *out->passes)};
    double *all = malloc(LENS_SAMPLE_KINDS * count * sizeof *all);
    for (int k = 0; all && k < LENS_SAMPLE_KINDS; k++)
        out->value[k] = all + (size_t)k * count;
    return all && out->passes ? STATUS_OK : out_of_memory(why);
}

void lens_samples_release(lens_samples *s)
{
    free(s->value[0]);
    free(s->passes);
    *s = (lens_samples){.n = 0};
}

/* --- the fine grid --- */

/* The cubic's weights through four samples, of which `from` is the first, at u. */
static void cubic(double u, int from, double w[4])
{
    for (int i = 0; i < 4; i++) {
        w[i] = 1.0;
        for (int j = 0; j < 4; j++)
            w[i] *= i == j ? 1.0 : (u - from - j) / (i - j);
    }
}

/* Samples of which only every `skip`-th is used. */
typedef struct thinned {
    const lens_samples *s;
    int skip, n;
} thinned;

static int sample_at(const thinned *t, int row, int column)
{
    return row * t->skip * t->s->n + column * t->skip;
}

static double between(const thinned *t, const double *v, double row, double column)
{
    const int j = (int)fmax(0.0, fmin(floor(row) - 1.0, t->n - 4.0)),
              i = (int)fmax(0.0, fmin(floor(column) - 1.0, t->n - 4.0));
    double a[4], b[4], sum = 0.0;
    cubic(row, j, a);
    cubic(column, i, b);
    for (int k = 0; k < 16; k++)
        sum += a[k / 4] * b[k % 4] * v[sample_at(t, j + k / 4, i + k % 4)];
    return sum;
}

/* Whether light that passes the stop there arrives: of the four samples about the point, those within the stop. */
static bool arrives(const thinned *t, double row, double column)
{
    const int j = (int)fmax(0.0, fmin(floor(row), t->n - 2.0)), i = (int)fmax(0.0, fmin(floor(column), t->n - 2.0));
    double sum = 0.0;
    for (int k = 0; k < 4; k++) {
        const int at = sample_at(t, j + k / 2, i + k % 2);
        const double x = t->s->value[LENS_STOP_X][at], y = t->s->value[LENS_STOP_Y][at],
                     a = k / 2 ? row - j : 1.0 - (row - j), b = k % 2 ? column - i : 1.0 - (column - i);
        sum += a * b * (t->s->passes[at] || !(x * x + y * y <= 1.0));
    }
    return sum > 0.5;
}

/* A fine grid, before the edge: rho in units of the stop's radius, or of the ellipse that vignetting factors leave of
 * it where that is farther in; NaN where no light arrives. */
typedef struct fine_grid {
    int m;
    double *rho, *waves;
} fine_grid;

/* The part c of a cell within the stop, whose edge is straight there. The middle of that part lies (1 - c) / 2 of
 * a cell inwards, which changes an integral of f by -h^2 f' / 12 for edges that are anywhere in their cells; half
 * of it is what midpoints of whole cells miss, h^2 f' / 24 (Euler and Maclaurin). So the wavefront moves by the
 * half. */
static double cover_of(const fine_grid *g, int at, double *waves)
{
    const int m = g->m, j = at / m, i = at % m;
    const double *rho = g->rho, *w = g->waves;
    *waves = w[at];
    if (!(rho[at] > 0.5))
        return isnan(rho[at]) ? 0.0 : 1.0;
    if (j == 0 || i == 0 || j == m - 1 || i == m - 1)
        return 0.0;
    const double down = 0.5 * (rho[at + m] - rho[at - m]), on = 0.5 * (rho[at + 1] - rho[at - 1]),
                 width = hypot(down, on);
    if (!(width > 0.0)) /* next to what does not arrive */
        return rho[at] <= 1.0;
    const double cover = fmin(1.0, fmax(0.0, 0.5 + (1.0 - rho[at]) / width));
    const double slope = 0.5 * ((w[at + m] - w[at - m]) * down + (w[at + 1] - w[at - 1]) * on) / width;
    if (cover > 0.0)
        *waves -= 0.25 * (1.0 - cover) * slope;
    return cover;
}

status lens_pupil_make(const lens_samples *s, int skip, int finer, lens_pupil *out, diagnostic *why)
{
    const thinned t = {s, skip, s->n / skip};
    const int m = t.n * finer;
    const size_t count = (size_t)m * (size_t)m;
    double *all = malloc(2 * count * sizeof *all), *grid = malloc(2 * count * sizeof *grid);
    const fine_grid g = {m, grid, grid + count};
    *out = (lens_pupil){.n = m, .step = s->step * skip / finer, .cover = all, .waves = all + count};
    if (!all || !grid) {
        free(grid);
        return out_of_memory(why);
    }
    for (int i = 0; i < m * m; i++) {
        const double row = (i / m + 0.5) / finer - 0.5, column = (i % m + 0.5) / finer - 0.5;
        const double x = between(&t, s->value[LENS_STOP_X], row, column),
                     y = between(&t, s->value[LENS_STOP_Y], row, column);
        g.waves[i] = between(&t, s->value[LENS_WAVES], row, column);
        const double rho = fmax(hypot(x, y), hypot((x - s->part_x) / s->half_x, (y - s->part_y) / s->half_y));
        g.rho[i] = isnan(g.waves[i]) || !arrives(&t, row, column) ? NAN : rho;
    }
    for (int i = 0; i < m * m; i++) {
        out->cover[i] = cover_of(&g, i, &out->waves[i]);
        if (out->cover[i] == 0.0)
            out->waves[i] = 0.0;
        out->area += out->cover[i];
    }
    free(grid);
    return STATUS_OK;
}

void lens_pupil_release(lens_pupil *p)
{
    free(p->cover);
    *p = (lens_pupil){.n = 0};
}
