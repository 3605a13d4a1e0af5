/* The quantities of a fit, and what they should be. */
#include "base/number.h"
#include "realism/realism.h"
#include "scene/model/params.h"
#include "scene/model/scene.h"
#include "study/fit/fit.h"
#include "study/plan/grid.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define COUNT(array) (sizeof(array) / sizeof((array)[0]))

const char *const fit_beam_words[FIT_BEAM_QUANTITY_COUNT] = {
    "focus", "focus_rms", "focal_length", "power", "spot_rms", "spot_radius", "spot_u", "spot_v", "received"};

/* --- values and names, also for read.c --- */

/* A missing node leaves *out unchanged. */
status fit_read_real(const fit_reading *r, const node *map, const char *key, double least, double most, double *out)
{
    const node *n = node_get(map, key);
    char remedy[96];
    if (!n)
        return STATUS_OK;
    snprintf(remedy, sizeof remedy, "write a number from %g to %g", least, most);
    if (n->kind != NODE_SCALAR || !number_parse_real(n->text, out))
        return WRONG(r, n, remedy, "%s is not a number", key);
    return *out >= least && *out <= most ? STATUS_OK : WRONG(r, n, remedy, "%s: %.64s is out of range", key, n->text);
}

status fit_read_reals(const fit_reading *r, const node *n, const char *what, size_t count, double *out)
{
    bool good = n->kind == NODE_LIST && n->count == count;
    for (size_t i = 0; good && i < count; i++)
        good = n->items[i]->kind == NODE_SCALAR && number_parse_real(n->items[i]->text, &out[i]);
    return good ? STATUS_OK
                : WRONG(r, n, count == 3 ? "write three numbers: [0, 97, 0]" : "write two numbers: [0, -1]",
                        "%s is not a list of %zu numbers", what, count);
}

status fit_check_map(const fit_reading *r, const node *n, const char *what, const char *form, const char *const *keys,
                     size_t count)
{
    if (n->kind != NODE_MAP || n->count == 0)
        return WRONG(r, n, form, "%s is not a map", what);
    return keys ? node_check_keys(r->d, n, keys, count, r->why) : STATUS_OK;
}

/* Names become columns. */
static bool is_column(const char *name)
{
    static const char *const taken[] = {"study", "fit", "evaluation", "stage", "merit", "build", "checksum"};
    bool good = name[0] && strlen(name) <= 64 && read_grid_plain(name) && !strpbrk(name, ",;\"");
    for (size_t i = 0; i < COUNT(taken); i++)
        good = good && strcmp(name, taken[i]) != 0;
    return good;
}

status fit_check_column(const fit_reading *r, const node *at)
{
    if (!is_column(at->text))
        return WRONG(r, at, "use another name of at most 64 characters, without commas, semicolons and quotes",
                     "'%.64s' cannot be the name of a column", at->text);
    for (size_t i = 0; i < r->f->parameter_count; i++)
        if (r->f->parameters[i].name && strcmp(r->f->parameters[i].name, at->text) == 0)
            return WRONG(r, at, "use another name", "%.64s is already a parameter of the fit", at->text);
    return STATUS_OK;
}

status fit_check_unset(const fit_reading *r, const node *at, const char *path)
{
    for (size_t i = 0; i < r->f->s->fixed.count; i++)
        if (strcmp(r->f->s->fixed.paths[i], path) == 0)
            return WRONG(r, at, "remove it from set or from the fit", "%.64s is already set for the whole study", path);
    for (size_t i = 0; i < r->f->parameter_count; i++)
        for (size_t k = 0; k < r->f->parameters[i].drive_count; k++)
            if (strcmp(r->f->parameters[i].drives[k].path, path) == 0)
                return WRONG(r, at, "let one parameter set it", "%.64s is already set by the parameter %.64s", path,
                             r->f->parameters[i].name);
    return STATUS_OK;
}

/* --- quantities --- */

static status read_vector(const fit_reading *r, const node *n, const char *what, vec3 *out)
{
    double v[3];
    TRY(fit_read_reals(r, n, what, 3, v));
    *out = vec3_make(v[0], v[1], v[2]);
    return STATUS_OK;
}

