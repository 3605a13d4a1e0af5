/* Readers of small files in /proc and /sys. */
#include "measure/small_file.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

bool small_file_read(const char *root, const char *path, char *text, size_t size)
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

int64_t small_file_field(const char *text, const char *key)
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
