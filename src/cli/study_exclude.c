/* `cuvette study exclude`. */
#include "cli/options.h"
#include "cli/study_commands.h"
#include "study/rows/excluded.h"
#include "study/study.h"
#include <string.h>

typedef struct exclude_request {
    const char *file, *results, *row, *reason;
} exclude_request;

static const command_option options[] = {
    {"row", 0, "REF", "the row: CELL:REPETITION, as in these columns of rows.csv, or its value in the column check",
     OPTION_FILLS(option_text, exclude_request, row)},
    {"reason", 0, "TEXT", "why; written next to the row", OPTION_FILLS(option_text, exclude_request, reason)},
    {"results", 'r', "DIR", "folder of the results (default: results)",
     OPTION_FILLS(option_text, exclude_request, results)},
    {0},
};

static const command_form form = {
    .options = options,
    .synopsis = "FILE --row REF --reason TEXT",
    .arguments_at = offsetof(exclude_request, file),
    .argument_limit = 1,
    .excess_remedy = "give one study file",
    .excess = "unexpected argument '%.128s'",
    .about = "Exclude a row from summaries: append it and the reason to excluded.csv.\vThe row stays, and counts as "
             "measured. The summary has the number of excluded rows of each cell. To include the row again, remove its "
             "line from excluded.csv.",
};

static status check_request(const exclude_request *r, diagnostic *why)
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
    status code = command_form_read(&form, argc, argv, &request, why);
    THEN(code, check_request(&request, why));
    THEN(code, study_read(request.file, &s, why));
    THEN(code, study_follow_runs(s, request.results, why));
    THEN(code, excluded_add(s, request.results, request.row, request.reason, why));
    if (code == STATUS_OK)
        printf("%s: row %s is excluded in %s/%s/excluded.csv\n", s->name, request.row, request.results, s->name);
    study_destroy(s);
    return code;
}
