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

/* Positive floats are ordered as their bits, so bisection on the bits finds the threshold. */
static float least_value(unsigned byte)
{
    uint32_t under = 0, enough = 0x3f800000; /* 0.0f and 1.0f */
    float value;
    while (enough - under > 1) {
        uint32_t middle = under + (enough - under) / 2;
        memcpy(&value, &middle, sizeof value);
        if (codec_quantize(value, 255) >= byte)
            enough = middle;
        else
            under = middle;
    }
    memcpy(&value, &enough, sizeof value);
    return value;
}

void codec_bytes_prepare(codec_bytes *table)
{
    table->least[0] = 0.0f;
    for (unsigned byte = 1; byte < 256; byte++)
        table->least[byte] = least_value(byte);
}

unsigned char codec_byte(const codec_bytes *table, float linear)
{
    unsigned byte = 0;
    for (unsigned step = 128; step > 0; step /= 2)
        byte += linear >= table->least[byte + step] ? step : 0; /* never true for NaN */
    return (unsigned char)byte;
}

float *codec_decode_table(unsigned maximum)
{
    float *table = malloc(((size_t)maximum + 1) * sizeof *table);
    for (unsigned i = 0; table && i <= maximum; i++)
        table[i] = (float)srgb_decode((double)i / maximum);
    return table;
}
