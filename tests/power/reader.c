/* Reads the rows of a study after each power cut, for tests/power/check.py: one request per line of standard input,
 * STUDY RESULTS KIND, separated by tabs, and one line of output each: the status, the checks of the rows, and what is
 * wrong. KIND is "read", or "resume" for the same after the start of a run that is interrupted before its first frame:
 * it locks the files, moves what is incomplete aside, and lists the run. */
#include "base/cancel.h"
#include "base/text.h"
#include "study/rows/row_files.h"
#include "study/study.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void print_error(const diagnostic *why)
{
    char text[DIAGNOSTIC_TEXT_MAX];
    printf("error\t%s\n", diagnostic_text(why, text, sizeof text));
}

static status read_rows(const study *s, const char *results, diagnostic *why)
{
    row_files *files = NULL;
    excluded *without = NULL;
    TRY(excluded_read(s, results, &without, why));
    excluded_destroy(without);
    TRY(row_files_read(s, results, ROWS, &files, why));
    printf("ok\t");
    for (size_t i = 0; i < files->row_count; i++)
        printf("%s%s", i ? "," : "", row_field(&files->rows[i], "checksum"));
    printf("\t");
    for (size_t i = 0; i < files->issue_count; i++)
        if (files->issues[i].fault != ROW_TORN)
            printf("%s:%ld: %s; ", files->issues[i].path, files->issues[i].line, files->issues[i].text);
    printf("\n");
    row_files_destroy(files);
    return STATUS_OK;
}

static status start_run(const study *s, const char *results, diagnostic *why)
{
    const study_options options = {.results = results};
    cancel_token token = {.ask = NULL};
    cancel_set(&token);
    cancel_begin(&token);
    const status code = study_run(s, &options, NULL, why);
    cancel_end(&token);
    return code == STATUS_INTERRUPTED ? STATUS_OK : code;
}

int main(void)
{
    char line[8192], last[8192] = "";
    study *s = NULL;
    while (fgets(line, sizeof line, stdin)) {
        char *rest = line, *path = strsep(&rest, "\t"), *results = strsep(&rest, "\t"), *kind = strsep(&rest, "\n");
        diagnostic why = {.what = "no such request"};
        status code = results && kind ? STATUS_OK : STATUS_BAD_INPUT;
        if (code == STATUS_OK && strcmp(path, last) != 0) { /* the last study stays */
            study_destroy(s);
            s = NULL;
            snprintf(last, sizeof last, "%s", path);
            code = study_read(path, &s, &why);
        }
        if (code == STATUS_OK && strcmp(kind, "resume") == 0)
            code = start_run(s, results, &why);
        THEN(code, read_rows(s, results, &why));
        if (code != STATUS_OK)
            print_error(&why);
        fflush(stdout);
    }
    study_destroy(s);
    return 0;
}
