/* Aberrations of the third order and of colour by surface, and ghosts: images by light that two surfaces reflect.
 * Welford, Aberrations of Optical Systems, on Seidel sums, aspheric surfaces and chromatic aberration. */
#include "lens/lens_private.h"

#include <math.h>

enum { SUMS = 7 };
static const char *const sum_names[SUMS] = {"S_I", "S_II", "S_III", "S_IV", "S_V", "C_L", "C_T"};

/* S_V is A-bar / A (S_III + S_IV), which is finite where A is 0: with u / n = A / n^2 - y c / n and
 * H = A-bar y - A y-bar the factor A of the sum divides out. */
static void sums_of(const lens_model *m, const lens_first *first, const double spread[2], int i, double out[SUMS])
{
    const lens_step *s = &m->step[i];
    const double y = first->marginal.y[i], yb = first->chief.y[i];
    const double u = first->marginal.u[i], ub = first->chief.u[i], u2 = first->marginal.u[i + 1];
    const double c = s->c0, A = s->n * (u + y * c), Ab = s->n * (ub + yb * c), H = first->invariant;
    const double bend = u2 / s->n_after - u / s->n, P = c * (1.0 / s->n_after - 1.0 / s->n);
    const double squares = 1.0 / (s->n_after * s->n_after) - 1.0 / (s->n * s->n);
    /* 8 times the coefficient of r^4, less that of the sphere with the vertex's curvature */
    const double conic = s->k * s->c * s->c * s->c, folded = c == s->c ? 0.0 : s->c * s->c * s->c - c * c * c;
    const double figure = (conic + folded + 8.0 * s->shape.even[0]) * (s->n_after - s->n);
    const double colour = spread[1] / s->n_after - spread[0] / s->n;
    out[0] = -A * A * y * bend + figure * y * y * y * y;
    out[1] = -A * Ab * y * bend + figure * y * y * y * yb;
    out[2] = -Ab * Ab * y * bend + figure * y * y * yb * yb;
    out[3] = -H * H * P;
    out[4] = -Ab * Ab * Ab * y * squares + (Ab * y + H) * yb * Ab * P + figure * y * yb * yb * yb;
    out[5] = A * y * colour;
    out[6] = Ab * y * colour;
}

/* Indices of the shortest wavelength less those of the longest, before and after surface i. */
static void spread_at(const lens_study *s, int i, double out[2])
{
    size_t shortest = 0, longest = 0;
    for (size_t w = 1; w < s->waves; w++) {
        shortest = s->model[w].lambda_nm < s->model[shortest].lambda_nm ? w : shortest;
        longest = s->model[w].lambda_nm > s->model[longest].lambda_nm ? w : longest;
    }
    out[0] = s->model[shortest].step[i].n - s->model[longest].step[i].n;
    out[1] = s->model[shortest].step[i].n_after - s->model[longest].step[i].n_after;
}

/* Whether the wavefront of third order is what the sums describe: of round surfaces without terms of r and r^3. */
static bool has_sums(const lens_model *m)
{
    bool has = true;
    for (int i = 0; i < m->count; i++) {
        const even_asphere *e = &m->step[i].shape;
        has &= m->step[i].silent || (e->form == SIDE_ROUND && e->odd[0] == 0.0 && e->odd[2] == 0.0);
    }
    return has;
}

