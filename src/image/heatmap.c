/* Heat maps: the range of the values, the pixels, and the key. */
#include "image/heatmap.h"

#include "base/number.h"
#include "image/codec.h"
#include "image/color_map.h"
#include "image/font.h"
#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const unsigned char PAPER[3] = {255, 255, 255}, INK[3] = {34, 34, 34}, FRAME[3] = {120, 120, 120};

enum { WIDTH_MIN = 240, SCALE_MAX = 16 };

/* Sizes of the key in pixels; scale is the size of a dot of the font in pixels. */
typedef struct key_layout {
    int scale, margin, bar_x, bar_width, bar_y, bar_height, tick, numbers_y, title_y, height;
} key_layout;

void heatmap_color(double t, unsigned char rgb[3])
{
    double exact[3];
    color_map_at(VIRIDIS, t, exact);
    for (int channel = 0; channel < 3; channel++)
        rgb[channel] = (unsigned char)floor(exact[channel] + 0.5);
}

/* An image and the linear values of the 256 encoded ones. */
typedef struct canvas {
    image *img;
    const float *decoded;
} canvas;

static void fill(const canvas *on, int x, int y, int width, int height, const unsigned char rgb[3])
{
    image *img = on->img;
    float linear[3] = {on->decoded[rgb[0]], on->decoded[rgb[1]], on->decoded[rgb[2]]};
    int right = x + width < img->width ? x + width : img->width;
    int bottom = y + height < img->height ? y + height : img->height;
    for (int row = y > 0 ? y : 0; row < bottom; row++)
        for (int column = x > 0 ? x : 0; column < right; column++)
            memcpy(img->pixel + ((size_t)row * (size_t)img->width + (size_t)column) * 3, linear, sizeof linear);
}

static int text_width(size_t length, int scale)
{
    return length == 0 ? 0 : ((int)length * FONT_ADVANCE - (FONT_ADVANCE - FONT_WIDTH)) * scale;
}

static void draw_text(const canvas *on, int x, int y, int scale, const char *text)
{
    for (; *text; text++, x += FONT_ADVANCE * scale) {
        for (int dot = 0; dot < FONT_WIDTH * FONT_HEIGHT; dot++) {
            int column = dot % FONT_WIDTH, row = dot / FONT_WIDTH;
            if (font_dot(*text, column, row))
                fill(on, x + column * scale, y + row * scale, scale, scale, INK);
        }
    }
}

/* A number of the key: four digits, with an SI prefix if it would be long: 0, 29.5, 118, 3.086M. */
static void format_key(double value, double largest, char text[NUMBER_TEXT_MAX + 2])
{
    static const struct {
        double unit;
        const char *prefix;
    } prefixes[] = {
        {1e12, "T"}, {1e9, "G"}, {1e6, "M"}, {1e3, "k"}, {1, ""}, {1e-3, "m"}, {1e-6, "u"}, {1e-9, "n"},
    };
    size_t i = 4;
    if (largest >= 1e4 || largest < 1e-2) {
        for (i = 0; i < 7 && largest < prefixes[i].unit; i++) {
        }
    }
    double scaled = value / prefixes[i].unit, power = 1.0;
    while (scaled > 0 && scaled * power < 999.95 && power < 1e15)
        power *= 10.0;
    number_format(floor(scaled * power + 0.5) / power, text);
    strcat(text, scaled > 0 ? prefixes[i].prefix : "");
}

static key_layout lay_out_key(int width)
{
    int scale = (width + 200) / 400;
    scale = scale < 1 ? 1 : scale > SCALE_MAX ? SCALE_MAX : scale;
    key_layout key = {.scale = scale, .margin = 7 * scale, .bar_x = 20 * scale, .bar_width = width - 40 * scale};
    key.bar_y = key.margin;
    key.bar_height = 9 * scale;
    key.tick = 3 * scale;
    key.numbers_y = key.bar_y + key.bar_height + key.tick + 2 * scale;
    key.title_y = key.numbers_y + (FONT_HEIGHT + 5) * scale;
    key.height = key.title_y + (FONT_HEIGHT - 1) * scale + key.margin;
    return key;
}

/* As many characters as fit; a title that is too long ends in three dots. */
static void draw_title(const canvas *on, const key_layout *key, int top, const char *title)
{
    char shown[256];
    size_t room = (size_t)((on->img->width - 2 * key->margin) / (FONT_ADVANCE * key->scale));
    room = room < sizeof shown ? room : sizeof shown - 1;
    size_t length = strlen(title);
    snprintf(shown, room + 1, "%s", title);
    if (length > room && room > 3)
        memcpy(shown + room - 3, "...", 3);
    int x = (on->img->width - text_width(strlen(shown), key->scale)) / 2;
    draw_text(on, x, top + key->title_y, key->scale, shown);
}

static void draw_number(const canvas *on, const key_layout *key, int top, int center, const char *text)
{
    int width = text_width(strlen(text), key->scale), x = center - width / 2;
    int rightmost = on->img->width - width - 2 * key->scale;
    x = x > rightmost ? rightmost : x;
    draw_text(on, x < 2 * key->scale ? 2 * key->scale : x, top + key->numbers_y, key->scale, text);
}

