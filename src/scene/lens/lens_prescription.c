/* Media, surfaces and paraxial properties of a lens prescription (lens_prescription.h). */
#include "scene/lens/lens_prescription.h"
#include "geometry/solid.h"
#include "scene/lens/lens_reader.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

lens_prescription lens_prescription_empty(void)
{
    return (lens_prescription){
        .unit_mm = 1.0,
        .stop = -1,
        .object_distance = INFINITY,
        .field = {{0.0, 0.0, 1.0}},
        .field_count = 1,
        .wavelength = {{LINE_HELIUM_D_NM, 1.0}},
        .wavelength_count = 1,
    };
}

void lens_prescription_release(lens_prescription *p)
{
    free(p->surface);
    free(p->kept);
    p->surface = NULL;
    p->kept = NULL;
    p->count = 0;
}

/* --- notes --- */

/* Inserts a text into the note at a place; dots stand for what does not fit, once. */
static void note_insert(lens_prescription *p, size_t at, const char *text)
{
    static const char more[] = "; ...";
    const size_t used = strlen(p->note), length = strlen(text);
    if (used + length + sizeof more < sizeof p->note) {
        memmove(p->note + at + length, p->note + at, used - at + 1);
        memcpy(p->note + at, text, length);
    } else if (used >= sizeof more && strcmp(p->note + used - sizeof more + 1, more) != 0) {
        memcpy(p->note + used, more, sizeof more);
    }
}

/* The part of the note that begins so, NULL for none; ends: its end. */
static const char *note_part(const lens_prescription *p, const char *head, const char **ends)
{
    const size_t length = strlen(head);
    for (const char *at = p->note; *at; at = **ends ? *ends + 2 : *ends) {
        *ends = strstr(at, "; ") ? strstr(at, "; ") : at + strlen(at);
        if (strncmp(at, head, length) == 0 && (at + length == *ends || at[length] == ':'))
            return at;
    }
    return NULL;
}

void lens_note(lens_prescription *p, const char *format, ...)
{
    char text[400];
    const char *ends;
    va_list list;
    va_start(list, format);
    vsnprintf(text, sizeof text, format, list);
    va_end(list);
    if (note_part(p, text, &ends))
        return;
    if (p->note[0])
        note_insert(p, strlen(p->note), "; ");
    note_insert(p, strlen(p->note), text);
}

void lens_note_item(lens_prescription *p, const char *head, const char *format, ...)
{
    char item[120], text[124];
    const char *ends;
    va_list list;
    va_start(list, format);
    vsnprintf(item, sizeof item, format, list);
    va_end(list);
    const char *part = note_part(p, head, &ends);
    if (!part) {
        lens_note(p, "%s: %s", head, item);
        return;
    }
    const size_t length = strlen(item);
    for (const char *at = part + strlen(head); at < ends; at++)
        if ((at[-1] == ' ') && strncmp(at, item, length) == 0 && (at + length == ends || at[length] == ','))
            return;
    snprintf(text, sizeof text, ", %s", item);
    note_insert(p, (size_t)(ends - p->note), text);
}

/* --- media and surfaces --- */

/* Data of a file keep the index of the ends of their range (optical_data_at). */
static double within_range(const lens_medium *m, double lambda_nm)
{
    const dispersion *law = &m->law.law;
    return m->kind == LENS_DATA && law->high_nm > 0.0 ? fmin(fmax(lambda_nm, law->low_nm), law->high_nm) : lambda_nm;
}

double lens_medium_index(const lens_medium *m, double lambda_nm)
{
    if (m->kind == LENS_AIR)
        return 1.0;
    if (!m->law.data)
        lambda_nm = within_range(m, lambda_nm);
    if (m->around > 0.0)
        return index_law_at(&m->law, lambda_nm) / m->around;
    const double n = m->law.data ? optical_data_at(m->law.data, lambda_nm) : dispersion_index(&m->law.law, lambda_nm);
    return m->law.relative_to_air ? n : n / medium_index(media_at(0), lambda_nm);
}

bool lens_media_match(const lens_medium *a, const lens_medium *b)
{
    if (a->kind != b->kind || (a->kind != LENS_MODEL && a->kind != LENS_CONSTANT))
        return a->kind == b->kind && strcmp(a->name, b->name) == 0;
    return a->n_d == b->n_d && a->V_d == b->V_d;
}

