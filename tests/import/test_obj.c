/* Tests of the fast reader of plain OBJ files: its output equals that of assimp bit for bit, and what is not plain is
 * left to assimp. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "base/random.h"
#include "mesh_files.h"
#include <sched.h>
#include <stdbool.h>
#include <sys/wait.h>

/* The output of the import program with these options; *code: its exit status. */
static bytes import(const char *options, const char *name, int *code)
{
    char *path = in_folder(name);
    char *line = text_format("\"$CUVETTE_IMPORT\" %s '%s' 2>/dev/null", options, path);
    bytes got = {NULL, 0, 0};
    char buffer[65536];
    FILE *from = popen(line, "r");
    assert_non_null(from);
    for (size_t count; (count = fread(buffer, 1, sizeof buffer, from)) > 0;)
        add(&got, buffer, count);
    const int state = pclose(from);
    *code = WIFEXITED(state) ? WEXITSTATUS(state) : -1;
    free(line);
    free(path);
    return got;
}

static bool same(bytes a, bytes b)
{
    return a.size == b.size && (a.size == 0 || memcmp(a.at, b.at, a.size) == 0);
}

/* Both readers must read the file in the same way. */
static void check_plain(const char *name, const char *what)
{
    int plain_code, assimp_code;
    bytes plain = import("--obj=plain", name, &plain_code), assimp = import("--obj=assimp", name, &assimp_code);
    if (plain_code != 0 || assimp_code != 0 || !same(plain, assimp))
        fail_msg("exit codes %d (plain) and %d (assimp), %zu and %zu bytes: %s", plain_code, assimp_code, plain.size,
                 assimp.size, what);
    free(plain.at);
    free(assimp.at);
}

#define SQUARE "v 0 0 0\nv 1 0 0\nv 1 1 0.5\nv 0 1 0\n"
#define UVS "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
#define NORMALS "vn 0 0 1\nvn 0 0 -1\nvn 0.6 0 0.8\n"

static void statements_are_read_as_by_assimp(void **state)
{
    (void)state;
    put_text("two.mtl", "newmtl red\nKd 1 0 0\nNs 10\nd 0.5\nnewmtl glass\nKd 0 1 0\nKs 1 1 1\nNi 1.5\nmap_Kd a.png\n");
    static const char *const texts[] = {
        SQUARE "f 1 2 3\nf 1 3 4\n",
        SQUARE "f 1 2 3\nf 1 3 4", /* no end of the last line */
        "v 0 0 0\r\nv 1 0 0\r\nv 1 1 0\r\nf 1 2 3\r\n",
        "v  0\t0  0 \nv 1 0 0\t\nv 1 1 0\nf  1\t2 3 \n",
        "# comment\n\n\n" SQUARE "\n# f 1 2 3\nf 2 3 4\n\n",
        "f 1 2 3\n" SQUARE "f 2 3 4\n", /* vertices after their use */
        SQUARE UVS "f 1/1 2/2 3/3\nf 1/1 3/3 4/4\n",
        SQUARE NORMALS "f 1//1 2//1 3//1\nf 1//2 3//3 4//2\n",
        SQUARE UVS NORMALS "f 1/1/1 2/2/1 3/3/3\nf 1/4/1 3/3/1 4/4/2\n",
        SQUARE UVS NORMALS "f 1 2 3\nf 1/1 3/3 4/4\nf 2/1/1 3/2/2 4/3/3\nf 2//1 3//2 1//3\n",
        SQUARE UVS "f 1/1 2/2 3/3\nf 1/2 2/3 3/4\nf 1/1 2/2 3/3\n",
        SQUARE "v 0 0 0\nv -0 -0.0 0\nv 1 0 0\nf 1 2 3\nf 5 7 4\nf 6 7 3\n", /* equal vertices, -0 */
        SQUARE "f 1 1 1\nf 1 2 2\nf 4 3 2\n",
        SQUARE "o a\nf 1 2 3\no b\nf 1 3 4\no a\nf 2 3 4\n",
        SQUARE "g a\nf 1 2 3\ng b c\nf 1 3 4\ng a\nf 2 3 4\ng\nf 1 2 4\n",
        SQUARE "o a\ng b\ns 1\nf 1 2 3\ns off\nf 1 3 4\ng c\nf 2 3 4\n",
        "o empty\n" SQUARE "o full\nf 1 2 3\no empty\n",
        "mtllib two.mtl\n" SQUARE "usemtl red\nf 1 2 3\nusemtl glass\nf 1 3 4\nusemtl red\nf 2 3 4\n",
        "mtllib two.mtl\n" SQUARE "f 1 2 3\nusemtl glass\nf 1 3 4\ng x\nf 2 3 4\nusemtl red\no y\nf 4 3 2\n",
        "mtllib two.mtl\n" SQUARE "usemtl red\nusemtl glass\nf 1 3 4\nusemtl unknown\nf 2 3 4\n",
        SQUARE "usemtl nowhere\nf 1 3 4\n",
        "mtllib two.mtl\no a\n" SQUARE "usemtl red\nf 1 2 3\no b\nv 5 5 5\nv 6 6 5\nf 1 5 6\nusemtl glass\nf 4 5 6\n",
    };
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        put_text("plain.obj", texts[i]);
        check_plain("plain.obj", texts[i]);
    }
}

