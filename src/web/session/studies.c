/* The thread that runs a study, and its progress for pages. */
#include "web/session/studies.h"
#include "base/float_environment.h"
#include "base/text.h"
#include "report/json.h"
#include "web/session/tasks.h"

#include <math.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

struct studies {
    lab *l;
    void (*ended)(lab *l);
    task_thread task; /* task.life is acquired before lock */
    study *s;         /* used by the thread while it runs */
    atomic_bool drawing;

    pthread_mutex_t lock; /* guards the fields below */
    bool running;
    char *name; /* of the running or last study; NULL before the first */
    study_frame_progress now;
    double published_s;
    bool failed;
    diagnostic trouble;
};

status studies_create(lab *l, void (*ended)(lab *l), studies **out, diagnostic *why)
{
    *out = calloc(1, sizeof **out);
    if (!*out)
        return out_of_memory(why);
    (*out)->l = l;
    (*out)->ended = ended;
    task_thread_create(&(*out)->task);
    pthread_mutex_init(&(*out)->lock, NULL);
    return STATUS_OK;
}

/* The caller holds task.life. */
static void join_thread(studies *st)
{
    if (!task_thread_join(&st->task))
        return;
    study_destroy(st->s);
    st->s = NULL;
}

void studies_end(studies *st)
{
    pthread_mutex_lock(&st->task.life);
    task_thread_end(&st->task);
    join_thread(st);
    pthread_mutex_unlock(&st->task.life);
}

void studies_destroy(studies *st)
{
    if (!st)
        return;
    studies_end(st);
    task_thread_destroy(&st->task);
    pthread_mutex_destroy(&st->lock);
    free(st->name);
    free(st);
}

/* --- progress for pages --- */

json_t *studies_json(studies *st)
{
    static const char *const stages[] = {"measuring", "moving", "images"};
    pthread_mutex_lock(&st->lock);
    const study_frame_progress *now = &st->now;
    json_t *json = !st->name
                       ? json_null()
                       : json_pack("{s:s, s:b, s:I, s:I, s:o, s:I, s:o, s:s, s:I, s:I, s:o}", "name", st->name,
                                   "running", st->running, "frames_done", (json_int_t)now->frames_done, "frames_all",
                                   (json_int_t)now->frames_all, "left_s", json_of_real(now->left_s), "cell",
                                   (json_int_t)now->cell, "fraction", json_of_real(now->share), "stage",
                                   stages[now->stage], "image", (json_int_t)now->img, "images", (json_int_t)now->images,
                                   "error", st->failed ? json_of_diagnostic(&st->trouble) : json_null());
    pthread_mutex_unlock(&st->lock);
    return json;
}

static void publish(studies *st)
{
    lab_publish(st->l, "study", studies_json(st));
}

static void on_progress(void *context, const study_frame_progress *now)
{
    studies *st = context;
    pthread_mutex_lock(&st->lock);
    const bool due = task_publish_is_due(&st->published_s);
    st->now = *now;
    pthread_mutex_unlock(&st->lock);
    if (due)
        publish(st);
}

/* --- the run --- */

static void *run(void *context)
{
    studies *st = context;
    float_environment_set();
    char *text = text_format("a study is measuring: %s", st->s->name);
    render_worker_suspend(st->l->render_worker, text ? text : "a study is measuring");
    free(text);
    lab_publish_state(st->l);
    const study_options options = {.results = st->l->settings.results, .progressed = on_progress, .context = st};
    diagnostic why = {.what = ""};
    cancel_begin(&st->task.token);
    const status code = study_run(st->s, &options, NULL, &why);
    cancel_end(&st->task.token);
    render_worker_suspend(st->l->render_worker, NULL);
    pthread_mutex_lock(&st->lock);
    st->running = false;
    st->failed = code != STATUS_OK && code != STATUS_INTERRUPTED;
    st->trouble = why;
    pthread_mutex_unlock(&st->lock);
    st->ended(st->l);
    publish(st);
    lab_publish_state(st->l);
    return NULL;
}

/* The caller holds task.life. Replaces the last study; STATUS_INTERRUPTED while it still runs. */
static status claim_run(studies *st, study *s, diagnostic *why)
{
    char *name = strdup(s->name);
    if (!name)
        return out_of_memory(why);
    pthread_mutex_lock(&st->lock);
    const bool busy = st->running;
    if (busy)
        diagnose(why, STATUS_INTERRUPTED, "wait until it ends, or stop it", "the study %s is running", st->name);
    if (!busy) {
        free(st->name);
        st->name = name;
        st->now = (study_frame_progress){.left_s = NAN};
        st->published_s = 0;
        st->failed = false;
        st->running = true;
    }
    pthread_mutex_unlock(&st->lock);
    if (busy)
        free(name);
    return busy ? STATUS_INTERRUPTED : STATUS_OK;
}

static status begin(studies *st, study *s, diagnostic *why)
{
    TRY(task_thread_may_start(&st->task, why));
    TRY(claim_run(st, s, why));
    join_thread(st);
    st->s = s;
    const status code = task_thread_start(&st->task, run, st, why);
    if (code == STATUS_OK)
        return code;
    st->s = NULL;
    pthread_mutex_lock(&st->lock);
    st->running = false;
    pthread_mutex_unlock(&st->lock);
    return code;
}

status studies_start(studies *st, study *s, diagnostic *why)
{
    pthread_mutex_lock(&st->task.life);
    const status code = begin(st, s, why);
    pthread_mutex_unlock(&st->task.life);
    if (code != STATUS_OK)
        study_destroy(s);
    return code;
}

bool studies_runs(studies *st, const char *name)
{
    pthread_mutex_lock(&st->lock);
    const bool runs = st->running && (!name || strcmp(st->name, name) == 0);
    pthread_mutex_unlock(&st->lock);
    return runs;
}

status studies_stop(studies *st, const char *name, diagnostic *why)
{
    pthread_mutex_lock(&st->task.life); /* otherwise the next study might be stopped */
    const bool runs = studies_runs(st, name);
    if (runs)
        cancel_set(&st->task.token);
    pthread_mutex_unlock(&st->task.life);
    return runs ? STATUS_OK
                : diagnose(why, STATUS_INTERRUPTED, "start the study first", "the study %s is not running", name);
}

bool studies_ending(void *st)
{
    return cancel_is_set(&((const studies *)st)->task.ending);
}

bool studies_begin_drawing(studies *st)
{
    return !atomic_exchange(&st->drawing, true);
}

void studies_end_drawing(studies *st)
{
    atomic_store(&st->drawing, false);
}
