/* Memory of large and growing arrays. Ownership: the caller owns the array and frees it with free. */
#pragma once

#include <stdbool.h>
#include <stddef.h>

/* Growable arrays: the capacity at least doubles, so that n elements cost about n steps. An array is NULL at first. The
 * functions receive the address of the pointer to the elements, and the size of an element. They return false, with
 * everything unchanged, when out of memory. */

/* Makes room for `wanted` elements; *room is the capacity, which is updated. */
bool grow_room(void *array, size_t *room, size_t wanted, size_t size);

/* Ensures a capacity of `wanted` elements for the array with capacity `room`; false: out of memory. */
#define GROW(array, room, wanted) grow_room(&(array), &(room), wanted, sizeof *(array))

/* Makes room for one more element after `count` elements. The capacity is always a power of two, so that the count
 * determines when the array is full. */
bool room_for_one(void *array, size_t count, size_t size);

/* Advice to the system to use large pages (2 MiB) for a large block of memory: it is zeroed in fewer faults, and tables
 * that are read at random cost fewer misses of the TLB. Blocks below 4 MiB stay as they are; a failure only sets errno.
 * malloc usually maps blocks of that size separately. The first and the last page of a block in the heap may belong to
 * other blocks, too; the advice does not harm them. */
enum { LARGE_PAGE = 1 << 21, LARGE_PAGES_MIN = 2 * LARGE_PAGE }; /* bytes */

/* Gives this advice for `memory`, a block of `bytes` from malloc, and returns it; NULL is allowed. Call it before the
 * block is used. */
void *large_pages(void *memory, size_t bytes);
/* calloc with this advice. */
void *large_calloc(size_t count, size_t size);
