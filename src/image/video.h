/* Videos in one file. Ownership: streams and images are borrowed. Errors of the stream are
 * left to the caller that closes it. */
#pragma once

#include "image/image.h"
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

/* YUV4MPEG2, the uncompressed stream of frames that video encoders read (y4m(5) of mjpegtools): 4:2:0 with chroma sited
 * in the centre of its four pixels (C420jpeg), limited range. sRGB-encoded 8-bit pixels are converted to Y'CbCr by
 * ITU-R BT.601 below 720 lines and BT.709 from 720, as players assume; chroma is the mean of its four pixels, or of
 * those that exist at odd edges. Integer arithmetic: the same bytes everywhere. */

/* The stream's header: the frame rate as a fraction. */
status y4m_begin(FILE *stream, int width, int height, int64_t fps_num, int64_t fps_den, diagnostic *why);
/* One frame of that size. */
status y4m_frame(FILE *stream, const image *img, diagnostic *why);

/* Whether a file name ends in .y4m (case insensitive). */
bool y4m_is_named(const char *path);
