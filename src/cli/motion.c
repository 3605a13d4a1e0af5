/* `cuvette motion`: the motion of a scene's slimes against closed-form mechanics, as a table, CSV or JSON. */
#include "scene/motion/motion.h"
#include "base/number.h"
#include "cli/cli.h"
#include "cli/scene_input.h"
#include "cli/terminal.h"
#include "report/json.h"
#include "report/param_rows.h"
#include "report/report.h"
#include "scene/assets/slime.h"
#include "scene/model/scene.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

typedef struct motion_request {
    scene_input input;
    bool json, csv;
} motion_request;

static const command_option options[] = {
    OPTION_SET("'toy.dt_s=0.0005'"),
    OPTION_MEMORY,
    {"json", 0, NULL, "print one JSON object", OPTION_FILLS(option_flag, motion_request, json)},
    OPTION_CSV(motion_request),
    {0},
};

static status check_request(void *context, diagnostic *why)
{
    const motion_request *request = context;
    return request->json && request->csv
               ? options_wrong("motion", NULL, why, "use only one of them", "--json and --csv exclude each other")
               : STATUS_OK;
}

static status check_scene(void *context, const scene *s, diagnostic *why)
{
    const motion_request *request = context;
    return scene_moves(s) ? STATUS_OK
                          : options_wrong(request->input.path, NULL, why, "add a mesh with 'generate: slime'",
                                          "nothing moves in this scene: it has no slime");
}

static const char *number_text(double value, int digits, char text[NUMBER_TEXT_MAX])
{
    if (!isfinite(value))
        return "-";
    snprintf(text, NUMBER_TEXT_MAX, "%.*g", digits, value);
    return text;
}

/* The cells of a row as text; `unit` and `what` may have any length. */
typedef struct trial_cells {
    const char *name, *measured, *theory, *error, *unit, *what;
} trial_cells;

/* Width of the columns before `what`. On a narrower terminal the unit is in the last column. */
enum { TABLE_WIDTH = 88, CELLS_MAX = 256 };

static void print_cells(const trial_cells *c, int columns)
{
    char start[CELLS_MAX];
    const bool wide = !columns || columns > TABLE_WIDTH;
    snprintf(start, sizeof start, "  %-24s %16s %16s %9s  ", c->name, c->measured, c->theory, c->error);
    if (wide)
        snprintf(start + strlen(start), sizeof start - strlen(start), "%-12s ", c->unit);
    if (wide || !c->unit[0])
        wrap_row(stdout, columns, start, "%s", c->what);
    else
        wrap_row(stdout, columns, start, "%s; %s", c->unit, c->what);
}

static void print_text(const mesh_entry *m, const softbody_trial_report *r, int columns)
{
    static const trial_cells titles = {"", "measured", "theory", "error", "unit", "description"};
    char measured[NUMBER_TEXT_MAX], theory[NUMBER_TEXT_MAX], error[NUMBER_TEXT_MAX];
    printf("%s: level %lld, %s, steps of %g s\n", m->name, (long long)m->level, motion_integrator(m), m->slime.dt_s);
    print_cells(&titles, columns);
    for (int i = 0; i < SOFTBODY_TRIAL_COUNT; i++) {
        const softbody_trial *v = &r->value[i];
        const trial_cells cells = {v->name,
                                   number_text(v->measured, 10, measured),
                                   number_text(v->theory, 10, theory),
                                   number_text(softbody_trial_error(v), 2, error),
                                   v->unit,
                                   v->what};
        print_cells(&cells, columns);
    }
}

static status run(void *context, scene *s, isa level, diagnostic *why)
{
    const motion_request *request = context;
    json_t *slimes = json_array();
    status result = STATUS_OK;
    if (request->csv)
        motion_write_csv_header(stdout);
    for (size_t i = 0; result == STATUS_OK && i < s->mesh_count; i++) {
        const mesh_entry *m = &s->meshes[i];
        const softbody_settings settings = slime_settings(m);
        softbody_trial_report report;
        if (m->source != MESH_SLIME || (result = softbody_trials(&settings, level, &report, why)) != STATUS_OK)
            continue;
        if (request->json && json_array_append_new(slimes, motion_slime_json(m, &report)) != 0)
            result = out_of_memory(why);
        else if (request->csv)
            motion_write_csv(m, &report, stdout);
        else if (!request->json)
            print_text(m, &report, terminal_columns(STDOUT_FILENO));
    }
    if (result == STATUS_OK && request->json)
        return json_print(motion_json(slimes, request->input.path), why);
    json_decref(slimes);
    return result;
}

static const scene_command motion_command = {
    .name = "motion",
    .form = {.options = options,
             .synopsis = "SCENE",
             SCENE_WORD("motion", ""),
             .about =
                 "Compare the motion of each slime of the scene file SCENE, with its stiffness, integrator and time "
                 "step, with closed-form mechanics: oscillation of a spring, fall, bounce, quantities that a free "
                 "body conserves, volume, longest stable step; also measure the simulation speed.\vFor example:\n"
                 "  cuvette motion experiments/scenes/slime.yaml\n"
                 "  cuvette motion experiments/scenes/slime.yaml --set toy.integrator=verlet \\\n    --set "
                 "toy.dt_s=0.0005"},
    .check = check_request,
    .check_scene = check_scene,
    .unloaded = true, /* the trials create the slimes that they simulate */
    .run = run,
};

status command_motion(int argc, char **argv, diagnostic *why)
{
    motion_request request = {.json = false};
    return scene_command_run(&motion_command, argc, argv, &request, why);
}
