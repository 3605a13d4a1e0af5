#include "study/verify.h"
#include "study/row_environments.h"
#include <stdlib.h>
#include <string.h>

static const char *const kinds[] = {
    [ROW_TORN] = "torn",           [ROW_MARKED] = "marked",   [ROW_DAMAGED] = "damaged",
    [ROW_EDITED] = "edited",       [ROW_MISPLACED] = "moved", [ROW_MISSING] = "missing",
    [ROW_DUPLICATE] = "duplicate", [ROW_DIFFERS] = "differs", [ROW_UNKNOWN] = "unknown run",
};

static void put_issues(const row_files *files, FILE *out)
{
    for (size_t i = 0; i < files->issue_count; i++) {
        const row_issue *at = &files->issues[i];
        if (at->line)
            fprintf(out, "%s:%ld: %s: %s\n", at->path, at->line, kinds[at->fault], at->text);
        else
            fprintf(out, "%s: %s: %s\n", at->path, kinds[at->fault], at->text);
    }
}

static status put_environments(const row_files *files, FILE *out, diagnostic *why)
{
    row_environment_count *all;
    size_t count;
    TRY(row_environments_find(files, &all, &count, why));
    for (size_t i = 0; i < count; i++) {
        fprintf(out, "environment %s: %zu rows", all[i].key, all[i].rows);
        for (int fact = 0; all[i].run && fact < ENVIRONMENT_FACTS; fact++)
            fprintf(out, "%s %s %s", fact ? "," : ":", environment_names[fact], all[i].run->here.fact[fact]);
        fputc('\n', out);
    }
    free(all);
    return STATUS_OK;
}

status study_verify(const study *s, const char *results, FILE *out, study_verdict *verdict, diagnostic *why)
{
    *verdict = (study_verdict){0};
    size_t other = 0;
    for (row_kind kind = ROWS; kind <= COMPARE_ROWS; kind++) {
        row_files *files;
        TRY(row_files_read(s, results, kind, &files, why));
        put_issues(files, out);
        status code = kind == ROWS ? put_environments(files, out, why) : STATUS_OK;
        if (!verdict->first.what[0])
            row_files_judge(files, &verdict->first);
        verdict->rows += kind == ROWS ? files->row_count : 0;
        other += kind == ROWS ? files->other_cells : 0;
        verdict->faults += files->fault_count;
        row_files_destroy(files);
        if (code != STATUS_OK)
            return code;
    }
    fprintf(out, "%s: %zu rows, %zu faults", s->name, verdict->rows, verdict->faults);
    if (other)
        fprintf(out, ", %zu rows of cells that the study does not have", other);
    fputc('\n', out);
    return STATUS_OK;
}

void study_environment_difference(const study *s, const char *results, char *text, size_t size)
{
    row_files *files = NULL;
    run_environment here;
    isa level;
    text[0] = 0;
    if (isa_choose(&level, NULL) != STATUS_OK || row_files_read(s, results, ROWS, &files, NULL) != STATUS_OK)
        return;
    if (environment_read("", level, &here, NULL) != STATUS_OK) {
        row_files_destroy(files);
        return;
    }
    for (size_t i = files->row_count; i > 0 && !text[0]; i--)
        if (files->rows[i - 1].run >= 0)
            environment_difference(&here, &files->runs->entry[files->rows[i - 1].run].here, text, size);
    row_files_destroy(files);
}
