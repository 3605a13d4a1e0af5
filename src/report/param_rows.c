/* The parameter table as text, as JSON, and as roff for the manual page. */
#include "report/param_rows.h"
#include "base/json_build.h"
#include "base/number.h"
#include "base/text.h"
#include "geometry/shapes/shape.h"
#include "geometry/solid.h"
#include "lint/lint.h"
#include "optics/coating.h"
#include "report/json.h"
#include "report/report.h"
#include "scene/model/medium.h"
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

static int wider(int width, const char *text)
{
    int length = (int)strlen(text);
    return length > width && length <= 48 ? length : width; /* a single long value must not widen the column */
}

static const char *or_dash(const char *text)
{
    return text[0] ? text : "-";
}

/* Column widths of the table. A terminal without room for the range column gets the range before the meaning. */
typedef struct table_widths {
    int path, value, unit, range; /* range 0: no column */
} table_widths;

static table_widths measure(const param_lines *all, const char *value_title, int columns)
{
    table_widths w = {.path = 4, .value = wider(0, value_title), .unit = 4, .range = 5};
    char text[PARAM_PATH_MAX];
    for (size_t i = 0; i < all->count; i++) {
        w.path = wider(w.path, all->line[i].path);
        w.value = wider(w.value, all->line[i].value);
        w.unit = wider(w.unit, all->line[i].row->unit);
        w.range = wider(w.range, param_range_text(all->line[i].row, text, sizeof text));
    }
    if (columns && w.path + w.value + w.unit + w.range + 6 > columns)
        w.range = 0;
    return w;
}

typedef struct table_cells {
    const char *path, *value, *unit, *range, *meaning, *needs;
} table_cells;

static bool print_cells(FILE *stream, const table_widths *w, const table_cells *c, int columns)
{
    char *start = w->range ? text_format("%-*s  %-*s  %-*s  %-*s  ", w->path, c->path, w->value, c->value, w->unit,
                                         c->unit, w->range, c->range)
                           : text_format("%-*s  %-*s  %-*s  ", w->path, c->path, w->value, c->value, w->unit, c->unit);
    const char *before = c->needs[0] ? "; needs " : "";
    if (start && w->range)
        wrap_row(stream, columns, start, "%s%s%s", c->meaning, before, c->needs);
    else if (start)
        wrap_row(stream, columns, start, "%s; %s%s%s", c->range, c->meaning, before, c->needs);
    free(start);
    return start != NULL;
}

static bool print_lines(FILE *stream, const param_lines *all, const char *value_title, int columns)
{
    const table_widths widths = measure(all, value_title, columns);
    const table_cells titles = {"name", value_title, "unit", "range", "meaning", ""};
    bool good = print_cells(stream, &widths, &titles, columns);
    for (size_t i = 0; i < all->count && good; i++) {
        const param_line *l = &all->line[i];
        char range[PARAM_PATH_MAX], needs[PARAM_PATH_MAX];
        const table_cells cells = {l->path,
                                   or_dash(l->value),
                                   or_dash(l->row->unit),
                                   param_range_text(l->row, range, sizeof range),
                                   l->row->meaning,
                                   inert_needs_text(l->row, needs, sizeof needs)};
        good = print_cells(stream, &widths, &cells, columns);
    }
    return good;
}

status param_rows_print(FILE *stream, const scene *s, const char *filter, int columns, diagnostic *why)
{
    param_lines all;
    status result = param_lines_collect(s, NULL, filter, &all, why);
    if (result == STATUS_OK && !print_lines(stream, &all, s ? "value" : "default", columns))
        result = out_of_memory(why);
    param_lines_release(&all);
    return result;
}

static const char *const type_names[] = {
    [PARAM_INT] = "integer",   [PARAM_REAL] = "real",   [PARAM_CHOICE] = "choice",
    [PARAM_VECTOR] = "vector", [PARAM_COLOR] = "color", [PARAM_LIST] = "list",
    [PARAM_PATH] = "path",     [PARAM_WORD] = "name",   [PARAM_LAYERS] = "layers",
};

static json_t *choices(const param *row)
{
    json_t *list = json_array();
    for (size_t i = 0; list && row->choices && row->choices[i]; i++)
        json_add(&list, json_string(row->choices[i]));
    return list;
}

