/* The sections of a report, and their order: what concerns the whole lens, then field by field, on several threads. */
#include "lens/lens_private.h"

#include "base/worker_pool.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

const lens_options lens_options_usual = {.fan_rays = 20, .spot_grid = 32, .wave_grid = 64, .psf = true};

static const lens_section sections[] = {
    {.name = "first-order",
     .x = "",
     .meaning = "Gaussian constants at the primary wavelength; positions z from the first vertex, along the axis as if "
                "no mirror folded it",
     .single = true},
    {.name = "first-order-x",
     .x = "",
     .meaning = "the same in the meridian of X, if a surface is not round: first-order then holds in that of Y",
     .single = true},
    {.name = "surfaces",
     .x = "",
     .meaning = "vertices, and the marginal and the chief ray of first order at each surface"},
    {.name = "fields", .x = "", .meaning = "fields as the prescription states them"},
    {.name = "seidel",
     .x = "",
     .meaning = "third-order aberrations by surface: S_I spherical, S_II coma, S_III astigmatism, S_IV Petzval, S_V "
                "distortion; C_L, C_T axial and lateral colour, shortest less longest wavelength; none if a surface is "
                "not round or has a1 or a3"},
    {.name = "seidel-sum", .x = "", .meaning = "their sums", .single = true},
    {.name = "seidel-waves",
     .x = "",
     .meaning = "coefficients of the wavefront at the pupil's edge and the largest field",
     .single = true},
    {.name = "axial-colour",
     .x = "",
     .meaning = "paraxial focus from the image's plane, and from the focus of the primary wavelength"},
    {.name = "longitudinal",
     .x = "height in the pupil",
     .meaning = "where rays of the axial beam cross the axis, from the image's plane",
     .every = 5},
    {.name = "field-curves",
     .x = "field",
     .meaning = "foci of narrow pencils about the chief ray (Coddington), from the image along the axis; "
                "distortion from f tan(field), or the magnification",
     .every = 2},
    {.name = "ghosts",
     .x = "then surface",
     .meaning = "light that `surface` and then the surface x reflect: its focus from the image, the "
                "radius of its blur and its part of the light, along the axis and with coatings"},
    {.name = "ghosts-sum",
     .x = "reflections",
     .meaning = "all light that arrives after 2 and 4 reflections; omitted: pairs of surfaces with a mirror between "
                "them, whose ghosts are not followed"},
    {.name = "chief",
     .x = "",
     .meaning = "where chief rays meet the image; lateral_colour: from that of the primary wavelength"},
    {.name = "fan-tangential",
     .x = "pupil",
     .meaning = "rays by their height in the stop, in units of its radius, along the field's direction: "
                "distance from the primary chief ray at the image, and wavefront",
     .every = 10},
    {.name = "fan-sagittal", .x = "pupil", .meaning = "the same at right angles to it", .every = 10},
    {.name = "spot",
     .x = "",
     .meaning = "root mean square and largest distances of rays that fill the stop evenly; lambda_nm 0: all "
                "wavelengths by their weights; centroid from the primary chief ray"},
    {.name = "spot-points", .x = "ray", .meaning = "the points of the spots, from the primary chief ray", .every = -1},
    {.name = "vignetting",
     .x = "",
     .meaning = "the part of the stop's rays that arrives, and the part that no start reaches"},
    {.name = "vignetting-surfaces",
     .x = "",
     .meaning = "where the others are lost; one more than the last surface: before the image"},
    {.name = "transmission",
     .x = "",
     .meaning =
         "the part of unpolarised light that surfaces with their coatings (Fresnel) and media (Beer and Lambert) "
         "pass on, mean of the rays that arrive; lambda_nm 0: all wavelengths by their weights"},
    {.name = "illumination",
     .x = "",
     .meaning = "the solid angle of the light at the image, projected on it, and by that and the transmission the "
                "illuminance relative to field 1, both at the primary wavelength"},
    {.name = "mtf-geometric",
     .x = "cycles/mm",
     .meaning = "transform of the spots of all wavelengths, without diffraction",
     .every = 10},
    {.name = "wavefront",
     .x = "",
     .meaning =
         "optical path differences over the exit pupil: peak to valley, root mean square; Strehl ratio by "
         "Marechal, exp(-(2 pi rms)^2), and by the peak of the point image; strehl_error: from that of half as many "
         "rays"},
    {.name = "encircled",
     .x = "mm",
     .meaning = "encircled energy: fraction of the light within a circle about the centroid of the point image, with "
                "diffraction",
     .every = 5},
    {.name = "psf",
     .x = "mm",
     .meaning = "cuts through the peak of the point image, of the peak without aberrations",
     .every = -1},
    {.name = "mtf-diffraction",
     .x = "cycles/mm",
     .meaning = "with diffraction, all wavelengths; limit: of a round pupil without aberrations",
     .every = 10},
    {.name = NULL},
};

