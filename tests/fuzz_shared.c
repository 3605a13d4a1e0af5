/* The libFuzzer entry for scenes of strangers: any bytes are a PNG image or a shared page, the code of a link, or the
 * text of a shared scene. An accepted scene names no files, and can be shared again.
 *   clang -g -O1 -fsanitize=fuzzer,address,undefined ... tests/fuzz_shared.c; ./fuzz_shared CORPUS */
#include "scene/file/shared.h"
#include "base/text.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static void check(status code, scene *s, const diagnostic *why)
{
    if (code != STATUS_OK) {
        if (code != STATUS_BAD_INPUT || s || !why->what[0])
            abort();
        return;
    }
    char *text = NULL;
    if (shared_scene_text(s, &text, NULL) != STATUS_OK || strlen(text) > SHARED_TEXT_MAX)
        abort();
    free(text);
    scene_destroy(s);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    const char *bytes = (const char *)data;
    scene *s = NULL;
    diagnostic why = {.what = ""};
    if (shared_is_file(bytes, size))
        check(shared_read_file("fuzz", bytes, size, &s, &why), s, &why);
    char *link = memchr(data, 0, size) ? NULL : text_format(SHARED_FRAGMENT "%.*s", (int)size, bytes);
    if (link)
        check(shared_read_link(link, &s, &why), s, &why);
    free(link);
    check(shared_read_text("fuzz", bytes, size, &s, &why), s, &why);
    return 0;
}
