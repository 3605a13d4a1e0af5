#include "base/room.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

bool room_for_one(void *array, size_t count, size_t size)
{
    void *old;
    if ((count & (count - 1)) != 0)
        return true;
    const size_t room = count ? 2 * count : 1;
    memcpy(&old, array, sizeof old);
    void *grown = room <= SIZE_MAX / 2 / size ? realloc(old, room * size) : NULL;
    if (grown)
        memcpy(array, &grown, sizeof grown);
    return grown;
}
