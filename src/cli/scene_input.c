/* The scene of a command: --set and its short forms, reading, loading, notes. */
#include "cli/scene_input.h"
#include "base/array.h"
#include "base/budget.h"
#include "cli/outputs.h"
#include "cli/terminal.h"
#include "job/account.h"
#include "lint/lint.h"
#include "scene/model/params.h"
#include "scene/model/scene.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void scene_input_release(scene_input *input)
{
    free(input->changes);
    *input = (scene_input){0};
}

status option_change(const command_option *o, void *request, const char *value, diagnostic *why)
{
    scene_input *input = request;
    if (!room_for_one(&input->changes, input->count, sizeof *input->changes))
        return out_of_memory(why);
    input->changes[input->count++] = (scene_change){o->name, o->parameter, value};
    return STATUS_OK;
}

status option_memory(const command_option *o, void *request, const char *value, diagnostic *why)
{
    uint64_t bytes;
    (void)o, (void)request;
    if (!memory_parse(value, &bytes))
        return options_wrong("--memory-limit", value, why, "give a size such as 500M or 4G", "invalid size");
    memory_budget_set(bytes);
    return STATUS_OK;
}

/* Whether the command has --lambda. */
static bool has_one_wavelength(const scene_input *input)
{
    bool any = false;
    for (size_t i = 0; i < input->count; i++)
        any |= strcmp(input->changes[i].option, "lambda") == 0;
    return any;
}

status scene_input_probe(const scene_input *input, const scene *s, isa level, probe **out, diagnostic *why)
{
    const status result = probe_create(s, level, out, why);
    if (result == STATUS_OK && has_one_wavelength(input))
        probe_use_one_wavelength(*out);
    return result;
}

status scene_command_read(const scene_command *command, int argc, char **argv, void *request, diagnostic *why)
{
    const scene_input *input = request;
    TRY(command_form_read(&command->form, argc, argv, request, why));
    if (!input->path)
        return options_wrong(command->name, NULL, why, "give a scene file, such as experiments/scenes/rod.yaml",
                             "no scene is given");
    return command->check ? command->check(request, why) : STATUS_OK;
}

status scene_command_run(const scene_command *command, int argc, char **argv, void *request, diagnostic *why)
{
    scene *s = NULL;
    isa level = ISA_BASE;
    status result = scene_command_read(command, argc, argv, request, why);
    THEN(result, scene_input_isa(&level, why));
    THEN(result, scene_input_read(request, &s, why));
    const char *output = ((scene_input *)request)->output;
    if (result == STATUS_OK && output)
        result = outputs_check_place("-o", output, s, why);
    if (result == STATUS_OK && command->check_scene)
        result = command->check_scene(request, s, why);
    if (result == STATUS_OK && !command->unloaded)
        result = scene_input_load(s, why);
    THEN(result, command->run(request, s, level, why));
    scene_destroy(s);
    scene_input_release(request);
    return result;
}

status scene_input_read(const scene_input *input, scene **out, diagnostic *why)
{
    status result = scene_read(input->path, out, why);
    for (size_t i = 0; i < input->count && result == STATUS_OK; i++) {
        const scene_change *one = &input->changes[i];
        result = one->path ? scene_set(*out, one->path, one->text, why) : scene_set_assignment(*out, one->text, why);
        if (result != STATUS_OK) {
            char where[512];
            snprintf(where, sizeof where, "--%s %s", one->option, one->text);
            diagnostic_locate(why, where, 0, 0);
        }
    }
    for (size_t i = 0; result == STATUS_OK && input->from_beginning && i < (*out)->mesh_count; i++)
        (*out)->meshes[i].time_s = 0;
    if (result == STATUS_OK && input->count > 0) {
        diagnostic_locate(why, input->path, 0, 0); /* the position of errors without a line */
        result = scene_check(*out, why);
    }
    return result;
}

static void show_motion(void *context, double fraction)
{
    progress_draw(context, fraction);
}

status scene_input_load(scene *s, diagnostic *why)
{
    progress_line line;
    progress_start(&line, "simulating");
    const load_watch watch = {show_motion, &line};
    const status result = scene_load_until(s, &watch, why);
    progress_erase(&line);
    return result;
}

status scene_input_isa(isa *level, diagnostic *why)
{
    return locate_failure(why, "environment", isa_choose(level, why));
}

static const job_distribution *frame_sharing; /* how the program distributes frames; NULL: it does not */

void scene_input_distribute(const job_distribution *sharing)
{
    frame_sharing = sharing;
}

status scene_input_job(bool measured, job **out, diagnostic *why)
{
    isa level = ISA_BASE;
    const job_settings settings = {.level = &level, .measured = measured, .sharing = frame_sharing};
    TRY(scene_input_isa(&level, why));
    return job_create(&settings, out, why);
}

static void print_note(void *context, const scene_note *note)
{
    (void)context;
    char line[NOTE_LINE_MAX];
    terminal_note(note_line(note, line, sizeof line));
}

static const note_sink printer = {print_note, NULL};

void scene_input_note_hints(const scene *s)
{
    scene_hints(s, &printer);
}

status scene_input_lint(const scene *s, isa level, diagnostic *why)
{
    return lint_scene(s, level, &printer, why);
}

