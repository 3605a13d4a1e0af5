/* The disk space of image files that are to be written. */
#pragma once

#include "base/disk_room.h"
#include "image/image.h"

/* Adds what count image files with 8 bits may take. PFM has an exact size; of the others the least is that of the best
 * possible compression. */
void image_room(image_format format, double width, double height, double count, disk_room *to);
