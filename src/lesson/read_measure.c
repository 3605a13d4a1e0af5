/* Reads what a lesson measures: the curve and its value, formulas, and the measurement by hand with what is shown. */
#include "base/number.h"
#include "base/text.h"
#include "lesson/lesson.h"
#include "scene/data/document.h"
#include "scene/model/params.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define COUNT(array) (sizeof(array) / sizeof((array)[0]))

static status read_curve(const lesson_reader *r, const node *n)
{
    const node *curve = node_get(n, "curve");
    const char *names[REALISM_CURVE_COUNT];
    for (int i = 0; i < REALISM_CURVE_COUNT; i++) {
        names[i] = realism_curve_name((realism_curve)i);
        if (curve && curve->kind == NODE_SCALAR && strcmp(curve->text, names[i]) == 0) {
            r->l->curve = (realism_curve)i;
            return STATUS_OK;
        }
    }
    const char *near = curve && curve->kind == NODE_SCALAR ? text_nearest(curve->text, names, COUNT(names)) : NULL;
    char remedy[96];
    snprintf(remedy, sizeof remedy, near ? "did you mean '%s'?" : "'cuvette realism --help' lists the curves", near);
    return node_error(r->file, curve ? curve : n, r->why, remedy,
                      curve ? "unknown curve '%.64s'" : "'curve' is missing%s",
                      curve && curve->kind == NODE_SCALAR ? curve->text : "");
}

/* The values of a control on the x axis must be numbers. A range requires a parameter that is not an integer, so a
 * value with decimals is tried. */
static status try_over(const lesson_reader *r, const node *at, const lesson_control *c)
{
    double number;
    char text[NUMBER_TEXT_MAX];
    for (int i = 0; i < c->choice_count; i++)
        if (!number_parse_real(c->choices[i], &number))
            return node_error(r->file, at, r->why, "choose a control whose values are numbers",
                              "'%.64s', a choice of %.128s, is not a number", c->choices[i], c->parameter);
    if (c->choice_count)
        return STATUS_OK;
    scene *trial = scene_clone(r->l->start);
    diagnostic refused = {.what = ""};
    status code = trial ? STATUS_OK : out_of_memory(&refused);
    THEN(code, scene_set(trial, c->parameter, number_format(c->from + (c->to - c->from) / M_PI, text), &refused));
    scene_destroy(trial);
    return lesson_relay(r, at, code, "give the control's values as choices", &refused);
}

static status read_over(const lesson_reader *r, const node *measure, const node *over)
{
    lesson *l = r->l;
    if (node_get(measure, "curve") || node_get(measure, "at"))
        return node_error(r->file, over, r->why, "give either 'curve', or 'over' with 'metric'",
                          "'over' cannot be combined with 'curve' or 'at'");
    for (l->over = 0; over->kind == NODE_SCALAR && l->over < l->control_count; l->over++)
        if (strcmp(l->control[l->over].parameter, over->text) == 0)
            return try_over(r, over, &l->control[l->over]);
    return node_error(r->file, over, r->why, "write the parameter of one of the controls",
                      "'over' is none of the controls");
}

/* Times have no tolerance. */
static status read_tolerance(const lesson_reader *r, const node *n)
{
    const node *tolerance = node_get(n, "tolerance");
    if (!lesson_is_timed(r->l))
        return lesson_read_number(r, n, "tolerance", &r->l->tolerance);
    r->l->tolerance = INFINITY;
    return tolerance ? node_error(r->file, tolerance, r->why, "remove 'tolerance'", "times have no tolerance")
                     : STATUS_OK;
}

