/* YUV4MPEG2, the uncompressed stream of frames that video encoders read (y4m(5) of mjpegtools): 4:2:0 with chroma sited
 * in the centre of its four pixels (C420jpeg), limited range. sRGB-encoded 8-bit pixels are converted to Y'CbCr by
 * ITU-R BT.601 below 720 lines and BT.709 from 720, as players assume; chroma is the mean of its four pixels, or of
 * those that exist at odd edges. Integer arithmetic: the same bytes everywhere. Ownership: streams and images are
 * borrowed. Stream errors are left to the caller that closes the stream. */
#pragma once

#include "image/image.h"
#include <stdint.h>
#include <stdio.h>

/* The stream's header: the frame rate as a fraction. */
status y4m_begin(FILE *stream, int width, int height, int64_t fps_num, int64_t fps_den, diagnostic *why);
/* One frame of that size. */
status y4m_frame(FILE *stream, const image *img, diagnostic *why);
