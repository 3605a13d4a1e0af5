/* Scene handles: creating, reading, cloning, checking, loading, writing. */
#include "engine/engine_private.h"
#include "lint/lint.h"
#include "measure/clock.h"
#include "scene/file/shared.h"
#include "scene/file/write.h"

#include <stdlib.h>
#include <string.h>

/* Recursive: a progress function that is called while the scene is loaded may clone or write it. */
static bool init_loading(pthread_mutex_t *lock)
{
    pthread_mutexattr_t kind;
    if (pthread_mutexattr_init(&kind) != 0)
        return false;
    const bool made =
        pthread_mutexattr_settype(&kind, PTHREAD_MUTEX_RECURSIVE) == 0 && pthread_mutex_init(lock, &kind) == 0;
    pthread_mutexattr_destroy(&kind);
    return made;
}

cuvette_status engine_own_scene(scene *model, cuvette_scene **out, cuvette_diagnostic *why)
{
    diagnostic inner = {.line = 0};
    cuvette_scene *s = model ? calloc(1, sizeof *s) : NULL;
    if (!s || !init_loading(&s->loading)) {
        free(s);
        scene_destroy(model);
        return engine_report(out_of_memory(&inner), &inner, why);
    }
    s->model = model;
    atomic_init(&s->owners, 1);
    *out = s;
    return CUVETTE_OK;
}

cuvette_status cuvette_scene_create(cuvette_scene **out, cuvette_diagnostic *why)
{
    ENGINE_CALL(out);
    *out = NULL;
    return engine_own_scene(scene_create(), out, why);
}

cuvette_status cuvette_scene_read(const char *path, cuvette_scene **out, cuvette_diagnostic *why)
{
    ENGINE_CALL(out);
    *out = NULL;
    ENGINE_NEED(path);
    scene *model = NULL;
    const status code = scene_read(path, &model, &inner);
    return code == STATUS_OK ? engine_own_scene(model, out, why) : engine_report(code, &inner, why);
}

cuvette_status cuvette_scene_read_text(const char *name, const char *text, size_t size, cuvette_scene **out,
                                       cuvette_diagnostic *why)
{
    ENGINE_CALL(out);
    *out = NULL;
    ENGINE_NEED(name, text);
    scene *model = NULL;
    const status code = scene_read_text(name, text, size, &model, &inner);
    return code == STATUS_OK ? engine_own_scene(model, out, why) : engine_report(code, &inner, why);
}

/* Locks the scene (its lock `loading`) against loading by another thread: renders of one scene may begin together, and
 * each checks what is loaded. */
static cuvette_scene *lock_scene(const cuvette_scene *s)
{
    cuvette_scene *held = (cuvette_scene *)(uintptr_t)s; /* handles are never const objects */
    pthread_mutex_lock(&held->loading);
    return held;
}

cuvette_status cuvette_scene_clone(const cuvette_scene *s, cuvette_scene **out, cuvette_diagnostic *why)
{
    ENGINE_CALL(out);
    *out = NULL;
    ENGINE_NEED(s);
    cuvette_scene *source = lock_scene(s);
    scene *model = scene_clone(source->model);
    const bool grabbed = source->grabbed;
    pthread_mutex_unlock(&source->loading);
    ENGINE_TRY(engine_own_scene(model, out, why));
    (*out)->grabbed = grabbed;
    return CUVETTE_OK;
}

void engine_release_scene(cuvette_scene *s)
{
    if (atomic_fetch_sub(&s->owners, 1) > 1)
        return;
    pthread_mutex_destroy(&s->loading);
    free(s);
}

void cuvette_scene_destroy(cuvette_scene *s)
{
    if (!s)
        return;
    scene_destroy(s->model);
    s->model = NULL; /* shows the scene's motions that it is destroyed */
    engine_release_scene(s);
}

static cuvette_status busy(const char *remedy, const char *what, cuvette_diagnostic *why)
{
    diagnostic inner = {.line = 0};
    engine_report(diagnose(&inner, STATUS_BAD_INPUT, remedy, "%s", what), &inner, why);
    return CUVETTE_BUSY;
}

