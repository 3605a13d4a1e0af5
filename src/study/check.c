#include "study/check.h"
#include "base/hash.h"
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static bool is_missing(const char *field)
{
    return field[0] == 'N' && field[1] == 'A' && field[2] == 0;
}

status check_columns_create(char *const *names, size_t count, check_columns *out, diagnostic *why)
{
    *out = (check_columns){malloc((count + 1) * sizeof *out->name), count};
    if (!out->name)
        return out_of_memory(why);
    for (size_t i = 0; i < count; i++)
        out->name[i] = strcmp(names[i], "check") == 0 ? 0 : hash_bytes(HASH_START, names[i], strlen(names[i]) + 1);
    return STATUS_OK;
}

void check_columns_free(check_columns *c)
{
    free(c->name);
    *c = (check_columns){0};
}

/* A sum, because the order of columns is not part of a row. */
uint64_t check_values(const check_columns *c, char *const *fields)
{
    uint64_t sum = 0;
    for (size_t i = 0; i < c->count; i++)
        if (c->name[i] && !is_missing(fields[i]))
            sum += hash_finish(hash_bytes(c->name[i], fields[i], strlen(fields[i])));
    return hash_finish(sum);
}

uint32_t check_content(const check_columns *c, char *const *fields)
{
    return (uint32_t)(check_values(c, fields) >> 32);
}

uint32_t check_chain(const char *previous, uint32_t content)
{
    const int64_t word = content;
    return (uint32_t)(hash_finish(hash_words(hash_bytes(HASH_START, previous, strlen(previous)), &word, 1)) >> 32);
}

void check_text(uint32_t content, uint32_t chain, char text[CHECK_TEXT])
{
    snprintf(text, CHECK_TEXT, "%08" PRIx32 "%08" PRIx32, content, chain);
}

bool check_parse(const char *text, uint32_t *content, uint32_t *chain)
{
    if (strlen(text) != CHECK_TEXT - 1 || strspn(text, "0123456789abcdef") != CHECK_TEXT - 1)
        return false;
    const uint64_t both = strtoull(text, NULL, 16);
    *content = (uint32_t)(both >> 32);
    *chain = (uint32_t)both;
    return true;
}

static status check_line(const check_columns *c, char previous[CHECK_TEXT], const char *line, size_t size,
                         char **fields, csv_line *out, diagnostic *why)
{
    char *copy = strndup(line, size);
    const bool split = copy && csv_split(copy, fields) == c->count;
    if (split) {
        const uint32_t content = check_content(c, fields);
        check_text(content, check_chain(previous, content), previous);
        for (size_t i = 0; i < c->count; i++)
            csv_text(out, c->name[i] ? fields[i] : previous);
        csv_end(out);
    }
    free(copy);
    return split && !out->failed ? STATUS_OK : out_of_memory(why);
}

status check_lines(const check_columns *c, char previous[CHECK_TEXT], csv_line *lines, diagnostic *why)
{
    csv_line out = {0};
    char **fields = malloc((lines->size + 1) * sizeof *fields);
    status code = fields && !lines->failed ? STATUS_OK : out_of_memory(why);
    for (size_t at = 0; code == STATUS_OK && at < lines->size;) {
        const size_t length = strcspn(lines->text + at, "\n");
        code = check_line(c, previous, lines->text + at, length, fields, &out, why);
        at += length + 1;
    }
    free(fields);
    csv_line_free(lines);
    *lines = out;
    return code;
}
