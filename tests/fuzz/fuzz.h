/* What the fuzzers share. A fuzzer is a file tests/fuzz/NAME.c with one function for one reader: any bytes are read or
 * refused, and what is accepted is checked. `make fuzz` runs them with libFuzzer; test_fuzz_corpus.c replays
 * tests/fuzz/corpus/NAME in every build (FUZZ_REPLAY is then defined, and the function has the name fuzz_NAME). A wrong
 * result aborts. Ownership: values; the folder of a process is removed when it ends. */
#pragma once

#include "base/status.h"
#include "base/text.h"

#include <ftw.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static inline void must(bool sound)
{
    if (!sound)
        abort();
}

/* Input is at fault, and the message says how. */
__attribute__((unused)) static void must_refuse(status code, const diagnostic *why)
{
    must(code == STATUS_BAD_INPUT && why->what[0]);
}

__attribute__((unused)) static int fuzz_unlink(const char *path, const struct stat *what, int kind, struct FTW *place)
{
    (void)what, (void)kind, (void)place;
    return remove(path);
}

static char fuzz_place[64];

__attribute__((unused)) static void fuzz_remove(void)
{
    nftw(fuzz_place, fuzz_unlink, 16, FTW_DEPTH | FTW_PHYS);
}

/* A folder of this process for readers that take paths; in memory where the system has such a place. */
__attribute__((unused)) static const char *fuzz_folder(void)
{
    if (!fuzz_place[0]) {
        snprintf(fuzz_place, sizeof fuzz_place, "%s/cuvette-fuzz-XXXXXX",
                 access("/dev/shm", W_OK) == 0 ? "/dev/shm" : "/tmp");
        must(mkdtemp(fuzz_place) && atexit(fuzz_remove) == 0);
    }
    return fuzz_place;
}

/* The path of a name in that folder; free it. */
__attribute__((unused)) static char *fuzz_path(const char *name)
{
    char *path = text_format("%s/%s", fuzz_folder(), name);
    must(path);
    return path;
}

__attribute__((unused)) static void fuzz_write(const char *name, const void *bytes, size_t size)
{
    char *path = fuzz_path(name);
    FILE *file = fopen(path, "wb");
    must(file && fwrite(bytes, 1, size, file) == size && fclose(file) == 0);
    free(path);
}

/* Inputs of several files: the parts between lines "%%". */
typedef struct fuzz_part {
    const char *at;
    size_t size;
} fuzz_part;
#define FUZZ_CUT "\n%%\n"

/* Splits off the first part. Returns false, and an empty part, where nothing is left. */
__attribute__((unused)) static bool fuzz_next(fuzz_part *rest, fuzz_part *part)
{
    *part = (fuzz_part){"", 0};
    if (!rest->at)
        return false;
    const char *cut = memmem(rest->at, rest->size, FUZZ_CUT, strlen(FUZZ_CUT));
    *part = (fuzz_part){rest->at, cut ? (size_t)(cut - rest->at) + 1 : rest->size};
    const size_t used = cut ? part->size + strlen(FUZZ_CUT) - 1 : rest->size;
    *rest = cut ? (fuzz_part){rest->at + used, rest->size - used} : (fuzz_part){NULL, 0};
    return true;
}
