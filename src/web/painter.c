#include "web/painter.h"
#include "measure/clock.h"
#include "measure/topology.h"
#include "scene/camera.h"
#include "scene/motion.h"
#include "render/renderer.h"
#include "report/json.h"
#include "web/pace.h"
#include "web/passes.h"
#include "web/picture.h"

#include <errno.h>
#include <math.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

/* How long the first pass may take; how often a render looks up for something newer; of a frame of the live slime, how long its motion and its picture may take;
 * and how long those who want a scene as it is now wait for it. */
static const double first_s = 0.04, look_up_s = 0.002, move_s = 0.02, live_frame_s = 0.03, scene_wait_s = 60.0;

/* So often may a first pass be ended by newer changes before one is let through: who watches somebody else's drag shall see it. But no longer
 * than so: what takes minutes must not keep back what is newer. */
enum { ENDED_MAX = 12 };
static const double let_through_s = 0.5;

struct painter {
    desk *desk;
    live *toy;
    isa level;
    painter_listener listener;
    pthread_t thread;
    renderer *tracer;
    topology *machine;

    pthread_mutex_t lock; /* of what follows */
    pthread_cond_t wake, news;
    bool woken, stop, busy;
    char *waiting;
    const picture *newest;
    uint64_t serial;
    diagnostic trouble;
    status trouble_code;            /* of the stage's generation */
    uint64_t stage_generation;      /* 0: none yet */
    bool stage_ready;               /* loaded */

    pthread_rwlock_t stage_lock;    /* read to look at the stage or to render it, written to replace or move it */
    scene *stage;

    /* the thread's own */
    pass_plan plan;
    int pass;                       /* next */
    double rate;
    int ended;                      /* first passes in a row, and loads before them */
    double begun_s;                 /* when what is on its way, a load or a pass, began */
    uint64_t taken;                 /* the generation that the stage is a copy of, loaded or not; 0: to be taken anew */
    bool was_on;
    pace traced, raster;            /* of the film of the live slime */
};

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
    char *copy = text ? strdup(text) : NULL;
    pthread_mutex_lock(&p->lock);
    free(p->waiting);
    p->waiting = copy;
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
            code = diagnose(why, STATUS_INTERRUPTED, "ask again when it is done", "nothing is rendered now: %.200s", p->waiting);
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
            code = diagnose(why, STATUS_INTERRUPTED, "ask again when it is done", "nothing is traced now: %.200s", p->waiting);
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
status painter_with_scene(painter *p, status (*look)(void *context, scene *s, diagnostic *why), void *context, diagnostic *why)
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

/* --- what the thread tells --- */

static void tell(painter *p)
{
    p->listener.told(p->listener.context);
}

/* With the lock held; true where pages are to be told. */
static bool take_trouble(painter *p, status code, const diagnostic *why)
{
    const bool differs = code != p->trouble_code || (code != STATUS_OK && strcmp(why->what, p->trouble.what) != 0);
    p->trouble_code = code;
    p->trouble = *why;
    pthread_cond_broadcast(&p->news);
    return differs;
}

static void set_trouble(painter *p, status code, const diagnostic *why)
{
    pthread_mutex_lock(&p->lock);
    const bool differs = take_trouble(p, code, why);
    pthread_mutex_unlock(&p->lock);
    if (differs)
        tell(p);
}

static void publish(painter *p, picture *shown)
{
    pthread_mutex_lock(&p->lock);
    shown->serial = ++p->serial;
    pthread_mutex_unlock(&p->lock);
    const picture *made = picture_create(shown);
    if (!made) {
        image_destroy((image *)(uintptr_t)shown->linear);
        scene_destroy((scene *)(uintptr_t)shown->of);
        return;
    }
    picture_keep(made); /* for the listener */
    pthread_mutex_lock(&p->lock);
    const picture *before = p->newest;
    p->newest = made;
    pthread_cond_broadcast(&p->news);
    pthread_mutex_unlock(&p->lock);
    picture_release(before);
    p->listener.published(p->listener.context, made);
    picture_release(made);
}

/* --- the thread: the stage --- */

static bool is_stale(painter *p)
{
    return desk_generation(p->desk) != p->taken;
}

/* Shall what is on its way end? A first pass that was ended too often goes on for a while. */
static bool must_end(painter *p)
{
    pthread_mutex_lock(&p->lock);
    const bool now = p->stop || p->waiting;
    pthread_mutex_unlock(&p->lock);
    const bool let_through = p->ended >= ENDED_MAX && clock_wall_s() - p->begun_s < let_through_s;
    return now || (is_stale(p) && !let_through) || (live_is_due(p->toy) && p->pass > 0);
}

/* A slime's way to its moment may be long: it ends where that is no longer wanted, by the desk or by who plays with it. */
static bool go_on_loading(void *of, double share_done)
{
    (void)share_done;
    return !must_end(of) && !live_is_due(((painter *)of)->toy);
}

static status load_stage(painter *p, diagnostic *why)
{
    const load_watch watch = {go_on_loading, p};
    p->begun_s = clock_wall_s();
    return scene_load_until(p->stage, &watch, why);
}

