/* YUV4MPEG2, the plain stream of frames that video encoders read (y4m(5) of mjpegtools): 4:2:0 with chroma in the
 * middle of its four pixels (C420jpeg), limited range. sRGB-coded 8-bit pixels to Y'CbCr by ITU-R BT.601 below 720
 * lines and BT.709 from there on, as players take it; chroma is the mean of its four pixels, at odd edges of those that
 * are there. Integer arithmetic: the same bytes everywhere. Ownership: streams and pictures are borrowed. Errors of the
 * stream are left to whoever closes it. */
#pragma once

#include "image/image.h"
#include <stdint.h>
#include <stdio.h>

/* The stream's header: frames a second as a fraction. */
status y4m_begin(FILE *stream, int width, int height, int64_t fps_num, int64_t fps_den, diagnostic *why);
/* One frame, of that size. */
status y4m_frame(FILE *stream, const image *img, diagnostic *why);
