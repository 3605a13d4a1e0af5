/* The section `fit` of a study file:
 *
 *   fit:
 *     parameters:                      what is varied: numbers of the parameter table
 *       liquid.ior: {from: 1.2, to: 1.6, start: 1.4}
 *       bend:                          or a name that sets several, to offset + factor x, or to the reciprocal
 *         {from: -0.02, to: 0.02, start: 0, reciprocal: on, sets: {front.radius_1: 1, back.radius_2: [0.01, -1]}}
 *     targets:                         columns: measured quantities and what they should be
 *       edges.left: {value: 312.5, sigma: 0.1}
 *       colour: {quantity: focus, beam: blue, minus: {quantity: focus, beam: red}, value: 0, weight: 4}
 *     minimise: {quantity: spot_rms, beam: [axis, edge]}    or maximise; instead of targets
 *     screen: {position: [0, 97, 0], normal: [0, 1, 0]}     of quantities of beams
 *     method: [direct, nelder-mead]    evaluations: 500    precision: 1e-9    step: 1e-4    worsening: 1    seed: 1
 *     interval: profile                or linear */
#include "base/array.h"
#include "base/hash.h"
#include "base/number.h"
#include "scene/model/params.h"
#include "scene/model/scene.h"
#include "study/fit/fit.h"
#include "study/plan/grid.h"
#include "study/plan/identity.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define COUNT(array) (sizeof(array) / sizeof((array)[0]))

const char *const fit_method_words[FIT_METHOD_COUNT] = {"nelder-mead", "sbplx",  "bobyqa", "cobyla",
                                                        "damped",      "direct", "crs"};

static status located(const fit_reading *r, const node *at, status code)
{
    if (code != STATUS_OK)
        diagnostic_locate(r->why, document_name(r->d), at->line, at->column);
    return code;
}

/* --- parameters --- */

static status check_path(const fit_reading *r, const node *at, const char *path)
{
    param_place place;
    TRY(located(r, at, param_place_find(r->f->s->base, path, &place, r->why)));
    const param_type type = place.row ? place.row->type : PARAM_WORD;
    if (type != PARAM_REAL && !((type == PARAM_VECTOR || type == PARAM_COLOR) && place.element >= 0))
        return WRONG(r, at, "choose a parameter with a real number, such as an index, or a position.x",
                     "%.64s is not a real number", path);
    return fit_check_unset(r, at, path);
}

static status add_drive(const fit_reading *r, fit_parameter *p, const node *at, double offset, double factor)
{
    TRY(check_path(r, at, at->text));
    if (!room_for_one(&p->drives, p->drive_count, sizeof *p->drives))
        return out_of_memory(r->why);
    p->drives[p->drive_count] = (fit_drive){strdup(at->text), offset, factor};
    return p->drives[p->drive_count++].path ? STATUS_OK : out_of_memory(r->why);
}

static status read_drives(const fit_reading *r, fit_parameter *p, const node *name, const node *sets)
{
    if (!sets)
        return add_drive(r, p, name, 0.0, 1.0);
    TRY(fit_check_map(r, sets, "sets", "write {path: factor} or {path: [offset, factor]}", NULL, 0));
    for (size_t i = 0; i < sets->count; i++) {
        const node *n = sets->items[i];
        double v[2] = {0.0, 1.0};
        if (n->kind == NODE_SCALAR && !number_parse_real(n->text, &v[1]))
            return WRONG(r, n, "write a factor, or [offset, factor]", "this is not a number");
        if (n->kind != NODE_SCALAR)
            TRY(fit_read_reals(r, n, "this", 2, v));
        if (v[1] == 0.0)
            return WRONG(r, n, "write a factor that is not 0", "with the factor 0 the parameter does nothing");
        TRY(add_drive(r, p, sets->keys[i], v[0], v[1]));
    }
    return STATUS_OK;
}

/* The scene's value if the parameter sets one path directly, and it is between the bounds; else the middle. */
static status find_start(const fit *f, fit_parameter *p, diagnostic *why)
{
    double value = NAN;
    const bool direct = p->drive_count == 1 && p->drives[0].offset == 0.0 && p->drives[0].factor == 1.0;
    if (direct && !p->reciprocal) {
        char *text = NULL;
        TRY(scene_get(f->s->base, p->drives[0].path, &text, why));
        number_parse_real(text, &value);
        free(text);
    }
    p->start = value >= p->from && value <= p->to ? value : 0.5 * (p->from + p->to);
    return STATUS_OK;
}

