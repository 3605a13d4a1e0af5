/* Radiance's HDR images: lines of text, the resolution with the order of rows and columns, then pixels of three
 * mantissas and a common exponent, plain or with run lengths in the old or the new way. Ward, "Real pixels",
 * Graphics Gems II, 1991; Ward, Radiance File Formats; run lengths as in Radiance's color.c.
 *
 * A value is mantissa / 256 times 2^(exponent - 128), as most programs read it, so that values such as 1 are exact
 * (Walter, rgbe.c; Radiance adds half a step of the mantissa). Pixels are divided by all EXPOSUREs and COLORCORRs,
 * which gives radiance again. RGB without PRIMARIES has those of sRGB, as other programs write and read it. */
#include "image/codec.h"

#include "base/cancel.h"
#include "base/number.h"
#include <float.h>
#include <limits.h>
#include <math.h>
#include <stdlib.h>

enum { LINE_MAX_BYTES = 256, RUNS_LEAST = 8, RUNS_MOST = 0x7fff, RUN = 128 };

#define DAMAGED "copy the file again, or save it again as Radiance HDR"

typedef struct hdr_reading {
    const unsigned char *at, *end;
    double factor[3]; /* of the pixels */
    codec_color color;
    int rows, columns, orientation; /* as they are stored */
    diagnostic *why;
} hdr_reading;

/* ---- the header ---- */

/* The next line, without its end and what is longer than the memory; false if the file ends first. */
static bool read_line(hdr_reading *job, char line[LINE_MAX_BYTES])
{
    size_t length = 0;
    for (; job->at < job->end && *job->at != '\n'; job->at++)
        if (length < LINE_MAX_BYTES - 1 && *job->at != '\r')
            line[length++] = (char)*job->at;
    line[length] = 0;
    return job->at++ < job->end;
}

/* Reads count finite numbers; false if the text has others, or fewer. */
static bool read_numbers(const char *text, int count, double *numbers)
{
    for (int i = 0; i < count; i++) {
        text += strspn(text, " \t");
        if (!number_scan(&text, &numbers[i]))
            return false;
    }
    return true;
}

/* The text after a name and '='; NULL if the line has another name. */
static const char *value_of(const char *line, const char *name)
{
    const size_t length = strlen(name);
    return strncmp(line, name, length) == 0 && line[length] == '=' ? line + length + 1 : NULL;
}

static status bad_line(const hdr_reading *job, const char *line)
{
    return diagnose(job->why, STATUS_BAD_INPUT, DAMAGED, "the header of the HDR file has a wrong line: %.60s", line);
}

static status read_format(hdr_reading *job, const char *format)
{
    format += strspn(format, " \t");
    if (strncmp(format, "32-bit_rle_xyze", 15) == 0)
        codec_color_set_XYZ(&job->color);
    else if (strncmp(format, "32-bit_rle_rgbe", 15) != 0)
        return diagnose(job->why, STATUS_BAD_INPUT, "use one of 32-bit_rle_rgbe or 32-bit_rle_xyze",
                        "the HDR file has the unknown format %.60s", format);
    return STATUS_OK;
}

static bool divide(hdr_reading *job, const double by[3])
{
    bool right = true;
    for (int c = 0; c < 3; c++) {
        job->factor[c] /= by[c];
        right &= by[c] > 0.0 && job->factor[c] > 0.0 && isfinite(job->factor[c]);
    }
    return right;
}

