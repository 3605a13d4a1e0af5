/* The thread that renders a video, and its progress for pages. */
#include "web/session/videos.h"
#include "base/float_environment.h"
#include "base/number.h"
#include "job/job.h"
#include "measure/clock.h"
#include "render/plan/film.h"
#include "report/json.h"
#include "scene/model/camera.h"
#include "scene/model/params.h"
#include "scene/model/render_settings.h"
#include "scene/motion/motion.h"
#include "web/session/studies.h"
#include "web/session/tasks.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define FRAME_LIMIT_S 600.0

struct videos {
    lab *l;
    task_thread task; /* task.life is acquired before lock */
    video_plan plan;

    pthread_mutex_t lock; /* guards the fields below */
    bool running, begun;
    int64_t done;
    double fraction, began_s, published_s, wall_s;
    FILE *file; /* of the finished video; NULL: none */
    size_t size;
    bool failed;
    diagnostic trouble;
};

status videos_create(lab *l, videos **out, diagnostic *why)
{
    *out = calloc(1, sizeof **out);
    if (!*out)
        return out_of_memory(why);
    (*out)->l = l;
    task_thread_create(&(*out)->task);
    pthread_mutex_init(&(*out)->lock, NULL);
    return STATUS_OK;
}

void video_plan_release(video_plan *plan)
{
    scene_destroy(plan->s);
    free(plan->path);
    *plan = (video_plan){.s = NULL};
}

/* The caller holds task.life. */
static void join_thread(videos *v)
{
    if (!task_thread_join(&v->task))
        return;
    pthread_mutex_lock(&v->lock);
    video_plan_release(&v->plan);
    pthread_mutex_unlock(&v->lock);
}

void videos_end(videos *v)
{
    pthread_mutex_lock(&v->task.life);
    task_thread_end(&v->task);
    join_thread(v);
    pthread_mutex_unlock(&v->task.life);
}

void videos_destroy(videos *v)
{
    if (!v)
        return;
    videos_end(v);
    if (v->file)
        fclose(v->file);
    task_thread_destroy(&v->task);
    pthread_mutex_destroy(&v->lock);
    free(v);
}

/* --- progress for pages --- */

static double left_s(const videos *v)
{
    const double done = (double)v->done + v->fraction;
    return v->running && done > 0.0 ? (clock_wall_s() - v->began_s) / done * ((double)v->plan.count - done) : NAN;
}

json_t *videos_json(videos *v)
{
    pthread_mutex_lock(&v->lock);
    json_t *json = !v->begun ? json_null()
                             : json_pack("{s:b, s:I, s:I, s:o, s:o, s:s, s:o, s:o}", "running", (int)v->running, "done",
                                         (json_int_t)v->done, "frames", (json_int_t)v->plan.count, "left_s",
                                         json_of_real(left_s(v)), "wall_s", json_of_real(v->wall_s), "format",
                                         v->plan.format == VIDEO_Y4M ? "y4m" : "apng", "bytes",
                                         v->file ? json_integer((json_int_t)v->size) : json_null(), "error",
                                         v->failed ? json_of_diagnostic(&v->trouble) : json_null());
    pthread_mutex_unlock(&v->lock);
    return json;
}

static void publish(videos *v)
{
    lab_publish(v->l, "video", videos_json(v));
}

/* The ask of a cancel token: a video would disturb a study that measures. */
static bool study_measures(void *context)
{
    const videos *v = context;
    return studies_runs(v->l->studies, NULL);
}

static void on_progress(void *context, double fraction)
{
    videos *v = context;
    pthread_mutex_lock(&v->lock);
    const bool due = task_publish_is_due(&v->published_s);
    v->fraction = fraction;
    pthread_mutex_unlock(&v->lock);
    if (due)
        publish(v);
}

/* The motion before a frame does not count as progress of the frame. */
static void on_motion(void *context, double fraction)
{
    (void)fraction;
    on_progress(context, 0.0);
}

