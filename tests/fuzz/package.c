/* The fuzzer of scene packages: changes of a valid package with a hash that fits. A package belongs to its build, so
 * the input is not the package but a list of changes, six bytes each: the place (three bytes), what is done there and
 * with which value. A last byte cuts the package. What is accepted can be packed again. */
#include "scene/package/package.h"
#include "base/hash.h"
#include "fuzz.h"
#include "scene/model/scene.h"

static const char text_of_scene[] =
    "title: fuzz\nrender: {width: 4, height: 3}\n"
    "meshes: {ball: {generate: icosphere, level: 0}, ground: {generate: terrain, depth: 0, around: 3, tube: 3},\n"
    "  toy: {generate: slime, level: 0, time_s: 0}}\n"
    "lights: {lamp: {position: [4, 7, -5]}}\n"
    "solids: {one: {shape: mesh, mesh: ball}, two: {shape: mesh, mesh: ground}, three: {shape: mesh, mesh: toy},\n"
    "  four: {shape: sphere, radius: 1}}\n";

enum { SIZE_AT = 48, WORD = 8 };

/* The valid package. */
static const char *original(size_t *size)
{
    static void *bytes;
    static size_t length;
    scene *s = NULL;
    if (!bytes) {
        must(scene_read_text("fuzz.yaml", text_of_scene, strlen(text_of_scene), &s, NULL) == STATUS_OK &&
             scene_load(s, NULL) == STATUS_OK && scene_build_hierarchies(s, NULL) == STATUS_OK &&
             scene_pack(s, &bytes, &length, NULL) == STATUS_OK);
        scene_destroy(s);
    }
    *size = length;
    return bytes;
}

static void change(char *word, uint8_t what, uint8_t value)
{
    static const uint64_t values[] = {
        0, 1, UINT64_MAX, 0xffffffff, UINT64_C(0x7ff8000000000000), UINT64_C(0x7ff0000000000000), 1u << 31, 1u << 20};
    uint64_t number;
    memcpy(&number, word, sizeof number);
    switch (what % 4) {
    case 0: number = values[value % (sizeof values / sizeof *values)]; break;
    case 1: number ^= UINT64_C(1) << value % 64; break;
    case 2: number += (uint64_t)(int64_t)(int8_t)value; break;
    default: number = (number & ~UINT64_C(0xff)) | value; break;
    }
    memcpy(word, &number, sizeof number);
}

static void put_word(char *bytes, size_t at, uint64_t value)
{
    memcpy(bytes + at, &value, sizeof value);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    size_t whole;
    const char *from = original(&whole);
    char *bytes = malloc(whole);
    must(bytes);
    memcpy(bytes, from, whole);
    size_t length = whole;
    for (; size >= 6; size -= 6, data += 6) {
        const size_t place = ((size_t)data[0] << 16 | (size_t)data[1] << 8 | data[2]) % (whole / WORD);
        change(bytes + WORD * place, data[3], data[4]);
    }
    if (size > 0)
        length = whole - WORD * (data[0] % (whole / WORD));
    if (length >= SIZE_AT + 2 * WORD) {
        put_word(bytes, SIZE_AT, length);
        put_word(bytes, length - WORD, hash_finish(hash_words(HASH_START, (const void *)bytes, length / WORD - 1)));
    }
    scene *s = NULL;
    diagnostic why = {.what = ""};
    const status code = scene_unpack(bytes, length, &s, &why);
    if (code == STATUS_OK) {
        void *again = NULL;
        size_t same = 0;
        diagnostic bad = {.what = ""};
        char text[DIAGNOSTIC_TEXT_MAX];
        if (scene_pack(s, &again, &same, &bad) != STATUS_OK)
            fprintf(stderr, "%s\n", diagnostic_text(&bad, text, sizeof text)), abort();
        free(again);
        scene_destroy(s);
    } else {
        must(!s);
        must_refuse(code, &why);
    }
    free(bytes);
    return 0;
}
