/* `cuvette animate`: reads scene and scripts, renders the animation frame by frame, prints its account. */
#include "cli/animate.h"
#include "base/cancel.h"
#include "base/file.h"
#include "base/text.h"
#include "cli/cli.h"
#include "cli/outputs.h"
#include "cli/scene_input.h"
#include "cli/terminal.h"
#include "image/video.h"
#include "render/frame/record.h"
#include "report/json.h"
#include "report/report.h"
#include "scene/assets/slime.h"
#include "scene/model/camera.h"
#include "scene/model/open.h"
#include "scene/model/params.h"
#include "scene/model/render_settings.h"
#include "scene/model/scene.h"

#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* --- rendering, frame by frame, into numbered images or one stream --- */

/* The account of an animation. */
typedef struct animate_totals {
    int64_t rendered, kept;
    double wall_s;            /* render time */
    double step_s, surface_s; /* seconds spent on steps, also for kept frames, and on surfaces */
    double simulated_s;
    uint64_t steps;
} animate_totals;

/* An animation being rendered. */
typedef struct animation_job {
    const animate_request *request;
    const animate_names *names; /* NULL: one stream */
    uint64_t definition;
    scene *s;
    scene_motion *motion;
    job *frame_job;
    file_writer stream;
    animate_rows *rows; /* NULL: no table */
    int64_t frame, count;
    progress_line line;
    char label[64];
    scene_motion_report last_motion; /* motion since the previous frame */
    animate_totals *totals;
} animation_job;

static void show_progress(void *context, double fraction)
{
    animation_job *f = context;
    progress_draw(&f->line, ((double)f->frame + fraction) / (double)f->count);
}

static status report_interrupted(const animation_job *f, diagnostic *why)
{
    const char *remedy = f->names ? "run the same command again to resume" : "";
    return diagnose_at(why, f->request->output, STATUS_INTERRUPTED, remedy, "interrupted at %s%s", f->label,
                       f->stream.atomic ? "; nothing is written" : "");
}

/* Returns whether the frame's image exists, and its row where a table is written. */
static bool is_done(const animation_job *f, const char *path)
{
    return path && access(path, F_OK) == 0 && (!f->rows || animate_rows_have(f->rows, f->frame));
}

/* All frames count as equally long; the motion up to the first one has its own progress line. */
static void show_motion(void *context, double fraction)
{
    animation_job *f = context;
    if (f->frame > 0)
        show_progress(f, 0);
    else
        progress_draw(&f->line, fraction);
}

static status advance(animation_job *f, double to_s, bool surfaces, diagnostic *why)
{
    const load_watch watch = {show_motion, f};
    const bool is_initial = f->frame == 0 && to_s > 0;
    if (is_initial)
        progress_start(&f->line, "simulating up to the first frame");
    status result = scene_motion_advance_until(f->motion, to_s, surfaces, &watch, why);
    if (is_initial) {
        progress_erase(&f->line);
        progress_start(&f->line, f->label);
    }
    if (result != STATUS_OK)
        return result;
    f->last_motion = scene_motion_last(f->motion);
    animate_totals *totals = f->totals;
    totals->steps += f->last_motion.steps;
    totals->step_s += f->last_motion.step_s;
    totals->surface_s += f->last_motion.surface_s;
    totals->simulated_s = to_s;
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
    status result = file_writer_commit(&f->stream, why); /* reports the reason of the failure */
    return result == STATUS_OK ? diagnose(why, STATUS_FAILURE, "", "cannot write the animation") : result;
}

static status write_image(animation_job *f, const char *path, const render_result *rendered, diagnostic *why)
{
    if (path) /* PNG and OpenEXR also store the scene, whose slimes are at the time of this frame */
        return record_image(rendered, NULL, f->s, path, 8, why);
    image *frame = NULL;
    status result = film_image(rendered->img, &frame, why);
    if (result == STATUS_OK)
        frame->tone = camera_tone(f->s);
    errno = 0;
    THEN(result, y4m_frame(f->stream.stream, frame, why));
    image_destroy(frame);
    return result == STATUS_OK ? flush_stream(f, why) : result;
}

