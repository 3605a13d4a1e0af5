/* PFM, Paul Debevec's portable float map: "PF" (colour) or "Pf" (grey), width height, a scale whose sign determines the
 * byte order (negative: little-endian), one blank, then floats, rows from the bottom. The absolute value of the scale
 * is a unit and is not applied, as in other readers. */
#include "image/codec.h"

#include "base/cancel.h"
#include "base/number.h"
#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

status codec_pfm_write(const image_rows *rows, FILE *stream, diagnostic *why)
{
    size_t count = (size_t)rows->width * 3;
    unsigned char *row = malloc(count * 4);
    float *pixel = malloc(count * sizeof *pixel);
    if (!row || !pixel) {
        free(row);
        free(pixel);
        return out_of_memory(why);
    }
    fprintf(stream, "PF\n%d %d\n-1.0\n", rows->width, rows->height);
    for (int y = rows->height - 1; y >= 0 && !cancel_asked(); y--) {
        rows->read(rows->of, y, pixel);
        for (size_t i = 0; i < count; i++) {
            uint32_t word;
            memcpy(&word, &pixel[i], sizeof word);
            for (int byte = 0; byte < 4; byte++)
                row[4 * i + (size_t)byte] = (unsigned char)(word >> 8 * byte);
        }
        if (fwrite(row, 4, count, stream) != count)
            break; /* a write error stays set in the stream */
    }
    free(row);
    free(pixel);
    return cancel_check(why);
}

typedef struct cursor {
    const unsigned char *at, *end;
} cursor;

static bool is_blank(unsigned char c)
{
    return c == ' ' || c == '\n' || c == '\r' || c == '\t';
}

/* The next word of the header, without leading blanks; false if it is missing or too long. */
static bool read_word(cursor *c, char word[NUMBER_TEXT_MAX])
{
    size_t length = 0;
    while (c->at < c->end && is_blank(*c->at))
        c->at++;
    while (c->at < c->end && !is_blank(*c->at) && length < NUMBER_TEXT_MAX - 1)
        word[length++] = (char)*c->at++;
    word[length] = 0;
    return length > 0 && c->at < c->end && is_blank(*c->at);
}

static float read_float(const unsigned char *b, bool little)
{
    uint32_t word = little ? (uint32_t)b[0] | (uint32_t)b[1] << 8 | (uint32_t)b[2] << 16 | (uint32_t)b[3] << 24
                           : (uint32_t)b[3] | (uint32_t)b[2] << 8 | (uint32_t)b[1] << 16 | (uint32_t)b[0] << 24;
    float value;
    memcpy(&value, &word, sizeof value);
    return value;
}

static status read_pixels(const unsigned char *bytes, int channels, bool little, image *img, diagnostic *why)
{
    for (int y = img->height - 1; y >= 0; y--) {
        TRY(cancel_check(why));
        for (int x = 0; x < img->width; x++) {
            float *pixel = img->pixel + ((size_t)y * (size_t)img->width + (size_t)x) * 3;
            for (int channel = 0; channel < 3; channel++) {
                pixel[channel] = read_float(bytes + (channels == 3 ? 4 * channel : 0), little);
                if (!isfinite(pixel[channel]))
                    return diagnose(why, STATUS_BAD_INPUT, "use an image with finite values",
                                    "the pixel in column %d, row %d from the top is not a finite number", x, y);
            }
            bytes += 4 * channels;
        }
    }
    return STATUS_OK;
}

status codec_pfm_read(const unsigned char *bytes, size_t size, image **out, diagnostic *why)
{
    cursor c = {bytes + 2, bytes + size};
    char width_text[NUMBER_TEXT_MAX], height_text[NUMBER_TEXT_MAX], scale_text[NUMBER_TEXT_MAX];
    int64_t width, height;
    double scale;
    int channels = bytes[1] == 'F' ? 3 : 1;
    *out = NULL;
    if (!read_word(&c, width_text) || !read_word(&c, height_text) || !read_word(&c, scale_text) ||
        !number_parse_int(width_text, &width) || !number_parse_int(height_text, &height) ||
        !number_parse_real(scale_text, &scale) || !(fabs(scale) > 0)) {
        return diagnose(why, STATUS_BAD_INPUT, "write width, height and a scale other than 0 into the header",
                        "the header of the PFM file is damaged");
    }
    c.at++;
    TRY(codec_check_size(width, height, size, why));
    size_t expected = (size_t)width * (size_t)height * (size_t)channels * 4, got = (size_t)(c.end - c.at);
    if (got != expected)
        return diagnose(why, STATUS_BAD_INPUT, "copy the file again",
                        "the PFM file is %s: %zu bytes of pixels instead of %zu",
                        got < expected ? "truncated" : "too long", got, expected);
    image *img;
    TRY(image_create((int)width, (int)height, &img, why));
    status code = read_pixels(c.at, channels, scale < 0, img, why);
    if (code != STATUS_OK) {
        image_destroy(img);
        return code;
    }
    *out = img;
    return STATUS_OK;
}
