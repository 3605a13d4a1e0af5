/* Renders a video of a copy of the current scene: its slimes move, as with `cuvette animate`, or one parameter changes
 * from one value to another. A thread renders it into a temporary file, which is kept until the next video begins. It
 * holds a place of the semaphore for heavy work, and ends when a study begins to measure. Thread-safe. Ownership:
 * videos_create creates, videos_end joins the thread, videos_destroy releases. */
#pragma once

#include "image/video.h"
#include "scene/motion/motion.h"
#include "web/session/session.h"

typedef struct videos videos;

typedef struct video_plan {
    scene *s;          /* the scene of the first frame, loaded; owned */
    char *path;        /* of the parameter; NULL: the slimes move; owned */
    double from, to;   /* its values in the first and the last frame */
    bool is_integer;   /* the parameter is an integer: values are rounded */
    frame_times times; /* start and duration only of moving slimes */
    int64_t count;     /* of frames */
    video_format format;
} video_plan;

/* Limits of a video: frames, and bytes of its pixels before compression. */
enum { VIDEO_FRAMES_MAX = 1000 };
#define VIDEO_BYTES_MAX 1073741824.0

status videos_create(lab *l, videos **out, diagnostic *why);
void videos_end(videos *v);
void videos_destroy(videos *v); /* NULL is allowed */

void video_plan_release(video_plan *plan);
/* The scene of a frame of a parameter's video; the caller destroys it. */
status video_plan_scene(const video_plan *plan, int64_t frame, scene **out, diagnostic *why);

/* Starts a video and owns the plan, also after an error. STATUS_INTERRUPTED while another video is rendered. */
status videos_start(videos *v, video_plan *plan, diagnostic *why);
status videos_stop(videos *v, diagnostic *why);

/* The event "video" and the state's `video` of web/README.md. */
json_t *videos_json(videos *v);
/* The finished video: a file descriptor, which the caller closes. STATUS_BAD_INPUT if there is none. */
status videos_open(videos *v, int *file, size_t *size, video_format *format, diagnostic *why);
