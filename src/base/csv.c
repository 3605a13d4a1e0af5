/* Writing lines and reading tables of comma-separated values. */
#include "base/csv.h"
#include "base/file.h"
#include "base/number.h"
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { CSV_BYTES_MAX = 1 << 30 };

static void add(csv_buffer *line, const char *bytes, size_t count)
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

static void separate(csv_buffer *line)
{
    if (line->started)
        add(line, ",", 1);
    line->started = true;
}

void csv_text(csv_buffer *line, const char *text)
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

void csv_real(csv_buffer *line, double value)
{
    char text[NUMBER_TEXT_MAX];
    csv_text(line, isnan(value) ? NULL : number_format(value, text));
}

void csv_count(csv_buffer *line, int64_t value)
{
    char text[NUMBER_TEXT_MAX];
    snprintf(text, sizeof text, "%" PRId64, value);
    csv_text(line, value < 0 ? NULL : text);
}

void csv_hash(csv_buffer *line, uint64_t value)
{
    char text[NUMBER_TEXT_MAX];
    snprintf(text, sizeof text, "%016" PRIx64, value);
    csv_text(line, text);
}

void csv_end(csv_buffer *line)
{
    add(line, "\n", 1);
    line->started = false;
}

void csv_buffer_free(csv_buffer *line)
{
    free(line->text);
    *line = (csv_buffer){0};
}

/* csv_split that stores at most `most` fields. */
static size_t split_first(char *text, char **fields, size_t most)
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
        if (count < most)
            fields[count] = field;
        count++;
        if (last)
            return count;
    }
}

size_t csv_split(char *line, char **fields)
{
    return split_first(line, fields, fields ? SIZE_MAX : 0);
}

static status damaged(const char *path, long line, diagnostic *why)
{
    diagnostic_locate(why, path, line, 1);
    return diagnose(why, STATUS_BAD_INPUT,
                    line == 1 ? "move the file away, or correct this line in a copy"
                              : "move the file away, or correct or remove this line in a copy",
                    line == 1 ? "the header is damaged" : "the row is damaged");
}

/* Finds the starts of the lines, and replaces the newlines of the copy by 0. Returns the number of lines. */
static size_t find_lines(csv *table)
{
    size_t lines = 0;
    for (const char *at = table->raw, *end = at + table->complete_size;
         at < end && (at = memchr(at, '\n', (size_t)(end - at))); at++)
        lines++;
    table->start = malloc((lines + 1) * sizeof *table->start);
    table->split = malloc(table->complete_size + 1);
    table->broken = calloc(lines + 1, sizeof *table->broken);
    if (!table->start || !table->split || !table->broken)
        return 0;
    memcpy(table->split, table->raw, table->complete_size);
    size_t line = 0;
    for (char *at = table->split, *end = at + table->complete_size;
         at < end && (at = memchr(at, '\n', (size_t)(end - at))); at++) {
        *at = 0;
        table->start[line++] = (size_t)(at - table->split) + 1;
    }
    return lines;
}

static bool split_row(csv *table, size_t row)
{
    static char missing[] = "NA";
    char **fields = table->fields + row * table->column_count;
    const bool complete = !memchr(table->raw + table->start[row], 0, table->start[row + 1] - table->start[row]);
    if (complete && split_first(table->split + table->start[row], fields, table->column_count) == table->column_count)
        return true;
    for (size_t i = 0; i < table->column_count; i++)
        fields[i] = missing;
    table->broken[row] = true;
    return false;
}

/* Splits the rows into fields; strict: a broken row is an error. */
static status split_all(csv *table, const char *path, bool strict, diagnostic *why)
{
    if (table->complete_size == 0)
        return STATUS_OK;
    const size_t lines = find_lines(table);
    if (lines == 0)
        return out_of_memory(why);
    size_t most = 1;
    for (const char *at = table->split; *at; at++)
        most += *at == ',';
    char **header = malloc(most * sizeof *header);
    if (!header)
        return out_of_memory(why);
    table->row_count = lines - 1;
    table->column_count = strlen(table->split) + 1 == table->start[0] ? csv_split(table->split, header) : 0;
    if (table->column_count > 0)
        table->header = malloc(lines * table->column_count * sizeof *table->header);
    if (table->header)
        memcpy(table->header, header, table->column_count * sizeof *header);
    free(header);
    if (table->column_count == 0)
        return damaged(path, 1, why);
    if (!table->header)
        return out_of_memory(why);
    table->fields = table->header + table->column_count;
    for (size_t row = 0; row < table->row_count; row++)
        if (!split_row(table, row) && strict)
            return damaged(path, (long)row + 2, why);
    return STATUS_OK;
}

