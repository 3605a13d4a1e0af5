/* Animated PNG (PNG specification, third edition, 11.3.8): lossless frames in one file that browsers play, and of which
 * other programs show the first. Each frame has the pixels of the PNG file that image_encode makes. Ownership: streams
 * and images are borrowed. Errors of the stream are left to the caller that closes it. */
#pragma once

#include "image/image.h"
#include <stdint.h>
#include <stdio.h>

typedef struct apng {
    FILE *stream;
    uint32_t frames; /* of the whole film, known before the first */
    int64_t fps_num, fps_den;
    uint32_t sequence, written; /* of chunks; of frames */
} apng;

/* Appends a frame; all have one size. The last one ends the file. */
status apng_frame(apng *a, const image *img, diagnostic *why);
