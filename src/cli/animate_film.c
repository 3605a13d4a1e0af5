/* Renders an animation frame by frame, into numbered images or one stream. */
#include "cli/animate.h"
#include "base/cancel.h"
#include "base/file.h"
#include "cli/terminal.h"
#include "image/video.h"
#include "render/frame/record.h"
#include "scene/model/open.h"
#include "scene/model/render_settings.h"
#include "scene/model/camera.h"
#include <errno.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* An animation being rendered. */
typedef struct animation_job {
    const animate_request *request;
    const animate_names *names; /* NULL: one stream */
    uint64_t definition;
    scene *s;
    scene_motion *motion;
    job *with;
    file_writer stream;
    video video;
    animate_rows *rows; /* NULL: no table */
    int64_t frame, count;
    progress_line line;
    char label[64];
    scene_motion_report last_motion; /* motion up to this frame */
    animate_account *account;
} animation_job;

static void show_progress(void *context, double share_done)
{
    animation_job *f = context;
    progress_draw(&f->line, ((double)f->frame + share_done) / (double)f->count);
}

static status report_interrupted(const animation_job *f, diagnostic *why)
{
    const char *remedy = f->names ? "run the same command again to resume" : "";
    return diagnose_at(why, f->request->output, STATUS_INTERRUPTED, remedy, "interrupted at %s%s", f->label,
                       f->stream.whole ? "; nothing is written" : "");
}

/* Returns whether the frame's image exists, and its row where a table is written. */
static bool is_done(const animation_job *f, const char *path)
{
    return path && access(path, F_OK) == 0 && (!f->rows || animate_rows_have(f->rows, f->frame));
}

/* Frames take equal time, except the motion up to the first one, which has a progress line of its own. */
static void show_motion(void *context, double share_done)
{
    animation_job *f = context;
    if (f->frame > 0)
        show_progress(f, 0);
    else
        progress_draw(&f->line, share_done);
}

static status advance(animation_job *f, double to_s, bool surfaces, diagnostic *why)
{
    const load_watch watch = {show_motion, f};
    const bool own_line = f->frame == 0 && to_s > 0;
    if (own_line)
        progress_start(&f->line, "simulating up to the first frame");
    status result = scene_motion_advance_until(f->motion, to_s, surfaces, &watch, why);
    if (own_line) {
        progress_erase(&f->line);
        progress_start(&f->line, f->label);
    }
    if (result != STATUS_OK)
        return result;
    f->last_motion = scene_motion_last(f->motion);
    animate_account *account = f->account;
    account->steps += f->last_motion.steps;
    account->step_s += f->last_motion.step_s;
    account->skin_s += f->last_motion.skin_s;
    account->simulated_s = to_s;
    return STATUS_OK;
}

/* Flushes after each frame for the reader of a pipe. A closed pipe is a failure without a message, as for all
 * output. */
static status flush_stream(animation_job *f, diagnostic *why)
{
    if (fflush(f->stream.stream) == 0 && !ferror(f->stream.stream))
        return STATUS_OK;
    if (errno == EPIPE)
        return STATUS_FAILURE;
    status result = file_writer_commit(&f->stream, why); /* has the reason of the failure */
    return result == STATUS_OK ? diagnose(why, STATUS_FAILURE, "", "cannot write the animation") : result;
}

static status write_image(animation_job *f, const char *path, const film *img, diagnostic *why)
{
    if (path) /* the slimes of the scene have the time of this frame */
        return record_image(img, f->s, path, 8, why);
    image *frame = NULL;
    status result = film_image(img, &frame, why);
    if (result == STATUS_OK)
        frame->tone = camera_tone(f->s);
    errno = 0;
    THEN(result, video_frame(&f->video, frame, why));
    image_destroy(frame);
    return result == STATUS_OK ? flush_stream(f, why) : result;
}

static status render_frame(animation_job *f, const char *path, diagnostic *why)
{
    const render_options options = {.progress = show_progress, .context = f};
    job_account rendered;
    status ended = job_render(f->with, f->s, &options, &rendered, why);
    THEN(ended, write_image(f, path, rendered.result->img, why));
    if (ended == STATUS_OK && f->rows) {
        const animate_row row = {.definition = f->definition,
                                 .frame = f->frame,
                                 .time_s = frame_times_at(&f->request->times, f->frame),
                                 .account = &rendered,
                                 .motion = f->last_motion,
                                 .body = scene_motion_body(f->motion, 0)};
        ended = animate_rows_add(f->rows, &row, why);
    }
    if (ended == STATUS_OK) {
        f->account->rendered++;
        f->account->wall_s += rendered.result->wall_s;
    }
    job_account_release(&rendered);
    return ended;
}

static status make_frame(animation_job *f, diagnostic *why)
{
    char *path = f->names ? animate_name(f->names, f->frame) : NULL;
    if (f->names && !path)
        return out_of_memory(why);
    const bool exists = is_done(f, path);
    snprintf(f->label, sizeof f->label, "frame %" PRId64 " of %" PRId64, f->frame + 1, f->count);
    show_progress(f, 0);
    status result = cancel_check(why);
    THEN(result, advance(f, frame_times_at(&f->request->times, f->frame), !exists, why));
    if (result == STATUS_OK && exists)
        f->account->kept++;
    else if (result == STATUS_OK)
        result = render_frame(f, path, why);
    free(path);
    return result == STATUS_INTERRUPTED ? report_interrupted(f, why) : result; /* in motion, tracing, or encoding */
}

static status make_frames(animation_job *f, diagnostic *why)
{
    status result = STATUS_OK;
    progress_start(&f->line, f->label);
    for (; f->frame < f->count && result == STATUS_OK; f->frame += result == STATUS_OK)
        result = make_frame(f, why);
    progress_erase(&f->line);
    return result;
}

static status open_stream(animation_job *f, diagnostic *why)
{
    const animate_request *request = f->request;
    TRY(file_writer_open(&f->stream, request->output, why));
    const video_format format = video_format_of(request->output);
    return video_begin(&f->video, format == VIDEO_NONE ? VIDEO_Y4M : format, f->stream.stream,
                       (int)scene_settings(f->s)->width, (int)scene_settings(f->s)->height, f->count,
                       request->times.fps_num, request->times.fps_den, why);
}

static status close_stream(animation_job *f, status ended, diagnostic *why)
{
    return f->stream.stream ? file_writer_end(&f->stream, ended, why) : ended;
}

static status make_animation(animation_job *f, diagnostic *why)
{
    status result = f->names ? STATUS_OK : open_stream(f, why);
    THEN(result, make_frames(f, why));
    return close_stream(f, result, why);
}

status animate_film(const animate_request *request, const animate_names *names, const animate_definition *d, job *with,
                    scene *s, scene_motion *motion, animate_account *account, diagnostic *why)
{
    animation_job f = {.request = request,
                       .names = names,
                       .definition = d->hash,
                       .s = s,
                       .motion = motion,
                       .with = with,
                       .count = frame_times_count(&request->times),
                       .account = account};
    *account = (animate_account){0};
    status result =
        request->rows ? animate_rows_open(request->rows, d->hash, request->restart || !names, &f.rows, why) : STATUS_OK;
    if (result == STATUS_OK && names)
        result = animate_index_begin(names, d, f.count, request->restart, why);
    THEN(result, make_animation(&f, why));
    animate_rows_close(f.rows);
    return result;
}
