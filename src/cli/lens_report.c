/* `cuvette lens report`: what a lens does, by first order, aberrations and real rays, as text, CSV, JSON or a page of
 * figures. */
#include "base/file.h"
#include "base/text.h"
#include "cli/cli.h"
#include "cli/options.h"
#include "cli/outputs.h"
#include "cli/scene_input.h"
#include "cli/terminal.h"
#include "lens/lens.h"
#include "report/json.h"
#include "report/param_rows.h"
#include "scene/lens/lens_prescription.h"
#include "study/plot/plot.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { GLASS_FILES_MAX = 16 };

typedef struct report_request {
    const char *path, *system, *figure;
    const char *glass_file[GLASS_FILES_MAX];
    size_t glass_files;
    lens_options options;
    lens_light light;
    int64_t fan, spot, wave;
    bool json, csv;
} report_request;

static status parse_frequency(const command_option *o, void *context, const char *value, diagnostic *why)
{
    (void)o;
    report_request *r = context;
    TRY(options_reals("--frequency", value, "a number", 1, &r->options.frequency_per_mm, why));
    return r->options.frequency_per_mm > 0.0
               ? STATUS_OK
               : options_wrong("--frequency", value, why, "use a number above 0", "out of range");
}

static status parse_list(const char *name, const char *value, double *list, size_t *count, diagnostic *why)
{
    *count = 1;
    for (const char *at = value; *at; at++)
        *count += *at == ',';
    if (*count > LENS_LIST_MAX)
        return options_wrong(name, value, why, "give fewer", "more than %d numbers", LENS_LIST_MAX);
    return options_reals(name, value, "numbers with commas between", *count, list, why);
}

static status parse_field(const command_option *o, void *context, const char *value, diagnostic *why)
{
    lens_light *with = &((report_request *)context)->light;
    (void)o;
    return parse_list("--field", value, with->field, &with->fields, why);
}

static status parse_wavelength(const command_option *o, void *context, const char *value, diagnostic *why)
{
    lens_light *with = &((report_request *)context)->light;
    (void)o;
    return parse_list("--wavelength", value, with->lambda_nm, &with->wavelengths, why);
}

static status parse_glasses(const command_option *o, void *context, const char *value, diagnostic *why)
{
    report_request *r = context;
    (void)o;
    if (r->glass_files == GLASS_FILES_MAX)
        return options_wrong("--glasses", value, why, "join the catalogues in one file", "more than %d files",
                             GLASS_FILES_MAX);
    r->glass_file[r->glass_files++] = value;
    return STATUS_OK;
}

static const command_option options[] = {
    {"json", 0, NULL, "print one JSON object", OPTION_FILLS(option_flag, report_request, json)},
    {"csv", 0, NULL, "print one row for each number", OPTION_FILLS(option_flag, report_request, csv)},
    {"figure", 0, "FILE",
     "draw a page of figures with gnuplot (.png, .svg or .pdf); its data (.rows.csv) and its script "
     "(.gp) are written next to it",
     OPTION_FILLS(option_text, report_request, figure)},
    {"system", 0, "NAME", "of a scene: the lens system with that name (default: all its lenses)",
     OPTION_FILLS(option_text, report_request, system)},
    {"glasses", 'g', "FILE", "glass catalogue (.agf), which precedes the catalogue of media; may be repeated",
     .store = parse_glasses},
    {"field", 0, "LIST", "fields along +Y, such as 0,10,20, instead of those of the lens: degrees, or heights",
     .store = parse_field},
    {"wavelength", 0, "LIST",
     "wavelengths in nm, such as 588,486,656, the primary one first, instead of those of the lens",
     .store = parse_wavelength},
    {"frequency", 0, "N", "highest frequency of the MTF, cycles per mm (default: 100, or the cutoff)",
     .store = parse_frequency},
    {"fan", 0, "N", "number of rays in half a ray fan (default: 20)", OPTION_FILLS(option_integer, report_request, fan),
     .lowest = 2, .highest = 500},
    {"spot", 0, "N", "number of rays across the pupil in a spot diagram (default: 32)",
     OPTION_FILLS(option_integer, report_request, spot), .lowest = 4, .highest = 256},
    {"wave", 0, "N", "samples across the pupil of a wavefront: 8, 16, ... 256 (default: 64)",
     OPTION_FILLS(option_integer, report_request, wave), .lowest = 8, .highest = 256},
    {0},
};

static const command_form form = {
    .options = options,
    .arguments_at = offsetof(report_request, path),
    .argument_limit = 1,
    .excess = "unexpected argument '%.128s'",
    .excess_remedy = "lens report takes one scene or file of a prescription",
    .synopsis = "SCENE|FILE",
    .about =
        "Report on the lens of a prescription (.zmx, .dat, .csv) or of a scene: first order, Seidel sums, ray fans, "
        "spots, distortion, field curves, colour, vignetting, wavefronts, MTF, point images and ghosts.\vLengths "
        "are mm. Rays are aimed at the real stop and traced through solids. For example:\n"
        "  cuvette lens report lens.zmx\n"
        "  cuvette lens report lens.zmx --csv > lens.csv\n"
        "  cuvette lens report lens.zmx --figure lens.png\n"
        "Manual: cuvette-lens-report(1).",
};

