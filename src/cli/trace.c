#include "cli/cli.h"
#include "cli/options.h"
#include "cli/outputs.h"
#include "cli/scene_input.h"
#include "report/trace_writers.h"
#include "base/file.h"
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

typedef enum trace_format { FORMAT_TEXT, FORMAT_JSON, FORMAT_SVG, FORMAT_NONE } trace_format;

typedef struct trace_request {
    scene_input input;
    const char *output; /* NULL: standard output */
    trace_format format;
    bool by_pixel, by_ray, one_wavelength;
    double pixel[2], ray[6];
} trace_request;

enum { KEY_PIXEL = 0x100, KEY_RAY, KEY_DEPTH, KEY_LAMBDA, KEY_JSON, KEY_TEXT, KEY_SVG };

static const struct argp_option options[] = {
    {"pixel", KEY_PIXEL, "X,Y", 0, "trace the camera rays of a pixel; 0,0 is at the top left", 0},
    {"ray", KEY_RAY, "OX,OY,OZ,DX,DY,DZ", 0, "trace the ray from a point in a direction of any length", 0},
    {"depth", KEY_DEPTH, "N", 0, "the same as --set render.depth=N", 0},
    {"lambda", KEY_LAMBDA, "NM", 0,
     "one wavelength for indices and for absorption by wavelength; sets render.lambda_nm", 0},
    {"set", 's', "PATH=VALUE", 0, "set a parameter, as 'liquid.ior=1.4'; may be given many times", 0},
    {"text", KEY_TEXT, NULL, 0, "print an indented tree, a line a ray (the default)", 0},
    {"json", KEY_JSON, NULL, 0, "print one JSON object", 0},
    {"svg", KEY_SVG, NULL, 0, "draw the tree in the plane of incidence and from above", 0},
    {"output", 'o', "FILE", 0, "write there; without a format, the ending says which: .txt, .json, .svg", 0},
    {0},
};

static error_t take_format(trace_request *request, trace_format format, diagnostic *why)
{
    if (request->format == FORMAT_NONE || request->format == format) {
        request->format = format;
        return 0;
    }
    diagnose(why, STATUS_BAD_INPUT, "give one of --text, --json, --svg", "there is more than one format");
    diagnostic_locate(why, "trace", 0, 0);
    return EINVAL;
}

static error_t take_pixel(trace_request *request, const char *value, diagnostic *why)
{
    request->by_pixel = true;
    if (options_reals("--pixel", value, "X,Y as two integers", 2, request->pixel, why) != STATUS_OK)
        return EINVAL;
    for (int k = 0; k < 2; k++)
        if (floor(request->pixel[k]) != request->pixel[k] || fabs(request->pixel[k]) > 1e9) {
            char where[512];
            snprintf(where, sizeof where, "--pixel %s", value);
            diagnose(why, STATUS_BAD_INPUT, "give X,Y as two integers", "there is no such pixel");
            diagnostic_locate(why, where, 0, 0);
            return EINVAL;
        }
    return 0;
}

static error_t take_option(int key, char *value, struct argp_state *state)
{
    options_input *input = state->input;
    trace_request *request = input->request;
    switch (key) {
    case 's': scene_input_change(&request->input, "--set", NULL, value); return 0;
    case 'o': request->output = value; return 0;
    case KEY_DEPTH: scene_input_change(&request->input, "--depth", "render.depth", value); return 0;
    case KEY_LAMBDA:
        request->one_wavelength = true;
        scene_input_change(&request->input, "--lambda", "render.lambda_nm", value);
        return 0;
    case KEY_PIXEL: return take_pixel(request, value, input->why);
    case KEY_RAY:
        request->by_ray = true;
        return options_reals("--ray", value, "OX,OY,OZ,DX,DY,DZ", 6, request->ray, input->why) == STATUS_OK ? 0
                                                                                                            : EINVAL;
    case KEY_TEXT: return take_format(request, FORMAT_TEXT, input->why);
    case KEY_JSON: return take_format(request, FORMAT_JSON, input->why);
    case KEY_SVG: return take_format(request, FORMAT_SVG, input->why);
    case ARGP_KEY_ARG: return scene_input_name(&request->input, value, input->why) == STATUS_OK ? 0 : EINVAL;
    default: return ARGP_ERR_UNKNOWN;
    }
}

