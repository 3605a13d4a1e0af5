/* Rows of a table wrapped to the width of a terminal. */
#include "report/report.h"
#include <stdarg.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

enum { ROOM_MIN = 24, INDENT_BELOW = 4 }; /* characters: see wrap_row in wrap.h */

static bool starts_character(char byte)
{
    return ((unsigned char)byte & 0xc0) != 0x80;
}

static int width_of(const char *text, size_t bytes)
{
    int width = 0;
    for (size_t i = 0; i < bytes; i++)
        width += starts_character(text[i]);
    return width;
}

/* Bytes of the longest part of a word that fits into room: up to the last comma or slash, or else up to the last
 * character that fits. */
static size_t part_of_word(const char *word, size_t length, int room)
{
    size_t fits = 0, good = 0;
    int width = 0;
    for (size_t i = 0; i < length; i++) {
        width += starts_character(word[i]);
        if (width > room)
            break;
        if (i + 1 == length || starts_character(word[i + 1]))
            fits = i + 1;
        if (word[i] == ',' || word[i] == '/')
            good = i + 1;
    }
    return good ? good : fits;
}

/* Writes words wrapped between the columns indent and columns, and a newline. */
static void write_words(FILE *stream, const char *text, int indent, int columns)
{
    int column = indent;
    for (const char *word = text + strspn(text, " "); *word; word += strspn(word, " ")) {
        size_t length = strcspn(word, " ");
        if (column > indent && column + 1 + width_of(word, length) > columns) {
            fprintf(stream, "\n%*s", indent, "");
            column = indent;
        }
        if (column > indent)
            column += fprintf(stream, " ");
        while (columns > indent && width_of(word, length) > columns - column) {
            const size_t part = part_of_word(word, length, columns - column);
            fprintf(stream, "%.*s\n%*s", (int)part, word, indent, "");
            word += part, length -= part;
        }
        fprintf(stream, "%.*s", (int)length, word);
        column += width_of(word, length);
        word += length;
    }
    fputc('\n', stream);
}

static void write_wrapped(FILE *stream, int columns, const char *start, const char *text)
{
    size_t length = strlen(start);
    const int width = width_of(start, length);
    if (columns - width >= ROOM_MIN) {
        fputs(start, stream);
        write_words(stream, text, width, columns);
        return;
    }
    while (length > 0 && start[length - 1] == ' ')
        length--;
    if (length > 0 && width_of(start, length) <= columns)
        fprintf(stream, "%.*s\n", (int)length, start);
    else if (length > 0)
        write_words(stream, start, 0, columns);
    if (text[0]) {
        fprintf(stream, "%*s", INDENT_BELOW, "");
        write_words(stream, text, INDENT_BELOW, columns);
    }
}

void wrap_row(FILE *stream, int columns, const char *start, const char *format, ...)
{
    va_list arguments;
    char *text = NULL;
    if (columns > 0) {
        va_start(arguments, format);
        if (vasprintf(&text, format, arguments) < 0)
            text = NULL; /* without memory, the row is written unwrapped */
        va_end(arguments);
    }
    if (text) {
        write_wrapped(stream, columns, start, text);
    } else {
        va_start(arguments, format);
        fputs(start, stream);
        vfprintf(stream, format, arguments);
        fputc('\n', stream);
        va_end(arguments);
    }
    free(text);
}
