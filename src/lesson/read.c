/* Reads lessons. The grammar, in YAML; * marks keys that may be missing:
 *
 *   lesson: critical-angle           the name: letters, digits and -
 *   title: TEXT
 *   language: en                     * language of the texts
 *   question: TEXT
 *   scene: ../scenes/rod.yaml        relative to this file
 *   set: {PARAMETER: VALUE, ..}      *
 *   controls:                        one to five
 *     - {parameter: liquid.ior, label: TEXT, from: 1.1, to: 1.6}
 *     - {parameter: liquid.medium, label: TEXT, choices: [water, ethanol]}
 *   prediction: {ask: TEXT, within: 3}                              a number, compared with the value to read
 *   prediction: {ask: TEXT, choices: [TEXT, ..], right: TEXT}       or a choice
 *     axis: x                        * the curve's axis of the predicted number; or y
 *   measure:
 *     curve: mirror                  a curve of `cuvette realism --curve`; or
 *     over: liquid.ior               the metric at the values of this control
 *     tolerance: 1e-9                not with the metric speedup
 *     reading: TEXT                  label of the value to read
 *     unit: deg                      *
 *     metric: critical.liquid        a metric of `cuvette realism` or `cuvette motion`, or speedup; or
 *     at: 60                         the x at which the curve is read
 *   answer: TEXT */
#include "base/file.h"
#include "base/number.h"
#include "base/text.h"
#include "lesson/lesson.h"
#include "scene/data/document.h"
#include "scene/model/params.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { TEXT_BYTES_MAX = 2000, NAME_BYTES_MAX = 64 };
#define COUNT(array) (sizeof(array) / sizeof((array)[0]))

typedef struct reader {
    const document *file;
    lesson *l;
    const char *root;
    diagnostic *why;
} reader;

static status read_text(const reader *r, const node *map, const char *key, bool needed, char **out)
{
    const node *n = node_get(map, key);
    if (!n && !needed)
        return STATUS_OK;
    if (!n)
        return node_error(r->file, map, r->why, "add it; cuvette-lesson(5) shows an example", "'%s' is missing", key);
    if (n->kind != NODE_SCALAR || !n->text[0] || strlen(n->text) > TEXT_BYTES_MAX)
        return node_error(r->file, n, r->why, "write a text of at most 2000 bytes", "'%s' is not a text", key);
    return (*out = strdup(n->text)) ? STATUS_OK : out_of_memory(r->why);
}

static status read_number(const reader *r, const node *map, const char *key, double *out)
{
    const node *n = node_get(map, key);
    if (!n)
        return node_error(r->file, map, r->why, "add it; cuvette-lesson(5) shows an example", "'%s' is missing", key);
    if (n->kind != NODE_SCALAR || !number_parse_real(n->text, out))
        return node_error(r->file, n, r->why, "write a number such as 1.5", "'%s' is not a number", key);
    return STATUS_OK;
}

static status expect_map(const reader *r, const node *parent, const char *key, const node **out)
{
    const node *n = node_get(parent, key);
    if (n && n->kind == NODE_MAP) {
        *out = n;
        return STATUS_OK;
    }
    return node_error(r->file, n ? n : parent, r->why, "write keys and values; cuvette-lesson(5) shows an example",
                      n ? "'%s' has no keys" : "'%s' is missing", key);
}

/* Reports the error of a value or of the scene: bad input is located in the lesson, a failure of the machine is not. */
static status relay(const reader *r, const node *at, status code, const char *remedy, const diagnostic *refused)
{
    if (code == STATUS_BAD_INPUT)
        return node_error(r->file, at, r->why, remedy, "%s", refused->what);
    if (code != STATUS_OK && r->why)
        *r->why = *refused;
    return code;
}

/* Reads a value as text. If the node is not a value, `error` and `remedy` are reported. */
static status read_value(const reader *r, const node *n, const char *remedy, const char *error, char **out)
{
    if (!node_is_value(n))
        return node_error(r->file, n, r->why, remedy, "%s", error);
    return (*out = node_value_text(n)) ? STATUS_OK : out_of_memory(r->why);
}

