/* What real rays of one field draw: fans, spots, vignetting, colour, geometric MTF; and along the field: foci of narrow
 * pencils (Coddington), distortion. */
#include "lens/lens_private.h"

#include "base/cancel.h"
#include <math.h>
#include <stdlib.h>

/* Components along the field's own direction (tangential) and at right angles to it. On the axis it is Y. */
static void field_axes(const lens_study *s, size_t field, double t[2])
{
    const lens_field *f = &s->p->field[field];
    const double size = hypot(f->x, f->y);
    t[0] = size > 0.0 ? f->x / size : 0.0;
    t[1] = size > 0.0 ? f->y / size : 1.0;
}

static lens_row keyed(const char *section, size_t field, double lambda_nm, double x)
{
    return (lens_row){.section = section, .field = (int)field + 1, .lambda_nm = lambda_nm, .x = x};
}

static void put(lens_report *out, lens_row key, const char *quantity, const char *unit, double value)
{
    key.quantity = quantity, key.unit = unit, key.value = value;
    lens_row_put(out, key);
}

/* --- fans --- */

static status put_fan(lens_study *s, size_t field, lens_beam *bundle, vec3 about, const double t[2], bool sagittal,
                      diagnostic *why)
{
    const int half = s->options->fan_rays;
    const double a = sagittal ? -t[1] : t[0], b = sagittal ? t[0] : t[1];
    for (int i = -half; i <= half; i++) {
        const double p = (double)i / half;
        lens_ray r;
        TRY(cancel_check(why));
        TRY(lens_beam_ray(bundle, a * p, b * p, NULL, &r, why));
        const bool passes = r.loss == LENS_PASSES;
        const vec3 e = vec3_sub(r.image, about);
        const lens_row key = keyed(sagittal ? "fan-sagittal" : "fan-tangential", field, bundle->b->m->lambda_nm, p);
        put(s->out, key, "e_tangential", "mm", passes ? e.x * t[0] + e.y * t[1] : NAN);
        put(s->out, key, "e_sagittal", "mm", passes ? -e.x * t[1] + e.y * t[0] : NAN);
        put(s->out, key, "opd", "waves", lens_opd(bundle, &s->first, &r));
    }
    return STATUS_OK;
}

/* --- spots --- */

typedef struct spot {
    double *x, *y; /* of rays that pass, from the primary wavelength's chief ray */
    int count, launched, early, lost[LENS_SURFACES_MAX + 1];
    double surfaces, media, all; /* sums of the parts of light that surfaces, media and both pass on */
} spot;

/* A square grid of cell centres within the pupil. */
static status spot_trace(lens_study *s, lens_beam *bundle, vec3 about, spot *out, diagnostic *why)
{
    const int n = s->options->spot_grid;
    for (int j = 0; j < n; j++) {
        lens_row_launch row = {.count = 0};
        for (int i = 0; i < n; i++) {
            const double px = (2.0 * i + 1.0) / n - 1.0, py = (2.0 * j + 1.0) / n - 1.0;
            lens_ray r;
            if (px * px + py * py > 1.0)
                continue;
            TRY(cancel_check(why));
            double launch[2] = {NAN, NAN};
            lens_row_guess(&row, launch);
            TRY(lens_beam_ray(bundle, px, py, launch, &r, why));
            lens_row_add(&row, r.loss != LENS_LOST_EARLY, launch);
            out->launched++;
            if (r.loss == LENS_PASSES) {
                out->x[out->count] = r.image.x - about.x, out->y[out->count] = r.image.y - about.y;
                out->count++;
                out->surfaces += r.surfaces, out->media += r.media, out->all += r.surfaces * r.media;
            } else if (r.loss == LENS_LOST_EARLY) {
                out->early++;
            } else {
                out->lost[r.lost_at]++;
            }
        }
    }
    return STATUS_OK;
}

/* Moments of spots that are added by weight. */
typedef struct spot_sum {
    double weight, x, y, square, most;
} spot_sum;

static void spot_add(const spot *one, double weight, spot_sum *sum)
{
    for (int i = 0; i < one->count; i++) {
        const double x = one->x[i], y = one->y[i];
        sum->weight += weight;
        sum->x += weight * x, sum->y += weight * y, sum->square += weight * (x * x + y * y);
        sum->most = fmax(sum->most, x * x + y * y);
    }
}

