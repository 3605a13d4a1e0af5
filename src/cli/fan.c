#include "cli/cli.h"
#include "cli/fan_writers.h"
#include "cli/options.h"
#include "cli/outputs.h"
#include "cli/scene_input.h"
#include "base/file.h"
#include <errno.h>
#include <stdio.h>

typedef struct fan_request {
    scene_input input;
    const char *output;
    size_t format; /* index of the ending */
    fan_rule rule;
    bool has_from, has_to, has_width, whole_trees, one_wavelength;
} fan_request;

enum { KEY_FROM = 0x100, KEY_TO, KEY_RAYS, KEY_WIDTH, KEY_SPREAD, KEY_PLANE, KEY_DEPTH, KEY_LAMBDA, KEY_TREE };
enum { FAN_SVG, FAN_CSV };

static const struct argp_option options[] = {
    {"from", KEY_FROM, "X,Y,Z", 0, "where the middle ray sets out", 0},
    {"to", KEY_TO, "X,Y,Z", 0, "a point that it goes towards", 0},
    {"rays", KEY_RAYS, "N", 0, "how many rays, 21 when not said", 0},
    {"width", KEY_WIDTH, "W", 0, "a pencil of parallel rays, as wide as this; 1 when neither is said", 0},
    {"spread", KEY_SPREAD, "DEG", 0, "a fan from one point, of this angle", 0},
    {"plane", KEY_PLANE, "NX,NY,NZ", 0, "the normal of the rays' plane", 0},
    {"depth", KEY_DEPTH, "N", 0, "the same as --set render.depth=N", 0},
    {"lambda", KEY_LAMBDA, "NM", 0,
     "one wavelength for indices and for absorption by wavelength; sets render.lambda_nm", 0},
    {"set", 's', "PATH=VALUE", 0, "set a parameter, as 'rod.visible=off'; may be given many times", 0},
    {"tree", KEY_TREE, NULL, 0, "draw each ray's whole tree, not its refracted way alone", 0},
    {"output", 'o', "FILE", 0, "write there: .svg, a drawing, or .csv, a row a ray", 0},
    {0},
};

static error_t take_vector(const char *option, const char *value, vec3 *out, diagnostic *why)
{
    double v[3];
    if (options_reals(option, value, "X,Y,Z", 3, v, why) != STATUS_OK)
        return EINVAL;
    *out = vec3_make(v[0], v[1], v[2]);
    return 0;
}

static error_t take_size(fan_request *request, bool spreads, const char *value, diagnostic *why)
{
    const char *option = spreads ? "--spread" : "--width";
    double size, most = spreads ? 179.0 : 1e6;
    if (options_reals(option, value, spreads ? "degrees" : "scene units", 1, &size, why) != STATUS_OK)
        return EINVAL;
    if (request->has_width || !(size >= 0.0 && size <= most)) {
        char where[512];
        snprintf(where, sizeof where, "%s %s", option, value);
        diagnose(why, STATUS_BAD_INPUT,
                 request->has_width ? "give one of them"
                 : spreads          ? "give 0 to 179 degrees"
                                    : "give 0 to 1e6",
                 request->has_width ? "--width and --spread exclude each other" : "out of range");
        diagnostic_locate(why, where, 0, 0);
        return EINVAL;
    }
    request->has_width = true;
    request->rule.spreads = spreads;
    *(spreads ? &request->rule.spread_deg : &request->rule.width) = size;
    return 0;
}

static error_t take_rays(fan_request *request, const char *value, diagnostic *why)
{
    int64_t rays;
    if (options_integer("--rays", value, 1, FAN_RAYS_MAX, &rays, why) != STATUS_OK)
        return EINVAL;
    request->rule.rays = (int)rays;
    return 0;
}

static error_t take_option(int key, char *value, struct argp_state *state)
{
    options_input *input = state->input;
    fan_request *request = input->request;
    switch (key) {
    case 's': scene_input_change(&request->input, "--set", NULL, value); return 0;
    case 'o': request->output = value; return 0;
    case KEY_DEPTH: scene_input_change(&request->input, "--depth", "render.depth", value); return 0;
    case KEY_LAMBDA:
        request->one_wavelength = true;
        scene_input_change(&request->input, "--lambda", "render.lambda_nm", value);
        return 0;
    case KEY_FROM: request->has_from = true; return take_vector("--from", value, &request->rule.from, input->why);
    case KEY_TO: request->has_to = true; return take_vector("--to", value, &request->rule.to, input->why);
    case KEY_PLANE:
        request->rule.has_normal = true;
        return take_vector("--plane", value, &request->rule.normal, input->why);
    case KEY_RAYS: return take_rays(request, value, input->why);
    case KEY_WIDTH: return take_size(request, false, value, input->why);
    case KEY_SPREAD: return take_size(request, true, value, input->why);
    case KEY_TREE: request->whole_trees = true; return 0;
    case ARGP_KEY_ARG: return scene_input_name(&request->input, value, input->why) == STATUS_OK ? 0 : EINVAL;
    default: return ARGP_ERR_UNKNOWN;
    }
}