status lesson_read_measure(const lesson_reader *r, const node *root)
{
    static const char *const keys[] = {"curve", "over", "tolerance", "reading", "unit", "metric", "at", "theory"};
    lesson *l = r->l;
    const node *n = NULL;
    TRY(lesson_expect_map(r, root, "measure", &n));
    TRY(node_check_keys(r->file, n, keys, COUNT(keys), r->why));
    l->line = n->line;
    l->column = n->column;
    const node *over = node_get(n, "over"), *at = node_get(n, "at");
    l->over = -1;
    TRY(over ? read_over(r, n, over) : read_curve(r, n));
    TRY(lesson_read_text(r, n, "metric", false, &l->metric));
    TRY(lesson_read_formula(r, n, "theory", false, &l->theory));
    if (l->theory && (!l->metric || l->over < 0))
        return node_error(r->file, node_get(n, "theory"), r->why, "give 'over' and a metric of a beam, or remove it",
                          "'theory' requires 'over' and 'metric'");
    TRY(read_tolerance(r, n));
    TRY(lesson_read_text(r, n, "reading", true, &l->reading));
    TRY(lesson_read_text(r, n, "unit", false, &l->unit));
    if (!l->unit && !(l->unit = strdup("")))
        return out_of_memory(r->why);
    if (!l->metric == !at)
        return node_error(r->file, n, r->why, "give either 'metric' or 'at'",
                          at ? "'metric' and 'at' cannot be combined" : "the value to read is missing");
    return at ? lesson_read_number(r, n, "at", &l->at) : STATUS_OK;
}

/* --- formulas --- */

/* Tries a formula with a theory of 1, as the value is not measured yet. */
static status try_formula(const lesson_reader *r, const node *at, const char *formula)
{
    double unused;
    diagnostic refused = {.what = ""};
    const status code = lesson_formula(r->l, r->l->start, 1.0, formula, &unused, &refused);
    return lesson_relay(r, at, code, refused.remedy, &refused);
}

status lesson_read_formula(const lesson_reader *r, const node *map, const char *key, bool needed, char **out)
{
    TRY(lesson_read_text(r, map, key, needed, out));
    return *out ? try_formula(r, node_get(map, key), *out) : STATUS_OK;
}

static bool is_value_name(const char *text)
{
    const size_t letters = strspn(text, "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ_");
    const size_t all =
        letters + strspn(text + letters, "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ_0123456789");
    return letters > 0 && !text[all] && strcmp(text, "theory") != 0 && strcmp(text, "measured") != 0 &&
           strcmp(text, "pi") != 0;
}

status lesson_read_values(const lesson_reader *r, const node *root)
{
    lesson *l = r->l;
    const node *map = node_get(root, "values");
    if (!map)
        return STATUS_OK;
    if (map->kind != NODE_MAP || map->count > LESSON_VALUES_MAX)
        return node_error(r->file, map, r->why, "write at most 12 values, such as {n: liquid.ior}",
                          "'values' has no keys, or too many");
    for (size_t i = 0; i < map->count; i++) {
        lesson_value_of *v = &l->value[l->value_count];
        const char *name = map->keys[i]->text;
        if (!is_value_name(name))
            return node_error(r->file, map->keys[i], r->why, "use letters, digits and _; theory, measured and pi exist",
                              "invalid name of a value");
        const status code = lesson_read_formula(r, map, name, true, &v->formula); /* only names above are known */
        l->value_count += v->formula != NULL;
        if (code != STATUS_OK)
            return code;
        if (!(v->name = strdup(name)))
            return out_of_memory(r->why);
    }
    return STATUS_OK;
}

/* --- what is shown, and measured by hand --- */

/* The index of the key's word, or -1 with an error; words: ends with NULL. */
static status read_word(const lesson_reader *r, const node *map, const char *key, const char *const *words, int *out)
{
    const node *n = node_get(map, key);
    char list[96] = "write one of: ";
    for (*out = 0; words[*out]; ++*out) {
        if (n && n->kind == NODE_SCALAR && strcmp(n->text, words[*out]) == 0)
            return STATUS_OK;
        const size_t length = strlen(list);
        snprintf(list + length, sizeof list - length, "%s%s", *out ? ", " : "", words[*out]);
    }
    return node_error(r->file, n ? n : map, r->why, list, n ? "unknown word for '%s'" : "'%s' is missing", key);
}

/* A list of `count` numbers. */
static status read_numbers(const lesson_reader *r, const node *map, const char *key, int count, double *out)
{
    const node *n = node_get(map, key);
    bool fits = n && n->kind == NODE_LIST && n->count == (size_t)count;
    for (int i = 0; fits && i < count; i++)
        fits = n->items[i]->kind == NODE_SCALAR && number_parse_real(n->items[i]->text, &out[i]);
    char remedy[48];
    snprintf(remedy, sizeof remedy, "write a list of %d numbers", count);
    return fits ? STATUS_OK
                : node_error(r->file, n ? n : map, r->why, remedy, n ? "invalid '%s'" : "'%s' is missing", key);
}

