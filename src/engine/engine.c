/* Engines, and the rendering of a request: checks, a preview, the film, the caller's buffers and callbacks. */
#include "engine/engine_private.h"
#include "measure/clock.h"
#include "scene/file/shared.h"
#include "scene/model/scene.h"

#include <stdlib.h>
#include <string.h>

enum { PREVIEW_MAX = 64 };
/* The size of a request of the first version. */
#define REQUEST_FIRST offsetof(cuvette_request, layers)

status engine_isa(const char *name, isa *out, diagnostic *why)
{
    return name ? isa_named(name, out, why) : isa_choose(out, why);
}

cuvette_status cuvette_engine_create(const char *instructions, cuvette_engine **out, cuvette_diagnostic *why)
{
    ENGINE_CALL(out);
    *out = NULL;
    cuvette_engine *e = calloc(1, sizeof *e);
    isa level = ISA_BASE;
    status code = e ? engine_isa(instructions, &level, &inner) : out_of_memory(&inner);
    if (code == STATUS_OK)
        code = job_create(&(job_settings){.level = &level}, &e->workers, &inner);
    if (code != STATUS_OK) {
        free(e);
        return engine_report(code, &inner, why);
    }
    *out = e;
    return CUVETTE_OK;
}

void cuvette_engine_destroy(cuvette_engine *engine)
{
    if (!engine)
        return;
    job_destroy(engine->workers);
    free(engine);
}

void cuvette_engine_cancel(cuvette_engine *engine)
{
    if (engine)
        cancel_set(&engine->token);
}

/* One render in progress. */
typedef struct render_call {
    cuvette_engine *engine;
    const cuvette_request *request;
    host_progress progress;
    canvas buffers;
    bool is_preview;
    status tile_status; /* from passing tiles to the callback */
} render_call;

static void watch(void *context, double fraction)
{
    render_call *call = context;
    if (call->request->tile && call->tile_status == STATUS_OK)
        call->tile_status = canvas_hand_out(&call->buffers, NULL);
    engine_report_progress(&call->progress, call->is_preview ? 0.0 : fraction);
}

static void accept_tile(void *context, const film *img, int x0, int y0, int x1, int y1)
{
    render_call *call = context;
    canvas_fill(&call->buffers, img, x0, y0, x1, y1, 1);
    canvas_note(&call->buffers, (cuvette_tile){x0, y0, x1, y1, 1});
}

/* Copies a request into the current version of the struct; earlier versions have fewer fields. */
static status read_request(const cuvette_request *given, const scene *s, cuvette_request *out, diagnostic *why)
{
    *out = CUVETTE_REQUEST;
    if (!given)
        return STATUS_OK;
    if (given->size < REQUEST_FIRST)
        return diagnose(why, STATUS_BAD_INPUT, "initialise the request with CUVETTE_REQUEST",
                        "the request's size is %zu, which is too small", given->size);
    memcpy(out, given, given->size < sizeof *out ? given->size : sizeof *out);
    if (out->preview != 0 && (out->preview < 2 || out->preview > PREVIEW_MAX))
        return diagnose(why, STATUS_BAD_INPUT, "set it to 0, or to a value from 2 to 64", "the request's preview is %d",
                        out->preview);
    if (!out->rgb && !out->srgb)
        return STATUS_OK;
    if (out->width != s->render.width || out->height != s->render.height)
        return diagnose(why, STATUS_BAD_INPUT,
                        "make the buffers as large as the image, or set render.width and render.height",
                        "the buffers are %d x %d, but the image is %lld x %lld", out->width, out->height,
                        (long long)s->render.width, (long long)s->render.height);
    TRY(canvas_stride(&out->rgb_stride, sizeof *out->rgb, out->width, out->height, why));
    return canvas_stride(&out->srgb_stride, sizeof *out->srgb, out->width, out->height, why);
}

/* Renders the complete image at reduced size. */
static status render_preview(render_call *call, const scene *s, diagnostic *why)
{
    const int coarse = call->request->preview;
    scene small = *s; /* borrows what s owns */
    small.render.width = (s->render.width + coarse - 1) / coarse;
    small.render.height = (s->render.height + coarse - 1) / coarse;
    const render_options options = {.progress = watch, .context = call};
    job_account account;
    call->is_preview = true;
    const status code = job_render(call->engine->workers, &small, &options, &account, why);
    call->is_preview = false;
    if (code == STATUS_OK) {
        canvas_fill(&call->buffers, account.result->img, 0, 0, (int)small.render.width, (int)small.render.height,
                    coarse);
        if (call->request->tile)
            canvas_hand_tile(&call->buffers,
                             &(cuvette_tile){0, 0, (int)s->render.width, (int)s->render.height, coarse});
    }
    job_account_release(&account);
    return code;
}

