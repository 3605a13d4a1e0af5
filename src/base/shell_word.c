/* Quoting for a POSIX shell. */
#include "base/shell_word.h"

#include <string.h>

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
