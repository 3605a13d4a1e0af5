/* One pass of the painter: how it is rendered, and the picture that comes of it. See web/live/painter_private.h. */
#include "web/live/painter_private.h"
#include "measure/clock.h"
#include "report/report.h"
#include "scene/model/scene.h"

/* How often a render looks up for something newer; how long a frame of the live slime may take. */
static const double look_up_s = 0.002, live_frame_s = 0.03;

static void publish(painter *p, picture *shown)
{
    pthread_mutex_lock(&p->lock);
    shown->serial = ++p->serial;
    pthread_mutex_unlock(&p->lock);
    const picture *made = picture_create(shown);
    if (!made) {
        picture_drop(shown);
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
        draw_triangles(&view.render);
        view.render.spectrum = SPECTRUM_RGB;
    }
    return view;
}

static bool describe(painter *p, const job_account *made, int pass, bool moving, picture *out)
{
    const film *shown = made->result->picture;
    image *linear = NULL;
    if (film_image(shown, &linear, NULL) != STATUS_OK)
        return false;
    const bool final = !moving && pass == p->plan.count - 1;
    *out = (picture){.generation = p->stage_generation,
                     .pass = pass + 1,
                     .passes = p->plan.count,
                     .final = final,
                     .width = shown->width,
                     .height = shown->height,
                     .full_width = (int)p->stage->render.width,
                     .full_height = (int)p->stage->render.height,
                     .numbers = report_page(made),
                     .film_hash = final ? job_account_hash(made) : 0,
                     .linear = linear,
                     .of = final ? scene_clone(p->stage) : NULL};
    if (out->numbers && (out->of || !final))
        return true;
    picture_drop(out);
    return false;
}

static void take_rate(painter *p, int pass, const render_result *made)
{
    if (made->wall_s > 0.0)
        p->rate = passes_work(&p->stage->render, p->plan.shrink[pass], p->plan.single[pass]) / made->wall_s;
}

void painter_paint_pass(painter *p)
{
    const int pass = p->pass;
    const bool moving = live_is_moving(p->toy);
    const bool raster = is_raster(p, moving);
    pace *tempo = !moving ? NULL : raster ? &p->raster : &p->traced;
    const scene view = pass_scene(p, pass, tempo, raster);
    const render_options options = {.progress_s = look_up_s};
    diagnostic why = {.line = 0};
    job_account account;
    picture shown;
    bool good = false;
    p->begun_s = clock_wall_s();
    pthread_rwlock_rdlock(&p->stage_lock);
    const status code = job_render(p->tracer, &view, &options, &account, &why);
    const render_result *made = account.result;
    if (code == STATUS_OK)
        good = describe(p, &account, pass, moving, &shown);
    pthread_rwlock_unlock(&p->stage_lock);
    if (code == STATUS_OK) {
        if (tempo)
            pace_take(tempo, made->wall_s, live_frame_s);
        else
            take_rate(p, pass, made);
        p->pass = moving ? p->plan.count : pass + 1;
        p->ended = 0;
    } else if (code == STATUS_INTERRUPTED) {
        p->ended += pass == 0 && painter_is_stale(p);
    } else {
        p->pass = p->plan.count;
    }
    job_account_release(&account);
    if (code != STATUS_INTERRUPTED)
        painter_set_trouble(p, code, &why);
    if (good)
        publish(p, &shown);
}
