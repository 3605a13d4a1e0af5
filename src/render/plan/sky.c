/* Radiance and mean of the background's kinds; tables of the rain drops' scattering function by wavelength, or of its
 * colour. */
#include "render/plan/sky.h"

#include "base/elementary.h"
#include "optics/phase_function.h"
#include "optics/spectrum.h"
#include "scene/model/medium.h"
#include <math.h>
#include <stdlib.h>

static vec3 sky_image_texel(const image *img, int x, int y)
{
    const float *p = &img->pixel[((size_t)y * (size_t)img->width + (size_t)x) * 3];
    return vec3_make((double)p[0], (double)p[1], (double)p[2]);
}

static vec3 mix(vec3 a, vec3 b, double fraction)
{
    return vec3_add(vec3_scale(a, 1.0 - fraction), vec3_scale(b, fraction));
}

static int wrap(int x, int width)
{
    x %= width;
    return x < 0 ? x + width : x;
}

static int clamp(int y, int height)
{
    return y < 0 ? 0 : y >= height ? height - 1 : y;
}

/* Bilinear; longitude wraps around, latitude is clamped. */
static vec3 sky_image_radiance(const image *img, vec3 d)
{
    double longitude = elementary_atan2_deg(d.x, d.z),
           latitude = elementary_atan2_deg(d.y, sqrt(d.x * d.x + d.z * d.z));
    double u = (0.5 + longitude / 360.0) * img->width - 0.5, v = (0.5 - latitude / 180.0) * img->height - 0.5;
    double left = floor(u), top = floor(v);
    int x0 = wrap((int)left, img->width), x1 = wrap((int)left + 1, img->width);
    int y0 = clamp((int)top, img->height), y1 = clamp((int)top + 1, img->height);
    vec3 upper = mix(sky_image_texel(img, x0, y0), sky_image_texel(img, x1, y0), u - left);
    vec3 lower = mix(sky_image_texel(img, x0, y1), sky_image_texel(img, x1, y1), u - left);
    return mix(upper, lower, v - top);
}

vec3 sky_radiance(const background *sky, vec3 direction)
{
    switch ((background_kind)sky->kind) {
    case BACKGROUND_UNIFORM: return sky->color;
    case BACKGROUND_RAIN:
    case BACKGROUND_GRADIENT: return mix(sky->horizon, sky->color, direction.y > 0.0 ? direction.y : 0.0);
    case BACKGROUND_IMAGE:
        return sky->img ? vec3_scale(sky_image_radiance(sky->img, direction), sky->brightness) : sky->color;
    case BACKGROUND_CIE:
        return direction.y > 0.0 ? vec3_scale(sky->color, cie_sky_relative(&sky->cie, direction)) : sky->horizon;
    }
    return sky->color;
}

/* The weight of a row of texels in the mean: the integral of its interpolation, a hat function from the row above to
 * the row below, times the sine of the polar angle. With rows h apart that is sin(angle) 2 (1 - cos h) / h; a row next
 * to a pole is constant up to the pole: 1 - 2 cos h sin(h / 2) / h. The weights add up to 2. */
static double row_weight(int y, int height)
{
    const double h_deg = 180.0 / height, h = 3.141592653589793 / height;
    double sin_h, cos_h, sin_half, cos_half, sine, cosine;
    if (height == 1)
        return 2.0;
    elementary_sincos_deg(h_deg, &sin_h, &cos_h);
    elementary_sincos_deg(0.5 * h_deg, &sin_half, &cos_half);
    if (y == 0 || y == height - 1)
        return 1.0 - 2.0 * cos_h * sin_half / h;
    elementary_sincos_deg((y + 0.5) * h_deg, &sine, &cosine);
    return sine * 4.0 * sin_half * sin_half / h;
}

static vec3 sky_image_mean(const image *img)
{
    vec3 mean = {0.0, 0.0, 0.0};
    for (int y = 0; y < img->height; y++) {
        vec3 row = {0.0, 0.0, 0.0};
        for (int x = 0; x < img->width; x++)
            row = vec3_add(row, sky_image_texel(img, x, y));
        mean = vec3_add(mean, vec3_scale(row, 0.5 * row_weight(y, img->height) / img->width));
    }
    return mean;
}

vec3 sky_mean(const background *sky)
{
    switch ((background_kind)sky->kind) {
    case BACKGROUND_UNIFORM: return sky->color;
    case BACKGROUND_RAIN:
    case BACKGROUND_GRADIENT: return mix(sky->horizon, sky->color, 0.25);
    case BACKGROUND_IMAGE: return sky->img ? vec3_scale(sky_image_mean(sky->img), sky->brightness) : sky->color;
    case BACKGROUND_CIE: return mix(sky->horizon, vec3_scale(sky->color, sky->cie.mean), 0.5);
    }
    return sky->color;
}

/* --- rain --- */

