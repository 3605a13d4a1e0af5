#include "web/session/studies.h"
#include "base/float_environment.h"
#include "base/text.h"
#include "measure/clock.h"
#include "report/json.h"
#include <math.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>

/* Pages are told at most four times a second: telling takes time from what is measured. */
static const double told_every_s = 0.25;

struct studies {
    lab *l;
    pthread_mutex_t life; /* held while a thread is begun or joined; goes before lock */
    pthread_t thread;
    bool begun; /* there is a thread to be joined */
    study *s;   /* the thread's while it runs */
    atomic_bool stop, ending, drawing;

    pthread_mutex_t lock; /* of what follows */
    bool running;
    char *name; /* of the one that runs or ran last; NULL before the first */
    study_moment now;
    double told_s;
    bool failed;
    diagnostic trouble;
};

status studies_create(lab *l, studies **out, diagnostic *why)
{
    *out = calloc(1, sizeof **out);
    if (!*out)
        return out_of_memory(why);
    (*out)->l = l;
    pthread_mutex_init(&(*out)->life, NULL);
    pthread_mutex_init(&(*out)->lock, NULL);
    return STATUS_OK;
}

/* Under life. */
static void join(studies *st)
{
    if (!st->begun)
        return;
    pthread_join(st->thread, NULL);
    st->begun = false;
    study_destroy(st->s);
    st->s = NULL;
}

void studies_end(studies *st)
{
    pthread_mutex_lock(&st->life);
    atomic_store(&st->ending, true);
    atomic_store(&st->stop, true);
    join(st);
    pthread_mutex_unlock(&st->life);
}

void studies_destroy(studies *st)
{
    if (!st)
        return;
    studies_end(st);
    pthread_mutex_destroy(&st->life);
    pthread_mutex_destroy(&st->lock);
    free(st->name);
    free(st);
}

/* --- what others hear of it --- */

json_t *studies_tell(studies *st)
{
    static const char *const stages[] = {"measuring", "moving", "pictures"};
    pthread_mutex_lock(&st->lock);
    const study_moment *now = &st->now;
    json_t *told =
        !st->name ? json_null()
                  : json_pack("{s:s, s:b, s:I, s:I, s:o, s:I, s:o, s:s, s:I, s:I, s:o}", "name", st->name, "running",
                              st->running, "frames_done", (json_int_t)now->frames_done, "frames_all",
                              (json_int_t)now->frames_all, "left_s", json_of_real(now->left_s), "cell",
                              (json_int_t)now->cell, "share", json_of_real(now->share), "stage", stages[now->stage],
                              "picture", (json_int_t)now->img, "pictures", (json_int_t)now->images, "error",
                              st->failed ? json_of_diagnostic(&st->trouble) : json_null());
    pthread_mutex_unlock(&st->lock);
    return told;
}

static void publish(studies *st)
{
    lab_publish(st->l, "study", studies_tell(st));
}

static void hear(void *context, const study_moment *now)
{
    studies *st = context;
    const double now_s = clock_wall_s();
    pthread_mutex_lock(&st->lock);
    const bool due = now_s - st->told_s >= told_every_s;
    st->now = *now;
    if (due)
        st->told_s = now_s;
    pthread_mutex_unlock(&st->lock);
    if (due)
        publish(st);
}

static bool should_stop(void *context)
{
    const studies *st = context;
    return atomic_load(&st->stop);
}

/* --- the run --- */

static void *run(void *context)
{
    studies *st = context;
    float_environment_set();
    char *text = text_format("a study measures: %s", st->s->name);
    render_worker_suspend(st->l->render_worker, text ? text : "a study measures");
    free(text);
    lab_tell_state(st->l);
    const study_options options = {
        .results = st->l->settings.results, .stop = should_stop, .progressed = hear, .context = st};
    diagnostic why = {.what = ""};
    const status code = study_run(st->s, &options, NULL, &why);
    render_worker_suspend(st->l->render_worker, NULL);
    pthread_mutex_lock(&st->lock);
    st->running = false;
    st->failed = code != STATUS_OK && code != STATUS_INTERRUPTED;
    st->trouble = why;
    pthread_mutex_unlock(&st->lock);
    publish(st);
    lab_tell_state(st->l);
    return NULL;
}

/* Under life. Takes the place of what ran before; STATUS_INTERRUPTED while that still runs. */
static status take_place(studies *st, study *s, diagnostic *why)
{
    char *name = strdup(s->name);
    if (!name)
        return out_of_memory(why);
    pthread_mutex_lock(&st->lock);
    const bool busy = st->running;
    if (busy)
        diagnose(why, STATUS_INTERRUPTED, "wait for it, or stop it first", "the study %s runs", st->name);
    if (!busy) {
        free(st->name);
        st->name = name;
        st->now = (study_moment){.left_s = NAN};
        st->told_s = 0;
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
    if (atomic_load(&st->ending))
        return diagnose(why, STATUS_INTERRUPTED, "start it again", "the laboratory is being closed");
    TRY(take_place(st, s, why));
    join(st);
    st->s = s;
    atomic_store(&st->stop, false);
    st->begun = pthread_create(&st->thread, NULL, run, st) == 0;
    if (st->begun)
        return STATUS_OK;
    st->s = NULL;
    pthread_mutex_lock(&st->lock);
    st->running = false;
    pthread_mutex_unlock(&st->lock);
    return diagnose(why, STATUS_FAILURE, "", "no thread can be started");
}

status studies_start(studies *st, study *s, diagnostic *why)
{
    pthread_mutex_lock(&st->life);
    const status code = begin(st, s, why);
    pthread_mutex_unlock(&st->life);
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
    pthread_mutex_lock(&st->life); /* else it might be the next one that is stopped */
    const bool runs = studies_runs(st, name);
    if (runs)
        atomic_store(&st->stop, true);
    pthread_mutex_unlock(&st->life);
    return runs ? STATUS_OK : diagnose(why, STATUS_INTERRUPTED, "start it first", "the study %s does not run", name);
}

const atomic_bool *studies_ending(const studies *st)
{
    return &st->ending;
}

bool studies_begin_drawing(studies *st)
{
    return !atomic_exchange(&st->drawing, true);
}

void studies_end_drawing(studies *st)
{
    atomic_store(&st->drawing, false);
}
