/* Figures of a study: their names, scripts and SVG files. To draw them, the tables of the study are written and
 * plots/draw.sh is run. */
#include "base/cancel.h"
#include "base/file.h"
#include "base/json_build.h"
#include "base/os_process.h"
#include "base/status.h"
#include "base/text.h"
#include "scene/model/open.h"
#include "study/summary/summary.h"
#include "web/session/studies.h"

#include <dirent.h>
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { FIGURE_NAME_MAX = 64, FIGURES_MAX = 200, SVG_MAX = 32 << 20, SCRIPT_MAX = 1 << 20 };

static bool is_figure_name(const char *name)
{
    const size_t length = strspn(name, "abcdefghijklmnopqrstuvwxyz0123456789-");
    return length > 0 && length <= FIGURE_NAME_MAX && !name[length];
}

/* results/figures relative to the chosen folder; NULL if it is outside. */
static status figures_folder(const lab *l, char **name, diagnostic *why)
{
    *name = NULL;
    char *path = text_format("%s/figures", l->settings.results);
    const status code = path ? folder_find(l->files, path, name, why) : out_of_memory(why);
    free(path);
    return code;
}

/* The path of a file in a subfolder of the chosen folder. */
static status inner_path(const lab *l, const char *in, const char *name, const char *ending, char **path,
                         diagnostic *why)
{
    if (!in)
        return diagnose(why, STATUS_BAD_INPUT, "", "no figure has that name");
    char *inner = text_format("%s/%s%s", in, name, ending);
    const status code = inner ? folder_path(l->files, inner, true, path, why) : out_of_memory(why);
    free(inner);
    return code;
}

status figure_read(const lab *l, const char *name, char **svg, size_t *size, diagnostic *why)
{
    char *in = NULL, *path = NULL;
    status code = is_figure_name(name) ? figures_folder(l, &in, why)
                                       : diagnose(why, STATUS_BAD_INPUT, "use lower-case letters, digits and '-'",
                                                  "invalid name of a figure");
    THEN(code, inner_path(l, in, name, ".svg", &path, why));
    THEN(code, file_read_below(path, folder_real(l->files), SVG_MAX, svg, size, why));
    free(path);
    free(in);
    return code;
}

/* --- the figures of a study --- */

static bool names_study_table(const char *need, size_t length, const char *study_name)
{
    static const char tables[] = "tables/";
    const size_t name = strlen(study_name);
    if (length > name && strncmp(need, study_name, name) == 0 && need[name] == '/')
        return true;
    if (length < sizeof tables - 1 || strncmp(need, tables, sizeof tables - 1) != 0)
        return false;
    need += sizeof tables - 1;
    if (strncmp(need, study_name, name) != 0)
        return false;
    static const char *const endings[] = {".tsv", "-metrics.tsv", "-curves.tsv", "-motion.tsv"};
    for (size_t i = 0; i < sizeof endings / sizeof *endings; i++)
        if (strncmp(need + name, endings[i], strlen(endings[i])) == 0)
            return true;
    return false;
}

/* Whether the `# needs:` lines of a script's head name the study's rows or tables. *has_needs: there are such lines. */
static bool needs_in(const char *text, const char *study_name, bool *has_needs)
{
    static const char key[] = "# needs:";
    bool needs = false;
    for (const char *line = text; line && *line == '#' && !needs; line = strchr(line, '\n'), line += line != NULL) {
        if (strncmp(line, key, sizeof key - 1) != 0)
            continue;
        *has_needs = true;
        for (const char *word = line + sizeof key - 1; *word == ' ' && !needs; word += strcspn(word, " \n")) {
            word += strspn(word, " ");
            needs = names_study_table(word, strcspn(word, " \n"), study_name);
        }
    }
    return needs;
}

/* Ignores an error, unless the machine cannot read an existing file now (STATUS_FAILURE): the result may then lack
 * something. */
static status ignore_missing(status code, const diagnostic *reason, diagnostic *why)
{
    if (code == STATUS_FAILURE)
        *why = *reason;
    return code == STATUS_FAILURE ? code : STATUS_OK;
}