static void numbers_are_read_as_by_assimp(void **state)
{
    (void)state;
    static const char *const numbers[] = {"0",
                                          "-0",
                                          "+1.5",
                                          "5.",
                                          "-.25",
                                          "007.50",
                                          "1e3",
                                          "1E-3",
                                          "1.5e+2",
                                          "2.e2",
                                          "-.5e1",
                                          "0.1",
                                          "16777217",
                                          "0.3333333333333333333333",
                                          "123456.789012345678",
                                          "1e-30",
                                          "3.4e38",
                                          "999999999999",
                                          "1.0000001",
                                          "1.9999999",
                                          "4.35e0",
                                          "7e00",
                                          "1e-45",
                                          "0.000000000000001",
                                          "-1.0e-5",
                                          "1e38",
                                          "33554433.5",
                                          "8388608.5",
                                          "0.99999997",
                                          "2.1",
                                          "1048576.0625"};
    const size_t count = sizeof numbers / sizeof *numbers;
    for (size_t i = 0; i < count; i++) {
        char *text = text_format("v %s 1 2\nv 1 %s 2\nv 0 1 %s\nvt %s 1\nvn %s 0 1\nf 1/1/1 2/1/1 3/1/1\n", numbers[i],
                                 numbers[i], numbers[i], numbers[i], numbers[i]);
        put_text("number.obj", text);
        check_plain("number.obj", numbers[i]);
        free(text);
    }
}

