/* Tests of shared scenes: the metadata of a PNG image and a link give the same scene again, and so the same film; what
 * strangers may not share is refused with its reason; damaged and oversized data are refused. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "base/text.h"
#include "image/image.h"
#include "scene/file/shared.h"
#include "scene/model/edit/edit.h"
#include "scene/model/params.h"
#include "scene/model/scene.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <zlib.h>

#define ROD "experiments/scenes/rod.yaml"

static scene *read_file(const char *path)
{
    scene *s = NULL;
    assert_int_equal(scene_read(path, &s, NULL), STATUS_OK);
    return s;
}

static char *text_of(const scene *s)
{
    char *text = NULL;
    assert_int_equal(shared_scene_text(s, &text, NULL), STATUS_OK);
    return text;
}

static char *link_of(const char *text)
{
    char *code = NULL;
    assert_int_equal(shared_scene_code(text, &code, NULL), STATUS_OK);
    char *link = text_format("http://127.0.0.1:8000/" SHARED_FRAGMENT "%s", code);
    free(code);
    return link;
}

static void png_of(const scene *s, unsigned char **bytes, size_t *size)
{
    image *img = NULL;
    shared_texts texts;
    assert_int_equal(image_create(5, 4, &img, NULL), STATUS_OK);
    assert_int_equal(shared_texts_make(s, &texts, NULL), STATUS_OK);
    image_rows rows = image_rows_of(img);
    rows.texts = texts.item;
    rows.text_count = texts.count;
    assert_int_equal(image_encode_rows(&rows, IMAGE_PNG, 8, false, bytes, size, NULL), STATUS_OK);
    free(texts.scene);
    image_destroy(img);
}

/* The same text is the same scene, whose film is the same: tests/scene/test_scene_write.c. */
static void all_forms_give_the_same_scene(void **state)
{
    (void)state;
    scene *s = read_file(ROD), *again = NULL;
    char *text = text_of(s), *link = link_of(text);
    unsigned char *bytes;
    size_t size;
    png_of(s, &bytes, &size);
    assert_int_equal(shared_read_file("rod.png", (const char *)bytes, size, &again, NULL), STATUS_OK);
    char *from_png = text_of(again);
    assert_string_equal(from_png, text);
    scene_destroy(again);
    assert_int_equal(scene_read(link, &again, NULL), STATUS_OK);
    char *from_link = text_of(again);
    assert_string_equal(from_link, text);
    assert_string_equal(again->path, "");
    scene_destroy(again);
    scene_destroy(s);
    free(from_png);
    free(from_link);
    free(bytes);
    free(link);
    free(text);
}

/* A file of the same image must not depend on the machine's threads. */
static void settings_of_the_machine_stay_at_home(void **state)
{
    (void)state;
    scene *s = read_file(ROD);
    char *plain = text_of(s);
    assert_int_equal(scene_set(s, "render.threads", "7", NULL), STATUS_OK);
    assert_int_equal(scene_set(s, "render.schedule", "rows", NULL), STATUS_OK);
    char *same = text_of(s);
    assert_string_equal(same, plain);
    assert_int_equal(scene_set(s, "render.accel", "none", NULL), STATUS_OK);
    char *other = text_of(s);
    assert_string_not_equal(other, plain);
    free(plain);
    free(same);
    free(other);
    scene_destroy(s);
}

static void refused(const char *assignment, const char *expected)
{
    scene *s = read_file(ROD);
    char *text = NULL;
    diagnostic why = {.line = 0};
    assert_int_equal(scene_set_assignment(s, assignment, &why), STATUS_OK);
    assert_int_equal(shared_scene_text(s, &text, &why), STATUS_BAD_INPUT);
    assert_null(text);
    assert_non_null(strstr(why.what, expected));
    shared_texts texts;
    assert_int_equal(shared_texts_make(s, &texts, NULL), STATUS_OK);
    assert_int_equal(texts.count, 1); /* the program alone */
    scene_destroy(s);
}

static void strangers_name_no_files_and_are_bounded(void **state)
{
    (void)state;
    refused("background.image=sky.png", "the background reads sky.png");
    refused("render.width=65536", "pixels");
    refused("render.depth=64", "rays");
    scene *s = NULL;
    diagnostic why = {.line = 0};
    static const char secret[] = "textures:\n  wood: {file: /etc/passwd}\n";
    assert_int_equal(shared_read_text("stranger", secret, sizeof secret - 1, &s, &why), STATUS_BAD_INPUT);
    assert_null(s);
    assert_string_equal(why.file, "stranger");
    assert_non_null(strstr(why.what, "wood reads /etc/passwd"));
    static const char slime[] = "meshes:\n  m: {generate: slime, level: 7, time_s: 1000}\n";
    assert_int_equal(shared_read_text("stranger", slime, sizeof slime - 1, &s, &why), STATUS_BAD_INPUT);
    assert_null(s);
}