even_asphere lens_surface_shape(const lens_surface *s)
{
    even_asphere e = asphere_of(s->radius == 0.0 ? 0.0 : 1.0 / s->radius, s->conic, s->even);
    asphere_add_odd(&e, s->odd);
    e.form = s->form;
    e.curvature_x = s->radius_x == 0.0 ? 0.0 : 1.0 / s->radius_x, e.stretch_x = 1.0 + s->conic_x;
    return e;
}

lens_surface lens_surface_scaled(const lens_surface *s, double k)
{
    lens_surface out = *s;
    out.radius *= k, out.radius_x *= k, out.diameter *= k, out.chamfer *= k;
    for (int i = 0; i < LENS_EVEN_TERMS; i++)
        out.even[i] /= pow(k, 3 + 2 * i);
    for (int i = 0; i < LENS_ODD_TERMS; i++)
        out.odd[i] /= pow(k, asphere_odd_power(i) - 1);
    return out;
}

double lens_surface_sag(const lens_surface *s, double rho)
{
    const even_asphere e = lens_surface_shape(s);
    return asphere_reaches(&e, rho * rho) ? asphere_sag(&e, rho * rho) : NAN;
}

/* --- mirrors that fold the axis --- */

bool lens_folds(const lens_surface *s)
{
    return s->tilt_x_deg != 0.0 || s->tilt_y_deg != 0.0;
}

mat3 lens_tilt(const lens_surface *s)
{
    return mat3_product(rotation_from_deg(vec3_make(s->tilt_x_deg, 0.0, 0.0)),
                        rotation_from_deg(vec3_make(0.0, s->tilt_y_deg, 0.0)));
}

mat3 lens_fold(const lens_surface *s)
{
    const vec3 n = mat3_apply(lens_tilt(s), vec3_make(0.0, 0.0, 1.0));
    const double k[3] = {n.x, n.y, n.z};
    mat3 q;
    for (int i = 0; i < 3; i++) /* (1 - 2 n n') diag(1, 1, -1) */
        q.row[i] = vec3_make((i == 0) - 2.0 * k[i] * n.x, (i == 1) - 2.0 * k[i] * n.y, 2.0 * k[i] * n.z - (i == 2));
    return q;
}

bool lens_is_flat(const lens_surface *s)
{
    bool flat = s->radius == 0.0 && (s->form == SIDE_ROUND || s->radius_x == 0.0);
    for (int i = 0; i < LENS_EVEN_TERMS; i++)
        flat &= s->even[i] == 0.0;
    for (int i = 0; i < LENS_ODD_TERMS; i++)
        flat &= s->odd[i] == 0.0;
    return flat;
}

void lens_turn_round(lens_surface *s)
{
    s->radius = -s->radius, s->radius_x = -s->radius_x;
    for (int i = 0; i < LENS_EVEN_TERMS; i++)
        s->even[i] = -s->even[i];
    for (int i = 0; i < LENS_ODD_TERMS; i++)
        s->odd[i] = -s->odd[i];
}

double lens_index_after(const lens_surface *s, double before, double lambda_nm)
{
    return s->mirror ? -before : copysign(lens_medium_index(&s->medium, lambda_nm), before);
}

lens_vignetting lens_vignetting_of(const lens_prescription *p, double x, double y)
{
    for (size_t i = 0; i < p->field_count; i++)
        if (p->field[i].x == x && p->field[i].y == y)
            return p->vignetting[i];
    return (lens_vignetting){0};
}

double lens_vignetting_factor(const lens_vignetting *v, size_t k)
{
    return k == 0 ? v->shift_x : k == 1 ? v->shift_y : k == 2 ? v->squeeze_x : v->squeeze_y;
}

double lens_field_most(const lens_prescription *p)
{
    double most = 0.0;
    for (size_t i = 0; i < p->field_count; i++)
        most = fmax(most, hypot(p->field[i].x, p->field[i].y));
    return most;
}

