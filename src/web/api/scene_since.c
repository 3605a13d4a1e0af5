/* GET /api/scene?since=GENERATION: the latest scenes that were sent are remembered as JSON, and a page that has one of
 * them gets only what differs. */
#include "base/json_build.h"
#include "web/api/scene_since.h"
#include "report/json.h"

#include <pthread.h>
#include <stdlib.h>
#include <string.h>

/* The scenes that are remembered: a page is up to date within a change or two. Scenes of more parameters than that are
 * not, because of their memory: a row takes some 2 kB, so that all take at most 40 MB. */
enum { SCENES = 8, PARAMS_MAX = 2500 };

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

static json_int_t generation_of(const json_t *scene)
{
    return json_integer_value(json_object_get(scene, "generation"));
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

/* Adds the rows that differ, and all paths in their order if there are others than before. */
static bool add_params(json_t *delta, const json_t *before, const json_t *after)
{
    const json_t *old = json_object_get(before, "params"), *new = json_object_get(after, "params");
    json_t *known = rows_by_path(old), *rows = json_array(), *order = json_array();
    bool same = json_array_size(old) == json_array_size(new);
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

/* {"generation", "since", "params": [rows that differ or are new], "order"?: [all paths, if there are others or in
 * another order], and every other key whose value differs}. */
static json_t *scene_delta(const json_t *before, const json_t *after)
{
    json_t *delta = json_pack("{s:I}", "since", generation_of(before));
    bool good = delta != NULL;
    const char *key;
    json_t *value;
    json_object_foreach((json_t *)(uintptr_t)after, key, value)
    {
        if (strcmp(key, "params") != 0 && !json_equal(value, json_object_get(before, key)))
            good = good && json_object_set(delta, key, value) == 0;
    }
    good = good && json_object_set(delta, "generation", json_object_get(after, "generation")) == 0;
    return json_if(delta, good && add_params(delta, before, after));
}

/* Jansson's reference counts are not atomic, so all uses of the remembered scenes are under the lock. */
char *sent_scenes_reply(sent_scenes *s, json_t *scene, long long since)
{
    const json_t *before = NULL;
    bool known = false;
    pthread_mutex_lock(&s->lock);
    for (int i = 0; i < SCENES; i++) {
        before = s->scene[i] && generation_of(s->scene[i]) == since ? s->scene[i] : before;
        known |= s->scene[i] && generation_of(s->scene[i]) == generation_of(scene);
    }
    json_t *reply = before ? scene_delta(before, scene) : json_incref(scene);
    char *text = reply ? json_text(reply, JSON_COMPACT) : NULL;
    json_decref(reply);
    if (!known && json_array_size(json_object_get(scene, "params")) <= PARAMS_MAX) {
        json_decref(s->scene[s->next]);
        s->scene[s->next] = json_incref(scene);
        s->next = (s->next + 1) % SCENES;
    }
    json_decref(scene);
    pthread_mutex_unlock(&s->lock);
    return text;
}
