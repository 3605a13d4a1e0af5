/* `cuvette lens`: reads and writes lens prescriptions, and turns them into scenes and back. */
#include "base/text.h"
#include "cli/cli.h"
#include "cli/options.h"
#include "cli/outputs.h"
#include "cli/scene_input.h"
#include "cli/terminal.h"
#include "scene/file/write.h"
#include "scene/lens/lens_prescription.h"
#include "scene/model/scene.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { GLASS_FILES_MAX = 16 };

typedef struct lens_request {
    const char *path, *output, *system;
    const char *glass_file[GLASS_FILES_MAX];
    size_t glass_files;
} lens_request;

static status parse_glasses(const command_option *o, void *context, const char *value, diagnostic *why)
{
    lens_request *request = context;
    (void)o;
    if (request->glass_files == GLASS_FILES_MAX)
        return options_wrong("--glasses", value, why, "join the catalogues in one file", "more than %d files",
                             GLASS_FILES_MAX);
    request->glass_file[request->glass_files++] = value;
    return STATUS_OK;
}

static const command_option options[] = {
    {"glasses", 'g', "FILE", "glass catalogue (.agf), which precedes the catalogue of media; may be repeated",
     .store = parse_glasses},
    {"system", 0, "NAME", "of a scene: the lens system with that name (default: all its lenses)",
     OPTION_FILLS(option_text, lens_request, system)},
    {"output", 'o', "FILE", "write a scene (.yaml) or a lens file (.zmx, .dat, .csv)",
     OPTION_FILLS(option_text, lens_request, output)},
    {0},
};

static const command_form form = {
    .options = options,
    .synopsis = "FILE [-o FILE]",
    .arguments_at = offsetof(lens_request, path),
    .argument_limit = 1,
    .excess_remedy = "give one file",
    .excess = "unexpected argument '%.128s'",
    .about =
        "Read the prescription of a lens system from a lens file (.zmx of Zemax, .dat of pbrt, or .csv) or from the "
        "lenses of a scene, and print its surfaces and paraxial data, or write it as a scene that can be rendered "
        "at once (.yaml) or as a lens file.\vExamples: cuvette lens triplet.zmx -o triplet.yaml; cuvette lens "
        "triplet.yaml -o triplet.csv. What a lens does: cuvette lens report FILE. Manual: cuvette-lens(1), "
        "cuvette-lens-report(1).",
};

/* --- the table --- */

static void print_number(const char *format, double value)
{
    if (isfinite(value))
        printf(format, value);
    else
        printf("%14s", "inf");
}

static void print_surfaces(const lens_prescription *p)
{
    char word[LENS_NAME_MAX];
    printf("%3s %14s %14s %14s %10s  %s\n", "", "radius", "thickness", "diameter", "conic", "medium");
    for (size_t i = 0; i < p->count; i++) {
        const lens_surface *s = &p->surface[i];
        bool even = false;
        for (int k = 0; k < LENS_EVEN_TERMS; k++)
            even |= s->even[k] != 0.0 || s->odd[k] != 0.0;
        printf("%3zu ", i + 1);
        print_number("%14.7g ", s->radius == 0.0 ? INFINITY : s->radius);
        printf("%s%14.7g %14.7g %10.5g  %s%s%s", s->radius == 0.0 ? " " : "", s->thickness, s->diameter, s->conic,
               s->mirror ? "mirror" : lens_medium_text(&s->medium, word), even ? ", asphere" : "",
               p->stop == (int)i ? ", stop" : "");
        if (s->chamfer > 0.0)
            printf(", bevel %.7g", s->chamfer);
        if (lens_folds(s))
            printf(", tilted %.7g, %.7g degrees", s->tilt_x_deg, s->tilt_y_deg);
        putchar('\n');
        if (s->form != SIDE_ROUND)
            printf("%s along x:%8.7g %32s%10.5g  %s\n", "   ", s->radius_x == 0.0 ? INFINITY : s->radius_x, "",
                   s->conic_x, s->form == SIDE_TORIC ? "toric" : "biconic");
    }
}

static void print_paraxial(const lens_prescription *p)
{
    const double nm = p->wavelength[p->primary].nm;
    const lens_first_order f = lens_first_order_of(p, nm);
    printf("\nparaxial, at %.10g nm, lengths in units of %.10g mm\n", nm, p->unit_mm);
    printf("  focal length            %.9g\n  back focal distance     %.9g\n", f.efl, f.back);
    printf("  image distance          %.9g (last thickness %.9g)\n", f.image, p->surface[p->count - 1].thickness);
    if (f.pupil_diameter > 0.0) {
        printf("  entrance pupil          %.9g, diameter %.9g\n", f.pupil, f.pupil_diameter);
        printf("  exit pupil              %.9g, from the last vertex\n", f.exit_pupil);
        printf("  f-number                %.6g\n", fabs(f.efl) / f.pupil_diameter);
    }
    if (f.magnification != 0.0)
        printf("  magnification           %.9g\n", f.magnification);
    if (lens_is_round(p))
        return;
    const lens_first_order x = lens_first_order_x(p, nm);
    printf("in the meridian of x, as a surface is not round\n");
    printf("  focal length            %.9g\n  back focal distance     %.9g\n", x.efl, x.back);
    printf("  image distance          %.9g\n", x.image);
}

