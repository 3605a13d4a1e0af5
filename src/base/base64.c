/* Base64 and base64url (RFC 4648, 4 and 5). */
#include "base/base64.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

static const char plain_digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
static const char address_digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_";

char *base64_encode(const void *bytes, size_t size, bool for_address)
{
    const unsigned char *from = bytes;
    const char *digits = for_address ? address_digits : plain_digits;
    char *text = size < SIZE_MAX / 2 ? malloc((size + 2) / 3 * 4 + 1) : NULL, *to = text;
    if (!text)
        return NULL;
    for (size_t i = 0; i < size; i += 3) {
        const size_t left = size - i;
        const unsigned group = (unsigned)from[i] << 16 | (left > 1 ? (unsigned)from[i + 1] << 8 : 0u) |
                               (left > 2 ? (unsigned)from[i + 2] : 0u);
        const int count = left > 2 ? 4 : (int)left + 1;
        for (int k = 0; k < 4; k++)
            if (k < count)
                *to++ = digits[group >> (18 - 6 * k) & 63];
            else if (!for_address)
                *to++ = '=';
    }
    *to = 0;
    return text;
}

unsigned char *base64_decode(const char *text, size_t length, size_t *size)
{
    unsigned char *bytes = length % 4 == 1 ? NULL : malloc(length / 4 * 3 + 3), *to = bytes;
    unsigned group = 0;
    for (size_t i = 0; bytes && i < length; i++) {
        const char *digit = text[i] ? strchr(address_digits, text[i]) : NULL;
        if (!digit) {
            free(bytes);
            return NULL;
        }
        group = group << 6 | (unsigned)(digit - address_digits);
        if (i % 4 > 0)
            *to++ = (unsigned char)(group >> (i % 4 == 1 ? 4 : i % 4 == 2 ? 2 : 0));
    }
    *size = bytes ? (size_t)(to - bytes) : 0;
    return bytes;
}
