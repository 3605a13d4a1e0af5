/* The measures of compare.h that use neighbourhoods: structural similarity and FLIP, and their convolution. */
#include "image/compare.h"

#include "base/cancel.h"
#include "base/elementary.h"
#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

/* ==== convolution with separable filters ==== */

#define E 2.7182818284590452

convolve_taps convolve_gaussian(int count, double sigma)
{
    convolve_taps taps = {.count = count, .before = (count - 1) / 2};
    double sum = 0.0;
    for (int i = 0; i < count; i++) {
        double x = i - (count - 1) / 2.0;
        taps.weight[i] = elementary_pow(E, -x * x / (2.0 * sigma * sigma));
        sum += taps.weight[i];
    }
    for (int i = 0; i < count; i++)
        taps.weight[i] /= sum;
    return taps;
}

static int within(int i, int count)
{
    return i < 0 ? 0 : i < count ? i : count - 1;
}

/* out += weight * shifted row, with repeated border values. */
static void add_shifted_row(const double *restrict row, int width, int shift, double weight, double *restrict out)
{
    int first = shift < 0 ? within(-shift, width + 1) : 0;
    int last = shift > 0 ? within(width - shift, width + 1) : width;
    for (int x = 0; x < first; x++)
        out[x] += weight * row[0];
    for (int x = first; x < last; x++)
        out[x] += weight * row[x + shift];
    for (int x = last; x < width; x++)
        out[x] += weight * row[width - 1];
}

void convolve_add(const double *plane, int width, int height, const convolve_taps *across, const convolve_taps *down,
                  double scale, double *scratch, double *out)
{
    size_t stride = (size_t)width;
    for (int y = 0; y < height && !cancel_asked(); y++) {
        memset(scratch + (size_t)y * stride, 0, stride * sizeof *scratch);
        for (int i = 0; i < across->count; i++)
            add_shifted_row(plane + (size_t)y * stride, width, i - across->before, across->weight[i],
                            scratch + (size_t)y * stride);
    }
    for (int y = 0; y < height && !cancel_asked(); y++) {
        for (int i = 0; i < down->count; i++) {
            const double *row = scratch + (size_t)within(y + i - down->before, height) * stride;
            add_shifted_row(row, width, 0, scale * down->weight[i], out + (size_t)y * stride);
        }
    }
}

/* ==== structural similarity ==== */

/* Structural similarity: Wang, Bovik, Sheikh, Simoncelli, Image Quality Assessment: From Error Visibility to Structural
 * Similarity, IEEE Transactions on Image Processing 13(4), 2004: eq. 13 with the statistics of eqs. 14 to 16 under
 * their 11 x 11 Gaussian of sigma 1.5, K1 = 0.01, K2 = 0.03, L = 1, and the mean of eq. 17 over all windows inside the
 * image. Along a side shorter than 11 pixels the window is as long as that side, with a centred Gaussian of sum 1. */

enum { WINDOW = 11, MEAN_A = 0, MEAN_B, SQUARE_A, SQUARE_B, PRODUCT, SUMS };

/* A plane per windowed sum, and two scratch planes. */
typedef struct statistics {
    int width, height;
    size_t count;
    double *sums[SUMS], *terms, *scratch;
} statistics;

static void gather(statistics *s, const double *a, const double *b, const convolve_taps *across,
                   const convolve_taps *down)
{
    const double *const factors[SUMS][2] = {{a, NULL}, {b, NULL}, {a, a}, {b, b}, {a, b}};
    for (int sum = 0; sum < SUMS; sum++) {
        const double *first = factors[sum][0], *second = factors[sum][1];
        for (size_t i = 0; i < s->count && !cancel_asked_at(i); i++)
            s->terms[i] = second ? first[i] * second[i] : first[i];
        convolve_add(s->terms, s->width, s->height, across, down, 1.0, s->scratch, s->sums[sum]);
    }
}

/* Eq. 13 for one window. */
static double similarity(const statistics *s, size_t at)
{
    const double c1 = 0.01 * 0.01, c2 = 0.03 * 0.03;
    double a = s->sums[MEAN_A][at], b = s->sums[MEAN_B][at];
    double variance_a = s->sums[SQUARE_A][at] - a * a, variance_b = s->sums[SQUARE_B][at] - b * b;
    double covariance = s->sums[PRODUCT][at] - a * b;
    return (2 * a * b + c1) * (2 * covariance + c2) / ((a * a + b * b + c1) * (variance_a + variance_b + c2));
}

