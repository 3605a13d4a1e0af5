/* Texts: similar words, formatting, a stream into memory, words of a shell, Base64. */
#include "base/text.h"

#include <errno.h>

#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/types.h>

/* ---- similar words ---- */

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

/* ---- formatting ---- */

char *text_format(const char *format, ...)
{
    char *text = NULL;
    va_list arguments;
    va_start(arguments, format);
    int length = vasprintf(&text, format, arguments);
    va_end(arguments);
    return length < 0 ? NULL : text;
}

/* ---- a stream into memory ---- */

/* Room for more bytes and a final 0. */
static bool make_room(text_writer *w, size_t more)
{
    if (more < w->capacity - w->size)
        return true;
    if (more > SIZE_MAX / 4 - w->size)
        return false;
    const size_t capacity = 2 * (w->size + more) + 128;
    char *larger = realloc(w->text, capacity);
    if (!larger)
        return false;
    w->text = larger;
    w->capacity = capacity;
    return true;
}

static ssize_t append(void *of, const char *bytes, size_t count)
{
    text_writer *w = of;
    if (w->failed || !make_room(w, count)) {
        w->failed = true;
        return 0; /* reports an error to the stream */
    }
    memcpy(w->text + w->size, bytes, count);
    w->size += count;
    return (ssize_t)count;
}

status text_writer_open(text_writer *writer, diagnostic *why)
{
    *writer = (text_writer){.stream = NULL};
    if (make_room(writer, 0) && (writer->stream = fopencookie(writer, "w", (cookie_io_functions_t){.write = append})))
        return STATUS_OK;
    text_writer_abandon(writer);
    return out_of_memory(why);
}

/* Closes the stream; returns whether everything fit. */
static bool end_stream(text_writer *w)
{
    const bool bad = !w->stream || ferror(w->stream);
    const bool ended = w->stream && fclose(w->stream) == 0;
    w->stream = NULL;
    return ended && !bad && !w->failed;
}

status text_writer_close(text_writer *writer, char **text, size_t *size, diagnostic *why)
{
    *text = NULL;
    if (!end_stream(writer)) {
        text_writer_abandon(writer);
        return out_of_memory(why);
    }
    writer->text[writer->size] = 0;
    *text = writer->text;
    if (size)
        *size = writer->size;
    *writer = (text_writer){.stream = NULL};
    return STATUS_OK;
}

void text_writer_abandon(text_writer *writer)
{
    end_stream(writer);
    free(writer->text);
    *writer = (text_writer){.stream = NULL};
}

status text_writer_end(text_writer *writer, status code, char **text, size_t *size, diagnostic *why)
{
    *text = NULL;
    if (code == STATUS_OK)
        return text_writer_close(writer, text, size, why);
    text_writer_abandon(writer);
    return code;
}

/* ---- words of a shell ---- */

size_t text_utf8(const char *text, uint32_t *out)
{
    const unsigned char *b = (const unsigned char *)text;
    static const uint32_t least[] = {0, 0, 0x80, 0x800, 0x10000};
    const size_t length = b[0] < 0x80 ? 1 : b[0] >> 5 == 6 ? 2 : b[0] >> 4 == 14 ? 3 : b[0] >> 3 == 30 ? 4 : 0;
    uint32_t c = length < 2 ? b[0] : b[0] & (0x7fu >> length);
    for (size_t i = 1; i < length; i++) {
        if ((b[i] & 0xc0) != 0x80)
            return 0;
        c = c << 6 | (b[i] & 0x3fu);
    }
    const bool valid = length > 0 && c >= least[length] && c <= 0x10ffff && (c < 0xd800 || c > 0xdfff);
    *out = c;
    return valid ? length : 0;
}

/* Writes a character as UTF-8; returns the place after it. */
static char *put_utf8(char *to, uint32_t c)
{
    if (c < 0x80) {
        *to++ = (char)c;
        return to;
    }
    const int more = c < 0x800 ? 1 : c < 0x10000 ? 2 : 3;
    *to++ = (char)((0xff00u >> (more + 1) & 0xffu) | c >> 6 * more);
    for (int i = more - 1; i >= 0; i--)
        *to++ = (char)(0x80u | (c >> 6 * i & 0x3fu));
    return to;
}