static const struct argp parser = {
    .options = options,
    .parser = take_option,
    .args_doc = "SCENE --from X,Y,Z --to X,Y,Z -o FILE",
    .doc = "Send many rays through the scene side by side, or from one point, in one plane; follow each along its "
           "refracted way; and "
           "find where neighbours cross, the caustic, and the mean focus.\vThe plane is level where --from and --to "
           "are equally "
           "high, else upright. For example:\n"
           "  cuvette fan experiments/scenes/rod.yaml --from -3,1.5,0 --to 3,1.5,0 --width 1.6 --rays 41 --set "
           "rod.visible=off -o fan.svg",
};

static status check_request(fan_request *request, diagnostic *why)
{
    static const char *const endings[] = {".svg", ".csv"};
    const char *what = NULL, *remedy = NULL;
    status result = scene_input_check(&request->input, why);
    if (result != STATUS_OK)
        return result;
    if (!request->has_from || !request->has_to)
        what = "the rays have no axis", remedy = "give --from X,Y,Z and --to X,Y,Z";
    else if (!request->output)
        what = "nothing is asked for", remedy = "add -o FILE.svg for the drawing or -o FILE.csv for a row a ray";
    if (what) {
        diagnose(why, STATUS_BAD_INPUT, remedy, "%s", what);
        diagnostic_locate(why, "fan", 0, 0);
        return STATUS_BAD_INPUT;
    }
    return outputs_ending("-o", request->output, endings, 2, "end it in .svg or .csv", &request->format, why);
}

static status load_scene(const fan_request *request, scene **out, diagnostic *why)
{
    status result = scene_input_read(&request->input, out, why);
    if (result == STATUS_OK)
        result = outputs_check_place("-o", request->output, *out, why);
    if (result == STATUS_OK)
        result = scene_input_load(*out, why);
    return result;
}

static status write_fan(const fan_request *request, const fanned *t, diagnostic *why)
{
    file_writer writer;
    status result = file_writer_open(&writer, request->output, why);
    if (result != STATUS_OK)
        return result;
    result =
        request->format == FAN_CSV ? fan_write_csv(t, writer.stream, why) : fan_write_drawing(t, writer.stream, why);
    if (result == STATUS_OK)
        return file_writer_commit(&writer, why);
    file_writer_abandon(&writer);
    return result;
}

/* One line for people. */
static void print_summary(const fan_request *request, const fan *f)
{
    int left = 0;
    for (int i = 0; i < f->count; i++)
        left += f->ray[i].leaves;
    printf("%d rays, %d followed to their end, %d crossings of neighbours", f->count, left, f->crossing_count);
    if (f->has_focus)
        printf(", %s %.6g,%.6g,%.6g (rms distance %.3g)", f->is_virtual ? "virtual mean focus" : "mean focus",
               fan_shown(f->focus.x), fan_shown(f->focus.y), fan_shown(f->focus.z), f->focus_rms);
    printf(" -> %s\n", request->output);
}

static status run(const fan_request *request, const scene *s, probe *p, diagnostic *why)
{
    fan f = {0};
    status result = fan_follow(p, &request->rule, &f, why);
    if (result == STATUS_BAD_INPUT)
        diagnostic_locate(why, "fan", 0, 0);
    if (result == STATUS_OK) {
        const fanned t = {s, p, &request->rule, &f, request->whole_trees};
        result = write_fan(request, &t, why);
    }
    if (result == STATUS_OK)
        print_summary(request, &f);
    fan_release(&f);
    return result;
}

status command_fan(int argc, char **argv, diagnostic *why)
{
    fan_request request = {0};
    scene *s = NULL;
    probe *p = NULL;
    isa level = ISA_SSE2;
    status result = scene_input_prepare(&request.input, "fan", argc, why);
    request.rule = (fan_rule){.rays = 21, .width = 1.0};
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
    if (result == STATUS_OK) {
        scene_input_note_tree(s);
        result = run(&request, s, p, why);
    }
    probe_destroy(p);
    scene_destroy(s);
    scene_input_release(&request.input);
    return result;
}