void lens_seidel(lens_study *s)
{
    const lens_model *m = &s->model[s->primary];
    const double known = has_sums(m) ? 0.0 : NAN; /* the sums of a part of the surfaces mean nothing */
    double total[SUMS] = {0.0}, spread[2];
    for (int i = 0; i <= m->count; i++) {
        double own[SUMS];
        if (i < m->count) {
            spread_at(s, i, spread);
            sums_of(m, &s->first, spread, i, own);
        }
        for (int k = 0; k < SUMS; k++) {
            total[k] += (i < m->count ? own[k] : 0.0) + known;
            lens_row_put(s->out, (lens_row){.section = i < m->count ? "seidel" : "seidel-sum",
                                            .surface = i < m->count ? i + 1 : 0,
                                            .x = NAN,
                                            .lambda_nm = m->lambda_nm,
                                            .quantity = sum_names[k],
                                            .unit = "mm",
                                            .value = i < m->count ? own[k] + known : total[k]});
        }
    }
    const double wave = m->lambda_nm * 1e-6;
    const struct {
        const char *name;
        double value;
    } waves[] = {{"W040", total[0] / 8.0}, {"W131", total[1] / 2.0},
                 {"W222", total[2] / 2.0}, {"W220", (total[2] + total[3]) / 4.0},
                 {"W311", total[4] / 2.0}, {"W020_colour", total[5] / 2.0},
                 {"W111_colour", total[6]}};
    for (size_t k = 0; k < sizeof waves / sizeof waves[0]; k++)
        lens_row_put(s->out, (lens_row){.section = "seidel-waves",
                                        .x = NAN,
                                        .lambda_nm = m->lambda_nm,
                                        .quantity = waves[k].name,
                                        .unit = "waves",
                                        .value = waves[k].value / wave});
}

/* --- ghosts --- */

/* The marginal ray refracted, or reflected, by surface i, and moved to surface `next` or to the image. Indices are
 * positive; `way` is 1 along the light's way and -1 against it. Mirrors reflect on the regular way. */
typedef struct ghost_ray {
    double y, u, n;
} ghost_ray;

static void ghost_step(const lens_model *m, int i, bool forth, bool reflects, ghost_ray *r)
{
    const lens_step *s = &m->step[i];
    const double before = forth ? s->n : -s->n_after, after = forth ? s->n_after : -s->n;
    const double next = reflects ? -before : after;
    r->u = (before * r->u - r->y * (next - before) * s->c0) / next;
    r->n = next;
}

static void ghost_move(const lens_model *m, int i, bool forth, ghost_ray *r)
{
    const int j = forth ? i + 1 : i - 1;
    const double to = j >= m->count ? m->z_image : m->step[j].z;
    r->y += r->u * (to - m->step[i].z);
}

/* By surface, for light along the axis: reflectances from before and from behind, and transmittance, with coatings. A
 * mirror passes the light on by its reflectance. */
typedef struct ghost_powers {
    double R[LENS_SURFACES_MAX], back[LENS_SURFACES_MAX], T[LENS_SURFACES_MAX];
    bool mirrors;
} ghost_powers;

/* A ghost by surfaces j and then i < j. Returns the fraction of the light; the ray ends at the image. */
static double ghost_trace(const lens_study *s, int i, int j, const ghost_powers *g, ghost_ray *r)
{
    const lens_model *m = &s->model[s->primary];
    double weight = 1.0;
    *r = (ghost_ray){s->first.marginal.y[0], s->first.marginal.u[0], m->n_object};
    for (int k = 0; k < j; k++) {
        ghost_step(m, k, true, false, r);
        weight *= g->T[k];
        ghost_move(m, k, true, r);
    }
    ghost_step(m, j, true, true, r);
    weight *= g->R[j];
    for (int k = j; k > i; k--) {
        ghost_move(m, k, false, r);
        ghost_step(m, k - 1, false, k - 1 == i, r);
        weight *= k - 1 == i ? g->back[i] : g->T[k - 1];
    }
    for (int k = i; k < m->count; k++) {
        ghost_move(m, k, true, r);
        if (k + 1 < m->count) {
            ghost_step(m, k + 1, true, false, r);
            weight *= g->T[k + 1];
        }
    }
    return weight;
}

/* Whether a mirror lies between: the light back from j would meet it again, and its ghosts are other images. */
static bool mirror_between(const lens_model *m, int i, int j)
{
    for (int k = i; k <= j; k++)
        if (m->step[k].mirror)
            return true;
    return false;
}

