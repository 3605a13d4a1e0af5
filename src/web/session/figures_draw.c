/* Drawing of a study's figures: writes its tables, then runs plots/draw.sh. */
#include "base/cancel.h"
#include "base/file.h"
#include "base/text.h"
#include "study/summary/summary.h"
#include "base/child.h"
#include "web/session/figures.h"
#include "web/session/studies.h"
#include "web/session/study_files.h"
#include "scene/model/open.h"
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const double draw_limit_s = 50; /* below the minute that a page waits for a reply */
enum { PART_MAX = 64 << 20 };

/* --- tables, made as by the Makefile's rules --- */

static status write_summary(const study *s, const char *results, const char *path, diagnostic *why)
{
    file_writer file;
    TRY(file_writer_open(&file, path, why));
    return file_writer_end(&file, study_summary(s, results, file.stream, why), why);
}

static char *part_path(const study *s, const char *results, size_t cell, const char *kind)
{
    return text_format("%s/%s/images/%04zu-%s.tsv", results, s->name, cell, kind);
}

/* Appends the table of one cell; only the header of the first is kept. */
static status append_part(FILE *out, const char *path, const char *root, bool *headed, diagnostic *why)
{
    char *text = NULL;
    size_t size;
    TRY(file_read_below(path, root, PART_MAX, &text, &size, why));
    const char *line = strchr(text, '\n');
    fputs(*headed ? (line ? line + 1 : "") : text, out);
    *headed = true;
    free(text);
    return STATUS_OK;
}

static status string_parts(const study *s, const char *results, const char *kind, const char *path, diagnostic *why)
{
    file_writer file;
    bool headed = false;
    TRY(file_writer_open(&file, path, why));
    status code = STATUS_OK;
    for (size_t cell = 0; code == STATUS_OK && cell < study_cell_count(s); cell++) {
        char *part = part_path(s, results, cell, kind);
        if (!part)
            code = out_of_memory(why);
        else if (access(part, R_OK) == 0)
            code = append_part(file.stream, part, scene_root(s->base), &headed, why);
        free(part);
    }
    return file_writer_end(&file, code, why);
}

static status write_tables(const study *s, const char *results, diagnostic *why)
{
    static const char *const kinds[] = {"metrics", "curves", "motion"};
    char *tables = text_format("%s/tables", results), *path = text_format("%s/tables/%s.tsv", results, s->name);
    status code = tables && path ? file_make_directory(tables, why) : out_of_memory(why);
    THEN(code, write_summary(s, results, path, why));
    for (size_t i = 0; code == STATUS_OK && i < sizeof kinds / sizeof *kinds; i++) {
        char *first = part_path(s, results, 0, kinds[i]),
             *table = text_format("%s/tables/%s-%s.tsv", results, s->name, kinds[i]);
        if (!first || !table)
            code = out_of_memory(why);
        else if (access(first, R_OK) == 0)
            code = string_parts(s, results, kinds[i], table, why);
        free(first);
        free(table);
    }
    free(path);
    free(tables);
    return code;
}

/* --- the script --- */

static status run_script(const lab *l, const char *script, const json_t *figures, char **output, bool *complete,
                         diagnostic *why)
{
    enum { BEFORE = 6 };
    const size_t count = json_array_size(figures);
    const char **arguments = calloc(BEFORE + count + 1, sizeof *arguments);
    if (!arguments)
        return out_of_memory(why);
    const char *const before[BEFORE] = {"/bin/bash", script, "--results", l->settings.results, "--format", "svg"};
    memcpy(arguments, before, sizeof before);
    for (size_t i = 0; i < count; i++)
        arguments[BEFORE + i] = json_string_value(json_array_get(figures, i));
    int exit_code;
    cancel_token token = {.ask = studies_ending, .context = l->studies};
    cancel_begin(&token);
    const status code = child_run((char *const *)(uintptr_t)arguments, draw_limit_s, output, &exit_code, why);
    cancel_end(&token);
    free(arguments);
    *complete = exit_code == 0;
    return code;
}

status figures_draw(const lab *l, const study *s, char **output, bool *complete, diagnostic *why)
{
    char *script = NULL;
    *output = NULL;
    *complete = false;
    json_t *figures;
    status code = figures_drawable(l, s->name, &figures, why);
    if (code == STATUS_OK && json_array_size(figures) == 0)
        code = diagnose(why, STATUS_BAD_INPUT, "write a script in plots/ with the line `# needs: tables/NAME.tsv`",
                        "no script draws a figure of this study");
    THEN(code, folder_path(l->files, "plots/draw.sh", true, &script, why));
    THEN(code, study_check_results(l, l->settings.results, "tables", why));
    THEN(code, study_check_results(l, l->settings.results, "figures", why));
    THEN(code, study_check_results(l, l->settings.results, s->name, why));
    THEN(code, write_tables(s, l->settings.results, why));
    THEN(code, run_script(l, script, figures, output, complete, why));
    free(script);
    json_decref(figures);
    return code;
}
