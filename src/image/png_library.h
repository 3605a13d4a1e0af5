/* What readers and writers of PNG share of libpng: an error jumps back with its message kept, warnings are ignored, and
 * the bytes come from memory. A job starts with a png_library, which is the pointer that libpng hands back. */
#pragma once

#include "base/status.h"

#include <png.h>
#include <stdbool.h>

typedef struct png_library {
    png_structp png;
    png_infop info;
    char message[256];          /* of libpng's error */
    const unsigned char *bytes; /* of a file that is read */
    size_t size, used;
    int error;      /* errno when libpng ended */
    bool no_memory; /* an allocation of libpng or zlib failed, which is reported like damage */
} png_library;

/* Creates png and info of a job for reading, or for writing; false: out of memory. */
bool png_library_read(png_library *of);
bool png_library_write(png_library *of);
/* The status of a read, and of a write, that ended with an error of libpng. */
status png_library_failed(const png_library *of, diagnostic *why);
status png_library_unwritten(const png_library *of, diagnostic *why);

/* Before the first byte of a file that anyone may have made, and after setjmp: it is read from memory, no chunk takes
 * more bytes than the file has or than chunk_max when it is expanded, and a wrong checksum is an error. */
void png_library_guard(png_library *of, size_t chunk_max);
