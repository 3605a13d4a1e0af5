/* A film in one file, in a format chosen by its name: YUV4MPEG2 (image/y4m.h) or animated PNG (image/apng.h).
 * Ownership: streams and images are borrowed. Errors of the stream are left to the caller that closes it. */
#pragma once

#include "image/apng.h"

typedef enum video_format { VIDEO_NONE, VIDEO_Y4M, VIDEO_APNG } video_format;
/* Of a file name that ends in .y4m or .apng (case insensitive); otherwise VIDEO_NONE. */
video_format video_format_of(const char *path);

typedef struct video {
    video_format format;
    apng png;
    FILE *stream;
} video;

/* frames: the number of frames to come; the rate is a fraction. */
status video_begin(video *v, video_format format, FILE *stream, int width, int height, int64_t frames, int64_t fps_num,
                   int64_t fps_den, diagnostic *why);
status video_frame(video *v, const image *img, diagnostic *why);
