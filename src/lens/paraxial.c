/* A prescription at one wavelength, paraxial rays through it and its Gaussian constants. The ray through surface i:
 * n' u' = n u - y (n' - n) c, then y += t u' (Welford, Aberrations of Optical Systems, 1986, 3.2); products of such
 * steps are matrices of y and n u with determinant 1 (Hecht, Optics, 6.2). */
#include "lens/lens_private.h"

#include <math.h>
#include <string.h>

double lens_sag(const lens_step *s, double rho, double *slope, double *bend)
{
    const double r2 = rho * rho, root = sqrt(1.0 - (1.0 + s->k) * s->c * s->c * r2);
    double sag = s->c * r2 / (1.0 + root), power = r2 * rho;
    *slope = s->c * rho / root;
    *bend = s->c / (root * root * root);
    for (int i = 0, order = 4; i < LENS_EVEN_TERMS; i++, order += 2, power *= r2) {
        sag += s->even[i] * power * rho;
        *slope += order * s->even[i] * power;
        *bend += order * (order - 1) * s->even[i] * (rho > 0.0 ? power / rho : 0.0);
    }
    return sag;
}

static void step_make(const lens_surface *from, double mm, double z, double n, double lambda_nm, lens_step *out)
{
    const double index = from->mirror ? -n : copysign(lens_medium_index(&from->medium, lambda_nm), n);
    *out = (lens_step){.c = from->radius == 0.0 ? 0.0 : 1.0 / (from->radius * mm),
                       .k = from->conic,
                       .z = z,
                       .n = n,
                       .n_after = index,
                       .clear = from->diameter > 0.0 ? 0.5 * from->diameter * mm : INFINITY,
                       .mirror = from->mirror,
                       .silent = !from->mirror && index == n};
    for (int i = 0; i < LENS_EVEN_TERMS; i++)
        out->even[i] = from->even[i] / pow(mm, 3 + 2 * i);
}

/* The stop where none is stated: the surface that a beam along the axis fills first. */
static int narrowest(const lens_model *m)
{
    lens_trail t;
    const bool far = isinf(m->object_distance);
    lens_trail_make(m, 1.0, far ? 0.0 : 1.0 / m->object_distance, &t);
    int best = 0;
    double least = INFINITY;
    for (int i = 0; i < m->count; i++)
        if (m->step[i].clear < least * fabs(t.y[i])) {
            least = m->step[i].clear / fabs(t.y[i]);
            best = i;
        }
    return best;
}

status lens_model_make(const lens_prescription *p, double lambda_nm, lens_model *out, diagnostic *why)
{
    if (p->count == 0 || p->count > LENS_SURFACES_MAX)
        return diagnose(why, STATUS_BAD_INPUT, "give at least one surface", "the lens has no surfaces");
    const double mm = p->unit_mm;
    if (!(p->object_distance > 0.0))
        return diagnose(why, STATUS_BAD_INPUT, "place the object before the first surface",
                        "the object is not before the lens");
    *out = (lens_model){.count = (int)p->count,
                        .stop = p->stop,
                        .lambda_nm = lambda_nm,
                        .object_distance = p->object_distance * mm,
                        .image_c = p->image_radius == 0.0 ? 0.0 : 1.0 / (p->image_radius * mm),
                        .unit_mm = mm};
    double z = 0.0, n = out->n_object = lens_medium_index(&p->object_medium, lambda_nm);
    for (int i = 0; i < out->count; i++) {
        step_make(&p->surface[i], mm, z, n, lambda_nm, &out->step[i]);
        n = out->step[i].n_after;
        z += p->surface[i].thickness * mm;
    }
    out->n_image = n;
    out->z_image = z;
    if (!isfinite(z) || !isfinite(n) || n == 0.0)
        return diagnose(why, STATUS_BAD_INPUT, "give finite distances, and media that are known at each wavelength",
                        "the lens is not defined at %g nm", lambda_nm);
    if (out->stop < 0 || out->stop >= out->count)
        out->stop = narrowest(out);
    out->step[out->stop].clear = INFINITY; /* rays are aimed within it, and may miss it on the way there */
    return STATUS_OK;
}

void lens_trail_make(const lens_model *m, double y, double u, lens_trail *out)
{
    for (int i = 0; i < m->count; i++) {
        const lens_step *s = &m->step[i];
        out->y[i] = y;
        out->u[i] = u;
        u = (s->n * u - y * (s->n_after - s->n) * s->c) / s->n_after;
        if (i + 1 < m->count)
            y += u * (m->step[i + 1].z - s->z);
    }
    out->u[m->count] = u;
}

