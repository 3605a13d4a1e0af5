/* The fuzzer of the PFM reader. */
#include "image_fuzz.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    if (size < 3 || memcmp(data, "P", 1) != 0 || (data[1] | 32) != 'f')
        return 0; /* image_read does not call it */
    image *img = NULL;
    diagnostic why = {.what = ""};
    const status code = codec_pfm_read(data, size, &img, &why);
    check_image(code, img, false, &why);
    return 0;
}
