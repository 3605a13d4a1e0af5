#include "web/session/child.h"
#include "base/spawn.h"
#include "measure/clock.h"
#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <sys/pidfd.h>
#include <sys/wait.h>
#include <unistd.h>

enum { SAID_MAX = 16384, LOOK_MS = 100 };

typedef struct child {
    pid_t pid;
    int handle; /* of the process */
    int out;    /* our end of what it writes; not blocking */
    char *said;
    size_t length;
} child;

static int begin(child *c, char *const *arguments)
{
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0)
        return errno;
    int error = fcntl(ends[0], F_SETFL, O_NONBLOCK) == 0
                    ? spawn_program(&c->pid, arguments[0], arguments, ends[1], ends[1], true)
                    : errno;
    close(ends[1]);
    if (error) {
        close(ends[0]);
        return error;
    }
    c->out = ends[0];
    c->handle = pidfd_open(c->pid, 0);
    return 0;
}

/* All that is there now; what is over the limit is dropped, so that it never has to wait for us. False at the end. */
static bool hear(child *c)
{
    char bytes[4096];
    for (;;) {
        const ssize_t got = read(c->out, bytes, sizeof bytes);
        if (got <= 0)
            return got < 0 && (errno == EAGAIN || errno == EINTR);
        const size_t room = SAID_MAX - c->length, kept = (size_t)got < room ? (size_t)got : room;
        memcpy(c->said + c->length, bytes, kept);
        c->length += kept;
    }
}

/* Until it has ended; false where that took too long. */
static bool listen_to(child *c, double limit_s, const atomic_bool *stop)
{
    const double deadline_s = clock_wall_s() + limit_s;
    bool hears = true;
    while (clock_wall_s() < deadline_s && !atomic_load(stop)) {
        struct pollfd both[] = {{.fd = hears ? c->out : -1, .events = POLLIN}, {.fd = c->handle, .events = POLLIN}};
        poll(both, 2, LOOK_MS);
        if (both[0].revents)
            hears = hear(c);
        siginfo_t ended = {.si_pid = 0};
        if (waitid(P_PID, (id_t)c->pid, &ended, WEXITED | WNOHANG | WNOWAIT) != 0 || ended.si_pid == c->pid)
            return true;
    }
    return false;
}

/* Its number, and so its group's, cannot come to stand for others before it is waited for. */
static int end(child *c)
{
    int state = -1;
    kill(-c->pid, SIGKILL);
    while (waitpid(c->pid, &state, 0) < 0)
        if (errno != EINTR)
            return -1;
    hear(c);
    close(c->out);
    if (c->handle >= 0)
        close(c->handle);
    return WIFEXITED(state) ? WEXITSTATUS(state) : -1;
}

status child_run(char *const *arguments, double limit_s, const atomic_bool *stop, char **said, int *exit_code,
                 diagnostic *why)
{
    child c = {.said = calloc(1, SAID_MAX + 1)};
    *said = c.said;
    *exit_code = -1;
    if (!c.said)
        return out_of_memory(why);
    const int error = begin(&c, arguments);
    if (error) {
        const char *reason = strerrordesc_np(error);
        return diagnose_at(why, arguments[0], STATUS_FAILURE, "", "it cannot be started: %s",
                           reason ? reason : "unknown error");
    }
    const bool in_time = listen_to(&c, limit_s, stop);
    *exit_code = end(&c);
    return in_time ? STATUS_OK
                   : diagnose(why, STATUS_INTERRUPTED, "draw fewer at a time, or from a terminal",
                              "it took longer than %g s", limit_s);
}
