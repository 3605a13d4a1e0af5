/* A reserve of memory for jansson. */
#include "base/json_memory.h"

#include <jansson.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>

enum { RESERVE_BYTES = 1 << 20, ALIGNMENT = 16 };

/* Handed out from the beginning, and never taken back: it is for a program that is about to report that memory ran
 * out. Pages that are not used cost nothing. */
static _Alignas(ALIGNMENT) char reserve[RESERVE_BYTES];
static atomic_size_t used;

static void *allocate(size_t size)
{
    void *memory = malloc(size);
    if (memory || size > RESERVE_BYTES / 4)
        return memory;
    const size_t rounded = (size + ALIGNMENT - 1) / ALIGNMENT * ALIGNMENT, at = atomic_fetch_add(&used, rounded);
    return at + rounded <= RESERVE_BYTES ? reserve + at : NULL;
}

static void release(void *memory)
{
    const uintptr_t at = (uintptr_t)memory, start = (uintptr_t)reserve;
    if (at < start || at >= start + RESERVE_BYTES)
        free(memory);
}

void json_memory_reserve(void)
{
    json_set_alloc_funcs(allocate, release);
}
