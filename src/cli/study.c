/* `cuvette study`: runs, lists, merges and summarises studies. */
#include "base/text_writer.h"
#include "cli/cli.h"
#include "cli/inert_notes.h"
#include "cli/options.h"
#include "cli/scene_input.h"
#include "cli/study_request.h"
#include "cli/terminal.h"
#include "study/spread.h"
#include "study/study.h"
#include "study/summary.h"
#include "scene/model/scene.h"
#include <dirent.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* The action of a subcommand on each given study. */
typedef status study_action(const study *s, const study_request *request, diagnostic *why);

/* Reads all files before acting on the first, so that an error in the last one is reported at once. */
static status read_and_act(const study_request *request, study_action *act, diagnostic *why)
{
    study **studies = calloc(request->file_count + 1, sizeof *studies);
    if (!studies)
        return out_of_memory(why);
    status result = STATUS_OK;
    for (size_t i = 0; i < request->file_count && result == STATUS_OK; i++)
        result = study_read(request->files[i], &studies[i], why);
    for (size_t i = 0; i < request->file_count && result == STATUS_OK; i++)
        result = act(studies[i], request, why);
    for (size_t i = 0; i < request->file_count; i++)
        study_destroy(studies[i]);
    free(studies);
    return result;
}

static status for_each_study(study_verb verb, study_action *act, int argc, char **argv, diagnostic *why)
{
    study_request request;
    status result = study_request_parse(verb, argc, argv, &request, why);
    THEN(result, read_and_act(&request, act, why));
    study_request_release(&request);
    return result;
}

/* Returns whether path equals place or is an element of it ("lamp.position.x" of "lamp.position"). */
static bool is_part(const char *place, const char *path)
{
    const size_t length = strlen(place);
    return strncmp(place, path, length) == 0 && (path[length] == '\0' || path[length] == '.');
}

/* Returns whether place is a solid's parameter and path the same parameter of its material. */
static bool is_of_material(const scene *s, const char *place, const char *path)
{
    const char *dot = strchr(place, '.');
    char name[SCENE_NAME_MAX + 1], whole[NOTE_PLACE_MAX];
    if (!dot || (size_t)(dot - place) >= sizeof name)
        return false;
    snprintf(name, sizeof name, "%.*s", (int)(dot - place), place);
    const int solid_index = scene_find_solid(s, name);
    if (solid_index < 0 || s->solids[solid_index].material_index < 0)
        return false;
    snprintf(whole, sizeof whole, "%s%s", s->materials[s->solids[solid_index].material_index].name, dot);
    return is_part(whole, path);
}

static bool varies(void *context, const char *place)
{
    const study *s = context;
    for (size_t a = 0; a < s->axis_count; a++)
        for (size_t i = 0; i < s->axes[a].points[0].count; i++) {
            const char *path = s->axes[a].points[0].paths[i];
            if (is_part(place, path) || is_part(path, place) || is_of_material(s->base, place, path))
                return true;
        }
    return false;
}

/* Prints notes on the scene with the fixed parameters before anything is measured. Slimes are not simulated for
 * this. */
static status lint(const study *s, const study_request *request, diagnostic *why)
{
    study_progress progress;
    isa level = ISA_SSE2;
    status result = study_status(s, request->results, &progress, why);
    if (result != STATUS_OK || progress.cells_done == progress.cells)
        return result;
    result = scene_input_isa(&level, why);
    scene *base = scene_clone(s->base);
    if (result == STATUS_OK && !base)
        result = out_of_memory(why);
    bool moves = false;
    for (size_t i = 0; result == STATUS_OK && i < base->mesh_count; i++)
        moves |= base->meshes[i].source == MESH_SLIME;
    THEN(result, moves ? scene_load_files(base, why) : scene_load(base, why));
    if (result == STATUS_OK)
        result = scene_input_lint(base, level, &(lint_filter){varies, (void *)(uintptr_t)s}, why);
    THEN(result, inert_note_study(s, why));
    scene_destroy(base);
    return result;
}

static status run_one(const study *s, const study_request *request, diagnostic *why)
{
    FILE *terminal = !request->quiet && terminal_is_smart(STDERR_FILENO) ? stderr : NULL;
    const study_options options = {.results = request->results,
                                   .shard = request->shard,
                                   .shards = request->shards,
                                   .progress = terminal,
                                   .stop = terminal_stop_requested};
    size_t rows = 0;
    status result = request->quiet ? STATUS_OK : lint(s, request, why);
    THEN(result, study_run(s, &options, &rows, why));
    if (result == STATUS_INTERRUPTED) {
        diagnose(why, STATUS_INTERRUPTED,
                 study_keeps_files(s) ? "run it again to resume; images are written at the end"
                                      : "run it again to resume",
                 "interrupted; its %zu new rows are kept", rows);
        diagnostic_locate(why, s->path, 0, 0);
    }
    if (result != STATUS_OK || request->quiet)
        return result;
    if (rows)
        printf("%s: %zu rows, including warm-ups, written to %s/%s%s\n", s->name, rows, request->results, s->name,
               study_keeps_files(s) ? "; images/index.tsv there lists the images" : "");
    else
        printf("%s: complete, nothing to do\n", s->name);
    return terminal_flush(why); /* the next study may take an hour */
}