/* Reads one line; others than these say nothing about the values. */
static status read_entry(hdr_reading *job, const char *line, double primaries[8], bool *has_primaries)
{
    const char *value;
    double n[3];
    if ((value = value_of(line, "FORMAT")))
        return read_format(job, value);
    if ((value = value_of(line, "EXPOSURE")))
        return read_numbers(value, 1, n) && divide(job, (const double[]){n[0], n[0], n[0]}) ? STATUS_OK
                                                                                            : bad_line(job, line);
    if ((value = value_of(line, "COLORCORR")))
        return read_numbers(value, 3, n) && divide(job, n) ? STATUS_OK : bad_line(job, line);
    if ((value = value_of(line, "PRIMARIES"))) {
        *has_primaries = true;
        return read_numbers(value, 8, primaries) ? STATUS_OK : bad_line(job, line);
    }
    if ((value = value_of(line, "GAMMA"))) {
        if (!read_numbers(value, 1, n))
            return bad_line(job, line);
        if (fabs(n[0] - 1.0) > 1e-6)
            return diagnose(job->why, STATUS_BAD_INPUT, "save it with linear values",
                            "the values of the HDR file are encoded with gamma %g", n[0]);
    }
    return STATUS_OK;
}

/* The resolution, such as "-Y 512 +X 1024": rows from the top (-Y), columns from the left (+X); or rows along x. */
static bool read_resolution(hdr_reading *job, const char *line, int64_t sides[2])
{
    static const char *const orders[] = {"-Y+X", "-Y-X", "+Y-X", "+Y+X", "+X-Y", "-X-Y", "-X+Y", "+X+Y"};
    char order[5] = "";
    for (int i = 0; i < 2; i++) {
        char digits[NUMBER_TEXT_MAX];
        line += strspn(line, " \t");
        if (!line[0] || !line[1])
            return false;
        memcpy(order + 2 * i, line, 2);
        line += 2 + strspn(line + 2, " \t");
        const size_t length = strspn(line, "0123456789");
        if (length >= sizeof digits)
            return false;
        memcpy(digits, line, length);
        digits[length] = 0;
        if (!number_parse_int(digits, &sides[i]))
            return false;
        line += length;
    }
    for (int i = 0; i < 8; i++)
        if (strcmp(order, orders[i]) == 0)
            job->orientation = i + 1;
    return job->orientation > 0;
}

static status read_header(hdr_reading *job, size_t size)
{
    char line[LINE_MAX_BYTES];
    double xy[8];
    int64_t sides[2];
    bool has_primaries = false;
    do {
        if (!read_line(job, line))
            return diagnose(job->why, STATUS_BAD_INPUT, DAMAGED, "the header of the HDR file is truncated");
        TRY(read_entry(job, line, xy, &has_primaries));
    } while (line[0]);
    if (!read_line(job, line) || !read_resolution(job, line, sides))
        return diagnose(job->why, STATUS_BAD_INPUT, DAMAGED, "the HDR file has no resolution such as -Y 512 +X 1024");
    /* in the file red, green, blue, white; of XYZ they mean nothing */
    const double white_first[8] = {xy[6], xy[7], xy[0], xy[1], xy[2], xy[3], xy[4], xy[5]};
    if (has_primaries && !job->color.mixes && !codec_color_set_primaries(&job->color, white_first))
        return diagnose(job->why, STATUS_BAD_INPUT, DAMAGED, "the PRIMARIES of the HDR file span no colours");
    TRY(codec_check_size(sides[1], sides[0], size, job->why));
    job->rows = (int)sides[0], job->columns = (int)sides[1];
    return STATUS_OK;
}

/* ---- pixels ---- */

/* What is wrong with a row of the file. */
typedef enum row_fault { NO_FAULT, TRUNCATED, DAMAGED_ROW } row_fault;

/* The new way: each of the four components of a row, as runs of one byte and other bytes. */
static row_fault read_components(hdr_reading *job, unsigned char *row)
{
    for (int c = 0; c < 4; c++)
        for (int x = 0; x < job->columns;) {
            if (job->end - job->at < 2)
                return TRUNCATED;
            const int code = *job->at++, count = code > RUN ? code - RUN : code, bytes = code > RUN ? 1 : count;
            if (count == 0 || count > job->columns - x)
                return DAMAGED_ROW;
            if (bytes > job->end - job->at)
                return TRUNCATED;
            for (int i = 0; i < count; i++)
                row[4 * (x + i) + c] = job->at[code > RUN ? 0 : i];
            job->at += bytes;
            x += count;
        }
    return NO_FAULT;
}

