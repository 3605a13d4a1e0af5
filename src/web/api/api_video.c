/* API: a video of the current scene: its slimes as they move, or a parameter from one value to another. */
#include "scene/model/params.h"
#include "scene/model/render_settings.h"
#include "scene/motion/motion.h"
#include "web/api/api.h"
#include "web/session/studies.h"
#include "web/session/videos.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The search for a parameter by its path; found: its row, NULL if there is none. */
typedef struct param_search {
    const char *path;
    const param *found;
} param_search;

static status match(void *context, const char *path, const param *row, const char *value)
{
    param_search *q = context;
    (void)value;
    if (strcmp(path, q->path) == 0)
        q->found = row;
    return STATUS_OK;
}

static status read_sweep(call *c, const char *path, video_plan *plan)
{
    double frames = 0;
    param_search q = {.path = path};
    if (!api_read_number(c, "from", true, &plan->from) || !api_read_number(c, "to", true, &plan->to) ||
        !api_read_number(c, "frames", true, &frames))
        return STATUS_BAD_INPUT;
    if (!(frames >= 2 && frames <= VIDEO_FRAMES_MAX && frames == floor(frames)))
        return api_refuse(c, 400, "the number of frames is out of range", "give 2 to 1000 frames");
    if (scene_each_param(plan->s, match, &q) != STATUS_OK)
        return out_of_memory(&c->why);
    if (!q.found)
        return api_refuse(c, 400, "the scene has no such parameter", "use a path that GET /api/scene lists");
    if (q.found->type != PARAM_REAL && q.found->type != PARAM_INT)
        return api_refuse(c, 400, "the parameter is not a number", "choose a parameter whose value is one number");
    plan->is_integer = q.found->type == PARAM_INT;
    plan->count = (int64_t)frames;
    plan->path = strdup(path);
    return plan->path ? STATUS_OK : out_of_memory(&c->why);
}

/* The first and the last frame must be valid scenes with images of the same size. */
static status check_sweep(call *c, const video_plan *plan)
{
    const render_settings *first = scene_settings(plan->s);
    for (int i = 0; i < 2; i++) {
        scene *s = NULL;
        TRY(video_plan_scene(plan, i ? plan->count - 1 : 0, &s, &c->why));
        const bool same = scene_settings(s)->width == first->width && scene_settings(s)->height == first->height;
        scene_destroy(s);
        if (!same)
            return api_refuse(c, 400, "the parameter changes the size of the frames", "choose another parameter");
    }
    return STATUS_OK;
}

static status read_motion(call *c, video_plan *plan)
{
    if (!scene_moves(plan->s))
        return api_refuse(c, 409, "nothing moves in this scene: it has no slime",
                          "give 'parameter', 'from', 'to' and 'frames', or add a slime");
    if (!api_read_number(c, "duration_s", false, &plan->times.duration_s))
        return STATUS_BAD_INPUT;
    TRY(frame_times_choose(&plan->times, plan->s, &c->why));
    plan->count = frame_times_count(&plan->times);
    if (plan->count > VIDEO_FRAMES_MAX)
        return api_refuse(c, 400, "the video has more than 1000 frames",
                          "give a shorter 'duration_s' or a lower 'fps'");
    return frame_times_check_end(&plan->times, plan->s, &c->why);
}

static status read_form(call *c, video_plan *plan)
{
    const char *format = "y4m";
    double fps = 25;
    if (!api_read_text(c, "format", false, &format) || !api_read_number(c, "fps", false, &fps))
        return STATUS_BAD_INPUT;
    plan->format = strcmp(format, "y4m") == 0 ? VIDEO_Y4M : strcmp(format, "apng") == 0 ? VIDEO_APNG : VIDEO_NONE;
    if (plan->format == VIDEO_NONE)
        return api_refuse(c, 400, "unknown format of a video", "use y4m or apng for 'format'");
    if (!(fps >= 1 && fps <= 240 && fps == floor(fps)))
        return api_refuse(c, 400, "the frame rate is out of range", "give an integer from 1 to 240 for 'fps'");
    plan->times = (frame_times){.duration_s = -1, .fps_num = (int64_t)fps, .fps_den = 1};
    return STATUS_OK;
}

static status check_size(call *c, const video_plan *plan)
{
    const render_settings *r = scene_settings(plan->s);
    if (3.0 * (double)r->width * (double)r->height * (double)plan->count <= VIDEO_BYTES_MAX)
        return STATUS_OK;
    return api_refuse(c, 400, "the video is too large: more than 1 GiB of pixels",
                      "give fewer frames, or reduce render.width and render.height");
}

static status read_plan(call *c, video_plan *plan)
{
    const char *parameter = NULL;
    TRY(read_form(c, plan));
    if (!api_read_text(c, "parameter", false, &parameter))
        return STATUS_BAD_INPUT;
    TRY(parameter ? read_sweep(c, parameter, plan) : read_motion(c, plan));
    if (parameter)
        TRY(check_sweep(c, plan));
    return check_size(c, plan);
}

status api_video(call *c)
{
    if (studies_runs(c->l->studies, NULL))
        return api_refuse(c, 409, "a study is measuring, and a video would disturb it",
                          "wait until the study ends, or stop it");
    video_plan plan = {.s = scene_document_copy(c->l->scene_document, NULL)};
    status code = plan.s ? read_plan(c, &plan) : out_of_memory(&c->why);
    if (code != STATUS_OK) {
        video_plan_release(&plan);
        return code;
    }
    TRY(videos_start(c->l->videos, &plan, &c->why));
    return api_reply_json(c, videos_json(c->l->videos));
}

status api_video_stop(call *c)
{
    TRY(videos_stop(c->l->videos, &c->why));
    return api_reply_json(c, videos_json(c->l->videos));
}

status api_video_file(call *c)
{
    int file;
    size_t size;
    video_format format;
    if (videos_open(c->l->videos, &file, &size, &format, &c->why) != STATUS_OK) {
        c->refused = 404;
        return STATUS_BAD_INPUT;
    }
    http_reply_file(c->reply, 200, format == VIDEO_Y4M ? "video/x-yuv4mpeg" : "image/apng", file, size);
    c->sent = true;
    return STATUS_OK;
}
