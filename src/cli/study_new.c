/* `cuvette study new`: writes a study file for a scene and axes, after reading it as `study run` would. */
#include "cli/study_new.h"
#include "base/file.h"
#include "base/grow.h"
#include "base/text_writer.h"
#include "cli/options.h"
#include "cli/outputs.h"
#include "cli/study_commands.h"
#include "cli/study_notes.h"
#include "cli/terminal.h"
#include "scene/file/write_parts.h"
#include "scene/model/params.h"
#include "scene/model/scene.h"
#include "study/study.h"
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { NAME_LENGTH = 64 };

typedef struct new_request {
    const char *scene, *name, *output;
    const char **axes, **sets;
    size_t axis_count, set_count;
    int64_t repetitions;
    bool force;
} new_request;

static status take_axis(const command_option *o, void *context, const char *value, diagnostic *why)
{
    new_request *r = context;
    (void)o;
    if (!room_for_one(&r->axes, r->axis_count, sizeof *r->axes))
        return out_of_memory(why);
    r->axes[r->axis_count++] = value;
    return STATUS_OK;
}

static status take_set(const command_option *o, void *context, const char *value, diagnostic *why)
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
     .take = take_axis},
    {"set", 's', "PATH=VALUE", "set a parameter in all cells; may be repeated", .take = take_set},
    {"name", 0, "NAME", "name of the study (default: from -o, or from the scene and the first axis)",
     OPTION_FILLS(option_text, new_request, name)},
    {"repetitions", 0, "N", "measured frames of each cell (default: 6)",
     OPTION_FILLS(option_integer, new_request, repetitions), .lowest = 1, .highest = STUDY_REPETITIONS_MAX},
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

/* Applies one setting, or each value of one axis, so that an error is located at its option. */
static status try_settings(const new_request *r, scene *s, const new_axis *axes, diagnostic *why)
{
    char where[512];
    for (size_t i = 0; i < r->set_count; i++) {
        const status code = scene_set_assignment(s, r->sets[i], why);
        snprintf(where, sizeof where, "--set %.400s", r->sets[i]);
        if (code != STATUS_OK) {
            diagnostic_locate(why, where, 0, 0);
            return code;
        }
    }
    scene *on = scene_clone(s);
    status code = on ? STATUS_OK : out_of_memory(why);
    for (size_t a = 0; a < r->axis_count && code == STATUS_OK; a++)
        for (size_t i = 0; i < axes[a].count - (axes[a].range ? 1 : 0) && code == STATUS_OK; i++) {
            code = scene_set(on, axes[a].path, axes[a].values[i], why);
            snprintf(where, sizeof where, "--axis %.400s", r->axes[a]);
            if (code != STATUS_OK)
                diagnostic_locate(why, where, 0, 0);
        }
    scene_destroy(on);
    return code;
}

/* The name of the file without its ending; or the names of scene and parameter, "rod-depth". */
static void choose_name(const new_request *r, const new_axis *first, char name[NAME_LENGTH + 1])
{
    const char *file = file_name_of(is_written(r) ? r->output : r->scene);
    const char *ending = strrchr(file, '.'), *parameter = strrchr(first->path, '.');
    const int length = ending ? (int)(ending - file) : (int)strlen(file);
    if (r->name)
        snprintf(name, NAME_LENGTH + 1, "%s", r->name);
    else if (is_written(r))
        snprintf(name, NAME_LENGTH + 1, "%.*s", length, file);
    else
        snprintf(name, NAME_LENGTH + 1, "%.*s-%s", length, file, parameter ? parameter + 1 : first->path);
    for (char *c = name; !r->name && *c; c++)
        if (!strchr("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_", *c))
            *c = '-';
}

