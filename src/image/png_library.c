/* Callbacks of libpng. */
#include "image/png_library.h"
#include "image/image.h"

#include "base/system_error.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static __attribute__((noreturn)) void png_library_error(png_structp png, png_const_charp message)
{
    png_library *of = png_get_error_ptr(png);
    of->error = errno;
    snprintf(of->message, sizeof of->message, "%s", message);
    png_longjmp(png, 1);
}

static void png_library_warning(png_structp png, png_const_charp message)
{
    (void)png;
    (void)message;
}

static png_voidp take_memory(png_structp png, png_alloc_size_t size)
{
    png_library *of = png_get_mem_ptr(png);
    void *memory = malloc(size);
    of->no_memory |= !memory;
    return memory;
}

static void give_memory(png_structp png, png_voidp memory)
{
    (void)png;
    free(memory);
}

bool png_library_read(png_library *of)
{
    of->png = png_create_read_struct_2(PNG_LIBPNG_VER_STRING, of, png_library_error, png_library_warning, of,
                                       take_memory, give_memory);
    of->info = of->png ? png_create_info_struct(of->png) : NULL;
    return of->info;
}

bool png_library_write(png_library *of)
{
    of->png = png_create_write_struct_2(PNG_LIBPNG_VER_STRING, of, png_library_error, png_library_warning, of,
                                        take_memory, give_memory);
    of->info = of->png ? png_create_info_struct(of->png) : NULL;
    return of->info;
}

status png_library_unwritten(const png_library *of, diagnostic *why)
{
    return of->no_memory ? out_of_memory(why)
                         : system_error(why, STATUS_FAILURE, NULL, "cannot write the PNG file", of->error,
                                        "write a PFM file instead");
}

status png_library_failed(const png_library *of, diagnostic *why)
{
    return of->no_memory ? out_of_memory(why)
                         : diagnose(why, STATUS_BAD_INPUT, "copy the file again, or save it again as PNG",
                                    "the PNG file is damaged: %s", of->message);
}

static void take_bytes(png_structp png, png_bytep to, size_t count)
{
    png_library *from = png_get_io_ptr(png);
    if (count > from->size - from->used)
        png_error(png, "the file is truncated");
    memcpy(to, from->bytes + from->used, count);
    from->used += count;
}

/* libpng takes memory for a chunk of any length, up to 2 GiB, before it reads it: its limit is only a warning. */
static void check_lengths(const png_library *of)
{
    for (size_t at = 8; of->size > at && of->size - at >= 8;) {
        const size_t length = png_get_uint_32(of->bytes + at), left = of->size - at - 8;
        if (length > left)
            png_error(of->png, "the file is truncated");
        if (memcmp(of->bytes + at + 4, "IEND", 4) == 0)
            return;
        at += 12 + length;
    }
}

void png_library_guard(png_library *of, size_t chunk_max)
{
    png_set_read_fn(of->png, of, take_bytes);
    png_set_user_limits(of->png, IMAGE_SIDE_MAX, IMAGE_SIDE_MAX);
    png_set_chunk_malloc_max(of->png, chunk_max);
    png_set_chunk_cache_max(of->png, 128);
    png_set_crc_action(of->png, PNG_CRC_ERROR_QUIT, PNG_CRC_ERROR_QUIT);
    check_lengths(of);
}
