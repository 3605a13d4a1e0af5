/* `cuvette study new`: writes a study file for a scene and axes, after reading it as `study run` would. */
#include "base/array.h"
#include "base/file.h"
#include "cli/options.h"
#include "cli/outputs.h"
#include "cli/study.h"
#include "cli/terminal.h"
#include "scene/model/scene.h"
#include "study/plan/new_study.h"
#include "study/study.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

typedef struct new_request {
    const char *scene, *name, *output;
    const char **axes, **sets;
    size_t axis_count, set_count;
    int64_t repetitions, warmups;
    bool force;
} new_request;

static status parse_axis(const command_option *o, void *context, const char *value, diagnostic *why)
{
    new_request *r = context;
    (void)o;
    if (!room_for_one(&r->axes, r->axis_count, sizeof *r->axes))
        return out_of_memory(why);
    r->axes[r->axis_count++] = value;
    return STATUS_OK;
}

static status parse_set(const command_option *o, void *context, const char *value, diagnostic *why)
{
    new_request *r = context;
    (void)o;
    if (!room_for_one(&r->sets, r->set_count, sizeof *r->sets))
        return out_of_memory(why);
    r->sets[r->set_count++] = value;
    return STATUS_OK;
}

static const command_option options[] = {
    {"axis", 'a', "PATH=VALUES", "vary a parameter: PATH=1,2,3 or PATH=FROM..TO:STEPS; may be repeated",
     .store = parse_axis},
    {"set", 's', "PATH=VALUE", "set a parameter in all cells; may be repeated", .store = parse_set},
    {"name", 0, "NAME", "name of the study (default: from -o, or from the scene and the first axis)",
     OPTION_FILLS(option_text, new_request, name)},
    {"repetitions", 0, "N", "measured frames of each cell (default: 6)",
     OPTION_FILLS(option_integer, new_request, repetitions), .lowest = 1, .highest = STUDY_REPETITIONS_MAX},
    {"warmups", 0, "N", "frames of each cell before its first measured one (default: 1)",
     OPTION_FILLS(option_integer, new_request, warmups), .lowest = 0, .highest = STUDY_WARMUPS_MAX},
    {"output", 'o', "FILE", "write to FILE instead of standard output; it must end in .study",
     OPTION_FILLS(option_text, new_request, output)},
    {"force", 0, NULL, "overwrite FILE if it exists", OPTION_FILLS(option_flag, new_request, force)},
    {0},
};

static const command_form form = {
    .options = options,
    .synopsis = "SCENE --axis PATH=VALUES...",
    .arguments_at = offsetof(new_request, scene),
    .argument_limit = 1,
    .excess_remedy = "give one scene; vary parameters with --axis PATH=VALUES",
    .excess = "unexpected argument '%.128s'",
    .about = "Write a commented study file. It is read before it is written, so that 'cuvette study run' accepts it.\v"
             "For example:\n"
             "  cuvette study new rod.yaml --axis render.depth=1,2,4 --axis liquid.ior=1.0..1.6:4 -o depth.study",
};

static bool is_written(const new_request *r)
{
    return r->output && strcmp(r->output, "-") != 0;
}

static status check_request(const new_request *r, diagnostic *why)
{
    static const char *const endings[] = {".study"};
    size_t which;
    if (!r->scene)
        return options_wrong("study new", NULL, why, "give a scene file, such as experiments/scenes/rod.yaml",
                             "no scene is given");
    if (!r->axis_count)
        return options_wrong("study new", NULL, why, "add --axis PATH=1,2,3", "no axis is given");
    if (!is_written(r))
        return STATUS_OK;
    TRY(outputs_ending("-o", r->output, endings, 1, "end it with .study", &which, why));
    TRY(outputs_check_folder("-o", r->output, why));
    if (!r->force && access(r->output, F_OK) == 0)
        return options_wrong("-o", r->output, why, "choose another name, or add --force to overwrite it",
                             "the file already exists");
    return STATUS_OK;
}

static void print_notes(const new_request *r, const study *written)
{
    if (is_written(r)) {
        study_notes_print_file(written);
        return;
    }
    for (size_t i = 0; i < written->note_count; i++) {
        char line[NOTE_LINE_MAX];
        terminal_note(note_line(&written->notes[i].note, line, sizeof line));
    }
}

static status make_study(const new_request *r, scene *s, diagnostic *why)
{
    char *text = NULL;
    study *written = NULL;
    const new_study_order order = {.scene = r->scene,
                                   .target = is_written(r) ? r->output : NULL,
                                   .name = r->name,
                                   .axes = r->axes,
                                   .axis_count = r->axis_count,
                                   .sets = r->sets,
                                   .set_count = r->set_count,
                                   .repetitions = r->repetitions,
                                   .warmups = r->warmups};
    status code = new_study_compose(&order, s, &text, &written, why);
    if (code == STATUS_OK && is_written(r))
        code = outputs_check_place("-o", r->output, s, why);
    if (code == STATUS_OK)
        print_notes(r, written);
    if (code == STATUS_OK && is_written(r))
        code = file_write(r->output, text, why);
    else if (code == STATUS_OK)
        fputs(text, stdout);
    if (code == STATUS_OK && is_written(r))
        printf("%s: %zu cells of %ld repetitions; cuvette study run %s\n", r->output, study_cell_count(written),
               written->repetitions_max, r->output);
    study_destroy(written);
    free(text);
    return code;
}

status study_new(int argc, char **argv, diagnostic *why)
{
    new_request request = {.repetitions = 6, .warmups = 1};
    scene *s = NULL;
    status code = command_form_read(&form, argc, argv, &request, why);
    THEN(code, check_request(&request, why));
    THEN(code, scene_read(request.scene, &s, why));
    THEN(code, make_study(&request, s, why));
    scene_destroy(s);
    free(request.axes);
    free(request.sets);
    return code;
}
