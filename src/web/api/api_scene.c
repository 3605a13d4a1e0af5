/* API: the scene with its parameters, or only what differs from a scene that the page has; and the search for
 * parameters. See web/README.md. */
#include "base/json_build.h"
#include "geometry/shapes/shape.h"
#include "report/json.h"
#include "report/param_rows.h"
#include "scene/model/params.h"
#include "scene/model/scene.h"
#include "web/api/api.h"

#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* --- the whole scene: objects, outlines of solids, shapes, and rows of parameters --- */

/* By light_kind, as the parameter `kind` spells them. */
static const char *const light_words[] = {"point", "cone", "soft_cone", "disc", "rectangle", "sun"};

static json_t *object_json(const char *name, const char *kind)
{
    return json_pack("{s:o,s:s}", "name", json_of_text(name), "kind", kind);
}

static json_t *solid_json(const scene *s, const solid *one)
{
    json_t *o = object_json(one->name, "solid");
    int bad = json_object_set_new(o, "shape", json_string(shape_name(one->shape.kind)));
    bad |= json_object_set_new(
        o, "material", one->material_index >= 0 ? json_of_text(s->materials[one->material_index].name) : json_null());
    if (shape_of(&one->shape)->triangles)
        bad |= json_object_set_new(o, "mesh", json_of_text(one->mesh));
    return json_if(o, !bad);
}

static json_t *objects_json(const scene *s)
{
    static const param_group rest[] = {PARAM_BEAM, PARAM_MATERIAL, PARAM_MESH, PARAM_TEXTURE, PARAM_DATA};
    json_t *list = json_array();
    int bad = 0;
    for (size_t i = 0; i < s->solid_count; i++)
        bad |= json_array_append_new(list, solid_json(s, &s->solids[i]));
    for (size_t i = 0; i < s->light_count; i++) {
        json_t *o = object_json(s->lights[i].name, "light");
        bad |= json_object_set_new(o, "light", json_string(light_words[s->lights[i].kind]));
        bad |= json_array_append_new(list, o);
    }
    for (size_t group = 0; group < sizeof rest / sizeof *rest; group++)
        for (size_t i = 0; i < param_place_group_size(s, rest[group]); i++)
            bad |= json_array_append_new(
                list, object_json(param_place_group_name(s, rest[group], i), param_group_name(rest[group])));
    return json_if(list, !bad);
}

/* [[RING, ..], ..]: the rings of each convex part. A RING is [y, x, z, corners, from_deg] of a shape_ring. */
static json_t *outline_json(const solid_shape *shape)
{
    shape_ring rings[RINGS_MAX];
    const int count = shape_rings(shape, rings);
    json_t *parts = json_array(), *part = NULL;
    for (int i = 0; i < count; i++) {
        const shape_ring *r = &rings[i];
        if (i == 0 || r->part != rings[i - 1].part)
            part = json_array();
        json_add(&part, json_pack("[f,f,f,i,f]", r->y, r->x, r->z, r->corners, r->from_deg));
        if (i + 1 == count || rings[i + 1].part != r->part)
            json_add(&parts, part);
    }
    return parts;
}

/* --- what the page requests: of a group of many objects only the parameters of those that it shows --- */

enum { GROUP_ALL = 40 }; /* the largest group whose objects are sent with all their parameters */

typedef struct asked {
    const scene *now;
    json_t *objects, *some, *paths; /* {NAME: true}: all parameters, some; {PATH: true} */
} asked;

/* ?of=NAME,PATH,..: a word with a dot is a path. */
static bool read_asked(asked *a, const char *words)
{
    *a = (asked){NULL, json_object(), json_object(), json_object()};
    bool good = a->objects && a->some && a->paths;
    while (words && *words && good) {
        const char *dot = NULL;
        size_t length = 0;
        for (; words[length] && words[length] != ','; length++)
            dot = words[length] == '.' ? words + length : dot;
        const size_t name = dot ? (size_t)(dot - words) : length;
        good = json_object_setn_new(dot ? a->some : a->objects, words, name, json_true()) == 0;
        if (dot && good)
            good = json_object_setn_new(a->paths, words, length, json_true()) == 0;
        words += length + (words[length] == ',');
    }
    return good;
}

static void release_asked(asked *a)
{
    json_decref(a->objects);
    json_decref(a->some);
    json_decref(a->paths);
}

static bool is_asked(const void *context, const scene *s, const param_place *at)
{
    const asked *a = context;
    if (param_place_group_size(a->now, at->object_group) <= GROUP_ALL)
        return true;
    const char *name = param_place_group_name(s, at->object_group, at->index);
    if (json_object_get(a->objects, name))
        return true;
    if (!at->row || !json_object_get(a->some, name))
        return !at->row && json_object_get(a->some, name);
    char path[PARAM_PATH_MAX];
    snprintf(path, sizeof path, "%s.%s", name, at->row->name);
    return json_object_get(a->paths, path) != NULL;
}

static bool is_sent_whole(const asked *a, const char *name)
{
    return a->now->solid_count <= GROUP_ALL || json_object_get(a->objects, name);
}

