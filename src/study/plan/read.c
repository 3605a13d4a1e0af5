/* Study files, YAML:
 *
 *   study: depth                     the name: folder under results/, first column of the rows
 *   title: Time by recursion depth   optional
 *   scene: scenes/rod.yaml           relative to the study file
 *   set: {render.threads: 1}         parameters of all cells, by path
 *   grid:                            a list of axes; the last one runs fastest
 *     - {render.depth: [0, 1, 2]}    one parameter
 *     - {liquid.ior: {from: 1.0, to: 2.0, steps: 5}}   evenly spaced, both ends included
 *     - name: pair                   or several together
 *       points: [{vessel.ior: 1.0, liquid.ior: 1.5}, {vessel.ior: 1.3, liquid.ior: 1.0}]
 *   reference: {render.depth: 40}    parameters of the reference image of each cell
 *   repetitions: 10                  or {min: 6, max: 20, relative_width: 0.02}, or {undisturbed: 6, max: 20}
 *   processes: 1                     fresh processes that divide the repetitions
 *   disturbed: {others_fraction: 0.05, steal_fraction: 0.01, frequency_drop: 0.1, stalled_fraction: 0.1}
 *   warmups: 1
 *   order: {shuffle: on, seed: 1}
 *   keep: {image: on, pfm: off, workers: off, pixel_rays: off, pixel_time: off, pixel_cut: off, timeline: off,
 *   metrics: off, curves: off, motion: off}
 *
 * Reading tries every path and value on the scene, so that a study that was read can be run. */
#include "base/file.h"
#include "base/installed.h"
#include "base/number.h"
#include "base/text.h"
#include "scene/data/document.h"
#include "study/plan/grid.h"
#include "study/plan/identity.h"
#include "study/plan/keep.h"
#include <libgen.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { FILE_BYTES_MAX = 1 << 20, NAME_MAX_LENGTH = 64, TITLE_MAX_LENGTH = 200 };

#define COUNT(array) (sizeof(array) / sizeof((array)[0]))

/* Whether the text is an integer, possibly with too many digits for a number. */
static bool only_digits(const char *text)
{
    text += *text == '-' || *text == '+';
    return *text && text[strspn(text, "0123456789")] == 0;
}

/* A missing node leaves *out unchanged. */
static status read_integer(const document *d, const node *n, const char *key, int64_t lowest, int64_t highest,
                           int64_t *out, diagnostic *why)
{
    if (!n)
        return STATUS_OK;
    char remedy[128];
    snprintf(remedy, sizeof remedy, "write an integer from %lld to %lld", (long long)lowest, (long long)highest);
    bool is_integer = n->kind == NODE_SCALAR && number_parse_int(n->text, out);
    if (is_integer && *out >= lowest && *out <= highest)
        return STATUS_OK;
    if (n->kind != NODE_SCALAR)
        return node_error(d, n, why, remedy, "%s is not a number", key);
    if (is_integer || only_digits(n->text))
        return node_error(d, n, why, remedy, "%s: %.64s is out of range", key, n->text);
    return node_error(d, n, why, remedy, "%s: '%.64s' is not an integer", key, n->text);
}

/* A missing node leaves *out unchanged. */
static status read_switch(const document *d, const node *n, const char *key, bool *out, diagnostic *why)
{
    if (!n)
        return STATUS_OK;
    static const char *const words[] = {"off", "on", "false", "true", "no", "yes"};
    for (size_t i = 0; n->kind == NODE_SCALAR && i < COUNT(words); i++)
        if (strcmp(n->text, words[i]) == 0) {
            *out = i & 1;
            return STATUS_OK;
        }
    return node_error(d, n, why, "write on or off", "%s is neither on nor off", key);
}

/* Whether the text is a file name that needs no quoting and is not a reserved folder of results. */
static bool is_valid_name(const char *name)
{
    static const char *const reserved[] = {"figures", "tables", "reference", "quick"};
    for (size_t i = 0; i < COUNT(reserved); i++)
        if (strcmp(name, reserved[i]) == 0)
            return false;
    size_t length = strspn(name, "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_");
    return length > 0 && length <= NAME_MAX_LENGTH && !name[length] && name[0] != '-';
}

