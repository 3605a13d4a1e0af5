/* The sRGB transfer function to 16 bits by Taylor polynomials, exactly rounded: values so near to the boundary between
 * two words that the polynomial's error could matter are encoded by codec_quantize. */
#include "image/codec.h"

#include "base/elementary.h"
#include <stdlib.h>

/* Cells of equal exponent and first 6 bits of the mantissa, from 2^-9 (less than the end of the curve's linear part) to
 * 1. A cell's half width is at most 2^-7 of its centre c. With the exponent a = 1/2.4, the third term of the binomial
 * series is a (a-1) (a-2) / 6 = 0.0641, so the remainder after two is less than
 * 1.055 x 65535 x 0.0641 x 2^-21 x (1 - 2^-7)^(a-3) = 0.0022 words. */
enum { SHIFT = 17, CELLS_FROM = 0x3b00 >> 1, CELLS = 9 * 64 };
static const double margin = 1.0 / 256.0, maximum = 65535.0;

typedef struct word_cell {
    double centre, value, slope, bend; /* value includes the 0.5 of rounding */
} word_cell;

struct codec_words {
    word_cell cell[CELLS];
};

codec_words *codec_words_create(void)
{
    codec_words *table = malloc(sizeof *table);
    for (uint32_t i = 0; table && i < CELLS; i++) {
        const uint32_t low = (i + CELLS_FROM) << SHIFT, high = (i + CELLS_FROM + 1) << SHIFT;
        const double a = 1.0 / 2.4;
        float from, to;
        memcpy(&from, &low, sizeof from);
        memcpy(&to, &high, sizeof to);
        const double centre = 0.5 * ((double)from + (double)to);
        const double power = maximum * 1.055 * elementary_pow(centre, a); /* IEC 61966-2-1 */
        table->cell[i] = (word_cell){.centre = centre,
                                     .value = power - maximum * 0.055 + 0.5,
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
    const word_cell *c = &table->cell[(bits >> SHIFT) - CELLS_FROM];
    const double t = (double)linear - c->centre, value = c->value + t * (c->slope + t * c->bend);
    const int word = (int)value;
    const double part = value - word;
    return part < margin || part > 1.0 - margin ? codec_quantize(linear, 65535) : (unsigned)word;
}

void codec_words_encode(const codec_words *table, const float *linear, size_t count, unsigned char *bytes)
{
    for (size_t i = 0; i < count; i++) {
        const unsigned word = word_of_value(table, linear[i]);
        bytes[2 * i] = (unsigned char)(word >> 8);
        bytes[2 * i + 1] = (unsigned char)word;
    }
}
