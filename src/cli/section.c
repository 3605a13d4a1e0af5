/* `cuvette section`: writes a plane cut through a scene as a drawing or JSON. */
#include "cli/cli.h"
#include "cli/options.h"
#include "cli/outputs.h"
#include "cli/scene_input.h"
#include "report/trace_writers.h"

#include <stdio.h>

typedef struct section_request {
    scene_input input;
    size_t format; /* SECTION_SVG or SECTION_JSON */
    section_rule rule;
    int64_t cells;
} section_request;

enum { SECTION_SVG, SECTION_JSON };

static status parse_view(const command_option *o, void *context, const char *value, diagnostic *why)
{
    section_request *request = context;
    int which = 0;
    (void)o;
    TRY(options_choice("--view", "view", value, section_view_words, SECTION_VIEW_COUNT, &which, why));
    request->rule.view = (section_view)which;
    return STATUS_OK;
}

static status parse_at(const command_option *o, void *context, const char *value, diagnostic *why)
{
    section_request *request = context;
    double v[3];
    (void)o;
    TRY(options_reals("--at", value, "X,Y,Z", 3, v, why));
    request->rule.at = vec3_make(v[0], v[1], v[2]);
    request->rule.has_at = true;
    return STATUS_OK;
}

static status parse_extent(const command_option *o, void *context, const char *value, diagnostic *why)
{
    section_request *request = context;
    request->rule.has_extent = true;
    return options_reals("--extent", value, o->form, 4, request->rule.extent, why);
}

static const command_option options[] = {
    {"view", 0, "VIEW", "front (default), top or side", .store = parse_view},
    {"at", 0, "X,Y,Z", "a point of the plane (default: the first beam's start)", .store = parse_at},
    {"through", 0, "SOLID", "cut through the axis of a solid instead",
     OPTION_FILLS(option_text, section_request, rule.through)},
    {"extent", 0, "U0,U1,V0,V1", "part of the plane that is shown (default: the solids that it cuts, and the beams)",
     .store = parse_extent},
    {"cells", 0, "N", "cells along the longer side (default: 400)",
     OPTION_FILLS(option_integer, section_request, cells), .lowest = 2, .highest = SECTION_CELLS_MAX},
    OPTION_LAMBDA,
    OPTION_SET("'lens.rotation=0,0,80'"),
    OPTION_MEMORY,
    OPTION_OUTPUT("write a drawing (.svg) or the outlines (.json)"),
    {0},
};

static status check_request(void *context, diagnostic *why)
{
    static const char *const endings[] = {".svg", ".json"};
    section_request *request = context;
    if (request->rule.through && request->rule.has_at)
        return options_wrong("section", NULL, why, "use only one of them", "--at and --through exclude each other");
    if (!request->input.output)
        return options_wrong("section", NULL, why, "add -o FILE.svg for a drawing or -o FILE.json for the outlines",
                             "no output is given");
    return outputs_ending("-o", request->input.output, endings, 2, "use a name that ends in .svg or .json",
                          &request->format, why);
}

static status write_svg(const void *content, FILE *out, diagnostic *why)
{
    return section_write_drawing(content, out, why);
}

static status write_json(const void *content, FILE *out, diagnostic *why)
{
    return section_write_json(content, out, why);
}

static status run(void *context, scene *s, isa level, diagnostic *why)
{
    const section_request *request = context;
    section_output t = {.s = s, .level = level, .scene_path = request->input.path, .cells = (int)request->cells};
    probe *p = NULL;
    status code = section_rule_resolve(&request->rule, s, &t.plane, why);
    if (code == STATUS_BAD_INPUT)
        diagnostic_locate(why, "section", 0, 0);
    THEN(code, scene_input_probe(&request->input, s, level, &p, why));
    t.p = p;
    if (code == STATUS_OK)
        scene_input_note_beams(s);
    THEN(code,
         outputs_write_text(request->input.output, request->format == SECTION_SVG ? write_svg : write_json, &t, why));
    probe_destroy(p);
    return code;
}

static const scene_command section_command = {
    .name = "section",
    .form = {.options = options,
             .synopsis = "SCENE -o FILE",
             SCENE_WORD("section", "-o FILE for an output, "),
             .about = "Cut a plane through the scene and write the outlines of the solids in it, with the rays of the "
                      "scene's beams in a drawing.\vFor example:\n"
                      "  cuvette section experiments/scenes/rod.yaml --view top --at 0,1.5,0 -o rod.svg\n"
                      "  cuvette section lens.yaml --through lens --extent=-2,2,-1,1 -o lens.json"},
    .check = check_request,
    .run = run,
};

status command_section(int argc, char **argv, diagnostic *why)
{
    section_request request = {.cells = SECTION_CELLS_USUAL};
    return scene_command_run(&section_command, argc, argv, &request, why);
}
