/* Prescriptions from files and scenes as reports need them: the solids that stand for them, the surfaces at one
 * wavelength and the Gaussian constants, in mm. */
#include "lens/lens_private.h"

#include "scene/lens/lens_prescription.h"
#include "scene/model/medium.h"
#include "scene/model/params.h"
#include "scene/model/scene.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* --- the solids --- */

/* The lens of a placement: light along the +y of its frame, fields of +y towards its -z, as files are placed. */
static void place_of(const scene *s, const lens_prescription *p, const lens_placement *at, lens_place *out)
{
    const mat3 turn = rotation_from_deg(at->rotation_deg);
    *out = (lens_place){.s = s,
                        .origin = at->position,
                        .across = mat3_apply(turn, vec3_make(1.0, 0.0, 0.0)),
                        .up = mat3_apply(turn, vec3_make(0.0, 0.0, -1.0)),
                        .along = mat3_apply(turn, vec3_make(0.0, 1.0, 0.0)),
                        .scale = at->scale / p->unit_mm};
}

/* Whether an index of the prescription is that of a catalogue, and so relative to air. */
static bool needs_air(const lens_prescription *p)
{
    bool needs = p->object_medium.kind == LENS_CATALOGUE || p->object_medium.kind == LENS_DATA;
    for (size_t i = 0; i < p->count; i++)
        needs |= p->surface[i].medium.kind == LENS_CATALOGUE || p->surface[i].medium.kind == LENS_DATA;
    return needs;
}

/* Rays are aimed at the stop's edge: it has no solid, and where it is the rim of an element, that is larger. */
static void without_stop(lens_prescription *p)
{
    if (p->stop >= 0 && (size_t)p->stop < p->count)
        p->surface[p->stop].diameter *= 1.02;
    p->stop = -1;
}

status lens_place_alone(const lens_prescription *p, const lens_glasses *glasses, scene **out, lens_place *place,
                        diagnostic *why)
{
    const lens_placement at = {.name = "lens", .scale = p->unit_mm, .glasses = glasses};
    lens_prescription bare = *p;
    *out = NULL;
    scene *s = scene_create();
    bare.surface = malloc(p->count * sizeof *bare.surface);
    if (!s || !bare.surface) {
        free(bare.surface);
        scene_destroy(s);
        return out_of_memory(why);
    }
    memcpy(bare.surface, p->surface, p->count * sizeof *bare.surface);
    without_stop(&bare);
    s->render.unit_m = 0.001;
    /* Otherwise surroundings of index 1 stand for air, and constant indices are used as they are. */
    status code = needs_air(p) ? scene_set(s, "background.medium", "air", why) : STATUS_OK;
    THEN(code, lens_add_to_scene(s, &bare, &at, why));
    THEN(code, scene_load(s, why));
    free(bare.surface);
    if (code != STATUS_OK) {
        scene_destroy(s);
        return code;
    }
    place_of(s, p, &at, place);
    *out = s;
    return STATUS_OK;
}

status lens_place_in_scene(scene *s, const char *system, lens_prescription *p, lens_place *place, diagnostic *why)
{
    lens_placement at;
    TRY(lens_of_scene(s, system, p, &at, why));
    const int stop = at.name ? scene_find_solid(s, at.name) : -1;
    if (stop >= 0)
        s->solids[stop].visible = 0;
    place_of(s, p, &at, place);
    return STATUS_OK;
}

static status open_scene(const char *path, const char *system, lens_prescription *p, scene **out, lens_place *place,
                         diagnostic *why)
{
    scene *s = NULL;
    TRY(scene_read(path, &s, why));
    status code = scene_load(s, why);
    if (code == STATUS_OK)
        code = locate_failure(why, path, lens_place_in_scene(s, system, p, place, why));
    if (code == STATUS_OK)
        *out = s;
    else
        scene_destroy(s);
    return code;
}

status lens_open(const char *path, const char *system, const lens_glasses *glasses, lens_prescription *p, scene **s,
                 lens_place *place, diagnostic *why)
{
    *s = NULL;
    if (!lens_file_named(path))
        return open_scene(path, system, p, s, place, why);
    TRY(lens_file_read(path, glasses, p, why));
    return locate_failure(why, path, lens_place_alone(p, glasses, s, place, why));
}

/* --- the surfaces and the constants --- */

/* The part of the second derivative by rho that 2 dz/dq does not have: n (n - 2) a rho^(n - 2) of each term. */
static double odd_bend(const even_asphere *e, double rho)
{
    double sum = 0.0;
    for (int i = 0; i < e->odd_terms && rho > 0.0; i++) {
        const int n = asphere_odd_power(i);
        sum += n * (n - 2) * e->odd[i] * pow(rho, n - 2);
    }
    return sum;
}

double lens_sag(const lens_step *s, double rho, double *slope, double *bend)
{
    const even_asphere *e = &s->shape;
    const double q = rho * rho;
    if (!asphere_reaches(e, q))
        return *slope = *bend = NAN;
    const double by_q = asphere_slope(e, q);
    *slope = 2.0 * rho * by_q;
    *bend = 2.0 * by_q + 4.0 * q * asphere_slope_rate(e, q) + odd_bend(e, rho);
    return asphere_sag(e, q);
}