/* What is not plain: the fast reader declines, and the program answers as with assimp alone. */
static void what_is_not_plain_is_left_to_assimp(void **state)
{
    (void)state;
    static const char *const texts[] = {
        SQUARE "f 1 2 3 4\n",
        SQUARE "f -4 -3 -2\n",
        SQUARE "f 1 2 5\n",
        SQUARE "f 1 2 0\n",
        SQUARE "f 1 2\n",
        SQUARE "f 1 2 3\nl 1 2\n",
        SQUARE "f 1 2 3\np 1\n",
        SQUARE "f 1/1 2/1 3/1\n",
        SQUARE "f 1//1 2//1 3//1\n",
        SQUARE UVS "f 1/1 2/2 3\n",
        SQUARE UVS "f 1/1/ 2/2/ 3/3/\n",
        SQUARE UVS "f 1/1 2/2 3/5\n",
        SQUARE "f 1 2 3 # last\n",
        SQUARE "f 1 2 3x\n",
        SQUARE "f 1 2 \\\n3\n",
        SQUARE "# \\\nf 1 2 3\nf 2 3 4\n",
        SQUARE " f 1 2 3\nf 2 3 4\n",
        SQUARE "F 1 2 3\nf 2 3 4\n",
        SQUARE "vp 1 2\nf 2 3 4\n",
        SQUARE,
        "v 0 0 0 1\nv 1 0 0 1\nv 1 1 0 2\nf 1 2 3\n",
        "v 0 0 0 1 1 1\nv 1 0 0 1 1 1\nv 1 1 0 1 1 1\nf 1 2 3\n",
        "v 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n",
        "v 0 0 nan\nv 1 0 0\nv 1 1 0\nf 1 2 3\n",
        "v 0 0 inf\nv 1 0 0\nv 1 1 0\nf 1 2 3\n",
        "v 0 0 0,5\nv 1 0 0\nv 1 1 0\nf 1 2 3\n",
        "v 0 0 1e\nv 1 0 0\nv 1 1 0\nf 1 2 3\n",
        "v 0 0 .5\nv 1 0 0\nv 1 1 0\nf 1 2 3\n",
        "v 0 0 .\nv 1 0 0\nv 1 1 0\nf 1 2 3\n",
        "v 0 0 --1\nv 1 0 0\nv 1 1 0\nf 1 2 3\n",
        "v 0 0 12345678901234567890\nv 1 0 0\nv 1 1 0\nf 1 2 3\n",
        SQUARE "vt 1\nf 1/1 2/1 3/1\n",
        SQUARE "vt 1 0 0\nf 1/1 2/1 3/1\n",
        "mtllib missing.mtl\n" SQUARE "f 1 2 3\n",
        "hello, this is no mesh\n",
    };
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        int plain_code, any_code, assimp_code;
        put_text("other.obj", texts[i]);
        bytes plain = import("--obj=plain", "other.obj", &plain_code), any = import("", "other.obj", &any_code),
              assimp = import("--obj=assimp", "other.obj", &assimp_code);
        if (plain_code != 2 || plain.size > 0 || any_code != assimp_code || !same(any, assimp))
            fail_msg("exit codes %d (plain), %d and %d (assimp): %s", plain_code, any_code, assimp_code, texts[i]);
        free(plain.at);
        free(any.at);
        free(assimp.at);
    }
}

static uint32_t draw(uint32_t *counter, uint32_t below)
{
    return random_at(1, (*counter)++, 0, 0, 0).word[0] % below;
}

static void add_line(bytes *b, const char *format, ...)
{
    char line[200];
    va_list list;
    va_start(list, format);
    add(b, line, (size_t)vsnprintf(line, sizeof line, format, list));
    va_end(list);
}

/* A number with 1 to 17 digits, sometimes with an exponent. */
static void random_number(uint32_t *at, char text[64])
{
    const double value = ((double)draw(at, 2000001) - 1000000) / 3000 * (draw(at, 2) ? 1 : 1e-3);
    const int digits = (int)draw(at, 16) + 1;
    snprintf(text, 64, draw(at, 4) ? "%.*g" : draw(at, 2) ? "%.*f" : "%.*e", digits, value);
}

