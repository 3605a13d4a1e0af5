#include "cli/param_rows.h"
#include "cli/json.h"
#include "cli/report.h"
#include <stdlib.h>
#include <string.h>

enum { CELL_MAX = 160 };

/* One line of the printed table; value is the default, or the scene's. */
typedef struct line {
    char *path, *value;
    const param *row;
} line;

typedef struct lines {
    line *line;
    size_t count, capacity;
} lines;

static const char *group_prefix(param_group group)
{
    switch (group) {
    case PARAM_LIGHT: return "LIGHT";
    case PARAM_MATERIAL: return "MATERIAL";
    case PARAM_SOLID: return "SOLID";
    case PARAM_RENDER:
    case PARAM_CAMERA:
    case PARAM_BACKGROUND:
    case PARAM_GROUP_COUNT: break;
    }
    return param_group_name(group);
}

char *param_rows_path(const param *row, char *text, size_t size)
{
    snprintf(text, size, "%s.%s", group_prefix(row->group), row->name);
    return text;
}

static status add_line(void *context, const char *path, const param *row, const char *value)
{
    lines *all = context;
    if (all->count == all->capacity) {
        size_t capacity = all->capacity * 2 + 64;
        line *larger = realloc(all->line, capacity * sizeof *larger);
        if (!larger)
            return STATUS_FAILURE;
        all->line = larger;
        all->capacity = capacity;
    }
    line *added = &all->line[all->count];
    *added = (line){strdup(path), strdup(value), row};
    all->count++;
    return added->path && added->value ? STATUS_OK : STATUS_FAILURE;
}

static status add_lines(lines *all, const scene *s)
{
    if (s)
        return scene_each_param(s, add_line, all);
    status result = STATUS_OK;
    for (size_t i = 0; i < param_count() && result == STATUS_OK; i++) {
        char path[CELL_MAX];
        result = add_line(all, param_rows_path(param_at(i), path, sizeof path), param_at(i), param_at(i)->fallback);
    }
    return result;
}

static void release(lines *all)
{
    for (size_t i = 0; i < all->count; i++) {
        free(all->line[i].path);
        free(all->line[i].value);
    }
    free(all->line);
}

static int wider(int width, const char *text)
{
    int length = (int)strlen(text);
    return length > width && length <= 48 ? length : width; /* one long value must not push the table apart */
}

static const char *or_dash(const char *text)
{
    return text[0] ? text : "-";
}

static void print_lines(FILE *stream, const lines *all, const char *value_title)
{
    int path = 4, value = wider(0, value_title), unit = 4, range = 5;
    char text[CELL_MAX];
    for (size_t i = 0; i < all->count; i++) {
        path = wider(path, all->line[i].path);
        value = wider(value, all->line[i].value);
        unit = wider(unit, all->line[i].row->unit);
        range = wider(range, param_range_text(all->line[i].row, text, sizeof text));
    }
    fprintf(stream, "%-*s  %-*s  %-*s  %-*s  %s\n", path, "name", value, value_title, unit, "unit", range, "range",
            "meaning");
    for (size_t i = 0; i < all->count; i++) {
        const line *l = &all->line[i];
        fprintf(stream, "%-*s  %-*s  %-*s  %-*s  %s\n", path, l->path, value, or_dash(l->value), unit,
                or_dash(l->row->unit), range, param_range_text(l->row, text, sizeof text), l->row->meaning);
    }
}

status param_rows_print(FILE *stream, const scene *s, diagnostic *why)
{
    lines all = {0};
    status result = add_lines(&all, s);
    if (result == STATUS_OK)
        print_lines(stream, &all, s ? "value" : "default");
    release(&all);
    return result == STATUS_OK ? result : diagnose(why, result, "", "out of memory");
}

static const char *type_name(param_type type)
{
    switch (type) {
    case PARAM_INT: return "integer";
    case PARAM_REAL: return "real";
    case PARAM_CHOICE: return "choice";
    case PARAM_VECTOR: return "vector";
    case PARAM_COLOR: return "color";
    case PARAM_PATH: return "path";
    }
    return "";
}

static json_t *choices(const param *row)
{
    json_t *list = json_array();
    for (size_t i = 0; list && row->choices && row->choices[i]; i++)
        json_array_append_new(list, json_string(row->choices[i]));
    return list;
}