/* Both ends of its range must be allowed values. */
static status check_ends(const fit_reading *r, size_t parameter, const node *map)
{
    fit *f = r->f;
    const double ends[2] = {f->parameters[parameter].from, f->parameters[parameter].to};
    for (int i = 0; i < 2; i++) {
        double x[FIT_PARAMETERS_MAX];
        scene *s = NULL;
        for (size_t k = 0; k <= parameter; k++)
            x[k] = k == parameter ? ends[i] : f->parameters[k].start;
        const status code = fit_scene(f, x, 0, &s, r->why);
        scene_destroy(s);
        TRY(located(r, node_get(map, i ? "to" : "from"), code));
    }
    return STATUS_OK;
}

/* *out: whether it is the first word; unchanged if it is missing. */
static status read_either(const fit_reading *r, const node *map, const char *key, const char *first, const char *second,
                          bool *out)
{
    const node *n = node_get(map, key);
    char remedy[64];
    if (!n)
        return STATUS_OK;
    snprintf(remedy, sizeof remedy, "write %s or %s", first, second);
    *out = n->kind == NODE_SCALAR && strcmp(n->text, first) == 0;
    return *out || (n->kind == NODE_SCALAR && strcmp(n->text, second) == 0)
               ? STATUS_OK
               : WRONG(r, n, remedy, "%s is neither %s nor %s", key, first, second);
}

static status read_parameter(const fit_reading *r, const node *name, const node *map)
{
    static const char *const keys[] = {"from", "to", "start", "sets", "reciprocal"};
    fit *f = r->f;
    TRY(fit_check_map(r, map, name->text, "write {from: 1.2, to: 1.6, start: 1.4}", keys, COUNT(keys)));
    TRY(fit_check_column(r, name));
    if (f->parameter_count == FIT_PARAMETERS_MAX)
        return WRONG(r, name, "use at most 16 parameters", "the fit has more than %d parameters", FIT_PARAMETERS_MAX);
    const size_t index = f->parameter_count++;
    fit_parameter *p = &f->parameters[index];
    if (!(p->name = strdup(name->text)))
        return out_of_memory(r->why);
    for (int i = 0; i < 2; i++) {
        if (!node_get(map, i ? "to" : "from"))
            return WRONG(r, map, "write {from: 1.2, to: 1.6, start: 1.4}", "the parameter has no '%s'",
                         i ? "to" : "from");
        TRY(fit_read_real(r, map, i ? "to" : "from", -1e300, 1e300, i ? &p->to : &p->from));
    }
    if (!(p->from < p->to))
        return WRONG(r, map, "set from to less than to", "from %g is not less than to %g", p->from, p->to);
    TRY(read_either(r, map, "reciprocal", "on", "off", &p->reciprocal));
    TRY(read_drives(r, p, name, node_get(map, "sets")));
    TRY(find_start(f, p, r->why));
    TRY(fit_read_real(r, map, "start", p->from, p->to, &p->start));
    return check_ends(r, index, map);
}

/* --- the search --- */

static status read_stages(const fit_reading *r, const node *n)
{
    fit *f = r->f;
    const size_t count = n && n->kind == NODE_LIST ? n->count : 1;
    f->stages[0] = f->parameter_count > 1 ? FIT_BOBYQA : FIT_NELDER_MEAD;
    f->stage_count = count < FIT_STAGES_MAX ? count : FIT_STAGES_MAX;
    for (size_t i = 0; n && i < f->stage_count; i++) {
        const node *word = n->kind == NODE_LIST ? n->items[i] : n;
        int which = 0;
        while (which < FIT_METHOD_COUNT &&
               (word->kind != NODE_SCALAR || strcmp(word->text, fit_method_words[which]) != 0))
            which++;
        if (which == FIT_METHOD_COUNT)
            return WRONG(r, word, "use nelder-mead, sbplx, bobyqa, cobyla, damped, direct or crs, or a list of them",
                         "unknown method");
        if (which == FIT_BOBYQA && f->parameter_count < 2)
            return WRONG(r, word, "use nelder-mead or cobyla", "bobyqa needs two parameters");
        if (which == FIT_DAMPED && f->goal != FIT_TARGETS)
            return WRONG(r, word, "use another method, or targets", "damped least squares needs targets");
        f->stages[i] = (fit_method)which;
    }
    return count >= 1 && count <= FIT_STAGES_MAX ? STATUS_OK
                                                 : WRONG(r, n, "give 1 to 8 methods", "invalid list of methods");
}

