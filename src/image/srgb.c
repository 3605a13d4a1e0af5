/* How values are shown: exposure and the published tone curves, then the sRGB transfer function and its tables. */
#include "image/codec.h"

#include "base/elementary.h"
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

/* IEC 61966-2-1, with the standard's rounded constants. */
double srgb_encode(double linear)
{
    if (!(linear > 0.0)) /* NaN too */
        return 0.0;
    if (linear >= 1.0)
        return 1.0;
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * elementary_pow(linear, 1.0 / 2.4) - 0.055;
}

double srgb_decode(double encoded)
{
    return encoded <= 0.04045 ? encoded / 12.92 : elementary_pow((encoded + 0.055) / 1.055, 2.4);
}

unsigned codec_quantize(float linear, unsigned maximum)
{
    return (unsigned)floor(srgb_encode(linear) * maximum + 0.5);
}

static float float_of(uint32_t word)
{
    float value;
    memcpy(&value, &word, sizeof value);
    return value;
}

static uint32_t word_of(float value)
{
    uint32_t word;
    memcpy(&word, &value, sizeof word);
    return word;
}

/* The least float that is encoded as `byte` or more. Positive floats are ordered as their bits, and the inverse curve
 * is only a few floats off. */
static float least_value(unsigned byte)
{
    uint32_t word = word_of((float)srgb_decode((byte - 0.5) / 255.0));
    while (codec_quantize(float_of(word), 255) >= byte)
        word--;
    while (codec_quantize(float_of(word), 255) < byte)
        word++;
    return float_of(word);
}

void codec_bytes_prepare(codec_bytes *table)
{
    unsigned byte = 0;
    table->least[0] = 0.0f;
    for (unsigned i = 1; i < 256; i++)
        table->least[i] = least_value(i);
    table->least[256] = INFINITY;
    for (uint32_t cell = 0; cell <= CODEC_CELLS; cell++) {
        const float value = float_of((cell + CODEC_CELLS_FROM) << CODEC_CELL_SHIFT);
        while (value >= table->least[byte + 1])
            byte++;
        table->first[cell] = (unsigned char)byte;
    }
}

void codec_bytes_encode(const codec_bytes *table, const float *linear, size_t count, unsigned char *bytes)
{
    for (size_t i = 0; i < count; i++)
        bytes[i] = codec_byte(table, linear[i]);
}

float *codec_decode_table(unsigned maximum)
{
    float *table = malloc(((size_t)maximum + 1) * sizeof *table);
    for (unsigned i = 0; table && i <= maximum; i++)
        table[i] = (float)srgb_decode((double)i / maximum);
    return table;
}

/* ---- 16 bits ---- */

/* Encodes 16-bit words by Taylor polynomials, exactly rounded: values so near to the boundary between two words that
 * the polynomial's error could matter are encoded by codec_quantize.
 *
 * Cells of equal exponent and first 6 bits of the mantissa, from 2^-9 (less than the end of the curve's linear part) to
 * 1. A cell's half width is at most 2^-7 of its centre c. With the exponent a = 1/2.4, the third term of the binomial
 * series is a (a-1) (a-2) / 6 = 0.0641, so the remainder after two is less than
 * 1.055 x 65535 x 0.0641 x 2^-21 x (1 - 2^-7)^(a-3) = 0.0022 words. */
enum { WORD_SHIFT = 17, WORD_CELLS_FROM = 0x3b00 >> 1, WORD_CELLS = 9 * 64 };
static const double word_margin = 1.0 / 256.0, word_max = 65535.0;

typedef struct word_cell {
    double centre, value, slope, bend; /* value includes the 0.5 of rounding */
} word_cell;

struct codec_words {
    word_cell cell[WORD_CELLS];
};

codec_words *codec_words_create(void)
{
    codec_words *table = malloc(sizeof *table);
    for (uint32_t i = 0; table && i < WORD_CELLS; i++) {
        const uint32_t low = (i + WORD_CELLS_FROM) << WORD_SHIFT, high = (i + WORD_CELLS_FROM + 1) << WORD_SHIFT;
        const double a = 1.0 / 2.4;
        float from, to;
        memcpy(&from, &low, sizeof from);
        memcpy(&to, &high, sizeof to);
        const double centre = 0.5 * ((double)from + (double)to);
        const double power = word_max * 1.055 * elementary_pow(centre, a); /* IEC 61966-2-1 */
        table->cell[i] = (word_cell){.centre = centre,
                                     .value = power - word_max * 0.055 + 0.5,
                                     .slope = power * a / centre,
                                     .bend = power * a * (a - 1.0) / 2.0 / (centre * centre)};
    }
    return table;
}

static unsigned word_of_value(const codec_words *table, float linear)
{
    if (!(linear > 0.0031308f) || !(linear < 1.0f)) /* the linear part, and all that is clamped */
        return codec_quantize(linear, 65535);
    uint32_t bits;
    memcpy(&bits, &linear, sizeof bits);
    const word_cell *c = &table->cell[(bits >> WORD_SHIFT) - WORD_CELLS_FROM];
    const double t = (double)linear - c->centre, value = c->value + t * (c->slope + t * c->bend);
    const int word = (int)value;
    const double part = value - word;
    return part < word_margin || part > 1.0 - word_margin ? codec_quantize(linear, 65535) : (unsigned)word;
}

void codec_words_encode(const codec_words *table, const float *linear, size_t count, unsigned char *bytes)
{
    for (size_t i = 0; i < count; i++) {
        const unsigned word = word_of_value(table, linear[i]);
        bytes[2 * i] = (unsigned char)(word >> 8);
        bytes[2 * i + 1] = (unsigned char)word;
    }
}

/* ---- tone ---- */

bool image_tone_is_plain(const image_tone *t)
{
    return t->exposure == 0.0 && t->curve == TONE_NONE;
}

/* 2^stops, exact for integers. */
static double factor_of(double stops)
{
    const double integer = floor(stops), part = stops - integer;
    return ldexp(part > 0.0 ? elementary_pow(2.0, part) : 1.0, (int)integer);
}

/* Reinhard, Stark, Shirley and Ferwerda, "Photographic Tone Reproduction for Digital Images", SIGGRAPH 2002, equation
 * 4: L_d = L (1 + L / L_white^2) / (1 + L), of the luminance (ITU-R BT.709), so that hues do not change. */
static void reinhard(double white, double rgb[3])
{
    const double luminance = 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2];
    const double scale = (1.0 + luminance / (white * white)) / (1.0 + luminance);
    for (int c = 0; c < 3 && luminance > 0.0; c++)
        rgb[c] *= scale;
}

/* The fit by K. Narkowicz, "ACES Filmic Tone Mapping Curve" (2015), of the Academy Color Encoding System's reference
 * transforms, by channel. */
static double aces(double x)
{
    return x > 0.0 ? x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14) : x;
}

void image_tone_apply(const image_tone *t, float *rgb, size_t pixels)
{
    const double factor = factor_of(t->exposure);
    for (size_t i = 0; i < pixels; i++) {
        double at[3];
        for (int c = 0; c < 3; c++)
            at[c] = factor * (double)rgb[3 * i + (size_t)c];
        if (t->curve == TONE_REINHARD)
            reinhard(t->white, at);
        for (int c = 0; c < 3; c++)
            rgb[3 * i + (size_t)c] = (float)(t->curve == TONE_ACES ? aces(at[c]) : at[c]);
    }
}
