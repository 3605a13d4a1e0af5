/* Advice to use large pages. */
#include "base/large_pages.h"

#include <stdint.h>
#include <stdlib.h>
#include <sys/mman.h>
#include <unistd.h>

void *large_pages(void *memory, size_t bytes)
{
    if (memory && bytes >= LARGE_PAGES_MIN) {
        /* whole pages, from the one with malloc's header: a mapping of two kinds could not be moved by realloc */
        const uintptr_t page = (uintptr_t)sysconf(_SC_PAGESIZE), first = (uintptr_t)memory / page * page,
                        end = ((uintptr_t)memory + bytes + page - 1) / page * page;
        madvise((char *)memory - ((uintptr_t)memory - first), end - first, MADV_HUGEPAGE);
    }
    return memory;
}

void *large_calloc(size_t count, size_t size)
{
    return large_pages(calloc(count, size), count * size); /* calloc rejects a product that overflows */
}
