#include "cli/cli.h"
#include "cli/fan_writers.h"
#include "cli/options.h"
#include "cli/outputs.h"
#include "cli/scene_input.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

typedef struct fan_request {
    scene_input input;
    size_t format; /* index of the ending */
    fan_rule rule;
    int64_t rays;
    bool has_width, whole_trees;
} fan_request;

enum { FAN_SVG, FAN_CSV };

static status take_vector(const command_option *o, void *request, const char *value, diagnostic *why)
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

static status take_size(const command_option *o, void *into, const char *value, diagnostic *why)
{
    fan_request *request = into;
    const bool spreads = strcmp(o->name, "spread") == 0;
    const char *name = spreads ? "--spread" : "--width";
    const status result = options_reals(name, value, spreads ? "degrees" : "scene units", 1,
                                        spreads ? &request->rule.spread_deg : &request->rule.width, why);
    const double size = spreads ? request->rule.spread_deg : request->rule.width, most = spreads ? 179.0 : 1e6;
    if (result != STATUS_OK)
        return result;
    if (request->has_width)
        return options_wrong(name, value, why, "give one of them", "--width and --spread exclude each other");
    if (!(size >= 0.0 && size <= most))
        return options_wrong(name, value, why, spreads ? "give 0 to 179 degrees" : "give 0 to 1e6", "out of range");
    request->has_width = true;
    request->rule.spreads = spreads;
    return STATUS_OK;
}

static const command_option options[] = {
    {"from", 0, "X,Y,Z", "where the middle ray sets out", OPTION_FILLS(take_vector, fan_request, rule.from)},
    {"to", 0, "X,Y,Z", "a point that it goes towards", OPTION_FILLS(take_vector, fan_request, rule.to)},
    {"rays", 0, "N", "how many rays, 21 when not said", OPTION_FILLS(option_integer, fan_request, rays), .lowest = 1,
     .highest = FAN_RAYS_MAX},
    {"width", 0, "W", "a pencil of parallel rays, as wide as this; 1 when neither is said", .take = take_size},
    {"spread", 0, "DEG", "a fan from one point, of this angle", .take = take_size},
    {"plane", 0, "NX,NY,NZ", "the normal of the rays' plane", OPTION_FILLS(take_vector, fan_request, rule.normal)},
    OPTION_DEPTH,
    OPTION_LAMBDA,
    OPTION_SET("'rod.visible=off'"),
    {"tree", 0, NULL, "draw each ray's whole tree, not its refracted way alone",
     OPTION_FILLS(option_flag, fan_request, whole_trees)},
    OPTION_OUTPUT("write there: .svg, a drawing, or .csv, a row a ray"),
    {0},
};

static status check_request(void *asked, diagnostic *why)
{
    static const char *const endings[] = {".svg", ".csv"};
    fan_request *request = asked;
    request->rule.rays = (int)request->rays;
    if (isnan(request->rule.from.x) || isnan(request->rule.to.x))
        return options_wrong("fan", NULL, why, "give --from X,Y,Z and --to X,Y,Z", "the rays have no axis");
    if (!request->input.output)
        return options_wrong("fan", NULL, why, "add -o FILE.svg for the drawing or -o FILE.csv for a row a ray",
                             "nothing is asked for");
    return outputs_ending("-o", request->input.output, endings, 2, "end it in .svg or .csv", &request->format, why);
}

static status write_fan(const void *content, FILE *out, diagnostic *why)
{
    const fanned *t = content;
    return t->as_csv ? fan_write_csv(t, out, why) : fan_write_drawing(t, out, why);
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
    printf(" -> %s\n", request->input.output);
}

static status follow(const fan_request *request, const scene *s, probe *p, diagnostic *why)
{
    fan f = {0};
    status result = fan_follow(p, &request->rule, &f, why);
    if (result == STATUS_BAD_INPUT)
        diagnostic_locate(why, "fan", 0, 0);
    if (result == STATUS_OK) {
        const fanned t = {s, p, &request->rule, &f, request->whole_trees, request->format == FAN_CSV};
        result = outputs_write_text(request->input.output, write_fan, &t, why);
    }
    if (result == STATUS_OK)
        print_summary(request, &f);
    fan_release(&f);
    return result;
}

static status run(void *asked, scene *s, isa level, diagnostic *why)
{
    const fan_request *request = asked;
    probe *p = NULL;
    status result = scene_input_probe(&request->input, s, level, &p, why);
    if (result == STATUS_OK) {
        scene_input_note_tree(s);
        result = follow(request, s, p, why);
    }
    probe_destroy(p);
    return result;
}

static const scene_command fan_command = {
    .name = "fan",
    .form = {.options = options,
             .words = "SCENE --from X,Y,Z --to X,Y,Z -o FILE",
             SCENE_WORD("fan"),
             .about = "Send many rays through the scene side by side, or from one point, in one plane; follow each "
                      "along its refracted way; and find where neighbours cross, the caustic, and the mean focus.\vThe "
                      "plane is level where --from and --to are equally high, else upright. For example:\n"
                      "  cuvette fan experiments/scenes/rod.yaml --from -3,1.5,0 --to 3,1.5,0 --width 1.6 --rays 41 "
                      "--set rod.visible=off -o fan.svg"},
    .check = check_request,
    .run = run,
};

status command_fan(int argc, char **argv, diagnostic *why)
{
    fan_request request = {.rays = 21, .rule = {.from.x = NAN, .to.x = NAN, .width = 1.0}};
    return scene_command_run(&fan_command, argc, argv, &request, why);
}