status compare_ssim(const double *a, const double *b, int width, int height, double *mean, diagnostic *why)
{
    statistics s = {.width = width, .height = height, .count = (size_t)width * (size_t)height};
    double *planes = calloc(s.count, (SUMS + 2) * sizeof *planes);
    if (!planes)
        return diagnose(why, STATUS_FAILURE, MEMORY_REMEDY, "out of memory for the structural similarity");
    for (int sum = 0; sum < SUMS; sum++)
        s.sums[sum] = planes + (size_t)sum * s.count;
    s.terms = planes + SUMS * s.count;
    s.scratch = s.terms + s.count;
    convolve_taps across = convolve_gaussian(width < WINDOW ? width : WINDOW, 1.5);
    convolve_taps down = convolve_gaussian(height < WINDOW ? height : WINDOW, 1.5);
    gather(&s, a, b, &across, &down);
    int columns = width - across.count + 1, rows = height - down.count + 1;
    double sum = 0.0;
    for (int y = 0; y < rows && !cancel_asked(); y++)
        for (int x = 0; x < columns; x++)
            sum += similarity(&s, (size_t)(y + down.before) * (size_t)width + (size_t)(x + across.before));
    *mean = sum / ((double)rows * columns);
    free(planes);
    return cancel_check(why);
}

/* ==== FLIP ==== */

/* FLIP, the difference perceived by an observer who alternates between two images: Andersson, Nilsson, Akenine-Moller,
 * Oskarsson, Astrom, Fairchild, FLIP: A Difference Evaluator for Alternating Images, Proceedings of the ACM on Computer
 * Graphics and Interactive Techniques 3(2), 2020, for low dynamic range, with the paper's constants. The observer is
 * 0.7 m away from a display that is 0.7 m and 3840 pixels wide: 67.02 pixels per degree. The filters are sums of
 * separable ones, applied along rows and columns; border pixels are repeated outside. */

/* ---- the colour space: section 4.1 ---- */

/* Linear sRGB to XYZ relative to the white of sRGB (D65). Each row is divided by the sum of its numerators and so sums
 * to 1. The fractions follow from the primaries of IEC 61966-2-1; the authors' implementation uses the same. */
static const double XYZ_OF_RGB[3][3] = {
    {10135552.0 / 23359437, 8788810.0 / 23359437, 4435075.0 / 23359437},
    {2613072.0 / 12288897, 8788810.0 / 12288897, 887015.0 / 12288897},
    {1425312.0 / 80288307, 8788810.0 / 80288307, 70074185.0 / 80288307},
};

/* The inverse, from exact fractions. */
static const double RGB_OF_XYZ[3][3] = {
    {3.0803419882804608, -1.5373989694887855, -0.54294301879167506},
    {-0.92117839616512365, 1.8759299836951759, 0.045248412469947583},
    {0.052881292875543252, -0.20401120612390997, 1.1511299132483668},
};

static double clamp(double value)
{
    return value > 0.0 ? value < 1.0 ? value : 1.0 : 0.0;
}

static void multiply(const double matrix[3][3], const double in[3], double out[3])
{
    for (int row = 0; row < 3; row++)
        out[row] = matrix[row][0] * in[0] + matrix[row][1] * in[1] + matrix[row][2] * in[2];
}

/* Luminance and two opponent colours, red-green and yellow-blue: YCxCz without its scales and offset, which filters of
 * sum 1 preserve. Linear in rgb, which is clamped to 0..1 first. */
static void flip_opponent(const float rgb[3], double opponent[3])
{
    double clamped[3] = {clamp(rgb[0]), clamp(rgb[1]), clamp(rgb[2])}, xyz[3];
    multiply(XYZ_OF_RGB, clamped, xyz);
    opponent[0] = xyz[1];
    opponent[1] = xyz[0] - xyz[1];
    opponent[2] = xyz[1] - xyz[2];
}

/* CIE 15, the cube root with a linear segment near 0. */
static double lab_root(double t)
{
    const double delta = 6.0 / 29.0;
    return t > delta * delta * delta ? elementary_pow(t, 1.0 / 3.0) : t / (3.0 * delta * delta) + 4.0 / 29.0;
}

/* Converts opponent colours to linear RGB, clamps it to 0..1, and converts it to CIELAB with Hunt's adjustment. */
static void flip_hunt_lab(const double opponent[3], double lab[3])
{
    double xyz[3] = {opponent[0] + opponent[1], opponent[0], opponent[0] - opponent[2]}, rgb[3];
    multiply(RGB_OF_XYZ, xyz, rgb);
    for (int i = 0; i < 3; i++)
        rgb[i] = clamp(rgb[i]);
    multiply(XYZ_OF_RGB, rgb, xyz);
    double x = lab_root(xyz[0]), y = lab_root(xyz[1]), z = lab_root(xyz[2]);
    lab[0] = 116.0 * y - 16.0;
    lab[1] = 0.01 * lab[0] * 500.0 * (x - y); /* Hunt effect: lighter colours appear more colourful */
    lab[2] = 0.01 * lab[0] * 200.0 * (y - z);
}

