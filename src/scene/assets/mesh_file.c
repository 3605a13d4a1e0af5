/* The child process cuvette-import, which reads a mesh file: started with pipes, read until a deadline, always reaped.
 * All descriptors are close-on-exec. The caller's signal handlers and other children are not affected. */
#include "base/cancel.h"
#include "base/installed.h"
#include "base/os_process.h"
#include "base/status.h"
#include "base/text.h"
#include "scene/assets/mesh_stream.h"

#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/pidfd.h>
#include <sys/types.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

typedef struct mesh_child {
    pid_t pid;
    int handle;         /* pidfd: unlike a process id, it cannot be reused; -1 if the kernel has no pidfds */
    int out, err;       /* read ends of its standard output and error; -1 after their end */
    double deadline_s;  /* on the monotonic clock */
    char message[2048]; /* the beginning of its standard error */
    size_t message_length;
    bool late;      /* killed after the deadline */
    bool cancelled; /* killed because the work was cancelled (base/cancel.h) */
    bool cut;       /* its standard output ended too early */
    bool ended;     /* by itself, or by somebody else's signal */
    int error;      /* errno of a failed read of its standard output */
} mesh_child;

static double now_s(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* --- start --- */

#define PROGRAM "cuvette-import"
#ifndef CUVETTE_LIBEXEC
#define CUVETTE_LIBEXEC "/usr/local/libexec/cuvette"
#endif

/* The path of cuvette-import, the first that exists: $CUVETTE_IMPORT (only this one if it is set); the places below,
 * relative to the running program, then to the library; libexec/cuvette of the installation prefix. Free it; NULL if
 * memory runs out. */
static char *importer_path(void)
{
    /* Relative to the program or library: its own folder in a build; libexec, seen from bin or lib, or from
     * lib/ARCHITECTURE, after `make install`. */
    static const char *const places[] = {"", "/../libexec/cuvette", "/../../libexec/cuvette"};
    const char *asked = getenv("CUVETTE_IMPORT");
    if (asked && *asked)
        return strdup(asked);
    char *path = installed_find(places, sizeof places / sizeof *places, PROGRAM);
    return path || errno == ENOMEM ? path : strdup(CUVETTE_LIBEXEC "/" PROGRAM);
}

/* Opens a pipe whose ends are above the standard descriptors, some of which the caller may have closed. */
static int open_pipe(int ends[2])
{
    int low[2];
    if (pipe2(low, O_CLOEXEC) != 0)
        return errno;
    ends[0] = fcntl(low[0], F_DUPFD_CLOEXEC, 3);
    ends[1] = fcntl(low[1], F_DUPFD_CLOEXEC, 3);
    int error = ends[0] < 0 || ends[1] < 0 ? errno : 0;
    close(low[0]);
    close(low[1]);
    if (error) {
        for (int i = 0; i < 2; i++)
            if (ends[i] >= 0)
                close(ends[i]);
    }
    return error;
}

static int spawn_with_pipes(mesh_child *child, const char *program, char *const *arguments)
{
    int out[2], err[2];
    int error = open_pipe(out);
    if (error)
        return error;
    error = open_pipe(err);
    if (!error) {
        fcntl(out[0], F_SETPIPE_SZ, 1 << 20); /* fewer context switches; optional */
        error = spawn_program(&child->pid, program, arguments, out[1], err[1], false);
        close(err[1]);
        if (error)
            close(err[0]);
    }
    close(out[1]);
    if (error) {
        close(out[0]);
        return error;
    }
    child->out = out[0];
    child->err = err[0];
    child->handle = pidfd_open(child->pid, 0);
    return 0;
}

/* Starts the importer on path. STATUS_BAD_INPUT if it is not installed, STATUS_FAILURE if it cannot be started. */
static status start(mesh_child *child, const char *path, const mesh_limits *limits, diagnostic *why)
{
    *child = (mesh_child){.pid = -1, .handle = -1, .out = -1, .err = -1};
    char *program = importer_path();
    char memory[32], seconds[32], triangles[32], vertices[32];
    uint64_t mib = limits->memory_bytes >> 20, cpu_s = limits->wall_s < 1e6 ? (uint64_t)limits->wall_s + 1 : 1000000;
    snprintf(memory, sizeof memory, "--memory=%llu", (unsigned long long)(mib ? mib : 1));
    snprintf(seconds, sizeof seconds, "--seconds=%llu", (unsigned long long)cpu_s);
    snprintf(triangles, sizeof triangles, "--triangles=%zu", limits->triangles);
    snprintf(vertices, sizeof vertices, "--vertices=%zu", limits->vertices);
    char *name = strdup(path), *root = text_format("--root=%s", limits->root ? limits->root : ""),
         first[] = "cuvette-import", rest[] = "--";
    if (!program || !name || !root) {
        free(program);
        free(name);
        free(root);
        return out_of_memory(why);
    }
    child->deadline_s = now_s() + limits->wall_s;
    int error = spawn_with_pipes(child, program,
                                 (char *const[]){first, memory, seconds, triangles, vertices, root, rest, name, NULL});
    status code = STATUS_OK;
    if (error == ENOENT || error == EACCES || error == ENOEXEC || error == ENOTDIR) {
        const char *reason = strerrordesc_np(error);
        code = diagnose_at(why, program, STATUS_BAD_INPUT,
                           "install cuvette with its importer, or set CUVETTE_IMPORT to its path",
                           "cannot start the mesh importer: %s", reason ? reason : "unknown error");
    } else if (error) {
        code = system_error(why, STATUS_FAILURE, program, "cannot start the mesh importer", error, "try again");
    }
    free(program);
    free(name);
    free(root);
    return code;
}

/* --- communication --- */

static void close_end(int *fd)
{
    if (*fd >= 0) {
        close(*fd);
        *fd = -1;
    }
}

/* Reads the child's standard error. It keeps only the beginning, but drains the pipe, so that the child never
 * blocks. */
static void read_messages(mesh_child *child)
{
    char buffer[4096];
    ssize_t got = read(child->err, buffer, sizeof buffer);
    if (got < 0 && errno == EINTR)
        return;
    if (got <= 0) {
        close_end(&child->err);
        return;
    }
    size_t room = sizeof child->message - 1 - child->message_length, kept = (size_t)got < room ? (size_t)got : room;
    memcpy(child->message + child->message_length, buffer, kept);
    child->message_length += kept;
}

/* Polls for at most 50 ms. After the deadline or a cancellation it sets late or cancelled and returns 0. */
static int wait_until_late(mesh_child *child, struct pollfd *files, nfds_t count)
{
    const double left_s = child->deadline_s - now_s();
    child->late = left_s <= 0;
    child->cancelled = cancel_asked();
    return child->late || child->cancelled ? 0 : poll(files, count, left_s < 0.05 ? (int)(left_s * 1000) + 1 : 50);
}

static bool is_transient(int error)
{
    return error == EINTR || error == EAGAIN;
}

/* Waits until standard output has data (true); false at its end, after the deadline or a cancellation. */
static bool wait_for_bytes(mesh_child *child)
{
    while (child->out >= 0) {
        struct pollfd both[] = {{.fd = child->out, .events = POLLIN},
                                {.fd = child->err, .events = POLLIN}}; /* -1 is ignored */
        const int ready = wait_until_late(child, both, 2);
        if (child->late || child->cancelled || (ready < 0 && !is_transient(errno)))
            return false;
        if (ready > 0 && both[1].revents)
            read_messages(child);
        if (ready > 0 && both[0].revents)
            return true;
    }
    return false;
}

/* Reads up to size bytes; 0 at the end, after the deadline or a cancellation. */
static size_t read_some(mesh_child *child, void *bytes, size_t size)
{
    while (wait_for_bytes(child)) {
        ssize_t got = read(child->out, bytes, size);
        if (got > 0)
            return (size_t)got;
        if (got < 0 && errno == EINTR)
            continue;
        child->error = got < 0 ? errno : 0;
        close_end(&child->out);
    }
    return 0;
}

/* mesh_source.read, with the child as context. If the stream ends early, finish() explains why. */
static status read_bytes(void *context, void *bytes, size_t size, diagnostic *why)
{
    for (size_t done = 0; done < size;) {
        size_t got = read_some(context, (char *)bytes + done, size - done);
        const int error = ((const mesh_child *)context)->error;
        if (got == 0 && error)
            return system_error(why, STATUS_FAILURE, NULL, "cannot read the importer's answer", error, "try again");
        if (got == 0) {
            ((mesh_child *)context)->cut = true;
            return diagnose(why, STATUS_BAD_INPUT, NULL, "the importer's answer is truncated");
        }
        done += got;
    }
    return STATUS_OK;
}

static status read_end(void *context, diagnostic *why)
{
    char more;
    return read_some(context, &more, 1) == 0
               ? STATUS_OK
               : diagnose(why, STATUS_BAD_INPUT, NULL, "the importer's answer has data after its end");
}

/* --- end --- */

/* The exit status as from waitpid; -1 if it is not available (the parent process ignores SIGCHLD). */
static int reap(mesh_child *child, bool still_wanted)
{
    /* Reads the remaining messages: the child closes this pipe when it ends. */
    while (still_wanted && child->err >= 0 && !child->late && !child->cancelled) {
        struct pollfd one = {.fd = child->err, .events = POLLIN};
        const int ready = wait_until_late(child, &one, 1);
        if (ready > 0)
            read_messages(child);
        else if (ready < 0 && !is_transient(errno))
            break;
    }
    int state = -1;
    /* After the end of its output a child ends within this time, unless it only closed its pipes. */
    if (child->cut && !child->late && !child->cancelled && child->handle >= 0)
        poll(&(struct pollfd){.fd = child->handle, .events = POLLIN}, 1, 200);
    child->ended = waitpid(child->pid, &state, WNOHANG) == child->pid;
    /* A child that is already exiting keeps its own exit status: it no longer receives signals. */
    if (!child->ended && child->handle >= 0)
        pidfd_send_signal(child->handle, SIGKILL, NULL, 0);
    else if (!child->ended)
        kill(child->pid, SIGKILL);
    close_end(&child->handle);
    close_end(&child->out);
    close_end(&child->err);
    while (!child->ended && waitpid(child->pid, &state, 0) < 0)
        if (errno != EINTR)
            return -1;
    return state;
}

/* Parses the child's line "cuvette-import: PATH[:LINE[:COLUMN]]: what[; remedy]"; false if it has another form. */
static bool parse_message(mesh_child *child, const char *path, diagnostic *why)
{
    diagnostic here = {.what = ""};
    diagnostic_locate(&here, path, 0, 0);
    char *prefix = text_format("cuvette-import: %s:", here.file), *line = child->message;
    line[child->message_length] = 0;
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

/* Terminates the child and waits for it. code is the result of reading: STATUS_OK is kept only if the child exited
 * successfully; the child's own message, or its signal, takes precedence over the reader's. */
static status finish(mesh_child *child, const char *path, const mesh_limits *limits, status code, diagnostic *why)
{
    /* If the reader refused the stream before its end, the child's messages do not matter. */
    int state = reap(child, code == STATUS_OK || child->out < 0);
    diagnostic_locate(why, path, 0, 0);
    if (child->cancelled)
        return diagnose(why, STATUS_INTERRUPTED, NULL, "reading the file was interrupted");
    if (child->late)
        return diagnose(why, STATUS_BAD_INPUT, "use a mesh of less detail, or export the file again if it is damaged",
                        "reading the file took longer than the limit of %g s", limits->wall_s);
    if (state == -1)
        return code != STATUS_OK && parse_message(child, path, why) ? STATUS_BAD_INPUT : code;
    if (WIFSIGNALED(state)) {
        int signal = WTERMSIG(state);
        const char *name = sigdescr_np(signal);
        if (signal == SIGINT || signal == SIGTERM || signal == SIGHUP)
            return diagnose(why, STATUS_INTERRUPTED, NULL, "reading the file was interrupted");
        if (signal == SIGXCPU)
            return diagnose(why, STATUS_BAD_INPUT,
                            "use a mesh of less detail, or export the file again if it is damaged",
                            "reading the file took more CPU time than the limit of %g s", limits->wall_s);
        if (signal == SIGKILL && child->ended)
            return diagnose(why, STATUS_FAILURE, "set --memory-limit, or use a mesh of less detail",
                            "the importer was killed, as the system does when memory runs out");
        if (signal == SIGKILL && code != STATUS_OK)
            return code;
        return diagnose(why, STATUS_BAD_INPUT, "check that the file is complete, or export it again",
                        "the importer was stopped by signal %d (%s)", signal, name ? name : "unknown");
    }
    int exit_code = WEXITSTATUS(state);
    if (exit_code == 0)
        return code;
    if (!parse_message(child, path, why)) {
        diagnose(why, STATUS_FAILURE, NULL, "the importer ended with exit code %d without a message", exit_code);
        return STATUS_FAILURE;
    }
    return exit_code == STATUS_BAD_INPUT ? STATUS_BAD_INPUT : STATUS_FAILURE;
}

/* --- the file --- */

status mesh_read_file(const char *path, const mesh_limits *limits, mesh_import **out, diagnostic *why)
{
    mesh_limits all = mesh_limits_complete(limits);
    mesh_child child;
    diagnostic inner = {.what = ""};
    *out = NULL;
    if (!*path)
        return diagnose(why, STATUS_BAD_INPUT, "give a mesh file", "the name of the mesh file is empty");
    status code = start(&child, path, &all, &inner);
    mesh_import *fresh = NULL;
    if (code == STATUS_OK) {
        mesh_source source = {.read = read_bytes, .end = read_end, .context = &child};
        code = mesh_stream_read(&source, &all, &fresh, &inner);
        code = finish(&child, path, &all, code, &inner);
    }
    THEN(code, mesh_textures_find(path, fresh, &inner));
    if (code != STATUS_OK) {
        mesh_import_destroy(fresh);
        if (why)
            *why = inner;
        return code;
    }
    *out = fresh;
    return STATUS_OK;
}