/* The names of the designs of coatings. */
static json_t *designs(void)
{
    json_t *list = json_array();
    for (size_t i = 0; list && i < coating_designs_count(); i++)
        json_add(&list, json_string(coating_design_at(i)->name));
    return list;
}

static json_t *shapes(const param *row)
{
    json_t *list = json_array();
    const shape_rule *rule;
    for (int i = 0; list && (rule = shape_of_kind((shape_kind)i)); i++)
        if (!row->by_shape || shape_has(rule, row->name))
            json_add(&list, json_string(rule->word));
    return list;
}

static json_t *slider(const param *row, const char *initial, const char *value)
{
    const param_slider s = param_slider_of(row, initial, value);
    return json_pack("{s:f,s:f,s:f,s:f}", "lowest", s.lowest, "highest", s.highest, "step", s.step, "log_from",
                     s.log_from);
}

/* {LAW: coefficients} for the laws that need some. */
static json_t *first_coefficients(const char *value)
{
    double ior = 1;
    json_t *laws = json_object();
    number_parse_real(value, &ior);
    for (int law = MEDIUM_IOR + 1; law < MEDIUM_DATA; law++) {
        const number_list first = medium_first_coefficients(law, ior);
        json_t *list = json_array();
        for (int64_t i = 0; i < first.count; i++)
            json_add(&list, json_of_real(first.value[i]));
        json_add_as(&laws, medium_words[law], list);
    }
    return laws;
}

/* The value of a path in the opened scene; NULL for none. */
static const char *initial_of(const json_t *initial, const param_line *l)
{
    return json_string_value(json_object_get(initial, l->path));
}

/* initial: {path: text}; NULL for none. */
static json_t *line_json(const param_line *l, bool has_value, const json_t *initial)
{
    const param *row = l->row;
    const char *first = initial_of(initial, l);
    bool bounded =
        row->type != PARAM_CHOICE && row->type != PARAM_PATH && row->type != PARAM_WORD && row->type != PARAM_LAYERS;
    char range[PARAM_PATH_MAX];
    json_t *o = json_object();
    int bad = json_object_set_new(o, "path", json_of_text(l->path));
    bad |= json_object_set_new(o, "group", json_string(param_group_name(row->group)));
    bad |= json_object_set_new(o, "name", json_string(row->name));
    bad |= json_object_set_new(o, "type", json_string(type_names[row->type]));
    bad |= json_object_set_new(o, "unit", json_string(row->unit));
    bad |= json_object_set_new(o, "range", json_string(param_range_text(row, range, sizeof range)));
    bad |= json_object_set_new(o, "lowest", bounded ? json_of_real(row->lowest) : json_null());
    bad |= json_object_set_new(o, "highest", bounded ? json_of_real(row->highest) : json_null());
    bad |= json_object_set_new(o, "above_lowest", json_boolean(row->above_lowest));
    if (param_has_slider(row))
        bad |= json_object_set_new(o, "slider", slider(row, first, l->value));
    bad |= row->coefficient ? json_object_set_new(o, "coefficient", json_true()) : 0;
    bad |= row->choices ? json_object_set_new(o, "choices", choices(row)) : 0;
    bad |= row->type == PARAM_LAYERS ? json_object_set_new(o, "designs", designs()) : 0;
    bad |= row->names ? json_object_set_new(o, "names", json_string(row->names)) : 0;
    bad |= row->automatic ? json_object_set_new(o, "automatic", json_string(row->automatic)) : 0;
    bad |= row->group == PARAM_SOLID ? json_object_set_new(o, "shapes", shapes(row)) : 0;
    bad |= json_object_set_new(o, "default", report_value(row, row->fallback));
    bad |= has_value ? json_object_set_new(o, "value", report_value(row, l->value)) : 0;
    bad |= initial ? json_object_set_new(o, "initial", first ? report_value(row, first) : json_null()) : 0;
    bad |= json_object_set_new(o, "meaning", json_string(row->meaning));
    bad |= json_object_set_new(o, "needs", json_string(inert_needs_text(row, range, sizeof range)));
    return json_if(o, bad == 0);
}

static status add_text(void *values, const char *path, const param *row, const char *value)
{
    (void)row;
    return json_object_set_new(values, path, json_of_text(value)) ? STATUS_FAILURE : STATUS_OK;
}

