/* `cuvette realism`: metrics of a traced scene against closed-form optics, as a table, CSV, JSON or a curve. */
#include "cli/cli.h"
#include "cli/options.h"
#include "cli/scene_input.h"
#include "cli/terminal.h"
#include "report/json.h"
#include "report/param_rows.h"
#include "report/report.h"

#include <stdio.h>
#include <string.h>
#include <unistd.h>

typedef struct realism_request {
    scene_input input;
    bool json, csv;
    int curve; /* realism_curve, or -1 */
} realism_request;

static status parse_curve(const command_option *o, void *context, const char *value, diagnostic *why)
{
    realism_request *request = context;
    const char *names[REALISM_CURVE_COUNT];
    (void)o;
    for (int i = 0; i < REALISM_CURVE_COUNT; i++)
        names[i] = realism_curve_name((realism_curve)i);
    return options_choice("--curve", "curve", value, names, REALISM_CURVE_COUNT, &request->curve, why);
}

static const command_option options[] = {
    OPTION_SET("'liquid.ior=1.47'"),
    OPTION_MEMORY,
    {"json", 0, NULL, "print one JSON object", OPTION_FILLS(option_flag, realism_request, json)},
    OPTION_CSV(realism_request),
    {"curve", 0, "NAME",
     "print one curve (x, measured, theory) as CSV: fresnel-s, fresnel-p, fresnel, deviation, depth, absorption, "
     "edges, mirror, apparent-depth, prism, rainbow, plates, malus, coin, arrow or soap",
     .store = parse_curve},
    {0},
};

static status check_request(void *context, diagnostic *why)
{
    const realism_request *request = context;
    return request->json && (request->csv || request->curve >= 0)
               ? options_wrong("realism", NULL, why, "use only one of them", "--json excludes --csv and --curve")
               : STATUS_OK;
}

/* The cells of a row as text; `unit` and `what` may have any length. */
typedef struct metric_cells {
    const char *verdict, *metric, *measured, *theory, *error, *tolerance, *unit, *what;
} metric_cells;

/* Width of the columns before `what`. On a narrower terminal tolerance and unit are in the last column. */
enum { TABLE_WIDTH = 103, CELLS_MAX = 256 };

static void print_cells(const metric_cells *c, int columns)
{
    char start[CELLS_MAX];
    if (!columns || columns > TABLE_WIDTH) {
        snprintf(start, sizeof start, "%-4s  %-24s %18s %18s %9s %9s  %-12s ", c->verdict, c->metric, c->measured,
                 c->theory, c->error, c->tolerance, c->unit);
        wrap_row(stdout, columns, start, "%s", c->what);
        return;
    }
    snprintf(start, sizeof start, "%-4s  %-24s %18s %18s %9s  ", c->verdict, c->metric, c->measured, c->theory,
             c->error);
    if (c->tolerance[0] == '-')
        wrap_row(stdout, columns, start, "%s", c->what);
    else
        wrap_row(stdout, columns, start, "%s%s%s; %s", c->tolerance, c->unit[0] ? " " : "", c->unit, c->what);
}

static void print_value(const realism_value *v, int columns)
{
    char measured[32] = "-", theory[32] = "-", error[32] = "-", tolerance[32] = "-";
    if (realism_is_defined(v)) {
        snprintf(measured, sizeof measured, "%.12g", v->measured);
        snprintf(theory, sizeof theory, "%.12g", v->theory);
        snprintf(error, sizeof error, "%.1e", realism_error(v));
        snprintf(tolerance, sizeof tolerance, "%.1e", v->tolerance);
    }
    const metric_cells cells = {realism_verdict(v), v->metric, measured, theory, error, tolerance, v->unit, v->what};
    print_cells(&cells, columns);
}

static void print_text(const realism_report *r, int columns)
{
    static const metric_cells titles = {"",      "metric",    "measured", "theory",
                                        "error", "tolerance", "unit",     "description"};
    int defined = 0, passed = 0;
    print_cells(&titles, columns);
    for (int i = 0; i < r->count; i++) {
        defined += realism_is_defined(&r->value[i]);
        passed += realism_passes(&r->value[i]);
        print_value(&r->value[i], columns);
    }
    printf("%d of %d pass", passed, defined);
    if (defined < r->count)
        printf("; %d not defined for this scene", r->count - defined);
    putchar('\n');
}

static status print_curve(const scene *s, isa level, realism_curve which, diagnostic *why)
{
    realism_points points;
    TRY(realism_measure_curve(s, level, which, &points, why));
    realism_write_curve(which, &points, stdout);
    return STATUS_OK;
}

static status run(void *context, scene *s, isa level, diagnostic *why)
{
    const realism_request *request = context;
    if (!request->json && !request->csv && request->curve < 0)
        scene_input_note_hints(s);
    if (request->curve >= 0)
        return print_curve(s, level, (realism_curve)request->curve, why);
    realism_report report;
    TRY(realism_measure(s, level, &report, why));
    if (request->json)
        return json_print(realism_json(&report, request->input.path), why);
    if (request->csv)
        realism_write_csv(&report, stdout);
    else
        print_text(&report, terminal_columns(STDOUT_FILENO));
    return STATUS_OK;
}

static const scene_command realism_command = {
    .name = "realism",
    .form = {.options = options,
             .synopsis = "SCENE",
             SCENE_WORD("realism", ""),
             .about = "Compare the traced optics of the scene file SCENE with closed-form theory. The scene holds a "
                      "vessel (a cup), a liquid in it (a cylinder) and a rod (a box); or a prism, a drop, or two "
                      "plates. The exit status is 0 whether or not the metrics pass. On a terminal the lines "
                      "are wrapped to its width.\vFor example:\n"
                      "  cuvette realism experiments/scenes/rod.yaml\n"
                      "  cuvette realism experiments/scenes/rod.yaml --set render.weights=constant \\\n    --set "
                      "clear.reflectivity=0.1 --set clear.transparency=0.9\n"
                      "  cuvette realism experiments/scenes/prism.yaml"},
    .check = check_request,
    .run = run,
};

status command_realism(int argc, char **argv, diagnostic *why)
{
    realism_request request = {.curve = -1};
    return scene_command_run(&realism_command, argc, argv, &request, why);
}
