/* Tests of status and diagnostics, numbers, words, hashes and large pages. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "base/array.h"
#include "base/hash.h"
#include "base/number.h"
#include "base/random.h"
#include "base/status.h"
#include "base/text.h"
#include <errno.h>
#include <float.h>
#include <locale.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* ---- status ---- */

static void diagnose_fills_and_returns(void **state)
{
    (void)state;
    diagnostic why = {.file = "scene.yaml", .line = 3, .column = 7};
    assert_int_equal(diagnose(&why, STATUS_BAD_INPUT, "1 to 9", "depth %d is out of range", 77), STATUS_BAD_INPUT);
    char text[DIAGNOSTIC_TEXT_MAX];
    assert_string_equal(diagnostic_text(&why, text, sizeof text), "scene.yaml:3:7: depth 77 is out of range; 1 to 9");
    assert_ptr_equal(diagnostic_text(&why, text, sizeof text), text);
    assert_int_equal(diagnose(NULL, STATUS_FAILURE, NULL, "nobody cares"), STATUS_FAILURE);
    diagnostic_locate(NULL, "x", 1, 1);
}

static void diagnostic_text_omits_missing_parts(void **state)
{
    (void)state;
    static const struct {
        const char *file;
        long line, column;
        const char *remedy, *expected;
    } cases[] = {
        {"a", 1, 2, "r", "a:1:2: w; r"}, {"a", 1, 0, NULL, "a:1: w"},  {"a", 0, 5, "", "a: w"},
        {NULL, 0, 0, NULL, "w"},         {"", 4, 2, "r", "4:2: w; r"}, {"a", -1, -1, "r", "a: w; r"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        diagnostic why = {0};
        char text[DIAGNOSTIC_TEXT_MAX];
        diagnostic_locate(&why, cases[i].file, cases[i].line, cases[i].column);
        diagnose(&why, STATUS_FAILURE, cases[i].remedy, "w");
        assert_string_equal(diagnostic_text(&why, text, sizeof text), cases[i].expected);
    }
}

static void diagnostics_are_one_line_of_valid_utf8(void **state)
{
    (void)state;
    diagnostic why = {0};
    diagnostic_locate(&why, "evil\n\x1b[2Jname", 1, 1);
    diagnose(&why, STATUS_BAD_INPUT, "a\tb\x7f",
             "x\r\n\xc2\x9b"
             "31m \xc3\xa9");
    assert_string_equal(why.file, "evil??[2Jname");
    assert_string_equal(why.what, "x????31m \xc3\xa9");
    assert_string_equal(why.remedy, "a?b?");

    char many[600]; /* two-byte letters at odd positions: the cut falls into one */
    memset(many, 'a', sizeof many);
    for (size_t i = 1; i + 2 < sizeof many; i += 2)
        memcpy(many + i, "\xc3\xa9", 2);
    many[sizeof many - 1] = 0;
    diagnose(&why, STATUS_BAD_INPUT, many + 1, "%s", many);
    assert_int_equal(strlen(why.what), sizeof why.what - 1);
    assert_int_equal((unsigned char)why.what[510], 0xa9);
    assert_int_equal(strlen(why.remedy), sizeof why.remedy - 2);
    assert_int_equal((unsigned char)why.remedy[509], 0xa9);
}

static void diagnose_accepts_its_own_texts_as_arguments(void **state)
{
    (void)state;
    diagnostic why = {0};
    diagnose(&why, STATUS_BAD_INPUT, "first remedy", "first");
    diagnose(&why, STATUS_BAD_INPUT, why.what, "second after %s", why.what);
    assert_string_equal(why.what, "second after first");
    assert_string_equal(why.remedy, "first");
}

/* ---- numbers ---- */

static void check_real(const char *text, double expected)
{
    double value = -77;
    assert_true(number_parse_real(text, &value));
    assert_memory_equal(&value, &expected, sizeof value);
}

static void reals_are_parsed(void **state)
{
    (void)state;
    check_real("0", 0.0);
    check_real("-0", -0.0);
    check_real("+1.5", 1.5);
    check_real(".25", 0.25);
    check_real("5.", 5.0);
    check_real("1e3", 1000.0);
    check_real("1E-3", 0.001);
    check_real("0.1", 0.1);
    check_real("4.9e-324", 4.9e-324);
    check_real("1e-400", 0.0);
    check_real("1.7976931348623157e308", DBL_MAX);
}

static void invalid_reals_are_refused(void **state)
{
    (void)state;
    static const char *const bad[] = {"",          " 1",     "1 ",    "1,5", "0x10", "nan", "NaN",   "inf",
                                      "-infinity", "1e",     "1e+",   ".",   "-",    "+",   "1.2.3", "--1",
                                      "1e400",     "-1e400", "1_000", "1f",  "e5",   ".e5", "1e5.0", "\xd9\xa1"};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        double value = 42;
        assert_false(number_parse_real(bad[i], &value));
        assert_true(value == 42.0);
    }
    assert_false(number_parse_real(NULL, &(double){0}));
}