static void put_spot(lens_study *s, lens_row key, const spot_sum *sum, double lambda_nm)
{
    const double x = sum->x / sum->weight, y = sum->y / sum->weight, square = sum->square / sum->weight;
    put(s->out, key, "rms_centroid", "mm", sqrt(fmax(0.0, square - x * x - y * y)));
    put(s->out, key, "rms_chief", "mm", sqrt(square));
    put(s->out, key, "geo", "mm", sum->weight > 0.0 ? sqrt(sum->most) : NAN);
    put(s->out, key, "centroid_x", "mm", x);
    put(s->out, key, "centroid_y", "mm", y);
    /* The first zero of (2 J1(v) / v)^2 is at v = 3.8317 = pi 1.21967 (Hecht, Optics, on the circular aperture). */
    put(s->out, key, "airy_radius", "mm", 1.2196698912665045 * lambda_nm * 1e-6 * s->first.working_number);
}

static double wave_weight(const lens_study *s, size_t w)
{
    return s->p->wavelength[w].weight;
}

/* Sums of cosines and sines over the spots' points: the transform of the geometric line image. */
static double geometric_mtf(const lens_study *s, const spot *spots, const double along[2], double frequency)
{
    double c = 0.0, d = 0.0, all = 0.0;
    for (size_t w = 0; w < s->waves; w++)
        for (int i = 0; i < spots[w].count; i++) {
            const double phase = 2.0 * M_PI * frequency * (spots[w].x[i] * along[0] + spots[w].y[i] * along[1]);
            c += wave_weight(s, w) * cos(phase);
            d += wave_weight(s, w) * sin(phase);
            all += wave_weight(s, w);
        }
    return hypot(c, d) / all;
}

static void put_mtf(lens_study *s, size_t field, const spot *spots, const double t[2])
{
    enum { STEPS = 40 };
    const double across[2] = {-t[1], t[0]};
    for (int i = 0; i <= STEPS; i++) {
        const double f = s->frequency_most * i / STEPS;
        const lens_row key = keyed("mtf-geometric", field, 0.0, f);
        put(s->out, key, "tangential", "", geometric_mtf(s, spots, t, f));
        put(s->out, key, "sagittal", "", geometric_mtf(s, spots, across, f));
    }
}

static void put_vignetting(lens_study *s, size_t field, const spot *one)
{
    lens_row key = keyed("vignetting", field, s->model[s->primary].lambda_nm, NAN);
    put(s->out, key, "passes", "", one->launched ? (double)one->count / one->launched : NAN);
    put(s->out, key, "before_stop", "", one->launched ? (double)one->early / one->launched : NAN);
    for (int i = 0; i <= s->model->count; i++)
        if (one->lost[i]) {
            key.section = "vignetting-surfaces", key.surface = i + 1;
            put(s->out, key, "lost", "", (double)one->lost[i] / one->launched);
        }
}

/* Of the rays that arrive. */
static void put_transmission(lens_study *s, size_t field, const spot *spots)
{
    double sum = 0.0, weight = 0.0;
    for (size_t w = 0; w < s->waves; w++) {
        const spot *one = &spots[w];
        const double n = one->count ? (double)one->count : (double)NAN;
        const lens_row key = keyed("transmission", field, s->model[w].lambda_nm, NAN);
        put(s->out, key, "surfaces", "", one->surfaces / n);
        put(s->out, key, "media", "", one->media / n);
        put(s->out, key, "transmission", "", one->all / n);
        sum += wave_weight(s, w) * one->all / n, weight += wave_weight(s, w);
        if (w == s->primary)
            s->transmitted = one->all / n;
    }
    put(s->out, keyed("transmission", field, 0.0, NAN), "transmission", "", sum / weight);
}

static void put_points(lens_study *s, size_t field, const spot *spots)
{
    for (size_t w = 0; w < s->waves; w++)
        for (int i = 0; i < spots[w].count; i++) {
            const lens_row key = keyed("spot-points", field, s->model[w].lambda_nm, i + 1);
            put(s->out, key, "dx", "mm", spots[w].x[i]);
            put(s->out, key, "dy", "mm", spots[w].y[i]);
        }
}