/* Reads a list of 2 to LESSON_CHOICES_MAX texts. */
static status read_choices(const reader *r, const node *n, char **out, int *count)
{
    if (n->kind != NODE_LIST || n->count < 2 || n->count > LESSON_CHOICES_MAX)
        return node_error(r->file, n, r->why, "write a list of 2 to 6 texts, such as [water, ethanol]",
                          "invalid list of choices");
    for (size_t i = 0; i < n->count; i++) {
        TRY(read_value(r, n->items[i], "write a word or a number", "this is not a choice", &out[*count]));
        ++*count;
    }
    return STATUS_OK;
}

static status try_value(const reader *r, scene *s, const node *at, const char *path, const char *value)
{
    diagnostic refused = {.what = ""};
    const status code = scene_set(s, path, value, &refused);
    return relay(r, at, code, refused.remedy, &refused);
}

static status try_range(const reader *r, scene *s, const node *n, const lesson_control *c)
{
    const double ends[] = {c->from, c->to};
    const char *const keys[] = {"from", "to"};
    char text[NUMBER_TEXT_MAX];
    for (int i = 0; i < 2; i++)
        TRY(try_value(r, s, node_get(n, keys[i]), c->parameter, number_format(ends[i], text)));
    return c->from < c->to ? STATUS_OK
                           : node_error(r->file, node_get(n, "to"), r->why, "make 'to' greater than 'from'",
                                        "the range of %s is empty", c->parameter);
}

static status read_control(const reader *r, const node *n, scene *trial)
{
    static const char *const keys[] = {"parameter", "label", "from", "to", "choices"};
    lesson_control *c = &r->l->control[r->l->control_count++];
    if (n->kind != NODE_MAP)
        return node_error(r->file, n, r->why, "write {parameter: liquid.ior, label: Index, from: 1, to: 2}",
                          "this is not a control");
    TRY(node_check_keys(r->file, n, keys, COUNT(keys), r->why));
    TRY(read_text(r, n, "parameter", true, &c->parameter));
    TRY(read_text(r, n, "label", true, &c->label));
    const node *choices = node_get(n, "choices");
    if (!choices) {
        TRY(read_number(r, n, "from", &c->from));
        TRY(read_number(r, n, "to", &c->to));
        return try_range(r, trial, n, c);
    }
    TRY(read_choices(r, choices, c->choices, &c->choice_count));
    for (int i = 0; i < c->choice_count; i++)
        TRY(try_value(r, trial, choices->items[i], c->parameter, c->choices[i]));
    return STATUS_OK;
}

static status read_controls(const reader *r, const node *root)
{
    const node *list = node_get(root, "controls");
    if (!list || list->kind != NODE_LIST || list->count < 1 || list->count > LESSON_CONTROLS_MAX)
        return node_error(r->file, list ? list : root, r->why, "add a list 'controls' of one to five parameters",
                          "a lesson needs one to five controls");
    scene *trial = scene_clone(r->l->start);
    status code = trial ? STATUS_OK : out_of_memory(r->why);
    for (size_t i = 0; i < list->count && code == STATUS_OK; i++)
        code = read_control(r, list->items[i], trial);
    scene_destroy(trial);
    return code;
}

/* The path without links and "..", relative to the working folder if the file is below it; unchanged if it is
 * missing. */
static char *short_path(const char *path)
{
    char real[PATH_MAX], here[PATH_MAX];
    if (!realpath(path, real))
        return strdup(path);
    const size_t length = realpath(".", here) ? strlen(here) : 0;
    const bool below = length > 1 && strncmp(real, here, length) == 0 && real[length] == '/';
    return strdup(below ? real + length + 1 : real);
}