static status render_frame(animation_job *f, const char *path, diagnostic *why)
{
    const render_options options = {.progress = show_progress, .context = f};
    job_account rendered;
    status ended = job_render(f->frame_job, f->s, &options, &rendered, why);
    THEN(ended, write_image(f, path, rendered.result, why));
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
        f->totals->rendered++;
        f->totals->wall_s += rendered.result->wall_s;
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
        f->totals->kept++;
    else if (result == STATUS_OK)
        result = render_frame(f, path, why);
    free(path);
    return result == STATUS_INTERRUPTED ? report_interrupted(f, why)
                                        : result; /* the interruption came during motion, rendering or encoding */
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
    return y4m_begin(f->stream.stream, (int)scene_settings(f->s)->width, (int)scene_settings(f->s)->height,
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

/* Renders the animation frame by frame. names is NULL for a stream. STATUS_INTERRUPTED after a signal: the existing
 * frames are complete. */
static status animate_film(const animate_request *request, const animate_names *names, const animate_definition *d,
                           job *frame_job, scene *s, scene_motion *motion, animate_totals *totals, diagnostic *why)
{
    animation_job f = {.request = request,
                       .names = names,
                       .definition = d->hash,
                       .s = s,
                       .motion = motion,
                       .frame_job = frame_job,
                       .count = frame_times_count(&request->times),
                       .totals = totals};
    *totals = (animate_totals){0};
    status result =
        request->rows ? animate_rows_open(request->rows, d->hash, request->restart || !names, &f.rows, why) : STATUS_OK;
    if (result == STATUS_OK && names)
        result = animate_index_begin(names, d, f.count, request->restart, why);
    THEN(result, make_animation(&f, why));
    animate_rows_close(f.rows);
    return result;
}

/* --- the command --- */

/* Sets the parameter script of every slime to --script. */
static status set_scripts(const animate_request *request, scene *s, diagnostic *why)
{
    status result = STATUS_OK;
    for (size_t i = 0; i < s->mesh_count && result == STATUS_OK && request->script_path; i++) {
        if (s->meshes[i].source != MESH_SLIME)
            continue;
        char *path = text_format("%s.script", s->meshes[i].name);
        result = path ? scene_set(s, path, request->script_path, why) : out_of_memory(why);
        if (result != STATUS_OK)
            diagnostic_locate(why, "--script", 0, 0);
        free(path);
    }
    return result;
}

static status choose_duration(animate_request *request, const scene *s, diagnostic *why)
{
    TRY(frame_times_choose(&request->times, s, why));
    TRY(animate_check_length(request, why));
    diagnostic_locate(why, request->input.path, 0, 0);
    return frame_times_check_end(&request->times, s, why);
}

static status read_scene(animate_request *request, const animate_names *names, scene **out, diagnostic *why)
{
    TRY(scene_input_read(&request->input, out, why));
    if (!scene_moves(*out))
        return diagnose_at(why, request->input.path, STATUS_BAD_INPUT,
                           "add a mesh with 'generate: slime', or use 'cuvette render'",
                           "nothing moves in this scene: it has no slime");
    TRY(set_scripts(request, *out, why));
    if (request->rows)
        TRY(outputs_check_place("--rows", request->rows, *out, why));
    if (animate_is_stream(request))
        TRY(outputs_check_place("-o", request->output, *out, why));
    if (names)
        TRY(animate_names_check(names, *out, why));
    return choose_duration(request, *out, why);
}

static void print_summary(const animate_request *request, const scene *s, const animate_totals *a)
{
    printf("%" PRId64 " frames of %lldx%lld pixels, %.6g per second -> %s: %" PRId64 " rendered", a->rendered + a->kept,
           (long long)s->render.width, (long long)s->render.height,
           (double)request->times.fps_num / (double)request->times.fps_den, request->output, a->rendered);
    if (a->rendered)
        printf(" in %.4f s each", a->wall_s / (double)a->rendered);
    printf(", %" PRId64 " kept; %.3g s of motion simulated", a->kept, a->simulated_s);
    if (a->step_s > 0)
        printf(" at %.3g s per second", a->simulated_s / a->step_s);
    putchar('\n');
}

static status print_account(const animate_request *request, const scene *s, const animate_definition *d, isa level,
                            const animate_totals *a, diagnostic *why)
{
    char hash[32];
    snprintf(hash, sizeof hash, "%016" PRIx64, d->hash);
    json_t *o = json_pack(
        "{s:i,s:s,s:s,s:s,s:o,s:I,s:I,s:I,s:[I,I],s:o,s:o,s:I,s:o,s:o,s:o,s:o,s:o}", "schema", REPORT_SCHEMA, "version",
        CUVETTE_VERSION, "isa", isa_name(level), "definition", hash, "output", json_of_text(request->output), "frames",
        (json_int_t)(a->rendered + a->kept), "rendered", (json_int_t)a->rendered, "kept", (json_int_t)a->kept, "fps",
        (json_int_t)request->times.fps_num, (json_int_t)request->times.fps_den, "start_s",
        json_of_real(request->times.start_s), "simulated_s", json_of_real(a->simulated_s), "steps",
        (json_int_t)a->steps, "step_s", json_of_real(a->step_s), "surface_s", json_of_real(a->surface_s), "wall_s",
        json_of_real(a->wall_s), "wall_s_mean",
        json_of_real(a->rendered ? a->wall_s / (double)a->rendered : (double)NAN), "params", report_params(s));
    return o ? json_print(o, why) : out_of_memory(why);
}

static status make(const animate_request *request, const animate_names *names, job *frame_job, scene *s,
                   diagnostic *why)
{
    scene_motion *motion = NULL;
    animate_definition d = {0};
    animate_totals totals = {0};
    status result = scene_motion_create(s, &motion, why);
    THEN(result, animate_define(request, s, &d, why));
    if (result == STATUS_OK && names)
        result = animate_index_check(names, &d, frame_times_count(&request->times), request->restart, why);
    THEN(result, animate_check_room(request, names, s, why));
    THEN(result, animate_film(request, names, &d, frame_job, s, motion, &totals, why));
    if (result == STATUS_OK && request->json)
        result = print_account(request, s, &d, job_isa(frame_job), &totals, why);
    else if (result == STATUS_OK && strcmp(request->output, "-") != 0)
        print_summary(request, s, &totals);
    animate_definition_release(&d);
    scene_motion_destroy(motion);
    return result;
}

status command_animate(int argc, char **argv, diagnostic *why)
{
    animate_request request;
    animate_names names = {0};
    scene *s = NULL;
    job *frame_job = NULL;
    status result = animate_request_parse(argc, argv, &request, why);
    const bool in_files = result == STATUS_OK && !animate_is_stream(&request);
    if (in_files)
        result = animate_names_parse(request.output, &names, why);
    THEN(result, scene_input_job(false, &frame_job, why));
    THEN(result, read_scene(&request, in_files ? &names : NULL, &s, why));
    if (result == STATUS_OK && !request.json)
        result = scene_input_lint(s, job_isa(frame_job), why);
    if (result == STATUS_OK && !request.json)
        scene_input_note_inert(s, &request.input);
    THEN(result, make(&request, in_files ? &names : NULL, frame_job, s, why));
    job_destroy(frame_job);
    scene_destroy(s);
    animate_names_release(&names);
    animate_request_release(&request);
    return result;
}