static void put_spots(lens_study *s, size_t field, const spot *spots)
{
    spot_sum all = {0};
    for (size_t w = 0; w < s->waves; w++) {
        spot_sum own = {0};
        spot_add(&spots[w], 1.0, &own);
        spot_add(&spots[w], wave_weight(s, w), &all);
        put_spot(s, keyed("spot", field, s->model[w].lambda_nm, NAN), &own, s->model[w].lambda_nm);
    }
    put_spot(s, keyed("spot", field, 0.0, NAN), &all, s->model[s->primary].lambda_nm);
}

static status trace_field(lens_study *s, size_t field, spot *spots, diagnostic *why)
{
    double t[2];
    const lens_field *f = &s->p->field[field];
    lens_beam chief;
    field_axes(s, field, t);
    TRY(lens_beam_aim(&s->bench[s->primary], s->p, &s->first, f->x, f->y, &chief, why));
    const vec3 about = chief.chief.image;
    for (size_t w = 0; w < s->waves; w++) {
        lens_beam bundle;
        TRY(lens_beam_aim(&s->bench[w], s->p, &s->first, f->x, f->y, &bundle, why));
        const lens_row key = keyed("chief", field, s->model[w].lambda_nm, NAN);
        const bool any = bundle.chief.loss == LENS_PASSES;
        put(s->out, key, "image_x", "mm", any ? bundle.chief.image.x : NAN);
        put(s->out, key, "image_y", "mm", any ? bundle.chief.image.y : NAN);
        put(s->out, key, "lateral_colour", "mm",
            any ? (bundle.chief.image.x - about.x) * t[0] + (bundle.chief.image.y - about.y) * t[1] : NAN);
        put(s->out, key, "blocked", "", bundle.blocked);
        TRY(put_fan(s, field, &bundle, about, t, false, why));
        TRY(put_fan(s, field, &bundle, about, t, true, why));
        TRY(spot_trace(s, &bundle, about, &spots[w], why));
    }
    put_vignetting(s, field, &spots[s->primary]);
    put_transmission(s, field, spots);
    put_spots(s, field, spots);
    put_points(s, field, spots);
    put_mtf(s, field, spots, t);
    return STATUS_OK;
}

status lens_images(lens_study *s, size_t field, diagnostic *why)
{
    const size_t room = (size_t)s->options->spot_grid * (size_t)s->options->spot_grid;
    spot *spots = calloc(s->waves, sizeof *spots);
    double *points = malloc(2 * room * s->waves * sizeof *points);
    status code = spots && points ? STATUS_OK : out_of_memory(why);
    for (size_t w = 0; code == STATUS_OK && w < s->waves; w++)
        spots[w].x = points + 2 * w * room, spots[w].y = spots[w].x + room;
    THEN(code, trace_field(s, field, spots, why));
    free(points);
    free(spots);
    return code;
}

/* --- along the field --- */

/* Distances to the foci of a narrow pencil about a chief ray in a plane with the axis (Coddington's equations: Welford,
 * Aberrations of Optical Systems, on astigmatism), from the image's surface along the ray. */
static void pencil_foci(const lens_model *m, const lens_beam *bundle, double *t, double *s)
{
    const lens_ray *r = &bundle->chief;
    vec3 before = bundle->object;
    double vt = 0.0, vs = 0.0; /* n over the distance to the focus: vergences, before each surface */
    for (int i = 0; i <= m->count; i++) {
        const vec3 at = i < m->count ? r->hit[i] : r->image;
        const double n = i < m->count ? fabs(m->step[i].n) : fabs(m->n_image);
        const double length = vec3_dot(vec3_sub(at, before), r->along[i]);
        if (i == 0) {
            vt = vs = bundle->far ? 0.0 : -n / length;
        } else {
            vt = vt / (1.0 - vt * length / n);
            vs = vs / (1.0 - vs * length / n);
        }
        before = at;
        if (i == m->count) {
            *t = n / vt, *s = n / vs;
            return;
        }
        const lens_step *f = &m->step[i];
        if (f->silent)
            continue;
        double slope, bend;
        const double rho = hypot(at.x, at.y);
        lens_sag(f, rho, &slope, &bend);
        const double root = sqrt(1.0 + slope * slope), kt = bend / (root * root * root);
        const double ks = f->shape.form != SIDE_ROUND
                              ? lens_bend_across(f, rho) / root /* the ray is in the plane of Y */
                          : rho > 1e-12 ? slope / (rho * root)
                                        : f->c0;
        const vec3 up = vec3_make(rho > 0.0 ? -slope * at.x / rho : 0.0, rho > 0.0 ? -slope * at.y / rho : 0.0, 1.0);
        const double ci = vec3_dot(r->along[i], up) / root, ci2 = vec3_dot(r->along[i + 1], up) / root;
        const double n2 = fabs(f->n_after), power = n2 * ci2 - n * ci;
        vs += power * ks;
        vt = (vt * ci * ci + power * kt) / (ci2 * ci2);
    }
}

