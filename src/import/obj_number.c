/* Numbers of OBJ files, as assimp rounds them. Independent of the locale. */
#include "import/obj.h"

#include <math.h>

enum { WHOLE_MAX = 18, PART_MAX = 15, EXPONENT_MAX = 3 }; /* digits */

static bool is_digit(char c)
{
    return c >= '0' && c <= '9';
}

/* Reads digits up to `most` of them; returns their number. */
static int digits(const char **at, int most, uint64_t *value)
{
    const char *p = *at;
    uint64_t sum = 0;
    for (; is_digit(*p) && p - *at < most; p++)
        sum = sum * 10 + (uint64_t)(*p - '0');
    const int count = (int)(p - *at);
    *value = sum;
    *at = p;
    return count;
}

bool obj_number(const char **at, float *number)
{
    static const double tenth[PART_MAX + 1] = {0.0,  1e-1, 1e-2,  1e-3,  1e-4,  1e-5,  1e-6,  1e-7,
                                               1e-8, 1e-9, 1e-10, 1e-11, 1e-12, 1e-13, 1e-14, 1e-15};
    const char *p = *at;
    const bool minus = *p == '-';
    uint64_t whole, part, exponent;
    if (*p == '.') /* without a sign assimp refuses it */
        return false;
    p += minus || *p == '+';
    const int before = digits(&p, WHOLE_MAX, &whole);
    if (is_digit(*p))
        return false;
    float value = (float)whole;
    int after = 0;
    if (*p == '.') {
        p++;
        after = digits(&p, PART_MAX, &part);
        while (is_digit(*p))
            p++;
        if (after > 0)
            value += (float)((double)part * tenth[after]);
    }
    if (before == 0 && after == 0)
        return false;
    if (*p == 'e' || *p == 'E') {
        p++;
        const bool negative = *p == '-';
        p += negative || *p == '+';
        if (digits(&p, EXPONENT_MAX, &exponent) == 0 || is_digit(*p))
            return false;
        value *= powf(10.0F, negative ? -(float)exponent : (float)exponent);
    }
    *number = minus ? -value : value;
    *at = p;
    return true;
}

bool obj_index(const char **at, uint32_t *index)
{
    uint64_t value;
    if (digits(at, 9, &value) == 0 || is_digit(**at) || value == 0)
        return false;
    *index = (uint32_t)value;
    return true;
}