static status read_names(study *s, const document *d, const node *root, diagnostic *why)
{
    const node *name = node_get(root, "study"), *title = node_get(root, "title");
    if (!name)
        return node_error(d, root, why, "add a line study: NAME", "the study has no name");
    if (name->kind != NODE_SCALAR || !is_valid_name(name->text))
        return node_error(d, name, why, "use 1 to 64 letters, digits, - and _; not figures, tables, reference or quick",
                          "invalid name of a study");
    if (title &&
        (title->kind != NODE_SCALAR || strlen(title->text) > TITLE_MAX_LENGTH || !read_grid_plain(title->text)))
        return node_error(d, title, why, "write one line of at most 200 characters", "this is not a title");
    s->name = strdup(name->text);
    s->title = strdup(title ? title->text : name->text);
    return s->name && s->title ? STATUS_OK : out_of_memory(why);
}

/* From six repetitions on the median has a 95% interval (measure/statistics.h). */
enum { REPETITIONS_DEFAULT = 6 };

/* {min: 6, max: 20, relative_width: 0.02} */
static status read_interval_rule(study *s, const document *d, const node *n, diagnostic *why)
{
    static const char *const keys[] = {"min", "max", "relative_width"};
    status code = node_check_keys(d, n, keys, COUNT(keys), why);
    const node *min = node_get(n, "min"), *max = node_get(n, "max"), *width = node_get(n, "relative_width");
    int64_t least = 0, most = 0;
    THEN(code, read_integer(d, min, "min", 2, STUDY_REPETITIONS_MAX, &least, why));
    THEN(code, read_integer(d, max, "max", 2, STUDY_REPETITIONS_MAX, &most, why));
    if (code != STATUS_OK)
        return code;
    if (min && max && most < least)
        return node_error(d, max, why, "set max to at least min", "max %lld is less than min %lld", (long long)most,
                          (long long)least);
    for (size_t i = 0; i < COUNT(keys); i++)
        if (!node_get(n, keys[i]))
            return node_error(d, n, why, "write {min: 6, max: 20, relative_width: 0.02}, or a single number",
                              "repetitions has no %s", keys[i]);
    double fraction;
    if (width->kind != NODE_SCALAR || !number_parse_real(width->text, &fraction))
        return node_error(d, width, why, "write a number from 0 to 1", "relative_width is not a number");
    if (fraction < 0 || fraction > 1)
        return node_error(d, width, why, "write a number from 0 to 1", "relative_width: %.64s is out of range",
                          width->text);
    s->repetitions_min = (long)least;
    s->repetitions_max = (long)most;
    s->relative_width = fraction;
    return STATUS_OK;
}

/* {undisturbed: 6, max: 20} */
static status read_undisturbed(study *s, const document *d, const node *n, diagnostic *why)
{
    static const char *const keys[] = {"undisturbed", "max"};
    const node *max = node_get(n, "max");
    int64_t least = 0, most = 0;
    TRY(node_check_keys(d, n, keys, COUNT(keys), why));
    TRY(read_integer(d, node_get(n, "undisturbed"), "undisturbed", 1, STUDY_REPETITIONS_MAX, &least, why));
    if (!max)
        return node_error(d, n, why, "write {undisturbed: 6, max: 20}", "repetitions has no max");
    TRY(read_integer(d, max, "max", 1, STUDY_REPETITIONS_MAX, &most, why));
    if (most < least)
        return node_error(d, max, why, "set max to at least undisturbed", "max %lld is less than undisturbed %lld",
                          (long long)most, (long long)least);
    s->repetitions_min = s->undisturbed = (long)least;
    s->repetitions_max = (long)most;
    return STATUS_OK;
}

static status read_repetitions(study *s, const document *d, const node *n, diagnostic *why)
{
    int64_t value = REPETITIONS_DEFAULT;
    if (n && n->kind == NODE_MAP)
        return node_get(n, "undisturbed") ? read_undisturbed(s, d, n, why) : read_interval_rule(s, d, n, why);
    status code = read_integer(d, n, "repetitions", 1, STUDY_REPETITIONS_MAX, &value, why);
    s->repetitions_min = s->repetitions_max = (long)value;
    return code;
}

