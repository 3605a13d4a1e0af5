/* Replays the inputs that the fuzzers kept (tests/fuzz/corpus/NAME): each reaches code that no other does, or was once
 * a failure. No libFuzzer is needed. Run from the repository root. CUVETTE_FUZZ=NAME: that fuzzer alone. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <dirent.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* clang-format off */
#define FUZZERS(X) \
    X(animation) X(arguments) X(bmp) X(exr) X(films) X(gltf) X(hdr) X(http) X(jpeg) X(lens) X(lesson) X(mesh_stream) \
    X(mtl) X(obj) X(optical) X(package) X(pfm) X(ply) X(png) X(points) X(published) X(rows) X(runs) X(scene) \
    X(script) X(shared) X(stl) X(study)
/* clang-format on */

typedef int fuzzer(const uint8_t *data, size_t size);
#define DECLARE(name) fuzzer fuzz_##name;
FUZZERS(DECLARE)

#define ENTRY(name) {#name, fuzz_##name},
static const struct {
    const char *name;
    fuzzer *run;
} fuzzers[] = {FUZZERS(ENTRY)};
enum { COUNT = sizeof fuzzers / sizeof *fuzzers };

/* The input that is replayed, for the report of a crash. */
static char current[640];

static void tell(int number)
{
    static const char text[] = "\nthe input was ";
    if (write(STDERR_FILENO, text, sizeof text - 1) < 0 || write(STDERR_FILENO, current, strlen(current)) < 0)
        _exit(1);
    signal(number, SIG_DFL);
    raise(number);
}

/* Bytes in a block of their own size, so that instruments see a read beyond them. */
static void replay(fuzzer *run, const char *path)
{
    struct stat about;
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    assert_int_equal(fstat(fileno(file), &about), 0);
    const size_t size = (size_t)about.st_size;
    uint8_t *bytes = malloc(size ? size : 1);
    assert_non_null(bytes);
    assert_int_equal(fread(bytes, 1, size, file), size);
    fclose(file);
    snprintf(current, sizeof current, "%s\n", path);
    run(bytes, size);
    free(bytes);
}

static size_t replay_folder(fuzzer *run, const char *folder)
{
    size_t count = 0;
    DIR *entries = opendir(folder);
    assert_non_null(entries);
    for (const struct dirent *e; (e = readdir(entries));) {
        char path[600];
        if (e->d_name[0] == '.')
            continue;
        snprintf(path, sizeof path, "%s/%s", folder, e->d_name);
        replay(run, path);
        count++;
    }
    closedir(entries);
    return count;
}

static void inputs_of_a_fuzzer_are_read_or_refused(void **state)
{
    const size_t i = *(const size_t *)*state;
    const char *only = getenv("CUVETTE_FUZZ");
    char folder[300];
    if (only && *only && strcmp(only, fuzzers[i].name) != 0)
        skip();
    snprintf(folder, sizeof folder, "tests/fuzz/corpus/%s", fuzzers[i].name);
    fuzzers[i].run((const uint8_t *)"", 0);
    const size_t count = replay_folder(fuzzers[i].run, folder);
    print_message("%s: %zu inputs\n", fuzzers[i].name, count);
    assert_true(count >= 3);
}

static void every_fuzzer_is_replayed(void **state)
{
    (void)state;
    size_t count = 0;
    DIR *entries = opendir("tests/fuzz");
    assert_non_null(entries);
    for (const struct dirent *e; (e = readdir(entries));) {
        const char *ending = strrchr(e->d_name, '.');
        count += ending && strcmp(ending, ".c") == 0;
    }
    closedir(entries);
    assert_int_equal(count, COUNT);
}

int main(void)
{
    struct CMUnitTest tests[COUNT + 1] = {cmocka_unit_test(every_fuzzer_is_replayed)};
    static size_t numbers[COUNT];
    for (size_t i = 0; i < COUNT; i++) {
        numbers[i] = i;
        tests[i + 1] = (struct CMUnitTest){
            .name = fuzzers[i].name, .test_func = inputs_of_a_fuzzer_are_read_or_refused, .initial_state = &numbers[i]};
    }
    signal(SIGABRT, tell);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
