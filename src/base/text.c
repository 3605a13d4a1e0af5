/* Edit distance, the nearest word, and formatted strings. */
#include "base/text.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

enum { WORD_MAX = 63 };

static char lower(char c)
{
    return c >= 'A' && c <= 'Z' ? (char)(c - 'A' + 'a') : c;
}

static unsigned least(unsigned a, unsigned b)
{
    return a < b ? a : b;
}

unsigned text_distance(const char *a, const char *b)
{
    size_t a_length = strnlen(a, WORD_MAX), b_length = strnlen(b, WORD_MAX);
    unsigned rows[3][WORD_MAX + 1]; /* distances of a's prefixes i-2, i-1 and i to every prefix of b */
    unsigned *two_back = rows[0], *previous = rows[1], *current = rows[2];
    for (size_t j = 0; j <= b_length; j++) {
        previous[j] = (unsigned)j;
        two_back[j] = 0;
    }
    for (size_t i = 1; i <= a_length; i++) {
        current[0] = (unsigned)i;
        for (size_t j = 1; j <= b_length; j++) {
            char x = lower(a[i - 1]), y = lower(b[j - 1]);
            current[j] = least(least(previous[j], current[j - 1]) + 1, previous[j - 1] + (x != y));
            if (i > 1 && j > 1 && x == lower(b[j - 2]) && lower(a[i - 2]) == y)
                current[j] = least(current[j], two_back[j - 2] + 1);
        }
        unsigned *oldest = two_back;
        two_back = previous;
        previous = current;
        current = oldest;
    }
    return previous[b_length];
}

const char *text_nearest(const char *wrong, const char *const *words, size_t count)
{
    size_t third = strnlen(wrong, WORD_MAX) / 3;
    unsigned allowed = third > 1 ? (unsigned)third : 1;
    const char *nearest = NULL;
    for (size_t i = 0; i < count; i++) {
        unsigned distance = text_distance(wrong, words[i]);
        if (distance < allowed || (distance == allowed && !nearest)) {
            nearest = words[i];
            allowed = distance;
        }
    }
    return nearest;
}

char *text_format(const char *format, ...)
{
    char *text = NULL;
    va_list arguments;
    va_start(arguments, format);
    int length = vasprintf(&text, format, arguments);
    va_end(arguments);
    return length < 0 ? NULL : text;
}