void scene_input_note_frame(const job_account *frame)
{
    frame_notes(frame, &printer);
}

void scene_input_note_beams(const scene *s)
{
    scene_beam_range_hints(s, &printer);
}

void scene_input_note_tree(const scene_input *input, const scene *s)
{
    const bool path = integrator_traits_of(&s->render)->by_chance, drawn = integrator_traits_of(&s->render)->drawn,
               layers = integrator_traits_of(&s->render)->layers;
    const bool spectral = s->render.spectrum == SPECTRUM_SPECTRAL;
    scene_lambda_range_hints(s, has_one_wavelength(input), &printer);
    char text[160];
    if (!path && !drawn && !layers && !spectral)
        return;
    snprintf(text, sizeof text,
             "the scene is rendered %s%s%s; this command traces Whitted-style rays at render.lambda_nm = %.6g",
             path     ? "with random paths"
             : drawn  ? "with a depth buffer"
             : layers ? "as one layer of the first hits"
                      : "",
             path && spectral ? " and " : "", spectral ? "spectrally" : "", s->render.lambda_nm);
    terminal_note(text);
}

/* --- notes on parameters that have no effect on the image --- */

enum { PATH_MAX_HERE = 200 };

/* Copies a change's parameter path: `path`, or if it is NULL, `text` up to its '='. False if the path is too long. */
static bool path_of(const char *path, const char *text, char out[PATH_MAX_HERE])
{
    const size_t length = path ? strlen(path) : strcspn(text, "=");
    if (length >= PATH_MAX_HERE)
        return false;
    memcpy(out, path ? path : text, length);
    out[length] = 0;
    return true;
}

typedef struct place_search {
    const char *place;
    bool found;
} place_search;

static void compare_place(void *context, const scene_note *note)
{
    place_search *x = context;
    x->found |= strcmp(x->place, note->place) == 0;
}

static bool is_hinted(const scene *s, const char *path)
{
    place_search x = {path, false};
    scene_hints(s, &(note_sink){compare_place, &x});
    return x.found;
}

static void print_inert_note(const inert_answer *answer)
{
    char line[NOTE_LINE_MAX];
    terminal_note(note_line(&answer->note, line, sizeof line));
}

void scene_input_note_inert_assignment(const scene *s, const char *assignment)
{
    char path[PATH_MAX_HERE];
    inert_answer answer;
    if (path_of(NULL, assignment, path) && param_is_inert(s, path, NULL, &answer))
        print_inert_note(&answer);
}

/* Returns whether a later option sets the same path. */
static bool is_set_again(const scene_input *input, size_t at, const char *path)
{
    char other[PATH_MAX_HERE];
    for (size_t i = at + 1; i < input->count; i++)
        if (path_of(input->changes[i].path, input->changes[i].text, other) && strcmp(path, other) == 0)
            return true;
    return false;
}

/* Copies the scene and sets time_s of its slimes, as an animation does. At time_s = 0, which scene_input_read sets, the
 * parameters of their motion would count as without effect. */
static scene *in_motion(const scene *s)
{
    scene *moved = scene_clone(s);
    for (size_t i = 0; moved && i < moved->mesh_count; i++)
        if (moved->meshes[i].source == MESH_SLIME)
            moved->meshes[i].time_s = 1.0;
    return moved;
}

/* Notes the changes of the command line that have no effect; with a witness (a rendered frame), only those that need
 * the witness. */
static void note_changes(const scene *s, const scene_input *input, const inert_witness *witness)
{
    for (size_t i = 0; i < input->count; i++) {
        char path[PATH_MAX_HERE];
        inert_answer answer;
        if (!path_of(input->changes[i].path, input->changes[i].text, path) || is_set_again(input, i, path))
            continue;
        const bool is_plain = param_is_inert(s, path, NULL, &answer);
        if (witness ? !is_plain && param_is_inert(s, path, witness, &answer) : is_plain && !is_hinted(s, path))
            print_inert_note(&answer);
    }
}

void scene_input_note_inert(const scene *s, const scene_input *input)
{
    scene *moved = input->from_beginning ? in_motion(s) : NULL;
    note_changes(moved ? moved : s, input, NULL);
    scene_destroy(moved);
}

/* --- notes that need a rendered frame --- */

typedef struct witness_frame {
    const job_account *frame;
    job *frame_job;
} witness_frame;

static bool is_same(void *context, const char *assignment)
{
    const double limit_s = 1.0;
    const witness_frame *f = context;
    scene *s = f->frame->result->wall_s < limit_s ? scene_clone(f->frame->of) : NULL;
    job_account other = {.result = NULL};
    const bool rendered = s && scene_set_assignment(s, assignment, NULL) == STATUS_OK &&
                          scene_check(s, NULL) == STATUS_OK && job_load(f->frame_job, s, NULL, NULL) == STATUS_OK &&
                          job_render(f->frame_job, s, NULL, &other, NULL) == STATUS_OK;
    const bool same = rendered && job_account_hash(&other) == job_account_hash(f->frame);
    job_account_release(&other);
    scene_destroy(s);
    return same;
}

void scene_input_note_inert_frame(const scene_input *input, job *frame_job, const job_account *frame)
{
    witness_frame f = {frame, frame_job};
    note_changes(frame->of, input, &(inert_witness){&frame->result->counters, is_same, &f});
}
