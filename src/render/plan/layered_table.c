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

static int films_of(const layered_surface *s, bool inward, double lambda_nm, thin_film films[FILMS_MAX])
{
    return s->stack ? film_stack_films(s->stack, lambda_nm, inward, films) : 0;
}

sp_amplitudes layered_amplitudes(const layered_surface *s, bool inward, double cos_i, double n_from, double n_to,
                                 double lambda_nm)
{
    thin_film films[FILMS_MAX];
    const int count = films_of(s, inward, lambda_nm, films);
    return multilayer_amplitudes(cos_i, n_from, films, count, index_behind(s, n_to, lambda_nm), lambda_nm);
}

static double within_unit(double x)
{
    return lesser(greater(x, 0.0), 1.0);
}

static vec3 clamped(vec3 rgb)
{
    return vec3_make(within_unit(rgb.x), within_unit(rgb.y), within_unit(rgb.z));
}

static const vec3 white = {1.0, 1.0, 1.0}, black = {0.0, 0.0, 0.0};

static bool surface_absorbs(const layered_surface *s)
{
    return !s->opaque && s->stack && s->stack->absorbs;
}

/* --- integrals over daylight --- */

/* A surface and the indices on its sides. */
typedef struct sides {
    const layered_surface *of;
    double n_low, n_high;
    bool inward; /* a ray from the side of the lower index runs inwards */
} sides;

static sides sides_of(const layered_surface *s, double n_out, double n_in)
{
    return (sides){s, lesser(n_out, n_in), greater(n_out, n_in), n_out <= n_in};
}

static double cosine_on_side(const sides *s, layered_side side, double x)
{
    const double ratio = s->n_low / s->n_high, low2 = ratio * ratio;
    switch (side) {
    case LAYERED_DENSE: return sqrt(1.0 - low2 * (1.0 - x * x)); /* Snell */
    case LAYERED_BEYOND: return sqrt(1.0 - low2) * (1.0 - x * x) / (1.0 + x * x);
    case LAYERED_LOW:
    case LAYERED_THROUGH:
    case LAYERED_SIDES: break;
    }
    return x;
}

/* The colours of a side at some abscissas, not clamped. */
static void colors_at(const sides *s, layered_side side, int count, const double *x, vec3 *out)
{
    const bool dense = side == LAYERED_DENSE || side == LAYERED_BEYOND, through = side == LAYERED_THROUGH;
    const double n_from = dense ? s->n_high : s->n_low, n_to = dense ? s->n_low : s->n_high;
    daylight_spectrum d;
    daylight_spectrum_make(&d);
    for (int i = 0; i < count; i++)
        out[i] = black;
    for (int k = 0; k < SAMPLES; k++) {
        thin_film films[FILMS_MAX];
        const int layers = films_of(s->of, s->inward != dense, d.lambda_nm[k], films);
        const complex_pair to = index_behind(s->of, n_to, d.lambda_nm[k]);
        for (int i = 0; i < count; i++) {
            const double cosine = cosine_on_side(s, side, x[i]);
            if (!(cosine > 0.0))
                continue;
            const sp_amplitudes a = multilayer_amplitudes(cosine, n_from, films, layers, to, d.lambda_nm[k]);
            const complex_pair of_s = through ? a.t_s : a.r_s, of_p = through ? a.t_p : a.r_p;
            out[i] = vec3_add(out[i], vec3_scale(d.weight[k], 0.5 * (complex_norm2(of_s) + complex_norm2(of_p))));
        }
    }
    for (int i = 0; i < count; i++)
        if (!(cosine_on_side(s, side, x[i]) > 0.0))
            out[i] = through ? black : white; /* grazing light is reflected */
}

/* --- tables --- */

/* Cubic through the four nearest entries (Lagrange). */
static vec3 curve_color(const layered_curve *c, double x)
{
    const double at = within_unit(x) * c->steps;
    int first = (int)at - 1;
    first = first < 0 ? 0 : first > c->steps - 3 ? c->steps - 3 : first;
    const double d = at - first, y = d - 1.0, z = d - 2.0, w = d - 3.0;
    const double weight[4] = {y * z * w / -6.0, d * z * w / 2.0, d * y * w / -2.0, d * y * z / 6.0};
    vec3 sum = vec3_scale(c->color[first], weight[0]);
    for (int k = 1; k < 4; k++)
        sum = vec3_add(sum, vec3_scale(c->color[first + k], weight[k]));
    return sum;
}

