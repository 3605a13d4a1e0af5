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
        "  cuvette lens report lens.zmx --figure lens.png",
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

static status write_script(const void *content, FILE *out, diagnostic *why)
{
    const figure_data *d = content;
    const lens_prescription *p = d->p;
    (void)why;
    plot_script_open(out, "cuvette lens report", d->base, ".rows.csv", 1000, 1400);
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
            "vertex; nm:\".waves.\" (green, blue, vermillion); sagittal dashed\"\n",
            first_number(d->report, "efl"), first_number(d->report, "f_number"),
            first_number(d->report, "entrance_pupil"), first_number(d->report, "z_image"));
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
