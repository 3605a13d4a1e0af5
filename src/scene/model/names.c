/* Names of objects: which are valid, which are in use; and suggestions for misspelt words (names.h). */
#include "scene/model/names.h"
#include "base/hash.h"
#include "base/number.h"
#include "base/text.h"
#include "scene/model/params.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

/* --- valid names --- */

static bool is_reserved(const char *name)
{
    static const char *const sections[] = {"title", "meshes", "textures", "materials", "lights", "solids"};
    for (size_t i = 0; i < sizeof sections / sizeof sections[0]; i++)
        if (strcmp(name, sections[i]) == 0)
            return true;
    for (int g = 0; g < PARAM_GROUP_COUNT; g++) /* objects of older scenes may be called "beam" or "data" */
        if (g != PARAM_BEAM && g != PARAM_DATA && strcmp(name, param_group_name((param_group)g)) == 0)
            return true;
    return false;
}

/* Letters of any script, not by a table of Unicode: above ASCII all but controls, punctuation, symbols, arrows, private
 * and invisible characters, by their blocks. */
static bool is_letter(uint32_t c)
{
    static const uint32_t others[][2] = {{0, 0xbf},        {0xd7, 0xd7},     {0xf7, 0xf7},       {0x2000, 0x2bff},
                                         {0x3000, 0x3004}, {0x3008, 0x3020}, {0xd800, 0xf8ff},   {0xfe00, 0xfe6f},
                                         {0xfeff, 0xff20}, {0xfff0, 0xffff}, {0x1f000, 0x1faff}, {0xe0000, UINT32_MAX}};
    if (c < 0x80)
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
    for (size_t i = 0; i < sizeof others / sizeof others[0]; i++)
        if (c >= others[i][0] && c <= others[i][1])
            return false;
    return true;
}

status check_name(const char *name, diagnostic *why)
{
    uint32_t c = 0;
    bool valid = name[0] && strlen(name) <= SCENE_NAME_MAX;
    for (size_t at = 0, size; valid && name[at]; at += size) {
        size = text_utf8(name + at, &c);
        valid = size && (is_letter(c) || (at > 0 && ((c >= '0' && c <= '9') || c == '-')));
    }
    if (!valid)
        return diagnose(why, STATUS_BAD_INPUT,
                        "use letters of any script, digits, _ and -, at most 63 bytes, beginning with a letter or _",
                        "'%.80s' is not a valid name", name);
    if (is_reserved(name))
        return diagnose(why, STATUS_BAD_INPUT, "choose another name", "the name '%s' is a reserved word of scene files",
                        name);
    return STATUS_OK;
}

/* --- names in use --- */

/* The hash of a name, never 0, which marks a free entry. */
static uint64_t hash_of(const char *name)
{
    const uint64_t h = hash_finish(hash_bytes(HASH_START, name, strlen(name)));
    return h ? h : 1;
}

/* The entry of a hash, or the free entry for it. The size is a power of two, and at least one entry is free. */
static size_t entry_of(const name_tally *t, uint64_t hash)
{
    size_t at = (size_t)hash & (t->size - 1);
    while (t->hash[at] != 0 && t->hash[at] != hash)
        at = (at + 1) & (t->size - 1);
    return at;
}

static bool grow(name_tally *t)
{
    const size_t size = t->size ? 2 * t->size : 64;
    name_tally larger = {.hash = calloc(size, sizeof *t->hash),
                         .count = calloc(size, sizeof *t->count),
                         .newest = calloc(size, sizeof *t->newest),
                         .size = size};
    if (!larger.hash || !larger.count || !larger.newest) {
        name_tally_clear(&larger);
        return false;
    }
    for (size_t i = 0; i < t->size; i++) {
        if (t->hash[i] == 0 || t->count[i] == 0)
            continue;
        const size_t at = entry_of(&larger, t->hash[i]);
        larger.hash[at] = t->hash[i];
        larger.count[at] = t->count[i];
        larger.newest[at] = t->newest[i];
        larger.used++;
    }
    name_tally_clear(t);
    *t = larger;
    return true;
}

