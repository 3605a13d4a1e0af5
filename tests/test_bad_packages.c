/* Tests of packages that are damaged, cut short, forged, or another build's. Run from the repository root. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "base/hash.h"
#include "package_fixture.h"
#include "random_stream.h"

static void assert_refused(const package *p, const char *reason)
{
    scene *s = NULL;
    diagnostic why = {.what = ""};
    assert_int_equal(scene_unpack(p->at, p->size, &s, &why), STATUS_BAD_INPUT);
    assert_null(s);
    assert_non_null(strstr(why.what, reason));
}

static void other_builds_and_machines_are_refused(void **state)
{
    (void)state;
    scene *s = rod_scene("");
    package p = packed(s);
    assert_refused(&(package){p.at, 0}, "ends early");
    assert_refused(&(package){p.at, 40}, "ends early");
    const struct {
        size_t at;
        const char *reason;
    } places[] = {{0, "does not begin as one"},    {8, "another kind of machine"}, {12, "another kind of machine"},
                  {16, "another kind of machine"}, {24, "from another build"},     {40, "from another build"},
                  {48, "it has another size"}};
    for (size_t i = 0; i < sizeof places / sizeof *places; i++) {
        p.at[places[i].at] ^= 8;
        assert_refused(&p, places[i].reason);
        p.at[places[i].at] ^= 8;
    }
    scene *again = unpacked(&p);
    scene_destroy(again);
    scene_destroy(s);
    free(p.at);
}

enum { SIZE_AT = 48 };

static void put_word(const package *p, size_t at, uint64_t value)
{
    memcpy(p->at + at, &value, sizeof value);
}

/* The hash that fits the bytes. */
static void seal(const package *p)
{
    int64_t *words = malloc(p->size);
    memcpy(words, p->at, p->size);
    put_word(p, p->size - 8, hash_finish(hash_words(HASH_START, words, p->size / 8 - 1)));
    free(words);
}

/* Each prefix says that it is whole, in a block of its own size, so that a read beyond it is found. */
static void a_truncated_package_is_refused(void **state)
{
    (void)state;
    scene *s = whole_scene();
    const package p = packed(s);
    scene_destroy(s);
    const size_t step = p.size / 8 / 1500 * 8 + 8;
    for (size_t size = 64; size < p.size; size += size < 2048 ? 8 : step) {
        package part = {malloc(size), size};
        assert_non_null(part.at);
        memcpy(part.at, p.at, size);
        put_word(&part, SIZE_AT, size);
        seal(&part);
        assert_refused(&part, "");
        free(part.at);
    }
    free(p.at);
}

static void a_changed_byte_is_refused(void **state)
{
    (void)state;
    scene *s = whole_scene();
    const package p = packed(s);
    scene_destroy(s);
    const size_t step = p.size / 3000 + 1;
    for (size_t at = 0; at < p.size; at += at < 2048 ? 1 : step) {
        p.at[at] ^= (char)(1 << at % 8);
        assert_refused(&p, "");
        p.at[at] ^= (char)(1 << at % 8);
    }
    scene *again = unpacked(&p);
    scene_destroy(again);
    free(p.at);
}

static void render_with_every_hierarchy(scene *s)
{
    static const char *const kinds[] = {"none", "sphere", "octant", "bvh"};
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++) {
        char text[64];
        snprintf(text, sizeof text, "render.accel=%s", kinds[i]);
        set(s, text);
        render_result_destroy(render(s));
    }
}

/* Changes that the hash does not show, behind the scene's text: what is accepted can be rendered. */
static void a_forged_package_is_refused_or_harmless(void **state)
{
    (void)state;
    scene *s = whole_scene();
    set_all(s, "render.threads=1 render.depth=3");
    package p = packed(s);
    scene_destroy(s);
    const char *end = memmem(p.at, p.size, "visible: off", 12);
    assert_non_null(end);
    const size_t first = ((size_t)(end - p.at) + 12) / 8 * 8 + 8, words = (p.size - 8 - first) / 8;
    static const uint64_t values[] = {0,
                                      1,
                                      2,
                                      0xffffffff,
                                      UINT64_MAX,
                                      UINT64_C(0x7ff8000000000000),
                                      UINT64_C(0x7ff0000000000000),
                                      UINT64_C(0x7f800000ff800000)};
    uint64_t seed = 1;
    size_t refused = 0, accepted = 0;
    for (size_t i = 0; i < 6000; i++) {
        /* all words of the first part, which is full of heads, then any */
        const size_t at = first + 8 * (i < 1500 && i < words ? i : random_bits(&seed) % words);
        uint64_t old, changed;
        memcpy(&old, p.at + at, sizeof old);
        changed = i % 2 ? values[random_bits(&seed) % 8] : old ^ UINT64_C(1) << random_bits(&seed) % 64;
        put_word(&p, at, changed);
        seal(&p);
        scene *again = NULL;
        diagnostic why = {.what = ""};
        const status code = scene_unpack(p.at, p.size, &again, &why);
        assert_true(code == STATUS_OK ? again != NULL : code == STATUS_BAD_INPUT && !again && why.what[0]);
        if (again)
            render_with_every_hierarchy(again);
        scene_destroy(again);
        *(code == STATUS_OK ? &accepted : &refused) += 1;
        put_word(&p, at, old);
    }
    assert_true(refused > 500 && accepted > 500);
    free(p.at);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(other_builds_and_machines_are_refused),
        cmocka_unit_test(a_truncated_package_is_refused),
        cmocka_unit_test(a_changed_byte_is_refused),
        cmocka_unit_test(a_forged_package_is_refused_or_harmless),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