status fit_read_screen(const fit_reading *r, const node *screen, vec3 *at, vec3 *normal)
{
    static const char *const keys[] = {"position", "normal"};
    if (!screen)
        return STATUS_OK;
    TRY(fit_check_map(r, screen, "screen", "write {position: [0, 97, 0], normal: [0, 1, 0]}", keys, COUNT(keys)));
    if (node_get(screen, "position"))
        TRY(read_vector(r, node_get(screen, "position"), "position", at));
    if (node_get(screen, "normal")) {
        TRY(read_vector(r, node_get(screen, "normal"), "normal", normal));
        if (!(vec3_length(*normal) > 0.0))
            return WRONG(r, node_get(screen, "normal"), "give a vector that is not zero",
                         "the screen's normal is zero");
    }
    return STATUS_OK;
}

static status choose_beam(const fit_reading *r, const node *name, fit_measure *m)
{
    const scene *s = r->f->s->base;
    for (size_t i = 0; name->kind == NODE_SCALAR && i < s->beam_count; i++)
        if (strcmp(s->beams[i].name, name->text) == 0) {
            m->beams[i / 64] |= UINT64_C(1) << i % 64;
            return STATUS_OK;
        }
    return WRONG(r, name, "name a beam of the scene, or several: [red, blue]", "the scene has no beam '%.64s'",
                 name->kind == NODE_SCALAR ? name->text : "");
}

static status read_beams(const fit_reading *r, const node *map, fit_measure *m)
{
    const scene *s = r->f->s->base;
    const node *names = node_get(map, "beam");
    bool found = false;
    if (!(m->beams = calloc(s->beam_count / 64 + 1, sizeof *m->beams)))
        return out_of_memory(r->why);
    for (size_t i = 0; names && names->kind == NODE_LIST && i < names->count; i++)
        TRY(choose_beam(r, names->items[i], m));
    if (names && names->kind != NODE_LIST)
        TRY(choose_beam(r, names, m));
    TRY(fit_read_real(r, map, "lambda_nm", 1, 1e7, &m->lambda_nm));
    for (size_t i = 0; i < s->beam_count; i++) {
        if (!names && s->beams[i].visible)
            m->beams[i / 64] |= UINT64_C(1) << i % 64;
        if (!(m->beams[i / 64] >> i % 64 & 1))
            continue;
        if (!(vec3_length(m->normal) > 0.0))
            m->normal = beam_axis(&s->beams[i]);
        for (int k = 0; k < beam_wavelengths(&s->beams[i]); k++)
            found = found || m->lambda_nm == 0.0 || fabs(beam_lambda(&s->beams[i], k) - m->lambda_nm) < 1e-6;
    }
    if (!found)
        return WRONG(r, map, "add one: cuvette scene SCENE --add beam:laser, or give the wavelength of one",
                     "the scene has no %s", m->lambda_nm > 0.0 ? "such beam with this wavelength" : "visible beam");
    TRY(fit_read_screen(r, node_get(map, "screen"), &m->at, &m->normal));
    if (isnan(m->at.x))
        return WRONG(r, map, "write screen: {position: [0, 97, 0]}, here or for the whole fit", "%.64s needs a screen",
                     m->name);
    m->normal = vec3_normalize(m->normal);
    return STATUS_OK;
}

static status read_radiance(const fit_reading *r, const node *map, fit_measure *m)
{
    static const char *const words[] = {"red", "green", "blue", "mean"};
    const node *pixel = node_get(map, "pixel"), *channel = node_get(map, "channel");
    double v[2] = {-1.0, -1.0};
    m->channel = -1;
    if (pixel)
        TRY(fit_read_reals(r, pixel, "pixel", 2, v));
    if (pixel && !(v[0] >= 0 && v[1] >= 0 && v[0] < 1e6 && v[1] < 1e6 && v[0] == floor(v[0]) && v[1] == floor(v[1])))
        return WRONG(r, pixel, "write the column and the row, from 0: [400, 300]", "this is not a pixel");
    m->pixel[0] = (int)v[0], m->pixel[1] = (int)v[1];
    for (int i = 0; channel && i < 4; i++)
        if (channel->kind == NODE_SCALAR && strcmp(channel->text, words[i]) == 0) {
            m->channel = i < 3 ? i : -1;
            return STATUS_OK;
        }
    return channel ? WRONG(r, channel, "write red, green, blue or mean", "this is not a channel") : STATUS_OK;
}