/* A figure without a script, or with one that cannot be read, needs nothing. */
static status script_needs_study(const lab *l, const char *figure, const char *study_name, bool *needs, bool *has_needs,
                                 diagnostic *why)
{
    char *path = NULL, *text = NULL;
    size_t size;
    diagnostic reason = {.what = ""};
    *needs = *has_needs = false;
    status code = inner_path(l, "plots", figure, ".gp", &path, &reason);
    THEN(code, file_read_below(path, folder_real(l->files), SCRIPT_MAX, &text, &size, &reason));
    if (code == STATUS_OK)
        *needs = needs_in(text, study_name, has_needs);
    free(text);
    free(path);
    return ignore_missing(code, &reason, why);
}

typedef status accepted(const lab *l, const char *figure, const char *study_name, bool *yes, diagnostic *why);

static status belongs_to_study(const lab *l, const char *figure, const char *study_name, bool *yes, diagnostic *why)
{
    bool has_needs;
    const size_t length = strlen(study_name);
    TRY(script_needs_study(l, figure, study_name, yes, &has_needs, why));
    *yes |= !has_needs && strncmp(figure, study_name, length) == 0 && (!figure[length] || figure[length] == '-');
    return STATUS_OK;
}

static status needs_study(const lab *l, const char *figure, const char *study_name, bool *yes, diagnostic *why)
{
    bool has_needs;
    return script_needs_study(l, figure, study_name, yes, &has_needs, why);
}

/* The names of the files in a folder that have that ending, are valid figure names and are accepted; an empty list if
 * the folder does not exist. */
static status list_figures(const char *path, const char *ending, accepted *accept, const lab *l, const char *study_name,
                           json_t **out, diagnostic *why)
{
    struct dirent **entries = NULL;
    diagnostic reason = {.what = ""};
    const int count = scandir(path, &entries, NULL, alphasort);
    status code = STATUS_OK;
    if (count < 0)
        code =
            ignore_missing(system_error(&reason, STATUS_BAD_INPUT, path, "cannot be listed", errno, ""), &reason, why);
    *out = json_array();
    for (int i = 0; i < count; i++) {
        char *dot = strrchr(entries[i]->d_name, '.');
        bool yes = code == STATUS_OK && dot && strcmp(dot, ending) == 0 && json_array_size(*out) < FIGURES_MAX;
        if (yes)
            *dot = 0;
        if (yes && (yes = is_figure_name(entries[i]->d_name)))
            code = accept(l, entries[i]->d_name, study_name, &yes, why);
        if (yes && code == STATUS_OK && *out)
            json_add(out, json_string(entries[i]->d_name));
        free(entries[i]);
    }
    free(entries);
    if (code == STATUS_OK && *out)
        return STATUS_OK;
    json_decref(*out);
    *out = NULL;
    return code == STATUS_OK ? out_of_memory(why) : code;
}

status figures_of(const lab *l, const char *study_name, json_t **out, diagnostic *why)
{
    char *in, *path = NULL;
    *out = NULL;
    status code = figures_folder(l, &in, why);
    if (code == STATUS_OK && in && !(path = text_format("%s/figures", l->settings.results)))
        code = out_of_memory(why);
    if (code == STATUS_OK)
        code = in                      ? list_figures(path, ".svg", belongs_to_study, l, study_name, out, why)
               : (*out = json_array()) ? STATUS_OK
                                       : out_of_memory(why);
    free(path);
    free(in);
    return code;
}

status figures_drawable(const lab *l, const char *study_name, json_t **out, diagnostic *why)
{
    char *script = NULL;
    diagnostic reason = {.what = ""};
    *out = NULL;
    const status found = inner_path(l, "plots", "draw", ".sh", &script, &reason);
    if (found != STATUS_OK) {
        TRY(ignore_missing(found, &reason, why));
        return (*out = json_array()) ? STATUS_OK : out_of_memory(why);
    }
    *strrchr(script, '/') = 0;
    const status code = list_figures(script, ".gp", needs_study, l, study_name, out, why);
    free(script);
    return code;
}

static const double draw_limit_s = 50; /* below the minute that a page waits for a reply */
enum { PART_MAX = 64 << 20 };

/* --- tables, the same as by the Makefile's rules --- */

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

static status join_parts(const study *s, const char *results, const char *kind, const char *path, diagnostic *why)
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
            code = join_parts(s, results, kinds[i], table, why);
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