static cuvette_status is_rendered(cuvette_diagnostic *why)
{
    return busy("wait for the render to end, cancel it, or change a clone", "the scene is being rendered", why);
}

cuvette_status engine_is_advancing(cuvette_diagnostic *why)
{
    return busy("wait for cuvette_motion_advance to return", "the scene's slimes are being advanced", why);
}

cuvette_status engine_need_change(const char *names, const void *const *arguments, cuvette_diagnostic *why)
{
    const cuvette_scene *s = arguments[0];
    return s && atomic_load(&s->renders) > 0 ? is_rendered(why)
           : s && atomic_load(&s->advancing) ? engine_is_advancing(why)
                                             : engine_need(names, arguments, why);
}

/* Each side announces itself before it checks for the other: of two that begin at the same time at least one sees the
 * other. */
cuvette_status engine_begin_render(cuvette_scene *s, cuvette_diagnostic *why)
{
    atomic_fetch_add(&s->renders, 1);
    if (!atomic_load(&s->advancing))
        return CUVETTE_OK;
    engine_end_render(s);
    return engine_is_advancing(why);
}

void engine_end_render(cuvette_scene *s)
{
    atomic_fetch_sub(&s->renders, 1);
}

cuvette_status engine_begin_advance(cuvette_scene *s, cuvette_diagnostic *why)
{
    if (atomic_exchange(&s->advancing, true))
        return engine_is_advancing(why);
    if (atomic_load(&s->renders) == 0)
        return CUVETTE_OK;
    engine_end_advance(s);
    return is_rendered(why);
}

void engine_end_advance(cuvette_scene *s)
{
    atomic_store(&s->advancing, false);
}

status engine_load(cuvette_scene *s, const load_watch *watch, diagnostic *why)
{
    pthread_mutex_lock(&s->loading);
    const status code = scene_load_until(s->model, watch, why);
    pthread_mutex_unlock(&s->loading);
    return code;
}

void engine_report_progress(host_progress *p, double fraction)
{
    static const double every_s = 0.1;
    if (fraction > p->fraction)
        p->fraction = fraction;
    if (!p->callback || cancel_is_set(&p->token))
        return;
    p->next_s = clock_wall_s() + every_s;
    float_environment_leave(p->host);
    const bool wants_more = p->callback(p->context, p->fraction);
    float_environment_enter(p->host);
    if (!wants_more)
        cancel_set(&p->token);
}

void engine_report_if_due(void *context, double fraction)
{
    host_progress *p = context;
    if (p->callback && clock_wall_s() >= p->next_s)
        engine_report_progress(p, fraction);
    else if (fraction > p->fraction)
        p->fraction = fraction;
}

/* The ask of the progress's token. */
static bool host_cancels(void *context)
{
    const host_progress *p = context;
    engine_report_if_due(context, p->fraction);
    return cancel_is_set(&p->token);
}

void engine_begin_progress(host_progress *p)
{
    p->token = (cancel_token){.ask = host_cancels, .context = p};
    cancel_begin(&p->token);
}

void engine_end_progress(host_progress *p)
{
    cancel_end(&p->token);
}

cuvette_status cuvette_scene_load(const cuvette_scene *s, bool (*progress)(void *context, double fraction),
                                  void *context, cuvette_diagnostic *why)
{
    ENGINE_CALL(s);
    cuvette_scene *held = (cuvette_scene *)(uintptr_t)s; /* handles are never const objects */
    host_progress report = {.callback = progress, .context = context, .host = &host};
    ENGINE_TRY(engine_begin_render(held, why)); /* the callback must not change the scene */
    status code = engine_check(held, &inner);
    engine_begin_progress(&report);
    THEN(code, engine_load(held, &(load_watch){engine_report_if_due, &report}, &inner));
    engine_end_progress(&report);
    engine_end_render(held);
    return engine_report(code, &inner, why);
}

status engine_check(const cuvette_scene *s, diagnostic *why)
{
    cuvette_scene *held = lock_scene(s);
    const status code = scene_check(held->model, why);
    pthread_mutex_unlock(&held->loading);
    return code;
}