/* "hits.rod": a quantity by solid. */
static bool find_by_solid(const scene *s, fit_measure *m)
{
    const char *dot = strchr(m->name, '.');
    char name[64];
    snprintf(name, sizeof name, "%.*s", dot ? (int)(dot - m->name) : 0, m->name);
    m->frame = dot ? frame_quantity(name) : NULL;
    for (size_t i = 0; m->frame && m->frame->type == QUANTITY_SOLIDS && i < s->solid_count; i++)
        if (strcmp(s->solids[i].name, dot + 1) == 0)
            m->solid = (int)i;
    return m->solid >= 0;
}

static status find_quantity(const fit_reading *r, const node *at, fit_measure *m)
{
    const scene *s = r->f->s->base;
    m->solid = -1;
    for (int i = 0; i < FIT_BEAM_QUANTITY_COUNT; i++)
        if (strcmp(fit_beam_words[i], m->name) == 0) {
            m->source = FIT_BEAMS, m->beam_quantity = (fit_beam_quantity)i;
            return STATUS_OK;
        }
    if (strcmp(m->name, "radiance") == 0) {
        m->source = FIT_RADIANCE;
        return STATUS_OK;
    }
    m->source = FIT_FRAME;
    m->frame = frame_quantity(m->name);
    const bool scalar = m->frame && (m->frame->type == QUANTITY_COUNT || m->frame->type == QUANTITY_REAL);
    if ((scalar && m->frame->merge == QUANTITY_SAME) || (!m->frame && find_by_solid(s, m)))
        return STATUS_OK;
    if (m->frame && m->frame->type != QUANTITY_SOLIDS)
        return WRONG(r, at, "choose a number that is equal in all frames of a scene", "%.64s cannot be fitted",
                     m->name);
    m->source = FIT_REALISM;
    if (strchr(m->name, '.') && !m->frame)
        return STATUS_OK;
    return WRONG(
        r, at,
        "use focus, focus_rms, focal_length, power, spot_rms, spot_radius, spot_u, spot_v, received, radiance, a "
        "metric of 'cuvette realism' or a quantity of a frame",
        "unknown quantity '%.64s'", m->name);
}

/* Keys that the quantity ignores are errors: what can be set acts. */
static status check_used(const fit_reading *r, const node *map, const fit_measure *m)
{
    static const struct {
        const char *key;
        fit_source source;
    } used[] = {{"beam", FIT_BEAMS},
                {"lambda_nm", FIT_BEAMS},
                {"screen", FIT_BEAMS},
                {"pixel", FIT_RADIANCE},
                {"channel", FIT_RADIANCE}};
    for (size_t i = 0; i < COUNT(used); i++)
        if (node_get(map, used[i].key) && used[i].source != m->source)
            return WRONG(r, node_get(map, used[i].key), "remove it", "%s has no effect on %.64s", used[i].key, m->name);
    return STATUS_OK;
}

static bool settings_equal(const study_point *a, const study_point *b)
{
    bool same = a->count == b->count;
    for (size_t i = 0; same && i < a->count; i++)
        same = strcmp(a->paths[i], b->paths[i]) == 0 && strcmp(a->values[i], b->values[i]) == 0;
    return same;
}

/* Further parameters of one measurement: {rod.position.x: 0.2}. */
static status read_setting(const fit_reading *r, const node *set, size_t *index)
{
    fit *f = r->f;
    *index = 0;
    if (!set)
        return STATUS_OK;
    scene *target = scene_clone(f->s->base);
    study_point *point = &f->settings[f->setting_count++];
    status code = target ? STATUS_OK : out_of_memory(r->why);
    THEN(code, read_point(point, target, r->d, set, r->why));
    scene_destroy(target);
    TRY(code);
    for (size_t i = 0; i < point->count; i++)
        TRY(fit_check_unset(r, set, point->paths[i]));
    for (*index = 0; !settings_equal(&f->settings[*index], point);)
        ++*index;
    if (*index + 1 < f->setting_count)
        study_point_release(&f->settings[--f->setting_count]);
    return STATUS_OK;
}