/* {path: text} of a scene. */
static json_t *texts_of(const scene *s, const param_selection *of)
{
    json_t *values = json_object();
    return json_if(values, values && scene_each_param_of(s, of, add_text, values) == STATUS_OK);
}

status param_rows_json(const scene *s, const scene *opened, const param_selection *of, const char *filter, json_t **out,
                       diagnostic *why)
{
    param_lines all;
    *out = NULL;
    status result = param_lines_collect(s, of, filter, &all, why);
    json_t *list = result == STATUS_OK ? json_array() : NULL, *initial = opened && list ? texts_of(opened, of) : NULL;
    int bad = !list || (opened && !initial);
    const param *ior = param_find(PARAM_MATERIAL, "ior");
    for (size_t i = 0; i < all.count && !bad; i++) {
        json_t *line = line_json(&all.line[i], s != NULL, initial);
        if (initial && all.line[i].row == ior)
            bad |= json_object_set_new(line, "first_coefficients", first_coefficients(all.line[i].value));
        bad |= json_array_append_new(list, line);
    }
    param_lines_release(&all);
    json_decref(initial);
    if (!bad)
        *out = json_pack("{s:i,s:o}", "schema", REPORT_SCHEMA, "params", list);
    else
        json_decref(list);
    return result == STATUS_OK && !*out ? out_of_memory(why) : result;
}

/* roff reads '-' as a hyphen, '\' as an escape, '^' as an accent, and '.' or a quote at the start of a line as a
 * request. */
static void write_roff(FILE *stream, const char *text)
{
    fputs(*text == '.' || *text == '\'' ? "\\&" : "", stream);
    for (const char *c = text; *c; c++)
        if (*c == '-')
            fputs("\\-", stream);
        else if (*c == '\\')
            fputs("\\e", stream);
        else if (*c == '^')
            fputs("\\(ha", stream);
        else
            fputc(*c, stream);
}

static const char *const group_titles[PARAM_GROUP_COUNT] = {
    [PARAM_RENDER] = "Rendering",
    [PARAM_CAMERA] = "Camera",
    [PARAM_BACKGROUND] = "Background",
    [PARAM_MESH] = "Meshes, by name",
    [PARAM_TEXTURE] = "Textures, by name",
    [PARAM_DATA] = "Optical data, by name",
    [PARAM_LIGHT] = "Lights, by name",
    [PARAM_BEAM] = "Beams, by name",
    [PARAM_MATERIAL] = "Materials, by name; or by a solid's name, for that solid only",
    [PARAM_SOLID] = "Solids, by name",
};

static void write_shapes(FILE *stream)
{
    const shape_rule *rule;
    fprintf(stream, ".SS Shapes of solids, in the solid's frame\n");
    for (int k = 0; (rule = shape_of_kind((shape_kind)k)); k++) {
        fprintf(stream, ".TP\n.B %s\n", rule->word);
        write_roff(stream, rule->meaning);
        fprintf(stream, rule->parameters ? ".\n(parameters " : ".\n");
        for (const char *const *name = rule->parameters; name && *name; name++)
            fprintf(stream, "%s%s", *name, name[1] ? ", " : ")\n");
    }
}

void param_rows_manual(FILE *stream)
{
    char text[PARAM_PATH_MAX];
    for (size_t i = 0; i < param_count(); i++) {
        const param *row = param_at(i);
        if (i == 0 || param_at(i - 1)->group != row->group)
            fprintf(stream, ".SS %s\n", group_titles[row->group]);
        fprintf(stream, ".TP\n.B ");
        write_roff(stream, param_lines_path(row, text, sizeof text));
        fputc('\n', stream);
        write_roff(stream, row->meaning);
        fprintf(stream, ".\n(");
        write_roff(stream, param_range_text(row, text, sizeof text));
        fprintf(stream, "%s", row->unit[0] ? ", " : "");
        write_roff(stream, row->unit);
        fprintf(stream, "; default ");
        write_roff(stream, row->fallback[0] ? row->fallback : "none");
        fprintf(stream, "%s", inert_needs_text(row, text, sizeof text)[0] ? "; needs " : "");
        write_roff(stream, text);
        fprintf(stream, ")\n");
    }
    write_shapes(stream);
}