const lens_section *lens_section_at(size_t i)
{
    return i < sizeof sections / sizeof sections[0] ? &sections[i]
                                                    : &sections[sizeof sections / sizeof sections[0] - 1];
}

void lens_report_release(lens_report *r)
{
    free(r->row);
    *r = (lens_report){0};
}

/* --- the whole lens --- */

static void put_first(lens_study *s)
{
    const lens_first *f = &s->first;
    const lens_model *m = &s->model[s->primary];
    const struct {
        const char *name, *unit;
        double value;
    } rows[] = {{"efl", "mm", 1.0 / f->power},
                {"bfl", "mm", f->bfl},
                {"ffl", "mm", f->ffl},
                {"power", "1/mm", f->power},
                {"z_principal", "mm", f->z_principal},
                {"z_principal_rear", "mm", f->z_principal_rear},
                {"z_nodal", "mm", f->z_nodal},
                {"z_nodal_rear", "mm", f->z_nodal_rear},
                {"z_focus_front", "mm", f->z_front},
                {"z_focus_rear", "mm", f->z_rear},
                {"stop", "", m->stop + 1},
                {"stop_diameter", "mm", 2.0 * f->stop_radius},
                {"stop_diameter_real", "mm", 2.0 * f->stop_real},
                {"z_entrance_pupil", "mm", f->z_entrance},
                {"entrance_pupil", "mm", f->entrance_d},
                {"z_exit_pupil", "mm", f->z_exit},
                {"exit_pupil", "mm", f->exit_d},
                {"f_number", "", f->f_number},
                {"working_f_number", "", f->working_number},
                {"z_paraxial_image", "mm", f->z_focus},
                {"z_image", "mm", m->z_image},
                {"magnification", "", f->magnification},
                {"lagrange_invariant", "mm", f->invariant},
                {"lambda", "nm", m->lambda_nm}};
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++)
        lens_row_put(s->out, (lens_row){.section = "first-order",
                                        .lambda_nm = m->lambda_nm,
                                        .x = NAN,
                                        .quantity = rows[i].name,
                                        .unit = rows[i].unit,
                                        .value = rows[i].value});
}

/* Of the other meridian: a line focus of a cylinder is in one of both. */
static void put_first_x(lens_study *s)
{
    if (lens_is_round(s->p))
        return;
    const lens_model *m = &s->model[s->primary];
    const lens_first_order f = lens_first_order_x(s->p, m->lambda_nm);
    const double mm = m->unit_mm, efl = f.efl * mm, z_last = m->step[m->count - 1].z, rear = z_last + f.back * mm;
    const struct {
        const char *name, *unit;
        double value;
    } rows[] = {{"efl", "mm", efl},
                {"bfl", "mm", f.back * mm},
                {"power", "1/mm", 1.0 / efl},
                {"z_principal", "mm", f.front * mm + m->n_object * efl},
                {"z_principal_rear", "mm", rear - m->n_image * efl},
                {"z_focus_rear", "mm", rear},
                {"f_number", "", fabs(0.5 * f.stop_height * efl / s->first.stop_radius)},
                {"z_paraxial_image", "mm", z_last + f.image * mm},
                {"magnification", "", f.magnification}};
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++)
        lens_row_put(s->out, (lens_row){.section = "first-order-x",
                                        .lambda_nm = m->lambda_nm,
                                        .x = NAN,
                                        .quantity = rows[i].name,
                                        .unit = rows[i].unit,
                                        .value = rows[i].value});
}

static void put_surfaces(lens_study *s)
{
    const lens_model *m = &s->model[s->primary];
    for (int i = 0; i < m->count; i++) {
        const struct {
            const char *name, *unit;
            double value;
        } rows[] = {{"z", "mm", m->step[i].z},
                    {"n_after", "", fabs(m->step[i].n_after)},
                    {"marginal_y", "mm", s->first.marginal.y[i]},
                    {"marginal_u", "", s->first.marginal.u[i + 1]},
                    {"chief_y", "mm", s->first.chief.y[i]},
                    {"chief_u", "", s->first.chief.u[i + 1]}};
        for (size_t k = 0; k < sizeof rows / sizeof rows[0]; k++)
            lens_row_put(s->out, (lens_row){.section = "surfaces",
                                            .surface = i + 1,
                                            .lambda_nm = m->lambda_nm,
                                            .x = NAN,
                                            .quantity = rows[k].name,
                                            .unit = rows[k].unit,
                                            .value = rows[k].value});
    }
}