/* Fills entries first, first + step, ... of a table. */
static void fill_entries(const sides *s, layered_side side, int first, int step, layered_curve *c)
{
    double x[LAYERED_STEPS_MOST + 1] = {0.0};
    vec3 color[LAYERED_STEPS_MOST + 1];
    int count = 0;
    for (int i = first; i <= c->steps; i += step)
        x[count++] = (double)i / c->steps;
    colors_at(s, side, count, x, color);
    for (int k = 0; k < count; k++)
        c->color[first + k * step] = color[k];
}

static double apart(vec3 a, vec3 b)
{
    return greater(magnitude(a.x - b.x), greater(magnitude(a.y - b.y), magnitude(a.z - b.z)));
}

/* Doubles the steps of a table; returns the largest error of interpolation that it had at a new entry. */
static double refine(const sides *s, layered_side side, layered_curve *c)
{
    const layered_curve old = *c;
    vec3 guess[LAYERED_STEPS_MOST / 2];
    double error = 0.0;
    for (int k = 0; k < old.steps; k++)
        guess[k] = curve_color(&old, (k + 0.5) / old.steps);
    for (int k = old.steps; k > 0; k--)
        c->color[2 * k] = old.color[k];
    c->steps = 2 * old.steps;
    fill_entries(s, side, 1, 2, c);
    for (int k = 0; k < old.steps; k++)
        error = greater(error, apart(guess[k], c->color[2 * k + 1]));
    return error;
}

/* Without memory for its entries, a table integrates for each ray. */
static void curve_make(const sides *s, layered_side side, layered_curve *c)
{
    const double tolerance = 1e-4;
    const film_stack *stack = s->of->stack;
    const bool several = stack && (stack->layers.count > 1 || surface_absorbs(s->of));
    c->steps = !several && stack && stack->thickness_nm[0] > LAYERED_THIN_NM ? LAYERED_STEPS : LAYERED_STEPS_THIN;
    if (!several && stack && film_stack_index(stack, 0, 587.5618).re < s->n_low)
        return;
    c->color = calloc(several ? LAYERED_STEPS_MOST + 1 : (size_t)c->steps + 1, sizeof *c->color);
    if (!c->color)
        return;
    fill_entries(s, side, 0, 1, c);
    while (several && c->steps < LAYERED_STEPS_MOST && refine(s, side, c) > tolerance)
        ;
}

void layered_curves_make(const layered_surface *s, double n_out, double n_in, layered_curves *out)
{
    const sides both = sides_of(s, n_out, s->opaque ? n_out : n_in);
    for (int side = LAYERED_LOW; side < (surface_absorbs(s) ? LAYERED_SIDES : LAYERED_LOW + 1); side++)
        if (side != LAYERED_BEYOND || both.n_low < both.n_high)
            curve_make(&both, (layered_side)side, &out->side[side]);
}

void layered_curves_release(layered_curves *c)
{
    for (int side = 0; side < LAYERED_SIDES; side++)
        free(c->side[side].color);
}

static vec3 color_of(const sides *s, const layered_curves *c, layered_side side, double x)
{
    vec3 rgb;
    if (c && c->side[side].color)
        return clamped(curve_color(&c->side[side], x));
    colors_at(s, side, 1, &x, &rgb);
    return clamped(rgb);
}

/* Layers that absorb: the two sides differ, and the transmitted light is not the rest. */
static layered_colors absorbing_colors(const sides *s, const layered_curves *c, bool inward, double cos_i, double cos_t,
                                       bool total)
{
    const bool low = inward == s->inward;
    const double cosine = low ? cos_i : cos_t;
    if (total) {
        const double ratio = s->n_low / s->n_high, share = cos_i / sqrt(1.0 - ratio * ratio),
                     t = sqrt(greater(1.0 - share, 0.0) / (1.0 + share));
        return (layered_colors){color_of(s, c, LAYERED_BEYOND, t), black};
    }
    const vec3 R = color_of(s, c, low ? LAYERED_LOW : LAYERED_DENSE, cosine),
               T = color_of(s, c, LAYERED_THROUGH, cosine);
    return (layered_colors){R, vec3_make(lesser(T.x, 1.0 - R.x), lesser(T.y, 1.0 - R.y), lesser(T.z, 1.0 - R.z))};
}

