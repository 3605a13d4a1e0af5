/* Terminal and signals of the program: stop request, checked standard output, colour, progress line. */
#include "cli/terminal.h"
#include "base/cancel.h"
#include "base/number.h"
#include "base/os_process.h"
#include "base/status.h"
#include "measure/clock.h"

#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdio_ext.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <sys/types.h>
#include <unistd.h>

static atomic_int stop_requested; /* the signal */
static _Atomic int64_t stop_ns;
static cancel_token token; /* of the main thread's work */

/* A second signal kills the process, unless it arrives within a fifth of a second, too soon for a second Ctrl-C:
 * timeout(1) and mpirun send their signal to the process and to its group. */
static void request_stop(int signal_number)
{
    const int64_t patience_ns = 200000000, now_ns = clock_wall_ns();
    if (atomic_load(&stop_requested) == 0) {
        atomic_store(&stop_ns, now_ns);
        atomic_store(&stop_requested, signal_number);
        cancel_set(&token);
    } else if (now_ns - atomic_load(&stop_ns) > patience_ns) {
        signal(signal_number, SIG_DFL);
        raise(signal_number);
    }
}

bool terminal_stopped_by_user(void)
{
    return stop_requested == SIGINT;
}

/* --- standard output through write_all --- */

/* An interrupted or short write is continued, and the errno of the first failed write is stored, which stdio
 * forgets. */

static int first_error; /* the errno of the first write that failed; 0: none */

static ssize_t write_all(void *unused, const char *bytes, size_t size)
{
    (void)unused;
    for (size_t done = 0; done < size;) {
        const ssize_t count = write(STDOUT_FILENO, bytes + done, size - done);
        if (count < 0 && errno == EINTR && stop_requested == 0)
            continue;
        if (count <= 0) {
            first_error = first_error ? first_error : count < 0 ? errno : ENOSPC;
            return 0; /* a failure, for a cookie's write */
        }
        done += (size_t)count;
    }
    return (ssize_t)size;
}

/* Replaces stdout by a stream that uses write_all; when out of memory, stdio's remains. */
static void prepare_output(void)
{
    FILE *stream = fopencookie(NULL, "w", (cookie_io_functions_t){.write = write_all});
    if (!stream)
        return;
    setvbuf(stream, NULL, isatty(STDOUT_FILENO) ? _IOLBF : _IOFBF, BUFSIZ);
    stdout = stream;
}

/* An image file must never get descriptor 1 because the caller has closed it: a closed descriptor is opened on
 * /dev/null, in the direction that fails (write-only for standard input, read-only for the outputs). */
static void hold_standard_descriptors(void)
{
    for (int fd = 0; fd <= 2; fd++)
        if (fcntl(fd, F_GETFD) == -1 && errno == EBADF)
            (void)!open("/dev/null", fd == 0 ? O_WRONLY : O_RDONLY);
}

/* The errno of an earlier failed write is lost, but poll still reports a pipe without a reader. */
static bool reader_left(void)
{
    struct pollfd output = {.fd = STDOUT_FILENO, .events = POLLOUT};
    return poll(&output, 1, 0) == 1 && (output.revents & POLLERR);
}

status terminal_flush(diagnostic *why)
{
    bool failed_before = ferror(stdout) != 0;
    errno = 0;
    if (fflush(stdout) == 0 && !failed_before)
        return STATUS_OK;
    int error = first_error ? first_error : errno ? errno : ENOMEM; /* no write failed, so printf ran out of memory */
    __fpurge(stdout);
    clearerr(stdout); /* report the error once */
    if (error == EPIPE || reader_left())
        return STATUS_FAILURE;
    return system_error(why, STATUS_FAILURE, NULL, "cannot write to standard output", error, "write to a file with -o");
}

/* Flushes standard output when exit() ends the program, as argp's --help does. */
static void check_stdout_at_exit(void)
{
    if (__fpending(stdout) == 0 && !ferror(stdout))
        return;
    diagnostic why = {0};
    if (terminal_flush(&why) != STATUS_OK) {
        terminal_error(&why);
        _exit(STATUS_FAILURE);
    }
}

