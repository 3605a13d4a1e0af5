/* The thread that keeps the unsaved scene, and the scenes of laboratories that died, which are offered. */
#include "base/cancel.h"
#include "base/float_environment.h"
#include "base/json_build.h"
#include "base/text.h"
#include "measure/clock.h"
#include "report/json.h"
#include "scene/file/write.h"
#include "scene/model/scene.h"
#include "web/document/kept_scenes.h"
#include "web/session/session.h"
#include "web/session/studies.h"

#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct rescue {
    lab *l;
    const char *folder; /* "": none is known */
    pthread_t thread;
    bool started;
    kept_scene kept; /* the unsaved scene; only the thread uses it */
    uint64_t number; /* of the version in kept */

    pthread_mutex_t lock; /* guards the fields below */
    pthread_cond_t changed;
    bool woken, ending, failed;
    diagnostic trouble;
    /* Unsaved scenes that were found at the start. offers: not opened yet; opened: opened in the document, each with a
     * file that is removed when the document is saved, or written to `kept`. */
    kept_scene offers[KEPT_SCENES_MAX], opened[KEPT_SCENES_MAX];
    size_t offer_count, opened_count;
};

static const double period_s = 1.0;

/* The path to which the names of files in a kept scene are relative: the scene's own file, or any in its folder. */
static char *place_of(const char *root, const char *file)
{
    return text_format("%s/%s", root, file ? file : "unsaved");
}

void rescue_wake(rescue *r)
{
    if (!r)
        return;
    pthread_mutex_lock(&r->lock);
    r->woken = true;
    pthread_cond_signal(&r->changed);
    pthread_mutex_unlock(&r->lock);
}

/* --- the thread that keeps the unsaved scene --- */

static json_t *about_scene(const rescue *r, const scene *s, const char *file)
{
    return json_pack("{s:o, s:o, s:o}", "title", json_of_text(s->title), "folder",
                     json_of_text(folder_real(r->l->files)), "file", file ? json_of_text(file) : json_null());
}

static status write_kept(rescue *r, diagnostic *why)
{
    uint64_t number = 0;
    char *file = NULL, *text = NULL;
    scene_document_unsaved(r->l->scene_document, &number, &file);
    scene *s = scene_document_copy_to_save(r->l->scene_document, NULL, &number);
    if (s)
        lab_clear_default_threads(r->l, s);
    char *place = place_of(folder_real(r->l->files), file);
    json_t *about = s ? about_scene(r, s, file) : NULL;
    status code = s && place && about ? scene_write_text(s, place, false, &text, why) : out_of_memory(why);
    THEN(code, kept_scene_write(r->folder, &r->kept, about, text, why));
    if (code == STATUS_OK)
        r->number = number;
    json_decref(about);
    scene_destroy(s);
    free(place);
    free(file);
    free(text);
    return code;
}

/* Makes the file follow the document: writes it, or removes it when nothing is unsaved. */
static status update_file(rescue *r, diagnostic *why)
{
    uint64_t number;
    const bool unsaved = scene_document_unsaved(r->l->scene_document, &number, NULL);
    if (!unsaved) {
        kept_scene_remove(&r->kept);
        return STATUS_OK;
    }
    if (r->kept.path && r->number == number)
        return STATUS_OK;
    if (!r->folder[0])
        return diagnose(why, STATUS_FAILURE, "set HOME or XDG_STATE_HOME",
                        "there is no folder in which to keep unsaved changes");
    return write_kept(r, why);
}

/* The files of scenes that were opened are removed only after the document has been written. */
static void step(rescue *r)
{
    pthread_mutex_lock(&r->lock);
    const size_t opened = r->opened_count; /* before the document is read */
    pthread_mutex_unlock(&r->lock);
    diagnostic why = {.line = 0};
    const bool failed = update_file(r, &why) != STATUS_OK;
    if (failed && !why.remedy[0])
        snprintf(why.remedy, sizeof why.remedy, "save the scene, or set XDG_STATE_HOME to another folder");
    pthread_mutex_lock(&r->lock);
    const bool differs = failed != r->failed;
    r->failed = failed;
    r->trouble = why;
    for (size_t i = 0; i < opened && !failed; i++)
        kept_scene_remove(&r->opened[i]);
    if (!failed) {
        r->opened_count -= opened;
        memmove(r->opened, r->opened + opened, r->opened_count * sizeof *r->opened);
    }
    pthread_mutex_unlock(&r->lock);
    if (differs)
        lab_publish_state(r->l);
}

