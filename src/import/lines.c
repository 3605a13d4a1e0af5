/* Divides a text into lines, words and numbers (plain.h). */
#include "base/number.h"
#include "import/plain.h"

#include <string.h>
#include <strings.h>

static bool is_line_end(char c)
{
    return c == '\n' || c == '\r';
}

static bool is_blank(char c)
{
    return c == ' ' || c == '\t' || c == '\f' || c == '\v';
}

size_t text_begin(const char *text, size_t size)
{
    return size >= 3 && memcmp(text, "\xef\xbb\xbf", 3) == 0 ? 3 : 0;
}

lines lines_of(const char *text, size_t size)
{
    return (lines){.at = text + text_begin(text, size), .end = text + size, .line = 1};
}

bool lines_next(lines *l)
{
    while (l->at < l->end && !is_line_end(*l->at))
        l->at++;
    if (l->at >= l->end)
        return false;
    l->at += l->at[0] == '\r' && l->at[1] == '\n' ? 2 : 1;
    l->line++;
    return l->at < l->end;
}

bool lines_word(lines *l, const char **word, size_t *length)
{
    while (l->at < l->end && is_blank(*l->at))
        l->at++;
    const char *p = l->at;
    while (p < l->end && !is_blank(*p) && !is_line_end(*p))
        p++;
    *word = l->at;
    *length = (size_t)(p - l->at);
    l->at = p;
    return *length > 0;
}

bool lines_any_word(lines *l, const char **word, size_t *length)
{
    while (!lines_word(l, word, length))
        if (!lines_next(l))
            return false;
    return true;
}

bool lines_number(const char *word, size_t length, double *number)
{
    const char *at = word;
    return number_scan(&at, number) && at == word + length;
}

bool lines_is(const char *word, size_t length, const char *text)
{
    return strlen(text) == length && strncasecmp(word, text, length) == 0;
}

size_t lines_rest(const lines *l, const char **text)
{
    const char *from = l->at;
    while (from < l->end && is_blank(*from))
        from++;
    const char *to = from;
    while (to < l->end && !is_line_end(*to))
        to++;
    while (to > from && is_blank(to[-1]))
        to--;
    *text = from;
    return (size_t)(to - from);
}
