/* Images of files, and the difference of two images. */
#include "engine/engine_private.h"

#include "image/compare.h"
#include <stdlib.h>
#include <string.h>

struct cuvette_image {
    image *held;
};

cuvette_status cuvette_image_read(const char *path, cuvette_image **out, cuvette_diagnostic *why)
{
    ENGINE_CALL(out);
    *out = NULL;
    ENGINE_NEED(path);
    int bits;
    cuvette_image *made = calloc(1, sizeof *made);
    const status code = made ? image_read(path, &made->held, &bits, &inner) : out_of_memory(&inner);
    if (code == STATUS_OK)
        *out = made;
    else
        free(made);
    return engine_report(code, &inner, why);
}

void cuvette_image_destroy(cuvette_image *img)
{
    if (!img)
        return;
    image_destroy(img->held);
    free(img);
}

const float *cuvette_image_rgb(const cuvette_image *img, int *width, int *height)
{
    if (width)
        *width = img ? img->held->width : 0;
    if (height)
        *height = img ? img->held->height : 0;
    return img ? img->held->pixel : NULL;
}

static status check_size(int width, int height, diagnostic *why)
{
    if (width >= 1 && height >= 1 && width <= IMAGE_SIDE_MAX && height <= IMAGE_SIDE_MAX)
        return STATUS_OK;
    return diagnose(why, STATUS_BAD_INPUT, "use sides from 1 to 65536", "images cannot be %d x %d", width, height);
}

cuvette_status cuvette_compare(int width, int height, const float *a, const float *b, float *map,
                               cuvette_comparison *out, cuvette_diagnostic *why)
{
    ENGINE_CALL(a, b, out);
    /* Only read: the comparison takes images that it does not change. */
    const image one = {.width = width, .height = height, .pixel = (float *)(uintptr_t)a, .owners = 1};
    const image other = {.width = width, .height = height, .pixel = (float *)(uintptr_t)b, .owners = 1};
    image_comparison found;
    image *drawn = NULL;
    status code = check_size(width, height, &inner);
    THEN(code, image_compare(&one, &other, &found, &inner));
    if (code == STATUS_OK && map)
        code = image_compare_map(&one, &other, &drawn, &inner);
    if (code != STATUS_OK)
        return engine_report(code, &inner, why);
    if (map)
        memcpy(map, drawn->pixel, 3 * (size_t)width * (size_t)height * sizeof *map);
    image_destroy(drawn);
    const cuvette_comparison result = {.mse = found.mse,
                                       .psnr_db = found.psnr_db,
                                       .ssim = found.ssim,
                                       .flip = found.flip,
                                       .largest = found.largest,
                                       .differing_share = found.differing_share,
                                       .largest_x = found.largest_x,
                                       .largest_y = found.largest_y};
    return engine_copy_struct(&result, sizeof result, out, why);
}
