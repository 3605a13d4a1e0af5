/* Readers of small files in /proc and /sys, and the parser of /proc/stat. */
#include "measure/proc_file.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

bool proc_file_read(const char *root, const char *path, char *text, size_t size)
{
    char full[512];
    text[0] = '\0';
    int length = snprintf(full, sizeof full, "%s%s", root, path);
    if (length < 0 || (size_t)length >= sizeof full) {
        errno = ENAMETOOLONG;
        return false;
    }
    int file = open(full, O_RDONLY | O_CLOEXEC);
    if (file < 0)
        return false;

    size_t used = 0;
    ssize_t got = 0;
    while (used + 1 < size && ((got = read(file, text + used, size - 1 - used)) > 0 || (got < 0 && errno == EINTR)))
        used += got > 0 ? (size_t)got : 0;
    const int error = errno;
    close(file);
    errno = error;
    text[used] = '\0';
    return got >= 0;
}

int64_t proc_file_field(const char *text, const char *key)
{
    size_t length = strlen(key);
    for (const char *line = text; line; line = strchr(line, '\n')) {
        if (*line == '\n')
            line++;
        if (strncmp(line, key, length) == 0 && line[length] == ':') {
            char *end;
            const char *digits = line + length + 1;
            long long value = strtoll(digits, &end, 10);
            return end == digits ? -1 : (int64_t)value;
        }
    }
    return -1;
}

/* ---- /proc/stat ---- */

/* The columns of a line "cpu ". Guest time, which follows, is already included in user and nice. */
enum { USER, NICE, SYSTEM, IDLE, IOWAIT, IRQ, SOFTIRQ, STEAL, COLUMNS };

static const char *next_line(const char *at)
{
    const char *end = strchr(at, '\n');
    return end ? end + 1 : at + strlen(at);
}

static int read_columns(const char *at, double ticks[COLUMNS])
{
    int count = 0;
    for (; count < COLUMNS; count++) {
        while (*at == ' ')
            at++;
        if (*at < '0' || *at > '9')
            break;
        char *end;
        ticks[count] = (double)strtoull(at, &end, 10);
        at = end;
    }
    return count;
}

bool proc_stat_parse(const char *text, double ticks_per_s, proc_stat *out)
{
    double ticks[COLUMNS] = {0};
    bool found = false;
    int units = 0;
    for (const char *line = text; *line != '\0'; line = next_line(line)) {
        if (strncmp(line, "cpu", 3) != 0)
            continue;
        if (line[3] == ' ')
            found = read_columns(line + 4, ticks) > IDLE;
        else if (line[3] >= '0' && line[3] <= '9')
            units++;
    }

    double busy = ticks[USER] + ticks[NICE] + ticks[SYSTEM] + ticks[IRQ] + ticks[SOFTIRQ] + ticks[STEAL];
    double idle = ticks[IDLE] + ticks[IOWAIT];
    if (!found || busy + idle == 0.0 || !(ticks_per_s > 0.0))
        return false;
    *out = (proc_stat){.busy_s = busy / ticks_per_s,
                       .idle_s = idle / ticks_per_s,
                       .steal_s = ticks[STEAL] / ticks_per_s,
                       .units = units};
    return true;
}
