/* Divides a text into lines, words and numbers (mesh.h). */
#include "import/obj.h"
#include "wasm/mesh/mesh.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static bool is_blank(char c)
{
    return c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == '\f' || c == '\v';
}

bool lines_next(lines *l)
{
    if (l->at >= l->end)
        return false;
    l->word = l->at;
    const char *end;
    do {
        end = memchr(l->at, '\n', (size_t)(l->end - l->at));
        end = end ? end : l->end;
        l->at = end < l->end ? end + 1 : end;
        l->line++;
    } while (l->at < l->end && end > l->word &&
             (end[-1] == '\\' || (end[-1] == '\r' && end - 1 > l->word && end[-2] == '\\')));
    l->line_end = end;
    return true;
}

bool lines_word(lines *l, const char **word, size_t *length)
{
    const char *p = l->word;
    while (p < l->line_end && (is_blank(*p) || (*p == '\\' && p + 1 < l->line_end && is_blank(p[1]))))
        p++;
    *word = p;
    while (p < l->line_end && !is_blank(*p))
        p++;
    *length = (size_t)(p - *word);
    l->word = p;
    return *length > 0;
}

bool lines_is(const char *word, size_t length, const char *text)
{
    return strlen(text) == length && memcmp(word, text, length) == 0;
}

size_t lines_rest(const lines *l, const char **text)
{
    const char *from = l->word, *to = l->line_end;
    while (from < to && is_blank(*from))
        from++;
    while (to > from && is_blank(to[-1]))
        to--;
    *text = from;
    return (size_t)(to - from);
}

int lines_numbers(lines *l, int most, float *numbers)
{
    int count = 0;
    const char *word;
    size_t length;
    while (count < most && lines_word(l, &word, &length)) {
        char copy[64];
        if (length >= sizeof copy)
            return -1;
        memcpy(copy, word, length);
        copy[length] = 0;
        const char *at = copy;
        char *end = NULL;
        if (!obj_number(&at, &numbers[count]) || *at) {
            numbers[count] = strtof(copy, &end);
            if (end == copy || *end)
                return -1;
        }
        if (!isfinite(numbers[count]))
            return -1;
        count++;
    }
    return count;
}