/* Integers below 2^53 are exact as doubles. */
static status read_count(const fit_reading *r, const node *root, const char *key, double least, double most,
                         double *out)
{
    TRY(fit_read_real(r, root, key, least, most, out));
    return *out == floor(*out) ? STATUS_OK
                               : WRONG(r, node_get(root, key), "write an integer", "%s is not an integer", key);
}

static status read_search(const fit_reading *r, const node *root)
{
    fit *f = r->f;
    double evaluations = 2000, seed = 1;
    f->precision = 1e-9, f->step = 1e-4;
    TRY(read_stages(r, node_get(root, "method")));
    TRY(read_count(r, root, "evaluations", 1, FIT_EVALUATIONS_MAX, &evaluations));
    TRY(read_count(r, root, "seed", 0, 4294967295.0, &seed));
    TRY(fit_read_real(r, root, "precision", 1e-15, 0.1, &f->precision));
    TRY(fit_read_real(r, root, "step", 1e-9, 0.1, &f->step));
    TRY(fit_read_real(r, root, "worsening", 1e-300, 1e300, &f->worsening));
    TRY(read_either(r, root, "interval", "linear", "profile", &f->linear));
    if (node_get(root, "interval") && f->goal != FIT_TARGETS)
        return WRONG(r, node_get(root, "interval"), "remove it", "only targets give intervals");
    f->evaluations = (long)evaluations;
    f->seed = (uint64_t)seed;
    return STATUS_OK;
}

/* --- the section --- */

static status read_goal(const fit_reading *r, const node *root)
{
    static const char *const words[] = {"targets", "minimise", "maximise"};
    const node *chosen = NULL;
    for (size_t i = 0; i < COUNT(words); i++) {
        const node *n = node_get(root, words[i]);
        if (n && chosen)
            return WRONG(r, n, "use one of targets, minimise and maximise", "the fit has two goals");
        if (n)
            chosen = n, r->f->goal = (fit_goal)i;
    }
    if (!chosen)
        return WRONG(r, root, "add targets: {edges.left: {value: 312.5, sigma: 0.1}}, or minimise: spot_rms",
                     "the fit has no goal");
    if (r->f->goal != FIT_TARGETS)
        return fit_read_extreme(r, chosen);
    TRY(fit_check_map(r, chosen, "targets", "write {edges.left: {value: 312.5, sigma: 0.1}}", NULL, 0));
    for (size_t i = 0; i < chosen->count; i++)
        TRY(fit_read_target(r, chosen->keys[i], chosen->items[i]));
    return STATUS_OK;
}

static status read_section(fit_reading *r, const node *root)
{
    static const char *const keys[] = {"parameters",  "targets",   "minimise", "maximise",  "screen", "method",
                                       "evaluations", "precision", "step",     "worsening", "seed",   "interval"};
    const char *const form = "write {liquid.ior: {from: 1.2, to: 1.6, start: 1.4}}";
    r->f->setting_count = 1;
    TRY(fit_check_map(r, root, "fit", "write parameters: and targets: below it", keys, COUNT(keys)));
    TRY(fit_read_screen(r, node_get(root, "screen"), &r->at, &r->normal));
    const node *parameters = node_get(root, "parameters");
    if (!parameters)
        return WRONG(r, root, "add parameters: {liquid.ior: {from: 1.2, to: 1.6, start: 1.4}}",
                     "the fit has no parameters");
    TRY(fit_check_map(r, parameters, "parameters", form, NULL, 0));
    for (size_t i = 0; i < parameters->count; i++)
        TRY(read_parameter(r, parameters->keys[i], parameters->items[i]));
    TRY(read_goal(r, root));
    return read_search(r, root);
}

