/* Writes scalars so that YAML readers return the same text, and makes paths relative to a file. */
#include "base/text.h"
#include "scene/file/write.h"

#include <errno.h>
#include <limits.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <unistd.h>

/* --- scalars --- */

status write_check_text(const char *label, const char *text, diagnostic *why)
{
    uint32_t c;
    for (size_t length; *text; text += length) {
        length = text_utf8(text, &c);
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
static bool is_reserved(const char *text)
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
    if (!letter || is_reserved(text) || text[length - 1] == ' ' || text[length - 1] == ':' || strstr(text, ": ") ||
        strstr(text, " #"))
        return false;
    uint32_t c;
    for (size_t step; *text; text += step) {
        step = text_utf8(text, &c);
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
        length = text_utf8(text, &c);
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

/* --- paths --- */

/* The folder of a file, absolute and without links; a folder that does not exist is only made absolute. NULL if memory
 * runs out. */
static char *real_folder(const char *file)
{
    const char *slash = strrchr(file, '/');
    char *folder = slash ? strndup(file, (size_t)(slash - file) + 1) : strdup("."), here[PATH_MAX];
    char *real = folder ? realpath(folder, NULL) : NULL;
    if (folder && !real && errno != ENOMEM) /* the folder does not exist, or not yet */
        real = folder[0] != '/' && getcwd(here, sizeof here) ? text_format("%s/%s", here, folder) : strdup(folder);
    free(folder);
    for (size_t length = real ? strlen(real) : 0; length > 1 && real[length - 1] == '/'; length--)
        real[length - 1] = 0;
    return real;
}

/* Joins folder and path; each "../" at the start of path removes a part of folder, which has no links. */
static char *join(const char *folder, const char *path)
{
    size_t length = strcmp(folder, "/") == 0 ? 0 : strlen(folder);
    for (;;) {
        if (strncmp(path, "./", 2) == 0) {
            path += 2;
        } else if (*path == '/') {
            path++;
        } else if (strncmp(path, "../", 3) == 0) {
            path += 3;
            while (length > 0 && folder[--length] != '/') {
            }
        } else {
            return text_format("%.*s/%s", (int)length, folder, path);
        }
    }
}

/* Makes an absolute path relative to a folder; it stays absolute if they have only the root in common. */
static char *relative(const char *path, const char *folder)
{
    size_t common = 0; /* bytes, including the last slash */
    size_t at = 0;
    for (; path[at] && path[at] == folder[at]; at++)
        common = path[at] == '/' ? at + 1 : common;
    if (!folder[at] && path[at] == '/') /* folder is a prefix of path */
        return text_format("%s%s", path[at + 1] == ' ' ? "./" : "", path + at + 1);
    if (common <= 1)
        return strdup(path);
    char *steps = strdup("");
    for (const char *rest = folder + common; steps && rest; rest = strchr(rest, '/')) {
        rest += *rest == '/';
        char *longer = text_format("%s../", steps);
        free(steps);
        steps = longer;
    }
    char *text = steps ? text_format("%s%s", steps, path + common) : NULL;
    free(steps);
    return text;
}

status write_moved_path(const char *path, const char *old_file, const char *new_file, char **moved, diagnostic *why)
{
    char *from = real_folder(old_file), *to = real_folder(new_file);
    char *joined = from ? join(from, path) : NULL;
    const bool stays = path[0] == '/' || (from && to && strcmp(from, to) == 0);
    *moved = stays ? strdup(path) : joined && to ? relative(joined, to) : NULL;
    free(from);
    free(to);
    free(joined);
    return *moved ? STATUS_OK : out_of_memory(why);
}
