/* The FLIP error as a false-colour image. */
#include "image/compare.h"

#include "base/cancel.h"
#include "image/color_map.h"
#include "image/compare_parts.h"
#include <stdlib.h>

/* The map's colour for 0..1 in linear values. */
static void magma(double t, float linear[3])
{
    double rgb[3];
    color_map_at(MAGMA, t, rgb);
    for (int channel = 0; channel < 3; channel++)
        linear[channel] = (float)srgb_decode(rgb[channel] / 255.0);
}

status image_compare_map(const image *a, const image *b, image **map, diagnostic *why)
{
    image *img = NULL;
    *map = NULL;
    TRY(compare_check(a, b, why));
    size_t count = (size_t)a->width * (size_t)a->height;
    double *errors = malloc(count * sizeof *errors);
    status code = errors ? image_create(a->width, a->height, &img, why)
                         : diagnose(why, STATUS_FAILURE, MEMORY_REMEDY, "out of memory for the map of errors");
    THEN(code, compare_flip(a, b, errors, why));
    for (size_t i = 0; code == STATUS_OK && i < count && !cancel_asked(); i++)
        magma(errors[i], img->pixel + 3 * i);
    THEN(code, cancel_check(why));
    free(errors);
    if (code != STATUS_OK) {
        image_destroy(img);
        return code;
    }
    *map = img;
    return STATUS_OK;
}