static status measure_powers(const lens_study *s, ghost_powers *g, diagnostic *why)
{
    const lens_model *m = &s->model[s->primary];
    lens_bench *b = &s->bench[s->primary];
    g->mirrors = false;
    for (int i = 0; i < m->count; i++) {
        g->R[i] = g->back[i] = b->R[i];
        g->T[i] = m->step[i].mirror ? b->R[i] : b->T[i];
        g->mirrors |= m->step[i].mirror;
    }
    return g->mirrors ? STATUS_OK : lens_reflectances_back(b, g->back, why);
}

/* The light that arrives after an even number of reflections, in all orders: forth[i] arrives at surface i, the last at
 * the image, after k reflections; back[i] comes back to surface i. */
static double reflected_light(const lens_model *m, const ghost_powers *g, int reflections)
{
    double forth[LENS_SURFACES_MAX + 1], back[LENS_SURFACES_MAX];
    forth[0] = 1.0;
    for (int i = 0; i < m->count; i++)
        forth[i + 1] = forth[i] * g->T[i];
    for (int k = 0; k < reflections; k += 2) {
        back[m->count - 1] = 0.0;
        for (int i = m->count - 1; i > 0; i--)
            back[i - 1] = back[i] * g->T[i] + forth[i] * g->R[i];
        forth[0] = 0.0;
        for (int i = 0; i < m->count; i++)
            forth[i + 1] = forth[i] * g->T[i] + back[i] * g->back[i];
    }
    return forth[m->count];
}

static void put_ghost_sum(lens_study *s, double reflections, const char *quantity, double value)
{
    lens_row_put(s->out, (lens_row){.section = "ghosts-sum",
                                    .x = reflections,
                                    .lambda_nm = s->model[s->primary].lambda_nm,
                                    .quantity = quantity,
                                    .unit = "",
                                    .value = value});
}

status lens_ghosts(lens_study *s, diagnostic *why)
{
    const lens_model *m = &s->model[s->primary];
    lens_bench *b = &s->bench[s->primary];
    lens_ray axis;
    ghost_powers g;
    TRY(lens_ray_trace(
        b, vec3_make(0.0, 0.0, isinf(m->object_distance) ? -1.0 - 0.1 * m->step[m->count - 1].z : -m->object_distance),
        vec3_make(0.0, 0.0, 1.0), &axis, why));
    TRY(measure_powers(s, &g, why));
    double total = 0.0, omitted = 0.0;
    for (int j = 1; j < m->count && axis.loss == LENS_PASSES; j++)
        for (int i = 0; i < j; i++) {
            if (m->step[i].silent || m->step[j].silent)
                continue;
            if (mirror_between(m, i, j)) {
                omitted++;
                continue;
            }
            ghost_ray r;
            const double weight = ghost_trace(s, i, j, &g, &r);
            const struct {
                const char *name, *unit;
                double value;
            } rows[] = {{"focus", "mm", r.u == 0.0 ? INFINITY : -r.y / r.u},
                        {"blur_radius", "mm", fabs(r.y)},
                        {"weight", "", weight}};
            for (int k = 0; k < 3; k++)
                lens_row_put(s->out, (lens_row){.section = "ghosts",
                                                .surface = j + 1,
                                                .x = i + 1,
                                                .lambda_nm = m->lambda_nm,
                                                .quantity = rows[k].name,
                                                .unit = rows[k].unit,
                                                .value = rows[k].value});
            total += weight;
        }
    const bool passes = axis.loss == LENS_PASSES;
    put_ghost_sum(s, 2.0, "weight", passes ? total : NAN);
    put_ghost_sum(s, 2.0, "omitted", passes ? omitted : NAN);
    if (!g.mirrors)
        put_ghost_sum(s, 4.0, "weight", passes ? reflected_light(m, &g, 4) : NAN);
    return STATUS_OK;
}
