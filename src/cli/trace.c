/* `cuvette trace`: the ray tree of a pixel or a ray, as text, JSON or a drawing. */
#include "cli/cli.h"
#include "cli/options.h"
#include "cli/outputs.h"
#include "cli/scene_input.h"
#include "report/trace_writers.h"
#include "scene/model/scene.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

typedef enum trace_format { FORMAT_TEXT, FORMAT_JSON, FORMAT_CSV, FORMAT_SVG, FORMAT_NONE } trace_format;

typedef struct trace_request {
    scene_input input;
    trace_format format;
    bool by_pixel, by_ray, beams;
    double pixel[2], ray[6];
} trace_request;

static status parse_format(const command_option *o, void *context, const char *value, diagnostic *why)
{
    trace_request *request = context;
    const trace_format format = strcmp(o->name, "text") == 0   ? FORMAT_TEXT
                                : strcmp(o->name, "json") == 0 ? FORMAT_JSON
                                : strcmp(o->name, "csv") == 0  ? FORMAT_CSV
                                                               : FORMAT_SVG;
    (void)value;
    if (request->format != FORMAT_NONE && request->format != format)
        return options_wrong("trace", NULL, why, "give only one of --text, --json, --csv, --svg",
                             "more than one format is given");
    request->format = format;
    return STATUS_OK;
}

static status parse_pixel(const command_option *o, void *context, const char *value, diagnostic *why)
{
    trace_request *request = context;
    (void)o;
    request->by_pixel = true;
    const status result = options_reals("--pixel", value, "X,Y as two integers", 2, request->pixel, why);
    for (int k = 0; k < 2 && result == STATUS_OK; k++)
        if (floor(request->pixel[k]) != request->pixel[k] || fabs(request->pixel[k]) > 1e9)
            return options_wrong("--pixel", value, why, "give X,Y as two integers", "invalid pixel");
    return result;
}

static status parse_ray(const command_option *o, void *context, const char *value, diagnostic *why)
{
    trace_request *request = context;
    request->by_ray = true;
    return options_reals("--ray", value, o->form, 6, request->ray, why);
}

static const command_option options[] = {
    {"pixel", 0, "X,Y", "trace the camera rays of a pixel; 0,0 is at the top left", .store = parse_pixel},
    {"ray", 0, "OX,OY,OZ,DX,DY,DZ", "trace the ray from a point in a direction of any length", .store = parse_ray},
    {"beams", 0, NULL, "trace the rays of the scene's beams, each with its own depth and wavelengths",
     OPTION_FILLS(option_flag, trace_request, beams)},
    OPTION_DEPTH,
    OPTION_LAMBDA,
    {"min-weight", 0, "W", "do not trace rays with a weight below W, but count them; sets render.min_weight",
     .store = option_change, .parameter = "render.min_weight"},
    OPTION_SET("'liquid.ior=1.4'"),
    OPTION_MEMORY,
    {"text", 0, NULL, "print an indented tree, one line per ray (the default)", .store = parse_format},
    {"json", 0, NULL, "print one JSON object", .store = parse_format},
    {"csv", 0, NULL, "print comma-separated values, a row for each ray", .store = parse_format},
    {"svg", 0, NULL, "draw the tree in the plane of incidence and from above", .store = parse_format},
    OPTION_OUTPUT("write to FILE; its ending selects the format: .txt, .json, .csv, .svg"),
    {0},
};

/* What acts on trees of pixels and free rays alone. */
static status check_beam_options(const scene_input *input, diagnostic *why)
{
    static const struct {
        const char *option, *parameter;
    } own[] = {{"depth", "depth"}, {"lambda", "lambda_nm"}, {"min-weight", "min_fraction"}};
    for (size_t i = 0; i < input->count; i++)
        for (size_t k = 0; k < sizeof own / sizeof *own; k++)
            if (strcmp(input->changes[i].option, own[k].option) == 0) {
                char remedy[64];
                snprintf(remedy, sizeof remedy, "use --set BEAM.%s=VALUE", own[k].parameter);
                return options_wrong("--beams", NULL, why, remedy, "--%s does not act on beams", own[k].option);
            }
    return STATUS_OK;
}