void name_tally_add(name_tally *t, const char *name, name_place place)
{
    if (t->lost || (2 * (t->used + 1) > t->size && !grow(t))) {
        t->lost = true;
        return;
    }
    const uint64_t hash = hash_of(name);
    const size_t at = entry_of(t, hash);
    t->used += t->hash[at] == 0;
    t->hash[at] = hash;
    t->count[at]++;
    t->newest[at] = place;
}

void name_tally_remove(name_tally *t, const char *name)
{
    if (t->lost || t->size == 0)
        return;
    const size_t at = entry_of(t, hash_of(name));
    if (t->count[at] > 0)
        t->count[at]--;
}

size_t name_tally_most(const name_tally *t, const char *name)
{
    if (t->lost)
        return SIZE_MAX;
    return t->size ? t->count[entry_of(t, hash_of(name))] : 0;
}

const name_place *name_tally_newest(const name_tally *t, const char *name)
{
    const size_t at = t->lost || t->size == 0 ? 0 : entry_of(t, hash_of(name));
    return t->lost || t->size == 0 || t->count[at] == 0 ? NULL : &t->newest[at];
}

void name_tally_move(name_tally *t, const char *name, name_place to)
{
    if (!t->lost && t->size > 0)
        t->newest[entry_of(t, hash_of(name))] = to;
}

void name_tally_clear(name_tally *t)
{
    free(t->hash);
    free(t->count);
    free(t->newest);
    *t = (name_tally){.lost = t->lost};
}

/* --- suggestions --- */

static bool is_number(const char *text)
{
    double value;
    return number_parse_real(text, &value);
}

static const char *word_in(const char *word, const char *const *words, size_t count)
{
    for (size_t i = 0; i < count; i++)
        if (strcmp(words[i], word) == 0)
            return words[i];
    return NULL;
}

/* Names that other programs or earlier versions use for our parameters. */
static const char *by_alias(const char *wrong, const char *const *words, size_t count)
{
    static const char *const aliases[][2] = {
        {"n", "ior"},
        {"index", "ior"},
        {"refractive_index", "ior"},
        {"opacity", "transparency"},
        {"type", "shape"},
        {"kind", "shape"},
        {"alpha", "transparency"},
        {"colour", "color"},
        {"light", "lights"},
        {"objects", "solids"},
        {"shapes", "solids"},
        {"spheres", "solids"},
        {"picture", "image"},
        {"pieces", "tiles_per_worker"},
        {"min_share", "min_fraction"},
    };
    for (size_t i = 0; i < sizeof aliases / sizeof *aliases; i++)
        if (strcasecmp(aliases[i][0], wrong) == 0)
            return word_in(aliases[i][1], words, count);
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
    enum { LENGTH_MIN = 3 }; /* characters */
    const char *meant = by_alias(wrong, words, count);
    if (meant || strlen(wrong) < LENGTH_MIN || is_number(wrong))
        return meant;
    meant = by_beginning(wrong, words, count);
    return meant ? meant : text_nearest(wrong, words, count);
}

/* A list that does not fit ends with dots after a complete word. */
void suggest_list(const char *prefix, const char *const *words, size_t count, char *text, size_t size)
{
    static const char more[] = ", ...";
    int used = snprintf(text, size, "%s", prefix);
    size_t fits = 0; /* length of the longest text after which the dots fit */
    for (size_t i = 0; i < count && used >= 0 && (size_t)used < size; i++) {
        if ((size_t)used + sizeof more <= size)
            fits = (size_t)used;
        used += snprintf(text + used, size - (size_t)used, "%s%s", i ? ", " : "", words[i]);
    }
    if (used >= 0 && (size_t)used >= size && fits > 0)
        snprintf(text + fits, size - fits, "%s", more);
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