/* --- the figure --- */

/* plots/lens.gp, embedded by the assembler. */
extern const char lens_figure_script[];
__asm__(".pushsection .rodata\n.globl lens_figure_script\n.hidden lens_figure_script\nlens_figure_script: .incbin "
        "\"plots/lens.gp\"\n.byte 0\n.popsection");

typedef struct figure_data {
    const lens_report *report;
    const lens_prescription *p;
    const char *title, *base;
} figure_data;

static status write_data(const void *content, FILE *out, diagnostic *why)
{
    (void)why;
    lens_write_csv(((const figure_data *)content)->report, out);
    return STATUS_OK;
}

/* A number of the first section. */
static double first_number(const lens_report *r, const char *quantity)
{
    for (size_t i = 0; i < r->count; i++)
        if (strcmp(r->row[i].section, "first-order") == 0 && strcmp(r->row[i].quantity, quantity) == 0)
            return r->row[i].value;
    return NAN;
}

/* --- the lens in the plane of the fields, as blocks of points z y --- */

static void put_point(FILE *out, const lens_surface *s, double z, double y)
{
    const double sag = lens_surface_sag(s, fabs(y));
    if (isfinite(z + sag))
        fprintf(out, "%.7g,%.7g\n", z + sag, y);
}

/* The surfaces over their diameters, the rims of glass, and the image. */
static void put_sides(const lens_prescription *p, double image_y, FILE *out)
{
    enum { POINTS = 20 };
    double z = 0.0;
    for (size_t i = 0; i < p->count; i++) {
        const lens_surface *s = &p->surface[i];
        const double half = 0.5 * s->diameter, next = i + 1 < p->count ? 0.5 * s[1].diameter : 0.0;
        for (int k = -POINTS; k <= POINTS; k++)
            put_point(out, s, z, half * k / POINTS);
        fputc('\n', out);
        for (int way = -1; way <= 1 && !s->mirror && s->medium.kind != LENS_AIR && i + 1 < p->count; way += 2) {
            put_point(out, s, z, way * half);
            put_point(out, s + 1, z + s->thickness, way * next);
            fputc('\n', out);
        }
        z += s->thickness;
    }
    fprintf(out, "%.7g,%.7g\n%.7g,%.7g\n", z, -image_y, z, image_y);
}

/* A paraxial ray: the chief ray and parts of the marginal one, from before the lens to the image. */
static void put_ray(const lens_prescription *p, const lens_first_order *f, double chief, double part, FILE *out)
{
    double y = 0.0, u = chief * f->chief.u[0] + part * f->marginal.u[0], z = 0.0, length = 0.0;
    for (size_t i = 0; i < p->count; i++)
        length += fabs(p->surface[i].thickness);
    y = chief * f->chief.y[0] + part * f->marginal.y[0];
    const double before = fmin(0.25 * length, p->object_distance);
    fprintf(out, "%.7g,%.7g\n", -before, y - before * u);
    for (size_t i = 0; i < p->count; i++) {
        y = chief * f->chief.y[i] + part * f->marginal.y[i];
        u = chief * f->chief.u[i + 1] + part * f->marginal.u[i + 1];
        put_point(out, &p->surface[i], z, y);
        z += p->surface[i].thickness;
    }
    fprintf(out, "%.7g,%.7g\n\n", z, y + u * p->surface[p->count - 1].thickness);
}

/* The largest part of the marginal ray, above or below the chief ray, that the rims let pass. */
static double part_that_passes(const lens_prescription *p, const lens_first_order *f, int chief, int way)
{
    double part = way;
    for (size_t i = 0; i < p->count; i++) {
        const double half = 0.5 * p->surface[i].diameter, m = f->marginal.y[i], c = chief * f->chief.y[i];
        const double edge = m * part >= 0.0 ? half - c : -half - c, most = m != 0.0 ? edge / m : part;
        if (half > 0.0 && fabs(c + part * m) > half && most * way >= 0.0)
            part = most;
    }
    return part;
}

static void put_layout(const lens_prescription *p, FILE *out)
{
    const lens_first_order f = lens_first_order_of(p, p->wavelength[p->primary].nm);
    const double image_y = fabs(f.chief.y[p->count - 1] + f.chief.u[p->count] * p->surface[p->count - 1].thickness);
    fputs("$sides << END\n", out);
    put_sides(p, fmax(image_y, 0.25 * f.stop_diameter), out);
    fputs("END\n", out);
    for (int chief = 0; chief < 2; chief++) {
        fprintf(out, "$%s << END\n", chief ? "slanting" : "axial");
        for (int part = -1; part <= 1; part++)
            put_ray(p, &f, chief, part ? part_that_passes(p, &f, chief, part) : 0.0, out);
        fputs("END\n", out);
    }
}

