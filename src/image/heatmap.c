/* False colours and heat maps: the colour maps, the font of the key, the range of the values, the pixels. */
#include "image/heatmap.h"

#include "base/number.h"
#include "image/codec.h"
#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- colours ---- */

/* Every fifth of the maps' 256 colours; linear interpolation between them is within 1/255 of the others. */
enum { KNOTS = 52 };
static const unsigned char maps[][KNOTS][3] = {
    [VIRIDIS] =
        {
            {68, 1, 84},    {70, 8, 92},    {71, 16, 99},   {72, 23, 105},  {72, 29, 111},  {72, 36, 117},
            {71, 42, 122},  {70, 48, 126},  {69, 55, 129},  {67, 61, 132},  {65, 66, 135},  {63, 72, 137},
            {61, 78, 138},  {58, 83, 139},  {56, 89, 140},  {53, 94, 141},  {51, 99, 141},  {49, 104, 142},
            {46, 109, 142}, {44, 113, 142}, {42, 118, 142}, {41, 123, 142}, {39, 128, 142}, {37, 132, 142},
            {35, 137, 142}, {33, 142, 141}, {32, 146, 140}, {31, 151, 139}, {30, 156, 137}, {31, 161, 136},
            {33, 165, 133}, {36, 170, 131}, {40, 174, 128}, {46, 179, 124}, {53, 183, 121}, {61, 188, 116},
            {70, 192, 111}, {80, 196, 106}, {90, 200, 100}, {101, 203, 94}, {112, 207, 87}, {124, 210, 80},
            {137, 213, 72}, {149, 216, 64}, {162, 218, 55}, {176, 221, 47}, {189, 223, 38}, {202, 225, 31},
            {216, 226, 25}, {229, 228, 25}, {241, 229, 29}, {253, 231, 37},
        },
    [MAGMA] =
        {
            {0, 0, 4},       {2, 2, 11},      {5, 4, 22},      {9, 7, 32},      {14, 11, 43},    {20, 14, 54},
            {26, 16, 66},    {33, 17, 78},    {41, 17, 90},    {49, 17, 101},   {57, 15, 110},   {66, 15, 117},
            {74, 16, 121},   {82, 19, 124},   {90, 22, 126},   {98, 25, 128},   {106, 28, 129},  {114, 31, 129},
            {121, 34, 130},  {129, 37, 129},  {137, 40, 129},  {145, 43, 129},  {153, 45, 128},  {161, 48, 126},
            {170, 51, 125},  {178, 53, 123},  {186, 56, 120},  {194, 59, 117},  {202, 62, 114},  {210, 66, 111},
            {217, 70, 107},  {224, 76, 103},  {231, 82, 99},   {236, 88, 96},   {241, 96, 93},   {244, 105, 92},
            {247, 114, 92},  {249, 123, 93},  {251, 133, 96},  {252, 142, 100}, {253, 152, 105}, {254, 161, 110},
            {254, 170, 116}, {254, 180, 123}, {254, 189, 130}, {254, 198, 138}, {254, 207, 146}, {254, 216, 154},
            {253, 226, 163}, {253, 235, 172}, {252, 244, 182}, {252, 253, 191},
        },
};

void color_map_at(color_map which, double t, double rgb[3])
{
    const double at = (t > 0 ? t < 1 ? t : 1 : 0) * (KNOTS - 1);
    const int knot = at < KNOTS - 2 ? (int)at : KNOTS - 2;
    for (int channel = 0; channel < 3; channel++) {
        const double from = maps[which][knot][channel], to = maps[which][knot + 1][channel];
        rgb[channel] = from + (to - from) * (at - knot);
    }
}

void heatmap_color(double t, unsigned char rgb[3])
{
    double exact[3];
    color_map_at(VIRIDIS, t, exact);
    for (int channel = 0; channel < 3; channel++)
        rgb[channel] = (unsigned char)floor(exact[channel] + 0.5);
}

/* ---- the font ---- */

