/* The sRGB transfer function and its tables. */
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

/* Positive floats are ordered as their bits; the inverse curve is a few of them from the threshold. */
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
