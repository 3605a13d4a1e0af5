/* The libFuzzer entry for the script reader: any bytes give a script or one located error. The keys of an accepted
 * script obey the rules of hands, so that each key can be added again. `make fuzz` builds and runs it; seeds are
 * experiments/ and tests/bad/scripts/. */
#include "scene/assets/slime.h"

#include "fuzz.h"

static void add_again(const hand_script *s, hand_script *copy)
{
    for (size_t i = 0; i < s->track_count; i++)
        for (size_t k = 0; k < s->tracks[i].key_count; k++)
            if (hand_script_add(copy, s->tracks[i].name, &s->tracks[i].keys[k], NULL) != STATUS_OK)
                __builtin_trap();
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    hand_script *s;
    diagnostic why = {.what = ""};
    const status code = script_read_text("fuzz.yaml", (const char *)data, size, &s, &why);
    if (code != STATUS_OK) {
        if (s || code != STATUS_BAD_INPUT || why.line < 1 || why.column < 1 || !why.what[0])
            __builtin_trap();
        return 0;
    }
    hand_script *copy = hand_script_create("copy");
    if (!copy)
        return 0;
    add_again(s, copy);
    if (hand_script_end_s(copy) != hand_script_end_s(s))
        __builtin_trap();
    hand_script_destroy(copy);
    hand_script_destroy(s);
    return 0;
}