static status check_request(void *context, diagnostic *why)
{
    static const char *const endings[] = {".txt", ".json", ".csv", ".svg"};
    trace_request *request = context;
    const int given = request->by_pixel + request->by_ray + request->beams;
    if (given != 1)
        return options_wrong("trace", NULL, why, "give --pixel X,Y, --ray OX,OY,OZ,DX,DY,DZ or --beams",
                             given ? "--pixel, --ray and --beams exclude each other" : "no ray is given");
    if (request->beams)
        TRY(check_beam_options(&request->input, why));
    size_t which = FORMAT_TEXT;
    status result = STATUS_OK;
    if (request->format == FORMAT_NONE && request->input.output && strcmp(request->input.output, "-") != 0)
        result = outputs_ending("-o", request->input.output, endings, 4,
                                "use .txt, .json, .csv or .svg, or give --text, --json, --csv or --svg", &which, why);
    if (request->format == FORMAT_NONE)
        request->format = (trace_format)which;
    if (result == STATUS_OK && request->beams && request->format == FORMAT_SVG)
        return options_wrong("trace", NULL, why, "use --text, --json or --csv, or cuvette render --beams for an image",
                             "beams have no drawing of one plane");
    return result;
}

static status trace_tree(const trace_request *request, probe *p, ray_tree *tree, diagnostic *why)
{
    const double *r = request->ray;
    status result = request->by_pixel
                        ? probe_pixel(p, (int)request->pixel[0], (int)request->pixel[1], tree, why)
                        : probe_ray(p, vec3_make(r[0], r[1], r[2]), vec3_make(r[3], r[4], r[5]), tree, why);
    if (result == STATUS_BAD_INPUT)
        diagnostic_locate(why, request->by_pixel ? "--pixel" : "--ray", 0, 0);
    return result;
}

typedef struct formatted {
    traced tree;
    trace_format format;
} formatted;

static status write_as(const void *content, FILE *out, diagnostic *why)
{
    const formatted *f = content;
    switch (f->format) {
    case FORMAT_JSON: return trace_write_json(&f->tree, out, why);
    case FORMAT_CSV: return trace_write_csv(&f->tree, out, why);
    case FORMAT_SVG: return trace_write_drawing(&f->tree, out, why);
    case FORMAT_TEXT:
    case FORMAT_NONE: break;
    }
    return trace_write_text(&f->tree, out, why);
}

typedef struct formatted_beams {
    beam_output beams;
    trace_format format;
} formatted_beams;

static status write_beams_as(const void *content, FILE *out, diagnostic *why)
{
    const formatted_beams *f = content;
    switch (f->format) {
    case FORMAT_JSON: return beams_write_json(&f->beams, out, why);
    case FORMAT_CSV: return beams_write_csv(&f->beams, out, why);
    case FORMAT_SVG:
    case FORMAT_TEXT:
    case FORMAT_NONE: break;
    }
    return beams_write_text(&f->beams, out, why);
}

static status run_beams(const trace_request *request, const scene *s, isa level, diagnostic *why)
{
    if (s->beam_count == 0)
        return options_wrong("--beams", NULL, why, "add one: cuvette scene SCENE --add beam:laser", "%s has no beams",
                             request->input.path);
    const formatted_beams f = {{s, level, request->input.path, 0, false}, request->format};
    scene_input_note_beams(s);
    return outputs_write_text(request->input.output, write_beams_as, &f, why);
}

static status run(void *context, scene *s, isa level, diagnostic *why)
{
    const trace_request *request = context;
    if (request->beams)
        return run_beams(request, s, level, why);
    probe *p = NULL;
    ray_tree tree = {0};
    status result = scene_input_probe(&request->input, s, level, &p, why);
    THEN(result, trace_tree(request, p, &tree, why));
    if (result == STATUS_OK) {
        const formatted f = {{s, p, &tree, request->input.path, false}, request->format};
        scene_input_note_tree(&request->input, s);
        result = outputs_write_text(request->input.output, write_as, &f, why);
    }
    ray_tree_release(&tree);
    probe_destroy(p);
    return result;
}

static const scene_command trace_command = {
    .name = "trace",
    .form =
        {.options = options,
         .synopsis = "SCENE (--pixel X,Y | --ray OX,OY,OZ,DX,DY,DZ | --beams)",
         SCENE_WORD("trace", "-o FILE for an output, "),
         .about =
             "Trace one ray and print its ray tree: media, angles, reflectances, and the contribution of each ray to "
             "the pixel. The radiance of a pixel's tree equals the image, bit for bit.\vFor example:\n"
             "  cuvette trace experiments/scenes/rod.yaml --pixel 400,300 --depth 3\n"
             "  cuvette trace experiments/scenes/rod.yaml --ray -3,1.5,0.4,1,0,0 -o ray.svg"},
    .check = check_request,
    .run = run,
};

status command_trace(int argc, char **argv, diagnostic *why)
{
    trace_request request = {.format = FORMAT_NONE};
    return scene_command_run(&trace_command, argc, argv, &request, why);
}
