/* Tests of status and diagnostics, numbers, words, hashes and files. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "base/file.h"
#include "base/os_process.h"
#include "base/array.h"
#include "base/hash.h"
#include "base/number.h"
#include "base/status.h"
#include "base/text.h"
#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <float.h>
#include <locale.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
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

/* tests/faults.sh tests out of memory. */
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

/* ---- files ---- */

static char folder[4096];

static char *in_folder(const char *name)
{
    char *path = text_format("%s/%s", folder, name);
    assert_non_null(path);
    return path;
}

static void remove_tree(const char *path)
{
    DIR *entries = opendir(path);
    for (struct dirent *entry; entries && (entry = readdir(entries));) {
        if (strcmp(entry->d_name, ".") != 0 && strcmp(entry->d_name, "..") != 0) {
            char *inner = text_format("%s/%s", path, entry->d_name);
            struct stat about;
            if (lstat(inner, &about) == 0 && S_ISDIR(about.st_mode))
                remove_tree(inner);
            else
                unlink(inner);
            free(inner);
        }
    }
    if (entries)
        closedir(entries);
    rmdir(path);
}

static int make_folder(void **state)
{
    (void)state;
    const char *base = getenv("TMPDIR");
    snprintf(folder, sizeof folder, "%s/cuvette-base-XXXXXX", base && *base ? base : "/tmp");
    return mkdtemp(folder) ? 0 : -1;
}

static int remove_folder(void **state)
{
    (void)state;
    remove_tree(folder);
    return 0;
}

static int entries_in(const char *path)
{
    DIR *entries = opendir(path);
    int count = 0;
    assert_non_null(entries);
    while (readdir(entries))
        count++;
    closedir(entries);
    return count - 2; /* . and .. */
}

static void put(const char *path, const char *text)
{
    file_writer writer;
    diagnostic why = {0};
    assert_int_equal(file_writer_open(&writer, path, &why), STATUS_OK);
    assert_true(fputs(text, writer.stream) >= 0);
    assert_int_equal(file_writer_commit(&writer, &why), STATUS_OK);
}

static void check_content(const char *path, const char *expected)
{
    char *text;
    size_t size;
    assert_int_equal(file_read(path, 1 << 20, &text, &size, NULL), STATUS_OK);
    assert_int_equal(size, strlen(expected));
    assert_string_equal(text, expected);
    free(text);
}

static void written_files_read_back(void **state)
{
    (void)state;
    char *path = in_folder("a.txt"), *text;
    size_t size;
    diagnostic why = {0};
    put(path, "one\n");
    check_content(path, "one\n");
    put(path, "");
    check_content(path, "");
    put(path, "exactly16 bytes!");
    assert_int_equal(file_read(path, 16, &text, &size, &why), STATUS_OK);
    assert_int_equal(why.file[0], 0); /* a later error is not this file's */
    assert_int_equal(size, 16);
    free(text);
    assert_int_equal(file_read(path, 15, &text, &size, &why), STATUS_BAD_INPUT);
    assert_null(text);
    assert_string_equal(why.file, path);
    assert_int_equal(entries_in(folder), 1);
    free(path);
}

static void large_files_read_back(void **state)
{
    (void)state;
    char *path = in_folder("large"), *text;
    size_t size, count = 300001;
    file_writer writer;
    assert_int_equal(file_writer_open(&writer, path, NULL), STATUS_OK);
    for (size_t i = 0; i < count; i++)
        putc((int)(i * 7 % 256), writer.stream);
    assert_int_equal(file_writer_commit(&writer, NULL), STATUS_OK);
    assert_int_equal(file_read(path, SIZE_MAX, &text, &size, NULL), STATUS_OK);
    assert_int_equal(size, count);
    for (size_t i = 0; i < count; i++)
        assert_int_equal((unsigned char)text[i], i * 7 % 256);
    free(text);
    free(path);
}

