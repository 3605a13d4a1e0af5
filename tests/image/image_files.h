/* A folder for the image files of a test, emptied at its end, and a small image. */
#pragma once

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "base/file.h"
#include "base/os_process.h"
#include "base/text.h"
#include "image/codec.h"
#include "image/image.h"
#include <dirent.h>
#include <math.h>
#include <png.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>
#include <jpeglib.h>

static char folder[4096];

__attribute__((unused)) static int make_folder(void **state)
{
    (void)state;
    const char *base = getenv("TMPDIR");
    snprintf(folder, sizeof folder, "%s/cuvette-image-XXXXXX", base && *base ? base : "/tmp");
    return mkdtemp(folder) ? 0 : -1;
}

/* Empties the folder; returns the number of files that were in it. */
static int empty_folder(void)
{
    DIR *entries = opendir(folder);
    int count = 0;
    for (struct dirent *entry; entries && (entry = readdir(entries));) {
        char *path = text_format("%s/%s", folder, entry->d_name);
        count += unlink(path) == 0;
        free(path);
    }
    if (entries)
        closedir(entries);
    return count;
}

__attribute__((unused)) static int remove_folder(void **state)
{
    (void)state;
    empty_folder();
    rmdir(folder);
    return 0;
}

__attribute__((unused)) static char *in_folder(const char *name)
{
    char *path = text_format("%s/%s", folder, name);
    assert_non_null(path);
    return path;
}

typedef struct blob {
    char *bytes;
    size_t size;
} blob;

__attribute__((unused)) static blob get(const char *path)
{
    blob b;
    assert_int_equal(file_read(path, SIZE_MAX, &b.bytes, &b.size, NULL), STATUS_OK);
    return b;
}

__attribute__((unused)) static void put(const char *path, const void *bytes, size_t size)
{
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, size, file), size);
    assert_int_equal(fclose(file), 0);
}

__attribute__((unused)) static void assert_close(double value, double expected, double tolerance)
{
    if (!(fabs(value - expected) <= tolerance))
        fail_msg("%.17g is not %.17g within %g", value, expected, tolerance);
}

static uint32_t next_random(uint32_t *state)
{
    *state ^= *state << 13; /* xorshift32, Marsaglia 2003 */
    *state ^= *state >> 17;
    return *state ^= *state << 5;
}

__attribute__((unused)) static bool same_float(float a, float b)
{
    return memcmp(&a, &b, sizeof a) == 0;
}

/* A smooth image with some grain. */
__attribute__((unused)) static image *make_image(int width, int height)
{
    image *img;
    uint32_t random = 12345;
    assert_int_equal(image_create(width, height, &img, NULL), STATUS_OK);
    for (int i = 0; i < width * height * 3; i++) {
        int x = i / 3 % width, y = i / 3 / width;
        double wave = 0.5 + 0.4 * sin(0.2 * x + i % 3) * cos(0.15 * y);
        img->pixel[i] = (float)(wave + 0.05 * (next_random(&random) % 1000) / 1000.0);
    }
    return img;
}
