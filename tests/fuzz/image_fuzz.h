/* The check of a decoded image, and PNG files whose checksums fit after random changes. */
#pragma once

#include "fuzz.h"
#include "image/codec.h"
#include <math.h>
#include <zlib.h>

/* An accepted image has its size and finite values; those that were coded are in 0..1. */
__attribute__((unused)) static void check_image(status code, image *img, bool coded, const diagnostic *why)
{
    if (code != STATUS_OK) {
        must(!img);
        must_refuse(code, why);
        return;
    }
    must(img->width >= 1 && img->height >= 1 && img->width <= IMAGE_SIDE_MAX && img->height <= IMAGE_SIDE_MAX);
    const size_t count = (size_t)img->width * (size_t)img->height * 3;
    for (size_t i = 0; i < count; i++)
        must(isfinite(img->pixel[i]) && (!coded || (img->pixel[i] >= 0.0F && img->pixel[i] <= 1.0F)));
    image_destroy(img);
}

__attribute__((unused)) static size_t big_endian(const uint8_t *at)
{
    return (size_t)at[0] << 24 | (size_t)at[1] << 16 | (size_t)at[2] << 8 | at[3];
}

/* Random changes alone would stop at the checksums of a PNG file: libpng drops a chunk whose checksum is wrong. */
__attribute__((unused)) static void fix_png_sums(uint8_t *data, size_t size)
{
    if (!image_is_png(data, size))
        return;
    for (size_t at = 8; size - at >= 12 && big_endian(data + at) <= size - at - 12; at += 12 + big_endian(data + at)) {
        const size_t length = big_endian(data + at);
        const uLong sum = crc32(0, data + at + 4, (uInt)(length + 4));
        for (int i = 0; i < 4; i++)
            data[at + 8 + length + (size_t)i] = (uint8_t)(sum >> (24 - 8 * i));
    }
}

#ifndef FUZZ_REPLAY
size_t LLVMFuzzerMutate(uint8_t *data, size_t size, size_t room);
size_t LLVMFuzzerCustomMutator(uint8_t *data, size_t size, size_t room, unsigned seed);
#endif
