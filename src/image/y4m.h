/* The writer of YUV4MPEG2, the uncompressed stream of frames that video encoders read (y4m(5) of mjpegtools): 4:2:0
 * with chroma at the centre of its four pixels (C420jpeg), limited range. sRGB-encoded 8-bit pixels are converted to
 * Y'CbCr by ITU-R BT.601 below 720 lines and BT.709 from 720 lines on, as players assume; chroma is the mean of its
 * four pixels, at odd edges of those inside the image. Integer arithmetic: the same bytes on every machine. Ownership:
 * streams and images are borrowed. Whoever closes the stream checks it for errors. */
#pragma once

#include "image/image.h"
#include <stdint.h>
#include <stdio.h>

/* Writes the stream's header; fps_num / fps_den frames a second. */
status y4m_begin(FILE *stream, int width, int height, int64_t fps_num, int64_t fps_den, diagnostic *why);
/* Writes one frame, whose size must be that of the header. */
status y4m_frame(FILE *stream, const image *img, diagnostic *why);