layered_colors layered_colors_at(const layered_surface *s, const layered_curves *c, bool inward, double cos_i,
                                 double n_from, double n_to)
{
    if (s->opaque) {
        const sides one = sides_of(s, n_from, n_from);
        return (layered_colors){color_of(&one, c, LAYERED_LOW, cos_i), black};
    }
    const sides both = sides_of(s, inward ? n_from : n_to, inward ? n_to : n_from);
    const fresnel f = fresnel_dielectric(cos_i, n_from, n_to);
    if (surface_absorbs(s))
        return absorbing_colors(&both, c, inward, cos_i, f.cos_t, f.total);
    if (f.total)
        return (layered_colors){white, black};
    const vec3 R = color_of(&both, c, LAYERED_LOW, n_from > n_to ? f.cos_t : cos_i);
    return (layered_colors){R, vec3_sub(white, R)};
}

const layered_curves *layered_curves_of(layered_plan *p, int priority_index, int medium_number)
{
    layered_curves *c = &p->curves[priority_index][medium_number];
    if (atomic_load_explicit(&c->ready, memory_order_acquire))
        return c;
    pthread_mutex_lock(&p->filling);
    if (!atomic_load_explicit(&c->ready, memory_order_relaxed)) {
        const layered_surface *s = p->surface[priority_index];
        layered_curves_make(s, p->index[medium_number], p->index[p->medium[priority_index]], c);
        atomic_store_explicit(&c->ready, true, memory_order_release);
    }
    pthread_mutex_unlock(&p->filling);
    return c;
}

/* --- the plan --- */

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

/* Sets the layers of a surface: those of the surface before it, if they are the same. */
static bool add_stack(layered_plan *p, size_t i, size_t *last)
{
    layered_surface *s = &p->surfaces[i];
    if (!material_has_film(s->m))
        return true;
    const layered_surface *before = *last ? &p->surfaces[*last] : NULL;
    if (before && material_films_match(before->m, s->m)) {
        s->stack = before->stack;
        return true;
    }
    if (!(p->stacks[i] = malloc(sizeof *p->stacks[i])))
        return false;
    material_film_stack(s->m, p->stacks[i]);
    s->stack = p->stacks[i];
    *last = i;
    return true;
}

static bool fill(const render_settings *r, const material *const *materials, const index_law *const *laws,
                 const double *ior, const int *shading_class, layered_plan *p)
{
    p->surface = calloc(p->priority_indices, sizeof *p->surface);
    p->surfaces = calloc(p->priority_indices, sizeof *p->surfaces);
    p->stacks = calloc(p->priority_indices, sizeof(film_stack *));
    p->index = calloc(p->priority_indices, sizeof *p->index);
    p->medium = calloc(p->priority_indices, sizeof *p->medium);
    if (!p->surface || !p->surfaces || !p->stacks || !p->index || !p->medium)
        return false;
    size_t last = 0;
    for (size_t i = 1; i < p->priority_indices; i++) {
        const material *m = materials[i];
        if (!material_is_layered(m, r))
            continue;
        p->surfaces[i] = (layered_surface){.opaque = material_is_opaque(m), .law = *laws[i], .m = m};
        p->surface[i] = &p->surfaces[i];
        if (!add_stack(p, i, &last))
            return false;
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
    for (size_t r = 0; p->curves && p->owns_curves && r < p->priority_indices; r++) {
        if (!p->owns_curves[r] || !p->curves[r])
            continue;
        for (int k = 0; k < p->medium_count; k++)
            layered_curves_release(&p->curves[r][k]);
        free(p->curves[r]);
    }
    for (size_t r = 0; p->stacks && r < p->priority_indices; r++)
        free(p->stacks[r]);
    free(p->stacks);
    free(p->curves);
    free(p->owns_curves);
    free(p->surface);
    free(p->surfaces);
    free(p->index);
    free(p->medium);
    pthread_mutex_destroy(&p->filling);
    free(p);
}
