/* Arrays that grow as they are filled: the room at least doubles, so that n elements cost about n steps.
 * Ownership: the array is the caller's, NULL at first, released with free. Each function takes the address of the
 * pointer to the elements, and their size; false when memory is out, and all is then as it was. */
#pragma once

#include <stdbool.h>
#include <stddef.h>

/* Room for so many elements, where there is *room. */
bool grow_room(void *array, size_t *room, size_t wanted, size_t size);

/* Is there room for so many elements in the array, whose room this is, or can it be made? */
#define GROW(array, room, wanted) grow_room(&(array), &(room), wanted, sizeof *(array))

/* Room for one more behind count of them, in an array that grows by one: its room is always a power of two, so that
 * the count alone tells when it is full. */
bool room_for_one(void *array, size_t count, size_t size);
