#include "web/live/painter_private.h"
#include "scene/model/camera.h"
#include "report/json.h"
#include "scene/model/scene.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

/* How long those who want a scene as it is now wait for it. */
static const double scene_wait_s = 60.0;

/* --- what is asked from outside --- */

void painter_wake(painter *p)
{
    pthread_mutex_lock(&p->lock);
    p->woken = true;
    pthread_cond_signal(&p->wake);
    pthread_mutex_unlock(&p->lock);
}

static void wake(void *of)
{
    painter_wake(of);
}

void painter_wait(painter *p, const char *text)
{
    pthread_mutex_lock(&p->lock);
    snprintf(p->waiting_text, sizeof p->waiting_text, "%s", text ? text : "");
    p->waiting = text ? p->waiting_text : NULL;
    pthread_cond_broadcast(&p->news);
    pthread_cond_signal(&p->wake);
    while (text && p->busy)
        pthread_cond_wait(&p->news, &p->lock);
    pthread_mutex_unlock(&p->lock);
    p->listener.told(p->listener.context);
}

const picture *painter_take(painter *p)
{
    pthread_mutex_lock(&p->lock);
    const picture *newest = p->newest;
    if (newest)
        picture_keep(newest);
    pthread_mutex_unlock(&p->lock);
    return newest;
}

static struct timespec after(double seconds)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    t.tv_sec += (time_t)seconds;
    t.tv_nsec += (long)((seconds - floor(seconds)) * 1e9);
    t.tv_sec += t.tv_nsec / 1000000000;
    t.tv_nsec %= 1000000000;
    return t;
}

status painter_take_final(painter *p, double limit_s, const picture **out, diagnostic *why)
{
    const uint64_t wanted = desk_generation(p->desk);
    const struct timespec until = after(limit_s);
    status code = STATUS_OK;
    *out = NULL;
    pthread_mutex_lock(&p->lock);
    while (!*out && code == STATUS_OK) {
        if (p->newest && p->newest->final && p->newest->generation >= wanted) {
            picture_keep(*out = p->newest);
        } else if (p->trouble_code != STATUS_OK && p->stage_generation >= wanted) {
            *why = p->trouble;
            code = p->trouble_code;
        } else if (p->waiting) {
            code = diagnose(why, STATUS_INTERRUPTED, "ask again when it is done", "nothing is rendered now: %.200s",
                            p->waiting);
        } else if (p->stop || pthread_cond_timedwait(&p->news, &p->lock, &until) == ETIMEDOUT) {
            code = diagnose(why, STATUS_INTERRUPTED, "ask again", "the picture is not finished yet");
        }
    }
    pthread_mutex_unlock(&p->lock);
    return code;
}

live *painter_live(painter *p)
{
    return p->toy;
}

/* Is that generation, or a newer one, on the stage, or known not to get there? The lock is held. */
static bool is_settled(const painter *p, uint64_t wanted)
{
    return p->stage_generation >= wanted && (p->stage_ready || p->trouble_code != STATUS_OK);
}

static status wait_for_scene(painter *p, diagnostic *why)
{
    const uint64_t wanted = desk_generation(p->desk);
    const struct timespec until = after(scene_wait_s);
    status code = STATUS_OK;
    pthread_mutex_lock(&p->lock);
    while (!is_settled(p, wanted) && code == STATUS_OK) {
        if (p->waiting)
            code = diagnose(why, STATUS_INTERRUPTED, "ask again when it is done", "nothing is traced now: %.200s",
                            p->waiting);
        else if (p->stop || pthread_cond_timedwait(&p->news, &p->lock, &until) == ETIMEDOUT)
            code = diagnose(why, STATUS_INTERRUPTED, "ask again", "the scene is still being loaded");
    }
    if (code == STATUS_OK && !p->stage_ready) {
        *why = p->trouble;
        code = p->trouble_code;
    }
    pthread_mutex_unlock(&p->lock);
    return code;
}

/* The stage lock is held. */
static bool is_there_still(painter *p)
{
    pthread_mutex_lock(&p->lock);
    const bool is = p->stage_ready && p->stage_generation > 0;
    pthread_mutex_unlock(&p->lock);
    return is;
}

/* Between the two locks the painter may have begun with another scene, which then is waited for. */
status painter_with_scene(painter *p, status (*look)(void *context, scene *s, diagnostic *why), void *context,
                          diagnostic *why)
{
    for (;;) {
        status code = wait_for_scene(p, why);
        if (code != STATUS_OK)
            return code;
        pthread_rwlock_rdlock(&p->stage_lock);
        const bool is_there = is_there_still(p);
        if (is_there)
            code = look(context, p->stage, why);
        pthread_rwlock_unlock(&p->stage_lock);
        if (is_there)
            return code;
    }
}