/* A file of such a mesh or texture does not exist. */
static void arrays_of_a_program_are_refused(void **state)
{
    (void)state;
    static const char *const texts[] = {"meshes: {m: {generate: sparse, count: 5}}\n",
                                        "textures: {t: {file: a.png}}\n"};
    for (int k = 0; k < 2; k++) {
        scene *s = NULL;
        char *text = NULL;
        diagnostic why = {.line = 0};
        assert_int_equal(scene_read_text("own", texts[k], strlen(texts[k]), &s, &why), STATUS_OK);
        if (k == 0)
            s->meshes[0].source = MESH_ARRAYS;
        else
            s->textures[0].path[0] = 0;
        assert_int_equal(shared_scene_text(s, &text, &why), STATUS_BAD_INPUT);
        assert_null(text);
        assert_string_equal(why.what + 1, " was given as arrays, which a shared scene cannot contain");
        assert_non_null(strstr(why.remedy, "write it to a file"));
        scene_destroy(s);
    }
}

static void read_bad(const char *link)
{
    scene *s = NULL;
    diagnostic why = {.line = 0};
    assert_int_equal(scene_read(link, &s, &why), STATUS_BAD_INPUT);
    assert_null(s);
    assert_string_equal(why.file, "link");
    assert_string_not_equal(why.what, "");
}

/* The limits count triangles before they are made: as many as each generator then makes, or at most more. */
static void triangles_are_planned_for_each_generator(void **state)
{
    (void)state;
    static const char *const meshes[] = {
        "generate: box",
        "generate: icosphere, level: 3",
        "generate: torus, around: 24, tube: 9",
        "generate: terrain, around: 12, tube: 10",
        "generate: terrain, around: 12, tube: 10, depth: 0.5",
        "generate: lathe, around: 16, profile: [0.5, 0, 0.6, 1, 0.4, 2]",
        "generate: slime, level: 2, time_s: 0",
        "generate: slime, level: 4, time_s: 0",
    };
    for (size_t i = 0; i < sizeof meshes / sizeof *meshes; i++) {
        char text[200];
        scene *s;
        diagnostic why = {.what = ""};
        snprintf(text, sizeof text, "meshes: {m: {%s}}\nsolids: {a: {shape: mesh, mesh: m}}\n", meshes[i]);
        if (scene_read_text("s.yaml", text, strlen(text), &s, &why) != STATUS_OK || scene_load(s, &why) != STATUS_OK)
            fail_msg("%s: %s", meshes[i], why.what);
        const double planned = scene_planned_triangles(s), made = (double)s->meshes[0].data->triangle_count;
        if (!(planned >= made && planned <= 1.25 * made))
            fail_msg("%s: %g triangles planned, %g made", meshes[i], planned, made);
        scene_destroy(s);
    }
}

static void damaged_links_are_refused(void **state)
{
    (void)state;
    scene *s = read_file(ROD);
    char *text = text_of(s), *link = link_of(text);
    read_bad(SHARED_FRAGMENT);
    read_bad(SHARED_FRAGMENT "A");
    read_bad(SHARED_FRAGMENT "AAAA");
    read_bad(SHARED_FRAGMENT "a b!");
    for (size_t cut = 1; cut < 40; cut++) {
        link[strlen(link) - 1] = 0;
        read_bad(link);
    }
    free(link);
    free(text);
    scene_destroy(s);
}

/* A text of many solids is not written to its end if it is too long. */
static void the_text_is_bounded(void **state)
{
    (void)state;
    static const size_t counts[] = {30000, 40000, 60000}; /* a solid has at least 26 bytes */
    scene *s = read_file(ROD);
    for (size_t i = 0, n = 0; n < sizeof counts / sizeof *counts; n++) {
        for (; i < counts[n]; i++) {
            char name[16];
            snprintf(name, sizeof name, "s%zu", i);
            assert_int_equal(scene_add_solid(s, name, SHAPE_SPHERE, NULL, NULL), STATUS_OK);
        }
        char *text;
        diagnostic why = {.what = ""};
        const status code = shared_scene_text(s, &text, &why);
        assert_int_equal(code, n == 0 ? STATUS_OK : STATUS_BAD_INPUT);
        if (n == 0)
            assert_non_null(strstr(text, "  s29999:\n    shape: sphere\n"));
        else
            assert_string_equal(why.what, "a shared scene can have at most 1048576 bytes of text");
        assert_true(n == 0 || !text);
        free(text);
    }
    scene_destroy(s);
}

