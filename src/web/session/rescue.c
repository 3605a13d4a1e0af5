/* The thread that keeps the unsaved scene. rescue_offers.c offers those of laboratories that died. */
#include "web/session/rescue_private.h"
#include "base/cancel.h"
#include "base/float_environment.h"
#include "base/text.h"
#include "measure/clock.h"
#include "report/json.h"
#include "scene/file/write.h"
#include "scene/model/scene.h"
#include "web/session/studies.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double period_s = 1.0;

static json_t *about_scene(const rescue *r, const scene *s, const char *file)
{
    return json_pack("{s:o, s:o, s:o}", "title", json_of_text(s->title), "folder",
                     json_of_text(folder_real(r->l->files)), "file", file ? json_of_text(file) : json_null());
}

char *rescue_place(const char *root, const char *file)
{
    return text_format("%s/%s", root, file ? file : "unsaved");
}

static status write_own(rescue *r, diagnostic *why)
{
    uint64_t number = 0;
    char *file = NULL, *text = NULL;
    scene_document_unsaved(r->l->scene_document, &number, &file);
    scene *s = scene_document_take_kept(r->l->scene_document, NULL, &number);
    if (s)
        lab_clear_default_threads(r->l, s);
    char *place = rescue_place(folder_real(r->l->files), file);
    json_t *about = s ? about_scene(r, s, file) : NULL;
    status code = s && place && about ? scene_write_text(s, place, false, &text, why) : out_of_memory(why);
    THEN(code, kept_scene_write(r->folder, &r->own, about, text, why));
    if (code == STATUS_OK)
        r->number = number;
    json_decref(about);
    scene_destroy(s);
    free(place);
    free(file);
    free(text);
    return code;
}

/* Makes the file that of the document. */
static status follow(rescue *r, diagnostic *why)
{
    uint64_t number;
    const bool unsaved = scene_document_unsaved(r->l->scene_document, &number, NULL);
    if (!unsaved) {
        kept_scene_remove(&r->own);
        return STATUS_OK;
    }
    if (r->own.path && r->number == number)
        return STATUS_OK;
    if (!r->folder[0])
        return diagnose(why, STATUS_FAILURE, "set HOME or XDG_STATE_HOME",
                        "there is no folder in which to keep unsaved changes");
    return write_own(r, why);
}

/* Scenes that were opened have no other file than their own until the document has been written. */
static void step(rescue *r)
{
    pthread_mutex_lock(&r->lock);
    const size_t opened = r->opened_count; /* before the document is read */
    pthread_mutex_unlock(&r->lock);
    diagnostic why = {.line = 0};
    const bool failed = follow(r, &why) != STATUS_OK;
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

/* The caller holds the lock. Waits for a change, and for the end of the period after the last one. */
static bool wait_for_change(rescue *r, const struct timespec *until)
{
    while (!r->woken && !r->ending)
        pthread_cond_wait(&r->changed, &r->lock);
    while (!r->ending && pthread_cond_clockwait(&r->changed, &r->lock, CLOCK_MONOTONIC, until) == 0) {
    }
    r->woken = false;
    return !r->ending;
}

static void *run(void *of)
{
    rescue *r = of;
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
        rescue_find_offers(r);
    r->started = pthread_create(&r->thread, NULL, run, r) == 0;
    return r->started
               ? STATUS_OK
               : diagnose(why, STATUS_FAILURE, "close other programs, or raise the limit on processes (ulimit -u)",
                          "a thread cannot be started");
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
        cancel_token shield; /* the signal that ends the program has cancelled all other work of this thread */
        cancel_shield(&shield);
        step(r);
        cancel_end(&shield);
    }
    void (*end)(kept_scene *) = leave ? kept_scene_release : kept_scene_remove;
    end(&r->own);
    for (size_t i = 0; i < r->opened_count; i++)
        end(&r->opened[i]);
    for (size_t i = 0; i < r->offer_count; i++)
        kept_scene_release(&r->offers[i]);
    pthread_mutex_destroy(&r->lock);
    pthread_cond_destroy(&r->changed);
    free(r);
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
