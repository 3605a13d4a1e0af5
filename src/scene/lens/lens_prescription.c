/* Media, surfaces and paraxial properties of a lens prescription (lens_prescription.h). */
#include "scene/lens/lens_prescription.h"
#include "geometry/primitives/asphere.h"

#include <math.h>
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
    p->surface = NULL;
    p->count = 0;
}

double lens_medium_index(const lens_medium *m, double lambda_nm)
{
    if (m->kind == LENS_AIR)
        return 1.0;
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

double lens_surface_sag(const lens_surface *s, double rho)
{
    const even_asphere e = asphere_of(s->radius == 0.0 ? 0.0 : 1.0 / s->radius, s->conic, s->even);
    return e.stretch * (e.curvature * e.curvature) * (rho * rho) > 1.0 ? NAN : asphere_sag(&e, rho * rho);
}

/* --- paraxial rays ---
 *
 * A ray has the height y and the slope u = dy/dz before each surface. Refraction: n' u' = n u - y (n' - n) c; after a
 * mirror n' = -n. Transfer: y += t u'. Kingslake and Johnson, 3.1. */

typedef struct paraxial_ray {
    double y, u;
} paraxial_ray;

typedef struct paraxial_system {
    const lens_prescription *p;
    double index[LENS_SURFACES_MAX + 1]; /* before each surface, and in the image space; below 0 after a mirror */
} paraxial_system;

static paraxial_system system_of(const lens_prescription *p, double lambda_nm)
{
    paraxial_system s = {.p = p, .index = {lens_medium_index(&p->object_medium, lambda_nm)}};
    for (size_t i = 0; i < p->count; i++) {
        const double sign = s.index[i] < 0.0 ? -1.0 : 1.0;
        s.index[i + 1] =
            p->surface[i].mirror ? -s.index[i] : sign * lens_medium_index(&p->surface[i].medium, lambda_nm);
    }
    return s;
}

static paraxial_ray refract_at(const paraxial_system *s, size_t i, paraxial_ray r)
{
    const double radius = s->p->surface[i].radius, c = radius == 0.0 ? 0.0 : 1.0 / radius;
    r.u = (s->index[i] * r.u - r.y * (s->index[i + 1] - s->index[i]) * c) / s->index[i + 1];
    return r;
}

/* From before the first surface to before surface `to`; with to == count: to after the last surface, at its vertex.
 * height may be NULL. */
static paraxial_ray follow(const paraxial_system *s, size_t to, paraxial_ray r, double *height)
{
    for (size_t i = 0; i < to; i++) {
        if (height)
            height[i] = r.y;
        r = refract_at(s, i, r);
        r.y += i + 1 < s->p->count ? s->p->surface[i].thickness * r.u : 0.0;
    }
    return r;
}

/* The diameter of the entrance pupil; zoom: of the stop by that of the pupil. */
static double pupil_diameter(const lens_prescription *p, const lens_first_order *f, double zoom)
{
    const size_t stop = p->stop < 0 ? 0 : (size_t)p->stop;
    switch (p->aperture_kind) {
    case LENS_APERTURE_STOP: return zoom != 0.0 && p->count > 0 ? p->surface[stop].diameter / fabs(zoom) : 0.0;
    case LENS_APERTURE_PUPIL: return p->aperture;
    case LENS_APERTURE_NUMBER: return p->aperture > 0.0 && isfinite(f->efl) ? fabs(f->efl) / p->aperture : 0.0;
    case LENS_APERTURE_OBJECT:
        return isfinite(p->object_distance) && p->aperture < 1.0
                   ? 2.0 * (p->object_distance + f->pupil) * p->aperture / sqrt(1.0 - p->aperture * p->aperture)
                   : 0.0;
    }
    return 0.0;
}

static double field_slope(const lens_prescription *p, double pupil)
{
    const double rad = 0.017453292519943295769;
    double most = 0.0;
    for (size_t i = 0; i < p->field_count; i++) {
        const double h = hypot(p->field[i].x, p->field[i].y);
        most =
            fmax(most, p->field_kind == LENS_FIELD_ANGLE ? tan(fmin(h, 89.0) * rad) : h / (p->object_distance + pupil));
    }
    return most;
}

lens_first_order lens_first_order_of(const lens_prescription *p, double lambda_nm)
{
    const paraxial_system s = system_of(p, lambda_nm);
    const size_t stop = p->stop < 0 ? 0 : (size_t)p->stop;
    lens_first_order f = {.direction = s.index[p->count] < 0.0 ? -1.0 : 1.0};
    const paraxial_ray parallel = follow(&s, p->count, (paraxial_ray){1.0, 0.0}, NULL),
                       to_stop = follow(&s, stop, (paraxial_ray){1.0, 0.0}, NULL),
                       from_vertex = follow(&s, stop, (paraxial_ray){0.0, 1.0}, NULL);
    /* 1 / power */
    f.efl = -1.0 / (parallel.u * s.index[p->count]);
    f.back = -parallel.y / parallel.u;
    f.pupil = from_vertex.y / to_stop.y;
    f.pupil_diameter = pupil_diameter(p, &f, to_stop.y);
    f.stop_diameter = f.pupil_diameter * fabs(to_stop.y);
    f.field_slope = field_slope(p, f.pupil);
    const bool finite = isfinite(p->object_distance);
    const double half = 0.5 * f.pupil_diameter, slope = finite ? half / (p->object_distance + f.pupil) : 0.0;
    follow(&s, p->count, (paraxial_ray){finite ? p->object_distance * slope : half, slope}, f.marginal);
    follow(&s, p->count, (paraxial_ray){-f.pupil * f.field_slope, f.field_slope}, f.chief);
    const paraxial_ray from_object =
        follow(&s, p->count, finite ? (paraxial_ray){p->object_distance, 1.0} : (paraxial_ray){1.0, 0.0}, NULL);
    f.image = -from_object.y / from_object.u;
    f.magnification = finite ? s.index[0] / (s.index[p->count] * from_object.u) : 0.0;
    const paraxial_ray through_pupil = follow(&s, p->count, (paraxial_ray){-f.pupil, 1.0}, NULL);
    f.exit_pupil = -through_pupil.y / through_pupil.u;
    return f;
}

/* Real rays are outside paraxial ones; a rim that just lets these pass would vignette them. */
#define ROOM_FOR_REAL_RAYS 1.05

void lens_prescription_complete(lens_prescription *p)
{
    if (p->count == 0)
        return;
    const lens_first_order f = lens_first_order_of(p, p->wavelength[p->primary].nm);
    for (size_t i = 0; i < p->count; i++) {
        lens_surface *s = &p->surface[i];
        /* of wide fields, paraxial rays are farther out than the surface reaches */
        const double reach =
            s->radius == 0.0 || s->conic <= -1.0 ? INFINITY : 1.9 * fabs(s->radius) / sqrt(1.0 + s->conic);
        const double needed = fmin(2.0 * (fabs(f.marginal[i]) + fabs(f.chief[i])), reach);
        if (!(s->diameter > 0.0) && isfinite(needed))
            s->diameter = (int)i == p->stop ? f.stop_diameter : ROOM_FOR_REAL_RAYS * needed;
    }
    lens_surface *last = &p->surface[p->count - 1];
    if (last->thickness == 0.0 && isfinite(f.image))
        last->thickness = f.image;
}
