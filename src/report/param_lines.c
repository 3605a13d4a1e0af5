/* The lines of the parameter table: collection and filter. */
#include "base/array.h"
#include "base/text.h"
#include "report/param_rows.h"
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Placeholders of groups whose objects have names; the other groups use their own name as prefix. */
static const char *const prefixes[PARAM_GROUP_COUNT] = {
    [PARAM_MESH] = "MESH", [PARAM_TEXTURE] = "TEXTURE",   [PARAM_DATA] = "DATA",  [PARAM_LIGHT] = "LIGHT",
    [PARAM_BEAM] = "BEAM", [PARAM_MATERIAL] = "MATERIAL", [PARAM_SOLID] = "SOLID"};

char *param_lines_path(const param *row, char *text, size_t size)
{
    const char *prefix = prefixes[row->group];
    snprintf(text, size, "%s.%s", prefix ? prefix : param_group_name(row->group), row->name);
    return text;
}

static status add_line(void *context, const char *path, const param *row, const char *value)
{
    param_lines *all = context;
    if (!room_for_one(&all->line, all->count, sizeof *all->line))
        return STATUS_FAILURE;
    param_line *added = &all->line[all->count++];
    *added = (param_line){strdup(path), strdup(value), row};
    return added->path && added->value ? STATUS_OK : STATUS_FAILURE;
}

static status add_lines(param_lines *all, const scene *s, const param_selection *of)
{
    if (s)
        return scene_each_param_of(s, of, add_line, all);
    status result = STATUS_OK;
    for (size_t i = 0; i < param_count() && result == STATUS_OK; i++) {
        char path[PARAM_PATH_MAX];
        result = add_line(all, param_lines_path(param_at(i), path, sizeof path), param_at(i), param_at(i)->fallback);
    }
    return result;
}

void param_lines_release(param_lines *all)
{
    for (size_t i = 0; i < all->count; i++) {
        free(all->line[i].path);
        free(all->line[i].value);
    }
    free(all->line);
    *all = (param_lines){0};
}

/* Whether word is the path, one or more of its components ("rod", "priority", "lamp.position"), or an element of the
 * vector at that path. */
static bool names(const char *word, const char *path)
{
    size_t length = strlen(word), path_length = strlen(path);
    if (strncasecmp(word, path, path_length) == 0 && word[path_length] == '.' && length == path_length + 2)
        return true;
    for (const char *at = path; at; at = strchr(at, '.') ? strchr(at, '.') + 1 : NULL)
        if (strncasecmp(at, word, length) == 0 && (at[length] == 0 || at[length] == '.'))
            return true;
    return false;
}

/* Whether the filter keeps a line; named: the filter is the name of a parameter. */
static bool keeps(const char *filter, bool named, const param_line *l)
{
    return named ? names(filter, l->path) : param_matches(l->row, l->path, filter) != PARAM_NO_MATCH;
}

static status no_match(const param_lines *all, const char *filter, bool of_scene, diagnostic *why)
{
    char remedy[256] = "'cuvette params' lists all parameters";
    const char **known = calloc(2 * all->count + 1, sizeof *known);
    for (size_t i = 0; known && i < all->count; i++) {
        known[2 * i] = all->line[i].path;
        known[2 * i + 1] = all->line[i].row->name;
    }
    const char *nearest = known ? text_nearest(filter, known, 2 * all->count) : NULL;
    if (nearest)
        snprintf(remedy, sizeof remedy, "did you mean '%s'?", nearest);
    else if (!of_scene && strchr(filter, '.'))
        snprintf(remedy, sizeof remedy, "give the scene first if the path has the name of an object");
    free(known);
    return diagnose_at(why, "params", STATUS_BAD_INPUT, remedy, "no parameter matches '%.64s'", filter);
}

static status narrow(param_lines *all, const char *filter, bool of_scene, diagnostic *why)
{
    bool named = false;
    size_t kept = 0;
    for (size_t i = 0; i < all->count; i++)
        named = named || names(filter, all->line[i].path);
    for (size_t i = 0; i < all->count; i++)
        kept += keeps(filter, named, &all->line[i]);
    if (kept == 0)
        return no_match(all, filter, of_scene, why);
    kept = 0;
    for (size_t i = 0; i < all->count; i++) {
        param_line l = all->line[i];
        if (keeps(filter, named, &l)) {
            all->line[kept++] = l;
        } else {
            free(l.path);
            free(l.value);
        }
    }
    all->count = kept;
    return STATUS_OK;
}

status param_lines_collect(const scene *s, const param_selection *of, const char *filter, param_lines *out,
                           diagnostic *why)
{
    *out = (param_lines){0};
    if (add_lines(out, s, of) != STATUS_OK)
        return out_of_memory(why);
    return filter ? narrow(out, filter, s != NULL, why) : STATUS_OK;
}