static bool prepare_locks(painter *p)
{
    pthread_condattr_t monotonic;
    if (pthread_condattr_init(&monotonic) != 0)
        return false;
    pthread_condattr_setclock(&monotonic, CLOCK_MONOTONIC);
    pthread_rwlockattr_t kind;
    if (pthread_rwlockattr_init(&kind) != 0) {
        pthread_condattr_destroy(&monotonic);
        return false;
    }
    /* Those who look, one after another without a gap, shall not keep the painter from going on. */
    pthread_rwlockattr_setkind_np(&kind, PTHREAD_RWLOCK_PREFER_WRITER_NONRECURSIVE_NP);
    const bool good = pthread_mutex_init(&p->lock, NULL) == 0 && pthread_rwlock_init(&p->stage_lock, &kind) == 0 &&
                      pthread_cond_init(&p->wake, NULL) == 0 && pthread_cond_init(&p->news, &monotonic) == 0;
    pthread_rwlockattr_destroy(&kind);
    pthread_condattr_destroy(&monotonic);
    return good;
}

static void release(painter *p)
{
    live_detach(p->toy);
    live_destroy(p->toy);
    scene_destroy(p->stage);
    picture_release(p->newest);
    job_destroy(p->tracer);
    pthread_rwlock_destroy(&p->stage_lock);
    pthread_cond_destroy(&p->wake);
    pthread_cond_destroy(&p->news);
    pthread_mutex_destroy(&p->lock);
    free(p);
}

status painter_create(desk *d, isa level, const painter_listener *listener, painter **out, diagnostic *why)
{
    *out = NULL;
    painter *p = calloc(1, sizeof *p);
    if (!p || !prepare_locks(p)) {
        free(p);
        return out_of_memory(why);
    }
    p->desk = d;
    p->listener = *listener;
    p->traced.step = p->raster.step = 3; /* until it is known how long frames take */
    p->toy = live_create(wake, p);
    const job_settings settings = {.level = &level, .stop = painter_must_end, .context = p};
    status code = p->toy ? job_create(&settings, &p->tracer, why) : out_of_memory(why);
    if (code == STATUS_OK && pthread_create(&p->thread, NULL, painter_thread, p) != 0)
        code = diagnose(why, STATUS_FAILURE, "end other programs", "no thread can be started");
    if (code == STATUS_OK)
        *out = p;
    else
        release(p);
    return code;
}

void painter_end(painter *p)
{
    pthread_mutex_lock(&p->lock);
    p->stop = true;
    pthread_cond_broadcast(&p->news);
    pthread_cond_signal(&p->wake);
    pthread_mutex_unlock(&p->lock);
    live_stop(p->toy);
    pthread_join(p->thread, NULL);
}

void painter_destroy(painter *p)
{
    if (p)
        release(p);
}

/* --- the state --- */

static json_t *vector_json(vec3 v)
{
    return json_pack("[o,o,o]", json_of_real(v.x), json_of_real(v.y), json_of_real(v.z));
}

static json_t *camera_json(const scene *s)
{
    const camera_frame f = camera_frame_of(s);
    const double distance = s->camera.aimed ? vec3_length(vec3_sub(s->camera.target, s->camera.position)) : 0.0;
    json_t *o = json_pack("{s:o,s:o,s:o,s:o,s:o,s:o}", "eye", vector_json(f.eye), "forward", vector_json(f.forward),
                          "right", vector_json(f.right), "up", vector_json(f.up), "half_width",
                          json_of_real(f.half_width), "half_height", json_of_real(f.half_height));
    if (!o)
        return NULL;
    json_object_set_new(o, "target", s->camera.aimed ? vector_json(s->camera.target) : json_null());
    json_object_set_new(o, "distance", s->camera.aimed ? json_of_real(distance) : json_null());
    return o;
}

bool painter_tell(painter *p, json_t *state)
{
    scene *now = desk_take(p->desk, NULL);
    pthread_mutex_lock(&p->lock);
    int bad = json_object_set_new(state, "trouble",
                                  p->trouble_code != STATUS_OK ? json_of_diagnostic(&p->trouble) : json_null());
    bad |= json_object_set_new(state, "waiting", p->waiting ? json_of_text(p->waiting) : json_null());
    bad |= json_object_set_new(state, "picture", p->newest ? picture_json(p->newest) : json_null());
    pthread_mutex_unlock(&p->lock);
    bad |= now ? json_object_set_new(state, "camera", camera_json(now)) : 1;
    scene_destroy(now);
    return !bad;
}