/* Locates an error in a file that was not written at the option that made its line. */
static void relocate(const new_request *r, const char *text, diagnostic *why)
{
    char where[512] = "study new";
    size_t axes = 0;
    for (long line = 1; line <= why->line && *text; line++) {
        axes += strncmp(text, "  - {", 5) == 0;
        if (line == why->line && strncmp(text, "study: ", 7) == 0)
            snprintf(where, sizeof where, "--name %.400s", r->name ? r->name : "");
        text += strcspn(text, "\n");
        text += *text == '\n';
    }
    if (axes > 0 && axes <= r->axis_count)
        snprintf(where, sizeof where, "--axis %.400s", r->axes[axes - 1]);
    diagnostic_locate(why, where, 0, 0);
}

static status validate(const new_request *r, const char *file, const char *text, study **out, diagnostic *why)
{
    const status code = study_read_text(file, text, strlen(text), out, why);
    if (code == STATUS_BAD_INPUT && why->line > 0)
        relocate(r, text, why);
    if (code == STATUS_OK && is_written(r))
        study_notes_print_file(*out);
    for (size_t i = 0; code == STATUS_OK && !is_written(r) && i < (*out)->note_count; i++) {
        char line[NOTE_LINE_MAX];
        terminal_note(note_line(&(*out)->notes[i].note, line, sizeof line));
    }
    return code;
}

static status write_study(const new_request *r, const new_study *made, const char *file, diagnostic *why)
{
    char *text = NULL;
    study *read = NULL;
    text_writer writer;
    TRY(text_writer_open(&writer, why));
    new_study_write(made, writer.stream);
    status code = text_writer_close(&writer, &text, NULL, why);
    THEN(code, validate(r, file, text, &read, why));
    if (code == STATUS_OK && is_written(r))
        code = file_write(r->output, text, why);
    else if (code == STATUS_OK)
        fputs(text, stdout);
    if (code == STATUS_OK && is_written(r))
        printf("%s: %zu cells of %ld repetitions; cuvette study run %s\n", r->output, study_cell_count(read),
               read->repetitions_max, r->output);
    study_destroy(read);
    free(text);
    return code;
}

static status make_study(const new_request *r, scene *s, new_axis *axes, diagnostic *why)
{
    char where[512], name[NAME_LENGTH + 1], file[NAME_LENGTH + 16], *path = NULL;
    for (size_t i = 0; i < r->axis_count; i++) {
        const status code = new_axis_parse(r->axes[i], &axes[i], why);
        snprintf(where, sizeof where, "--axis %.400s", r->axes[i]);
        if (code != STATUS_OK) {
            diagnostic_locate(why, where, 0, 0);
            return code;
        }
    }
    TRY(try_settings(r, s, axes, why));
    choose_name(r, &axes[0], name);
    snprintf(file, sizeof file, "%s.study", name);
    const char *target = is_written(r) ? r->output : file;
    if (is_written(r))
        TRY(outputs_check_place("-o", target, s, why));
    const char *slash = strrchr(r->scene, '/');
    TRY(write_moved_path(slash ? slash + 1 : r->scene, r->scene, target, &path, why));
    const new_study made = {.name = name,
                            .scene_path = path,
                            .of = s,
                            .sets = r->sets,
                            .set_count = r->set_count,
                            .axes = axes,
                            .axis_count = r->axis_count,
                            .repetitions = r->repetitions};
    const status code = write_study(r, &made, target, why);
    free(path);
    return code;
}

status study_new(int argc, char **argv, diagnostic *why)
{
    new_request request = {.repetitions = 6};
    scene *s = NULL;
    status code = command_form_read(&form, argc, argv, &request, why);
    THEN(code, check_request(&request, why));
    THEN(code, scene_read(request.scene, &s, why));
    new_axis *axes = calloc(request.axis_count + 1, sizeof *axes);
    if (!axes)
        code = out_of_memory(why);
    THEN(code, make_study(&request, s, axes, why));
    for (size_t i = 0; axes && i < request.axis_count; i++)
        new_axis_release(&axes[i]);
    free(axes);
    scene_destroy(s);
    free(request.axes);
    free(request.sets);
    return code;
}