/* {name of a solid: outline}, for visible solids whose shape has one. */
static json_t *outlines_json(const scene *s, const asked *a)
{
    json_t *all = json_object();
    for (size_t i = 0; i < s->solid_count; i++)
        if (s->solids[i].visible && shape_of(&s->solids[i].shape)->rings && is_sent_whole(a, s->solids[i].name))
            json_add_as(&all, s->solids[i].name, outline_json(&s->solids[i].shape));
    return all;
}

static json_t *shapes_json(void)
{
    json_t *list = json_array();
    const shape_rule *rule;
    for (int k = 0; (rule = shape_of_kind((shape_kind)k)); k++)
        json_add(&list, json_pack("{s:s,s:s,s:b}", "shape", rule->word, "meaning", rule->meaning, "unbounded",
                                  (int)rule->unbounded));
    return list;
}

static bool has_all(const scene *s)
{
    bool all = true;
    for (int g = 0; g < PARAM_GROUP_COUNT; g++)
        all = all && param_place_group_size(s, (param_group)g) <= GROUP_ALL;
    return all;
}

/* The objects and one row per requested parameter. opened: the scene that `initial` is read from. NULL when out
 * of memory. */
static json_t *scene_json(const scene *s, const scene *opened, uint64_t generation, uint64_t version, const asked *a,
                          const char *words)
{
    json_t *rows = NULL, *o = NULL;
    const param_selection of = {is_asked, a};
    if (param_rows_json(s, opened, &of, NULL, &rows, NULL) == STATUS_OK)
        o = json_pack("{s:I,s:I,s:b,s:o,s:o,s:o,s:o,s:o,s:O}", "generation", (json_int_t)generation, "version",
                      (json_int_t)version, "whole", has_all(s), "of", json_of_text(words ? words : ""), "title",
                      json_of_text(s->title), "objects", objects_json(s), "outlines", outlines_json(s, a), "shapes",
                      shapes_json(), "params", json_object_get(rows, "params"));
    json_decref(rows);
    return o;
}

/* --- differences for a page: the latest scenes that were sent are remembered as JSON --- */

/* SCENES are remembered, because a page lags by a change or two. A scene of more than PARAMS_MAX parameters or
 * OBJECTS_MAX objects is not: a parameter needs about 2 kB, an object below 1 kB, so all need at most 200 MB. */
enum { SCENES = 8, PARAMS_MAX = 2500, OBJECTS_MAX = 20000 };

struct sent_scenes {
    pthread_mutex_t lock;
    json_t *scene[SCENES]; /* immutable; NULL: none */
    int next;
};

sent_scenes *sent_scenes_create(void)
{
    sent_scenes *s = calloc(1, sizeof *s);
    if (s)
        pthread_mutex_init(&s->lock, NULL);
    return s;
}

void sent_scenes_destroy(sent_scenes *s)
{
    if (!s)
        return;
    for (int i = 0; i < SCENES; i++)
        json_decref(s->scene[i]);
    pthread_mutex_destroy(&s->lock);
    free(s);
}

static json_int_t generation_of(const json_t *sent)
{
    return json_integer_value(json_object_get(sent, "generation"));
}

static const char *path_of(const json_t *row)
{
    return json_string_value(json_object_get(row, "path"));
}

/* {path: row} of a scene's parameters; NULL when out of memory. */
static json_t *rows_by_path(const json_t *params)
{
    json_t *rows = json_object();
    int bad = !rows;
    for (size_t i = 0; i < json_array_size(params) && !bad; i++)
        bad = json_object_set(rows, path_of(json_array_get(params, i)), json_array_get(params, i));
    return json_if(rows, !bad);
}

static bool asks_alike(const json_t *a, const json_t *b)
{
    return json_equal(json_object_get(a, "of"), json_object_get(b, "of"));
}

/* Adds the rows that differ, or all, and all paths in their order if the paths or their order changed. */
static bool add_params(json_t *delta, const json_t *before, const json_t *after, bool all)
{
    const json_t *old = json_object_get(before, "params"), *new = json_object_get(after, "params");
    json_t *known = all ? json_object() : rows_by_path(old), *rows = json_array(), *order = json_array();
    bool same = !all && json_array_size(old) == json_array_size(new);
    int bad = !known;
    for (size_t i = 0; i < json_array_size(new) && !bad; i++) {
        json_t *row = json_array_get(new, i);
        if (!json_equal(row, json_object_get(known, path_of(row))))
            bad |= json_array_append(rows, row);
        bad |= json_array_append_new(order, json_string(path_of(row)));
        same = same && strcmp(path_of(row), path_of(json_array_get(old, i))) == 0;
    }
    json_decref(known);
    bad |= json_object_set_new(delta, "params", rows);
    if (same)
        json_decref(order);
    else
        bad |= json_object_set_new(delta, "order", order);
    return !bad;
}

/* What depends on ?of=: a page may have it for other words than the remembered scene. */
static bool depends_on_request(const char *key)
{
    return strcmp(key, "of") == 0 || strcmp(key, "outlines") == 0;
}