/* A random plain file. Few of the positions are new, so that vertices are joined across groups. */
static bytes random_file(uint32_t seed, size_t size)
{
    bytes b = {NULL, 0, 0};
    uint32_t at = seed * 100000000, places = 0, uvs = 0, normals = 0;
    char x[64], y[64], z[64];
    add_text(&b, "mtllib two.mtl\n");
    while (b.size < size || places < 3) {
        const uint32_t kind = draw(&at, 40);
        if (kind < 14 || places < 3) {
            random_number(&at, x), random_number(&at, y), random_number(&at, z);
            draw(&at, 4) ? add_line(&b, "v %u %u 0.5\n", draw(&at, 20), draw(&at, 20))
                         : add_line(&b, "v %s %s %s\n", x, y, z);
            places++;
        } else if (kind < 17 || uvs == 0) {
            random_number(&at, x);
            add_line(&b, "vt %s %u\n", x, draw(&at, 3)), uvs++;
        } else if (kind < 20 || normals == 0) {
            random_number(&at, x);
            add_line(&b, "vn %s %u 1\n", x, draw(&at, 3)), normals++;
        } else if (kind < 39) {
            const uint32_t form = draw(&at, 4);
            add_text(&b, "f");
            for (int k = 0; k < 3; k++) {
                const uint32_t p = places - draw(&at, places < 50 ? places : 50), t = draw(&at, uvs) + 1,
                               n = draw(&at, normals) + 1;
                form == 0   ? add_line(&b, " %u", p)
                : form == 1 ? add_line(&b, " %u/%u", p, t)
                : form == 2 ? add_line(&b, " %u//%u", p, n)
                            : add_line(&b, " %u/%u/%u", p, t, n);
            }
            add_text(&b, "\n");
        } else if (draw(&at, 20) == 0) {
            static const char *const words[] = {"o a",        "o b",          "g a", "g b c", "g",
                                                "usemtl red", "usemtl glass", "s 1", "# -"};
            add_line(&b, "%s\n", words[draw(&at, sizeof words / sizeof *words)]);
        }
    }
    add_text(&b, "f 1 2 3\n");
    return b;
}

static void random_files_are_read_as_by_assimp(void **state)
{
    (void)state;
    put_text("two.mtl", "newmtl red\nKd 1 0 0\nnewmtl glass\nKd 0 1 0\n");
    for (uint32_t seed = 0; seed < 24; seed++) {
        bytes b = random_file(seed, seed < 20 ? 3000 : 2500000);
        char *what = text_format("seed %u", seed);
        put("random.obj", b.at, b.size);
        check_plain("random.obj", what);
        free(what);
        free(b.at);
    }
}

/* A part of the file for each processor: the same result with one. */
static void processors_do_not_matter(void **state)
{
    (void)state;
    cpu_set_t before, one;
    int code_many, code_one;
    bytes b = random_file(30, 4000000);
    put("parts.obj", b.at, b.size);
    bytes many = import("--obj=plain", "parts.obj", &code_many);
    assert_int_equal(sched_getaffinity(0, sizeof before, &before), 0);
    CPU_ZERO(&one);
    for (size_t cpu = 0; cpu < CPU_SETSIZE && CPU_COUNT(&one) == 0; cpu++)
        if (CPU_ISSET(cpu, &before))
            CPU_SET(cpu, &one);
    assert_int_equal(sched_setaffinity(0, sizeof one, &one), 0);
    bytes alone = import("--obj=plain", "parts.obj", &code_one);
    assert_int_equal(sched_setaffinity(0, sizeof before, &before), 0);
    assert_int_equal(code_many, 0);
    assert_int_equal(code_one, 0);
    assert_true(same(many, alone));
    free(b.at);
    free(many.at);
    free(alone.at);
}

/* Limits are explained as with assimp. */
static void limits_hold(void **state)
{
    (void)state;
    put_text("limit.obj", SQUARE "f 1 2 3\nf 1 3 4\n");
    static const char *const options[] = {"--triangles=1", "--vertices=3", "--triangles=2 --vertices=4"};
    for (int i = 0; i < 3; i++) {
        int code;
        bytes got = import(options[i], "limit.obj", &code);
        assert_int_equal(code, i < 2 ? 2 : 0);
        assert_int_equal(got.size > 0, i == 2);
        free(got.at);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(statements_are_read_as_by_assimp),
        cmocka_unit_test(numbers_are_read_as_by_assimp),
        cmocka_unit_test(random_files_are_read_as_by_assimp),
        cmocka_unit_test(processors_do_not_matter),
        cmocka_unit_test(limits_hold),
        cmocka_unit_test(what_is_not_plain_is_left_to_assimp),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