static const struct argp parser = {
    .options = options,
    .parser = take_option,
    .args_doc = "SCENE (--pixel X,Y | --ray OX,OY,OZ,DX,DY,DZ)",
    .doc = "Take one ray apart: the whole tree of rays that it grows into, with media, angles, reflectances and what "
           "each brings to "
           "the picture. The tree of a pixel has the pixel's radiance, to the bit.\vFor example:\n"
           "  cuvette trace experiments/scenes/rod.yaml --pixel 400,300 --depth 3\n"
           "  cuvette trace experiments/scenes/rod.yaml --ray -3,1.5,0.4,1,0,0 -o ray.svg",
};

static status check_request(trace_request *request, diagnostic *why)
{
    static const char *const endings[] = {".txt", ".json", ".svg"};
    status result = scene_input_check(&request->input, why);
    if (result == STATUS_OK && request->by_pixel == request->by_ray) {
        result = diagnose(why, STATUS_BAD_INPUT, "give --pixel X,Y or --ray OX,OY,OZ,DX,DY,DZ",
                          request->by_ray ? "--pixel and --ray exclude each other" : "no ray is named");
        diagnostic_locate(why, "trace", 0, 0);
    }
    if (result != STATUS_OK || request->format != FORMAT_NONE)
        return result;
    size_t which = FORMAT_TEXT;
    if (request->output && strcmp(request->output, "-") != 0)
        result = outputs_ending("-o", request->output, endings, 3,
                                "end it in .txt, .json or .svg, or give --text, --json or --svg", &which, why);
    request->format = (trace_format)which;
    return result;
}

static status load_scene(const trace_request *request, scene **out, diagnostic *why)
{
    status result = scene_input_read(&request->input, out, why);
    if (result == STATUS_OK && request->output)
        result = outputs_check_place("-o", request->output, *out, why);
    if (result == STATUS_OK)
        result = scene_input_load(*out, why);
    return result;
}

static status grow(const trace_request *request, probe *p, ray_tree *tree, diagnostic *why)
{
    const double *r = request->ray;
    status result = request->by_pixel
                        ? probe_pixel(p, (int)request->pixel[0], (int)request->pixel[1], tree, why)
                        : probe_ray(p, vec3_make(r[0], r[1], r[2]), vec3_make(r[3], r[4], r[5]), tree, why);
    if (result == STATUS_BAD_INPUT)
        diagnostic_locate(why, request->by_pixel ? "--pixel" : "--ray", 0, 0);
    return result;
}

static status write_as(trace_format format, const traced *t, FILE *out, diagnostic *why)
{
    switch (format) {
    case FORMAT_JSON: return trace_write_json(t, out, why);
    case FORMAT_SVG: return trace_write_drawing(t, out, why);
    case FORMAT_TEXT:
    case FORMAT_NONE: break;
    }
    return trace_write_text(t, out, why);
}

static status write_tree(const trace_request *request, const traced *t, diagnostic *why)
{
    if (!request->output || strcmp(request->output, "-") == 0)
        return write_as(request->format, t, stdout, why);
    file_writer writer;
    status result = file_writer_open(&writer, request->output, why);
    if (result != STATUS_OK)
        return result;
    result = write_as(request->format, t, writer.stream, why);
    if (result == STATUS_OK)
        return file_writer_commit(&writer, why);
    file_writer_abandon(&writer);
    return result;
}

status command_trace(int argc, char **argv, diagnostic *why)
{
    trace_request request = {0};
    scene *s = NULL;
    probe *p = NULL;
    ray_tree tree = {0};
    isa level = ISA_SSE2;
    status result = scene_input_prepare(&request.input, "trace", argc, why);
    request.format = FORMAT_NONE;
    if (result == STATUS_OK)
        result = options_parse(&parser, 0, argc, argv, &request, why);
    if (result == STATUS_OK)
        result = check_request(&request, why);
    if (result == STATUS_OK)
        result = scene_input_isa(&level, why);
    if (result == STATUS_OK)
        result = load_scene(&request, &s, why);
    if (result == STATUS_OK)
        result = probe_create(s, level, &p, why);
    if (result == STATUS_OK && request.one_wavelength)
        probe_one_wavelength(p);
    if (result == STATUS_OK)
        result = grow(&request, p, &tree, why);
    if (result == STATUS_OK) {
        const traced t = {s, p, &tree, request.input.path};
        scene_input_note_tree(s);
        result = write_tree(&request, &t, why);
    }
    ray_tree_release(&tree);
    probe_destroy(p);
    scene_destroy(s);
    scene_input_release(&request.input);
    return result;
}