static status read_measure(const fit_reading *r, const node *name, const node *map, fit_measure *m)
{
    const node *word = map->kind == NODE_MAP && node_get(map, "quantity") ? node_get(map, "quantity") : name;
    m->at = r->at, m->normal = r->normal;
    if (!word || word->kind != NODE_SCALAR)
        return WRONG(r, map, "write {quantity: spot_rms}", "there is no quantity");
    m->line = word->line, m->column = word->column;
    if (!(m->name = strdup(word->text)))
        return out_of_memory(r->why);
    TRY(find_quantity(r, word, m));
    TRY(check_used(r, map, m));
    if (m->source == FIT_BEAMS)
        TRY(read_beams(r, map, m));
    if (m->source == FIT_RADIANCE)
        TRY(read_radiance(r, map, m));
    return read_setting(r, node_get(map, "set"), &m->setting);
}

#define MEASURE_KEYS "quantity", "beam", "lambda_nm", "screen", "pixel", "channel", "set", "minus"

static status read_minus(const fit_reading *r, const node *minus, fit_target *t)
{
    static const char *const keys[] = {MEASURE_KEYS};
    if (!minus)
        return STATUS_OK;
    TRY(fit_check_map(r, minus, "minus", "write {quantity: focus, beam: red}", keys, COUNT(keys) - 1));
    t->has_minus = true;
    return read_measure(r, NULL, minus, &t->minus);
}

status fit_read_target(const fit_reading *r, const node *name, const node *map)
{
    static const char *const keys[] = {MEASURE_KEYS, "value", "sigma", "weight"};
    static const char *const form = "write {value: 312.5, sigma: 0.1}";
    fit *f = r->f;
    TRY(fit_check_map(r, map, name->text, form, keys, COUNT(keys)));
    TRY(fit_check_column(r, name));
    if (f->target_count == FIT_TARGETS_MAX)
        return WRONG(r, name, "use at most 128 targets", "the fit has more than %d targets", FIT_TARGETS_MAX);
    fit_target *t = &f->targets[f->target_count++];
    t->weight = 1.0;
    if (!(t->name = strdup(name->text)))
        return out_of_memory(r->why);
    if (!node_get(map, "value"))
        return WRONG(r, map, form, "the target has no value");
    TRY(fit_read_real(r, map, "value", -1e300, 1e300, &t->value));
    TRY(fit_read_real(r, map, "sigma", 1e-150, 1e150, &t->sigma));
    TRY(fit_read_real(r, map, "weight", 1e-150, 1e150, &t->weight));
    if (node_get(map, "sigma") && node_get(map, "weight"))
        return WRONG(r, map, "give one of them: the weight is 1 / sigma^2", "the target has a sigma and a weight");
    if (t->sigma > 0.0)
        t->weight = 1.0 / (t->sigma * t->sigma);
    TRY(read_measure(r, name, map, &t->of));
    return read_minus(r, node_get(map, "minus"), t);
}

/* minimise: spot_rms, or {quantity: spot_rms, beam: axis} */
status fit_read_extreme(const fit_reading *r, const node *n)
{
    static const char *const keys[] = {MEASURE_KEYS};
    fit_target *t = &r->f->targets[r->f->target_count++];
    const node *name = n->kind == NODE_MAP ? node_get(n, "quantity") : n;
    t->weight = 1.0;
    if (n->kind == NODE_MAP)
        TRY(node_check_keys(r->d, n, keys, COUNT(keys), r->why));
    if (!name || name->kind != NODE_SCALAR)
        return WRONG(r, n, "write {quantity: spot_rms, beam: axis}", "there is no quantity");
    TRY(fit_check_column(r, name));
    if (!(t->name = strdup(name->text)))
        return out_of_memory(r->why);
    TRY(read_measure(r, name, n, &t->of));
    return n->kind == NODE_MAP ? read_minus(r, node_get(n, "minus"), t) : STATUS_OK;
}