void terminal_prepare(void)
{
    hold_standard_descriptors();
    prepare_output();
    struct sigaction action = {.sa_handler = request_stop};
    sigemptyset(&action.sa_mask);
    sigaction(SIGINT, &action, NULL);
    sigaction(SIGTERM, &action, NULL);
    struct sigaction before;
    if (sigaction(SIGHUP, NULL, &before) == 0 && before.sa_handler != SIG_IGN) /* nohup(1) ignores it */
        sigaction(SIGHUP, &action, NULL);
    os_signals_as_errors();
    atexit(check_stdout_at_exit);
    cancel_begin(&token);
}

bool terminal_is_smart(int fd)
{
    const char *kind = getenv("TERM");
    return isatty(fd) && !(kind && strcmp(kind, "dumb") == 0);
}

int terminal_columns(int fd)
{
    enum { COLUMNS_DEFAULT = 80, COLUMNS_MAX = 10000 };
    struct winsize size;
    int64_t columns;
    if (!isatty(fd))
        return 0;
    if (ioctl(fd, TIOCGWINSZ, &size) == 0 && size.ws_col > 1)
        return size.ws_col;
    const char *given = getenv("COLUMNS");
    return given && number_parse_int(given, &columns) && columns > 1 && columns <= COLUMNS_MAX ? (int)columns
                                                                                               : COLUMNS_DEFAULT;
}

static bool has_color(int fd)
{
    const char *refused = getenv("NO_COLOR"); /* no-color.org: set and not empty */
    return terminal_is_smart(fd) && !(refused && refused[0]);
}

void terminal_error(const diagnostic *why)
{
    char text[DIAGNOSTIC_TEXT_MAX];
    if (why->what[0] == '\0')
        return;
    diagnostic_text(why, text, sizeof text);
    for (char *c = text; *c; c++) /* a file name may hold control characters; an error is one line */
        if ((unsigned char)*c < ' ' || *c == 127)
            *c = '?';
    bool color = has_color(STDERR_FILENO);
    fprintf(stderr, "%scuvette:%s %s\n", color ? "\033[1;31m" : "", color ? "\033[0m" : "", text);
}

void terminal_note(const char *text)
{
    bool color = has_color(STDERR_FILENO);
    fprintf(stderr, "%scuvette: note:%s %s\n", color ? "\033[1m" : "", color ? "\033[0m" : "", text);
}

void terminal_note_of(const char *path, const char *text)
{
    char line[2400];
    snprintf(line, sizeof line, "%.250s: %.2100s", path, text);
    if (text[0])
        terminal_note(line);
}

void progress_start(progress_line *line, const char *label)
{
    *line = (progress_line){.label = label, .started_s = clock_wall_s(), .enabled = terminal_is_smart(STDERR_FILENO)};
}

static void write_duration(double seconds, char *text, size_t size)
{
    long s = seconds < 359999 ? (long)(seconds + 0.5) : 359999;
    if (s >= 3600)
        snprintf(text, size, "%ld h %02ld min", s / 3600, s / 60 % 60);
    else if (s >= 60)
        snprintf(text, size, "%ld min %02ld s", s / 60, s % 60);
    else
        snprintf(text, size, "%ld s", s);
}

void progress_draw(progress_line *line, double fraction)
{
    double elapsed_s = clock_wall_s() - line->started_s;
    if (!line->enabled || elapsed_s < 0.5)
        return;
    static const char full[] = "####################";
    const int width = (int)sizeof full - 1, done = (int)(fraction * width);
    char text[160], left[48] = "?";
    if (fraction > 0)
        write_duration(elapsed_s * (1 - fraction) / fraction, left, sizeof left);
    snprintf(text, sizeof text, "%.64s: [%-*.*s] %3d%%, %s left", line->label, width, done, full, (int)(fraction * 100),
             left);
    int wide = terminal_columns(STDERR_FILENO) - 1;
    int length = (int)strlen(text) < wide ? (int)strlen(text) : wide;
    int blanks = line->shown > length ? line->shown - length : 0;
    fprintf(stderr, "\r%.*s%*s", length, text, blanks, "");
    fflush(stderr);
    line->shown = length;
}

void progress_erase(progress_line *line)
{
    if (line->shown > 0) {
        fprintf(stderr, "\r%*s\r", line->shown, "");
        fflush(stderr);
    }
    line->shown = 0;
}