static void files_of_proc_are_read_to_their_end(void **state)
{
    (void)state;
    char *text;
    size_t size;
    assert_int_equal(file_read("/proc/self/status", 1 << 20, &text, &size, NULL), STATUS_OK);
    assert_true(size > 100 && text[size] == 0);
    free(text);
}

static void unreadable_paths_are_refused(void **state)
{
    (void)state;
    char *missing = in_folder("missing"), *fifo = in_folder("fifo"), *text;
    size_t size;
    diagnostic why = {0};
    assert_int_equal(mkfifo(fifo, 0600), 0);
    assert_int_equal(file_read(missing, 100, &text, &size, &why), STATUS_BAD_INPUT);
    assert_string_equal(why.file, missing);
    assert_non_null(strstr(why.what, "No such file"));
    assert_int_equal(file_read(folder, 100, &text, &size, &why), STATUS_BAD_INPUT);
    assert_string_equal(why.what, "is a folder");
    assert_int_equal(file_read(fifo, 100, &text, &size, &why), STATUS_BAD_INPUT);
    assert_string_equal(why.what, "is not a regular file");
    assert_int_equal(file_read("/dev/null", 100, &text, &size, &why), STATUS_BAD_INPUT);
    free(missing);
    free(fifo);
}

static void the_file_is_unchanged_before_the_commit(void **state)
{
    (void)state;
    char *path = in_folder("a"), *fresh = in_folder("b");
    file_writer writer;
    put(path, "old");
    assert_int_equal(file_writer_open(&writer, path, NULL), STATUS_OK);
    fputs("new", writer.stream);
    fflush(writer.stream);
    check_content(path, "old");
    file_writer_abandon(&writer);
    check_content(path, "old");
    assert_int_equal(entries_in(folder), 1);

    assert_int_equal(file_writer_open(&writer, fresh, NULL), STATUS_OK);
    assert_int_equal(access(fresh, F_OK), -1);
    assert_int_equal(file_writer_commit(&writer, NULL), STATUS_OK);
    check_content(fresh, "");
    assert_int_equal(entries_in(folder), 2);
    free(path);
    free(fresh);
}

static void two_writers_do_not_interfere(void **state)
{
    (void)state;
    char *a = in_folder("a"), *b = in_folder("b");
    file_writer first, second;
    assert_int_equal(file_writer_open(&first, a, NULL), STATUS_OK);
    assert_int_equal(file_writer_open(&second, b, NULL), STATUS_OK);
    fputs("1", first.stream);
    fputs("2", second.stream);
    assert_int_equal(file_writer_commit(&second, NULL), STATUS_OK);
    assert_int_equal(file_writer_commit(&first, NULL), STATUS_OK);
    check_content(a, "1");
    check_content(b, "2");
    free(a);
    free(b);
}

static mode_t mode_of(const char *path)
{
    struct stat about;
    assert_int_equal(stat(path, &about), 0);
    return about.st_mode & 07777;
}

static void permissions_follow_umask_or_the_old_file(void **state)
{
    (void)state;
    char *a = in_folder("a"), *b = in_folder("b");
    mode_t before = umask(027);
    put(a, "x");
    umask(before);
    assert_int_equal(mode_of(a), 0640);
    put(b, "x");
    assert_int_equal(chmod(b, 0604), 0);
    put(b, "y");
    assert_int_equal(mode_of(b), 0604);
    free(a);
    free(b);
}

static void writing_through_a_link_keeps_the_link(void **state)
{
    (void)state;
    char *target = in_folder("target"), *absolute = in_folder("absolute"), *relative = in_folder("relative");
    char *dangling = in_folder("dangling"), *later = in_folder("later"), *loop = in_folder("loop");
    struct stat about;
    put(target, "old");
    assert_int_equal(symlink(target, absolute), 0);
    assert_int_equal(symlink("absolute", relative), 0);
    assert_int_equal(symlink("later", dangling), 0);
    assert_int_equal(symlink("loop", loop), 0);
    put(relative, "new");
    check_content(target, "new");
    assert_true(lstat(relative, &about) == 0 && S_ISLNK(about.st_mode));
    assert_true(lstat(absolute, &about) == 0 && S_ISLNK(about.st_mode));
    put(dangling, "made");
    check_content(later, "made");
    assert_true(lstat(dangling, &about) == 0 && S_ISLNK(about.st_mode));
    file_writer writer;
    assert_int_equal(file_writer_open(&writer, loop, NULL), STATUS_FAILURE);
    free(target);
    free(absolute);
    free(relative);
    free(dangling);
    free(later);
    free(loop);
}

