#include "scene/model/suggest.h"
#include "base/number.h"
#include "base/text.h"

#include <stdio.h>
#include <string.h>
#include <strings.h>

static bool is_number(const char *text)
{
    double value;
    return number_parse_real(text, &value);
}

static const char *find(const char *word, const char *const *words, size_t count)
{
    for (size_t i = 0; i < count; i++)
        if (strcmp(words[i], word) == 0)
            return words[i];
    return NULL;
}

/* Names of our parameters in other programs. */
static const char *by_alias(const char *wrong, const char *const *words, size_t count)
{
    static const char *const aliases[][2] = {
        {"n", "ior"},        {"index", "ior"},      {"refractive_index", "ior"}, {"opacity", "transparency"},
        {"type", "shape"},   {"kind", "shape"},     {"alpha", "transparency"},   {"colour", "color"},
        {"light", "lights"}, {"objects", "solids"}, {"shapes", "solids"},        {"spheres", "solids"},
    };
    for (size_t i = 0; i < sizeof aliases / sizeof *aliases; i++)
        if (strcasecmp(aliases[i][0], wrong) == 0)
            return find(aliases[i][1], words, count);
    return NULL;
}

static const char *by_beginning(const char *wrong, const char *const *words, size_t count)
{
    const char *only = NULL;
    for (size_t i = 0; i < count; i++) {
        if (strncasecmp(words[i], wrong, strlen(wrong)) == 0) {
            if (only)
                return NULL;
            only = words[i];
        }
    }
    return only;
}

const char *suggest_word(const char *wrong, const char *const *words, size_t count)
{
    enum { TELLING = 3 }; /* characters */
    const char *meant = by_alias(wrong, words, count);
    if (meant || strlen(wrong) < TELLING || is_number(wrong))
        return meant;
    meant = by_beginning(wrong, words, count);
    return meant ? meant : text_nearest(wrong, words, count);
}

void suggest_list(const char *prefix, const char *const *words, size_t count, char *text, size_t size)
{
    static const char more[] = ", ...";
    size_t used = (size_t)snprintf(text, size, "%s", prefix);
    for (size_t i = 0; i < count && used < size; i++) {
        const size_t left = size - used, need = strlen(words[i]) + 2;
        if (need + (i + 1 < count ? sizeof more : 1) > left) {
            snprintf(text + used, left, "%s", more);
            return;
        }
        used += (size_t)snprintf(text + used, left, "%s%s", i ? ", " : "", words[i]);
    }
}

char *suggest_key(const char *wrong, const char *const *words, size_t count, char *text, size_t size)
{
    const char *meant = suggest_word(wrong, words, count);
    if (is_number(wrong)) /* in braces a comma ends the entry: {radius: 1,5} has a key 5 */
        snprintf(text, size, "a decimal comma? write 1.5; a vector is [0, 1, 2]");
    else if (strchr(wrong, ':'))
        snprintf(text, size, "put a space after the colon");
    else if (meant)
        snprintf(text, size, "did you mean '%s'?", meant);
    else
        suggest_list("the keys here are: ", words, count, text, size);
    return text;
}
