/* The scenes that are offered: opening and discarding them. */
#include "base/json_build.h"
#include "web/session/rescue_private.h"
#include "report/json.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The caller owns *k from now on: nobody else can open or discard it. */
static status take_offer(rescue *r, const char *id, kept_scene *k, diagnostic *why)
{
    pthread_mutex_lock(&r->lock);
    size_t at = 0;
    while (at < r->offer_count && strcmp(r->offers[at].id, id) != 0)
        at++;
    const bool found = at < r->offer_count;
    if (found) {
        *k = r->offers[at];
        r->offer_count--;
        memmove(r->offers + at, r->offers + at + 1, (r->offer_count - at) * sizeof *r->offers);
    }
    pthread_mutex_unlock(&r->lock);
    return found ? STATUS_OK
                 : diagnose(why, STATUS_BAD_INPUT, "GET /api/state lists them as 'rescued'",
                            "no rescued scene has the id '%.40s'", id);
}

static void put(kept_scene *list, size_t *count, size_t at, kept_scene k)
{
    memmove(list + at + 1, list + at, (*count - at) * sizeof *list);
    list[at] = k;
    ++*count;
}

static const char *text_of(const kept_scene *k, const char *key)
{
    return json_string_value(json_object_get(k->about, key));
}

/* The name in this laboratory's folder of the file that the scene had; NULL if it had none, or one outside. */
static char *name_here(const rescue *r, const kept_scene *k, const char *place)
{
    char *name = text_of(k, "file") ? folder_name(r->l->files, place) : NULL;
    if (name && lab_is_scene_name(name))
        return name;
    free(name);
    return NULL;
}

static status open_scene(rescue *r, const kept_scene *k, const char *place, const char *name, uint64_t *generation,
                         diagnostic *why)
{
    char *text = NULL, *path = NULL;
    size_t size = 0;
    scene *s = NULL;
    status code = kept_scene_read(k, &text, &size, why);
    if (code == STATUS_OK && name)
        code = folder_path(r->l->files, name, false, &path, why);
    THEN(code, scene_read_text(path ? path : place, text, size, &s, why));
    if (code == STATUS_OK) {
        lab_set_default_threads(r->l, s);
        code = scene_document_rescue(r->l->scene_document, s, name, generation, why);
    }
    free(path);
    free(text);
    return code;
}

status rescue_open(rescue *r, const char *id, uint64_t *generation, diagnostic *why)
{
    kept_scene k;
    TRY(take_offer(r, id, &k, why));
    char *place = rescue_place(text_of(&k, "folder"), text_of(&k, "file")),
         *name = place ? name_here(r, &k, place) : NULL;
    const status code = place ? open_scene(r, &k, place, name, generation, why) : out_of_memory(why);
    if (code == STATUS_BAD_INPUT && strcmp(text_of(&k, "folder"), folder_real(r->l->files)) != 0)
        snprintf(why->remedy, sizeof why->remedy, "open it with: cuvette lab --folder %.200s", text_of(&k, "folder"));
    pthread_mutex_lock(&r->lock);
    if (code == STATUS_OK)
        put(r->opened, &r->opened_count, r->opened_count, k);
    else
        put(r->offers, &r->offer_count, 0, k);
    pthread_mutex_unlock(&r->lock);
    rescue_wake(r);
    lab_publish_state(r->l);
    free(place);
    free(name);
    return code;
}

status rescue_discard(rescue *r, const char *id, diagnostic *why)
{
    kept_scene k;
    TRY(take_offer(r, id, &k, why));
    kept_scene_remove(&k);
    lab_publish_state(r->l);
    return STATUS_OK;
}

/* Resolves paths once: the state is sent at every change. */
static void set_shown(const rescue *r, kept_scene *k)
{
    char *place = rescue_place(text_of(k, "folder"), text_of(k, "file")), *name = place ? name_here(r, k, place) : NULL;
    const bool named = place && text_of(k, "file");
    json_object_set_new(k->about, "shown", named ? json_of_text(name ? name : place) : json_null());
    free(place);
    free(name);
}

void rescue_find_offers(rescue *r)
{
    r->offer_count = kept_scenes_claim(r->folder, r->offers);
    for (size_t i = 0; i < r->offer_count; i++)
        set_shown(r, &r->offers[i]);
}

static json_t *offer_json(const kept_scene *k)
{
    return json_pack("{s:s, s:O, s:O, s:O}", "id", k->id, "time", json_object_get(k->about, "time"), "title",
                     json_object_get(k->about, "title"), "file", json_object_get(k->about, "shown"));
}

bool rescue_json(rescue *r, json_t *state)
{
    json_t *offers = json_array();
    pthread_mutex_lock(&r->lock);
    for (size_t i = 0; i < r->offer_count; i++)
        json_add(&offers, offer_json(&r->offers[i]));
    json_t *trouble = r->failed ? json_of_diagnostic(&r->trouble) : json_null();
    pthread_mutex_unlock(&r->lock);
    return json_object_set_new(state, "rescued", offers) == 0 && json_object_set_new(state, "unkept", trouble) == 0;
}
