/* Reads lessons, and finds their files. The grammar, in YAML; * marks keys that may be missing:
 *
 *   lesson: critical-angle           the name: letters, digits and -
 *   title: TEXT
 *   language: en                     * language of the texts
 *   question: TEXT
 *   scene: ../scenes/rod.yaml        relative to this file
 *   set: {PARAMETER: VALUE, ..}      *
 *   beams: {NAME: {KEY: VALUE, ..}, ..}     * added to the scene, as in a scene file
 *   solids: {NAME: {shape: box, ..}, ..}    *
 *   controls:                        one to five
 *     - {parameter: liquid.ior, label: TEXT, from: 1.1, to: 1.6}
 *     - {parameter: liquid.medium, label: TEXT, choices: [water, ethanol]}
 *   prediction: {ask: TEXT, within: 3}                              a number, compared with the value to read
 *   prediction: {ask: TEXT, choices: [TEXT, ..], right: TEXT}       or a choice
 *     axis: x                        * the curve's axis of the predicted number; or y
 *     which: FORMULA                 * the number of the right choice, from 1, for other values of the controls
 *   values: {NAME: FORMULA, ..}      * shown in the answer as {NAME}
 *   measure:
 *     curve: mirror                  a curve of `cuvette realism --curve`; or
 *     over: liquid.ior               the metric at the values of this control
 *     tolerance: 1e-9                not with the metric speedup
 *     reading: TEXT                  label of the value to read
 *     unit: deg                      *
 *     metric: critical.liquid        a metric of `cuvette realism` or `cuvette motion`, or speedup; or
 *     at: 60                         the x at which the curve is read
 *     theory: FORMULA                with a metric of a beam, such as light.image
 *   show: {view: top, at: 0.6, window: [U0, U1, V0, V1], marks: [normals, angles, extensions]}     *
 *   hand: {tool: protractor, ask: TEXT, unit: deg, truth: FORMULA, within: 2, place: [X, Y, Z]}   *
 *   answer: TEXT */
#include "base/array.h"
#include "base/file.h"
#include "base/installed.h"
#include "base/number.h"
#include "base/text.h"
#include "lesson/lesson.h"
#include "scene/data/document.h"
#include "scene/model/edit/edit.h"
#include "scene/model/params.h"

#include <dirent.h>
#include <errno.h>
#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { NAME_BYTES_MAX = 64 };
#define COUNT(array) (sizeof(array) / sizeof((array)[0]))

/* Reads a value as text. If the node is not a value, `error` and `remedy` are reported. */
static status read_value(const lesson_reader *r, const node *n, const char *remedy, const char *error, char **out)
{
    if (!node_is_value(n))
        return node_error(r->file, n, r->why, remedy, "%s", error);
    return (*out = node_value_text(n)) ? STATUS_OK : out_of_memory(r->why);
}

/* Reads a list of 2 to LESSON_CHOICES_MAX texts. */
static status read_choices(const lesson_reader *r, const node *n, char **out, int *count)
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

static status try_value(const lesson_reader *r, scene *s, const node *at, const char *path, const char *value)
{
    diagnostic refused = {.what = ""};
    const status code = scene_set(s, path, value, &refused);
    return lesson_relay(r, at, code, refused.remedy, &refused);
}

/* A value of a control, and of the parameter that goes with it. */
static status try_control(const lesson_reader *r, scene *s, const node *n, const node *at, const lesson_control *c,
                          const char *value)
{
    TRY(try_value(r, s, at, c->parameter, value));
    return c->with ? try_value(r, s, node_get(n, "with"), c->with, value) : STATUS_OK;
}

static status try_range(const lesson_reader *r, scene *s, const node *n, const lesson_control *c)
{
    const double ends[] = {c->from, c->to};
    const char *const keys[] = {"from", "to"};
    char text[NUMBER_TEXT_MAX];
    for (int i = 0; i < 2; i++)
        TRY(try_control(r, s, n, node_get(n, keys[i]), c, number_format(ends[i], text)));
    return c->from < c->to ? STATUS_OK
                           : node_error(r->file, node_get(n, "to"), r->why, "make 'to' greater than 'from'",
                                        "the range of %s is empty", c->parameter);
}

static status read_control(const lesson_reader *r, const node *n, scene *trial)
{
    static const char *const keys[] = {"parameter", "label", "with", "from", "to", "choices"};
    lesson_control *c = &r->l->control[r->l->control_count++];
    if (n->kind != NODE_MAP)
        return node_error(r->file, n, r->why, "write {parameter: liquid.ior, label: Index, from: 1, to: 2}",
                          "this is not a control");
    TRY(node_check_keys(r->file, n, keys, COUNT(keys), r->why));
    TRY(lesson_read_text(r, n, "parameter", true, &c->parameter));
    TRY(lesson_read_text(r, n, "label", true, &c->label));
    TRY(lesson_read_text(r, n, "with", false, &c->with));
    const node *choices = node_get(n, "choices");
    if (!choices) {
        TRY(lesson_read_number(r, n, "from", &c->from));
        TRY(lesson_read_number(r, n, "to", &c->to));
        return try_range(r, trial, n, c);
    }
    TRY(read_choices(r, choices, c->choices, &c->choice_count));
    for (int i = 0; i < c->choice_count; i++)
        TRY(try_control(r, trial, n, choices->items[i], c, c->choices[i]));
    return STATUS_OK;
}