/* The unit of UTF-16 at a place; 0 beyond the end. */
static uint32_t unit_at(const char *text, size_t size, size_t i, bool low_first)
{
    if (i + 1 >= size)
        return 0;
    const uint32_t a = (unsigned char)text[i], b = (unsigned char)text[i + 1];
    return low_first ? a | b << 8 : a << 8 | b;
}

static uint32_t wide_at(const char *text, size_t size, size_t *i, bool low_first)
{
    const uint32_t a = unit_at(text, size, *i, low_first), b = unit_at(text, size, *i + 2, low_first);
    *i += 2;
    if (a < 0xd800 || a > 0xdfff)
        return a;
    if (a > 0xdbff || b < 0xdc00 || b > 0xdfff)
        return ' ';
    *i += 2;
    return 0x10000 + ((a - 0xd800) << 10 | (b - 0xdc00));
}

/* The character at a place of a text of bytes, which is of ISO 8859-1 where it is not UTF-8. */
static uint32_t byte_at(const char *text, size_t size, size_t *i)
{
    char next[5] = {0};
    uint32_t c = 0;
    memcpy(next, text + *i, size - *i < 4 ? size - *i : 4);
    const size_t length = text_utf8(next, &c);
    *i += length > 0 ? length : 1;
    return length > 0 ? c : (unsigned char)next[0];
}

int text_cut(const char *text, size_t most)
{
    size_t n = strnlen(text, most + 1);
    if (n > most)
        for (n = most; n > 0 && ((unsigned char)text[n] & 0xc0) == 0x80; n--) {
        }
    return (int)n;
}

char *text_narrow(const char *text, size_t size)
{
    const bool marked_low = size >= 2 && memcmp(text, "\xff\xfe", 2) == 0,
               marked_high = size >= 2 && memcmp(text, "\xfe\xff", 2) == 0,
               low_first = marked_low || (size >= 4 && text[0] && !text[1] && text[2] && !text[3]),
               wide = low_first || marked_high;
    size_t i = marked_low || marked_high ? 2 : size >= 3 && memcmp(text, "\xef\xbb\xbf", 3) == 0 ? 3 : 0;
    char *narrow = malloc(2 * size + 4), *to = narrow;
    while (narrow && i < size) {
        const uint32_t c = wide ? wide_at(text, size, &i, low_first) : byte_at(text, size, &i);
        to = put_utf8(to, c == 0 || c == '\r' ? ' ' : c);
    }
    if (narrow)
        *to = 0;
    return narrow;
}

void shell_word_write(FILE *out, const char *word)
{
    if (*word && word[strspn(word, "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_./,=:+-")] == 0) {
        fputs(word, out);
        return;
    }
    fputc('\'', out);
    for (const char *c = word; *c; c++)
        fputs(*c == '\'' ? "'\\''" : (const char[]){*c, 0}, out);
    fputc('\'', out);
}

/* ---- Base64 and base64url: RFC 4648, 4 and 5 ---- */

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

unsigned char *base64_decode(const char *text, size_t length, bool for_address, size_t *size)
{
    const char *digits = for_address ? address_digits : plain_digits;
    unsigned char value[256];
    memset(value, 64, sizeof value);
    for (unsigned char i = 0; i < 64; i++)
        value[(unsigned char)digits[i]] = i;
    for (int k = 0; k < 2 && !for_address && length > 0 && text[length - 1] == '='; k++)
        length--;
    errno = 0;
    unsigned char *bytes = length % 4 == 1 ? NULL : malloc(length / 4 * 3 + 3), *to = bytes;
    unsigned group = 0;
    for (size_t i = 0; bytes && i < length; i++) {
        const unsigned digit = value[(unsigned char)text[i]];
        if (digit > 63) {
            free(bytes);
            return NULL;
        }
        group = group << 6 | digit;
        if (i % 4 > 0)
            *to++ = (unsigned char)(group >> (i % 4 == 1 ? 4 : i % 4 == 2 ? 2 : 0));
    }
    *size = bytes ? (size_t)(to - bytes) : 0;
    return bytes;
}