static void devices_are_written_directly(void **state)
{
    (void)state;
    diagnostic why = {0};
    file_writer writer;
    struct stat about;
    put("/dev/null", "gone");
    assert_true(stat("/dev/null", &about) == 0 && S_ISCHR(about.st_mode));
    assert_int_equal(file_writer_open(&writer, "/dev/full", &why), STATUS_OK);
    fputs("x", writer.stream);
    assert_int_equal(file_writer_commit(&writer, &why), STATUS_FAILURE);
    assert_string_equal(why.file, "/dev/full");
    assert_non_null(strstr(why.what, "No space left"));
    assert_int_equal(file_writer_open(&writer, "/dev/full", NULL), STATUS_OK);
    for (int i = 0; i < 100000; i++) /* the error comes early and must still be reported at the end */
        putc('x', writer.stream);
    assert_int_equal(file_writer_commit(&writer, NULL), STATUS_FAILURE);
}

static void a_full_disk_keeps_the_old_file(void **state)
{
    (void)state;
    char *path = in_folder("a");
    put(path, "old");
    struct rlimit before, small;
    assert_int_equal(getrlimit(RLIMIT_FSIZE, &before), 0);
    small = before;
    small.rlim_cur = 5000;
    os_signals_as_errors();
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &small), 0);
    file_writer writer;
    diagnostic why = {0};
    status opened = file_writer_open(&writer, path, NULL), committed = STATUS_OK;
    if (opened == STATUS_OK) {
        for (int i = 0; i < 20000; i++)
            putc('x', writer.stream);
        committed = file_writer_commit(&writer, &why);
    }
    setrlimit(RLIMIT_FSIZE, &before);
    assert_int_equal(opened, STATUS_OK);
    assert_int_equal(committed, STATUS_FAILURE);
    assert_string_equal(why.file, path);
    assert_true(strstr(why.what, "cannot write") == why.what);
    check_content(path, "old");
    assert_int_equal(entries_in(folder), 1);
    free(path);
}

/* Space that becomes free before the commit does not restore what was lost. */
static void an_early_write_error_is_reported_at_the_commit(void **state)
{
    (void)state;
    char *path = in_folder("a");
    struct rlimit before, small;
    assert_int_equal(getrlimit(RLIMIT_FSIZE, &before), 0);
    small = before;
    small.rlim_cur = 100;
    os_signals_as_errors();
    file_writer writer;
    diagnostic why = {0};
    assert_int_equal(file_writer_open(&writer, path, NULL), STATUS_OK);
    setvbuf(writer.stream, NULL, _IONBF, 0);
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &small), 0);
    char block[300] = {0};
    size_t written = fwrite(block, 1, sizeof block, writer.stream);
    setrlimit(RLIMIT_FSIZE, &before);
    assert_true(written < sizeof block);
    assert_int_equal(file_writer_commit(&writer, &why), STATUS_FAILURE);
    assert_string_equal(why.file, path);
    assert_int_equal(entries_in(folder), 0);
    free(path);
}

/* The name that a temporary file has for an instant when it replaces another: a folder cannot be replaced. */
static char *named_temporary(int *fd)
{
    char *full = in_folder("full"), *inside = in_folder("full/x"), *name = NULL;
    assert_int_equal(mkdir(full, 0777), 0);
    put(inside, "");
    *fd = temporary_open(full, &name);
    assert_true(*fd >= 0);
    assert_int_equal(temporary_move(*fd, &name, full), -1);
    assert_non_null(name);
    assert_int_equal(access(name, F_OK), 0);
    free(inside);
    free(full);
    return name;
}