/* HyAB (Abasi, Tehran, Fairchild 2020), for large distances: city block in lightness, Euclidean in colour; to the power
 * 0.7. */
static double hyab_power(const double a[3], const double b[3])
{
    double d1 = a[1] - b[1], d2 = a[2] - b[2];
    return elementary_pow(fabs(a[0] - b[0]) + sqrt(d1 * d1 + d2 * d2), 0.7);
}

/* HyAB distance between green and blue, the most distant colours of the RGB cube, raised to the power 0.7. */
static double flip_farthest(void)
{
    const float green[3] = {0.0f, 1.0f, 0.0f}, blue[3] = {0.0f, 0.0f, 1.0f};
    double opponent[3], lab_green[3], lab_blue[3];
    flip_opponent(green, opponent);
    flip_hunt_lab(opponent, lab_green);
    flip_opponent(blue, opponent);
    flip_hunt_lab(opponent, lab_blue);
    return hyab_power(lab_green, lab_blue);
}

/* The distance of two colours of flip_hunt_lab, mapped to 0..1. */
static double flip_color_error(const double a[3], const double b[3], double farthest)
{
    const double at_knee = 0.95; /* p_t, the value at the knee, p_c = 0.4 of the maximum distance */
    double distance = hyab_power(a, b), knee = 0.4 * farthest;
    return distance < knee ? at_knee * distance / knee
                           : at_knee + (1.0 - at_knee) * (distance - knee) / (farthest - knee);
}

/* ---- the error ---- */

#define PI 3.14159265358979323846
#define PIXELS_PER_DEGREE (3840.0 * PI / 180.0)

/* The perceived features of an image, one plane each: filtered opponent colours, strength of edges and points. */
enum { LUMINANCE, RED_GREEN, YELLOW_BLUE, EDGES, POINTS, FEATURE_COUNT };
typedef struct features {
    double *plane[FEATURE_COUNT];
} features;

/* Scratch planes of one size. */
typedef struct work_planes {
    int width, height;
    size_t count;
    double *opponent[3], *scratch;
    features a, b;
    double *memory;
} work_planes;

static status lay_out_planes(work_planes *d, const image *img, diagnostic *why)
{
    enum { PLANES = 2 * FEATURE_COUNT + 4 };
    *d = (work_planes){.width = img->width, .height = img->height};
    d->count = (size_t)d->width * (size_t)d->height;
    d->memory = calloc(d->count, PLANES * sizeof *d->memory);
    if (!d->memory)
        return diagnose(why, STATUS_FAILURE, MEMORY_REMEDY, "out of memory for the FLIP error");
    double *next = d->memory;
    for (int i = 0; i < FEATURE_COUNT; i++, next += 2 * d->count) {
        d->a.plane[i] = next;
        d->b.plane[i] = next + d->count;
    }
    for (int i = 0; i < 3; i++, next += d->count)
        d->opponent[i] = next;
    d->scratch = next;
    return STATUS_OK;
}

/* Contrast sensitivity as Gaussians, section 4.1.1 with table 1: exp(-pi^2 x^2 / b) at x degrees has sigma sqrt(b / 2)
 * / pi, here in pixels. All filters extend to three sigmas of the widest. */
static convolve_taps sensitivity(double b)
{
    const double widest = 0.04;
    int radius = (int)ceil(3.0 * sqrt(widest / 2.0) / PI * PIXELS_PER_DEGREE);
    return convolve_gaussian(2 * radius + 1, sqrt(b / 2.0) / PI * PIXELS_PER_DEGREE);
}

/* The sum of a two-dimensional Gaussian with peak 1: the square of its sum along one axis. That sum is the inverse of
 * the central tap, because the taps are normalised to the sum 1. */
static double weight_of_peak(const convolve_taps *gaussian)
{
    double middle = gaussian->weight[gaussian->before];
    return 1.0 / (middle * middle);
}

static void filter_colors(const work_planes *d, const features *s)
{
    convolve_taps luminance = sensitivity(0.0047), red_green = sensitivity(0.0053);
    convolve_taps wide = sensitivity(0.04), narrow = sensitivity(0.025);
    double wide_weight = 34.1 * sqrt(PI / 0.04) * weight_of_peak(&wide);
    double narrow_weight = 13.5 * sqrt(PI / 0.025) * weight_of_peak(&narrow);
    double sum = wide_weight + narrow_weight;
    int width = d->width, height = d->height;
    convolve_add(d->opponent[0], width, height, &luminance, &luminance, 1.0, d->scratch, s->plane[LUMINANCE]);
    convolve_add(d->opponent[1], width, height, &red_green, &red_green, 1.0, d->scratch, s->plane[RED_GREEN]);
    convolve_add(d->opponent[2], width, height, &wide, &wide, wide_weight / sum, d->scratch, s->plane[YELLOW_BLUE]);
    convolve_add(d->opponent[2], width, height, &narrow, &narrow, narrow_weight / sum, d->scratch,
                 s->plane[YELLOW_BLUE]);
}