static status print_status(const study *s, const study_request *request, diagnostic *why)
{
    study_progress progress;
    TRY(study_status(s, request->results, &progress, why));
    printf("%s: %zu of %zu cells done, %zu rows and %zu warm-ups in %s/%s, %zu marked\n", s->name, progress.cells_done,
           progress.cells, progress.rows - progress.warmups, progress.warmups, request->results, s->name,
           progress.rows_marked);
    return STATUS_OK;
}

static status merge_one(const study *s, const study_request *request, diagnostic *why)
{
    size_t rows = 0;
    TRY(study_merge(s, request->results, &rows, why));
    printf("%s: %zu rows in %s/%s/rows.csv\n", s->name, rows, request->results, s->name);
    return STATUS_OK;
}

/* A terminal gets the most important columns, a pipe or file all of them. */
static status print_summary(const study *s, const study_request *request, diagnostic *why)
{
    if (request->columns)
        return study_spread(s, request->results, request->columns, stdout, why);
    if (!terminal_columns(STDOUT_FILENO))
        return study_summary(s, request->results, stdout, why);
    char *text = NULL;
    text_writer writer;
    TRY(text_writer_open(&writer, why));
    status result = study_summary(s, request->results, writer.stream, why);
    result = text_writer_end(&writer, result, &text, NULL, why);
    THEN(result, study_table_print(stdout, text, why));
    free(text);
    return result;
}

static status command_run(int argc, char **argv, diagnostic *why)
{
    return for_each_study(STUDY_RUN, run_one, argc, argv, why);
}

static status command_status(int argc, char **argv, diagnostic *why)
{
    return for_each_study(STUDY_STATUS, print_status, argc, argv, why);
}

static status command_merge(int argc, char **argv, diagnostic *why)
{
    return for_each_study(STUDY_MERGE, merge_one, argc, argv, why);
}

static status command_summary(int argc, char **argv, diagnostic *why)
{
    return for_each_study(STUDY_SUMMARY, print_summary, argc, argv, why);
}

static int is_study_file(const struct dirent *entry)
{
    size_t length = strlen(entry->d_name);
    return length > 6 && strcmp(entry->d_name + length - 6, ".study") == 0;
}

/* Prints the line of one study; an unreadable file is an error that does not end the list. */
static status list_one(const char *folder, const char *name, diagnostic *why)
{
    char path[4096];
    study *s = NULL;
    diagnostic error = {0};
    snprintf(path, sizeof path, "%s/%s", folder, name);
    status result = study_read(path, &s, &error);
    if (result == STATUS_OK)
        printf("%-40s %5zu cells  %s\n", path, study_cell_count(s), s->title ? s->title : "");
    else
        *why = error;
    study_destroy(s);
    return result;
}

static status list_folder(const char *folder, diagnostic *why)
{
    struct dirent **entries = NULL;
    int count = scandir(folder, &entries, is_study_file, alphasort);
    if (count < 0)
        return options_wrong(folder, NULL, why, "give a folder with *.study files", "cannot list the folder: %s",
                             strerrordesc_np(errno));
    status result = STATUS_OK;
    for (int i = 0; i < count; i++) {
        if (result != STATUS_OK)
            terminal_error(why); /* main prints the last one */
        status listed = list_one(folder, entries[i]->d_name, why);
        result = listed == STATUS_OK ? result : listed;
        free(entries[i]);
    }
    free(entries);
    return result;
}

static status command_list(int argc, char **argv, diagnostic *why)
{
    study_request request;
    status result = study_request_parse(STUDY_LIST, argc, argv, &request, why);
    THEN(result, list_folder(request.file_count ? request.files[0] : "experiments", why));
    study_request_release(&request);
    return result;
}

static const command commands[] = {
    {"run", "run studies, or resume them: measure the missing rows", command_run},
    {"list", "list the studies in a folder", command_list},
    {"status", "print the progress of studies", command_status},
    {"merge", "merge the rows of a study that was run in shards", command_merge},
    {"summary", "print medians and confidence intervals for each cell", command_summary},
};

status command_study(int argc, char **argv, diagnostic *why)
{
    return command_dispatch(commands, sizeof commands / sizeof commands[0],
                            "A study combines a scene, a grid of parameter values and a number of repetitions. Each "
                            "repetition is one row of results/STUDY/rows.csv.",
                            argc, argv, why);
}
