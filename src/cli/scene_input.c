#include "cli/scene_input.h"
#include "cli/terminal.h"
#include "scene/model/hints.h"
#include "scene/model/params.h"
#include "scene/model/scene.h"
#include <stdio.h>
#include <stdlib.h>

status scene_input_prepare(scene_input *input, const char *command, int argc, diagnostic *why)
{
    *input = (scene_input){.command = command, .changes = calloc((size_t)argc + 1, sizeof *input->changes)};
    return input->changes ? STATUS_OK : out_of_memory(why);
}

void scene_input_release(scene_input *input)
{
    free(input->changes);
    *input = (scene_input){0};
}

status scene_input_name(scene_input *input, const char *argument, diagnostic *why)
{
    if (!input->path) {
        input->path = argument;
        return STATUS_OK;
    }
    char remedy[128];
    snprintf(remedy, sizeof remedy, "%s takes one scene; a parameter is set by --set PATH=VALUE", input->command);
    diagnose(why, STATUS_BAD_INPUT, remedy, "'%.128s' is one too many", argument);
    diagnostic_locate(why, input->command, 0, 0);
    return STATUS_BAD_INPUT;
}

void scene_input_change(scene_input *input, const char *option, const char *path, const char *text)
{
    input->changes[input->count++] = (scene_change){option, path, text};
}

status scene_input_check(const scene_input *input, diagnostic *why)
{
    if (input->path)
        return STATUS_OK;
    diagnose(why, STATUS_BAD_INPUT, "name a scene file, as experiments/scenes/rod.yaml", "no scene is named");
    diagnostic_locate(why, input->command, 0, 0);
    return STATUS_BAD_INPUT;
}

status scene_input_read(const scene_input *input, scene **out, diagnostic *why)
{
    status result = scene_read(input->path, out, why);
    for (size_t i = 0; i < input->count && result == STATUS_OK; i++) {
        const scene_change *one = &input->changes[i];
        result = one->path ? scene_set(*out, one->path, one->text, why) : scene_set_assignment(*out, one->text, why);
        if (result != STATUS_OK) {
            char where[512];
            snprintf(where, sizeof where, "%s %s", one->option, one->text);
            diagnostic_locate(why, where, 0, 0);
        }
    }
    for (size_t i = 0; result == STATUS_OK && input->from_beginning && i < (*out)->mesh_count; i++)
        (*out)->meshes[i].time_s = 0;
    if (result == STATUS_OK) {
        diagnostic_locate(why, input->path, 0, 0); /* for checks that have no line to name */
        result = scene_check(*out, why);
    }
    return result;
}

static bool show_motion(void *context, double share_done)
{
    progress_draw(context, share_done);
    return !terminal_stop_asked(NULL);
}

status scene_input_load(scene *s, diagnostic *why)
{
    progress_line line;
    progress_start(&line, "moving");
    const load_watch watch = {show_motion, &line};
    const status result = scene_load_until(s, &watch, why);
    progress_erase(&line);
    return result;
}

status scene_input_isa(isa *level, diagnostic *why)
{
    status result = isa_choose(level, why);
    if (result != STATUS_OK)
        diagnostic_locate(why, "environment", 0, 0);
    return result;
}

status scene_input_job(bool measured, job **out, diagnostic *why)
{
    isa level = ISA_SSE2;
    const job_settings settings = {.level = &level, .measured = measured, .stop = terminal_stop_asked};
    const status result = scene_input_isa(&level, why);
    return result == STATUS_OK ? job_create(&settings, out, why) : result;
}

static void print_note(void *context, const scene_note *note)
{
    (void)context;
    char line[NOTE_LINE_MAX];
    terminal_note(note_line(note, line, sizeof line));
}

static const note_taker printer = {print_note, NULL};

void scene_input_note_hints(const scene *s)
{
    scene_hints(s, &printer);
}

status scene_input_lint(const scene *s, isa level, const lint_filter *varies, diagnostic *why)
{
    return lint_scene_but(s, level, varies, &printer, why);
}

void scene_input_note_tree(const scene *s)
{
    const bool path = integrator_of(&s->render)->by_chance, drawn = integrator_of(&s->render)->drawn,
               layers = integrator_of(&s->render)->layers;
    const bool spectral = s->render.spectrum == SPECTRUM_SPECTRAL;
    scene one_lambda = *s; /* borrows what s owns */
    one_lambda.render.spectrum = SPECTRUM_RGB;
    scene_range_hints(&one_lambda, &printer);
    char text[160];
    if (!path && !drawn && !layers && !spectral)
        return;
    snprintf(text, sizeof text,
             "the scene's picture is %s%s%s; rays are here traced as Whitted did, at render.lambda_nm = %.6g",
             path     ? "made of random paths"
             : drawn  ? "drawn into a depth buffer"
             : layers ? "a layer of what camera rays meet first"
                      : "",
             path && spectral ? " and " : "", spectral ? "spectral" : "", s->render.lambda_nm);
    terminal_note(text);
}
