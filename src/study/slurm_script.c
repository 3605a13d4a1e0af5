/* The script of an array job. */
#include "base/text.h"
#include "study/slurm.h"
#include <stdlib.h>
#include <string.h>

/* Embedded by the assembler. */
__asm__(".pushsection .rodata\n.globl slurm_template\n.hidden slurm_template\nslurm_template: "
        ".incbin \"experiments/cluster/study.slurm\"\n.byte 0\n.popsection");

static void put_quoted(FILE *out, const char *value)
{
    static const char plain[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_./:,+-";
    if (value[0] && !value[strspn(value, plain)]) {
        fputs(value, out);
        return;
    }
    fputc('\'', out);
    for (; *value; value++)
        fputs(*value == '\'' ? "'\\''" : (const char[]){*value, 0}, out);
    fputc('\'', out);
}

/* The word that begins at an @ sign, without the signs; 0: this is another @ sign. */
static size_t word_length(const char *at)
{
    const size_t length = strspn(at + 1, "abcdefghijklmnopqrstuvwxyz_");
    return at[1 + length] == '@' ? length : 0;
}

static const slurm_word *find_word(const slurm_word *words, size_t count, const char *name, size_t length)
{
    for (size_t i = 0; i < count; i++)
        if (strlen(words[i].name) == length && memcmp(words[i].name, name, length) == 0)
            return &words[i];
    return NULL;
}

static status unknown_word(const slurm_word *words, size_t count, const char *name, size_t length, diagnostic *why)
{
    char known[300] = "use one of ";
    for (size_t i = 0, used = strlen(known); i < count && used < sizeof known; i++)
        used += (size_t)snprintf(known + used, sizeof known - used, "%s%s", i ? ", " : "", words[i].name);
    return diagnose(why, STATUS_BAD_INPUT, known, "unknown word @%.*s@", (int)length, name);
}

/* Writes a line, without its newline; *left_out: it has a word without a value, and is not written. */
static status put_line(FILE *out, const char *line, size_t size, const slurm_word *words, size_t count, bool *left_out,
                       diagnostic *why)
{
    for (const char *at = line; !*left_out && (at = memchr(at, '@', size - (size_t)(at - line)));) {
        const size_t length = word_length(at);
        const slurm_word *word = find_word(words, count, at + 1, length);
        if (length && !word) {
            diagnostic_locate(why, NULL, 0, at - line + 1);
            return unknown_word(words, count, at + 1, length, why);
        }
        *left_out = word && !word->value;
        at += length ? length + 2 : 1;
    }
    for (size_t i = 0; !*left_out && i < size;) {
        const size_t length = line[i] == '@' ? word_length(line + i) : 0;
        if (length)
            put_quoted(out, find_word(words, count, line + i + 1, length)->value);
        else
            fputc(line[i], out);
        i += length ? length + 2 : 1;
    }
    return STATUS_OK;
}

status slurm_fill(const char *file, const char *text, const slurm_word *words, size_t count, char **out,
                  diagnostic *why)
{
    text_writer writer;
    long line = 1;
    *out = NULL;
    TRY(text_writer_open(&writer, why));
    status code = STATUS_OK;
    for (; *text && code == STATUS_OK; line++) {
        const size_t size = strcspn(text, "\n");
        bool left_out = false;
        diagnostic error = {.what = ""};
        code = put_line(writer.stream, text, size, words, count, &left_out, &error);
        if (code != STATUS_OK && why) {
            *why = error;
            diagnostic_locate(why, file, line, error.column);
        }
        text += size;
        if (*text == '\n') {
            if (!left_out)
                fputc('\n', writer.stream);
            text++;
        }
    }
    return text_writer_end(&writer, code, out, NULL, why);
}
