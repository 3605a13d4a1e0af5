#include "cli/cli.h"
#include "report/json.h"
#include "cli/options.h"
#include "cli/scene_input.h"
#include "scene/motion/motion.h"
#include "scene/model/params.h"
#include "scene/model/slime.h"
#include "softbody/trials.h"
#include "scene/model/scene.h"
#include <errno.h>
#include <math.h>
#include <stdio.h>

typedef struct motion_request {
    scene_input input;
    bool json, csv;
} motion_request;

enum { KEY_JSON = 0x100, KEY_CSV };

static const struct argp_option options[] = {
    {"set", 's', "PATH=VALUE", 0, "set a parameter, as 'toy.dt_s=0.0005'; may be given many times", 0},
    {"json", KEY_JSON, NULL, 0, "print one JSON object", 0},
    {"csv", KEY_CSV, NULL, 0, "print the table as CSV, with all digits", 0},
    {0},
};

static error_t take_option(int key, char *value, struct argp_state *state)
{
    options_input *input = state->input;
    motion_request *request = input->request;
    switch (key) {
    case 's': scene_input_change(&request->input, "--set", NULL, value); return 0;
    case KEY_JSON: request->json = true; return 0;
    case KEY_CSV: request->csv = true; return 0;
    case ARGP_KEY_ARG: return scene_input_name(&request->input, value, input->why) == STATUS_OK ? 0 : EINVAL;
    default: return ARGP_ERR_UNKNOWN;
    }
}

static const struct argp parser = {
    .options = options,
    .parser = take_option,
    .args_doc = "SCENE",
    .doc = "Measure how each slime of the scene file SCENE moves with its stiffness, its integrator and its step, "
           "beside the closed forms of "
           "mechanics: a spring's swing, a fall, a bounce, what a free body keeps, its volume, the longest stable "
           "step, and how fast it is "
           "computed.\vFor example:\n"
           "  cuvette motion experiments/scenes/slime.yaml\n"
           "  cuvette motion experiments/scenes/slime.yaml --set toy.integrator=verlet --set toy.dt_s=0.0005",
};

static status check_request(const motion_request *request, diagnostic *why)
{
    status result = scene_input_check(&request->input, why);
    if (result != STATUS_OK || !request->json || !request->csv)
        return result;
    diagnose(why, STATUS_BAD_INPUT, "leave one of them out", "JSON and CSV do not go together");
    diagnostic_locate(why, "motion", 0, 0);
    return STATUS_BAD_INPUT;
}

static status check_scene(const motion_request *request, const scene *s, diagnostic *why)
{
    if (scene_moves(s))
        return STATUS_OK;
    diagnostic_locate(why, request->input.path, 0, 0);
    return diagnose(why, STATUS_BAD_INPUT, "give a mesh 'generate: slime'", "nothing moves in this scene");
}

static const char *motion_word(const mesh_entry *m)
{
    return param_find(PARAM_MESH, "integrator")->choices[m->slime.integrator];
}

static void print_number(double value, int digits, int width)
{
    if (isfinite(value))
        printf(" %*.*g", width, digits, value);
    else
        printf(" %*s", width, "-");
}

static void print_text(const mesh_entry *m, const softbody_trial_report *r)
{
    printf("%s: level %lld, %s, steps of %g s\n", m->name, (long long)m->level, motion_word(m), m->slime.dt_s);
    printf("  %-24s %16s %16s %9s  %-12s %s\n", "", "measured", "theory", "error", "unit", "what");
    for (int i = 0; i < SOFTBODY_TRIAL_COUNT; i++) {
        const softbody_trial *v = &r->value[i];
        printf("  %-24s", v->name);
        print_number(v->measured, 10, 16);
        print_number(v->theory, 10, 16);
        print_number(softbody_trial_error(v), 2, 9);
        printf("  %-12s %s\n", v->unit, v->what);
    }
}

static void print_real(double value)
{
    if (isfinite(value))
        printf("%.17g,", value);
    else
        fputs("NA,", stdout);
}

static void print_csv(const mesh_entry *m, const softbody_trial_report *r)
{
    for (int i = 0; i < SOFTBODY_TRIAL_COUNT; i++) {
        const softbody_trial *v = &r->value[i];
        printf("%s,%s,", m->name, v->name);
        print_real(v->measured);
        print_real(v->theory);
        print_real(softbody_trial_error(v));
        printf("%s,\"%s\"\n", v->unit, v->what);
    }
}

static json_t *slime_object(const mesh_entry *m, const softbody_trial_report *r)
{
    json_t *values = json_array();
    int bad = 0;
    for (int i = 0; i < SOFTBODY_TRIAL_COUNT; i++) {
        const softbody_trial *v = &r->value[i];
        json_t *one = json_pack("{s:s,s:o,s:o,s:o,s:s,s:s}", "name", v->name, "measured", json_of_real(v->measured),
                                "theory", json_of_real(v->theory), "error", json_of_real(softbody_trial_error(v)),
                                "unit", v->unit, "what", v->what);
        bad |= json_array_append_new(values, one);
    }
    json_t *o = bad ? NULL
                    : json_pack("{s:s,s:I,s:s,s:o,s:O}", "name", m->name, "level", (json_int_t)m->level, "integrator",
                                motion_word(m), "dt_s", json_of_real(m->slime.dt_s), "values", values);
    json_decref(values);
    return o;
}

static status write_json(const motion_request *request, json_t *slimes, diagnostic *why)
{
    json_t *o = json_pack("{s:i,s:o,s:O}", "schema", 1, "scene", json_of_text(request->input.path), "slimes", slimes);
    const status result = json_write(stdout, o, why);
    json_decref(o);
    return result;
}

static status measure_and_print(const motion_request *request, const scene *s, isa level, diagnostic *why)
{
    json_t *slimes = json_array();
    status result = STATUS_OK;
    if (request->csv)
        puts("slime,name,measured,theory,error,unit,what");
    for (size_t i = 0; result == STATUS_OK && i < s->mesh_count; i++) {
        const mesh_entry *m = &s->meshes[i];
        const softbody_settings settings = slime_settings(m);
        softbody_trial_report report;
        if (m->source != MESH_SLIME || (result = softbody_trials(&settings, level, &report, why)) != STATUS_OK)
            continue;
        if (request->json && json_array_append_new(slimes, slime_object(m, &report)) != 0)
            result = out_of_memory(why);
        else if (request->csv)
            print_csv(m, &report);
        else if (!request->json)
            print_text(m, &report);
    }
    if (result == STATUS_OK && request->json)
        result = write_json(request, slimes, why);
    json_decref(slimes);
    return result;
}

status command_motion(int argc, char **argv, diagnostic *why)
{
    motion_request request = {.json = false};
    scene *s = NULL;
    isa level = ISA_SSE2;
    status result = scene_input_prepare(&request.input, "motion", argc, why);
    if (result == STATUS_OK)
        result = options_parse(&parser, 0, argc, argv, &request, why);
    if (result == STATUS_OK)
        result = check_request(&request, why);
    if (result == STATUS_OK)
        result = scene_input_isa(&level, why);
    if (result == STATUS_OK)
        result = scene_input_read(&request.input, &s, why);
    if (result == STATUS_OK)
        result = check_scene(&request, s, why);
    if (result == STATUS_OK)
        result = measure_and_print(&request, s, level, why);
    scene_destroy(s);
    scene_input_release(&request.input);
    return result;
}