/* --- frames --- */

status video_plan_scene(const video_plan *plan, int64_t frame, scene **out, diagnostic *why)
{
    const double fraction = plan->count > 1 ? (double)frame / (double)(plan->count - 1) : 0.0;
    const double value = fraction == 1.0 ? plan->to : plan->from + fraction * (plan->to - plan->from);
    char text[NUMBER_TEXT_MAX];
    number_format(plan->is_integer ? round(value) : value, text);
    *out = scene_clone(plan->s);
    if (!*out)
        return out_of_memory(why);
    status code = scene_set(*out, plan->path, text, why);
    THEN(code, scene_document_check(*out, NULL, why));
    if (code != STATUS_OK) {
        scene_destroy(*out);
        *out = NULL;
    }
    return code;
}

static status render_frame(videos *v, job *j, const scene *s, video *out, diagnostic *why)
{
    const render_options options = {.progress = on_progress, .context = v};
    job_account account = {.result = NULL};
    image *img = NULL;
    status code = job_render(j, s, &options, &account, why);
    THEN(code, film_image(account.result->img, &img, why));
    if (code == STATUS_OK)
        img->tone = camera_tone(s);
    THEN(code, video_frame(out, img, why));
    image_destroy(img);
    job_account_release(&account);
    if (code == STATUS_OK && (fflush(out->stream) != 0 || ferror(out->stream)))
        return diagnose(why, STATUS_FAILURE, "free space in the folder for temporary files, or set TMPDIR to another",
                        "cannot write the video: %s", strerror(errno));
    return code;
}

static status next_frame(videos *v, job *j, scene_motion *motion, int64_t frame, video *out, diagnostic *why)
{
    const video_plan *plan = &v->plan;
    const load_watch watch = {on_motion, v};
    if (motion) {
        TRY(scene_motion_advance_until(motion, frame_times_at(&plan->times, frame), true, &watch, why));
        return render_frame(v, j, plan->s, out, why);
    }
    scene *s = NULL;
    status code = video_plan_scene(plan, frame, &s, why);
    THEN(code, job_load(j, s, &watch, why));
    THEN(code, render_frame(v, j, s, out, why));
    scene_destroy(s);
    return code;
}

static status render_frames(videos *v, job *j, scene_motion *motion, FILE *file, diagnostic *why)
{
    const video_plan *plan = &v->plan;
    const render_settings *r = scene_settings(plan->s);
    video out;
    status code = video_begin(&out, plan->format, file, (int)r->width, (int)r->height, plan->count, plan->times.fps_num,
                              plan->times.fps_den, why);
    for (int64_t i = 0; i < plan->count && code == STATUS_OK; i++) {
        code = next_frame(v, j, motion, i, &out, why);
        pthread_mutex_lock(&v->lock);
        v->done += code == STATUS_OK;
        v->fraction = 0.0;
        pthread_mutex_unlock(&v->lock);
    }
    return code;
}

static status render_video(videos *v, FILE *file, diagnostic *why)
{
    job *j = NULL;
    scene_motion *motion = NULL;
    const job_settings settings = {.level = &v->l->settings.level, .keeps_meshes = true, .time_s = FRAME_LIMIT_S};
    cancel_token token = {.ask = study_measures, .context = v};
    cancel_begin(&v->task.token);
    cancel_begin(&token);
    status code = job_create(&settings, &j, why);
    if (code == STATUS_OK && !v->plan.path)
        code = scene_motion_create(v->plan.s, &motion, why);
    THEN(code, render_frames(v, j, motion, file, why));
    cancel_end(&token);
    cancel_end(&v->task.token);
    scene_motion_destroy(motion);
    job_destroy(j);
    return code;
}

/* --- the thread --- */