cuvette_status cuvette_scene_check(const cuvette_scene *s, cuvette_diagnostic *why)
{
    ENGINE_CALL(s);
    return engine_report(engine_check(s, &inner), &inner, why);
}

typedef struct host_call {
    void (*note)(void *context, const char *text);
    void *context;
    float_environment *host; /* the caller's, for the callback */
} host_call;

static void call_host(void *context, const scene_note *note)
{
    const host_call *h = context;
    char line[NOTE_LINE_MAX];
    note_line(note, line, sizeof line);
    float_environment_leave(h->host);
    h->note(h->context, line);
    float_environment_enter(h->host);
}

cuvette_status cuvette_scene_hints(const cuvette_scene *s, void (*note)(void *context, const char *text), void *context,
                                   cuvette_diagnostic *why)
{
    ENGINE_CALL(s);
    ENGINE_NEED_NAMED(note, "note");
    cuvette_scene *held = lock_scene(s);
    scene *copy = scene_clone(held->model); /* the callback may use the scene */
    pthread_mutex_unlock(&held->loading);
    if (!copy)
        return engine_report(out_of_memory(&inner), &inner, why);
    const note_sink taker = {call_host, &(host_call){note, context, &host}};
    scene_hints(copy, &taker);
    scene_beam_range_hints(copy, &taker);
    scene_destroy(copy);
    return CUVETTE_OK;
}

cuvette_status engine_copy_text(char *content, char *text, size_t size, size_t *length, cuvette_diagnostic *why)
{
    const size_t needed = strlen(content);
    if (length)
        *length = needed;
    const bool fits = needed < size;
    if (fits)
        memcpy(text, content, needed + 1);
    free(content);
    if (fits)
        return CUVETTE_OK;
    diagnostic inner = {.line = 0};
    return engine_report(diagnose(&inner, STATUS_BAD_INPUT, "make room for the reported length plus 1",
                                  "the text has %zu characters, but the buffer only %zu bytes", needed, size),
                         &inner, why);
}

cuvette_status cuvette_scene_write(const cuvette_scene *s, const char *path, cuvette_diagnostic *why)
{
    ENGINE_CALL(s, path);
    cuvette_scene *held = lock_scene(s);
    const status code = scene_write(held->model, path, false, &inner);
    pthread_mutex_unlock(&held->loading);
    return engine_report(code, &inner, why);
}

static status make_text(const scene *s, char **text, diagnostic *why)
{
    return scene_write_text(s, NULL, false, text, why);
}

static status make_link(const scene *s, char **code, diagnostic *why)
{
    char *text = NULL;
    TRY(shared_scene_text(s, &text, why));
    const status result = shared_scene_code(text, code, why);
    free(text);
    return result;
}

/* Copies the text that `make` creates from the scene; inner: the diagnostic of the calling function. */
static cuvette_status copy_text_of(const cuvette_scene *s, status (*make)(const scene *s, char **text, diagnostic *why),
                                   char *text, size_t size, size_t *length, diagnostic *inner, cuvette_diagnostic *why)
{
    if (size > 0)
        ENGINE_NEED(text);
    char *content = NULL;
    cuvette_scene *held = lock_scene(s);
    const status code = make(held->model, &content, inner);
    pthread_mutex_unlock(&held->loading);
    return code == STATUS_OK ? engine_copy_text(content, text, size, length, why) : engine_report(code, inner, why);
}

cuvette_status cuvette_scene_write_text(const cuvette_scene *s, char *text, size_t size, size_t *length,
                                        cuvette_diagnostic *why)
{
    ENGINE_CALL(s);
    return copy_text_of(s, make_text, text, size, length, &inner, why);
}

cuvette_status cuvette_scene_write_link(const cuvette_scene *s, char *text, size_t size, size_t *length,
                                        cuvette_diagnostic *why)
{
    ENGINE_CALL(s);
    return copy_text_of(s, make_link, text, size, length, &inner, why);
}
