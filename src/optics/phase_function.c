/* A drop's scattering function: rays at evenly spaced angles of incidence; the light between two of them is spread
 * evenly over the solid angle between their directions. */
#include "optics/phase_function.h"

#include "base/elementary.h"
#include "optics/interface.h"

/* The lengths of a disc's chords, summed over a bin that starts at `from`. */
static double chords(double from, double radius)
{
    enum { PARTS = 16 };
    double sum = 0.0;
    for (int i = 0; i < PARTS; i++) {
        const double x = from + (i + 0.5) / PARTS * DROP_BIN_DEG;
        sum += sqrt(greater(radius * radius - x * x, 0.0));
    }
    return sum;
}

/* The blur kernel of a disc: the lengths of its chords, valid away from the poles of the sphere of directions. */
static void disc_make(double radius, drop_angles *out)
{
    double sum = 0.0;
    out->disc_bins = (int)(radius / DROP_BIN_DEG + 0.5);
    if (out->disc_bins == 0) {
        out->disc[0] = 1.0;
        return;
    }
    const int count = 2 * out->disc_bins + 1;
    for (int k = 0; k < count; k++)
        sum += out->disc[k] = chords((k - out->disc_bins - 0.5) * DROP_BIN_DEG, radius);
    for (int k = 0; k < count; k++)
        out->disc[k] /= sum;
}

void drop_angles_make(double disc_radius_deg, drop_angles *out)
{
    double unused;
    for (int k = 0; k <= DROP_BINS; k++)
        elementary_sincos_deg(k * DROP_BIN_DEG, &unused, &out->edge_cosine[k]);
    for (int k = 0; k <= DROP_RAYS; k++)
        elementary_sincos_deg(k * (90.0 / DROP_RAYS), &out->sine[k], &out->cosine[k]);
    disc_make(disc_radius_deg, out);
}

/* A ray of each order: cosine of its angle from the antisolar point, and its power relative to the incident ray's. */
typedef struct outgoing {
    double cosine[DROP_ORDERS], power[DROP_ORDERS];
} outgoing;

/* After m passes through the drop the ray is turned by 2 i - 2 m r + (m - 1) 180 degrees (Born and Wolf, Principles of
 * Optics, 7th ed., 4.7 exercises; van de Hulst, Light Scattering by Small Particles, 12.2). The angle to the antisolar
 * point is 180 degrees less; its cosine is the real part of exp(2i) exp(-2r)^m, with the sign of (-1)^m. */
static outgoing outgoing_rays(const drop_angles *a, int k, double n)
{
    outgoing out;
    const double si = a->sine[k], ci = a->cosine[k];
    const fresnel f = fresnel_dielectric(ci, 1.0, n);
    const double sr = f.total ? 1.0 : si / n, cr = f.cos_t;
    const double back_x = cr * cr - sr * sr, back_y = -2.0 * cr * sr;
    double x = ci * ci - si * si, y = 2.0 * ci * si;
    double s = (1.0 - f.R_s) * (1.0 - f.R_s), p = (1.0 - f.R_p) * (1.0 - f.R_p);
    for (int m = 0; m < DROP_ORDERS; m++) {
        out.cosine[m] = lesser(greater(m % 2 ? -x : x, -1.0), 1.0);
        out.power[m] = m == 0 ? f.R : 0.5 * (s + p);
        if (m > 0)
            s *= f.R_s, p *= f.R_p;
        const double turned = x * back_x - y * back_y;
        y = x * back_y + y * back_x;
        x = turned;
    }
    return out;
}

/* Spreads light evenly by solid angle between two cosines, from the bin of the first; returns the bin of the second. */
static int spread(const double *edge, int bin, double from, double to, double light, double *sum)
{
    if (from == to) {
        sum[bin] += light;
        return bin;
    }
    const double density = light / (to - from);
    while (to < edge[bin + 1] || to > edge[bin]) {
        const bool outwards = to < edge[bin + 1];
        const double border = outwards ? edge[bin + 1] : edge[bin];
        sum[bin] += (border - from) * density;
        from = border;
        bin += outwards ? 1 : -1;
    }
    sum[bin] += (to - from) * density;
    return bin;
}

/* p is `sharp` blurred by the disc; the function is mirrored at both ends. */
static void blur(const drop_angles *a, const double *sharp, double *p)
{
    for (int b = 0; b < DROP_BINS; b++) {
        double sum = 0.0;
        for (int k = -a->disc_bins; k <= a->disc_bins; k++) {
            const int at = b + k, inside = at < 0 ? -1 - at : at < DROP_BINS ? at : 2 * DROP_BINS - 1 - at;
            sum += a->disc[k + a->disc_bins] * sharp[inside];
        }
        p[b] = sum;
    }
}

void drop_scattering(const drop_angles *a, double n, double p[DROP_BINS])
{
    double sharp[DROP_BINS] = {0.0};
    int bin[DROP_ORDERS];
    outgoing last = outgoing_rays(a, 0, n);
    for (int m = 0; m < DROP_ORDERS; m++)
        bin[m] = m % 2 ? DROP_BINS - 1 : 0; /* the ray through the centre */
    for (int k = 1; k <= DROP_RAYS; k++) {
        const outgoing next = outgoing_rays(a, k, n);
        /* The fraction of the drop's cross-section between two rays: their impact parameters are the sines. */
        const double area = a->sine[k] * a->sine[k] - a->sine[k - 1] * a->sine[k - 1];
        for (int m = 0; m < DROP_ORDERS; m++)
            bin[m] = spread(a->edge_cosine, bin[m], last.cosine[m], next.cosine[m],
                            0.5 * area * (last.power[m] + next.power[m]), sharp);
        last = next;
    }
    for (int b = 0; b < DROP_BINS; b++)
        sharp[b] /= drop_bin_fraction(a, b);
    blur(a, sharp, p);
}
