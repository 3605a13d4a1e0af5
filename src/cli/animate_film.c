#include "cli/animate.h"
#include "base/file.h"
#include "cli/animate_rows.h"
#include "cli/terminal.h"
#include "image/y4m.h"
#include "render/core/record.h"
#include "scene/model/scene.h"
#include <errno.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* A film in the making. */
typedef struct film_job {
    const animate_request *request;
    const animate_names *names; /* NULL: one stream */
    uint64_t definition;
    scene *s;
    scene_motion *motion;
    isa level;
    renderer *r;
    file_writer stream;
    animate_rows *rows; /* NULL: none wanted */
    int64_t frame, count;
    progress_line line;
    char label[64];
    scene_motion_report moved; /* to this frame */
    animate_account *account;
} film_job;

static bool show_progress(void *context, double share_done)
{
    film_job *job = context;
    progress_draw(&job->line, ((double)job->frame + share_done) / (double)job->count);
    return !terminal_stop_asked();
}

static status say_interrupted(const film_job *job, diagnostic *why)
{
    const char *remedy = job->names ? "run it again, and it goes on there" : "";
    diagnostic_locate(why, job->request->output, 0, 0);
    return diagnose(why, STATUS_INTERRUPTED, remedy, "interrupted at %s%s", job->label,
                    job->stream.temporary ? ", and nothing is left of the film" : "");
}

/* Is that frame's picture there, and its row where rows are wanted? */
static bool is_there(const film_job *job, const char *path)
{
    return path && access(path, F_OK) == 0 && (!job->rows || animate_rows_have(job->rows, job->frame));
}

/* Frames are of equal length but for the way to the first one, which has a line of its own. */
static bool show_motion(void *context, double share_done)
{
    film_job *job = context;
    if (job->frame > 0)
        return show_progress(job, 0);
    progress_draw(&job->line, share_done);
    return !terminal_stop_asked();
}

static status advance(film_job *job, double to_s, bool skins, diagnostic *why)
{
    const load_watch watch = {show_motion, job};
    const bool own_line = job->frame == 0 && to_s > 0;
    if (own_line)
        progress_start(&job->line, "moving to the first frame");
    status result = scene_motion_advance_until(job->motion, to_s, skins, &watch, why);
    if (own_line) {
        progress_erase(&job->line);
        progress_start(&job->line, job->label);
    }
    if (result != STATUS_OK)
        return result == STATUS_INTERRUPTED ? say_interrupted(job, why) : result;
    job->moved = scene_motion_last(job->motion);
    animate_account *account = job->account;
    account->steps += job->moved.steps;
    account->step_s += job->moved.step_s;
    account->skin_s += job->moved.skin_s;
    account->simulated_s = to_s;
    return STATUS_OK;
}

/* A reader has each frame at once; one who left is a failure without words, as for all that goes to standard output. */
static status flush_stream(film_job *job, diagnostic *why)
{
    if (fflush(job->stream.stream) == 0 && !ferror(job->stream.stream))
        return STATUS_OK;
    if (errno == EPIPE)
        return STATUS_FAILURE;
    status result = file_writer_commit(&job->stream, why); /* knows best why it failed */
    return result == STATUS_OK ? diagnose(why, STATUS_FAILURE, "", "cannot write the film") : result;
}

static status write_picture(film_job *job, const char *path, const film *picture, diagnostic *why)
{
    if (path)
        return record_picture(picture, path, 8, why);
    image *frame = NULL;
    status result = film_image(picture, &frame, why);
    errno = 0;
    if (result == STATUS_OK)
        result = y4m_frame(job->stream.stream, frame, why);
    image_destroy(frame);
    return result == STATUS_OK ? flush_stream(job, why) : result;
}