/* Columns from the left, lowest bit on top: the usual letter forms of 5 by 7 character displays. */
static const unsigned char GLYPHS[95][FONT_WIDTH] = {
    {0x00, 0x00, 0x00, 0x00, 0x00}, {0x00, 0x00, 0x5f, 0x00, 0x00}, {0x00, 0x07, 0x00, 0x07, 0x00}, /*   ! " */
    {0x14, 0x7f, 0x14, 0x7f, 0x14}, {0x24, 0x2a, 0x7f, 0x2a, 0x12}, {0x23, 0x13, 0x08, 0x64, 0x62}, /* # $ % */
    {0x36, 0x49, 0x55, 0x22, 0x50}, {0x00, 0x05, 0x03, 0x00, 0x00}, {0x00, 0x1c, 0x22, 0x41, 0x00}, /* & ' ( */
    {0x00, 0x41, 0x22, 0x1c, 0x00}, {0x14, 0x08, 0x3e, 0x08, 0x14}, {0x08, 0x08, 0x3e, 0x08, 0x08}, /* ) * + */
    {0x00, 0xa0, 0x60, 0x00, 0x00}, {0x08, 0x08, 0x08, 0x08, 0x08}, {0x00, 0x60, 0x60, 0x00, 0x00}, /* , - . */
    {0x20, 0x10, 0x08, 0x04, 0x02}, {0x3e, 0x51, 0x49, 0x45, 0x3e}, {0x00, 0x42, 0x7f, 0x40, 0x00}, /* / 0 1 */
    {0x42, 0x61, 0x51, 0x49, 0x46}, {0x21, 0x41, 0x45, 0x4b, 0x31}, {0x18, 0x14, 0x12, 0x7f, 0x10}, /* 2 3 4 */
    {0x27, 0x45, 0x45, 0x45, 0x39}, {0x3c, 0x4a, 0x49, 0x49, 0x30}, {0x01, 0x71, 0x09, 0x05, 0x03}, /* 5 6 7 */
    {0x36, 0x49, 0x49, 0x49, 0x36}, {0x06, 0x49, 0x49, 0x29, 0x1e}, {0x00, 0x36, 0x36, 0x00, 0x00}, /* 8 9 : */
    {0x00, 0xac, 0x6c, 0x00, 0x00}, {0x08, 0x14, 0x22, 0x41, 0x00}, {0x14, 0x14, 0x14, 0x14, 0x14}, /* ; < = */
    {0x00, 0x41, 0x22, 0x14, 0x08}, {0x02, 0x01, 0x51, 0x09, 0x06}, {0x32, 0x49, 0x79, 0x41, 0x3e}, /* > ? @ */
    {0x7e, 0x11, 0x11, 0x11, 0x7e}, {0x7f, 0x49, 0x49, 0x49, 0x36}, {0x3e, 0x41, 0x41, 0x41, 0x22}, /* A B C */
    {0x7f, 0x41, 0x41, 0x22, 0x1c}, {0x7f, 0x49, 0x49, 0x49, 0x41}, {0x7f, 0x09, 0x09, 0x09, 0x01}, /* D E F */
    {0x3e, 0x41, 0x49, 0x49, 0x7a}, {0x7f, 0x08, 0x08, 0x08, 0x7f}, {0x00, 0x41, 0x7f, 0x41, 0x00}, /* G H I */
    {0x20, 0x40, 0x41, 0x3f, 0x01}, {0x7f, 0x08, 0x14, 0x22, 0x41}, {0x7f, 0x40, 0x40, 0x40, 0x40}, /* J K L */
    {0x7f, 0x02, 0x0c, 0x02, 0x7f}, {0x7f, 0x04, 0x08, 0x10, 0x7f}, {0x3e, 0x41, 0x41, 0x41, 0x3e}, /* M N O */
    {0x7f, 0x09, 0x09, 0x09, 0x06}, {0x3e, 0x41, 0x51, 0x21, 0x5e}, {0x7f, 0x09, 0x19, 0x29, 0x46}, /* P Q R */
    {0x46, 0x49, 0x49, 0x49, 0x31}, {0x01, 0x01, 0x7f, 0x01, 0x01}, {0x3f, 0x40, 0x40, 0x40, 0x3f}, /* S T U */
    {0x1f, 0x20, 0x40, 0x20, 0x1f}, {0x3f, 0x40, 0x38, 0x40, 0x3f}, {0x63, 0x14, 0x08, 0x14, 0x63}, /* V W X */
    {0x07, 0x08, 0x70, 0x08, 0x07}, {0x61, 0x51, 0x49, 0x45, 0x43}, {0x00, 0x7f, 0x41, 0x41, 0x00}, /* Y Z [ */
    {0x02, 0x04, 0x08, 0x10, 0x20}, {0x00, 0x41, 0x41, 0x7f, 0x00}, {0x04, 0x02, 0x01, 0x02, 0x04}, /* \ ] ^ */
    {0x40, 0x40, 0x40, 0x40, 0x40}, {0x00, 0x01, 0x02, 0x04, 0x00}, {0x20, 0x54, 0x54, 0x54, 0x78}, /* _ ` a */
    {0x7f, 0x48, 0x44, 0x44, 0x38}, {0x38, 0x44, 0x44, 0x44, 0x20}, {0x38, 0x44, 0x44, 0x48, 0x7f}, /* b c d */
    {0x38, 0x54, 0x54, 0x54, 0x18}, {0x08, 0x7e, 0x09, 0x01, 0x02}, {0x18, 0xa4, 0xa4, 0xa4, 0x7c}, /* e f g */
    {0x7f, 0x08, 0x04, 0x04, 0x78}, {0x00, 0x44, 0x7d, 0x40, 0x00}, {0x40, 0x80, 0x84, 0x7d, 0x00}, /* h i j */
    {0x7f, 0x10, 0x28, 0x44, 0x00}, {0x00, 0x41, 0x7f, 0x40, 0x00}, {0x7c, 0x04, 0x18, 0x04, 0x78}, /* k l m */
    {0x7c, 0x08, 0x04, 0x04, 0x78}, {0x38, 0x44, 0x44, 0x44, 0x38}, {0xfc, 0x24, 0x24, 0x24, 0x18}, /* n o p */
    {0x18, 0x24, 0x24, 0x24, 0xfc}, {0x7c, 0x08, 0x04, 0x04, 0x08}, {0x48, 0x54, 0x54, 0x54, 0x20}, /* q r s */
    {0x04, 0x3f, 0x44, 0x40, 0x20}, {0x3c, 0x40, 0x40, 0x20, 0x7c}, {0x1c, 0x20, 0x40, 0x20, 0x1c}, /* t u v */
    {0x3c, 0x40, 0x30, 0x40, 0x3c}, {0x44, 0x28, 0x10, 0x28, 0x44}, {0x1c, 0xa0, 0xa0, 0xa0, 0x7c}, /* w x y */
    {0x44, 0x64, 0x54, 0x4c, 0x44}, {0x00, 0x08, 0x36, 0x41, 0x00}, {0x00, 0x00, 0x7f, 0x00, 0x00}, /* z { | */
    {0x00, 0x41, 0x36, 0x08, 0x00}, {0x08, 0x04, 0x08, 0x10, 0x08},                                 /* } ~ */
};

