/* The libFuzzer entry for scenes of strangers: any bytes are a PNG image or a shared page, the code of a link, or the
 * text of a shared scene. An accepted scene names no files, and can be shared again: the text is then read as the same
 * scene. tests/bad/shared has whole ones to start from, and what was found. */
#include "scene/file/shared.h"
#include "image_fuzz.h"

#ifndef FUZZ_REPLAY
size_t LLVMFuzzerCustomMutator(uint8_t *data, size_t size, size_t room, unsigned seed)
{
    (void)seed;
    size = LLVMFuzzerMutate(data, size, room);
    fix_png_sums(data, size);
    return size;
}
#endif

static void check(status code, scene *s, const diagnostic *why)
{
    if (code != STATUS_OK) {
        if (code != STATUS_BAD_INPUT || s || !why->what[0])
            abort();
        return;
    }
    char *text = NULL, *same = NULL;
    scene *again = NULL;
    if (shared_scene_text(s, &text, NULL) != STATUS_OK || strlen(text) > SHARED_TEXT_MAX ||
        shared_read_text("again", text, strlen(text), &again, NULL) != STATUS_OK ||
        shared_scene_text(again, &same, NULL) != STATUS_OK || strcmp(text, same) != 0)
        abort();
    free(same);
    free(text);
    scene_destroy(again);
    scene_destroy(s);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    const char *bytes = (const char *)data;
    scene *s = NULL;
    diagnostic why = {.what = ""};
    status code;
    if (shared_is_file(bytes, size)) {
        code = shared_read_file("fuzz", bytes, size, &s, &why);
        check(code, s, &why);
    }
    char *link = memchr(data, 0, size) ? NULL : text_format(SHARED_FRAGMENT "%.*s", (int)size, bytes);
    if (link) {
        s = NULL;
        code = shared_read_link(link, &s, &why);
        check(code, s, &why);
    }
    free(link);
    s = NULL;
    code = shared_read_text("fuzz", bytes, size, &s, &why);
    check(code, s, &why);
    return 0;
}
