/* The subcommands of `cuvette study` on rows that exist: exclude, films. */
#include "cli/options.h"
#include "cli/study.h"
#include "cli/terminal.h"
#include "study/rows/row_files.h"
#include "study/study.h"
#include "study/summary/verify.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* --- `cuvette study exclude` --- */

typedef struct exclude_request {
    const char *file, *results, *row, *reason;
} exclude_request;

static const command_option exclude_options[] = {
    {"row", 0, "REF", "the row: CELL:REPETITION, as in these columns of rows.csv, or its value in the column checksum",
     OPTION_FILLS(option_text, exclude_request, row)},
    {"reason", 0, "TEXT", "why; written next to the row", OPTION_FILLS(option_text, exclude_request, reason)},
    {"results", 'r', "DIR", "folder of the results (default: results)",
     OPTION_FILLS(option_text, exclude_request, results)},
    {0},
};

static const command_form exclude_form = {
    .options = exclude_options,
    .synopsis = "FILE --row REF --reason TEXT",
    .arguments_at = offsetof(exclude_request, file),
    .argument_limit = 1,
    .excess_remedy = "give one study file",
    .excess = "unexpected argument '%.128s'",
    .about = "Exclude a row from summaries: append it and the reason to excluded.csv.\vThe row stays, and counts as "
             "measured. The summary has the number of excluded rows of each cell. To include the row again, remove its "
             "line from excluded.csv.",
};

static status check_exclude(const exclude_request *r, diagnostic *why)
{
    const char *what = NULL, *remedy = NULL;
    if (!r->file)
        what = "no study was given", remedy = "give a study file, such as experiments/depth.study";
    else if (!r->row)
        what = "no row is given", remedy = "add --row CELL:REPETITION";
    else if (!r->reason)
        what = "no reason is given", remedy = "add --reason TEXT";
    else if (!r->results[0])
        what = "--results is empty", remedy = "give a folder";
    return what ? options_wrong("study exclude", NULL, why, remedy, "%s", what) : STATUS_OK;
}

status study_exclude(int argc, char **argv, diagnostic *why)
{
    exclude_request request = {.results = "results"};
    study *s = NULL;
    status code = command_form_read(&exclude_form, argc, argv, &request, why);
    THEN(code, check_exclude(&request, why));
    THEN(code, study_read(request.file, &s, why));
    THEN(code, study_follow_runs(s, request.results, why));
    THEN(code, excluded_add(s, request.results, request.row, request.reason, why));
    if (code == STATUS_OK)
        printf("%s: row %s is excluded in %s/%s/excluded.csv\n", s->name, request.row, request.results, s->name);
    study_destroy(s);
    return code;
}

/* --- `cuvette study films`: whether two results folders have the same films and ray counts --- */

typedef struct films_request {
    const char **files;
    size_t file_count;
    const char *results, *against;
    bool on_terminal;
    size_t cells_different;
} films_request;

static void store_file(void *request, const char *file)
{
    films_request *r = request;
    r->files[r->file_count++] = file;
}

static const command_option films_options[] = {
    {"results", 'r', "DIR", "folder of the results (default: results)",
     OPTION_FILLS(option_text, films_request, results)},
    {"against", 0, "DIR", "the results folder to compare with", OPTION_FILLS(option_text, films_request, against)},
    {0},
};

static const command_form films_form = {
    .options = films_options,
    .store_argument = store_file,
    .synopsis = "--against DIR FILE...",
    .about = "Compare the films and ray counts of each study in two results folders, cell by cell. Exit status 1 if a "
             "cell differs.\vA cell is compared if both folders have rows of it. Films and counts do not depend on the "
             "machine. A pipe or a file gets one line per study, its fields separated by tabs.",
};

static status check_films(const films_request *r, diagnostic *why)
{
    const char *what = NULL, *remedy = NULL;
    if (r->file_count == 0)
        what = "no study was given", remedy = "give a study file, such as experiments/depth.study";
    else if (!r->against || !r->against[0])
        what = "no folder to compare with is given", remedy = "add --against DIR, such as --against results/reference";
    else if (!r->results[0])
        what = "--results is empty", remedy = "give a folder";
    return what ? options_wrong("study films", NULL, why, remedy, "%s", what) : STATUS_OK;
}

static void print_films(const study *s, const films_request *r, const study_films *f)
{
    if (r->on_terminal)
        printf("%s: %zu of %zu cells have the same film and ray counts (%zu films); different:", s->name, f->same,
               f->compared, f->distinct);
    else
        printf("%s\t%zu\t%zu\t%zu\t%zu\t%s\t%d\t", s->name, study_cell_count(s), f->compared, f->same, f->distinct,
               f->processor, f->other_processor);
    for (size_t i = 0; i < f->different_count; i++)
        printf("%s%zu", i || r->on_terminal ? " " : "", f->different[i]);
    puts(f->different_count ? "" : r->on_terminal ? " none" : "none");
}

static status compare_study(films_request *r, const char *path, diagnostic *why)
{
    study *s = NULL;
    study_films films = {.compared = 0};
    TRY(study_read(path, &s, why));
    status code = study_follow_runs(s, r->results, why);
    THEN(code, study_films_compare(s, r->results, r->against, &films, why));
    if (code == STATUS_OK)
        print_films(s, r, &films);
    r->cells_different += films.different_count;
    study_films_release(&films);
    study_destroy(s);
    return code;
}

status study_films_command(int argc, char **argv, diagnostic *why)
{
    films_request r = {.results = "results", .files = calloc((size_t)argc + 1, sizeof *r.files)};
    status code = r.files ? command_form_read(&films_form, argc, argv, &r, why) : out_of_memory(why);
    THEN(code, check_films(&r, why));
    r.on_terminal = terminal_columns(STDOUT_FILENO) > 0;
    if (code == STATUS_OK && !r.on_terminal)
        puts("study\tcells\tn\tsame\tfilms\tprocessor\tother\tdifferent");
    for (size_t i = 0; i < r.file_count && code == STATUS_OK; i++)
        code = compare_study(&r, r.files[i], why);
    THEN(code, terminal_flush(why));
    if (code == STATUS_OK && r.cells_different > 0)
        code = diagnose(why, STATUS_FAILURE, "`cuvette study verify` checks the rows of each folder",
                        "%zu cells have other films or counts than in %s", r.cells_different, r.against);
    free(r.files);
    return code;
}