static void put_fields(lens_study *s)
{
    const char *unit = s->p->field_kind == LENS_FIELD_ANGLE ? "deg" : "mm";
    const double mm = s->p->field_kind == LENS_FIELD_ANGLE ? 1.0 : s->p->unit_mm;
    for (size_t i = 0; i < s->p->field_count; i++) {
        lens_row row = {.section = "fields", .field = (int)i + 1, .x = NAN, .quantity = "field_x", .unit = unit};
        row.value = s->p->field[i].x * mm;
        lens_row_put(s->out, row);
        row.quantity = "field_y", row.value = s->p->field[i].y * mm;
        lens_row_put(s->out, row);
    }
}

static status open_benches(lens_study *s, const lens_place *at, isa level, diagnostic *why)
{
    s->bench = calloc(s->waves, sizeof *s->bench);
    if (!s->bench)
        return out_of_memory(why);
    for (size_t w = 0; w < s->waves; w++)
        TRY(lens_bench_open(&s->model[w], at, level, &s->bench[w], why));
    return STATUS_OK;
}

static void close_benches(lens_study *s)
{
    for (size_t w = 0; s->bench && w < s->waves; w++)
        lens_bench_close(&s->bench[w]);
    free(s->bench);
    s->bench = NULL;
}

static status whole_lens(lens_study *s, diagnostic *why)
{
    TRY(lens_stop_radius(&s->bench[s->primary], s->p, &s->first, why));
    put_first(s);
    put_first_x(s);
    put_surfaces(s);
    put_fields(s);
    lens_seidel(s);
    TRY(lens_curves(s, why));
    return lens_ghosts(s, why);
}

/* --- fields on threads --- */

typedef struct field_task {
    lens_study study;
    lens_report own;
    status code;
    diagnostic why;
} field_task;

typedef struct field_tasks {
    const lens_place *at;
    isa level;
    field_task *task;
} field_tasks;

static void run_field(void *context, size_t i, int member)
{
    const field_tasks *all = context;
    field_task *t = &all->task[i];
    (void)member;
    t->code = open_benches(&t->study, all->at, all->level, &t->why);
    THEN(t->code, lens_images(&t->study, i, &t->why));
    THEN(t->code, lens_waves(&t->study, i, &t->why));
    close_benches(&t->study);
}

/* E = T L times the projected solid angle (Born and Wolf, Principles of Optics, 4.8). */
static void put_illumination(const lens_study *s, const field_task *task, size_t count)
{
    const double first = task[0].study.solid_angle * task[0].study.transmitted;
    for (size_t i = 0; i < count; i++) {
        lens_row row = {.section = "illumination", .field = (int)i + 1, .x = NAN};
        row.lambda_nm = s->model[s->primary].lambda_nm;
        row.quantity = "solid_angle", row.unit = "sr", row.value = task[i].study.solid_angle;
        lens_row_put(s->out, row);
        row.quantity = "relative", row.unit = "";
        row.value =
            task[i].study.solid_angle > 0.0 ? task[i].study.solid_angle * task[i].study.transmitted / first : 0.0;
        lens_row_put(s->out, row);
    }
}

static status run_fields(const lens_study *s, const lens_place *at, isa level, diagnostic *why)
{
    const size_t count = s->p->field_count;
    field_tasks all = {at, level, calloc(count, sizeof *all.task)};
    const int units = thread_team_units();
    thread_team *team = thread_team_create(units < (int)count ? units : (int)count);
    status code = all.task && team ? STATUS_OK : out_of_memory(why);
    for (size_t i = 0; code == STATUS_OK && i < count; i++) {
        all.task[i].study = *s;
        all.task[i].study.out = &all.task[i].own;
        all.task[i].study.bench = NULL;
    }
    if (code == STATUS_OK)
        thread_team_run(team, run_field, &all, count);
    if (code == STATUS_OK)
        put_illumination(s, all.task, count);
    for (size_t i = 0; all.task && i < count; i++) {
        field_task *t = &all.task[i];
        if (code == STATUS_OK && t->code != STATUS_OK) {
            code = t->code;
            if (why)
                *why = t->why;
        }
        for (size_t k = 0; code == STATUS_OK && k < t->own.count; k++)
            lens_row_put(s->out, t->own.row[k]);
        s->out->failed = s->out->failed || t->own.failed;
        lens_report_release(&t->own);
    }
    thread_team_destroy(team);
    free(all.task);
    return code;
}

