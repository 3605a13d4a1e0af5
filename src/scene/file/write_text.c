#include "scene/file/write_parts.h"

#include <stdbool.h>
#include <stdint.h>
#include <string.h>
#include <strings.h>

/* Decodes one UTF-8 character (RFC 3629); returns its length in bytes, 0 if it is invalid. */
static size_t decode(const char *text, uint32_t *out)
{
    const unsigned char *b = (const unsigned char *)text;
    static const uint32_t least[] = {0, 0, 0x80, 0x800, 0x10000};
    const size_t length = b[0] < 0x80 ? 1 : b[0] >> 5 == 6 ? 2 : b[0] >> 4 == 14 ? 3 : b[0] >> 3 == 30 ? 4 : 0;
    uint32_t c = length < 2 ? b[0] : b[0] & (0x7fu >> length);
    for (size_t i = 1; i < length; i++) {
        if ((b[i] & 0xc0) != 0x80)
            return 0;
        c = c << 6 | (b[i] & 0x3fu);
    }
    const bool right = length > 0 && c >= least[length] && c <= 0x10ffff && (c < 0xd800 || c > 0xdfff);
    *out = c;
    return right ? length : 0;
}

status write_check_text(const char *label, const char *text, diagnostic *why)
{
    uint32_t c;
    for (size_t length; *text; text += length) {
        length = decode(text, &c);
        if (!length)
            return diagnose(why, STATUS_BAD_INPUT, "rename it", "%.150s is not UTF-8, which a scene file requires",
                            label);
    }
    return STATUS_OK;
}

/* Characters allowed unescaped in YAML 1.1 (5.1), except line breaks. */
static bool is_printable(uint32_t c)
{
    return (c >= 0x20 && c < 0x7f) || (c >= 0xa0 && c <= 0xfffd && c != 0x2028 && c != 0x2029 && c != 0xfeff) ||
           c >= 0x10000;
}

/* Words that YAML 1.1 readers interpret as a boolean or as null. */
static bool is_taken(const char *text)
{
    static const char *const words[] = {"y", "n", "yes", "no", "on", "off", "true", "false", "null", "~"};
    for (size_t i = 0; i < sizeof words / sizeof *words; i++)
        if (strcasecmp(words[i], text) == 0)
            return true;
    return false;
}

/* Whether the text needs no quotes. Conservative: some texts are quoted unnecessarily. */
static bool is_plain(const char *text)
{
    const char first = text[0];
    const bool letter = (first >= 'a' && first <= 'z') || (first >= 'A' && first <= 'Z') || first == '_' ||
                        first == '/' || (first == '.' && (text[1] == '/' || text[1] == '.')) ||
                        (unsigned char)first >= 0x80;
    const size_t length = strlen(text);
    if (!letter || is_taken(text) || text[length - 1] == ' ' || text[length - 1] == ':' || strstr(text, ": ") ||
        strstr(text, " #"))
        return false;
    uint32_t c;
    for (size_t step; *text; text += step) {
        step = decode(text, &c);
        if (!step || !is_printable(c) || strchr("\"\\[]{}", (int)c))
            return false;
    }
    return true;
}

static void put_quoted(FILE *out, const char *text)
{
    fputc('"', out);
    uint32_t c;
    for (size_t length; *text; text += length) {
        length = decode(text, &c);
        if (c == '"' || c == '\\')
            fprintf(out, "\\%c", (int)c);
        else if (c == '\n')
            fputs("\\n", out);
        else if (is_printable(c))
            fwrite(text, 1, length, out);
        else
            fprintf(out, c < 0x100 ? "\\x%02X" : "\\u%04X", (unsigned)c);
        length += !length; /* also handles text that write_check_text refuses */
    }
    fputc('"', out);
}

void write_word(FILE *out, const char *text)
{
    if (is_plain(text))
        fputs(text, out);
    else
        put_quoted(out, text);
}

void write_list(FILE *out, const char *numbers)
{
    fputc('[', out);
    for (const char *c = numbers; *c; c++)
        if (*c == ',')
            fputs(", ", out);
        else if (*c != '[' && *c != ']')
            fputc(*c, out);
    fputc(']', out);
}