/* Waits for a change and for the end of the period; false at the end. The caller holds the lock. */
static bool wait_for_change(rescue *r, const struct timespec *until)
{
    while (!r->woken && !r->ending)
        pthread_cond_wait(&r->changed, &r->lock);
    while (!r->ending && pthread_cond_clockwait(&r->changed, &r->lock, CLOCK_MONOTONIC, until) == 0) {
    }
    r->woken = false;
    return !r->ending;
}

static void *run(void *context)
{
    rescue *r = context;
    struct timespec until = clock_after(0);
    float_environment_set();
    pthread_mutex_lock(&r->lock);
    while (wait_for_change(r, &until)) {
        pthread_mutex_unlock(&r->lock);
        if (!studies_runs(r->l->studies, NULL)) {
            step(r);
            until = clock_after(period_s);
        }
        pthread_mutex_lock(&r->lock);
    }
    pthread_mutex_unlock(&r->lock);
    return NULL;
}

/* --- the scenes that are offered --- */

/* Moves an offer to *k, so that no other request can open or discard it. */
static status claim_offer(rescue *r, const char *id, kept_scene *k, diagnostic *why)
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
                 : diagnose(why, STATUS_BAD_INPUT, "use an id that GET /api/state lists in 'rescued'",
                            "no rescued scene has the id '%.40s'", id);
}

static void insert(kept_scene *list, size_t *count, size_t at, kept_scene k)
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
    TRY(claim_offer(r, id, &k, why));
    char *place = place_of(text_of(&k, "folder"), text_of(&k, "file")), *name = place ? name_here(r, &k, place) : NULL;
    const status code = place ? open_scene(r, &k, place, name, generation, why) : out_of_memory(why);
    if (code == STATUS_BAD_INPUT && strcmp(text_of(&k, "folder"), folder_real(r->l->files)) != 0)
        snprintf(why->remedy, sizeof why->remedy, "open it with: cuvette lab --folder %.200s", text_of(&k, "folder"));
    pthread_mutex_lock(&r->lock);
    if (code == STATUS_OK)
        insert(r->opened, &r->opened_count, r->opened_count, k);
    else
        insert(r->offers, &r->offer_count, 0, k);
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
    TRY(claim_offer(r, id, &k, why));
    kept_scene_remove(&k);
    lab_publish_state(r->l);
    return STATUS_OK;
}

/* Resolves the path once, since the state is sent at every change. */
static void set_shown(const rescue *r, kept_scene *k)
{
    char *place = place_of(text_of(k, "folder"), text_of(k, "file")), *name = place ? name_here(r, k, place) : NULL;
    const bool named = place && text_of(k, "file");
    json_object_set_new(k->about, "shown", named ? json_of_text(name ? name : place) : json_null());
    free(place);
    free(name);
}

/* Claims the scenes without an owner. */
static void find_offers(rescue *r)
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

/* --- start and end --- */

status rescue_create(lab *l, rescue **out, diagnostic *why)
{
    rescue *r = *out = calloc(1, sizeof *r);
    if (!r)
        return out_of_memory(why);
    *r = (rescue){.l = l, .folder = l->settings.rescue};
    pthread_mutex_init(&r->lock, NULL);
    pthread_cond_init(&r->changed, NULL);
    if (!r->folder)
        return STATUS_OK;
    if (r->folder[0])
        find_offers(r);
    r->started = pthread_create(&r->thread, NULL, run, r) == 0;
    return r->started
               ? STATUS_OK
               : diagnose(why, STATUS_FAILURE, "close other programs, or raise the limit on processes (ulimit -u)",
                          "cannot start a thread");
}

void rescue_destroy(rescue *r, bool leave)
{
    if (!r)
        return;
    pthread_mutex_lock(&r->lock);
    r->ending = true;
    pthread_cond_signal(&r->changed);
    pthread_mutex_unlock(&r->lock);
    if (r->started)
        pthread_join(r->thread, NULL);
    if (leave && r->started) {
        cancel_token
            shield; /* the signal that ends the program has cancelled the work of this thread; this step must run */
        cancel_shield(&shield);
        step(r);
        cancel_end(&shield);
    }
    void (*end)(kept_scene *) = leave ? kept_scene_release : kept_scene_remove;
    end(&r->kept);
    for (size_t i = 0; i < r->opened_count; i++)
        end(&r->opened[i]);
    for (size_t i = 0; i < r->offer_count; i++)
        kept_scene_release(&r->offers[i]);
    pthread_mutex_destroy(&r->lock);
    pthread_cond_destroy(&r->changed);
    free(r);
}
