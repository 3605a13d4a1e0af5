/* Arrays that grow as they are filled: the room at least doubles, so that n elements cost about n steps. */
#ifndef CUVETTE_BASE_GROW_H
#define CUVETTE_BASE_GROW_H

#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

/* array: the address of a pointer to elements of that size, of which there is *room. False when memory is out; all is
 * then as it was. */
static inline bool grow_room(void *array, size_t *room, size_t wanted, size_t size)
{
    if (wanted <= *room)
        return true;
    const size_t more = wanted < 64 ? 64 : 2 * wanted;
    void *now;
    memcpy(&now, array, sizeof now);
    now = more <= SIZE_MAX / size ? realloc(now, more * size) : NULL;
    if (!now)
        return false;
    memcpy(array, &now, sizeof now);
    *room = more;
    return true;
}

/* Is there room for so many elements in the array, whose room this is, or can it be made? */
#define GROW(array, room, wanted) grow_room(&(array), &(room), wanted, sizeof *(array))

#endif
