/* Tables, by angle, of the colours that metals and thin films reflect. */
#include "render/plan/layered_table.h"

#include "optics/spectrum.h"
#include <stdlib.h>

/* Three-point Gauss quadrature on every 5 nm interval of the observer's tables: its steps of 1.7 nm resolve the fringes
 * of thin films up to 20 um. */
enum { STEP_NM = 5, INTERVALS = (OBSERVER_HIGH_NM - OBSERVER_LOW_NM) / STEP_NM, SAMPLES = 3 * INTERVALS };

typedef struct daylight_spectrum {
    double lambda_nm[SAMPLES];
    vec3 weight[SAMPLES]; /* their sum is 1 in each channel */
} daylight_spectrum;

static void daylight_spectrum_make(daylight_spectrum *d)
{
    const double offset[3] = {-sqrt(0.6), 0.0, sqrt(0.6)}, fraction[3] = {5.0, 8.0, 5.0};
    vec3 sum = vec3_make(0.0, 0.0, 0.0);
    for (int k = 0; k < SAMPLES; k++) {
        double xyz[3], rgb[3];
        d->lambda_nm[k] = OBSERVER_LOW_NM + STEP_NM * (k / 3 + 0.5 + 0.5 * offset[k % 3]);
        observer_xyz(d->lambda_nm[k], xyz);
        xyz_to_linear_srgb(xyz, rgb);
        d->weight[k] = vec3_scale(vec3_make(rgb[0], rgb[1], rgb[2]), fraction[k % 3] * observer_d65(d->lambda_nm[k]));
        sum = vec3_add(sum, d->weight[k]);
    }
    for (int k = 0; k < SAMPLES; k++)
        d->weight[k] = vec3_make(d->weight[k].x / sum.x, d->weight[k].y / sum.y, d->weight[k].z / sum.z);
}

/* The complex index behind the surface. */
static complex_pair index_behind(const layered_surface *s, double n_to, double lambda_nm)
{
    return s->opaque ? complex_of(index_law_at(&s->law, lambda_nm), material_extinction_index(s->m, lambda_nm))
                     : complex_of(n_to, 0.0);
}

static sp_amplitudes amplitudes(const layered_surface *s, double cos_i, double n_from, complex_pair to,
                                double lambda_nm)
{
    return multilayer_amplitudes(cos_i, n_from, &s->film, s->film.thickness_nm > 0.0, to, lambda_nm);
}

sp_amplitudes layered_amplitudes(const layered_surface *s, double cos_i, double n_from, double n_to, double lambda_nm)
{
    return amplitudes(s, cos_i, n_from, index_behind(s, n_to, lambda_nm), lambda_nm);
}

static double within_unit(double x)
{
    return lesser(greater(x, 0.0), 1.0);
}

static vec3 clamped(vec3 rgb)
{
    return vec3_make(within_unit(rgb.x), within_unit(rgb.y), within_unit(rgb.z));
}

/* The surface's colours at the cosines of a list, not clamped. */
static void colors_at(const layered_surface *s, double n_low, double n_high, int count, const double *cosine, vec3 *out)
{
    daylight_spectrum d;
    complex_pair to[SAMPLES];
    daylight_spectrum_make(&d);
    for (int k = 0; k < SAMPLES; k++)
        to[k] = index_behind(s, n_high, d.lambda_nm[k]);
    for (int i = 0; i < count; i++) {
        out[i] = vec3_make(1.0, 1.0, 1.0); /* grazing light is reflected */
        if (!(cosine[i] > 0.0))
            continue;
        vec3 sum = vec3_make(0.0, 0.0, 0.0);
        for (int k = 0; k < SAMPLES; k++) {
            const sp_amplitudes a = amplitudes(s, cosine[i], n_low, to[k], d.lambda_nm[k]);
            sum = vec3_add(sum, vec3_scale(d.weight[k], 0.5 * (complex_norm2(a.r_s) + complex_norm2(a.r_p))));
        }
        out[i] = sum;
    }
}

vec3 layered_color(const layered_surface *s, double cosine, double n_low, double n_high)
{
    vec3 rgb;
    colors_at(s, n_low, n_high, 1, &cosine, &rgb);
    return clamped(rgb);
}

void layered_curve_make(const layered_surface *s, double n_low, double n_high, layered_curve *out)
{
    double cosine[LAYERED_STEPS + 1];
    out->steps = s->film.thickness_nm > LAYERED_THIN_NM ? LAYERED_STEPS : LAYERED_STEPS_THIN;
    for (int i = 0; i <= out->steps; i++)
        cosine[i] = (double)i / out->steps;
    out->by_ray = s->film.thickness_nm > 0.0 && s->film.index.re < n_low;
    if (!out->by_ray)
        colors_at(s, n_low, n_high, out->steps + 1, cosine, out->color);
}