static void the_file_of_a_killed_writer_is_removed_by_the_next(void **state)
{
    (void)state;
    int fd;
    char *a = in_folder("a"), *b = in_folder("b"), *left = named_temporary(&fd);
    put(a, "1");
    put(a, "2"); /* needs a name, and leaves that of the living writer alone */
    assert_int_equal(access(left, F_OK), 0);
    close(fd);   /* as the kernel does for a killed process */
    put(b, "1"); /* a new file needs no other name */
    assert_int_equal(access(left, F_OK), 0);
    put(a, "3");
    assert_int_equal(access(left, F_OK), -1);
    check_content(a, "3");
    assert_int_equal(entries_in(folder), 3); /* a, b and the folder */
    free(left);
    free(b);
    free(a);
}

static void a_file_for_another_program_has_a_name_and_ends_with_its_writer(void **state)
{
    (void)state;
    char *path = in_folder("figure.png"), *left = NULL, *other = NULL, *again = NULL;
    const int first = temporary_open_named(path, ".png", &left);
    const int second = temporary_open_named(path, ".png", &other);
    assert_true(first >= 0 && second >= 0);
    assert_string_equal(left + strlen(left) - 9, ".part.png");
    assert_string_not_equal(left, other);
    assert_int_equal(entries_in(folder), 2);
    close(first); /* killed */
    const int third = temporary_open_named(path, ".png", &again);
    assert_string_equal(again, left);
    assert_int_equal(access(other, F_OK), 0); /* its writer lives */
    assert_int_equal(temporary_move(third, &again, path), 0);
    assert_int_equal(temporary_move(second, &other, path), 0);
    assert_int_equal(entries_in(folder), 1);
    close(third);
    close(second);
    free(left);
    free(other);
    free(again);
    free(path);
}

static void an_unfinished_file_has_no_name(void **state)
{
    (void)state;
    char *path = in_folder("a");
    file_writer writer;
    assert_int_equal(file_writer_open(&writer, path, NULL), STATUS_OK);
    assert_int_equal(entries_in(folder), writer.temporary ? 1 : 0); /* named on old file systems */
    file_writer_abandon(&writer);
    assert_int_equal(entries_in(folder), 0);
    free(path);
}

static void the_remedy_fits_the_error(void **state)
{
    (void)state;
    assert_non_null(strstr(system_remedy(EACCES), "permissions"));
    assert_non_null(strstr(system_remedy(EIO), "check the disk"));
    assert_null(system_remedy(EINVAL));
}

static void unwritable_paths_are_refused(void **state)
{
    (void)state;
    char *closed = in_folder("closed"), *inside = in_folder("closed/a"), *no_folder = in_folder("none/a");
    char *read_only = in_folder("read_only");
    file_writer writer;
    diagnostic why = {0};
    assert_int_equal(file_writer_open(&writer, "", &why), STATUS_BAD_INPUT);
    assert_int_equal(file_writer_open(&writer, no_folder, &why), STATUS_FAILURE);
    assert_string_equal(why.file, no_folder);
    assert_int_equal(file_writer_open(&writer, folder, &why), STATUS_FAILURE);

    assert_int_equal(mkdir(closed, 0555), 0);
    put(read_only, "keep");
    assert_int_equal(chmod(read_only, 0444), 0);
    uid_t user = geteuid();
    assert_int_equal(chmod(folder, 0777), 0);
    if (user == 0)
        assert_int_equal(seteuid(65534), 0); /* root may write everywhere */
    status code = file_writer_open(&writer, inside, &why), kept = file_writer_open(&writer, read_only, NULL);
    status made = file_make_directory(inside, NULL);
    if (user == 0)
        assert_int_equal(seteuid(0), 0);
    assert_int_equal(code, STATUS_FAILURE);
    assert_non_null(strstr(why.what, "Permission denied"));
    assert_int_equal(kept, STATUS_FAILURE);
    assert_int_equal(made, STATUS_FAILURE);
    free(closed);
    free(inside);
    free(no_folder);
    free(read_only);
}