static status read_fraction(const document *d, const node *n, const char *name, double *out, diagnostic *why)
{
    if (!n)
        return STATUS_OK;
    if (n->kind != NODE_SCALAR || !number_parse_real(n->text, out) || *out < 0 || *out > 1)
        return node_error(d, n, why, "write a number from 0 to 1", "%s is not a fraction", name);
    return STATUS_OK;
}

/* {others_fraction: 0.05, steal_fraction: 0.01, frequency_drop: 0.1, stalled_fraction: 0.1} */
static status read_noise_rule(study *s, const document *d, const node *n, diagnostic *why)
{
    static const char *const keys[] = {"others_fraction", "steal_fraction", "frequency_drop", "stalled_fraction"};
    s->disturbed = noise_rule_default();
    if (!n)
        return STATUS_OK;
    if (n->kind != NODE_MAP)
        return node_error(d, n, why, "write {others_fraction: 0.05}", "disturbed is not a map");
    double *const parts[] = {&s->disturbed.others_fraction, &s->disturbed.steal_fraction, &s->disturbed.frequency_drop,
                             &s->disturbed.stalled_fraction};
    TRY(node_check_keys(d, n, keys, COUNT(keys), why));
    for (size_t i = 0; i < COUNT(keys); i++) {
        *parts[i] = NAN;
        TRY(read_fraction(d, node_get(n, keys[i]), keys[i], parts[i], why));
    }
    return STATUS_OK;
}

static status read_processes(study *s, const document *d, const node *n, diagnostic *why)
{
    int64_t value = 1;
    TRY(read_integer(d, n, "processes", 1, STUDY_PROCESSES_MAX, &value, why));
    if (value > s->repetitions_min)
        return node_error(d, n, why, "use at most as many processes as repetitions",
                          "%lld processes are more than the %ld repetitions", (long long)value, s->repetitions_min);
    s->processes = (long)value;
    return STATUS_OK;
}

static status read_order(study *s, const document *d, const node *warmups, const node *order, diagnostic *why)
{
    static const char *const keys[] = {"shuffle", "seed"};
    int64_t count = 1, seed = 1;
    status code = read_integer(d, warmups, "warmups", 0, STUDY_WARMUPS_MAX, &count, why);
    s->warmups = (long)count;
    s->shuffle = true;
    s->seed = 1;
    if (code != STATUS_OK || !order)
        return code;
    if (order->kind != NODE_MAP)
        return node_error(d, order, why, "write {shuffle: on, seed: 1}", "order is not a map");
    code = node_check_keys(d, order, keys, COUNT(keys), why);
    THEN(code, read_switch(d, node_get(order, "shuffle"), "shuffle", &s->shuffle, why));
    THEN(code, read_integer(d, node_get(order, "seed"), "seed", 0, INT64_MAX, &seed, why));
    s->seed = (uint64_t)seed;
    return code;
}

static status read_keep(study *s, const document *d, const node *n, diagnostic *why)
{
    static const char *const keys[] = {"image",     "pfm",      "workers", "pixel_rays", "pixel_time",
                                       "pixel_cut", "timeline", "metrics", "curves",     "motion"};
    bool *const kept[] = {&s->keep_image,      &s->keep_pfm,       &s->keep_workers,  &s->keep_pixel_rays,
                          &s->keep_pixel_time, &s->keep_pixel_cut, &s->keep_timeline, &s->keep_metrics,
                          &s->keep_curves,     &s->keep_motion};
    if (!n)
        return STATUS_OK;
    if (n->kind != NODE_MAP)
        return node_error(d, n, why, "write {image: on}", "keep is not a map");
    TRY(node_check_keys(d, n, keys, COUNT(keys), why));
    for (size_t i = 0; i < COUNT(keys); i++)
        TRY(read_switch(d, node_get(n, keys[i]), keys[i], kept[i], why));
    return STATUS_OK;
}

/* An error is located at the key of the table. */
static status check_kept(const study *s, const node *keep, diagnostic *why)
{
    const char *key;
    const status code = keep_check_tables(s, &key, why);
    const node *at = node_get(keep, key);
    if (code == STATUS_BAD_INPUT && at)
        diagnostic_locate(why, s->path, at->line, at->column);
    return code;
}