const layered_curve *layered_curve_of(layered_plan *p, int priority_index, int medium_number)
{
    layered_curve *c = &p->curves[priority_index][medium_number];
    if (atomic_load_explicit(&c->ready, memory_order_acquire))
        return c;
    pthread_mutex_lock(&p->filling);
    if (!atomic_load_explicit(&c->ready, memory_order_relaxed)) {
        const layered_surface *s = p->surface[priority_index];
        const double outer = p->index[medium_number], inner = s->opaque ? outer : p->index[p->medium[priority_index]];
        layered_curve_make(s, lesser(inner, outer), greater(inner, outer), c);
        atomic_store_explicit(&c->ready, true, memory_order_release);
    }
    pthread_mutex_unlock(&p->filling);
    return c;
}

/* Cubic through the four nearest entries (Lagrange). */
vec3 layered_curve_at(const layered_curve *c, double cosine)
{
    const double at = within_unit(cosine) * c->steps;
    int first = (int)at - 1;
    first = first < 0 ? 0 : first > c->steps - 3 ? c->steps - 3 : first;
    const double x = at - first, y = x - 1.0, z = x - 2.0, w = x - 3.0;
    const double weight[4] = {y * z * w / -6.0, x * z * w / 2.0, x * y * w / -2.0, x * y * z / 6.0};
    vec3 sum = vec3_scale(c->color[first], weight[0]);
    for (int k = 1; k < 4; k++)
        sum = vec3_add(sum, vec3_scale(c->color[first + k], weight[k]));
    return clamped(sum);
}

/* Numbers the distinct refractive indices. */
static void number_media(layered_plan *p, const double *ior)
{
    for (size_t r = 0; r < p->priority_indices; r++) {
        int k = 0;
        while (k < p->medium_count && p->index[k] != ior[r])
            k++;
        if (k == p->medium_count)
            p->index[p->medium_count++] = ior[r];
        p->medium[r] = k;
    }
}

/* Allocates the tables; equal surfaces share one. */
static bool make_curves(layered_plan *p, const int *shading_class)
{
    p->curves = calloc(p->priority_indices, sizeof *p->curves);
    p->owns_curves = calloc(p->priority_indices, sizeof *p->owns_curves);
    if (!p->curves || !p->owns_curves)
        return false;
    for (size_t r = 1; r < p->priority_indices; r++) {
        if (!p->surface[r])
            continue;
        const size_t first = (size_t)shading_class[r];
        p->owns_curves[r] = !(first < r && p->curves[first]);
        p->curves[r] = p->owns_curves[r] ? calloc((size_t)p->medium_count, sizeof **p->curves) : p->curves[first];
        if (!p->curves[r])
            return false;
    }
    return true;
}

static bool fill(const render_settings *r, const material *const *materials, const index_law *const *laws,
                 const double *ior, const int *shading_class, layered_plan *p)
{
    p->surface = calloc(p->priority_indices, sizeof *p->surface);
    p->surfaces = calloc(p->priority_indices, sizeof *p->surfaces);
    p->index = calloc(p->priority_indices, sizeof *p->index);
    p->medium = calloc(p->priority_indices, sizeof *p->medium);
    if (!p->surface || !p->surfaces || !p->index || !p->medium)
        return false;
    for (size_t i = 1; i < p->priority_indices; i++) {
        const material *m = materials[i];
        if (!material_is_layered(m, r))
            continue;
        p->surfaces[i] = (layered_surface){.film = {complex_of(m->film_ior, 0.0), m->film_thickness_nm},
                                           .opaque = material_is_opaque(m),
                                           .law = *laws[i],
                                           .m = m};
        p->surface[i] = &p->surfaces[i];
    }
    number_media(p, ior);
    return r->spectrum == SPECTRUM_SPECTRAL || make_curves(p, shading_class);
}

bool layered_plan_create(const render_settings *r, const material *const *materials, const index_law *const *laws,
                         const double *ior, const int *shading_class, size_t priority_indices, layered_plan **out)
{
    bool any = false;
    *out = NULL;
    for (size_t i = 1; i < priority_indices; i++)
        any |= material_is_layered(materials[i], r);
    if (!any)
        return true;
    layered_plan *p = calloc(1, sizeof *p);
    if (p && pthread_mutex_init(&p->filling, NULL) != 0) {
        free(p);
        return false;
    }
    if (p)
        p->priority_indices = priority_indices;
    *out = p;
    return p && fill(r, materials, laws, ior, shading_class, p);
}

void layered_plan_destroy(layered_plan *p)
{
    if (!p)
        return;
    for (size_t r = 0; p->curves && p->owns_curves && r < p->priority_indices; r++)
        if (p->owns_curves[r])
            free(p->curves[r]);
    free(p->curves);
    free(p->owns_curves);
    free(p->surface);
    free(p->surfaces);
    free(p->index);
    free(p->medium);
    pthread_mutex_destroy(&p->filling);
    free(p);
}