static bool has_slime(const painter *p)
{
    return p->stage && scene_moves(p->stage);
}

/* Under the stage lock, so that nobody looks at a stage that is not loaded. */
static void set_ready(painter *p, bool ready)
{
    pthread_mutex_lock(&p->lock);
    p->stage_ready = ready;
    pthread_mutex_unlock(&p->lock);
}

/* The stage becomes what is on the desk, with as much as possible of what was loaded before. */
static void renew_stage(painter *p)
{
    diagnostic why = {.line = 0};
    uint64_t generation;
    scene *next = desk_take(p->desk, &generation);
    p->taken = generation; /* before it is loaded, which ends when there is a newer one */
    const bool had_slime = has_slime(p);
    pthread_rwlock_wrlock(&p->stage_lock);
    set_ready(p, false);
    status code = next ? STATUS_OK : diagnose(&why, STATUS_FAILURE, "", "out of memory");
    if (next) {
        if (p->stage && !live_is_on(p->toy))
            scene_borrow_meshes(next, p->stage);
        live_detach(p->toy);
        scene_destroy(p->stage);
        p->stage = next;
        code = live_attach(p->toy, next, &why);
    }
    if (code == STATUS_OK)
        code = load_stage(p, &why);
    pthread_rwlock_unlock(&p->stage_lock);
    if (code == STATUS_OK && !live_is_on(p->toy))
        desk_lend(p->desk, p->stage, generation);
    pthread_mutex_lock(&p->lock);
    p->stage_generation = code == STATUS_INTERRUPTED ? 0 : generation; /* 0: begun again, from what was loaded so far */
    p->stage_ready = code == STATUS_OK;
    const bool differs = take_trouble(p, code == STATUS_INTERRUPTED ? STATUS_OK : code, &why);
    pthread_mutex_unlock(&p->lock);
    if (differs || has_slime(p) != had_slime) /* which is part of the state */
        tell(p);
    if (code == STATUS_INTERRUPTED) {
        p->ended += is_stale(p);
        p->taken = 0;
    }
    p->pass = 0;
    p->plan = code == STATUS_OK ? passes_plan(&p->stage->render, p->rate, first_s) : (pass_plan){.count = 0};
}

static bool is_bare(const scene *stage)
{
    bool bare = false;
    for (size_t i = 0; i < stage->mesh_count; i++)
        bare |= !stage->meshes[i].data;
    return bare;
}

/* The slime's orders and its motion; a stage that moved is painted anew. What it leaves without a mesh, whenever the order came, is loaded. */
static void move_stage(painter *p)
{
    diagnostic why = {.line = 0};
    bool told = false;
    pthread_rwlock_wrlock(&p->stage_lock);
    status code = live_advance(p->toy, move_s, &told, &why);
    const bool moved = live_take_moved(p->toy), ended = (p->was_on && !live_is_on(p->toy)) || (p->stage_ready && is_bare(p->stage));
    p->was_on = live_is_on(p->toy);
    if (code == STATUS_OK && ended)
        code = load_stage(p, &why);
    if (code != STATUS_OK)
        set_ready(p, false);
    pthread_rwlock_unlock(&p->stage_lock);
    if (code == STATUS_INTERRUPTED) {
        pthread_mutex_lock(&p->lock);
        p->stage_generation = 0;
        pthread_mutex_unlock(&p->lock);
        p->taken = 0; /* begun again */
    } else if (code != STATUS_OK) {
        set_trouble(p, code, &why);
    }
    if (moved || ended || told) {
        p->pass = 0;
        p->plan = passes_plan(&p->stage->render, p->rate, first_s);
    }
    if (told)
        tell(p);
}

/* --- the thread: one pass --- */

static bool go_on_rendering(void *of, double share_done)
{
    (void)share_done;
    return !must_end(of);
}

static bool is_raster(painter *p, bool moving)
{
    return moving && live_preview_of(p->toy) == LIVE_ZBUFFER;
}

/* The pass's own settings on a scene that is the stage's otherwise. tempo: of a film that moves; else NULL. */
static scene pass_scene(const painter *p, int pass, const pace *tempo, bool raster)
{
    scene view = *p->stage;
    view.render = tempo ? passes_settings(&p->stage->render, pace_shrink(tempo), true)
                       : passes_settings(&p->stage->render, p->plan.shrink[pass], p->plan.single[pass]);
    if (raster) {
        view.render.integrator = INTEGRATOR_ZBUFFER;
        view.render.spectrum = SPECTRUM_RGB;
    }
    return view;
}

static bool describe(painter *p, const render_result *made, int pass, bool moving, picture *out)
{
    image *linear = NULL;
    if (film_image(made->picture, &linear, NULL) != STATUS_OK)
        return false;
    const bool final = !moving && pass == p->plan.count - 1;
    *out = (picture){.generation = p->stage_generation, .pass = pass + 1, .passes = p->plan.count, .final = final, .width = made->picture->width,
                     .height = made->picture->height, .full_width = (int)p->stage->render.width, .full_height = (int)p->stage->render.height,
                     .wall_s = made->wall_s, .cpu_s = made->cpu_s, .rays = ray_counters_total(&made->counters), .noise = render_noise_rms(made),
                     .threads = made->worker_count, .linear = linear};
    if (final) {
        out->film_hash = film_hash(made->picture);
        out->of = scene_clone(p->stage);
    }
    return true;
}