static json_t *shapes(const param *row)
{
    static const char *const names[SHAPE_COUNT] = {"plane", "cylinder", "cup", "box", "sphere"};
    json_t *list = json_array();
    for (int i = 0; list && i < SHAPE_COUNT; i++)
        if (row->shapes == 0 || (row->shapes & 1u << i))
            json_array_append_new(list, json_string(names[i]));
    return list;
}

static json_t *line_json(const line *l, bool has_value)
{
    const param *row = l->row;
    bool bounded = row->type != PARAM_CHOICE && row->type != PARAM_PATH;
    char range[CELL_MAX];
    json_t *o = json_object();
    int bad = json_object_set_new(o, "path", json_of_text(l->path));
    bad |= json_object_set_new(o, "group", json_string(param_group_name(row->group)));
    bad |= json_object_set_new(o, "name", json_string(row->name));
    bad |= json_object_set_new(o, "type", json_string(type_name(row->type)));
    bad |= json_object_set_new(o, "unit", json_string(row->unit));
    bad |= json_object_set_new(o, "range", json_string(param_range_text(row, range, sizeof range)));
    bad |= json_object_set_new(o, "lowest", bounded ? json_of_real(row->lowest) : json_null());
    bad |= json_object_set_new(o, "highest", bounded ? json_of_real(row->highest) : json_null());
    bad |= json_object_set_new(o, "above_lowest", json_boolean(row->above_lowest));
    bad |= row->choices ? json_object_set_new(o, "choices", choices(row)) : 0;
    bad |= row->group == PARAM_SOLID ? json_object_set_new(o, "shapes", shapes(row)) : 0;
    bad |= json_object_set_new(o, "default", report_value(row, row->fallback));
    bad |= has_value ? json_object_set_new(o, "value", report_value(row, l->value)) : 0;
    bad |= json_object_set_new(o, "meaning", json_string(row->meaning));
    if (!bad)
        return o;
    json_decref(o);
    return NULL;
}

json_t *param_rows_json(const scene *s)
{
    lines all = {0};
    json_t *list = json_array();
    int bad = !list || add_lines(&all, s) != STATUS_OK;
    for (size_t i = 0; i < all.count && !bad; i++)
        bad |= json_array_append_new(list, line_json(&all.line[i], s != NULL));
    release(&all);
    if (!bad)
        return json_pack("{s:i,s:o}", "schema", REPORT_SCHEMA, "params", list);
    json_decref(list);
    return NULL;
}

/* roff reads '-' as a hyphen, '\' as an escape, and '.' or a quote at the start of a line as a request. */
static void write_roff(FILE *stream, const char *text)
{
    fputs(*text == '.' || *text == '\'' ? "\\&" : "", stream);
    for (const char *c = text; *c; c++) {
        if (*c == '-')
            fputs("\\-", stream);
        else if (*c == '\\')
            fputs("\\e", stream);
        else if (*c == '^')
            fputs("\\(ha", stream);
        else
            fputc(*c, stream);
    }
}

static const char *group_title(param_group group)
{
    switch (group) {
    case PARAM_RENDER: return "How it is rendered";
    case PARAM_CAMERA: return "Camera";
    case PARAM_BACKGROUND: return "Background";
    case PARAM_LIGHT: return "A light, by its name";
    case PARAM_MATERIAL: return "A material, by its name, or that of one solid, by the solid's";
    case PARAM_SOLID: return "A solid, by its name";
    case PARAM_GROUP_COUNT: break;
    }
    return "";
}

void param_rows_manual(FILE *stream)
{
    char text[CELL_MAX];
    for (size_t i = 0; i < param_count(); i++) {
        const param *row = param_at(i);
        if (i == 0 || param_at(i - 1)->group != row->group)
            fprintf(stream, ".SS %s\n", group_title(row->group));
        fprintf(stream, ".TP\n.B ");
        write_roff(stream, param_rows_path(row, text, sizeof text));
        fputc('\n', stream);
        write_roff(stream, row->meaning);
        fprintf(stream, ".\n(");
        write_roff(stream, param_range_text(row, text, sizeof text));
        fprintf(stream, "%s", row->unit[0] ? ", " : "");
        write_roff(stream, row->unit);
        fprintf(stream, "; default ");
        write_roff(stream, row->fallback[0] ? row->fallback : "none");
        fprintf(stream, ")\n");
    }
}
