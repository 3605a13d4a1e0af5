/* Figures of a study: their names, scripts and SVG files. */
#include "web/session/figures.h"
#include "base/file.h"
#include "base/text.h"
#include <dirent.h>
#include <stdlib.h>
#include <string.h>

enum { FIGURE_NAME_MAX = 64, FIGURES_MAX = 200, SVG_MAX = 32 << 20, SCRIPT_MAX = 1 << 20 };

static bool name_is_fit(const char *name)
{
    const size_t length = strspn(name, "abcdefghijklmnopqrstuvwxyz0123456789-");
    return length > 0 && length <= FIGURE_NAME_MAX && !name[length];
}

/* results/figures relative to the chosen folder; NULL where it is outside. */
static char *figures_folder(const lab *l)
{
    char *path = text_format("%s/figures", l->settings.results), *name = path ? folder_name(l->files, path) : NULL;
    free(path);
    return name;
}

/* The path of a file in a subfolder of the chosen folder. */
static status inner_path(const lab *l, const char *in, const char *name, const char *ending, char **path,
                         diagnostic *why)
{
    char *inner = in ? text_format("%s/%s%s", in, name, ending) : NULL;
    const status code = inner ? folder_path(l->files, inner, true, path, why)
                              : diagnose(why, STATUS_BAD_INPUT, "", "no figure has that name");
    free(inner);
    return code;
}

status figure_read(const lab *l, const char *name, char **svg, size_t *size, diagnostic *why)
{
    char *in = figures_folder(l), *path = NULL;
    status code = name_is_fit(name) ? inner_path(l, in, name, ".svg", &path, why)
                                    : diagnose(why, STATUS_BAD_INPUT, "use lower-case letters, digits and '-'",
                                               "invalid name of a figure");
    THEN(code, file_read_below(path, folder_real(l->files), SVG_MAX, svg, size, why));
    free(path);
    free(in);
    return code;
}

/* --- the figures of a study --- */

static bool names_study_table(const char *need, size_t length, const char *of)
{
    static const char tables[] = "tables/";
    const size_t name = strlen(of);
    if (length > name && strncmp(need, of, name) == 0 && need[name] == '/')
        return true;
    if (length < sizeof tables - 1 || strncmp(need, tables, sizeof tables - 1) != 0)
        return false;
    need += sizeof tables - 1;
    if (strncmp(need, of, name) != 0)
        return false;
    static const char *const endings[] = {".tsv", "-metrics.tsv", "-curves.tsv", "-motion.tsv"};
    for (size_t i = 0; i < sizeof endings / sizeof *endings; i++)
        if (strncmp(need + name, endings[i], strlen(endings[i])) == 0)
            return true;
    return false;
}

/* Whether the `# needs:` lines in the script's head name the study's rows or tables. *has_needs: there are such
 * lines. */
static bool script_needs_study(const lab *l, const char *figure, const char *of, bool *has_needs)
{
    char *path = NULL, *text = NULL;
    size_t size;
    bool needs = false;
    *has_needs = false;
    if (inner_path(l, "plots", figure, ".gp", &path, NULL) == STATUS_OK &&
        file_read_below(path, folder_real(l->files), SCRIPT_MAX, &text, &size, NULL) == STATUS_OK) {
        static const char key[] = "# needs:";
        for (const char *line = text; line && *line == '#' && !needs; line = strchr(line, '\n'), line += line != NULL) {
            if (strncmp(line, key, sizeof key - 1) != 0)
                continue;
            *has_needs = true;
            for (const char *word = line + sizeof key - 1; *word == ' ' && !needs; word += strcspn(word, " \n")) {
                word += strspn(word, " ");
                needs = names_study_table(word, strcspn(word, " \n"), of);
            }
        }
    }
    free(text);
    free(path);
    return needs;
}

static bool belongs_to_study(const lab *l, const char *figure, const char *of)
{
    bool has_needs;
    const size_t length = strlen(of);
    if (script_needs_study(l, figure, of, &has_needs))
        return true;
    return !has_needs && strncmp(figure, of, length) == 0 && (!figure[length] || figure[length] == '-');
}

/* The names of the files in a folder that have that ending, are valid figure names and pass accept. */
static json_t *list_figures(const char *path, const char *ending,
                            bool (*accept)(const lab *, const char *, const char *), const lab *l, const char *of)
{
    struct dirent **entries = NULL;
    json_t *names = json_array();
    const int count = path ? scandir(path, &entries, NULL, alphasort) : 0;
    for (int i = 0; i < count; i++) {
        char *dot = strrchr(entries[i]->d_name, '.');
        const bool ends = dot && strcmp(dot, ending) == 0;
        if (ends)
            *dot = 0;
        if (ends && names && json_array_size(names) < FIGURES_MAX && name_is_fit(entries[i]->d_name) &&
            accept(l, entries[i]->d_name, of))
            json_array_append_new(names, json_string(entries[i]->d_name));
        free(entries[i]);
    }
    free(entries);
    return names;
}

json_t *figures_of(const lab *l, const char *of)
{
    char *in = figures_folder(l), *path = in ? text_format("%s/figures", l->settings.results) : NULL;
    json_t *names = list_figures(path, ".svg", belongs_to_study, l, of);
    free(path);
    free(in);
    return names;
}

static bool needs_study(const lab *l, const char *figure, const char *of)
{
    bool has_needs;
    return script_needs_study(l, figure, of, &has_needs);
}

json_t *figures_drawable(const lab *l, const char *of)
{
    char *script = NULL;
    if (inner_path(l, "plots", "draw", ".sh", &script, NULL) != STATUS_OK)
        return json_array();
    *strrchr(script, '/') = 0;
    json_t *names = list_figures(script, ".gp", needs_study, l, of);
    free(script);
    return names;
}