static void take_rate(painter *p, int pass, const render_result *made)
{
    if (made->wall_s > 0.0)
        p->rate = passes_work(&p->stage->render, p->plan.shrink[pass], p->plan.single[pass]) / made->wall_s;
}

static void paint_pass(painter *p)
{
    const int pass = p->pass;
    const bool moving = live_is_moving(p->toy);
    const bool raster = is_raster(p, moving);
    pace *tempo = !moving ? NULL : raster ? &p->raster : &p->traced;
    const scene view = pass_scene(p, pass, tempo, raster);
    const render_options options = {.progress = go_on_rendering, .progress_s = look_up_s, .context = p};
    diagnostic why = {.line = 0};
    render_result *made = NULL;
    picture shown;
    bool good = false;
    p->begun_s = clock_wall_s();
    pthread_rwlock_rdlock(&p->stage_lock);
    const status code = renderer_render(p->tracer, &view, &options, &made, &why);
    if (code == STATUS_OK)
        good = describe(p, made, pass, moving, &shown);
    pthread_rwlock_unlock(&p->stage_lock);
    if (code == STATUS_OK) {
        if (tempo)
            pace_take(tempo, made->wall_s, live_frame_s);
        else
            take_rate(p, pass, made);
        p->pass = moving ? p->plan.count : pass + 1;
        p->ended = 0;
    } else if (code == STATUS_INTERRUPTED) {
        p->ended += pass == 0 && is_stale(p);
    } else {
        p->pass = p->plan.count;
    }
    render_result_destroy(made);
    if (code != STATUS_INTERRUPTED)
        set_trouble(p, code, &why);
    if (good)
        publish(p, &shown);
}

/* --- the thread itself --- */

/* Sleeps until there is something to do; false when it is to end. */
static bool wait_for_work(painter *p)
{
    pthread_mutex_lock(&p->lock);
    for (;;) {
        pthread_mutex_unlock(&p->lock);
        const bool due = is_stale(p) || (p->stage_ready && p->pass < p->plan.count) || live_is_due(p->toy);
        pthread_mutex_lock(&p->lock);
        if (p->stop || (due && !p->waiting))
            break;
        p->busy = false;
        pthread_cond_broadcast(&p->news);
        while (!p->woken && !p->stop && (p->waiting || !due))
            pthread_cond_wait(&p->wake, &p->lock);
        p->woken = false;
    }
    p->busy = !p->stop;
    const bool go_on = !p->stop;
    pthread_mutex_unlock(&p->lock);
    return go_on;
}

static void *paint(void *of)
{
    painter *p = of;
    while (wait_for_work(p)) {
        if (is_stale(p))
            renew_stage(p);
        if (p->stage && (live_is_due(p->toy) || p->was_on))
            move_stage(p);
        if (p->stage_ready && p->pass < p->plan.count)
            paint_pass(p);
    }
    pthread_mutex_lock(&p->lock);
    p->busy = false;
    pthread_cond_broadcast(&p->news);
    pthread_mutex_unlock(&p->lock);
    return NULL;
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
    const bool good = pthread_mutex_init(&p->lock, NULL) == 0 && pthread_rwlock_init(&p->stage_lock, &kind) == 0 && pthread_cond_init(&p->wake, NULL) == 0 &&
                      pthread_cond_init(&p->news, &monotonic) == 0;
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
    renderer_destroy(p->tracer);
    topology_destroy(p->machine);
    free(p->waiting);
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
        return diagnose(why, STATUS_FAILURE, "", "out of memory");
    }
    p->desk = d;
    p->level = level;
    p->listener = *listener;
    p->traced.step = p->raster.step = 3; /* until it is known how long frames take */
    p->toy = live_create(wake, p);
    status code = p->toy ? topology_create(&p->machine, why) : diagnose(why, STATUS_FAILURE, "", "out of memory");
    if (code == STATUS_OK)
        code = renderer_create(level, p->machine, &p->tracer, why);
    if (code == STATUS_OK && pthread_create(&p->thread, NULL, paint, p) != 0)
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
    json_t *o = json_pack("{s:o,s:o,s:o,s:o,s:o,s:o}", "eye", vector_json(f.eye), "forward", vector_json(f.forward), "right", vector_json(f.right), "up",
                          vector_json(f.up), "half_width", json_of_real(f.half_width), "half_height", json_of_real(f.half_height));
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
    int bad = json_object_set_new(state, "trouble", p->trouble_code != STATUS_OK ? json_of_diagnostic(&p->trouble) : json_null());
    bad |= json_object_set_new(state, "waiting", p->waiting ? json_of_text(p->waiting) : json_null());
    bad |= json_object_set_new(state, "picture", p->newest ? picture_json(p->newest) : json_null());
    pthread_mutex_unlock(&p->lock);
    bad |= now ? json_object_set_new(state, "camera", camera_json(now)) : 1;
    scene_destroy(now);
    return !bad;
}
