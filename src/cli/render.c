#include "cli/cli.h"
#include "report/json.h"
#include "cli/options.h"
#include "cli/outputs.h"
#include "report/report.h"
#include "cli/inert_notes.h"
#include "cli/scene_input.h"
#include "cli/terminal.h"
#include "scene/model/scene.h"
#include <errno.h>
#include <stdio.h>

typedef struct render_request {
    scene_input input;
    outputs files;
    bool json, repeated;
    int64_t repeat;
} render_request;

enum { KEY_JSON = 0x100, KEY_BITS, KEY_RAYS, KEY_TIME, KEY_NOISE, KEY_TIMELINE, KEY_LAYERS, KEY_REPEAT };

static const struct argp_option options[] = {
    {"output", 'o', "FILE", 0, "write the picture: .png, .jpg or .pfm (linear floats)", 0},
    {"set", 's', "PATH=VALUE", 0,
     "set a parameter, as 'render.depth=8' or 'lamp.position.x=2'; may be given many times", 0},
    {"json", KEY_JSON, NULL, 0, "print the account as one JSON object: hash, times, counts, parameters", 0},
    {"bits", KEY_BITS, "N", 0, "bits a channel of a PNG: 8 (the default) or 16", 0},
    {"rays", KEY_RAYS, "FILE", 0, "write the rays by pixel: .png with a key, or .pfm", 0},
    {"time", KEY_TIME, "FILE", 0, "write the nanoseconds by pixel: .png with a key, or .pfm", 0},
    {"noise", KEY_NOISE, "FILE", 0, "write the standard error of random paths by pixel: .png with a key, or .pfm", 0},
    {"timeline", KEY_TIMELINE, "FILE", 0,
     "write when each tile was taken by whom: .json, for chrome://tracing or Perfetto", 0},
    {"layers", KEY_LAYERS, "PREFIX", 0, "write each named layer of an integrator that gives them as PREFIX-LAYER.pfm",
     0},
    {"repeat", KEY_REPEAT, "N", 0, "render N times; wall_s and cpu_s are the medians", 0},
    {0},
};

static error_t take_bits(const char *value, render_request *request, diagnostic *why)
{
    int64_t bits;
    if (options_integer("--bits", value, 8, 16, &bits, why) != STATUS_OK)
        return EINVAL;
    if (bits != 8 && bits != 16) {
        diagnose(why, STATUS_BAD_INPUT, "give 8 or 16", "a PNG cannot have %d bits", (int)bits);
        diagnostic_locate(why, "--bits", 0, 0);
        return EINVAL;
    }
    request->files.bits = (int)bits;
    return 0;
}

static error_t take_option(int key, char *value, struct argp_state *state)
{
    options_input *input = state->input;
    render_request *request = input->request;
    switch (key) {
    case 'o': request->files.picture = value; return 0;
    case 's': scene_input_change(&request->input, "--set", NULL, value); return 0;
    case KEY_JSON: request->json = true; return 0;
    case KEY_BITS: return take_bits(value, request, input->why);
    case KEY_RAYS: request->files.rays = value; return 0;
    case KEY_TIME: request->files.time = value; return 0;
    case KEY_NOISE: request->files.noise = value; return 0;
    case KEY_TIMELINE: request->files.timeline = value; return 0;
    case KEY_LAYERS: request->files.layers = value; return 0;
    case KEY_REPEAT:
        request->repeated = true;
        return options_integer("--repeat", value, 1, 1000000, &request->repeat, input->why) == STATUS_OK ? 0 : EINVAL;
    case ARGP_KEY_ARG: return scene_input_name(&request->input, value, input->why) == STATUS_OK ? 0 : EINVAL;
    default: return ARGP_ERR_UNKNOWN;
    }
}

static const struct argp parser = {
    .options = options,
    .parser = take_option,
    .args_doc = "SCENE",
    .doc = "Render the scene file SCENE.\vFor example:\n"
           "  cuvette render experiments/scenes/rod.yaml -o rod.png --set render.depth=4\n"
           "'cuvette params SCENE' lists what --set can reach.",
};

static status check_request(const render_request *request, diagnostic *why)
{
    const outputs *files = &request->files;
    status result = scene_input_check(&request->input, why);
    if (result != STATUS_OK || files->picture || files->rays || files->time || files->noise || files->timeline ||
        files->layers || request->json)
        return result;
    diagnose(why, STATUS_BAD_INPUT, "add -o FILE for the picture or --json for the counts", "nothing is asked for");
    diagnostic_locate(why, "render", 0, 0);
    return STATUS_BAD_INPUT;
}