static status render_frame(film_job *job, const char *path, diagnostic *why)
{
    const render_options options = {.progress = show_progress, .context = job};
    render_result *result = NULL;
    status ended = renderer_render(job->r, job->s, &options, &result, why);
    if (ended == STATUS_INTERRUPTED)
        ended = say_interrupted(job, why);
    if (ended == STATUS_OK)
        ended = write_picture(job, path, result->picture, why);
    if (ended == STATUS_OK && job->rows) {
        const animate_row row = {.definition = job->definition,
                                 .frame = job->frame,
                                 .time_s = animate_time_s(job->request, job->frame),
                                 .result = result,
                                 .moved = job->moved,
                                 .body = scene_motion_body(job->motion, 0),
                                 .level = job->level};
        ended = animate_rows_add(job->rows, &row, why);
    }
    if (ended == STATUS_OK) {
        job->account->rendered++;
        job->account->wall_s += result->wall_s;
    }
    render_result_destroy(result);
    return ended;
}

static status make_frame(film_job *job, diagnostic *why)
{
    char *path = job->names ? animate_name(job->names, job->frame) : NULL;
    if (job->names && !path)
        return out_of_memory(why);
    const bool kept = is_there(job, path);
    snprintf(job->label, sizeof job->label, "frame %" PRId64 " of %" PRId64, job->frame + 1, job->count);
    status result = show_progress(job, 0) ? STATUS_OK : say_interrupted(job, why);
    if (result == STATUS_OK)
        result = advance(job, animate_time_s(job->request, job->frame), !kept, why);
    if (result == STATUS_OK && kept)
        job->account->kept++;
    else if (result == STATUS_OK)
        result = render_frame(job, path, why);
    free(path);
    return result;
}

static status make_frames(film_job *job, diagnostic *why)
{
    status result = STATUS_OK;
    progress_start(&job->line, job->label);
    for (; job->frame < job->count && result == STATUS_OK; job->frame += result == STATUS_OK)
        result = make_frame(job, why);
    progress_erase(&job->line);
    return result;
}

static status open_stream(film_job *job, diagnostic *why)
{
    const animate_request *request = job->request;
    status result = file_writer_open(&job->stream, request->output, why);
    if (result == STATUS_OK)
        result = y4m_begin(job->stream.stream, (int)job->s->render.width, (int)job->s->render.height, request->fps_num,
                           request->fps_den, why);
    return result;
}

static status close_stream(film_job *job, status ended, diagnostic *why)
{
    if (!job->stream.stream)
        return ended;
    if (ended == STATUS_OK)
        return file_writer_commit(&job->stream, why);
    file_writer_abandon(&job->stream);
    return ended;
}

static status make_film(film_job *job, diagnostic *why)
{
    topology *machine = NULL;
    status result = topology_create(&machine, why);
    if (result == STATUS_OK)
        result = renderer_create(job->level, machine, &job->r, why);
    if (result == STATUS_OK)
        result = renderer_prepare(job->r, job->s, why);
    if (result == STATUS_OK && !job->names)
        result = open_stream(job, why);
    if (result == STATUS_OK)
        result = make_frames(job, why);
    result = close_stream(job, result, why);
    renderer_destroy(job->r);
    topology_destroy(machine);
    return result;
}

status animate_film(const animate_request *request, const animate_names *names, const animate_definition *d, isa level,
                    scene *s, scene_motion *motion, animate_account *account, diagnostic *why)
{
    film_job job = {.request = request,
                    .names = names,
                    .definition = d->hash,
                    .s = s,
                    .motion = motion,
                    .level = level,
                    .count = animate_count(request),
                    .account = account};
    *account = (animate_account){0};
    status result = request->rows
                        ? animate_rows_open(request->rows, d->hash, request->restart || !names, &job.rows, why)
                        : STATUS_OK;
    if (result == STATUS_OK && names)
        result = animate_ledger_begin(names, d, job.count, request->restart, why);
    if (result == STATUS_OK)
        result = make_film(&job, why);
    animate_rows_close(job.rows);
    return result;
}
