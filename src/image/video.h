/* Videos in one file: YUV4MPEG2 or animated PNG. Ownership: streams and images are borrowed. Errors of the stream are
 * left to the caller that closes it. */
#pragma once

#include "image/image.h"
#include <stdint.h>
#include <stdio.h>

/* ---- YUV4MPEG2 ---- */

/* YUV4MPEG2, the uncompressed stream of frames that video encoders read (y4m(5) of mjpegtools): 4:2:0 with chroma sited
 * in the centre of its four pixels (C420jpeg), limited range. sRGB-encoded 8-bit pixels are converted to Y'CbCr by
 * ITU-R BT.601 below 720 lines and BT.709 from 720, as players assume; chroma is the mean of its four pixels, or of
 * those that exist at odd edges. Integer arithmetic: the same bytes everywhere. */

/* The stream's header: the frame rate as a fraction. */
status y4m_begin(FILE *stream, int width, int height, int64_t fps_num, int64_t fps_den, diagnostic *why);
/* One frame of that size. */
status y4m_frame(FILE *stream, const image *img, diagnostic *why);

/* ---- animated PNG ---- */

/* Animated PNG (PNG specification, third edition, 11.3.8): lossless frames in one file that browsers play, and of which
 * other programs show the first. Each frame has the pixels of the PNG file that image_encode makes. */
typedef struct apng {
    FILE *stream;
    uint32_t frames; /* number of frames of the video, known before the first is written */
    int64_t fps_num, fps_den;
    uint32_t sequence, written; /* the next chunk's sequence number; the frames written so far */
} apng;

/* Appends a frame; all have one size. The last one ends the file. */
status apng_frame(apng *a, const image *img, diagnostic *why);

/* ---- a video in a format chosen by its name ---- */

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