static status read_scene(const reader *r, const node *root)
{
    lesson *l = r->l;
    char *name = NULL;
    TRY(read_text(r, root, "scene", true, &name));
    char *joined = name[0] == '/' ? strdup(name) : file_next_to(l->path, name);
    l->scene_path = joined ? short_path(joined) : NULL;
    free(joined);
    free(name);
    if (!l->scene_path)
        return out_of_memory(r->why);
    diagnostic refused = {.what = ""};
    const status code = scene_read_below(l->scene_path, r->root, &l->start, &refused);
    /* an error inside the scene file keeps its position; a failure of the machine has none in this file */
    if (code == STATUS_OK || code == STATUS_FAILURE || refused.line > 0) {
        if (code != STATUS_OK && r->why)
            *r->why = refused;
        return code;
    }
    return node_error(r->file, node_get(root, "scene"), r->why, "give an existing scene, relative to this file",
                      "scene %.200s: %.200s", l->scene_path, refused.what);
}

static status read_settings(const reader *r, const node *root)
{
    lesson *l = r->l;
    const node *map = node_get(root, "set");
    if (!map)
        return STATUS_OK;
    if (map->kind != NODE_MAP)
        return node_error(r->file, map, r->why, "write {liquid.ior: 1.333}", "'set' has no keys");
    if (!(l->setting = calloc(map->count + 1, sizeof *l->setting)))
        return out_of_memory(r->why);
    for (size_t i = 0; i < map->count; i++) {
        char *value = NULL;
        TRY(read_value(r, map->items[i], "write a number, a word or a list", "this is not a value", &value));
        const status code = try_value(r, l->start, map->items[i], map->keys[i]->text, value);
        char *setting = code == STATUS_OK ? text_format("%s=%s", map->keys[i]->text, value) : NULL;
        free(value);
        TRY(code);
        if (!setting)
            return out_of_memory(r->why);
        l->setting[l->setting_count++] = setting;
    }
    return STATUS_OK;
}

static status read_axis(const reader *r, const node *n)
{
    const node *axis = node_get(n, "axis");
    if (!axis)
        return STATUS_OK;
    if (axis->kind != NODE_SCALAR || (strcmp(axis->text, "x") != 0 && strcmp(axis->text, "y") != 0))
        return node_error(r->file, axis, r->why, "write x or y", "'axis' is neither x nor y");
    r->l->predicts = axis->text[0];
    return STATUS_OK;
}

static status read_prediction(const reader *r, const node *root)
{
    static const char *const keys[] = {"ask", "choices", "right", "within", "axis"};
    lesson *l = r->l;
    const node *n = NULL;
    TRY(expect_map(r, root, "prediction", &n));
    TRY(node_check_keys(r->file, n, keys, COUNT(keys), r->why));
    TRY(read_text(r, n, "ask", true, &l->ask));
    TRY(read_axis(r, n));
    const node *choices = node_get(n, "choices"), *right = node_get(n, "right");
    if (!choices)
        return read_number(r, n, "within", &l->answer_within);
    TRY(read_choices(r, choices, l->choices, &l->choice_count));
    for (l->right = 0; right && right->kind == NODE_SCALAR && l->right < l->choice_count; l->right++)
        if (strcmp(l->choices[l->right], right->text) == 0)
            return STATUS_OK;
    return node_error(r->file, right ? right : n, r->why, "write the text of one of the choices",
                      "'right' is none of the choices");
}

static status read_curve(const reader *r, const node *n)
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
static status try_over(const reader *r, const node *at, const lesson_control *c)
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
    return relay(r, at, code, "give the control's values as choices", &refused);
}

static status read_over(const reader *r, const node *measure, const node *over)
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
static status read_tolerance(const reader *r, const node *n)
{
    const node *tolerance = node_get(n, "tolerance");
    if (!lesson_is_timed(r->l))
        return read_number(r, n, "tolerance", &r->l->tolerance);
    r->l->tolerance = INFINITY;
    return tolerance ? node_error(r->file, tolerance, r->why, "remove 'tolerance'", "times have no tolerance")
                     : STATUS_OK;
}