/* Normalises positive weights to the sum 1, negative ones to -1. */
static void balance(convolve_taps *taps)
{
    double positive = 0.0, negative = 0.0;
    for (int i = 0; i < taps->count; i++) {
        positive += taps->weight[i] > 0 ? taps->weight[i] : 0.0;
        negative -= taps->weight[i] < 0 ? taps->weight[i] : 0.0;
    }
    for (int i = 0; i < taps->count; i++)
        taps->weight[i] /= taps->weight[i] > 0 ? positive : negative;
}

/* Section 4.2: first and second derivatives of a Gaussian whose sigma is half of 0.082 degrees, the width of detectable
 * edges. */
static void make_detectors(convolve_taps *smooth, convolve_taps *edge, convolve_taps *point)
{
    const double sigma = 0.5 * 0.082 * PIXELS_PER_DEGREE;
    int radius = (int)ceil(3.0 * sigma);
    *smooth = *edge = *point = convolve_gaussian(2 * radius + 1, sigma);
    for (int i = 0; i < smooth->count; i++) {
        double x = i - radius;
        edge->weight[i] *= -x;
        point->weight[i] *= x * x / (sigma * sigma) - 1.0;
    }
    balance(edge);
    balance(point);
}

/* The magnitude of a detector's gradient. across and down are overwritten. */
static void detect(const work_planes *d, const convolve_taps *detector, const convolve_taps *smooth, double *across,
                   double *down, double *strength)
{
    for (size_t i = 0; i < d->count && !cancel_asked_at(i); i++)
        across[i] = down[i] = 0.0;
    convolve_add(d->opponent[0], d->width, d->height, detector, smooth, 1.0, d->scratch, across);
    convolve_add(d->opponent[0], d->width, d->height, smooth, detector, 1.0, d->scratch, down);
    for (size_t i = 0; i < d->count && !cancel_asked_at(i); i++)
        strength[i] = sqrt(across[i] * across[i] + down[i] * down[i]);
}

static void perceive(const work_planes *d, const image *img, const features *s)
{
    for (size_t i = 0; i < d->count && !cancel_asked_at(i); i++) {
        double opponent[3];
        flip_opponent(img->pixel + 3 * i, opponent);
        for (int channel = 0; channel < 3; channel++)
            d->opponent[channel][i] = opponent[channel];
    }
    filter_colors(d, s);
    convolve_taps smooth, edge, point;
    make_detectors(&smooth, &edge, &point);
    detect(d, &edge, &smooth, d->opponent[1], d->opponent[2], s->plane[EDGES]); /* the colours are filtered: planes 1
                                                                                   and 2 are free */
    detect(d, &point, &smooth, d->opponent[1], d->opponent[2], s->plane[POINTS]);
}

static void lab_at(const features *s, size_t at, double lab[3])
{
    double opponent[3] = {s->plane[LUMINANCE][at], s->plane[RED_GREEN][at], s->plane[YELLOW_BLUE][at]};
    flip_hunt_lab(opponent, lab);
}

/* Section 4.3: a difference of features amplifies the difference of colours. */
static double error_at(const features *a, const features *b, size_t at, double farthest)
{
    double lab_a[3], lab_b[3];
    lab_at(a, at, lab_a);
    lab_at(b, at, lab_b);
    double edges = fabs(a->plane[EDGES][at] - b->plane[EDGES][at]);
    double points = fabs(a->plane[POINTS][at] - b->plane[POINTS][at]);
    double feature = sqrt((edges > points ? edges : points) * sqrt(0.5));
    return elementary_pow(flip_color_error(lab_a, lab_b, farthest), feature < 1.0 ? 1.0 - feature : 0.0);
}

status compare_flip(const image *a, const image *b, double *errors, diagnostic *why)
{
    work_planes d;
    TRY(lay_out_planes(&d, a, why));
    perceive(&d, a, &d.a);
    perceive(&d, b, &d.b);
    double farthest = flip_farthest();
    for (size_t i = 0; i < d.count && !cancel_asked_at(i); i++)
        errors[i] = error_at(&d.a, &d.b, i, farthest);
    free(d.memory);
    return cancel_check(why);
}
