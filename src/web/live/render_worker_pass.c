/* One pass of the render worker: its settings, the render and the resulting image. See
 * web/live/render_worker_private.h. */
#include "web/live/render_worker_private.h"
#include "base/cancel.h"
#include "measure/clock.h"
#include "report/report.h"
#include "scene/model/scene.h"
#include "scene/model/camera.h"

/* How often a render checks for an interruption; the target time of a live frame, for about 20 frames a second. */
static const double poll_s = 0.002, live_frame_s = 0.045;

static bool publish(render_worker *p, shared_image *shown)
{
    pthread_mutex_lock(&p->lock);
    shown->serial = ++p->serial;
    pthread_mutex_unlock(&p->lock);
    const shared_image *published = shared_image_create(shown);
    if (!published) {
        shared_image_drop(shown);
        return false;
    }
    shared_image_retain(published); /* for the listener */
    pthread_mutex_lock(&p->lock);
    const shared_image *before = p->newest;
    p->newest = published;
    pthread_cond_broadcast(&p->changed);
    pthread_mutex_unlock(&p->lock);
    shared_image_release(before);
    p->listener.published(p->listener.context, published);
    shared_image_release(published);
    return true;
}

static bool is_raster(render_worker *p, bool moving)
{
    return moving && live_preview_of(p->live_slime) == LIVE_ZBUFFER;
}

/* The snapshot's scene with the settings of the pass. tempo: of a moving scene; otherwise NULL. */
static scene pass_scene(const render_worker *p, int pass, const adaptive_resolution *tempo, bool raster)
{
    scene view = *p->snapshot;
    view.render = tempo ? passes_settings(&p->snapshot->render, adaptive_resolution_divisor(tempo), true)
                        : passes_settings(&p->snapshot->render, p->plan.shrink[pass], p->plan.single[pass]);
    if (raster) {
        draw_triangles(&view.render);
        view.render.spectrum = SPECTRUM_RGB;
    }
    return view;
}

static status describe(render_worker *p, const job_account *account, int pass, bool moving, shared_image *out,
                       diagnostic *why)
{
    const film *shown = account->result->img;
    image *linear = NULL;
    TRY(film_image(shown, &linear, why));
    linear->tone = camera_tone(p->snapshot);
    const bool final = !moving && pass == p->plan.count - 1;
    *out = (shared_image){.generation = p->snapshot_generation,
                          .pass = pass + 1,
                          .passes = p->plan.count,
                          .final = final,
                          .width = shown->width,
                          .height = shown->height,
                          .full_width = (int)p->snapshot->render.width,
                          .full_height = (int)p->snapshot->render.height,
                          .numbers = report_page(account),
                          .film_hash = final ? job_account_hash(account) : 0,
                          .linear = linear,
                          .of = final ? scene_clone(p->snapshot) : NULL};
    if (out->numbers && (out->of || !final))
        return STATUS_OK;
    shared_image_drop(out);
    return out_of_memory(why);
}

/* Smoothed, so that the images of a drag keep their size. */
static void take_rate(render_worker *p, int pass, const render_result *result)
{
    const double recent = 0.4;
    if (result->wall_s <= 0.0)
        return;
    const double rate = passes_work(&p->snapshot->render, p->plan.shrink[pass], p->plan.single[pass]) / result->wall_s;
    p->rate = p->rate > 0.0 ? p->rate + recent * (rate - p->rate) : rate;
}

void render_worker_begin_pass(render_worker *p, started_pass *out)
{
    const bool moving = live_is_moving(p->live_slime), raster = is_raster(p, moving);
    adaptive_resolution *tempo = !moving ? NULL : raster ? &p->raster : &p->traced;
    p->started_s = clock_wall_s();
    pthread_rwlock_rdlock(&p->snapshot_lock);
    *out = (started_pass){p->pass, moving, raster, tempo, pass_scene(p, p->pass, tempo, raster)};
}

void render_worker_end_pass(render_worker *p, const started_pass *of, status code, job_account *account,
                            diagnostic *why)
{
    const render_result *result = account->result;
    shared_image shown;
    THEN(code, describe(p, account, of->pass, of->moving, &shown, why));
    pthread_rwlock_unlock(&p->snapshot_lock);
    if (code == STATUS_OK) {
        if (of->tempo)
            adaptive_resolution_update(of->tempo, result->wall_s, live_frame_s);
        else
            take_rate(p, of->pass, result);
        p->pass = of->moving ? p->plan.count : of->pass + 1;
        p->interrupted = 0;
    } else if (code == STATUS_INTERRUPTED) {
        p->interrupted += of->pass == 0 && render_worker_is_stale(p);
    } else {
        p->pass = p->plan.count;
    }
    job_account_release(account);
    if (code != STATUS_INTERRUPTED)
        render_worker_set_error(p, code, why);
    if (code == STATUS_OK && !publish(p, &shown)) {
        p->pass = p->plan.count;
        render_worker_set_error(p, out_of_memory(why), why);
    }
}

void render_worker_render_pass(render_worker *p)
{
    const render_options options = {.progress_s = poll_s};
    diagnostic why = {.line = 0};
    started_pass of;
    job_account account;
    render_worker_begin_pass(p, &of);
    cancel_token token = {.ask = render_worker_must_end, .context = p};
    cancel_begin(&token);
    const status code = job_render(p->renderer, &of.view, &options, &account, &why);
    cancel_end(&token);
    render_worker_end_pass(p, &of, code, &account, &why);
}