size_t csv_complete_size(const char *text, size_t size)
{
    const char *newline = size ? memrchr(text, '\n', size) : NULL;
    if (!newline)
        return 0;
    const char *before = memrchr(text, '\n', (size_t)(newline - text)), *start = before ? before + 1 : text;
    return (size_t)((memchr(start, 0, (size_t)(newline - start)) ? start : newline + 1) - text);
}

typedef enum reading { READ_OWN, READ_ANY, READ_ROWS } reading;

static const char byte_order_mark[] = "\xEF\xBB\xBF";

static bool is_marked(const csv *table)
{
    return table->size >= 3 && memcmp(table->raw, byte_order_mark, 3) == 0;
}

static bool has_carriage_returns(const csv *table)
{
    const char *newline = table->size ? memchr(table->raw, '\n', table->size) : NULL;
    return newline && newline > table->raw && newline[-1] == '\r';
}

/* Refuses rows that a spreadsheet, an editor or a checkout of git with other line ends has converted. */
static status check_form(const csv *table, const char *path, diagnostic *why)
{
    if (is_marked(table))
        return diagnose_at(why, path, STATUS_BAD_INPUT, "remove it: sed -i '1s/^\\xEF\\xBB\\xBF//' FILE",
                           "the file begins with a byte order mark: another program has written it");
    if (has_carriage_returns(table))
        return diagnose_at(why, path, STATUS_BAD_INPUT, "convert it: sed -i 's/\\r$//' FILE",
                           "the file has the line ends of Windows (CR LF): another program has written it");
    return STATUS_OK;
}

/* The number of fields of the line from `start` to `end`; 0 for invalid quotes. */
static size_t fields_of(const char *start, const char *end, diagnostic *why)
{
    char *copy = strndup(start, (size_t)(end - start));
    const size_t count = copy ? csv_split(copy, NULL) : 0;
    if (!copy)
        (void)out_of_memory(why);
    free(copy);
    return count;
}

/* Converts the bytes to the form that this program writes. */
static status mend(csv *table, diagnostic *why)
{
    char *bytes = malloc(table->size + 2), *to = bytes;
    if (!bytes)
        return out_of_memory(why);
    const char *from = table->raw + (is_marked(table) ? 3 : 0), *end = table->raw + table->size;
    for (; from < end; from++)
        if (*from != '\r' || (from + 1 < end && from[1] != '\n'))
            *to++ = *from;
    while (to > bytes + 1 && to[-1] == '\n' && to[-2] == '\n')
        to--;
    const char *last = memrchr(bytes, '\n', (size_t)(to - bytes)),
               *first_end = memchr(bytes, '\n', (size_t)(to - bytes));
    /* Adds a missing last newline if the last line is complete: as many fields as the first, and no byte 0. A file that
     * is one line without a newline has no row, and is left: its program may have been killed while it wrote. */
    if (first_end && to[-1] != '\n' && fields_of(bytes, first_end, why) == fields_of(last + 1, to, why) &&
        !memchr(last + 1, 0, (size_t)(to - last - 1)))
        *to++ = '\n';
    const size_t size = (size_t)(to - bytes);
    table->mended = size != table->size || memcmp(bytes, table->raw, size) != 0;
    *to = 0;
    free(table->raw);
    table->raw = bytes;
    table->size = size;
    return STATUS_OK;
}

static status read_table(const char *path, const char *root, reading how, csv **out, diagnostic *why)
{
    *out = NULL;
    if (access(path, F_OK) != 0)
        return STATUS_OK;
    csv *table = calloc(1, sizeof *table);
    if (!table)
        return out_of_memory(why);
    status code = file_read_below(path, root, CSV_BYTES_MAX, &table->raw, &table->size, why);
    if (code == STATUS_OK && how != READ_OWN)
        code = how == READ_ANY ? mend(table, why) : check_form(table, path, why);
    if (code == STATUS_OK) {
        table->complete_size = csv_complete_size(table->raw, table->size);
        table->torn = table->complete_size < table->size;
        code = split_all(table, path, how != READ_ROWS, why);
    }
    if (code != STATUS_OK) {
        csv_destroy(table);
        return code;
    }
    *out = table;
    return STATUS_OK;
}

status csv_read(const char *path, csv **out, diagnostic *why)
{
    return read_table(path, NULL, READ_OWN, out, why);
}

status csv_read_any(const char *path, const char *root, csv **out, diagnostic *why)
{
    return read_table(path, root, READ_ANY, out, why);
}

status csv_read_rows(const char *path, const char *root, csv **out, diagnostic *why)
{
    return read_table(path, root, READ_ROWS, out, why);
}

void csv_destroy(csv *table)
{
    if (!table)
        return;
    free(table->raw);
    free(table->split);
    free(table->header);
    free(table->start);
    free(table->broken);
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