bool font_dot(char character, int column, int row)
{
    if (column < 0 || column >= FONT_WIDTH || row < 0 || row >= FONT_HEIGHT)
        return false;
    char shown = character >= ' ' && character <= '~' ? character : '?';
    return GLYPHS[shown - ' '][column] >> row & 1;
}

/* ---- the scale ---- */

/* Checks every value; on success *largest is the maximum, and *integers is true if all are integers. */
static status inspect(const double *values, size_t count, double *largest, bool *integers, diagnostic *why)
{
    *largest = 0.0;
    *integers = true;
    for (size_t i = 0; i < count; i++) {
        if (!(values[i] >= 0.0) || isinf(values[i]))
            return diagnose(why, STATUS_BAD_INPUT, "use finite values of at least 0",
                            "value %zu of the heat map is negative or not finite", i);
        *largest = values[i] > *largest ? values[i] : *largest;
        *integers = *integers && values[i] == floor(values[i]);
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
    TRY(inspect(values, count, &largest, &out->integers, why));
    /* the 99.5th percentile, by nearest rank; it is 0 if very few values are not 0, and then the scale ends at the
     * maximum */
    const double percentile = nth_smallest(values, count, count - 1 - count / 200);
    out->cut = percentile > 0 && largest > 2 * percentile;
    out->end = out->cut ? percentile : largest;
    return STATUS_OK;
}

/* ---- the key ---- */

static const unsigned char PAPER[3] = {255, 255, 255}, INK[3] = {34, 34, 34}, FRAME[3] = {120, 120, 120};

enum { WIDTH_MIN = 240, SCALE_MAX = 16 };

/* Sizes of the key in pixels; scale is the size of a dot of the font in pixels. */
typedef struct key_layout {
    int scale, margin, bar_x, bar_width, bar_y, bar_height, tick, numbers_y, title_y, height;
} key_layout;

/* An image, and the table that decodes 8-bit sRGB values to linear ones. */
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

/* Draws as many characters of the title as fit; a title that is too long ends in three dots. */
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

/* Draws a tick and the number of a value, at the value's position in the bar. */
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
        value = scale->integers ? floor(value + 0.5) : value;
        if (value > before)
            draw_tick(on, key, top, value, scale);
        before = value;
    }
    draw_title(on, key, top, title);
}

/* ---- the image ---- */

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