/* A tick and its number, at its position in the bar. */
static void draw_tick(const canvas *on, const key_layout *key, int top, double value, const heatmap_scale *scale)
{
    int line = (key->scale + 1) / 2;
    bool first = value == 0, last = value == scale->end;
    int x = key->bar_x + (first ? 0 : (int)floor(key->bar_width * (value / scale->end) + 0.5));
    int left = x - (first ? line : last ? 0 : line / 2);
    fill(on, left, top + key->bar_y + key->bar_height, line, key->tick, FRAME);
    char text[NUMBER_TEXT_MAX + 4] = ">=";
    format_key(value, scale->end, text + (last && scale->cut ? 2 : 0));
    draw_number(on, key, top, x, text);
}

static void draw_key(const canvas *on, const key_layout *key, int top, const heatmap_scale *scale, const char *title)
{
    int line = (key->scale + 1) / 2, bar_top = top + key->bar_y;
    fill(on, key->bar_x - line, bar_top - line, key->bar_width + 2 * line, key->bar_height + 2 * line, FRAME);
    for (int x = 0; x < key->bar_width; x++) {
        unsigned char rgb[3];
        heatmap_color((x + 0.5) / key->bar_width, rgb);
        fill(on, key->bar_x + x, bar_top, 1, key->bar_height, rgb);
    }
    double before = -1.0;
    for (int quarter = 0; quarter <= (scale->end > 0 ? 4 : 0); quarter++) {
        double value = scale->end * quarter / 4.0;
        value = scale->whole ? floor(value + 0.5) : value;
        if (value > before)
            draw_tick(on, key, top, value, scale);
        before = value;
    }
    draw_title(on, key, top, title);
}

/* Checks every value; on success *largest is the maximum, and *whole is true if all are integers. */
static status inspect(const double *values, size_t count, double *largest, bool *whole, diagnostic *why)
{
    *largest = 0.0;
    *whole = true;
    for (size_t i = 0; i < count; i++) {
        if (!(values[i] >= 0.0) || isinf(values[i]))
            return diagnose(why, STATUS_BAD_INPUT, "use finite values of at least 0",
                            "value %zu of the heat map is negative or not finite", i);
        *largest = values[i] > *largest ? values[i] : *largest;
        *whole = *whole && values[i] == floor(values[i]);
    }
    return STATUS_OK;
}

/* The element number `rank` of the values in ascending order. Non-negative doubles are ordered as their bits (IEEE
 * 754), so a radix selection finds it byte by byte, without a copy. */
static double nth_smallest(const double *values, size_t count, size_t rank)
{
    uint64_t found = 0;
    for (int shift = 56; shift >= 0; shift -= 8) {
        size_t counts[256] = {0};
        for (size_t i = 0; i < count; i++) {
            double value = values[i] + 0.0; /* -0 becomes 0 */
            uint64_t bits;
            memcpy(&bits, &value, sizeof bits);
            if (shift == 56 || bits >> (shift + 8) == found)
                counts[bits >> shift & 255]++;
        }
        unsigned byte = 0;
        while (rank >= counts[byte])
            rank -= counts[byte++];
        found = found << 8 | byte;
    }
    double value;
    memcpy(&value, &found, sizeof value);
    return value;
}

status heatmap_scale_of(const double *values, size_t count, heatmap_scale *out, diagnostic *why)
{
    double largest;
    TRY(inspect(values, count, &largest, &out->whole, why));
    double percentile = nth_smallest(values, count, count - 1 - count / 200); /* the 99.5th percentile, by nearest rank
                                                                                 */
    out->cut = percentile > 0 && largest > 2 * percentile; /* with very few non-zero values the percentile is
                                                              meaningless */
    out->end = out->cut ? percentile : largest;
    return STATUS_OK;
}

static void draw_values(const canvas *on, int left, const double *values, int width, int height, double end)
{
    for (int y = 0; y < height; y++) {
        for (int x = 0; x < width; x++) {
            unsigned char rgb[3];
            double value = values[(size_t)y * (size_t)width + (size_t)x];
            heatmap_color(end > 0 ? value / end : 0.0, rgb);
            fill(on, left + x, y, 1, 1, rgb);
        }
    }
}

static void draw(const canvas *on, const double *values, int width, int height, const heatmap_scale *scale,
                 const char *title, const key_layout *key)
{
    fill(on, 0, 0, on->img->width, on->img->height, PAPER);
    draw_values(on, (on->img->width - width) / 2, values, width, height, scale->end);
    draw_key(on, key, height, scale, title);
}

status heatmap_create(const double *values, int width, int height, const char *title, image **out, diagnostic *why)
{
    heatmap_scale scale;
    *out = NULL;
    if (width < 1 || height < 1 || width > IMAGE_SIDE_MAX || height > IMAGE_SIDE_MAX)
        return diagnose(why, STATUS_BAD_INPUT, "use a width and height of 1 to 65536",
                        "a heat map cannot have %d x %d values", width, height);
    TRY(heatmap_scale_of(values, (size_t)width * (size_t)height, &scale, why));
    int image_width = width < WIDTH_MIN ? WIDTH_MIN : width;
    key_layout key = lay_out_key(image_width);
    float *decoded = codec_decode_table(255);
    image *img = NULL;
    if (!decoded)
        return out_of_memory(why);
    status code = image_create(image_width, height + key.height, &img, why);
    if (code == STATUS_OK) {
        draw(&(canvas){img, decoded}, values, width, height, &scale, title ? title : "", &key);
        *out = img;
    }
    free(decoded);
    return code;
}
