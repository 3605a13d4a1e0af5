/* Fits smooth spectra to colours (Jakob and Hanika 2019): Levenberg-Marquardt on the distance in CIELAB. */
#include "optics/upsample.h"
#include "base/lanes.h"

/* Three-point Gauss quadrature on every 5 nm interval of the tables: observer times D65 is quadratic there, which
 * leaves three of the rule's five degrees for S. */
enum {
    STEP_NM = 5,
    INTERVALS = (OBSERVER_HIGH_NM - OBSERVER_LOW_NM) / STEP_NM,
    SAMPLES = 3 * INTERVALS,
    STEPS_MAX = 100
};

static const double SATURATED = 0x1p60;   /* sigmoid(+-SATURATED) is 1 and 0 exactly */
static const double CLOSE_ENOUGH = 1e-20; /* the square of a CIELAB distance of 1e-10, far below visibility */

/* The contribution of each wavelength to X/Xn, Y/Yn, Z/Zn of a surface under D65; each row of weights sums to 1. */
typedef struct daylight {
    double t[SAMPLES], weight[3][SAMPLES];
} daylight;

/* Coefficients, the difference of their colour from the target in L*, a*, b*, and its derivatives. */
typedef struct trial {
    double c[3], distance[3], slope[3][3], square;
} trial;

static void daylight_make(daylight *d)
{
    const double offset[3] = {-sqrt(0.6), 0.0, sqrt(0.6)},
                 gauss[3] = {5.0, 8.0, 5.0}; /* offsets within -1 .. 1; weights out of 18 */
    double sum[3] = {0.0, 0.0, 0.0};
    for (int k = 0; k < SAMPLES; k++) {
        double intervals = k / 3 + 0.5 + 0.5 * offset[k % 3], lambda_nm = OBSERVER_LOW_NM + STEP_NM * intervals, xyz[3];
        observer_xyz(lambda_nm, xyz);
        d->t[k] = 2.0 * intervals / INTERVALS - 1.0;
        for (int i = 0; i < 3; i++) {
            d->weight[i][k] = gauss[k % 3] * observer_d65(lambda_nm) * xyz[i];
            sum[i] += d->weight[i][k];
        }
    }
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < SAMPLES; k++)
            d->weight[i][k] /= sum[i];
}

/* Halley's method, which triples the digits at each step; for t of 0.008 .. 1.1. */
static double cube_root(double t)
{
    double y = 0.35 + 0.65 * t;
    for (int k = 0; k < 4; k++) {
        double cube = y * y * y;
        y *= (cube + 2.0 * t) / (2.0 * cube + t);
    }
    return y;
}

/* f of CIELAB and its derivative; CIE 15:2018, 8.2.1.1. */
static double lab_f(double t, double *slope)
{
    const double delta = 6.0 / 29.0;
    if (t <= delta * delta * delta) {
        *slope = 1.0 / (3.0 * delta * delta);
        return t * *slope + 4.0 / 29.0;
    }
    double f = cube_root(t);
    *slope = 1.0 / (3.0 * f * f);
    return f;
}

/* L*, a*, b* are linear in f(X/Xn), f(Y/Yn), f(Z/Zn). */
static const double lab_of_f[3][3] = {{0.0, 116.0, 0.0}, {500.0, -500.0, 0.0}, {0.0, 200.0, -200.0}};

/* Computes the difference from the target, which the fit minimises, for a colour relative to white. */
static void evaluate(const daylight *d, const double target_f[3], trial *at)
{
    double relative[3] = {0.0, 0.0, 0.0}, by_c[3][3] = {{0.0, 0.0, 0.0}, {0.0, 0.0, 0.0}, {0.0, 0.0, 0.0}};
    for (int k = 0; k < SAMPLES; k++) {
        double t = d->t[k], x = (at->c[0] * t + at->c[1]) * t + at->c[2];
        double one_over_root = 1.0 / sqrt(1.0 + x * x);
        double s = 0.5 + 0.5 * x * one_over_root;
        double s_by_x = 0.5 * one_over_root * one_over_root * one_over_root;
        for (int i = 0; i < 3; i++) {
            double w = d->weight[i][k];
            relative[i] += w * s;
            by_c[i][0] += w * s_by_x * t * t;
            by_c[i][1] += w * s_by_x * t;
            by_c[i][2] += w * s_by_x;
        }
    }
    double difference[3], f_slope[3];
    for (int i = 0; i < 3; i++)
        difference[i] = lab_f(relative[i], &f_slope[i]) - target_f[i];
    at->square = 0.0;
    for (int i = 0; i < 3; i++) {
        at->distance[i] = 0.0;
        for (int j = 0; j < 3; j++) {
            at->distance[i] += lab_of_f[i][j] * difference[j];
            at->slope[i][j] = lab_of_f[i][0] * f_slope[0] * by_c[0][j] + lab_of_f[i][1] * f_slope[1] * by_c[1][j] +
                              lab_of_f[i][2] * f_slope[2] * by_c[2][j];
        }
        at->square += at->distance[i] * at->distance[i];
    }
}

