/* Tables of the drops' scattering function by wavelength, or of its colour. */
#include "render/shade/rain.h"

#include "base/elementary.h"
#include "optics/phase_function.h"
#include "optics/spectrum.h"
#include "scene/model/medium.h"
#include <math.h>
#include <stdlib.h>

/* Between neighbouring wavelengths the violet edge moves by 0.07 degrees, an eighth of the sun's disc. */
enum { STEP_NM = 5, NODES = (OBSERVER_HIGH_NM - OBSERVER_LOW_NM) / STEP_NM };

struct rain {
    vec3 from_sun; /* the antisolar direction */
    bool spectral;
    double (*at)[DROP_BINS]; /* by wavelength; one row of working space for a film of three channels */
    double share[NODES];     /* mean over the sphere by wavelength */
    vec3 color[DROP_BINS], color_mean;
};

static double node_lambda(int node)
{
    return OBSERVER_LOW_NM + STEP_NM * (node + 0.5);
}

/* The observer's share of a wavelength in the colour of white light. */
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
    r->color_mean = vec3_add(r->color_mean, vec3_scale(color, r->share[node]));
}

static void fill(rain *r, const background *sky, drop_angles *a)
{
    const medium *drops = media_at((size_t)(DROPS_FIRST + sky->drops)), *air = media_find("air");
    drop_angles_make(SUN_RADIUS_DEG, a);
    for (int node = 0; node < NODES; node++) {
        double *p = r->at[r->spectral ? node : 0];
        const double lambda_nm = node_lambda(node);
        drop_scattering(a, medium_index(drops, lambda_nm) / medium_index(air, lambda_nm), p);
        for (int b = 0; b < DROP_BINS; b++)
            p[b] *= sky->rain;
        r->share[node] = mean_of(a, p);
        if (!r->spectral)
            add_color(r, node, p);
    }
}

rain *rain_create(const background *sky, vec3 to_sun, bool spectral)
{
    rain *r = calloc(1, sizeof *r);
    drop_angles *angles = calloc(1, sizeof *angles);
    if (r && angles && (r->at = calloc(spectral ? NODES : 1, sizeof *r->at))) {
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
        free(r->at);
    free(r);
}

/* A place between two entries of a table. */
typedef struct place {
    int low;
    double part;
} place;

/* Entries stand at 0.5, 1.5, ... ; constant beyond the ends. */
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

double rain_share(const rain *r, double lambda_nm, vec3 direction)
{
    const place angle = angle_of(r, direction), node = node_of(lambda_nm);
    return between((const double[2]){between(r->at[node.low], angle), between(r->at[node.low + 1], angle)},
                   (place){0, node.part});
}

double rain_share_mean(const rain *r, double lambda_nm)
{
    return between(r->share, node_of(lambda_nm));
}
