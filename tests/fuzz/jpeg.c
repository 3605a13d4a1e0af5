/* The fuzzer of the JPEG reader. */
#include "image_fuzz.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    if (size < 3 || memcmp(data, "\xff\xd8\xff", 3) != 0)
        return 0; /* image_read does not call it */
    for (int values = IMAGE_LIGHT; values <= IMAGE_CODED; values += 2) {
        image *img = NULL;
        diagnostic why = {.what = ""};
        const status code = codec_jpeg_read(data, size, (image_values)values, &img, &why);
        check_image(code, img, true, &why);
    }
    return 0;
}
