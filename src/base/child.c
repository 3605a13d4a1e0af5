/* Starting other programs: posix_spawn(3); and running one to its end, with its output. */
#include "base/os_process.h"

#include "base/cancel.h"
#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/pidfd.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

/* ---- start ---- */

extern char **environ;

static int set_attributes(posix_spawnattr_t *attributes, bool new_group)
{
    sigset_t none, all;
    sigemptyset(&none);
    sigfillset(&all);
    posix_spawnattr_setsigmask(attributes, &none);
    posix_spawnattr_setsigdefault(attributes, &all);
    posix_spawnattr_setpgroup(attributes, 0);
    return posix_spawnattr_setflags(
        attributes, (short)(POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF | (new_group ? POSIX_SPAWN_SETPGROUP : 0)));
}

static int spawn(pid_t *pid, const char *program, char *const *arguments, char *const *environment, int out, int err,
                 bool new_group)
{
    posix_spawn_file_actions_t actions;
    posix_spawnattr_t attributes;
    int error = posix_spawn_file_actions_init(&actions);
    if (error)
        return error;
    error = posix_spawnattr_init(&attributes);
    if (!error) {
        error = set_attributes(&attributes, new_group);
        error = error ? error : posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
        error = error ? error : posix_spawn_file_actions_adddup2(&actions, out, 1);
        error = error ? error : posix_spawn_file_actions_adddup2(&actions, err, 2);
        error = error ? error : posix_spawn_file_actions_addclosefrom_np(&actions, 3);
        error = error ? error : posix_spawn(pid, program, &actions, &attributes, arguments, environment);
        posix_spawnattr_destroy(&attributes);
    }
    posix_spawn_file_actions_destroy(&actions);
    return error;
}

int spawn_program(pid_t *pid, const char *program, char *const *arguments, int out, int err, bool new_group)
{
    return spawn(pid, program, arguments, environ, out, err, new_group);
}

/* The environment variable with the id of the parent process, with which this process ends. */
#define PARENT "CUVETTE_PARENT"

int spawn_bound(pid_t *pid, const char *program, char *const *arguments, int out, int err)
{
    char variable[64];
    size_t count = 0;
    snprintf(variable, sizeof variable, PARENT "=%ld", (long)getpid());
    while (environ && environ[count])
        count++;
    char **extended = calloc(count + 2, sizeof *extended); /* not setenv, which is not thread-safe */
    if (!extended)
        return ENOMEM;
    memcpy(extended, environ, count * sizeof *extended);
    extended[count] = variable;
    const int error = spawn(pid, program, arguments, extended, out, err, false);
    free(extended);
    return error;
}

bool spawn_follow_parent(void)
{
    const char *parent = getenv(PARENT);
    if (!parent)
        return true;
    const long id = strtol(parent, NULL, 10);
    unsetenv(PARENT);
    os_die_with_parent();
    return getppid() == (pid_t)id;
}

/* ---- run to the end ---- */

enum { OUTPUT_MAX = 16384, POLL_MS = 100 /* how often the token is read */ };

typedef struct child {
    pid_t pid;
    int pidfd; /* -1 if the kernel provides none */
    int out;   /* our end of the output pipe; non-blocking */
    char *output;
    size_t length;
} child;

static double now_s(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + (double)t.tv_nsec * 1e-9;
}

static int begin(child *c, char *const *arguments)
{
    int pipe_ends[2];
    if (pipe2(pipe_ends, O_CLOEXEC) != 0)
        return errno;
    int error = fcntl(pipe_ends[0], F_SETFL, O_NONBLOCK) == 0
                    ? spawn_program(&c->pid, arguments[0], arguments, pipe_ends[1], pipe_ends[1], true)
                    : errno;
    close(pipe_ends[1]);
    if (error) {
        close(pipe_ends[0]);
        return error;
    }
    c->out = pipe_ends[0];
    c->pidfd = pidfd_open(c->pid, 0);
    return 0;
}

/* Reads all that is available; drops bytes over the limit, so that the program never blocks on a full pipe. False at
 * the end. */
static bool read_output(child *c)
{
    char bytes[4096];
    for (;;) {
        const ssize_t got = read(c->out, bytes, sizeof bytes);
        if (got <= 0)
            return got < 0 && (errno == EAGAIN || errno == EINTR);
        const size_t room = OUTPUT_MAX - c->length, kept = (size_t)got < room ? (size_t)got : room;
        memcpy(c->output + c->length, bytes, kept);
        c->length += kept;
    }
}

/* Waits until the program has ended; false after the time limit or a cancellation. */
static bool wait_child(child *c, double limit_s)
{
    const double deadline_s = now_s() + limit_s;
    bool open = true;
    while (now_s() < deadline_s && !cancel_asked()) {
        struct pollfd watched[] = {{.fd = open ? c->out : -1, .events = POLLIN}, {.fd = c->pidfd, .events = POLLIN}};
        poll(watched, 2, POLL_MS);
        if (watched[0].revents)
            open = read_output(c);
        siginfo_t ended = {.si_pid = 0};
        if (waitid(P_PID, (id_t)c->pid, &ended, WEXITED | WNOHANG | WNOWAIT) != 0 || ended.si_pid == c->pid)
            return true;
    }
    return false;
}

/* Kills the group, then reaps: the pid, and so the group's number, cannot be reused before waitpid. */
static int end(child *c)
{
    int state = -1;
    kill(-c->pid, SIGKILL);
    while (waitpid(c->pid, &state, 0) < 0)
        if (errno != EINTR)
            return -1;
    read_output(c);
    close(c->out);
    if (c->pidfd >= 0)
        close(c->pidfd);
    return WIFEXITED(state) ? WEXITSTATUS(state) : -1;
}

status child_run(char *const *arguments, double limit_s, char **output, int *exit_code, diagnostic *why)
{
    child c = {.output = calloc(1, OUTPUT_MAX + 1)};
    *output = c.output;
    *exit_code = -1;
    if (!c.output)
        return out_of_memory(why);
    const int error = begin(&c, arguments);
    if (error)
        return system_error(why, STATUS_FAILURE, arguments[0], "the program cannot be started", error, "try again");
    const bool in_time = wait_child(&c, limit_s);
    *exit_code = end(&c);
    return in_time          ? STATUS_OK
           : cancel_asked() ? cancel_check(why)
                            : diagnose(why, STATUS_INTERRUPTED, "give the program less work, or run it directly",
                                       "the program took longer than %g s", limit_s);
}