/* Solves (J'J + damping diag(J'J)) step = -J' distance by the Cholesky factorisation L D L'; a tiny addend keeps the
 * pivots above 0. */
static void damped_step(const trial *at, double damping, double step[3])
{
    double a[3][3], b[3];
    for (int i = 0; i < 3; i++) {
        b[i] = 0.0;
        for (int k = 0; k < 3; k++)
            b[i] -= at->slope[k][i] * at->distance[k];
        for (int j = 0; j < 3; j++) {
            a[i][j] = 0.0;
            for (int k = 0; k < 3; k++)
                a[i][j] += at->slope[k][i] * at->slope[k][j];
        }
    }
    for (int i = 0; i < 3; i++)
        a[i][i] += damping * a[i][i] + 1e-300;
    for (int j = 0; j < 3; j++) { /* the factorisation */
        for (int i = j + 1; i < 3; i++) {
            double factor = a[i][j] / a[j][j];
            for (int k = j + 1; k <= i; k++)
                a[i][k] -= factor * a[k][j];
            b[i] -= factor * b[j];
        }
    }
    for (int i = 2; i >= 0; i--) {
        step[i] = b[i];
        for (int k = i + 1; k < 3; k++)
            step[i] -= a[k][i] * step[k];
        step[i] /= a[i][i];
    }
}

/* Levenberg-Marquardt, from the coefficients that the caller stored in best. The result is never worse than the start:
 * a step that does not reduce the distance (or is NaN) is rejected. */
static void fit(const daylight *d, const double target_f[3], trial *best)
{
    double damping = 1e-3; /* Marquardt's start, less after a success and more after a rejection */
    evaluate(d, target_f, best);
    for (int n = 0; n < STEPS_MAX && best->square > CLOSE_ENOUGH; n++) {
        double step[3];
        trial next;
        damped_step(best, damping, step);
        for (int i = 0; i < 3; i++)
            next.c[i] = best->c[i] + step[i];
        evaluate(d, target_f, &next);
        if (next.square < best->square) {
            *best = next;
            damping *= 0.1;
        } else {
            damping *= 8.0;
        }
    }
}

static double clamped(double v, double high)
{
    return v > 0.0 ? lesser(v, high) : 0.0;
}

/* The inverse of the sigmoid. */
static double grey_coefficient(double v)
{
    if (v <= 0.0 || v >= 1.0)
        return v <= 0.0 ? -SATURATED : SATURATED;
    return greater((v - 0.5) / sqrt(v * (1.0 - v)), -SATURATED);
}

static upsampled_spectrum upsample_clamped(const double rgb[3])
{
    if (rgb[0] == rgb[1] && rgb[1] == rgb[2])
        return (upsampled_spectrum){.c = {0.0, 0.0, grey_coefficient(rgb[0])}, .scale = 1.0};
    const double white[3] = {1.0, 1.0, 1.0};
    double xyz[3], white_xyz[3], target_f[3], unused;
    linear_srgb_to_xyz(rgb, xyz);
    linear_srgb_to_xyz(white, white_xyz);
    for (int i = 0; i < 3; i++)
        target_f[i] = lab_f(xyz[i] / white_xyz[i], &unused);
    daylight d;
    daylight_make(&d);
    trial best = {.c = {0.0, 0.0, grey_coefficient(xyz[1])}}; /* start from the grey of equal luminance */
    fit(&d, target_f, &best);
    return (upsampled_spectrum){.c = {best.c[0], best.c[1], best.c[2]}, .scale = 1.0};
}

upsampled_spectrum upsample_reflectance(const double rgb[3])
{
    double v[3];
    for (int i = 0; i < 3; i++)
        v[i] = clamped(rgb[i], 1.0);
    return upsample_clamped(v);
}

upsampled_spectrum upsample_emission(const double rgb[3])
{
    double v[3], largest = 0.0;
    for (int i = 0; i < 3; i++) {
        v[i] = clamped(rgb[i], 0x1p1000);
        largest = greater(largest, v[i]);
    }
    if (largest == 0.0)
        return (upsampled_spectrum){.c = {0.0, 0.0, 0.0}, .scale = 0.0};
    for (int i = 0; i < 3; i++)
        v[i] /= 2.0 * largest;
    upsampled_spectrum l = upsample_clamped(v);
    l.scale = 2.0 * largest;
    return l;
}