static status write_script(const void *content, FILE *out, diagnostic *why)
{
    const figure_data *d = content;
    const lens_prescription *p = d->p;
    (void)why;
    plot_script_open(out, "cuvette lens report", d->base, ".rows.csv", 1000, 1700);
    fputs("lens = ", out);
    plot_script_text(out, d->title);
    fprintf(out, "\nfields = %zu; field_unit = \"%s\"; waves = \"", p->field_count,
            p->field_kind == LENS_FIELD_ANGLE ? "deg" : "mm");
    fprintf(out, "%.10g", p->wavelength[p->primary].nm);
    for (size_t w = 0; w < p->wavelength_count; w++)
        if (w != p->primary)
            fprintf(out, " %.10g", p->wavelength[w].nm);
    fprintf(out,
            "\"\nfirst = \"focal length %.6g mm, f/%.4g, entrance pupil %.5g mm, image at %.6g mm from the first "
            "vertex\"\n",
            first_number(d->report, "efl"), first_number(d->report, "f_number"),
            first_number(d->report, "entrance_pupil"), first_number(d->report, "z_image"));
    put_layout(p, out);
    fputs(lens_figure_script, out);
    return STATUS_OK;
}

static status draw(const lens_report *report, const lens_prescription *p, const char *title, const char *path,
                   diagnostic *why)
{
    static const char *const endings[] = {".png", ".svg", ".pdf"};
    size_t which = 0;
    TRY(outputs_ending("--figure", path, endings, 3, "use a name that ends in .png, .svg or .pdf", &which, why));
    char *base = text_format("%.*s", (int)strlen(path) - 4, path);
    char *data = base ? text_format("%s.rows.csv", base) : NULL, *script = base ? text_format("%s.gp", base) : NULL;
    const figure_data content = {report, p, title, base};
    status code = data && script ? STATUS_OK : out_of_memory(why);
    THEN(code, outputs_write_text(data, write_data, &content, why));
    THEN(code, outputs_write_text(script, write_script, &content, why));
    THEN(code, study_plot_draw(base, endings[which] + 1, 300, why));
    free(base);
    free(data);
    free(script);
    return code;
}

/* --- the command --- */

static status write_report(const report_request *r, const lens_prescription *p, const lens_report *report,
                           const char *title, diagnostic *why)
{
    if (r->figure) {
        TRY(draw(report, p, title, r->figure, why));
        printf("%s -> %s\n", r->path, r->figure);
        return STATUS_OK;
    }
    if (r->json)
        return json_print(lens_json(report, title), why);
    if (r->csv)
        lens_write_csv(report, stdout);
    else
        return lens_write_text(report, title, terminal_columns(STDOUT_FILENO), stdout, why);
    return STATUS_OK;
}

static status report_on(report_request *r, diagnostic *why)
{
    lens_prescription p = lens_prescription_empty();
    lens_report report = {0};
    const lens_glasses glasses = {.file = r->glass_file, .count = r->glass_files};
    scene *s = NULL;
    lens_place place;
    isa level;
    TRY(scene_input_isa(&level, why));
    if (!lens_file_named(r->path) && r->glass_files > 0)
        return options_wrong("--glasses", r->glass_file[0], why, "omit it", "a scene names its own files of glasses");
    status code = lens_open(r->path, r->system, &glasses, &p, &s, &place, why);
    THEN(code, lens_set_light(&p, &r->light, why));
    THEN(code, lens_report_make(&p, &place, level, &r->options, &report, why));
    if (code == STATUS_OK)
        terminal_note_of(r->path, p.note);
    THEN(code, write_report(r, &p, &report, p.title[0] ? p.title : r->path, why));
    lens_report_release(&report);
    lens_prescription_release(&p);
    scene_destroy(s);
    return code;
}

status command_lens_report(int argc, char **argv, diagnostic *why)
{
    report_request r = {.options = lens_options_usual};
    r.fan = r.options.fan_rays, r.spot = r.options.spot_grid, r.wave = r.options.wave_grid;
    TRY(command_form_read(&form, argc, argv, &r, why));
    if (!r.path)
        return options_wrong("lens report", NULL, why, "name a scene, or a file .zmx, .dat or .csv",
                             "no lens is given");
    if (r.json + r.csv + (r.figure != NULL) > 1)
        return options_wrong("lens report", NULL, why, "use only one of them",
                             "--json, --csv and --figure exclude each other");
    if (r.wave & (r.wave - 1))
        return options_wrong("--wave", NULL, why, "use 8, 16, 32, 64, 128 or 256", "not a power of two");
    r.options.fan_rays = (int)r.fan, r.options.spot_grid = (int)r.spot, r.options.wave_grid = (int)r.wave;
    return report_on(&r, why);
}
