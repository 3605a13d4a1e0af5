/* Bounds of compression. */
#include "image/image_room.h"

/* Deflate shrinks to 1/1032 at most (zlib, algorithm.txt); JPEG to 6 bits for 64 pixels. */
void image_room(image_format format, double width, double height, double count, disk_room *to)
{
    enum { HEADERS_MOST = 20000, DEFLATE_MOST = 1032 };
    const double pixels = width * height;
    if (format == IMAGE_PFM)
        disk_room_add(to, count, 12 * pixels, 12 * pixels + HEADERS_MOST);
    else if (format == IMAGE_PNG)
        disk_room_add(to, count, 3 * pixels / DEFLATE_MOST, 3.01 * pixels + HEADERS_MOST);
    else
        disk_room_add(to, count, pixels / 86, 4 * pixels + HEADERS_MOST);
}
