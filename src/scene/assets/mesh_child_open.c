#include "scene/assets/mesh_child.h"
#include "base/child.h"
#include "base/status.h"

#include "base/text.h"
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/pidfd.h>
#include <unistd.h>

/* Both ends above the standard descriptors, some of which the caller may have closed. */
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

status mesh_child_open(mesh_child *child, const char *path, const mesh_limits *limits, diagnostic *why)
{
    *child = (mesh_child){.pid = -1, .handle = -1, .out = -1, .err = -1};
    char *program = mesh_child_program();
    char memory[32], seconds[32], triangles[32], vertices[32];
    uint64_t mib = limits->memory_bytes >> 20, whole = limits->wall_s < 1e6 ? (uint64_t)limits->wall_s + 1 : 1000000;
    snprintf(memory, sizeof memory, "--memory=%llu", (unsigned long long)(mib ? mib : 1));
    snprintf(seconds, sizeof seconds, "--seconds=%llu", (unsigned long long)whole);
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
    child->deadline_s = mesh_child_now_s() + limits->wall_s;
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
