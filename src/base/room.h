/* Arrays that grow by one: their room is always a power of two, so that the count alone tells when it is full.
 * Ownership: the array is the caller's, NULL at first, released with free. */
#ifndef CUVETTE_BASE_ROOM_H
#define CUVETTE_BASE_ROOM_H

#include <stdbool.h>
#include <stddef.h>

/* Makes room for one more element of that size behind count of them; array is the address of the pointer to them. False
 * when memory is out: the array is then as it was. */
bool room_for_one(void *array, size_t count, size_t size);

#endif