static status read_measure(const reader *r, const node *root)
{
    static const char *const keys[] = {"curve", "over", "tolerance", "reading", "unit", "metric", "at"};
    lesson *l = r->l;
    const node *n = NULL;
    TRY(expect_map(r, root, "measure", &n));
    TRY(node_check_keys(r->file, n, keys, COUNT(keys), r->why));
    l->line = n->line;
    l->column = n->column;
    const node *over = node_get(n, "over"), *at = node_get(n, "at");
    l->over = -1;
    TRY(over ? read_over(r, n, over) : read_curve(r, n));
    TRY(read_text(r, n, "metric", false, &l->metric));
    TRY(read_tolerance(r, n));
    TRY(read_text(r, n, "reading", true, &l->reading));
    TRY(read_text(r, n, "unit", false, &l->unit));
    if (!l->unit && !(l->unit = strdup("")))
        return out_of_memory(r->why);
    if (!l->metric == !at)
        return node_error(r->file, n, r->why, "give either 'metric' or 'at'",
                          at ? "'metric' and 'at' cannot be combined" : "the value to read is missing");
    return at ? read_number(r, n, "at", &l->at) : STATUS_OK;
}

static bool is_name(const char *text)
{
    const size_t length = strspn(text, "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-");
    return length > 0 && length <= NAME_BYTES_MAX && !text[length];
}

static status read_root(const reader *r)
{
    static const char *const keys[] = {"lesson", "title",    "language",   "question", "scene",
                                       "set",    "controls", "prediction", "measure",  "answer"};
    lesson *l = r->l;
    const node *root = document_root(r->file);
    if (!root || root->kind != NODE_MAP)
        return diagnose_at(r->why, l->path, STATUS_BAD_INPUT,
                           "begin with lesson: NAME; cuvette-lesson(5) shows an example", "this is not a lesson");
    TRY(node_check_keys(r->file, root, keys, COUNT(keys), r->why));
    TRY(read_text(r, root, "lesson", true, &l->name));
    if (!is_name(l->name))
        return node_error(r->file, node_get(root, "lesson"), r->why, "use 1 to 64 letters, digits and -",
                          "invalid name of a lesson");
    TRY(read_text(r, root, "title", true, &l->title));
    TRY(read_text(r, root, "language", false, &l->language));
    if (!l->language && !(l->language = strdup("en")))
        return out_of_memory(r->why);
    TRY(read_text(r, root, "question", true, &l->question));
    TRY(read_text(r, root, "answer", true, &l->answer));
    TRY(read_scene(r, root));
    TRY(read_settings(r, root));
    TRY(read_controls(r, root));
    TRY(read_prediction(r, root));
    TRY(read_measure(r, root));
    diagnostic refused = {.what = ""};
    const status code = scene_check(l->start, &refused);
    return relay(r, root, code, refused.remedy, &refused);
}

status lesson_read_below(const char *path, const char *root, lesson **out, diagnostic *why)
{
    *out = NULL;
    document *file = NULL;
    lesson *l = calloc(1, sizeof *l);
    if (!l || !(l->path = strdup(path))) {
        free(l);
        return out_of_memory(why);
    }
    status code = document_read_below(path, root, &file, why);
    THEN(code, read_root(&(reader){file, l, root, why}));
    document_destroy(file);
    if (code == STATUS_OK)
        *out = l;
    else
        lesson_destroy(l);
    return code;
}

status lesson_read(const char *path, lesson **out, diagnostic *why)
{
    return lesson_read_below(path, NULL, out, why);
}

void lesson_destroy(lesson *l)
{
    if (!l)
        return;
    char *const texts[] = {l->path,       l->name, l->title,  l->language, l->question, l->answer,
                           l->scene_path, l->ask,  l->metric, l->reading,  l->unit};
    for (size_t i = 0; i < COUNT(texts); i++)
        free(texts[i]);
    for (size_t i = 0; i < l->setting_count; i++)
        free(l->setting[i]);
    free(l->setting);
    for (int i = 0; i < l->choice_count; i++)
        free(l->choices[i]);
    for (int i = 0; i < l->control_count; i++) {
        free(l->control[i].parameter);
        free(l->control[i].label);
        for (int k = 0; k < l->control[i].choice_count; k++)
            free(l->control[i].choices[k]);
    }
    scene_destroy(l->start);
    free(l);
}
