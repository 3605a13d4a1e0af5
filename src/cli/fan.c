/* `cuvette fan`: traces a fan of rays and writes its caustic and focus as a drawing or CSV. */
#include "cli/cli.h"
#include "cli/options.h"
#include "cli/outputs.h"
#include "cli/scene_input.h"
#include "report/trace_writers.h"
#include "scene/model/lights.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

typedef struct fan_request {
    scene_input input;
    size_t format; /* FAN_SVG or FAN_CSV */
    fan_rule rule;
    int64_t rays, depth; /* depth: -1: render.depth */
    bool has_width, full_trees;
} fan_request;

enum { FAN_SVG, FAN_CSV };

static status parse_vector(const command_option *o, void *request, const char *value, diagnostic *why)
{
    char name[32];
    double v[3];
    snprintf(name, sizeof name, "--%s", o->name);
    const status result = options_reals(name, value, "X,Y,Z", 3, v, why);
    if (result == STATUS_OK)
        *(vec3 *)((char *)request + o->at) = vec3_make(v[0], v[1], v[2]);
    ((fan_request *)request)->rule.has_normal |= strcmp(o->name, "plane") == 0;
    return result;
}

static status parse_size(const command_option *o, void *context, const char *value, diagnostic *why)
{
    fan_request *request = context;
    const bool spreads = strcmp(o->name, "spread") == 0;
    const char *name = spreads ? "--spread" : "--width";
    const status result = options_reals(name, value, spreads ? "degrees" : "scene units", 1,
                                        spreads ? &request->rule.spread_deg : &request->rule.width, why);
    const double size = spreads ? request->rule.spread_deg : request->rule.width, most = spreads ? 179.0 : 1e6;
    if (result != STATUS_OK)
        return result;
    if (request->has_width)
        return options_wrong(name, value, why, "use only one of them", "--width and --spread exclude each other");
    if (!(size >= 0.0 && size <= most))
        return options_wrong(name, value, why, spreads ? "use 0 to 179 degrees" : "use 0 to 1e6", "out of range");
    request->has_width = true;
    request->rule.spreads = spreads;
    return STATUS_OK;
}

static const command_option options[] = {
    {"from", 0, "X,Y,Z", "origin of the central ray", OPTION_FILLS(parse_vector, fan_request, rule.from)},
    {"to", 0, "X,Y,Z", "point on the central ray", OPTION_FILLS(parse_vector, fan_request, rule.to)},
    {"rays", 0, "N", "number of rays (default: 21)", OPTION_FILLS(option_integer, fan_request, rays), .lowest = 1,
     .highest = FAN_RAYS_MAX},
    {"width", 0, "W", "width of a parallel beam (default: 1, without --spread)", .store = parse_size},
    {"spread", 0, "DEG", "full angle of a fan from one point, in degrees", .store = parse_size},
    {"plane", 0, "NX,NY,NZ", "normal of the plane of the rays", OPTION_FILLS(parse_vector, fan_request, rule.normal)},
    {"depth", 0, "N", "number of surfaces at which a ray is followed (default: render.depth)",
     OPTION_FILLS(option_integer, fan_request, depth), .lowest = 0, .highest = BEAM_DEPTH_MAX},
    OPTION_LAMBDA,
    OPTION_SET("'rod.visible=off'"),
    OPTION_MEMORY,
    {"tree", 0, NULL, "draw the whole ray tree of each ray, not only its refracted path",
     OPTION_FILLS(option_flag, fan_request, full_trees)},
    OPTION_OUTPUT("write a drawing (.svg) or one row per ray (.csv)"),
    {0},
};

static status check_request(void *context, diagnostic *why)
{
    static const char *const endings[] = {".svg", ".csv"};
    fan_request *request = context;
    request->rule.rays = (int)request->rays;
    if (request->full_trees && request->depth > DEPTH_TREE_MAX)
        return options_wrong("--depth", NULL, why, "use 0 to 64, or omit --tree", "trees of rays end at depth %d",
                             (int)DEPTH_TREE_MAX);
    if (isnan(request->rule.from.x) || isnan(request->rule.to.x))
        return options_wrong("fan", NULL, why, "add --from X,Y,Z and --to X,Y,Z", "the axis of the fan is not given");
    if (!request->input.output)
        return options_wrong("fan", NULL, why, "add -o FILE.svg for a drawing or -o FILE.csv for one row per ray",
                             "no output is given");
    return outputs_ending("-o", request->input.output, endings, 2, "use a name that ends in .svg or .csv",
                          &request->format, why);
}

static status write_fan(const void *content, FILE *out, diagnostic *why)
{
    const fan_output *t = content;
    return t->as_csv ? fan_write_csv(t, out, why) : fan_write_drawing(t, out, why);
}

/* Prints the summary, one line. */
static void print_summary(const fan_request *request, const fan *f)
{
    int left = 0;
    for (int i = 0; i < f->count; i++)
        left += f->ray[i].leaves;
    printf("%d rays, %d followed to the end, %d crossings of adjacent rays", f->count, left, f->crossing_count);
    if (f->has_focus)
        printf(", %s %.6g,%.6g,%.6g (rms distance %.3g)", f->is_virtual ? "virtual mean focus" : "mean focus",
               fan_shown(f->focus.x), fan_shown(f->focus.y), fan_shown(f->focus.z), f->focus_rms);
    printf(" -> %s\n", request->input.output);
}

static status trace_fan(const fan_request *request, const scene *s, probe *p, diagnostic *why)
{
    fan f = {0};
    status result = fan_trace(p, &request->rule, &f, why);
    if (result == STATUS_BAD_INPUT)
        diagnostic_locate(why, "fan", 0, 0);
    if (result == STATUS_OK) {
        const fan_output t = {s, p, &request->rule, &f, request->full_trees, request->format == FAN_CSV};
        result = outputs_write_text(request->input.output, write_fan, &t, why);
    }
    if (result == STATUS_OK)
        print_summary(request, &f);
    fan_release(&f);
    return result;
}

static status run(void *context, scene *s, isa level, diagnostic *why)
{
    const fan_request *request = context;
    probe *p = NULL;
    status result = scene_input_probe(&request->input, s, level, &p, why);
    if (result == STATUS_OK) {
        scene_input_note_tree(&request->input, s);
        if (request->depth >= 0)
            probe_limit_depth(p, (int)request->depth, "lower --depth, or raise render.min_weight");
        result = trace_fan(request, s, p, why);
    }
    probe_destroy(p);
    return result;
}

static const scene_command fan_command = {
    .name = "fan",
    .form = {.options = options,
             .synopsis = "SCENE --from X,Y,Z --to X,Y,Z -o FILE",
             SCENE_WORD("fan", "-o FILE for an output, "),
             .about =
                 "Trace a fan of rays in one plane, parallel or from one point, along their refracted paths; find "
                 "the crossings of adjacent rays (the caustic) and the mean focus.\vWithout --plane, the plane is "
                 "horizontal if --from and --to have the same height, otherwise vertical. For example:\n"
                 "  cuvette fan experiments/scenes/rod.yaml --from -3,1.5,0 --to 3,1.5,0 \\\n    --width 1.6 --rays 41 "
                 "--set rod.visible=off -o fan.svg"},
    .check = check_request,
    .run = run,
};

status command_fan(int argc, char **argv, diagnostic *why)
{
    fan_request request = {.rays = 21, .depth = -1, .rule = {.from.x = NAN, .to.x = NAN, .width = 1.0}};
    return scene_command_run(&fan_command, argc, argv, &request, why);
}
