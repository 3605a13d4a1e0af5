#include "base/cancel.h"
#include "scene/assets/mesh_child.h"

#include "base/status.h"
#include "base/text.h"
#include <errno.h>
#include <poll.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/pidfd.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

double mesh_child_now_s(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* ---- communication ---- */

static void hang_up(int *fd)
{
    if (*fd >= 0) {
        close(*fd);
        *fd = -1;
    }
}

/* Reads its standard error; only the beginning is kept, but the pipe is always drained, so that the child never blocks.
 * */
static void hear(mesh_child *child)
{
    char buffer[4096];
    ssize_t got = read(child->err, buffer, sizeof buffer);
    if (got < 0 && errno == EINTR)
        return;
    if (got <= 0) {
        hang_up(&child->err);
        return;
    }
    size_t room = sizeof child->said - 1 - child->said_length, kept = (size_t)got < room ? (size_t)got : room;
    memcpy(child->said + child->said_length, buffer, kept);
    child->said_length += kept;
}

/* poll until the deadline, for at most 50 ms at a time; 0, with late or cancelled set, after it. */
static int wait_until_late(mesh_child *child, struct pollfd *files, nfds_t count)
{
    const double left_s = child->deadline_s - mesh_child_now_s();
    child->late = left_s <= 0;
    child->cancelled = cancel_asked();
    return child->late || child->cancelled ? 0 : poll(files, count, left_s < 0.05 ? (int)(left_s * 1000) + 1 : 50);
}

static bool is_passing(int error)
{
    return error == EINTR || error == EAGAIN;
}

/* Waits until standard output has data (true) or nothing more will come. */
static bool wait_for_bytes(mesh_child *child)
{
    while (child->out >= 0) {
        struct pollfd both[] = {{.fd = child->out, .events = POLLIN},
                                {.fd = child->err, .events = POLLIN}}; /* -1 is ignored */
        const int ready = wait_until_late(child, both, 2);
        if (child->late || child->cancelled || (ready < 0 && !is_passing(errno)))
            return false;
        if (ready > 0 && both[1].revents)
            hear(child);
        if (ready > 0 && both[0].revents)
            return true;
    }
    return false;
}

/* Reads up to size bytes; 0 at the end, or after the deadline. */
static size_t take(mesh_child *child, void *bytes, size_t size)
{
    while (wait_for_bytes(child)) {
        ssize_t got = read(child->out, bytes, size);
        if (got > 0)
            return (size_t)got;
        if (got < 0 && errno == EINTR)
            continue;
        child->error = got < 0 ? errno : 0;
        hang_up(&child->out);
    }
    return 0;
}

status mesh_child_read(void *context, void *bytes, size_t size, diagnostic *why)
{
    for (size_t done = 0; done < size;) {
        size_t got = take(context, (char *)bytes + done, size - done);
        const int error = ((const mesh_child *)context)->error;
        if (got == 0 && error)
            return system_error(why, STATUS_FAILURE, NULL, "cannot read the importer's answer", error, "try again");
        if (got == 0)
            return diagnose(why, STATUS_BAD_INPUT, NULL, "the importer's answer is truncated");
        done += got;
    }
    return STATUS_OK;
}

status mesh_child_end(void *context, diagnostic *why)
{
    char more;
    return take(context, &more, 1) == 0
               ? STATUS_OK
               : diagnose(why, STATUS_BAD_INPUT, NULL, "the importer's answer has data after its end");
}

/* ---- end ---- */

/* The exit status as from waitpid; -1 if it is not available (the parent process ignores SIGCHLD). */
static int reap(mesh_child *child, bool still_wanted)
{
    /* remaining messages; the end of the stream also closes this pipe */
    while (still_wanted && child->err >= 0 && !child->late && !child->cancelled) {
        struct pollfd one = {.fd = child->err, .events = POLLIN};
        const int ready = wait_until_late(child, &one, 1);
        if (ready > 0)
            hear(child);
        else if (ready < 0 && !is_passing(errno))
            break;
    }
    /* A child that is already exiting keeps its own exit status: it no longer receives signals. */
    if (child->handle >= 0)
        pidfd_send_signal(child->handle, SIGKILL, NULL, 0);
    else
        kill(child->pid, SIGKILL);
    hang_up(&child->handle);
    hang_up(&child->out);
    hang_up(&child->err);
    int state = -1;
    while (waitpid(child->pid, &state, 0) < 0)
        if (errno != EINTR)
            return -1;
    return state;
}

/* Parses the child's line "cuvette-import: PATH[:LINE[:COLUMN]]: what[; remedy]"; false if it has another form. */
static bool repeat(mesh_child *child, const char *path, diagnostic *why)
{
    diagnostic here = {.what = ""};
    diagnostic_locate(&here, path, 0, 0);
    char *prefix = text_format("cuvette-import: %s:", here.file), *line = child->said;
    line[child->said_length] = 0;
    size_t length = prefix ? strlen(prefix) : 0;
    bool ours = prefix && strncmp(line, prefix, length) == 0;
    free(prefix);
    char *end = strchr(line, '\n');
    if (!ours || !end)
        return false;
    *end = 0;
    char *at = line + length;
    long place[2] = {0, 0};
    for (int i = 0; i < 2 && *at >= '0' && *at <= '9'; i++) {
        place[i] = strtol(at, &at, 10);
        at += *at == ':';
    }
    at += *at == ' ';
    char *remedy = strstr(at, "; ");
    if (remedy) {
        *remedy = 0;
        remedy += 2;
    }
    diagnostic_locate(why, path, place[0], place[1]);
    diagnose(why, STATUS_BAD_INPUT, remedy, "%s", at);
    return true;
}

status mesh_child_close(mesh_child *child, const char *path, const mesh_limits *limits, status code, diagnostic *why)
{
    /* A stream that was complete but refused: no further data is expected. */
    int state = reap(child, code == STATUS_OK || child->out < 0);
    diagnostic_locate(why, path, 0, 0);
    if (child->cancelled)
        return diagnose(why, STATUS_INTERRUPTED, NULL, "reading the file was interrupted");
    if (child->late)
        return diagnose(why, STATUS_BAD_INPUT, "use a mesh of less detail, if the file is complete",
                        "reading the file took longer than the limit of %g s", limits->wall_s);
    if (state == -1)
        return code != STATUS_OK && repeat(child, path, why) ? STATUS_BAD_INPUT : code;
    if (WIFSIGNALED(state)) {
        int signal = WTERMSIG(state);
        const char *name = sigdescr_np(signal);
        if (signal == SIGINT || signal == SIGTERM || signal == SIGHUP)
            return diagnose(why, STATUS_INTERRUPTED, NULL, "reading the file was interrupted");
        if (signal == SIGXCPU)
            return diagnose(why, STATUS_BAD_INPUT, "use a mesh of less detail, if the file is complete",
                            "reading the file took more CPU time than the limit of %g s", limits->wall_s);
        if (signal == SIGKILL && code != STATUS_OK)
            return code;
        return diagnose(why, STATUS_BAD_INPUT, "check that the file is complete, or export it again",
                        "the importer was stopped by signal %d (%s)", signal, name ? name : "unknown");
    }
    int exit_code = WEXITSTATUS(state);
    if (exit_code == 0)
        return code;
    if (!repeat(child, path, why)) {
        diagnose(why, STATUS_FAILURE, NULL, "the importer ended with exit code %d without a message", exit_code);
        return STATUS_FAILURE;
    }
    return exit_code == STATUS_BAD_INPUT ? STATUS_BAD_INPUT : STATUS_FAILURE;
}