/* 64 MiB of spaces compress to 65 kB; no more than a MiB of them is ever expanded. */
static void a_bomb_is_refused(void **state)
{
    (void)state;
    const size_t size = 64u << 20;
    char *spaces = malloc(size);
    uLongf room = compressBound(size);
    unsigned char *packed = malloc(room);
    assert_true(spaces && packed);
    memset(spaces, ' ', size);
    assert_int_equal(compress2(packed, &room, (Bytef *)spaces, size, 9), Z_OK);
    char *code = base64_encode(packed, room, true), *link = text_format(SHARED_FRAGMENT "%s", code);
    read_bad(link);
    free(link);
    free(code);
    free(packed);
    free(spaces);
}

static void a_png_without_a_scene_says_so(void **state)
{
    (void)state;
    scene *s = read_file("experiments/scenes/models.yaml"), *again = NULL;
    diagnostic why = {.line = 0};
    unsigned char *bytes;
    size_t size;
    png_of(s, &bytes, &size);
    assert_int_equal(shared_read_file("m.png", (const char *)bytes, size, &again, &why), STATUS_BAD_INPUT);
    assert_string_equal(why.what, "this image holds no scene");
    for (size_t length = 8; length < size && length < 100; length++)
        assert_int_equal(shared_read_file("m.png", (const char *)bytes, length, &again, &why), STATUS_BAD_INPUT);
    assert_null(again);
    free(bytes);
    scene_destroy(s);
}

/* Found by fuzz_shared: 170 bytes made libpng take and clear 535 MB. */
static void a_chunk_longer_than_the_file_takes_no_memory(void **state)
{
    (void)state;
    scene *s = read_file(ROD), *again = NULL;
    diagnostic why = {.line = 0};
    unsigned char *bytes;
    size_t size;
    struct rusage before, after;
    png_of(s, &bytes, &size);
    unsigned char *text = memmem(bytes, size, "iTXt", 4);
    assert_non_null(text);
    text[-4] = 0x1f; /* the length */
    assert_int_equal(getrusage(RUSAGE_SELF, &before), 0);
    assert_int_equal(shared_read_file("s.png", (const char *)bytes, size, &again, &why), STATUS_BAD_INPUT);
    assert_int_equal(getrusage(RUSAGE_SELF, &after), 0);
    assert_null(again);
    assert_string_equal(why.what, "the PNG file is damaged: the file is truncated");
    assert_true(after.ru_maxrss - before.ru_maxrss < 100 * 1024); /* KiB */
    free(bytes);
    scene_destroy(s);
}

static void base64url_is_that_of_the_standard(void **state)
{
    (void)state;
    static const char *const expected[] = {"", "Zg", "Zm8", "Zm9v", "Zm9vYg", "Zm9vYmE", "Zm9vYmFy"}; /* RFC 4648, 10 */
    for (size_t i = 0; i < 7; i++) {
        size_t size;
        char *text = base64_encode("foobar", i, true);
        assert_string_equal(text, expected[i]);
        unsigned char *back = base64_decode(text, strlen(text), true, &size);
        assert_int_equal(size, i);
        assert_memory_equal(back, "foobar", i);
        free(back);
        free(text);
    }
    char *padded = base64_encode("f\xff\xfe", 2, false), *address = base64_encode("\xfb\xff", 2, true);
    assert_string_equal(padded, "Zv8=");
    assert_string_equal(address, "-_8");
    free(padded);
    free(address);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(all_forms_give_the_same_scene),
        cmocka_unit_test(settings_of_the_machine_stay_at_home),
        cmocka_unit_test(strangers_name_no_files_and_are_bounded),
        cmocka_unit_test(arrays_of_a_program_are_refused),
        cmocka_unit_test(triangles_are_planned_for_each_generator),
        cmocka_unit_test(damaged_links_are_refused),
        cmocka_unit_test(the_text_is_bounded),
        cmocka_unit_test(a_bomb_is_refused),
        cmocka_unit_test(a_png_without_a_scene_says_so),
        cmocka_unit_test(a_chunk_longer_than_the_file_takes_no_memory),
        cmocka_unit_test(base64url_is_that_of_the_standard),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
