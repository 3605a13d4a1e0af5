#include "image/compare.h"

#include "image/compare_parts.h"
#include <stdlib.h>

/* magma by S. van der Walt and N. Smith for matplotlib 2015 (CC0), every fifth of its 256 colours; straight lines
 * between them stay within 1/255 of the rest. */
enum { MAGMA_KNOTS = 52 };
static const unsigned char MAGMA[MAGMA_KNOTS][3] = {
    {0, 0, 4},       {2, 2, 11},      {5, 4, 22},      {9, 7, 32},      {14, 11, 43},    {20, 14, 54},
    {26, 16, 66},    {33, 17, 78},    {41, 17, 90},    {49, 17, 101},   {57, 15, 110},   {66, 15, 117},
    {74, 16, 121},   {82, 19, 124},   {90, 22, 126},   {98, 25, 128},   {106, 28, 129},  {114, 31, 129},
    {121, 34, 130},  {129, 37, 129},  {137, 40, 129},  {145, 43, 129},  {153, 45, 128},  {161, 48, 126},
    {170, 51, 125},  {178, 53, 123},  {186, 56, 120},  {194, 59, 117},  {202, 62, 114},  {210, 66, 111},
    {217, 70, 107},  {224, 76, 103},  {231, 82, 99},   {236, 88, 96},   {241, 96, 93},   {244, 105, 92},
    {247, 114, 92},  {249, 123, 93},  {251, 133, 96},  {252, 142, 100}, {253, 152, 105}, {254, 161, 110},
    {254, 170, 116}, {254, 180, 123}, {254, 189, 130}, {254, 198, 138}, {254, 207, 146}, {254, 216, 154},
    {253, 226, 163}, {253, 235, 172}, {252, 244, 182}, {252, 253, 191},
};

/* The map's colour for 0..1 in linear light. */
static void magma(double t, float rgb[3])
{
    double at = (t < 1 ? t : 1) * (MAGMA_KNOTS - 1);
    int knot = at < MAGMA_KNOTS - 2 ? (int)at : MAGMA_KNOTS - 2;
    for (int channel = 0; channel < 3; channel++) {
        double from = MAGMA[knot][channel], to = MAGMA[knot + 1][channel];
        rgb[channel] = (float)srgb_decode((from + (to - from) * (at - knot)) / 255.0);
    }
}

status image_compare_map(const image *a, const image *b, image **map, diagnostic *why)
{
    image *picture = NULL;
    *map = NULL;
    status code = compare_check(a, b, why);
    if (code != STATUS_OK) {
        return code;
    }
    size_t count = (size_t)a->width * (size_t)a->height;
    double *errors = malloc(count * sizeof *errors);
    code = errors ? image_create(a->width, a->height, &picture, why)
                  : diagnose(why, STATUS_FAILURE, NULL, "out of memory for the map of errors");
    if (code == STATUS_OK) {
        code = compare_flip(a, b, errors, why);
    }
    for (size_t i = 0; code == STATUS_OK && i < count; i++) {
        magma(errors[i], picture->pixel + 3 * i);
    }
    free(errors);
    if (code != STATUS_OK) {
        image_destroy(picture);
        return code;
    }
    *map = picture;
    return STATUS_OK;
}
