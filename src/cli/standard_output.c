/* Standard output with writes of our own. */
#include "cli/standard_output.h"

#include "cli/terminal.h"

#include <errno.h>
#include <stdio.h>
#include <sys/types.h>
#include <unistd.h>

static int first_error;

static ssize_t write_all(void *unused, const char *bytes, size_t size)
{
    (void)unused;
    for (size_t done = 0; done < size;) {
        const ssize_t count = write(STDOUT_FILENO, bytes + done, size - done);
        if (count < 0 && errno == EINTR && !terminal_stop_requested())
            continue;
        if (count <= 0) {
            first_error = first_error ? first_error : count < 0 ? errno : ENOSPC;
            return 0; /* a failure, for a cookie's write */
        }
        done += (size_t)count;
    }
    return (ssize_t)size;
}

void standard_output_prepare(void)
{
    FILE *own = fopencookie(NULL, "w", (cookie_io_functions_t){.write = write_all});
    if (!own)
        return;
    setvbuf(own, NULL, isatty(STDOUT_FILENO) ? _IOLBF : _IOFBF, BUFSIZ);
    stdout = own;
}

int standard_output_error(void)
{
    return first_error;
}
