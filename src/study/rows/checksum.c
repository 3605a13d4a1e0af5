/* Hashes the values of a row by column name, and chains the checksums of the rows of a run. */
#include "base/hash.h"
#include "study/rows/rows.h"
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static bool is_missing(const char *field)
{
    return field[0] == 'N' && field[1] == 'A' && field[2] == 0;
}

status checksum_columns_create(char *const *names, size_t count, checksum_columns *out, diagnostic *why)
{
    *out = (checksum_columns){malloc((count + 1) * sizeof *out->name), count};
    if (!out->name)
        return out_of_memory(why);
    for (size_t i = 0; i < count; i++)
        out->name[i] = strcmp(names[i], "checksum") == 0 ? 0 : hash_bytes(HASH_START, names[i], strlen(names[i]) + 1);
    return STATUS_OK;
}

void checksum_columns_free(checksum_columns *c)
{
    free(c->name);
    *c = (checksum_columns){0};
}

/* A sum, because the order of columns is not part of a row. */
uint64_t checksum_values(const checksum_columns *c, char *const *fields)
{
    uint64_t sum = 0;
    for (size_t i = 0; i < c->count; i++)
        if (c->name[i] && !is_missing(fields[i]))
            sum += hash_finish(hash_bytes(c->name[i], fields[i], strlen(fields[i])));
    return hash_finish(sum);
}

uint32_t checksum_content(const checksum_columns *c, char *const *fields)
{
    return (uint32_t)(checksum_values(c, fields) >> 32);
}

uint32_t checksum_chain(const char *previous, uint32_t content)
{
    const int64_t word = content;
    return (uint32_t)(hash_finish(hash_words(hash_bytes(HASH_START, previous, strlen(previous)), &word, 1)) >> 32);
}

void checksum_text(uint32_t content, uint32_t chain, char text[CHECKSUM_TEXT])
{
    snprintf(text, CHECKSUM_TEXT, "%08" PRIx32 "%08" PRIx32, content, chain);
}

bool checksum_parse(const char *text, uint32_t *content, uint32_t *chain)
{
    if (strlen(text) != CHECKSUM_TEXT - 1 || strspn(text, "0123456789abcdef") != CHECKSUM_TEXT - 1)
        return false;
    const uint64_t both = strtoull(text, NULL, 16);
    *content = (uint32_t)(both >> 32);
    *chain = (uint32_t)both;
    return true;
}

static status checksum_line(const checksum_columns *c, char previous[CHECKSUM_TEXT], const char *line, size_t size,
                            char **fields, csv_buffer *out, diagnostic *why)
{
    char *copy = strndup(line, size);
    const bool split = copy && csv_split(copy, fields) == c->count;
    if (split) {
        const uint32_t content = checksum_content(c, fields);
        checksum_text(content, checksum_chain(previous, content), previous);
        for (size_t i = 0; i < c->count; i++)
            csv_text(out, c->name[i] ? fields[i] : previous);
        csv_end(out);
    }
    free(copy);
    return split && !out->failed ? STATUS_OK : out_of_memory(why);
}

status checksum_lines(const checksum_columns *c, char previous[CHECKSUM_TEXT], csv_buffer *lines, diagnostic *why)
{
    csv_buffer out = {0};
    char **fields = malloc((lines->size + 1) * sizeof *fields);
    status code = fields && !lines->failed ? STATUS_OK : out_of_memory(why);
    for (size_t at = 0; code == STATUS_OK && at < lines->size;) {
        const size_t length = strcspn(lines->text + at, "\n");
        code = checksum_line(c, previous, lines->text + at, length, fields, &out, why);
        at += length + 1;
    }
    free(fields);
    csv_buffer_free(lines);
    *lines = out;
    return code;
}