/* {"generation", "since", "params": [rows that differ or are new], "order"?: [all paths, if they or their order
 * changed], and every other key whose value differs}. */
static json_t *scene_delta(const json_t *before, const json_t *after, bool all_rows)
{
    json_t *delta = json_pack("{s:I}", "since", generation_of(before));
    const bool all = all_rows || !asks_alike(before, after);
    bool good = delta != NULL;
    const char *key;
    json_t *value;
    json_object_foreach((json_t *)(uintptr_t)after, key, value)
    {
        if (strcmp(key, "params") != 0 &&
            ((all && depends_on_request(key)) || !json_equal(value, json_object_get(before, key))))
            good = good && json_object_set(delta, key, value) == 0;
    }
    good = good && json_object_set(delta, "generation", json_object_get(after, "generation")) == 0;
    return json_if(delta, good && add_params(delta, before, after, all));
}

/* The reply as allocated text: the scene, or only its differences from the generation `since` if that is remembered;
 * -1 for none; all_rows: all its rows. Releases json.
 * Jansson's reference counts are atomic only in some builds, so all uses of the remembered
 * scenes are under the lock. */
static char *sent_scenes_reply(sent_scenes *s, json_t *json, long long since, bool all_rows)
{
    json_t *before = NULL;
    bool known = false;
    pthread_mutex_lock(&s->lock);
    for (int i = 0; i < SCENES; i++) {
        if (s->scene[i] && generation_of(s->scene[i]) == since && (!before || asks_alike(s->scene[i], json)))
            before = s->scene[i];
        known |= s->scene[i] && generation_of(s->scene[i]) == generation_of(json) && asks_alike(s->scene[i], json);
    }
    json_t *objects = json_object_get(before, "objects");
    if (json_equal(objects, json_object_get(json, "objects"))) /* remember the list of a large scene once */
        json_object_set(json, "objects", objects);
    json_t *reply = before ? scene_delta(before, json, all_rows) : json_incref(json);
    char *text = reply ? json_text(reply, JSON_COMPACT) : NULL;
    json_decref(reply);
    if (!known && json_array_size(json_object_get(json, "params")) <= PARAMS_MAX &&
        json_array_size(json_object_get(json, "objects")) <= OBJECTS_MAX) {
        json_decref(s->scene[s->next]);
        s->scene[s->next] = json_incref(json);
        s->next = (s->next + 1) % SCENES;
    }
    json_decref(json);
    pthread_mutex_unlock(&s->lock);
    return text;
}

/* --- requests --- */

/* The generation in ?since; -1 for none. */
static bool read_since(call *c, long long *since)
{
    const char *text = http_query_value(c->request, "since");
    char *end = NULL;
    *since = text ? strtoll(text, &end, 10) : -1;
    return !text || (end > text && *end == '\0' && *since >= 0);
}

status api_scene(call *c)
{
    uint64_t generation, version;
    long long since;
    asked of;
    if (!read_since(c, &since))
        return api_refuse(c, 400, "since is not a generation", "use ?since=N with the generation of an earlier reply");
    const char *words = http_query_value(c->request, "of");
    const bool read = read_asked(&of, words), all_rows = http_query_value(c->request, "rows") != NULL;
    scene *current, *opened;
    json_t *all = NULL;
    if (scene_document_copies(c->l->scene_document, &current, &opened, &generation, &version) && read) {
        of.now = current;
        all = scene_json(current, opened, generation, version, &of, words);
    }
    char *text = all ? sent_scenes_reply(c->l->sent, all, since, all_rows) : NULL;
    release_asked(&of);
    scene_destroy(current);
    scene_destroy(opened);
    return text ? api_send(c, "application/json", text, strlen(text)) : out_of_memory(&c->why);
}

typedef struct param_question {
    const scene *s;
    const char *words;
    json_t *found[PARAM_NO_MATCH]; /* indexed by param_match */
} param_question;

static status add_found(void *context, const param_place *at)
{
    param_question *q = context;
    char path[PARAM_PATH_MAX];
    snprintf(path, sizeof path, "%s.%s", param_place_group_name(q->s, at->object_group, at->index), at->row->name);
    const param_match match = param_matches(at->row, path, q->words);
    if (match != PARAM_NO_MATCH)
        json_add(&q->found[match], json_of_text(path));
    return STATUS_OK;
}

status api_find(call *c)
{
    param_question q = {.words = http_query_value(c->request, "find")};
    if (!q.words)
        return api_refuse(c, 400, "find is missing", "use ?find=WORDS");
    scene *current = scene_document_copy(c->l->scene_document, NULL);
    json_t *found = current ? json_array() : NULL;
    q.s = current;
    for (int i = 0; i < PARAM_NO_MATCH; i++)
        q.found[i] = json_array();
    for (int g = 0; current && g < PARAM_GROUP_COUNT; g++)
        param_place_each(current, (param_group)g, add_found, &q);
    for (int i = 0; i < PARAM_NO_MATCH; i++)
        json_add(&found, q.found[i]);
    scene_destroy(current);
    return api_reply_json(c, json_pack("{s:o}", "found", found));
}