static void a_path_of_minus_is_standard_output(void **state)
{
    (void)state;
    char *path = in_folder("out");
    fflush(NULL);
    pid_t child = fork();
    assert_true(child >= 0);
    if (child == 0) {
        int fd = open(path, O_WRONLY | O_CREAT, 0600);
        dup2(fd, STDOUT_FILENO);
        free(path);
        file_writer writer;
        printf("before ");
        bool good = file_writer_open(&writer, "-", NULL) == STATUS_OK && fputs("picture", writer.stream) >= 0 &&
                    file_writer_commit(&writer, NULL) == STATUS_OK;
        printf(" after");
        fflush(stdout);
        _exit(good ? 0 : 1);
    }
    int result;
    assert_int_equal(waitpid(child, &result, 0), child);
    assert_int_equal(result, 0);
    check_content(path, "before picture after");
    free(path);
}

static void folders_are_created_with_their_parents(void **state)
{
    (void)state;
    char *deep = in_folder("a//b/c/"), *c = in_folder("a/b/c"), *file = in_folder("file"), *under = in_folder("file/x");
    struct stat about;
    diagnostic why = {0};
    assert_int_equal(file_make_directory(deep, &why), STATUS_OK);
    assert_true(stat(c, &about) == 0 && S_ISDIR(about.st_mode));
    assert_int_equal(file_make_directory(c, &why), STATUS_OK);
    put(file, "x");
    assert_int_equal(file_make_directory(file, &why), STATUS_FAILURE);
    assert_int_equal(file_make_directory(under, &why), STATUS_FAILURE);
    assert_string_equal(why.file, under);
    assert_int_equal(file_make_directory("", &why), STATUS_FAILURE);
    assert_int_equal(file_make_directory("/", &why), STATUS_OK);
    free(deep);
    free(c);
    free(file);
    free(under);
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

/* qemu-user, through which tests/arch.sh runs this program, drops the advice. */
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

#define file_test(f) cmocka_unit_test_setup_teardown(f, make_folder, remove_folder)

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(diagnose_fills_and_returns),
        cmocka_unit_test(diagnostic_text_omits_missing_parts),
        cmocka_unit_test(diagnostics_are_one_line_of_valid_utf8),
        cmocka_unit_test(diagnose_accepts_its_own_texts_as_arguments),
        cmocka_unit_test(reals_are_parsed),
        cmocka_unit_test(invalid_reals_are_refused),
        cmocka_unit_test(integers_are_parsed),
        cmocka_unit_test(reals_are_formatted_shortest),
        cmocka_unit_test(formatted_reals_read_back),
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
        file_test(written_files_read_back),
        file_test(large_files_read_back),
        file_test(files_of_proc_are_read_to_their_end),
        file_test(unreadable_paths_are_refused),
        file_test(the_file_is_unchanged_before_the_commit),
        file_test(two_writers_do_not_interfere),
        file_test(permissions_follow_umask_or_the_old_file),
        file_test(writing_through_a_link_keeps_the_link),
        file_test(devices_are_written_directly),
        file_test(a_full_disk_keeps_the_old_file),
        file_test(an_early_write_error_is_reported_at_the_commit),
        file_test(the_file_of_a_killed_writer_is_removed_by_the_next),
        file_test(a_file_for_another_program_has_a_name_and_ends_with_its_writer),
        file_test(an_unfinished_file_has_no_name),
        cmocka_unit_test(the_remedy_fits_the_error),
        file_test(unwritable_paths_are_refused),
        file_test(a_path_of_minus_is_standard_output),
        file_test(folders_are_created_with_their_parents),
    };
    return cmocka_run_group_tests_name("base", tests, NULL, NULL);
}
