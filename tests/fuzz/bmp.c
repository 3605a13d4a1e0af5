/* The fuzzer of the BMP reader. */
#include "image_fuzz.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    if (size < 3 || memcmp(data, "BM", 2) != 0)
        return 0; /* image_read does not call it */
    for (int values = IMAGE_LIGHT; values <= IMAGE_CODED; values += 2) {
        image *img = NULL;
        int bits = 0;
        diagnostic why = {.what = ""};
        const status code = codec_bmp_read(data, size, (image_values)values, &img, &bits, &why);
        must(code != STATUS_OK || bits == 8 || bits == 16);
        check_image(code, img, true, &why);
    }
    return 0;
}