static status render_frame(render_call *call, const scene *s, cuvette_frame *frame, diagnostic *why)
{
    const cuvette_request *r = call->request;
    const render_options options = {.pixel_rays = r->pixel_rays,
                                    .pixel_time = r->pixel_time,
                                    .pixel_cut = r->pixel_cut,
                                    .layers = r->layers,
                                    .progress = watch,
                                    .tile_done = r->tile ? accept_tile : NULL,
                                    .context = call};
    status code = job_render(call->engine->workers, s, &options, &frame->account, why);
    const film *img = frame->account.result ? frame->account.result->img : NULL;
    if (img && r->tile && call->tile_status == STATUS_OK)
        call->tile_status = canvas_hand_out(&call->buffers, why);
    else if (img && !r->tile)
        canvas_fill(&call->buffers, img, 0, 0, img->width, img->height, 1);
    if (code == STATUS_OK && call->tile_status != STATUS_OK)
        code = diagnose(why, call->tile_status, MEMORY_REMEDY, "out of memory for the list of finished tiles");
    if (code == STATUS_OK)
        engine_report_progress(&call->progress, 1.0);
    return code;
}

static status render(render_call *call, const scene *s, cuvette_frame *frame, diagnostic *why)
{
    engine_report_progress(&call->progress, 0.0);
    if (cancel_asked())
        return diagnose(why, STATUS_INTERRUPTED, "", "cancelled before the first ray");
    status code = STATUS_OK;
    if (call->request->preview && (call->request->rgb || call->request->srgb)) {
        const double began_s = clock_wall_s();
        code = render_preview(call, s, why);
        frame->preview_s = clock_wall_s() - began_s;
    }
    THEN(code, render_frame(call, s, frame, why));
    if (code == STATUS_INTERRUPTED)
        diagnose(why, code, "", "cancelled");
    return code;
}

/* Copies the scene that image files of the frame contain (scene/file/shared.h). Its text needs at least 16 bytes per
 * solid, so a scene with too many solids is not copied. */
static status keep_scene(const cuvette_scene *s, cuvette_frame *frame, diagnostic *why)
{
    if (s->grabbed || s->model->solid_count > SHARED_TEXT_MAX / 16 || shared_scene_check(s->model, NULL) != STATUS_OK)
        return STATUS_OK;
    frame->scene = scene_clone(s->model);
    return frame->scene ? STATUS_OK : out_of_memory(why);
}

/* The caller holds the engine and the scene; `given` is the caller's request. */
static status render_locked(cuvette_engine *engine, cuvette_scene *s, const cuvette_request *given,
                            float_environment *host, cuvette_frame *frame, diagnostic *why)
{
    cuvette_request request;
    render_call call = {.engine = engine, .request = &request};
    status code = engine_check(s, why);
    THEN(code, read_request(given, s->model, &request, why));
    if (code != STATUS_OK)
        return code;
    call.progress = (host_progress){
        .callback = request.progress, .context = request.context, .host = host, .next_s = clock_wall_s() + 0.1};
    cancel_begin(&engine->token);
    engine_begin_progress(&call.progress);
    code = engine_load(s, NULL, why);
    THEN(code, keep_scene(s, frame, why));
    THEN(code, canvas_open(&request, host, &call.buffers, why));
    if (code == STATUS_OK) {
        frame->solid_count = s->model->solid_count;
        code = render(&call, s->model, frame, why);
        canvas_close(&call.buffers);
    }
    engine_end_progress(&call.progress);
    cancel_end(&engine->token);
    return code;
}

cuvette_status cuvette_engine_render(cuvette_engine *engine, const cuvette_scene *s, const cuvette_request *request,
                                     cuvette_frame **out, cuvette_diagnostic *why)
{
    ENGINE_ENTER();
    if (out)
        *out = NULL;
    ENGINE_NEED(engine, s);
    if (atomic_exchange(&engine->busy, true)) {
        engine_report(diagnose(&inner, STATUS_BAD_INPUT, "wait for the render to end, or create a second engine",
                               "the engine is rendering"),
                      &inner, why);
        return CUVETTE_BUSY;
    }
    cuvette_scene *held = (cuvette_scene *)(uintptr_t)s; /* handles are never const objects */
    const cuvette_status begun = engine_begin_render(held, why);
    if (begun != CUVETTE_OK) {
        atomic_store(&engine->busy, false);
        return begun;
    }
    cancel_clear(&engine->token);
    cuvette_frame *frame = calloc(1, sizeof *frame);
    const status code = frame ? render_locked(engine, held, request, &host, frame, &inner) : out_of_memory(&inner);
    engine_end_render(held);
    atomic_store(&engine->busy, false);
    if (out && frame && frame->account.result)
        *out = frame;
    else
        cuvette_frame_destroy(frame);
    return engine_report(code, &inner, why);
}