/* Reads the scene file: its text, for runs.json, and its model. Errors in it name the scene file. */
static status read_scene(study *s, const document *d, const node *root, const study_guard *guard, diagnostic *why)
{
    const node *n = node_get(root, "scene");
    if (!n)
        return node_error(d, root, why, "add a line scene: FILE, relative to this file", "the study has no scene");
    if (n->kind != NODE_SCALAR || !n->text[0] || !read_grid_plain(n->text))
        return node_error(d, n, why, "write the path of a scene file, relative to this file",
                          "this is not a file name");
    char *copy = strdup(s->path);
    if (!copy)
        return out_of_memory(why);
    const char *folder = dirname(copy);
    const bool as_is = n->text[0] == '/' || strcmp(folder, ".") == 0;
    s->scene_path = text_format("%s%s%s", as_is ? "" : folder, as_is ? "" : "/", n->text);
    free(copy);
    if (!s->scene_path)
        return out_of_memory(why);
    diagnostic refused = {.what = ""};
    const status allowed = guard ? guard->may_open(guard->context, s->scene_path, &refused) : STATUS_OK;
    if (allowed != STATUS_OK) {
        node_error(d, n, why, refused.remedy, "%s", refused.what);
        return allowed;
    }
    struct stat found;
    if (stat(s->scene_path, &found) != 0 || !S_ISREG(found.st_mode) || access(s->scene_path, R_OK) != 0) {
        node_error(d, n, why, "give an existing scene file, relative to this file", "scene %s cannot be read",
                   s->scene_path);
        if (!guard)
            installed_suggest(s->scene_path, "experiments/scenes", ".yaml", why);
        return STATUS_BAD_INPUT;
    }
    size_t size;
    const char *below = guard ? guard->root : NULL;
    TRY(file_read_below(s->scene_path, below, FILE_BYTES_MAX, &s->scene_text, &size, why));
    TRY(scene_read_text(s->scene_path, s->scene_text, size, &s->base, why));
    return scene_limit(s->base, below, 0, why);
}

static status check_loads(void *context, const study *s, size_t cell, scene *setting, diagnostic *why)
{
    const study_guard *guard = context;
    scene *reference = NULL;
    status code = guard->may_load(guard->context, setting, why);
    if (code == STATUS_OK && s->reference.count && (code = reference_scene(s, cell, &reference, why)) == STATUS_OK)
        code = guard->may_load(guard->context, reference, why);
    scene_destroy(reference);
    return code;
}

/* fitted: the study must have a section `fit`, which study/fit reads; else it must not. */
static status read_root(study *s, const document *d, const study_guard *guard, bool fitted, diagnostic *why)
{
    static const char *const keys[] = {"study",       "title",     "scene",     "set",     "grid",  "reference",
                                       "repetitions", "processes", "disturbed", "warmups", "order", "keep"};
    static const char *const fit_keys[] = {"study", "title", "scene", "set", "fit"};
    const node *root = document_root(d);
    if (!root || root->kind != NODE_MAP) {
        if (root)
            return node_error(d, root, why, "begin with study: NAME and scene: FILE", "this is not a study");
        diagnostic_locate(why, s->path, 1, 1);
        return diagnose(why, STATUS_BAD_INPUT, "begin with study: NAME and scene: FILE", "the study is empty");
    }
    if (fitted && !node_get(root, "fit"))
        return node_error(d, root, why, "add it, see cuvette-study(5); run other studies with 'cuvette study run'",
                          "the study has no section fit");
    if (!fitted && node_get(root, "fit"))
        return node_error(d, node_get(root, "fit"), why, "run it with 'cuvette fit'", "this study is a fit");
    TRY(node_check_keys(d, root, fitted ? fit_keys : keys, fitted ? COUNT(fit_keys) : COUNT(keys), why));
    TRY(read_names(s, d, root, why));
    TRY(read_repetitions(s, d, node_get(root, "repetitions"), why));
    TRY(read_noise_rule(s, d, node_get(root, "disturbed"), why));
    TRY(read_processes(s, d, node_get(root, "processes"), why));
    TRY(read_order(s, d, node_get(root, "warmups"), node_get(root, "order"), why));
    TRY(read_keep(s, d, node_get(root, "keep"), why));
    TRY(read_scene(s, d, root, guard, why));
    TRY(read_grid(s, d, node_get(root, "set"), node_get(root, "grid"), why));
    TRY(read_reference(s, d, node_get(root, "reference"), why));
    TRY(grid_check_cells(s, why));
    TRY(reference_check(s, why));
    TRY(check_kept(s, node_get(root, "keep"), why));
    if (guard) {
        TRY(guard->may_load(guard->context, s->base, why));
        TRY(grid_each_cell(s, check_loads, (void *)(uintptr_t)guard, why));
    }
    TRY(scene_load_files(s->base, why)); /* the contents of its files are part of identities */
    return identities_find(s, &s->identity, why);
}

