/* Growable arrays: the capacity at least doubles, so that n elements cost about n steps. Ownership: the caller owns the
 * array, NULL at first, and frees it with free. Each function takes the address of the pointer to the elements, and
 * their size; false: out of memory, with everything unchanged. */
#pragma once

#include <stdbool.h>
#include <stddef.h>

/* Makes room for `wanted` elements; *room is the current capacity. */
bool grow_room(void *array, size_t *room, size_t wanted, size_t size);

/* Ensures a capacity of `wanted` elements for the array with capacity `room`; false: out of memory. */
#define GROW(array, room, wanted) grow_room(&(array), &(room), wanted, sizeof *(array))

/* Makes room for one more after count elements, in an array that grows by one: its capacity is always a power of two,
 * so that the count alone determines when it is full. */
bool room_for_one(void *array, size_t count, size_t size);