static void print_prescription(const lens_prescription *p)
{
    if (p->title[0])
        printf("%s\n\n", p->title);
    print_surfaces(p);
    print_paraxial(p);
}

/* --- reading and writing --- */

static status read_scene(const lens_request *request, lens_prescription *out, scene **s, diagnostic *why)
{
    const scene_input input = {.path = request->path};
    TRY(scene_input_read(&input, s, why));
    TRY(scene_input_load(*s, why));
    return locate_failure(why, request->path, lens_of_scene(*s, request->system, out, NULL, why));
}

/* The files of the scene's data, by which its media are written. The caller frees the list and its texts. */
static status files_of_data(const scene *s, char ***out, diagnostic *why)
{
    *out = calloc(s->data_count + 1, sizeof **out);
    for (size_t i = 0; *out && i < s->data_count; i++)
        if (!((*out)[i] = scene_file_path(s, s->data[i].path ? s->data[i].path : "")))
            return out_of_memory(why);
    return *out ? STATUS_OK : out_of_memory(why);
}

/* *s: the scene whose data the media of the prescription borrow, also after an error; NULL for a file. */
static status read_prescription(const lens_request *request, const lens_glasses *glasses, lens_prescription *out,
                                scene **s, diagnostic *why)
{
    *out = lens_prescription_empty();
    if (!lens_file_named(request->path) && glasses->count > 0)
        return options_wrong("--glasses", glasses->file[0], why, "omit it", "a scene names its own files of glasses");
    if (!lens_file_named(request->path))
        return read_scene(request, out, s, why);
    if (request->system)
        return options_wrong("--system", request->system, why, "omit it", "a lens file holds one system");
    return lens_file_read(request->path, glasses, out, why);
}

typedef struct lens_text {
    const lens_prescription *p;
    const char *path;
} lens_text;

static status write_text(const void *content, FILE *out, diagnostic *why)
{
    const lens_text *t = content;
    return lens_file_write(t->p, t->path, out, why);
}

static status write_scene(const lens_prescription *p, const lens_glasses *glasses, const char *path, diagnostic *why)
{
    scene *s = NULL;
    TRY(lens_scene_create(p, glasses, &s, why));
    status code = scene_check(s, why);
    THEN(code, scene_write(s, path, false, why));
    scene_destroy(s);
    return code;
}

static status write(const lens_prescription *p, const scene *source, const lens_glasses *glasses, const char *path,
                    bool as_scene, diagnostic *why)
{
    const lens_text text = {p, path};
    const char *lacks = as_scene ? NULL : lens_file_lacks(p, path);
    char **file = NULL, line[200];
    if (!as_scene)
        TRY(outputs_write_text(path, write_text, &text, why));
    snprintf(line, sizeof line, "it does not hold %s", lacks ? lacks : "");
    if (lacks)
        terminal_note_of(path, line);
    if (!as_scene)
        return STATUS_OK;
    if (!source)
        return write_scene(p, glasses, path, why);
    status code = files_of_data(source, &file, why);
    const lens_glasses own = {.file = (const char *const *)file, .count = source->data_count};
    THEN(code, write_scene(p, &own, path, why));
    for (size_t i = 0; file && i < source->data_count; i++)
        free(file[i]);
    free(file);
    return code;
}

static status run(const lens_request *request, diagnostic *why)
{
    static const char *const endings[] = {".yaml", ".yml", ".zmx", ".dat", ".csv"};
    const lens_glasses glasses = {.file = request->glass_file, .count = request->glass_files};
    lens_prescription p;
    size_t ending = 0;
    if (request->output) {
        TRY(outputs_ending("-o", request->output, endings, 5, "use a name that ends in .yaml, .zmx, .dat or .csv",
                           &ending, why));
        TRY(outputs_check_folder("-o", request->output, why));
        if (outputs_same_entry(request->path, request->output))
            return options_wrong("-o", request->output, why, "write to another file", "it is the file that is read");
    }
    scene *source = NULL;
    status code = read_prescription(request, &glasses, &p, &source, why);
    if (code == STATUS_OK)
        terminal_note_of(request->path, p.note);
    if (code == STATUS_OK && !request->output)
        print_prescription(&p);
    else if (code == STATUS_OK)
        code = locate_failure(why, request->path, write(&p, source, &glasses, request->output, ending < 2, why));
    lens_prescription_release(&p);
    scene_destroy(source);
    return code;
}

/* `lens report`: its first word is the command's. */
static status run_report(int argc, char **argv, diagnostic *why)
{
    char *program = text_format("%s report", argv[0]);
    if (!program)
        return out_of_memory(why);
    argv[1] = program;
    const status code = command_lens_report(argc - 1, argv + 1, why);
    free(program);
    return code;
}

status command_lens(int argc, char **argv, diagnostic *why)
{
    if (argc > 1 && strcmp(argv[1], "report") == 0)
        return run_report(argc, argv, why);
    lens_request request = {0};
    TRY(command_form_read(&form, argc, argv, &request, why));
    if (!request.path)
        return options_wrong("lens", NULL, why, "give a lens file (.zmx, .dat, .csv) or a scene", "no file is given");
    return run(&request, why);
}