/* The rays with y = 1, n u = 0 and y = 0, n u = 1 at the first vertex: the columns of the matrix to any surface. */
typedef struct basis {
    lens_trail a, b;
} basis;

/* From the matrix A, B of y from the first vertex to the stop's, before it refracts, and that of the whole lens. */
static void place_pupils(const lens_model *m, const basis *v, const double all[4], lens_first *out)
{
    const double A = v->a.y[m->stop], B = v->b.y[m->stop];
    /* The second column of the rest, which is all times the inverse of the front. */
    const double rest_B = -all[0] * B + all[1] * A, rest_D = -all[2] * B + all[3] * A;
    out->z_entrance = m->n_object * B / A;
    out->per_height = A;
    out->z_exit = m->step[m->count - 1].z - m->n_image * rest_B / rest_D;
    out->exit_d = 2.0 * out->stop_radius / fabs(rest_D);
    out->entrance_d = 2.0 * out->stop_radius / fabs(A);
}

static void place_rays(const lens_prescription *p, const lens_model *m, lens_first *out)
{
    const bool far = isinf(m->object_distance);
    const double half = 0.5 * out->entrance_d, zE = out->z_entrance, most = lens_field_most(p);
    const double u = far ? 0.0 : half / (m->object_distance + zE);
    double slope = p->field_kind == LENS_FIELD_ANGLE ? tan(fmin(most, 89.0) * (M_PI / 180.0))
                                                     : -most * m->unit_mm / (m->object_distance + zE);
    lens_trail_make(m, half - zE * u, u, &out->marginal);
    lens_trail_make(m, -zE * slope, slope, &out->chief);
    out->slope_max = slope;
    out->invariant = m->n_object * (slope * half); /* at the entrance pupil: chief height 0, marginal height half */
    const double last_u = out->marginal.u[m->count], last_y = out->marginal.y[m->count - 1];
    out->z_focus = m->step[m->count - 1].z - last_y / last_u;
    out->magnification = far ? 0.0 : m->n_object * u / (m->n_image * last_u);
    out->working_number = fabs(0.5 / (m->n_image * last_u));
}

static void stop_by_aperture(const lens_prescription *p, const lens_model *m, lens_first *out)
{
    const double mm = m->unit_mm;
    double radius = 0.5 * p->surface[m->stop].diameter * mm;
    if (p->aperture_kind == LENS_APERTURE_PUPIL)
        radius = 0.5 * p->aperture * mm * fabs(out->per_height);
    else if (p->aperture_kind == LENS_APERTURE_NUMBER)
        radius = 0.5 / (fabs(out->power) * p->aperture) * fabs(out->per_height);
    else if (p->aperture_kind == LENS_APERTURE_OBJECT)
        radius = (m->object_distance + out->z_entrance) * tan(asin(p->aperture / m->n_object)) * fabs(out->per_height);
    out->stop_radius = radius;
}

status lens_first_make(const lens_prescription *p, const lens_model *m, lens_first *out, diagnostic *why)
{
    basis v;
    const double n = m->n_object, n2 = m->n_image, z_last = m->step[m->count - 1].z;
    *out = (lens_first){0};
    lens_trail_make(m, 1.0, 0.0, &v.a);
    lens_trail_make(m, 0.0, 1.0 / n, &v.b);
    const double all[4] = {v.a.y[m->count - 1], v.b.y[m->count - 1], n2 * v.a.u[m->count], n2 * v.b.u[m->count]};
    out->power = -all[2];
    out->bfl = n2 * all[0] / out->power;
    out->z_front = -n * all[3] / out->power;
    out->ffl = out->z_front;
    out->z_rear = z_last + out->bfl;
    out->z_principal = out->z_front + n / out->power;
    out->z_principal_rear = out->z_rear - n2 / out->power;
    out->z_nodal = out->z_front + n2 / out->power;
    out->z_nodal_rear = out->z_rear - n / out->power;
    place_pupils(m, &v, all, out);
    stop_by_aperture(p, m, out);
    place_pupils(m, &v, all, out);
    if (!(out->stop_radius > 0.0) || !isfinite(out->stop_radius))
        return diagnose(why, STATUS_BAD_INPUT,
                        "state the aperture (an f-number, a pupil's diameter), or the diameter of the stop",
                        "the aperture of the lens is not known");
    place_rays(p, m, out);
    out->f_number = fabs(1.0 / (out->power * out->entrance_d));
    return STATUS_OK;
}

double lens_field_most(const lens_prescription *p)
{
    double most = 0.0;
    for (size_t i = 0; i < p->field_count; i++)
        most = fmax(most, hypot(p->field[i].x, p->field[i].y));
    return most;
}