static status read_controls(const lesson_reader *r, const node *root)
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

static status read_scene(const lesson_reader *r, const node *root)
{
    lesson *l = r->l;
    char *name = NULL;
    TRY(lesson_read_text(r, root, "scene", true, &name));
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

static status read_settings(const lesson_reader *r, const node *root)
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

static status add_object(const lesson_reader *r, const node *name, const node *map, bool is_solid)
{
    lesson *l = r->l;
    diagnostic refused = {.what = ""};
    const node *shape = node_get(map, "shape");
    if (map->kind != NODE_MAP)
        return node_error(r->file, map, r->why, "write keys and values, as in a scene file", "'%.64s' has no keys",
                          name->text);
    if (is_solid && (!shape || shape->kind != NODE_SCALAR))
        return node_error(r->file, map, r->why, "add the key shape", "the solid '%.64s' has no shape", name->text);
    shape_kind kind = (shape_kind)0;
    if (is_solid)
        TRY(lesson_relay(r, shape, scene_shape_named(shape->text, &kind, &refused), refused.remedy, &refused));
    const status code = is_solid ? scene_add_solid(l->start, name->text, kind, NULL, &refused)
                                 : scene_add(l->start, PARAM_BEAM, name->text, NULL, &refused);
    TRY(lesson_relay(r, name, code, refused.remedy, &refused));
    l->added[l->added_count] = strdup(name->text);
    if (!l->added[l->added_count++])
        return out_of_memory(r->why);
    for (size_t i = 0; i < map->count; i++) {
        char *value = NULL;
        TRY(read_value(r, map->items[i], "write a number, a word or a list", "this is not a value", &value));
        char *path = text_format("%s.%s", name->text, map->keys[i]->text);
        const status set = path ? scene_set_property(l->start, path, value, &refused) : out_of_memory(&refused);
        free(path);
        free(value);
        TRY(lesson_relay(r, map->items[i], set, refused.remedy, &refused));
    }
    return STATUS_OK;
}

/* The beams and solids that the lesson adds to its scene. */
static status read_added(const lesson_reader *r, const node *root)
{
    static const char *const sections[] = {"solids", "beams"};
    for (size_t k = 0; k < COUNT(sections); k++) {
        const node *map = node_get(root, sections[k]);
        if (!map)
            continue;
        if (map->kind != NODE_MAP)
            return node_error(r->file, map, r->why, "write {NAME: {KEY: VALUE}}", "'%s' has no keys", sections[k]);
        size_t room = r->l->added_count;
        if (!GROW(r->l->added, room, room + map->count + 1))
            return out_of_memory(r->why);
        for (size_t i = 0; i < map->count; i++)
            TRY(add_object(r, map->keys[i], map->items[i], k == 0));
    }
    return STATUS_OK;
}

static status read_axis(const lesson_reader *r, const node *n)
{
    const node *axis = node_get(n, "axis");
    if (!axis)
        return STATUS_OK;
    if (axis->kind != NODE_SCALAR || (strcmp(axis->text, "x") != 0 && strcmp(axis->text, "y") != 0))
        return node_error(r->file, axis, r->why, "write x or y", "'axis' is neither x nor y");
    r->l->predicts = axis->text[0];
    return STATUS_OK;
}

static status read_prediction(const lesson_reader *r, const node *root)
{
    static const char *const keys[] = {"ask", "choices", "right", "which", "within", "axis"};
    lesson *l = r->l;
    const node *n = NULL;
    TRY(lesson_expect_map(r, root, "prediction", &n));
    TRY(node_check_keys(r->file, n, keys, COUNT(keys), r->why));
    TRY(lesson_read_text(r, n, "ask", true, &l->ask));
    TRY(read_axis(r, n));
    TRY(lesson_read_formula(r, n, "which", false, &l->which));
    const node *choices = node_get(n, "choices"), *right = node_get(n, "right");
    if (!choices)
        return lesson_read_number(r, n, "within", &l->answer_within);
    TRY(read_choices(r, choices, l->choices, &l->choice_count));
    for (l->right = 0; right && right->kind == NODE_SCALAR && l->right < l->choice_count; l->right++)
        if (strcmp(l->choices[l->right], right->text) == 0)
            return STATUS_OK;
    return node_error(r->file, right ? right : n, r->why, "write the text of one of the choices",
                      "'right' is none of the choices");
}

static bool is_name(const char *text)
{
    const size_t length = strspn(text, "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-");
    return length > 0 && length <= NAME_BYTES_MAX && !text[length];
}

static status read_root(const lesson_reader *r)
{
    static const char *const keys[] = {"lesson", "title",   "language", "question", "scene",
                                       "set",    "beams",   "solids",   "controls", "prediction",
                                       "values", "measure", "show",     "hand",     "answer"};
    lesson *l = r->l;
    const node *root = document_root(r->file);
    if (!root || root->kind != NODE_MAP)
        return diagnose_at(r->why, l->path, STATUS_BAD_INPUT,
                           "begin with lesson: NAME; cuvette-lesson(5) shows an example", "this is not a lesson");
    TRY(node_check_keys(r->file, root, keys, COUNT(keys), r->why));
    TRY(lesson_read_text(r, root, "lesson", true, &l->name));
    if (!is_name(l->name))
        return node_error(r->file, node_get(root, "lesson"), r->why, "use 1 to 64 letters, digits and -",
                          "invalid name of a lesson");
    TRY(lesson_read_text(r, root, "title", true, &l->title));
    TRY(lesson_read_text(r, root, "language", false, &l->language));
    if (!l->language && !(l->language = strdup("en")))
        return out_of_memory(r->why);
    TRY(lesson_read_text(r, root, "question", true, &l->question));
    TRY(lesson_read_text(r, root, "answer", true, &l->answer));
    TRY(read_scene(r, root));
    TRY(read_settings(r, root));
    TRY(read_added(r, root));
    TRY(read_controls(r, root));
    TRY(lesson_read_values(r, root));
    TRY(read_prediction(r, root));
    TRY(lesson_read_measure(r, root));
    TRY(lesson_read_show(r, root));
    TRY(lesson_read_hand(r, root));
    diagnostic refused = {.what = ""};
    const status code = scene_check(l->start, &refused);
    return lesson_relay(r, root, code, refused.remedy, &refused);
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
    THEN(code, read_root(&(lesson_reader){file, l, root, why}));
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
    char *const texts[] = {l->path,       l->name,      l->title,    l->language,  l->question,  l->answer,
                           l->scene_path, l->ask,       l->metric,   l->reading,   l->unit,      l->which,
                           l->theory,     l->show.view, l->hand.ask, l->hand.unit, l->hand.truth};
    for (size_t i = 0; i < COUNT(texts); i++)
        free(texts[i]);
    for (int i = 0; i < l->value_count; i++) {
        free(l->value[i].name);
        free(l->value[i].formula);
    }
    for (size_t i = 0; i < l->added_count; i++)
        free(l->added[i]);
    free(l->added);
    for (size_t i = 0; i < l->setting_count; i++)
        free(l->setting[i]);
    free(l->setting);
    for (int i = 0; i < l->choice_count; i++)
        free(l->choices[i]);
    for (int i = 0; i < l->control_count; i++) {
        free(l->control[i].parameter);
        free(l->control[i].label);
        free(l->control[i].with);
        for (int k = 0; k < l->control[i].choice_count; k++)
            free(l->control[i].choices[k]);
    }
    scene_destroy(l->start);
    free(l);
}

/* --- files --- */

char *lesson_folder(void)
{
    return installed_folder("experiments/lessons");
}

static bool is_lesson(const char *name)
{
    const char *ending = strrchr(name, '.');
    return name[0] != '.' && ending && strcmp(ending, ".lesson") == 0;
}

static int by_name(const void *a, const void *b)
{
    return strcmp(*(char *const *)a, *(char *const *)b);
}

status lesson_list_find(const char *folder, lesson_list *out, diagnostic *why)
{
    *out = (lesson_list){.path = NULL};
    DIR *d = opendir(folder);
    if (!d)
        return system_error(why, STATUS_BAD_INPUT, folder, "cannot be listed", errno, "give a folder with lessons");
    status code = STATUS_OK;
    for (const struct dirent *e; code == STATUS_OK && (e = readdir(d));) {
        if (!is_lesson(e->d_name))
            continue;
        char *path = text_format("%s/%s", folder, e->d_name);
        if (path && GROW(out->path, out->room, out->count + 1))
            out->path[out->count++] = path;
        else
            free(path), code = out_of_memory(why);
    }
    closedir(d);
    if (out->count > 1)
        qsort(out->path, out->count, sizeof *out->path, by_name);
    if (code != STATUS_OK)
        lesson_list_release(out);
    return code;
}

void lesson_list_release(lesson_list *l)
{
    for (size_t i = 0; i < l->count; i++)
        free(l->path[i]);
    free(l->path);
    *l = (lesson_list){.path = NULL};
}