/* The image's height by first order: f tan for a far object, else by the magnification. */
static double ideal_height(const lens_study *s, double x, const lens_beam *bundle)
{
    const lens_model *m = &s->model[s->primary];
    const lens_first *f = &s->first;
    /* From the chief ray of first order, which the exit pupil and the image's plane place. */
    const double per_slope = f->chief.y[m->count - 1] + f->chief.u[m->count] * (m->z_image - m->step[m->count - 1].z);
    const double now = bundle->far ? tan(x * (M_PI / 180.0)) : -bundle->object.y / (m->object_distance + f->z_entrance);
    return f->slope_max != 0.0 ? per_slope * now / f->slope_max : NAN;
}

status lens_curves(lens_study *s, diagnostic *why)
{
    enum { STEPS = 20 };
    const lens_model *m = &s->model[s->primary];
    const double most = lens_field_most(s->p);
    for (int i = 0; i <= STEPS && (most > 0.0 || i == 0); i++) {
        lens_beam bundle;
        const double x = most * i / STEPS;
        double t = NAN, sagittal = NAN;
        TRY(cancel_check(why));
        TRY(lens_beam_aim(&s->bench[s->primary], s->p, &s->first, 0.0, x, &bundle, why));
        const bool any = bundle.chief.loss == LENS_PASSES && !bundle.blocked;
        if (any)
            pencil_foci(m, &bundle, &t, &sagittal);
        const double y = any ? bundle.chief.image.y : NAN, ideal = ideal_height(s, x, &bundle);
        const lens_row key = {.section = "field-curves", .lambda_nm = m->lambda_nm, .x = x};
        put(s->out, key, "tangential", "mm", t * bundle.chief.direction.z);
        put(s->out, key, "sagittal", "mm", sagittal * bundle.chief.direction.z);
        put(s->out, key, "height", "mm", y);
        put(s->out, key, "ideal_height", "mm", ideal);
        put(s->out, key, "distortion", "%", i ? 100.0 * (y - ideal) / ideal : 0.0);
    }
    for (size_t w = 0; w < s->waves; w++) {
        lens_first own;
        TRY(lens_first_make(s->p, &s->model[w], &own, why));
        const lens_row key = {.section = "axial-colour", .lambda_nm = s->model[w].lambda_nm, .x = NAN};
        put(s->out, key, "focus", "mm", own.z_focus - m->z_image);
        put(s->out, key, "shift", "mm", own.z_focus - s->first.z_focus);
        put(s->out, key, "efl", "mm", 1.0 / own.power);
        lens_beam bundle;
        TRY(lens_beam_aim(&s->bench[w], s->p, &s->first, 0.0, 0.0, &bundle, why));
        for (int i = 0; i <= STEPS; i++) {
            lens_ray r;
            TRY(lens_beam_ray(&bundle, 0.0, (double)i / STEPS, NULL, &r, why));
            const double crosses = r.image.z - r.image.y / r.direction.y * r.direction.z - m->z_image;
            const double off = i == 0 ? own.z_focus - m->z_image : r.loss == LENS_PASSES ? crosses : NAN;
            lens_row zone = key;
            zone.section = "longitudinal", zone.x = (double)i / STEPS;
            put(s->out, zone, "focus", "mm", off);
        }
    }
    return STATUS_OK;
}