double lens_surface_height(const lens_surface *s, double x, double y)
{
    const even_asphere e = lens_surface_shape(s);
    double by_x, by_y;
    return s->form == SIDE_ROUND ? lens_surface_sag(s, hypot(x, y)) : asphere_surface(&e, x, y, &by_x, &by_y);
}

double lens_surface_curvature(const lens_surface *s, bool along_x)
{
    const double radius = along_x && s->form != SIDE_ROUND ? s->radius_x : s->radius,
                 c = radius == 0.0 ? 0.0 : 1.0 / radius;
    return along_x && s->form != SIDE_ROUND ? c : c + 2.0 * s->odd[1];
}

bool lens_is_round(const lens_prescription *p)
{
    bool round = true;
    for (size_t i = 0; i < p->count; i++)
        round &= p->surface[i].form == SIDE_ROUND;
    return round;
}

/* --- paraxial rays ---
 *
 * A ray has the height y and the slope u = dy/dz before each surface. Refraction: n' u' = n u - y (n' - n) c; after a
 * mirror n' = -n. Transfer: y += t u'. Kingslake and Johnson, Lens Design Fundamentals. */

typedef struct paraxial_system {
    const lens_prescription *p;
    bool along_x;
    double index[LENS_SURFACES_MAX + 1]; /* before each surface, and in the image space */
} paraxial_system;

static paraxial_system system_of(const lens_prescription *p, bool along_x, double lambda_nm)
{
    paraxial_system s = {.p = p, .along_x = along_x, .index = {lens_medium_index(&p->object_medium, lambda_nm)}};
    for (size_t i = 0; i < p->count; i++)
        s.index[i + 1] = lens_index_after(&p->surface[i], s.index[i], lambda_nm);
    return s;
}

static lens_trail follow(const paraxial_system *s, double y, double u)
{
    lens_trail t;
    for (size_t i = 0; i < s->p->count; i++) {
        const lens_surface *of = &s->p->surface[i];
        const double c = lens_surface_curvature(of, s->along_x);
        t.y[i] = y, t.u[i] = u;
        u = (s->index[i] * u - y * (s->index[i + 1] - s->index[i]) * c) / s->index[i + 1];
        y += of->thickness * u;
    }
    t.u[s->p->count] = u;
    return t;
}

/* From the last vertex to where a ray crosses the axis. */
static double crossing(const paraxial_system *s, const lens_trail *t)
{
    return -t->y[s->p->count - 1] / t->u[s->p->count];
}

static int stop_of(const paraxial_system *s)
{
    const lens_prescription *p = s->p;
    const bool far = isinf(p->object_distance);
    if (p->stop >= 0 && (size_t)p->stop < p->count)
        return p->stop;
    const lens_trail t = follow(s, 1.0, far ? 0.0 : 1.0 / p->object_distance);
    int best = 0;
    double least = INFINITY;
    for (size_t i = 0; i < p->count; i++)
        if (p->surface[i].diameter > 0.0 && p->surface[i].diameter < least * fabs(t.y[i])) {
            least = p->surface[i].diameter / fabs(t.y[i]);
            best = (int)i;
        }
    return best;
}

/* The diameter of the entrance pupil. */
static double pupil_diameter(const paraxial_system *s, const lens_first_order *f)
{
    const lens_prescription *p = s->p;
    switch (p->aperture_kind) {
    case LENS_APERTURE_STOP: return f->stop_height != 0.0 ? p->surface[f->stop].diameter / fabs(f->stop_height) : 0.0;
    case LENS_APERTURE_PUPIL: return p->aperture;
    case LENS_APERTURE_NUMBER: return p->aperture > 0.0 && isfinite(f->efl) ? fabs(f->efl) / p->aperture : 0.0;
    case LENS_APERTURE_OBJECT:
        return isfinite(p->object_distance) && p->aperture < s->index[0]
                   ? 2.0 * (p->object_distance + f->pupil) * tan(asin(p->aperture / s->index[0]))
                   : 0.0;
    }
    return 0.0;
}

