/* Diagnostics: their text and position; and the meaning of system errors. */
#include "base/status.h"

#include <errno.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

/* Replaces ASCII control characters and the C1 controls of Unicode (UTF-8 C2 80 .. C2 9F), which terminals also
 * interpret. */
static void make_one_line(char *text)
{
    for (unsigned char *c = (unsigned char *)text; *c; c++) {
        if (*c < 0x20 || *c == 0x7f) {
            *c = '?';
        } else if (c[0] == 0xc2 && c[1] >= 0x80 && c[1] <= 0x9f) {
            c[0] = '?';
            c[1] = '?';
        }
    }
}

/* Drops a UTF-8 sequence truncated by the end of the buffer. */
static void drop_cut_sequence(char *text)
{
    size_t length = strlen(text), start = length;
    while (start > 0 && length - start < 4 && ((unsigned char)text[start - 1] & 0xc0) == 0x80)
        start--;
    if (start == 0 || (unsigned char)text[start - 1] < 0xc0)
        return;
    unsigned char lead = (unsigned char)text[start - 1];
    size_t needed = lead >= 0xf0 ? 3 : lead >= 0xe0 ? 2 : 1;
    if (length - start < needed)
        text[start - 1] = 0;
}

static void copy_line(char *to, size_t size, const char *from)
{
    if (snprintf(to, size, "%s", from) >= (int)size)
        drop_cut_sequence(to);
    make_one_line(to);
}

static status fill(diagnostic *why, status code, const char *remedy, const char *what, va_list arguments)
{
    if (!why)
        return code;
    /* Through copies, because the arguments may point into *why itself. */
    char what_text[sizeof why->what + 1], remedy_text[sizeof why->remedy];
    copy_line(remedy_text, sizeof remedy_text, remedy ? remedy : "");
    if (vsnprintf(what_text, sizeof what_text, what, arguments) < 0)
        what_text[0] = 0;
    copy_line(why->what, sizeof why->what, what_text);
    memcpy(why->remedy, remedy_text, sizeof remedy_text);
    return code;
}

status diagnose(diagnostic *why, status code, const char *remedy, const char *what, ...)
{
    va_list arguments;
    va_start(arguments, what);
    fill(why, code, remedy, what, arguments);
    va_end(arguments);
    return code;
}

status out_of_memory(diagnostic *why)
{
    return diagnose(why, STATUS_FAILURE, MEMORY_REMEDY, "out of memory");
}

void diagnostic_locate(diagnostic *why, const char *file, long line, long column)
{
    if (!why)
        return;
    char name[sizeof why->file];
    copy_line(name, sizeof name, file ? file : "");
    memcpy(why->file, name, sizeof name);
    why->line = line > 0 ? line : 0;
    why->column = column > 0 ? column : 0;
}

status diagnose_at(diagnostic *why, const char *place, status code, const char *remedy, const char *what, ...)
{
    va_list arguments;
    va_start(arguments, what);
    fill(why, code, remedy, what, arguments);
    va_end(arguments);
    diagnostic_locate(why, place, 0, 0);
    return code;
}

status locate_failure(diagnostic *why, const char *place, status code)
{
    if (code != STATUS_OK)
        diagnostic_locate(why, place, 0, 0);
    return code;
}

char *diagnostic_text(const diagnostic *why, char *text, size_t size)
{
    char line[24] = "", column[24] = "";
    if (why->line > 0) {
        snprintf(line, sizeof line, "%s%ld", why->file[0] ? ":" : "", why->line);
        if (why->column > 0)
            snprintf(column, sizeof column, ":%ld", why->column);
    }
    bool located = why->file[0] || line[0];
    snprintf(text, size, "%s%s%s%s%s%s%s", why->file, line, column, located ? ": " : "", why->what,
             why->remedy[0] ? "; " : "", why->remedy);
    return text;
}

/* ---- system errors ---- */

const char *system_remedy(int error)
{
    switch (error) {
    case ENOSPC:
    case EDQUOT: return "free some space or choose another disk";
    case EFBIG: return "raise the limit on file size (ulimit -f)";
    case EMFILE: return "raise the limit on open files (ulimit -n)";
    case ENFILE: return "close other programs";
    case EAGAIN: return "close other programs, or raise the limit on processes (ulimit -u)";
    case EINTR: return "run the command again";
    case EIO: return "check the disk (dmesg), or choose another";
    case EACCES:
    case EPERM:
    case EROFS: return "change the permissions or choose another folder";
    case ENOENT: return "check the path";
    default: return NULL;
    }
}

static bool is_fault_of_machine(int error)
{
    return error == ENOSPC || error == EDQUOT || error == EFBIG || error == EMFILE || error == ENFILE || error == EIO ||
           error == EAGAIN;
}

/* strerrordesc_np and not strerror, which is not thread-safe and depends on the locale. */
status system_error(diagnostic *why, status otherwise, const char *path, const char *doing, int error,
                    const char *advice)
{
    const char *reason = strerrordesc_np(error), *remedy = system_remedy(error);
    if (path)
        diagnostic_locate(why, path, 0, 0);
    if (error == ENOMEM)
        return out_of_memory(why);
    return diagnose(why, is_fault_of_machine(error) ? STATUS_FAILURE : otherwise, remedy ? remedy : advice, "%s: %s",
                    doing, reason ? reason : "unknown error");
}