/* Between neighbouring wavelengths the violet edge moves by 0.07 degrees, an eighth of the sun's disc. */
enum { STEP_NM = 5, NODES = (OBSERVER_HIGH_NM - OBSERVER_LOW_NM) / STEP_NM };

struct rain {
    vec3 from_sun; /* the antisolar direction */
    bool spectral;
    double (*radiance)[DROP_BINS]; /* by wavelength; for a film of three channels, one row of working memory */
    double mean[NODES];            /* over the sphere, by wavelength */
    vec3 color[DROP_BINS], color_mean;
};

static double node_lambda(int node)
{
    return OBSERVER_LOW_NM + STEP_NM * (node + 0.5);
}

/* The contribution of a wavelength to the colour of white light. */
static void node_color(int node, double rgb[3])
{
    double xyz[3];
    observer_weights(node_lambda(node), xyz);
    for (int c = 0; c < 3; c++)
        xyz[c] *= observer_d65(node_lambda(node)) / NODES;
    xyz_to_linear_srgb(xyz, rgb);
}

static double mean_of(const drop_angles *a, const double *p)
{
    double sum = 0.0;
    for (int b = 0; b < DROP_BINS; b++)
        sum += p[b] * drop_bin_fraction(a, b);
    return sum;
}

static void add_color(rain *r, int node, const double *p)
{
    double rgb[3];
    node_color(node, rgb);
    const vec3 color = vec3_make(rgb[0], rgb[1], rgb[2]);
    for (int b = 0; b < DROP_BINS; b++)
        r->color[b] = vec3_add(r->color[b], vec3_scale(color, p[b]));
    r->color_mean = vec3_add(r->color_mean, vec3_scale(color, r->mean[node]));
}

static void fill(rain *r, const background *sky, drop_angles *a)
{
    const medium *drops = media_at((size_t)(DROPS_FIRST + sky->drops)), *air = media_find("air");
    drop_angles_make(SUN_RADIUS_DEG, a);
    for (int node = 0; node < NODES; node++) {
        double *p = r->radiance[r->spectral ? node : 0];
        const double lambda_nm = node_lambda(node);
        drop_scattering(a, medium_index(drops, lambda_nm) / medium_index(air, lambda_nm), p);
        for (int b = 0; b < DROP_BINS; b++)
            p[b] *= sky->rain;
        r->mean[node] = mean_of(a, p);
        if (!r->spectral)
            add_color(r, node, p);
    }
}

rain *rain_create(const background *sky, vec3 to_sun, bool spectral)
{
    rain *r = calloc(1, sizeof *r);
    drop_angles *angles = calloc(1, sizeof *angles);
    if (r && angles && (r->radiance = calloc(spectral ? NODES : 1, sizeof *r->radiance))) {
        r->spectral = spectral;
        r->from_sun = vec3_scale(to_sun, -1.0);
        fill(r, sky, angles);
        free(angles);
        return r;
    }
    free(angles);
    rain_destroy(r);
    return NULL;
}

void rain_destroy(rain *r)
{
    if (r)
        free(r->radiance);
    free(r);
}

/* A position between two entries of a table. */
typedef struct place {
    int low;
    double part;
} place;

/* Entries are at 0.5, 1.5, ...; values are constant beyond the ends. */
static place place_of(double position, int count)
{
    const double at = position - 0.5;
    if (!(at > 0.0))
        return (place){0, 0.0};
    return at >= count - 1 ? (place){count - 2, 1.0} : (place){(int)at, at - (int)at};
}

static place angle_of(const rain *r, vec3 d)
{
    const double angle = elementary_atan2_deg(vec3_length(vec3_cross(d, r->from_sun)), vec3_dot(d, r->from_sun));
    return place_of(angle / DROP_BIN_DEG, DROP_BINS);
}

static double between(const double *v, place at)
{
    return v[at.low] * (1.0 - at.part) + v[at.low + 1] * at.part;
}

vec3 rain_color(const rain *r, vec3 direction)
{
    const place at = angle_of(r, direction);
    return vec3_add(vec3_scale(r->color[at.low], 1.0 - at.part), vec3_scale(r->color[at.low + 1], at.part));
}

vec3 rain_color_mean(const rain *r)
{
    return r->color_mean;
}

static place node_of(double lambda_nm)
{
    return place_of((lambda_nm - OBSERVER_LOW_NM) / STEP_NM, NODES);
}

double rain_radiance(const rain *r, double lambda_nm, vec3 direction)
{
    const place angle = angle_of(r, direction), node = node_of(lambda_nm);
    return between((const double[2]){between(r->radiance[node.low], angle), between(r->radiance[node.low + 1], angle)},
                   (place){0, node.part});
}

double rain_radiance_mean(const rain *r, double lambda_nm)
{
    return between(r->mean, node_of(lambda_nm));
}
