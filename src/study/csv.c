#include "study/csv.h"
#include "base/file.h"
#include "base/number.h"
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { CSV_BYTES_MAX = 1 << 30 };

static void add(csv_line *line, const char *bytes, size_t count)
{
    if (line->failed)
        return;
    if (line->size + count + 1 > line->capacity) {
        size_t capacity = 2 * (line->size + count + 1);
        char *text = realloc(line->text, capacity);
        if (!text) {
            line->failed = true;
            return;
        }
        line->text = text;
        line->capacity = capacity;
    }
    memcpy(line->text + line->size, bytes, count);
    line->size += count;
    line->text[line->size] = 0;
}

static void separate(csv_line *line)
{
    if (line->started)
        add(line, ",", 1);
    line->started = true;
}

void csv_text(csv_line *line, const char *text)
{
    separate(line);
    if (!text)
        text = "NA";
    if (!strpbrk(text, ",;\" ")) {
        add(line, text, strlen(text));
        return;
    }
    add(line, "\"", 1);
    for (const char *quote; (quote = strchr(text, '"')); text = quote + 1) {
        add(line, text, (size_t)(quote - text));
        add(line, "\"\"", 2);
    }
    add(line, text, strlen(text));
    add(line, "\"", 1);
}

void csv_real(csv_line *line, double value)
{
    char text[NUMBER_TEXT_MAX];
    csv_text(line, isnan(value) ? NULL : number_format(value, text));
}

void csv_count(csv_line *line, int64_t value)
{
    char text[NUMBER_TEXT_MAX];
    snprintf(text, sizeof text, "%" PRId64, value);
    csv_text(line, value < 0 ? NULL : text);
}

void csv_hash(csv_line *line, uint64_t value)
{
    char text[NUMBER_TEXT_MAX];
    snprintf(text, sizeof text, "%016" PRIx64, value);
    csv_text(line, text);
}

void csv_end(csv_line *line)
{
    add(line, "\n", 1);
    line->started = false;
}

void csv_line_free(csv_line *line)
{
    free(line->text);
    *line = (csv_line){0};
}

size_t csv_split(char *text, char **fields)
{
    size_t count = 0;
    for (char *read = text;; read++) {
        char *field = read, *write = read;
        if (*read == '"') {
            for (read++; *read; *write++ = *read++) {
                if (*read == '"' && read[1] != '"')
                    break;
                read += *read == '"';
            }
            if (*read++ != '"')
                return 0;
        } else {
            for (; *read && *read != ','; read++, write++)
                if (*read == '"')
                    return 0;
        }
        if (*read && *read != ',')
            return 0;
        bool last = !*read;
        *write = 0;
        if (fields)
            fields[count] = field;
        count++;
        if (last)
            return count;
    }
}

static status damaged(const char *path, long line, diagnostic *why)
{
    diagnostic_locate(why, path, line, 1);
    return diagnose(why, STATUS_BAD_INPUT, "move the file away, or use a copy without this line", "the row is damaged");
}

/* Finds the row starts and splits the rows into fields. */
static status split_all(csv *table, const char *path, diagnostic *why)
{
    size_t lines = 0, places = 0; /* upper bound of the number of fields: quoted commas are counted as well */
    for (size_t i = 0; i < table->whole; i++) {
        lines += table->raw[i] == '\n';
        places += table->raw[i] == '\n' || table->raw[i] == ',';
    }
    if (lines == 0)
        return STATUS_OK;
    if (memchr(table->raw, 0, table->whole))
        return damaged(path, 1, why);
    table->start = malloc(lines * sizeof *table->start);
    table->split = malloc(table->whole);
    table->header = calloc(places, sizeof *table->header);
    if (!table->start || !table->split || !table->header)
        return out_of_memory(why);
    memcpy(table->split, table->raw, table->whole);
    for (size_t i = 0, line = 0; i < table->whole; i++)
        if (table->raw[i] == '\n') {
            table->split[i] = 0;
            table->start[line++] = i + 1;
        }
    table->row_count = lines - 1;
    table->column_count = csv_split(table->split, table->header);
    table->fields = table->header + table->column_count;
    if (table->column_count == 0)
        return damaged(path, 1, why);
    for (size_t row = 0; row < table->row_count; row++)
        if (csv_split(table->split + table->start[row], table->fields + row * table->column_count) !=
            table->column_count)
            return damaged(path, (long)row + 2, why);
    return STATUS_OK;
}

status csv_read(const char *path, csv **out, diagnostic *why)
{
    return csv_read_below(path, NULL, out, why);
}

status csv_read_below(const char *path, const char *root, csv **out, diagnostic *why)
{
    *out = NULL;
    if (access(path, F_OK) != 0)
        return STATUS_OK;
    csv *table = calloc(1, sizeof *table);
    if (!table)
        return out_of_memory(why);
    status code = file_read_below(path, root, CSV_BYTES_MAX, &table->raw, &table->size, why);
    if (code == STATUS_OK) {
        const char *newline = table->size ? memrchr(table->raw, '\n', table->size) : NULL;
        table->whole = newline ? (size_t)(newline - table->raw) + 1 : 0;
        code = split_all(table, path, why);
    }
    if (code != STATUS_OK) {
        csv_destroy(table);
        return code;
    }
    *out = table;
    return STATUS_OK;
}

void csv_destroy(csv *table)
{
    if (!table)
        return;
    free(table->raw);
    free(table->split);
    free(table->header);
    free(table->start);
    free(table);
}

int csv_column(const csv *table, const char *name)
{
    for (size_t i = 0; table->header && i < table->column_count; i++)
        if (strcmp(table->header[i], name) == 0)
            return (int)i;
    return -1;
}

const char *csv_field(const csv *table, size_t row, int column)
{
    return column >= 0 ? table->fields[row * table->column_count + (size_t)column] : "NA";
}

double csv_field_real(const csv *table, size_t row, int column)
{
    double value;
    return column >= 0 && number_parse_real(csv_field(table, row, column), &value) ? value : NAN;
}