static status read_marks(const lesson_reader *r, const node *marks)
{
    lesson_show *show = &r->l->show;
    static const char *const names[] = {"normals", "angles", "extensions"};
    bool *const on[] = {&show->normals, &show->angles, &show->extensions};
    if (!marks)
        return STATUS_OK;
    for (size_t i = 0; marks->kind == NODE_LIST && i < marks->count; i++) {
        size_t k = 0;
        while (k < COUNT(names) &&
               (marks->items[i]->kind != NODE_SCALAR || strcmp(marks->items[i]->text, names[k]) != 0))
            k++;
        if (k == COUNT(names))
            return node_error(r->file, marks->items[i], r->why, "write one of: normals, angles, extensions",
                              "unknown mark");
        *on[k] = true;
    }
    return marks->kind == NODE_LIST
               ? STATUS_OK
               : node_error(r->file, marks, r->why, "write a list, such as [normals]", "'marks' is not a list");
}

status lesson_read_show(const lesson_reader *r, const node *root)
{
    static const char *const keys[] = {"view", "at", "window", "marks"};
    static const char *const views[] = {"image", "top", "front", "side", NULL};
    lesson_show *show = &r->l->show;
    const node *n = NULL;
    int view = 0;
    show->at = NAN;
    if (node_get(root, "show")) {
        TRY(lesson_expect_map(r, root, "show", &n));
        TRY(node_check_keys(r->file, n, keys, COUNT(keys), r->why));
        TRY(read_word(r, n, "view", views, &view));
        if (node_get(n, "at"))
            TRY(lesson_read_number(r, n, "at", &show->at));
        if ((show->has_window = node_get(n, "window")))
            TRY(read_numbers(r, n, "window", 4, show->window));
        TRY(read_marks(r, node_get(n, "marks")));
    }
    if (show->has_window && !(show->window[0] < show->window[1] && show->window[2] < show->window[3]))
        return node_error(r->file, node_get(n, "window"), r->why, "write [left, right, lower, upper]",
                          "the window is empty");
    return (show->view = strdup(views[view])) ? STATUS_OK : out_of_memory(r->why);
}

/* The keys of one tool only. */
static status read_tool_keys(const lesson_reader *r, const node *n)
{
    static const char *const readings[] = {"distance", "power", NULL};
    lesson_hand *hand = &r->l->hand;
    int reads = 0;
    hand->arms[0] = 90.0, hand->arms[1] = 45.0;
    if (hand->tool == LESSON_PROTRACTOR && node_get(n, "arms"))
        return read_numbers(r, n, "arms", 2, hand->arms);
    if (hand->tool == LESSON_RULER)
        return read_numbers(r, n, "to", 3, hand->to);
    if (hand->tool != LESSON_SCREEN)
        return STATUS_OK;
    TRY(read_word(r, n, "reads", readings, &reads));
    hand->reads_power = reads == 1;
    return hand->reads_power ? STATUS_OK : read_numbers(r, n, "from", 3, hand->from);
}

status lesson_read_hand(const lesson_reader *r, const node *root)
{
    static const char *const keys[] = {"tool",  "ask", "unit", "truth", "within",
                                       "place", "to",  "from", "arms",  "reads"};
    static const char *const tools[] = {"protractor", "ruler", "screen", NULL};
    lesson_hand *hand = &r->l->hand;
    const node *n = NULL;
    int tool = 0;
    if (!node_get(root, "hand"))
        return STATUS_OK;
    TRY(lesson_expect_map(r, root, "hand", &n));
    TRY(node_check_keys(r->file, n, keys, COUNT(keys), r->why));
    TRY(read_word(r, n, "tool", tools, &tool));
    hand->tool = (lesson_tool)(LESSON_PROTRACTOR + tool);
    TRY(lesson_read_text(r, n, "ask", true, &hand->ask));
    TRY(lesson_read_text(r, n, "unit", false, &hand->unit));
    TRY(lesson_read_formula(r, n, "truth", true, &hand->truth));
    TRY(lesson_read_number(r, n, "within", &hand->within));
    TRY(read_numbers(r, n, "place", 3, hand->place));
    if (strcmp(r->l->show.view, "image") == 0)
        return node_error(r->file, n, r->why, "add 'show' with a view: top, front or side",
                          "a tool needs a section to measure in");
    return read_tool_keys(r, n);
}
