/* Growable arrays. */
#include "base/grow.h"
#include "base/large_pages.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

static bool resize(void *array, size_t count, size_t size)
{
    void *now;
    memcpy(&now, array, sizeof now);
    now = count <= SIZE_MAX / size ? large_pages(realloc(now, count * size), count * size) : NULL;
    if (now)
        memcpy(array, &now, sizeof now);
    return now;
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
