/* The fuzzer of the BMP reader. */
#include "image_fuzz.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    if (size < 3 || memcmp(data, "BM", 2) != 0)
        return 0; /* image_read does not call it */
    image *img = NULL;
    diagnostic why = {.what = ""};
    const status code = codec_bmp_read(data, size, &img, &why);
    check_image(code, img, true, &why);
    return 0;
}