double lens_bend_across(const lens_step *s, double rho)
{
    const even_asphere *e = &s->shape;
    double slope, bend;
    const double C = e->curvature_x, g = lens_sag(s, rho, &slope, &bend);
    if (e->form == SIDE_ROUND)
        return rho > 1e-12 ? slope / rho : s->c0;
    const double root = sqrt(1.0 - e->stretch * (s->c * s->c) * (rho * rho));
    return e->form == SIDE_TORIC ? C / (1.0 - C * g) : C * (2.0 + g * (e->stretch_x * C) / root) / (1.0 + root);
}

double lens_height(const lens_step *s, double x, double y, double *by_x, double *by_y)
{
    double slope, bend;
    if (s->shape.form != SIDE_ROUND)
        return asphere_surface(&s->shape, x, y, by_x, by_y);
    const double rho = hypot(x, y), sag = lens_sag(s, rho, &slope, &bend);
    *by_x = rho > 0.0 ? slope * x / rho : 0.0, *by_y = rho > 0.0 ? slope * y / rho : 0.0;
    return sag;
}

static lens_step step_of(const lens_surface *from, double mm, double z, double n, double lambda_nm)
{
    const double index = lens_index_after(from, n, lambda_nm);
    const lens_surface own = lens_surface_scaled(from, mm);
    return (lens_step){.c = own.radius == 0.0 ? 0.0 : 1.0 / own.radius,
                       .k = from->conic,
                       .c0 = lens_surface_curvature(&own, false),
                       .shape = lens_surface_shape(&own),
                       .z = z,
                       .n = n,
                       .n_after = index,
                       .clear = from->diameter > 0.0 ? 0.5 * from->diameter * mm : INFINITY,
                       .mirror = from->mirror,
                       .silent = !from->mirror && index == n,
                       .folds = lens_folds(from),
                       .normal = mat3_apply(lens_tilt(from), vec3_make(0.0, 0.0, 1.0)),
                       .turn = lens_fold(from)};
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
                        .stop = lens_first_order_of(p, lambda_nm).stop,
                        .lambda_nm = lambda_nm,
                        .object_distance = p->object_distance * mm,
                        .image_c = p->image_radius == 0.0 ? 0.0 : 1.0 / (p->image_radius * mm),
                        .unit_mm = mm};
    double z = 0.0, n = out->n_object = lens_medium_index(&p->object_medium, lambda_nm);
    for (int i = 0; i < out->count; i++) {
        out->step[i] = step_of(&p->surface[i], mm, z, n, lambda_nm);
        n = out->step[i].n_after;
        z += p->surface[i].thickness * mm;
    }
    out->n_image = n;
    out->z_image = z;
    if (!isfinite(z) || !isfinite(n) || n == 0.0)
        return diagnose(why, STATUS_BAD_INPUT, "give finite distances, and media that are known at each wavelength",
                        "the lens is not defined at %g nm", lambda_nm);
    out->step[out->stop].clear = INFINITY; /* rays are aimed within it, and may miss it on the way there */
    return STATUS_OK;
}

static lens_trail trail_in_mm(lens_trail t, int count, double mm)
{
    for (int i = 0; i < count; i++)
        t.y[i] *= mm;
    return t;
}

status lens_first_make(const lens_prescription *p, const lens_model *m, lens_first *out, diagnostic *why)
{
    const lens_first_order f = lens_first_order_of(p, m->lambda_nm);
    const double mm = m->unit_mm, n = m->n_object, n2 = m->n_image, efl = f.efl * mm;
    const double z_last = m->step[m->count - 1].z, front = f.front * mm, rear = z_last + f.back * mm;
    const lens_trail marginal = trail_in_mm(f.marginal, m->count, mm);
    const double last_u = marginal.u[m->count];
    *out = (lens_first){.power = 1.0 / efl,
                        .bfl = f.back * mm,
                        .ffl = front,
                        .z_front = front,
                        .z_rear = rear,
                        .z_principal = front + n * efl,
                        .z_principal_rear = rear - n2 * efl,
                        .z_nodal = front + n2 * efl,
                        .z_nodal_rear = rear - n * efl,
                        .z_entrance = f.pupil * mm,
                        .entrance_d = f.pupil_diameter * mm,
                        .z_exit = z_last + f.exit_pupil * mm,
                        .exit_d = f.exit_diameter * mm,
                        .stop_radius = 0.5 * f.stop_diameter * mm,
                        .per_height = f.stop_height,
                        .f_number = fabs(f.efl / f.pupil_diameter),
                        .working_number = fabs(0.5 / (n2 * last_u)),
                        .z_focus = z_last + f.image * mm,
                        .magnification = f.magnification,
                        /* at the entrance pupil, where the chief ray's height is 0 */
                        .invariant = n * (f.field_slope * 0.5 * f.pupil_diameter * mm),
                        .slope_max = f.field_slope,
                        .marginal = marginal,
                        .chief = trail_in_mm(f.chief, m->count, mm)};
    return out->stop_radius > 0.0 && isfinite(out->stop_radius)
               ? STATUS_OK
               : diagnose(why, STATUS_BAD_INPUT,
                          "state the aperture (an f-number, a pupil's diameter), or the diameter of the stop",
                          "the aperture of the lens is not known");
}