static void integers_are_parsed(void **state)
{
    (void)state;
    int64_t value = 0;
    assert_true(number_parse_int("-9223372036854775808", &value) && value == INT64_MIN);
    assert_true(number_parse_int("9223372036854775807", &value) && value == INT64_MAX);
    assert_true(number_parse_int("+007", &value) && value == 7);
    errno = 5;
    static const char *const bad[] = {"",
                                      "4.0",
                                      "1e3",
                                      " 1",
                                      "1 ",
                                      "-",
                                      "0x1f",
                                      "9223372036854775808",
                                      "-9223372036854775809",
                                      "99999999999999999999999",
                                      "1a",
                                      "++1"};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        value = 42;
        assert_false(number_parse_int(bad[i], &value));
        assert_int_equal(value, 42);
    }
    assert_int_equal(errno, 5);
}

static void reals_are_formatted_shortest(void **state)
{
    (void)state;
    static const struct {
        double value;
        const char *text;
    } cases[] = {
        {0.1, "0.1"},
        {1e-9, "1e-09"},
        {100, "100"},
        {1e15, "1e+15"},
        {123456, "123456"},
        {-3, "-3"},
        {999999999999999.0, "999999999999999"},
        {-1e15, "-1e+15"},
        {-2.5, "-2.5"},
        {1.0 / 3, "0.3333333333333333"},
        {0.1 + 0.2, "0.30000000000000004"},
        {5e-324, "5e-324"},
        {DBL_MAX, "1.7976931348623157e+308"},
        {0, "0"},
        {-0.0, "-0"},
        {INFINITY, "inf"},
        {-INFINITY, "-inf"},
        {NAN, "nan"},
        {-NAN, "nan"},
        {9007199254740993.0, "9007199254740992"},
        {1e-4, "0.0001"},
        {0.00012345, "0.00012345"},
        {9.9999999999999e-5, "9.9999999999999e-05"},
        {0.1, "0.1"},
        {-0.000123456789012345, "-0.000123456789012345"},
        {1200, "1200"},
        {1200.5, "1200.5"},
        {99999999999999.9, "99999999999999.9"},
        {999999999999999, "999999999999999"},
        {999999999999999.9, "999999999999999.9"},
        {100000000000000.5, "100000000000000.5"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char text[NUMBER_TEXT_MAX];
        assert_string_equal(number_format(cases[i].value, text), cases[i].text);
    }
}

static void formatted_reals_read_back(void **state)
{
    (void)state;
    uint64_t bits = 88172645463325252; /* xorshift64, Marsaglia 2003 */
    for (int i = 0; i < 20000; i++) {
        bits ^= bits << 13;
        bits ^= bits >> 7;
        bits ^= bits << 17;
        double value, back;
        char text[NUMBER_TEXT_MAX];
        memcpy(&value, &bits, sizeof value);
        if (isfinite(value)) {
            assert_true(number_parse_real(number_format(value, text), &back));
            assert_memory_equal(&value, &back, sizeof value);
        }
    }
}

/* Decimals with up to 15 digits have a path of their own: the text is that of %.15g. */
static void short_decimals_are_formatted_as_by_printf(void **state)
{
    (void)state;
    uint64_t bits = 88172645463325252;
    for (int i = 0; i < 20000; i++) {
        bits ^= bits << 13;
        bits ^= bits >> 7;
        bits ^= bits << 17;
        static const double powers[] = {1, 10, 100, 1e3, 1e4, 1e6, 1e9, 1e12, 1e15, 1e18};
        const double value =
            ((double)(bits >> (14 + i % 50)) - 1000.0) / powers[bits % (sizeof powers / sizeof *powers)];
        char text[NUMBER_TEXT_MAX], expected[NUMBER_TEXT_MAX];
        snprintf(expected, sizeof expected, "%.15g", value);
        double back;
        if (number_parse_real(expected, &back) && memcmp(&back, &value, sizeof back) == 0)
            assert_string_equal(number_format(value, text), expected);
    }
}

static void digits_are_cut_by_the_uncertainty(void **state)
{
    (void)state;
    static const struct {
        double value, half;
        const char *text;
    } cases[] = {{0.6402, 0.013, "0.640"}, {0.6402, 0.04, "0.64"},       {0.6402, 0.0962, "0.64"},
                 {123456, 3000, "123000"}, {123456, 2400, "123500"},     {1.04567, 1e-4, "1.04567"},
                 {12.34567, NAN, "12.35"}, {12.34567, 0, "12.35"},       {-2.5551, 0.29, "-2.56"},
                 {NAN, 1, "nan"},          {3e-7, 1.1e-8, "0.000000300"}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char text[NUMBER_TEXT_MAX];
        assert_string_equal(number_format_within(cases[i].value, cases[i].half, text), cases[i].text);
    }
}

static void numbers_ignore_the_locale(void **state)
{
    (void)state;
    static const char *const with_comma[] = {"de_DE.UTF-8", "de_DE.utf8", "fr_FR.UTF-8", "fr_FR.utf8",
                                             "de_DE",       "fr_FR",      "it_IT.UTF-8"};
    const char *found = NULL;
    for (size_t i = 0; i < sizeof with_comma / sizeof *with_comma && !found; i++)
        found = setlocale(LC_NUMERIC, with_comma[i]);
    if (!found)
        skip(); /* no locale with a decimal comma is installed */
    char text[NUMBER_TEXT_MAX];
    double value = 0;
    bool parsed = number_parse_real("1.5", &value), comma = number_parse_real("1,5", &(double){0});
    number_format(0.1, text);
    setlocale(LC_NUMERIC, "C");
    assert_true(parsed && value == 1.5 && !comma);
    assert_string_equal(text, "0.1");
}

/* ---- words ---- */

static void distances_are_optimal_string_alignments(void **state)
{
    (void)state;
    assert_int_equal(text_distance("", ""), 0);
    assert_int_equal(text_distance("", "abc"), 3);
    assert_int_equal(text_distance("kitten", "sitting"), 3);
    assert_int_equal(text_distance("depth", "dpeth"), 1);
    assert_int_equal(text_distance("ca", "abc"), 3); /* 2 for unrestricted Damerau-Levenshtein */
    assert_int_equal(text_distance("Height", "hEIGHT"), 0);
    assert_int_equal(text_distance("height", "width"), 4);
    char long_a[100], long_b[100];
    memset(long_a, 'x', 99);
    memset(long_b, 'x', 99);
    long_a[99] = long_b[99] = 0;
    long_b[80] = 'y';
    assert_int_equal(text_distance(long_a, long_b), 0);
    long_b[62] = 'y';
    assert_int_equal(text_distance(long_a, long_b), 1);
}

static void nearest_word_is_near(void **state)
{
    (void)state;
    static const char *const words[] = {"width", "height", "depth", "ior", "rotation", "x"};
    assert_string_equal(text_nearest("hieght", words, 6), "height");
    assert_string_equal(text_nearest("dept", words, 6), "depth");
    assert_string_equal(text_nearest("iro", words, 6), "ior");
    assert_string_equal(text_nearest("y", words, 6), "x");
    assert_string_equal(text_nearest("ROTATOIN", words, 6), "rotation");
    assert_null(text_nearest("colour", words, 6));
    assert_null(text_nearest("wxyzh", words, 5));
    assert_null(text_nearest("width", words, 0));
    static const char *const close[] = {"abcdxx", "abcdex"};
    assert_string_equal(text_nearest("abcdef", close, 2), "abcdex");
}

static void text_is_formatted(void **state)
{
    (void)state;
    char *text = text_format("%s-%03d", "cell", 7);
    assert_string_equal(text, "cell-007");
    free(text);
}

/* tests/faults/faults.sh tests out of memory. */
static void a_text_writer_returns_the_whole_text(void **state)
{
    (void)state;
    enum { LINES = 20000 };
    text_writer w;
    char *text = NULL;
    size_t size = 0;
    assert_int_equal(text_writer_open(&w, NULL), STATUS_OK);
    assert_int_equal(text_writer_close(&w, &text, &size, NULL), STATUS_OK);
    assert_true(size == 0 && strcmp(text, "") == 0);
    free(text);
    assert_int_equal(text_writer_open(&w, NULL), STATUS_OK);
    for (int i = 0; i < LINES; i++)
        fprintf(w.stream, "%05d%c", i, i % 2 ? '\0' : '\n');
    assert_int_equal(text_writer_close(&w, &text, &size, NULL), STATUS_OK);
    assert_true(size == 6 * LINES && text[size] == 0);
    for (int i = 0; i < LINES; i++)
        assert_true(atoi(text + 6 * i) == i && text[6 * i + 5] == (i % 2 ? '\0' : '\n'));
    free(text);
    assert_int_equal(text_writer_open(&w, NULL), STATUS_OK);
    fputs("given up", w.stream);
    text_writer_abandon(&w);
    assert_null(w.stream);
}

/* ---- hashes: expected values from an independent computation with integers of any size ---- */

static void hashes_equal_independent_values(void **state)
{
    (void)state;
    const int64_t words[] = {1, -2, INT64_C(1) << 40};
    assert_true(hash_finish(hash_words(HASH_START, words, 3)) == UINT64_C(0xe418e579883267ec));
    assert_true(hash_finish(hash_bytes(HASH_START, "cuvette", 7)) == UINT64_C(0xe058321b646ab2fc));
    const uint32_t numbers[] = {0x76767563, 0x00657474}; /* "cuvv" and "tte", lowest byte first */
    assert_true(hash_numbers(HASH_START, numbers, 2, sizeof *numbers) == hash_bytes(HASH_START, "cuvvtte", 8));
    assert_true(hash_finish(HASH_START) == UINT64_C(0xefd01f60ba992926));
    uint64_t parts = hash_words(hash_words(HASH_START, words, 1), words + 1, 2);
    assert_true(parts == hash_words(HASH_START, words, 3));
}

static void hashes_depend_on_order_and_top_bits(void **state)
{
    (void)state;
    const int64_t a[] = {1, 2}, b[] = {2, 1}, c[] = {1 ^ INT64_MIN, 2 ^ INT64_MIN}, zero[] = {0, 0};
    assert_true(hash_words(HASH_START, a, 2) != hash_words(HASH_START, b, 2));
    assert_true(hash_words(HASH_START, a, 2) != hash_words(HASH_START, c, 2));
    assert_true(hash_words(HASH_START, zero, 1) != hash_words(HASH_START, zero, 2));
}

/* ---- large pages ---- */

/* Whether one mapping, advised to use large pages ("hg" of proc(5), smaps), holds the whole block. */
static bool is_advised(const void *memory, size_t bytes)
{
    FILE *maps = fopen("/proc/self/smaps", "r");
    const uintptr_t first = (uintptr_t)memory, end = first + bytes;
    bool holds = false, advised = false;
    char line[512];
    assert_non_null(maps);
    while (fgets(line, sizeof line, maps)) {
        unsigned long from, to;
        if (sscanf(line, "%lx-%lx ", &from, &to) == 2)
            holds = from <= first && end <= to;
        else if (holds && strncmp(line, "VmFlags:", 8) == 0)
            advised = strstr(line, " hg");
    }
    fclose(maps);
    return advised;
}

/* qemu-user, through which tests/check/arch.sh runs this program, drops the advice. */
static bool is_emulated(void)
{
    const char *runner = getenv("RUNNER");
    return runner && strncmp(runner, "qemu", 4) == 0;
}

static void large_blocks_are_advised_and_can_still_grow(void **state)
{
    (void)state;
    enum { WORDS = 1 << 22 };
    uint32_t *words = NULL;
    size_t room = 0;
    assert_null(large_pages(NULL, WORDS));
    for (size_t i = 0; i < WORDS; i++) {
        assert_true(GROW(words, room, i + 1));
        words[i] = (uint32_t)i;
    }
    if (access("/sys/kernel/mm/transparent_hugepage", F_OK) == 0 && !is_emulated())
        assert_true(is_advised(words, room * sizeof *words));
    for (size_t i = 0; i < WORDS; i++)
        assert_int_equal(words[i], i);
    free(words);
}

static void small_blocks_are_not_advised(void **state)
{
    (void)state;
    const size_t bytes = 1 << 20;
    void *memory = malloc(bytes);
    assert_ptr_equal(large_pages(memory, bytes), memory);
    assert_false(is_advised(memory, bytes));
    free(memory);
}

/* The text goes on with `rest`; the number is the one that strtod reads, bit for bit. */
static void scan_as_strtod(const char *number, const char *rest)
{
    char text[128];
    double got = 7.0;
    snprintf(text, sizeof text, "%s%s", number, rest);
    const char *at = text;
    const double expected = strtod(number, NULL);
    if (!number_scan(&at, &got) || memcmp(&got, &expected, sizeof got) != 0 || strcmp(at, rest) != 0)
        fail_msg("'%s' is scanned as %.17g, and '%s' is left", text, got, at);
}

/* Few and many digits, on both sides of each limit of the fast paths; halves between two doubles. */
static void numbers_are_scanned_as_the_nearest_double(void **state)
{
    (void)state;
    static const char *const fixed[] = {"0",
                                        "-0",
                                        "+1.5",
                                        ".5",
                                        "5.",
                                        "-.25e1",
                                        "1e0",
                                        "1E+3",
                                        "0e999",
                                        "1e22",
                                        "1e23",
                                        "1e-22",
                                        "1e-23",
                                        "9007199254740993",
                                        "9007199254740993e22",
                                        "9007199254740992.5",
                                        "9007199254740993.0000000000001",
                                        "18014398509481985e-5",
                                        "5e-324",
                                        "2.4703282292062327e-324",
                                        "1.7976931348623157e308",
                                        "00000000000000000000000001.5",
                                        "0.000000000000000000000000000000000000000000000000000000012345",
                                        "99999999999999999999999999999999999999999e-30"};
    for (size_t i = 0; i < sizeof fixed / sizeof *fixed; i++)
        scan_as_strtod(fixed[i], i % 2 ? "\n" : "/2");
    for (uint32_t i = 0; i < 300000; i++) {
        const random_words drawn = random_at(3, i, 0, 0, 0);
        const uint32_t *r = drawn.word;
        const uint64_t digits = ((uint64_t)r[0] << 32 | r[1]) >> (r[2] % 64);
        char text[64];
        const int after = (int)(r[3] % 24);
        double real;
        const uint64_t bits = (uint64_t)(1023 - 70 + r[3] % 140) << 52 | digits >> 12;
        memcpy(&real, &bits, sizeof real);
        if (i % 3 == 0)
            snprintf(text, sizeof text, "%s%llue%d", i % 2 ? "-" : "", (unsigned long long)digits, after - 12);
        else if (i % 3 == 1)
            snprintf(text, sizeof text, "%.*e", after, real);
        else
            snprintf(text, sizeof text, "%.*f", after, real);
        scan_as_strtod(text, " ");
    }
    static const char *const none[] = {"",    ".",     "-",      "e5", "1e",  "1e+", "nan",
                                       "inf", "1e999", "-1e999", " 1", "--1", "+-1"};
    for (size_t i = 0; i < sizeof none / sizeof *none; i++) {
        const char *at = none[i];
        double got;
        assert_false(number_scan(&at, &got));
        assert_ptr_equal(at, none[i]);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(numbers_are_scanned_as_the_nearest_double),
        cmocka_unit_test(diagnose_fills_and_returns),
        cmocka_unit_test(diagnostic_text_omits_missing_parts),
        cmocka_unit_test(diagnostics_are_one_line_of_valid_utf8),
        cmocka_unit_test(diagnose_accepts_its_own_texts_as_arguments),
        cmocka_unit_test(reals_are_parsed),
        cmocka_unit_test(invalid_reals_are_refused),
        cmocka_unit_test(integers_are_parsed),
        cmocka_unit_test(reals_are_formatted_shortest),
        cmocka_unit_test(formatted_reals_read_back),
        cmocka_unit_test(short_decimals_are_formatted_as_by_printf),
        cmocka_unit_test(digits_are_cut_by_the_uncertainty),
        cmocka_unit_test(numbers_ignore_the_locale),
        cmocka_unit_test(distances_are_optimal_string_alignments),
        cmocka_unit_test(nearest_word_is_near),
        cmocka_unit_test(text_is_formatted),
        cmocka_unit_test(a_text_writer_returns_the_whole_text),
        cmocka_unit_test(hashes_equal_independent_values),
        cmocka_unit_test(hashes_depend_on_order_and_top_bits),
        cmocka_unit_test(small_blocks_are_not_advised),
        cmocka_unit_test(large_blocks_are_advised_and_can_still_grow),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