/* Keeps the video if it is complete. */
static void finish(videos *v, FILE *file, status code, const diagnostic *why)
{
    const off_t size = file ? ftello(file) : 0;
    const bool complete = code == STATUS_OK && size > 0;
    pthread_mutex_lock(&v->lock);
    v->running = false;
    v->wall_s = clock_wall_s() - v->began_s;
    v->failed = code != STATUS_OK && !cancel_is_set(&v->task.token);
    v->trouble = *why;
    v->file = complete ? file : NULL;
    v->size = complete ? (size_t)size : 0;
    pthread_mutex_unlock(&v->lock);
    if (file && !complete)
        fclose(file);
    publish(v);
    lab_publish_state(v->l);
}

static void *run(void *context)
{
    videos *v = context;
    diagnostic why = {.what = ""};
    float_environment_set();
    FILE *file = lab_temporary_file(v->l);
    status code =
        file ? semaphore_acquire(v->l->heavy, &why)
             : diagnose(&why, STATUS_FAILURE, "free space in the folder for temporary files, or set TMPDIR to another",
                        "cannot write the video: %s", strerror(errno));
    if (code == STATUS_OK) {
        code = render_video(v, file, &why);
        semaphore_release(v->l->heavy);
    }
    if (code == STATUS_INTERRUPTED && studies_runs(v->l->studies, NULL))
        diagnose(&why, code, "save the video again when the study has ended", "a study began to measure");
    finish(v, file, code, &why);
    return NULL;
}

/* The caller holds task.life. */
static status claim(videos *v, diagnostic *why)
{
    pthread_mutex_lock(&v->lock);
    const bool busy = v->running;
    FILE *before = NULL;
    if (!busy) {
        before = v->file;
        v->file = NULL;
        v->running = v->begun = true;
        v->failed = false;
        v->done = 0;
        v->fraction = v->published_s = v->wall_s = 0.0;
        v->began_s = clock_wall_s();
    }
    pthread_mutex_unlock(&v->lock);
    if (before)
        fclose(before);
    return busy ? diagnose(why, STATUS_INTERRUPTED, "wait until it ends, or stop it", "another video is being rendered")
                : STATUS_OK;
}

static status begin(videos *v, video_plan *plan, diagnostic *why)
{
    TRY(task_thread_may_start(&v->task, why));
    TRY(claim(v, why));
    join_thread(v);
    pthread_mutex_lock(&v->lock);
    v->plan = *plan;
    *plan = (video_plan){.s = NULL};
    pthread_mutex_unlock(&v->lock);
    const status code = task_thread_start(&v->task, run, v, why);
    if (code == STATUS_OK)
        return code;
    pthread_mutex_lock(&v->lock);
    v->running = false;
    video_plan_release(&v->plan);
    pthread_mutex_unlock(&v->lock);
    return code;
}

status videos_start(videos *v, video_plan *plan, diagnostic *why)
{
    pthread_mutex_lock(&v->task.life);
    const status code = begin(v, plan, why);
    pthread_mutex_unlock(&v->task.life);
    video_plan_release(plan);
    return code;
}

status videos_stop(videos *v, diagnostic *why)
{
    pthread_mutex_lock(&v->task.life);
    pthread_mutex_lock(&v->lock);
    const bool running = v->running;
    pthread_mutex_unlock(&v->lock);
    cancel_set(&v->task.token);
    pthread_mutex_unlock(&v->task.life);
    return running ? STATUS_OK : diagnose(why, STATUS_INTERRUPTED, "start a video first", "no video is being rendered");
}

status videos_open(videos *v, int *file, size_t *size, video_format *format, diagnostic *why)
{
    pthread_mutex_lock(&v->lock);
    *file = v->file ? dup(fileno(v->file)) : -1;
    *size = v->size;
    *format = v->plan.format;
    const bool none = !v->file;
    pthread_mutex_unlock(&v->lock);
    if (none)
        return diagnose(why, STATUS_BAD_INPUT, "render one with POST /api/video", "there is no finished video");
    return *file >= 0 ? STATUS_OK
                      : diagnose(why, STATUS_FAILURE, "try again", "cannot read the video: %s", strerror(errno));
}