/* The old way: a pixel with the mantissas 1, 1, 1 repeats the one before as often as its exponent says; further ones
 * count in units of 256, 65536. Plain pixels have none of these. */
static row_fault read_pixels(hdr_reading *job, unsigned char *row)
{
    int shift = 0;
    for (int x = 0; x < job->columns;) {
        if (job->end - job->at < 4)
            return TRUNCATED;
        const unsigned char *from = job->at;
        job->at += 4;
        if (from[0] != 1 || from[1] != 1 || from[2] != 1) {
            memcpy(row + 4 * x++, from, 4);
            shift = 0;
            continue;
        }
        const int64_t count = shift < 32 ? (int64_t)from[3] << shift : INT_MAX;
        if (x == 0 || count > job->columns - x)
            return DAMAGED_ROW;
        for (int64_t i = 0; i < count; i++, x++)
            memcpy(row + 4 * x, row + 4 * (x - 1), 4);
        shift += 8;
    }
    return NO_FAULT;
}

static row_fault read_row(hdr_reading *job, unsigned char *row)
{
    const bool runs = job->columns >= RUNS_LEAST && job->columns <= RUNS_MOST && job->end - job->at >= 4 &&
                      job->at[0] == 2 && job->at[1] == 2 && job->at[2] < RUN;
    if (!runs)
        return read_pixels(job, row);
    if (codec_big_endian(job->at + 2, 2) != (uint32_t)job->columns)
        return DAMAGED_ROW;
    job->at += 4;
    return read_components(job, row);
}

static status convert_row(const hdr_reading *job, const unsigned char *row, int y, float *pixel)
{
    for (int x = 0; x < job->columns; x++, row += 4, pixel += 3) {
        const double unit = row[3] > 0 ? ldexp(1.0, row[3] - (128 + 8)) : 0.0;
        for (int c = 0; c < 3; c++) {
            pixel[c] = (float)(row[c] * unit * job->factor[c]);
            if (!isfinite(pixel[c]))
                return diagnose(job->why, STATUS_BAD_INPUT, "save it with smaller values",
                                "the pixel in column %d, row %d of the HDR file is too large", x, y);
        }
    }
    return STATUS_OK;
}

static status read_rows(hdr_reading *job, image *img)
{
    unsigned char *row = malloc(4 * (size_t)job->columns);
    status code = row ? STATUS_OK : out_of_memory(job->why);
    for (int y = 0; y < job->rows && code == STATUS_OK; y++) {
        code = cancel_check(job->why);
        const row_fault fault = code == STATUS_OK ? read_row(job, row) : NO_FAULT;
        if (fault != NO_FAULT)
            code = diagnose(job->why, STATUS_BAD_INPUT, DAMAGED, "the HDR file is %s in row %d of %d",
                            fault == TRUNCATED ? "truncated" : "damaged", y, job->rows);
        THEN(code, convert_row(job, row, y, img->pixel + (size_t)y * (size_t)job->columns * 3));
    }
    free(row);
    return code;
}

status codec_hdr_read(const unsigned char *bytes, size_t size, image **out, diagnostic *why)
{
    hdr_reading job = {.at = bytes, .end = bytes + size, .factor = {1.0, 1.0, 1.0}, .why = why};
    image *img;
    *out = NULL;
    TRY(read_header(&job, size));
    TRY(image_create(job.columns, job.rows, &img, why));
    status code = read_rows(&job, img);
    if (code == STATUS_OK)
        codec_color_apply(&job.color, (double)FLT_MAX, img);
    THEN(code, codec_orient(&img, job.orientation, why));
    if (code != STATUS_OK) {
        image_destroy(img);
        return code;
    }
    *out = img;
    return STATUS_OK;
}
