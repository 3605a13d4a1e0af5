/* Row filters of PNG and their choice. */
#include "image/png_filter.h"

#include <stdint.h>
#include <string.h>

enum { SUB = 1, UP = 2 };

static void filter_sub(const unsigned char *row, size_t bytes, size_t pixel, unsigned char *out)
{
    memcpy(out, row, pixel);
    for (size_t i = pixel; i < bytes; i++)
        out[i] = (unsigned char)(row[i] - row[i - pixel]);
}

static void filter_up(const unsigned char *row, const unsigned char *above, size_t bytes, unsigned char *out)
{
    for (size_t i = 0; i < bytes; i++)
        out[i] = (unsigned char)(row[i] - above[i]);
}

static uint32_t changes(const unsigned char *filtered, size_t bytes)
{
    uint32_t count = 0;
    for (size_t i = 1; i < bytes; i++)
        count += filtered[i] != filtered[i - 1];
    return count;
}

static uint32_t absolute_sum(const unsigned char *filtered, size_t bytes)
{
    uint32_t sum = 0; /* at most 128 x 6 x 65536 */
    for (size_t i = 0; i < bytes; i++)
        sum += filtered[i] < 128 ? filtered[i] : 256u - filtered[i];
    return sum;
}

void png_filter_row(png_filter_choice choice, const unsigned char *row, const unsigned char *above, size_t bytes,
                    size_t pixel, unsigned char *out, unsigned char *spare)
{
    out[0] = SUB;
    filter_sub(row, bytes, pixel, out + 1);
    if (choice == PNG_FILTER_ALWAYS_SUB)
        return;
    uint32_t (*cost)(const unsigned char *, size_t) = choice == PNG_FILTER_LEAST_SUM ? absolute_sum : changes;
    spare[0] = UP;
    filter_up(row, above, bytes, spare + 1);
    if (cost(spare + 1, bytes) < cost(out + 1, bytes))
        memcpy(out, spare, bytes + 1);
}
