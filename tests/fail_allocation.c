/* A library for LD_PRELOAD: one allocation of a program fails, as if memory were exhausted. FAIL_AT=N makes the Nth
 * fail, counted from 1 (0: none), among the kinds whose letters are in FAIL_KINDS: m malloc and aligned_alloc, c
 * calloc, g a growing realloc, s a shrinking one, p a realpath. FAIL_COUNT names a file to which their number is
 * written when the program ends. */
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <malloc.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static void *(*next_malloc)(size_t), *(*next_calloc)(size_t, size_t), *(*next_realloc)(void *, size_t),
    *(*next_aligned)(size_t, size_t);
static char *(*next_realpath)(const char *, char *);
static const char *kinds, *count_path;
static long fail_at;
static atomic_long seen;

/* Memory that dlsym itself allocates; never released. */
static char early[16384];
static size_t early_used;
static bool is_resolving;

static void *early_bytes(size_t size)
{
    const size_t at = early_used;
    early_used += (size + 15) / 16 * 16;
    if (early_used > sizeof early)
        _exit(99);
    return early + at;
}

static void *next(const char *name)
{
    return dlsym(RTLD_NEXT, name);
}

static void resolve(void)
{
    is_resolving = true;
    *(void **)&next_calloc = next("calloc");
    *(void **)&next_malloc = next("malloc");
    *(void **)&next_realloc = next("realloc");
    *(void **)&next_aligned = next("aligned_alloc");
    *(void **)&next_realpath = next("realpath");
    is_resolving = false;
}

static bool fails(char kind)
{
    if (!kinds || !strchr(kinds, kind) || atomic_fetch_add(&seen, 1) + 1 != fail_at)
        return false;
    errno = ENOMEM;
    return true;
}

void *malloc(size_t size)
{
    if (is_resolving)
        return early_bytes(size);
    if (!next_malloc)
        resolve();
    return fails('m') ? NULL : next_malloc(size);
}

void *aligned_alloc(size_t alignment, size_t size)
{
    if (!next_aligned)
        resolve();
    return fails('m') ? NULL : next_aligned(alignment, size);
}

void *calloc(size_t count, size_t size)
{
    if (is_resolving)
        return early_bytes(count * size);
    if (!next_calloc)
        resolve();
    return fails('c') ? NULL : next_calloc(count, size);
}

void *realloc(void *memory, size_t size)
{
    if (!next_realloc)
        resolve();
    return fails(memory && malloc_usable_size(memory) >= size ? 's' : 'g') ? NULL : next_realloc(memory, size);
}

char *realpath(const char *path, char *resolved)
{
    if (!next_realpath)
        resolve();
    return fails('p') ? NULL : next_realpath(path, resolved);
}

__attribute__((constructor)) static void begin(void)
{
    const char *at = getenv("FAIL_AT");
    if (!next_malloc)
        resolve();
    fail_at = at ? atol(at) : 0;
    count_path = getenv("FAIL_COUNT");
    kinds = getenv("FAIL_KINDS");
}

__attribute__((destructor)) static void end(void)
{
    const int file = count_path ? open(count_path, O_WRONLY | O_CREAT | O_TRUNC, 0666) : -1;
    kinds = NULL;
    if (file >= 0) {
        dprintf(file, "%ld\n", atomic_load(&seen));
        close(file);
    }
}