void study_point_release(study_point *point)
{
    for (size_t i = 0; i < point->count; i++) {
        free(point->paths[i]);
        free(point->values[i]);
    }
    free(point->paths);
    free(point->values);
    *point = (study_point){0};
}

void study_destroy(study *s)
{
    if (!s)
        return;
    for (size_t axis = 0; axis < s->axis_count; axis++) {
        for (size_t i = 0; i < s->axes[axis].count; i++)
            study_point_release(&s->axes[axis].points[i]);
        free(s->axes[axis].points);
        free(s->axes[axis].name);
    }
    free(s->axes);
    study_point_release(&s->fixed);
    study_point_release(&s->reference);
    free(s->path);
    free(s->name);
    free(s->title);
    free(s->scene_path);
    free(s->text);
    free(s->scene_text);
    scene_destroy(s->base);
    free(s->identity);
    free(s->notes);
    free(s);
}

/* fit: receives the document of a study with a section `fit`; NULL for other studies. */
static status read_text(const char *name, const char *text, size_t size, const study_guard *guard, document **fit,
                        study **out, diagnostic *why)
{
    *out = NULL;
    study *s = calloc(1, sizeof *s);
    document *d = NULL;
    status code = s && (s->path = strdup(name)) && (s->text = strndup(text, size))
                      ? document_parse(name, text, size, &d, why)
                      : out_of_memory(why);
    THEN(code, read_root(s, d, guard, fit != NULL, why));
    if (fit && code == STATUS_OK)
        *fit = d;
    else
        document_destroy(d);
    if (code == STATUS_OK)
        *out = s;
    else
        study_destroy(s);
    return code;
}

status study_read_text(const char *name, const char *text, size_t size, study **out, diagnostic *why)
{
    return read_text(name, text, size, NULL, NULL, out, why);
}

status study_read_text_guarded(const char *name, const char *text, size_t size, const study_guard *guard, study **out,
                               diagnostic *why)
{
    return read_text(name, text, size, guard, NULL, out, why);
}

static status read_file(const char *path, const study_guard *guard, document **fit, study **out, diagnostic *why)
{
    char *text;
    size_t size;
    *out = NULL;
    status code = file_read_below(path, guard ? guard->root : NULL, FILE_BYTES_MAX, &text, &size, why);
    if (code != STATUS_OK) {
        if (!guard)
            installed_suggest(path, "experiments", ".study", why);
        return code;
    }
    code = read_text(path, text, size, guard, fit, out, why);
    free(text);
    return code;
}

status study_read_guarded(const char *path, const study_guard *guard, study **out, diagnostic *why)
{
    return read_file(path, guard, NULL, out, why);
}

status study_read_fit(const char *path, study **out, document **d, diagnostic *why)
{
    *d = NULL;
    return read_file(path, NULL, d, out, why);
}

status study_read_fit_text(const char *name, const char *text, size_t size, study **out, document **d, diagnostic *why)
{
    *d = NULL;
    return read_text(name, text, size, NULL, d, out, why);
}

status study_read(const char *path, study **out, diagnostic *why)
{
    return study_read_guarded(path, NULL, out, why);
}

status study_make_quick(study *s, diagnostic *why)
{
    s->quick = true;
    s->repetitions_min = s->repetitions_max = s->processes = 1;
    s->relative_width = 0;
    s->undisturbed = s->warmups = 0;
    free(s->identity);
    s->identity = NULL;
    return identities_find(s, &s->identity, why);
}
