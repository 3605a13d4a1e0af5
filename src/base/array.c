/* Growable arrays, and advice to use large pages: madvise(2). */
#include "base/array.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

void *large_pages(void *memory, size_t bytes)
{
    if (memory && bytes >= LARGE_PAGES_MIN) {
        /* the advice includes the page with malloc's header: realloc could not move a mapping with two kinds of
         * pages */
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

static bool resize(void *array, size_t count, size_t size)
{
    void *elements;
    memcpy(&elements, array, sizeof elements);
    elements = count <= SIZE_MAX / size ? large_pages(realloc(elements, count * size), count * size) : NULL;
    if (elements)
        memcpy(array, &elements, sizeof elements);
    return elements;
}

bool grow_room(void *array, size_t *room, size_t wanted, size_t size)
{
    if (wanted <= *room)
        return true;
    const size_t more = wanted < 64 ? 64 : 2 * wanted;
    if (!resize(array, more, size))
        return false;
    *room = more;
    return true;
}

bool room_for_one(void *array, size_t count, size_t size)
{
    return (count & (count - 1)) != 0 || resize(array, count ? 2 * count : 1, size);
}
