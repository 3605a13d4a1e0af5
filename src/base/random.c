/* The generator Philox4x32-10. */
#include "base/random.h"

/* Random123's headers use implicit conversions. */
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wpedantic"
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wsign-conversion"
#pragma GCC diagnostic ignored "-Wshadow"
#pragma GCC diagnostic ignored "-Wmissing-prototypes"
#include <Random123/philox.h>
#pragma GCC diagnostic pop

random_words random_at(uint64_t key, uint32_t a, uint32_t b, uint32_t c, uint32_t d)
{
    philox4x32_key_t keys = {{(uint32_t)key, (uint32_t)(key >> 32)}};
    philox4x32_ctr_t counter = {{a, b, c, d}};
    philox4x32_ctr_t drawn = philox4x32(counter, keys);
    return (random_words){{drawn.v[0], drawn.v[1], drawn.v[2], drawn.v[3]}};
}
