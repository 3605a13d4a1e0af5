/* Memory of large and growing arrays. Ownership: the caller owns the array and frees it with free. */
#pragma once

#include <stdbool.h>
#include <stddef.h>

/* Growable arrays: the capacity at least doubles, so that n elements cost about n steps. An array is NULL at first. The
 * functions get the address of the pointer to the elements, and the size of one; false: out of memory, with everything
 * unchanged. */

/* Makes room for `wanted` elements; *room is the current capacity. */
bool grow_room(void *array, size_t *room, size_t wanted, size_t size);

/* Ensures a capacity of `wanted` elements for the array with capacity `room`; false: out of memory. */
#define GROW(array, room, wanted) grow_room(&(array), &(room), wanted, sizeof *(array))

/* Makes room for one more after count elements, in an array that grows by one: its capacity is always a power of two,
 * so that the count determines when it is full. */
bool room_for_one(void *array, size_t count, size_t size);

/* Advice to the system to use large pages (2 MiB) for a large block of memory: it is zeroed in fewer faults, and tables
 * that are read at random cost fewer misses of the TLB. Blocks below 4 MiB stay as they are; a failure only sets errno.
 * malloc maps blocks of that size separately; of a block in the heap, the first and the last page may belong to other
 * blocks too, which the advice does not harm. */
enum { LARGE_PAGE = 1 << 21, LARGE_PAGES_MIN = 2 * LARGE_PAGE }; /* bytes */

/* Returns `memory`, a block of `bytes` from malloc or the like, or NULL. Best before its first use. */
void *large_pages(void *memory, size_t bytes);
/* calloc with this advice. */
void *large_calloc(size_t count, size_t size);