/* --- the report --- */

static status check_options(const lens_options *o, diagnostic *why)
{
    const bool power = o->wave_grid >= 8 && o->wave_grid <= 256 && (o->wave_grid & (o->wave_grid - 1)) == 0;
    if (o->fan_rays < 2 || o->fan_rays > 500 || o->spot_grid < 4 || o->spot_grid > 256 || !power ||
        !(o->frequency_per_mm >= 0.0))
        return diagnose(
            why, STATUS_BAD_INPUT,
            "give 2 to 500 rays of a half fan, 4 to 256 across a spot, and 8, 16, ... 256 across a wavefront",
            "a number of rays is out of range");
    return STATUS_OK;
}

static status make(lens_study *s, lens_model *models, const lens_place *at, isa level, diagnostic *why)
{
    for (size_t w = 0; w < s->waves; w++)
        TRY(lens_model_make(s->p, s->p->wavelength[w].nm, &models[w], why));
    TRY(lens_first_make(s->p, &models[s->primary], &s->first, why));
    if (!(fabs(s->first.power) > 1e-9))
        return diagnose(why, STATUS_BAD_INPUT,
                        lens_is_round(s->p) ? "give a lens with a focus"
                                            : "give one with a focus there: radius is that along Y, radius_x along X",
                        lens_is_round(s->p) ? "the lens is afocal: it has no focus"
                                            : "the lens is afocal in the meridian of Y");
    TRY(open_benches(s, at, level, why));
    const double cutoff = 1.0 / (models[s->primary].lambda_nm * 1e-6 * s->first.working_number);
    s->frequency_most = s->options->frequency_per_mm > 0.0 ? s->options->frequency_per_mm : fmin(100.0, cutoff);
    TRY(whole_lens(s, why));
    return run_fields(s, at, level, why);
}

status lens_report_make(const lens_prescription *p, const lens_place *at, isa level, const lens_options *options,
                        lens_report *out, diagnostic *why)
{
    *out = (lens_report){0};
    TRY(check_options(options, why));
    if (p->wavelength_count == 0 || p->field_count == 0 || p->primary >= p->wavelength_count)
        return diagnose(why, STATUS_BAD_INPUT, "give at least one field and one wavelength",
                        "the lens has no wavelength, no primary one, or no field");
    lens_model *models = calloc(p->wavelength_count, sizeof *models);
    lens_study s = {
        .p = p, .options = options, .out = out, .model = models, .waves = p->wavelength_count, .primary = p->primary};
    status code = models ? make(&s, models, at, level, why) : out_of_memory(why);
    if (code == STATUS_OK && out->failed)
        code = out_of_memory(why);
    close_benches(&s);
    free(models);
    if (code != STATUS_OK)
        lens_report_release(out);
    return code;
}

status lens_set_light(lens_prescription *p, const lens_light *with, diagnostic *why)
{
    for (size_t i = 0; i < with->fields; i++)
        p->field[i] = (lens_field){0.0, with->field[i], 1.0}, p->vignetting[i] = (lens_vignetting){0};
    p->field_count = with->fields ? with->fields : p->field_count;
    for (size_t i = 0; i < with->wavelengths; i++) {
        const double nm = with->lambda_nm[i];
        if (!(nm >= 200.0 && nm <= 2000.0))
            return diagnose(why, STATUS_BAD_INPUT, "give nanometres, from 200 to 2000",
                            "the wavelength %g is out of range", nm);
        p->wavelength[i] = (lens_wavelength){nm, 1.0};
    }
    if (with->wavelengths) {
        p->wavelength_count = with->wavelengths;
        p->primary = 0;
    }
    return STATUS_OK;
}

status lens_report_of_scene(scene *s, const char *system, const lens_light *with, isa level,
                            const lens_options *options, lens_report *out, diagnostic *why)
{
    lens_prescription p = lens_prescription_empty();
    lens_place place;
    *out = (lens_report){0};
    status code = lens_place_in_scene(s, system, &p, &place, why);
    THEN(code, lens_set_light(&p, with, why));
    THEN(code, lens_report_make(&p, &place, level, options, out, why));
    lens_prescription_release(&p);
    return code;
}