/* Rays through the edge of the entrance pupil, and through its middle. */
static void set_rays(const paraxial_system *s, lens_first_order *f)
{
    const lens_prescription *p = s->p;
    const bool far = isinf(p->object_distance);
    const double half = 0.5 * f->pupil_diameter, slope = far ? 0.0 : half / (p->object_distance + f->pupil),
                 most = lens_field_most(p);
    f->field_slope = p->field_kind == LENS_FIELD_ANGLE ? tan(fmin(most, 89.0) * 0.017453292519943295769)
                                                       : -most / (p->object_distance + f->pupil);
    f->marginal = follow(s, far ? half : p->object_distance * slope, slope);
    f->chief = follow(s, -f->pupil * f->field_slope, f->field_slope);
}

static lens_first_order first_order(const lens_prescription *p, bool along_x, double lambda_nm)
{
    const paraxial_system s = system_of(p, along_x, lambda_nm);
    const double n = s.index[0], n_image = s.index[p->count];
    lens_first_order f = {.direction = n_image < 0.0 ? -1.0 : 1.0, .efl = INFINITY};
    if (p->count == 0)
        return f;
    const bool far = isinf(p->object_distance);
    const lens_trail parallel = follow(&s, 1.0, 0.0), from_vertex = follow(&s, 0.0, 1.0);
    f.stop = stop_of(&s);
    f.efl = -1.0 / (parallel.u[p->count] * n_image); /* 1 / power */
    f.back = crossing(&s, &parallel);
    f.front = -n_image * from_vertex.u[p->count] * f.efl;
    f.stop_height = parallel.y[f.stop];
    f.pupil = from_vertex.y[f.stop] / f.stop_height;
    f.pupil_diameter = pupil_diameter(&s, &f);
    f.stop_diameter =
        p->aperture_kind == LENS_APERTURE_STOP ? p->surface[f.stop].diameter : f.pupil_diameter * fabs(f.stop_height);
    set_rays(&s, &f);
    const lens_trail axial = far ? parallel : follow(&s, p->object_distance, 1.0), middle = follow(&s, -f.pupil, 1.0);
    f.image = crossing(&s, &axial);
    f.magnification = far ? 0.0 : n / (n_image * axial.u[p->count]);
    f.exit_pupil = crossing(&s, &middle);
    f.exit_diameter = f.pupil_diameter * fabs(n / (n_image * middle.u[p->count]));
    return f;
}

lens_first_order lens_first_order_of(const lens_prescription *p, double lambda_nm)
{
    return first_order(p, false, lambda_nm);
}

lens_first_order lens_first_order_x(const lens_prescription *p, double lambda_nm)
{
    return first_order(p, true, lambda_nm);
}

/* Real rays are outside paraxial ones; a rim that just lets these pass would vignette them. */
#define ROOM_FOR_REAL_RAYS 1.05

void lens_prescription_complete(lens_prescription *p)
{
    if (p->count == 0)
        return;
    const double nm = p->wavelength[p->primary].nm;
    const lens_first_order f = lens_first_order_of(p, nm), x = lens_first_order_x(p, nm);
    if (p->stop < 0)
        lens_note(p, "no stop is stated: it is surface %d, which a beam on the axis fills first", f.stop + 1);
    if (p->stop < 0 && p->aperture_kind != LENS_APERTURE_STOP)
        p->stop = f.stop; /* a stated aperture needs one in a scene, too */
    for (size_t i = 0; i < p->count; i++) {
        lens_surface *s = &p->surface[i];
        /* of wide fields, paraxial rays are farther out than the surface reaches */
        const double reach =
            s->radius == 0.0 || s->conic <= -1.0 ? INFINITY : 1.9 * fabs(s->radius) / sqrt(1.0 + s->conic);
        const double across = 2.0 * fmax(fabs(f.marginal.y[i]) + fabs(f.chief.y[i]),
                                         fabs(x.marginal.y[i]) + fabs(x.chief.y[i])),
                     needed = fmin(lens_folds(s) ? across / lens_tilt(s).row[2].z : across, reach);
        if (!(s->diameter > 0.0) && isfinite(needed))
            s->diameter = (int)i == p->stop ? f.stop_diameter : ROOM_FOR_REAL_RAYS * needed;
    }
    lens_surface *last = &p->surface[p->count - 1];
    if (last->thickness == 0.0 && isfinite(f.image))
        last->thickness = f.image;
    else if (last->thickness == 0.0 && isfinite(x.image)) /* a cylinder's line */
        last->thickness = x.image;
}