/* --- identity --- */

static void hash_text(uint64_t *hash, const char *text)
{
    *hash = hash_bytes(*hash, text ? text : "", strlen(text ? text : "") + 1);
}

/* Identities of scenes leave out beams, on which no film depends. */
static status hash_beam(void *context, const char *path, const param *row, const char *value)
{
    if (row->group == PARAM_BEAM) {
        hash_text(context, path);
        hash_text(context, value);
    }
    return STATUS_OK;
}

static void hash_measure(uint64_t *hash, const fit *f, const fit_measure *m)
{
    const study_point *set = &f->settings[m->setting];
    const double numbers[] = {m->pixel[0], m->pixel[1], m->channel,  m->lambda_nm, m->at.x,
                              m->at.y,     m->at.z,     m->normal.x, m->normal.y,  m->normal.z};
    hash_text(hash, m->name);
    *hash = hash_words(*hash, numbers, COUNT(numbers));
    if (m->beams)
        *hash = hash_words(*hash, m->beams, f->s->base->beam_count / 64 + 1);
    for (size_t i = 0; i < set->count; i++) {
        hash_text(hash, set->paths[i]);
        hash_text(hash, set->values[i]);
    }
}

static status find_identity(fit *f, diagnostic *why)
{
    uint64_t hash = 0;
    if (reference_scene_hash(f->s->base, &hash) != STATUS_OK ||
        scene_each_param(f->s->base, hash_beam, &hash) != STATUS_OK)
        return out_of_memory(why);
    for (size_t i = 0; i < f->parameter_count; i++) {
        const fit_parameter *p = &f->parameters[i];
        hash_text(&hash, p->name);
        for (size_t k = 0; k < p->drive_count; k++) {
            const double numbers[] = {p->drives[k].offset, p->drives[k].factor, p->reciprocal};
            hash_text(&hash, p->drives[k].path);
            hash = hash_words(hash, numbers, COUNT(numbers));
        }
    }
    for (size_t i = 0; i < f->target_count; i++) {
        hash_text(&hash, f->targets[i].name);
        hash_measure(&hash, f, &f->targets[i].of);
        if (f->targets[i].has_minus)
            hash_measure(&hash, f, &f->targets[i].minus);
    }
    f->identity = hash_finish(hash);
    return STATUS_OK;
}

/* --- fits --- */

static void release_measure(fit_measure *m)
{
    free(m->name);
    free(m->beams);
}

void fit_destroy(fit *f)
{
    if (!f)
        return;
    for (size_t i = 0; i < f->parameter_count; i++) {
        for (size_t k = 0; k < f->parameters[i].drive_count; k++)
            free(f->parameters[i].drives[k].path);
        free(f->parameters[i].drives);
        free(f->parameters[i].name);
    }
    for (size_t i = 0; i < f->target_count; i++) {
        free(f->targets[i].name);
        release_measure(&f->targets[i].of);
        release_measure(&f->targets[i].minus);
    }
    for (size_t i = 0; i < f->setting_count; i++)
        study_point_release(&f->settings[i]);
    study_destroy(f->s);
    free(f);
}

/* text: NULL to read the file `name`. */
static status read_fit(const char *name, const char *text, size_t size, fit **out, diagnostic *why)
{
    document *d = NULL;
    *out = NULL;
    fit *f = calloc(1, sizeof *f);
    if (!f)
        return out_of_memory(why);
    status code = text ? study_read_fit_text(name, text, size, &f->s, &d, why) : study_read_fit(name, &f->s, &d, why);
    if (code == STATUS_OK) {
        fit_reading r = {.f = f, .d = d, .at = {NAN, NAN, NAN}, .why = why};
        code = read_section(&r, node_get(document_root(d), "fit"));
        THEN(code, find_identity(f, why));
    }
    document_destroy(d);
    if (code == STATUS_OK)
        *out = f;
    else
        fit_destroy(f);
    return code;
}

status fit_read(const char *path, fit **out, diagnostic *why)
{
    return read_fit(path, NULL, 0, out, why);
}

status fit_read_text(const char *name, const char *text, size_t size, fit **out, diagnostic *why)
{
    return read_fit(name, text, size, out, why);
}
