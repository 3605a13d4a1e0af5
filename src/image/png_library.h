/* What readers and writers of PNG share of libpng: an error jumps back with its message kept, warnings are ignored, and
 * the bytes come from memory. A job starts with a png_library, which is the pointer that libpng hands back. */
#pragma once

#include <png.h>

typedef struct png_library {
    png_structp png;
    png_infop info;
    char message[256];          /* of libpng's error */
    const unsigned char *bytes; /* of a file that is read */
    size_t size, used;
} png_library;

void png_library_error(png_structp png, png_const_charp message) __attribute__((noreturn));
void png_library_warning(png_structp png, png_const_charp message);
/* Before the first byte of a file that anyone may have made, and after setjmp: it is read from memory, no chunk takes
 * more bytes than the file has or than chunk_max when it is expanded, and a wrong checksum is an error. */
void png_library_guard(png_library *of, size_t chunk_max);
