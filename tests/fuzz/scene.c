/* The libFuzzer entry for the scene reader: any bytes are a scene file. An accepted scene must also survive the usual
 * operations: each parameter is visited and set again to its own text; the scene is checked, copied and released. */
#include "scene/model/params.h"

#include "fuzz.h"

static status set_again(void *context, const char *path, const param *row, const char *value)
{
    (void)row;
    return scene_set(context, path, value, NULL);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    scene *s;
    diagnostic why = {.what = ""};
    status code = scene_read_text("fuzz.yaml", (const char *)data, size, &s, &why);
    if (code != STATUS_OK) {
        if (code != STATUS_BAD_INPUT || why.line < 1 || why.column < 1 || !why.what[0])
            abort();
        return 0;
    }
    scene *copy = scene_clone(s);
    if (!copy || scene_each_param(s, set_again, copy) != STATUS_OK || scene_check(copy, NULL) != STATUS_OK)
        abort();
    scene_destroy(copy);
    scene_destroy(s);
    return 0;
}