/* The scene as the command line changes it, its sky loaded, checked. */
static status load_scene(const render_request *request, scene **out, diagnostic *why)
{
    status result = scene_input_read(&request->input, out, why);
    if (result == STATUS_OK)
        result = outputs_check(&request->files, *out, why);
    if (result == STATUS_OK)
        result = scene_input_load(*out, why);
    return result;
}

/* One line for people; programs take --json. */
static void print_summary(const job_account *f, const outputs *files)
{
    const scene *s = f->of;
    const char *const written[] = {files->picture, files->rays, files->time, files->noise, files->timeline};
    uint64_t rays = ray_counters_total(&f->result->counters);
    const double wall_s = job_account_wall_s(f);
    printf("%s%lldx%lld pixels, depth %lld: %llu rays in %.3f s (%.1f million a second), film %016llx",
           f->whole ? "" : "a part of ", (long long)s->render.width, (long long)s->render.height,
           (long long)s->render.depth, (unsigned long long)rays, wall_s, wall_s > 0 ? (double)rays / wall_s / 1e6 : 0.0,
           (unsigned long long)job_account_hash(f));
    if (f->result->variance)
        printf(", noise %.4f rms", render_noise_rms(f->result));
    const char *before = " -> ";
    for (size_t i = 0; i < sizeof written / sizeof written[0]; i++)
        if (written[i]) {
            printf("%s%s", before, written[i]);
            before = ", ";
        }
    if (files->layers)
        printf("%s%s-*.pfm", before, files->layers);
    putchar('\n');
}

static status print_report(const job_account *f, bool repeated, diagnostic *why)
{
    json_t *account = report_create(f, repeated);
    status result = json_write(stdout, account, why);
    json_decref(account);
    return result;
}

static status write_results(const render_request *request, const job_account *f, diagnostic *why)
{
    status result = outputs_write(&request->files, f->result, why);
    if (result != STATUS_OK)
        return result;
    if (request->json)
        return print_report(f, request->repeated, why);
    print_summary(f, &request->files);
    return STATUS_OK;
}

static status say_interrupted(const render_request *request, const job_account *f, diagnostic *why)
{
    if (!f->result)
        return diagnose(why, STATUS_INTERRUPTED, "", "interrupted before the first pixel");
    bool partial = f->count == 0 && request->files.picture;
    diagnose(why, STATUS_INTERRUPTED, "", "interrupted; %s",
             partial ? "the picture holds what was finished" : "what was finished is kept");
    diagnostic_locate(why, request->files.picture, 0, 0);
    return STATUS_INTERRUPTED;
}

static bool show_progress(void *context, double share_done)
{
    progress_draw(context, share_done);
    return true;
}

static status render_and_write(const render_request *request, const scene *s, job *with, diagnostic *why)
{
    const outputs *files = &request->files;
    progress_line line;
    const render_options wanted = {.pixel_rays = files->rays,
                                   .pixel_time = files->time,
                                   .timeline = files->timeline,
                                   .layers = files->layers,
                                   .progress = show_progress,
                                   .context = &line};
    job_account measured;
    progress_start(&line, "rendering");
    status result = job_repeat(with, s, (size_t)request->repeat, &wanted, &measured, why);
    progress_erase(&line);
    if ((result == STATUS_OK || result == STATUS_INTERRUPTED) && measured.result) {
        status written = write_results(request, &measured, why);
        result = written == STATUS_OK ? result : written;
    }
    if (result == STATUS_OK && !request->json)
        inert_note_frame(&request->input, with, &measured);
    if (result == STATUS_INTERRUPTED)
        result = say_interrupted(request, &measured, why);
    job_account_release(&measured);
    return result;
}

status command_render(int argc, char **argv, diagnostic *why)
{
    render_request request = {.repeat = 1};
    scene *s = NULL;
    job *with = NULL;
    status result = scene_input_prepare(&request.input, "render", argc, why);
    if (result == STATUS_OK)
        result = options_parse(&parser, 0, argc, argv, &request, why);
    if (result == STATUS_OK)
        result = check_request(&request, why);
    if (result == STATUS_OK)
        result = scene_input_job(true, &with, why);
    if (result == STATUS_OK)
        result = load_scene(&request, &s, why);
    if (result == STATUS_OK && !request.json) {
        result = scene_input_lint(s, job_isa(with), NULL, why);
        inert_note_changes(s, &request.input);
    }
    if (result == STATUS_OK)
        result = render_and_write(&request, s, with, why);
    job_destroy(with);
    scene_destroy(s);
    scene_input_release(&request.input);
    return result;
}
