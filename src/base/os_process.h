/* This process and its parent, as far as it depends on the operating system: Linux. */
#pragma once

#include "base/status.h"
#include <limits.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <sys/types.h>

/* The path of the running program. False and "" if it cannot be known, or is too long. */
bool os_program_path(char path[PATH_MAX]);

/* The number of processing units that the process may use now (its CPU affinity); 0 if it cannot be known. */
int os_usable_units(void);

/* Makes a write to a pipe without a reader, or beyond the limit of file size, fail (EPIPE, EFBIG) instead of ending the
 * process by SIGPIPE or SIGXFSZ. For programs: the library leaves signals to its host. */
void os_signals_as_errors(void);

/* Calls task(context) and returns its value. If the limit of the stack is small (ulimit -s), the task runs on a thread
 * with a stack of the usual size, which later threads get, too. Cancelling the caller cancels it (base/cancel.h). */
int os_call_with_stack(int (*task)(void *context), void *context);

/* The kernel kills this process when the thread that started it ends. */
void os_die_with_parent(void);

/* Starting other programs, and running one to its end. They get a minimal environment of file descriptors and signals:
 * standard input is empty, no other file of ours is open, and no signal is blocked or ignored. */

/* Starts a program whose output and errors go to the given descriptors; the caller waits for it. program: its path.
 * arguments: argv, from the program's name on; NULL-terminated. new_group: the program leads a new process group.
 * Returns 0 or an errno. */
int spawn_program(pid_t *pid, const char *program, char *const *arguments, int out, int err, bool new_group);

/* The same for another `cuvette`, which the kernel kills when this thread ends for any reason: a study must not
 * continue without its caller, nor at the same time as a later run of it. Only one thread at a time may call it. */
int spawn_bound(pid_t *pid, const char *program, char *const *arguments, int out, int err);
/* The child calls this first, and exits at once if it returns false: the parent has already ended. */
bool spawn_follow_parent(void);

/* Runs a program to its end, in a new process group; when the program has ended, the rest of the group is killed.
 * arguments[0] is its path; the last element is NULL. *output: the first 16 KiB of its standard output and error, also
 * after an error; the caller's, freed with free; NULL when out of memory. *exit_code: -1 if a signal ended it.
 * STATUS_FAILURE if the program cannot be started, STATUS_INTERRUPTED after the time limit or a cancellation. */
status child_run(char *const *arguments, double limit_s, char **output, int *exit_code, diagnostic *why);

/* The control groups of this process (cgroups(7)), such as a slice of systemd: the innermost group and all groups that
 * contain it, because their limits apply as well. Version 2 has one tree, version 1 one tree per controller. Files are
 * read below `root`, "" for this machine, so that a test can use recorded files. A group without files limits nothing.
 * Without /proc/self/cgroup the roots of the trees are used. */

/* folder: the group's folder below root, such as "/sys/fs/cgroup/user.slice"; version: 1 or 2. */
typedef void control_group_visit(void *context, const char *folder, int version);

/* Calls visit for each group that the process is in for a controller ("cpu", "memory"), the innermost of a tree first.
 * Returns 0, or an errno if the list of groups exists but cannot be read now. */
int control_group_each(const char *root, const char *controller, control_group_visit *visit, void *context);

/* The tightest limits of all groups. */
typedef struct control_group_limits {
    long long quota_us, period_us; /* CPU time per period; 0: no limit */
    uint64_t memory_bytes;         /* UINT64_MAX: no limit */
} control_group_limits;

/* Returns 0, or an errno if the list of groups or a file with a limit exists but cannot be read now. */
int control_group_read(const char *root, control_group_limits *out);

/* Rights that a thread drops permanently, so that a fault in a reader of other people's files does little harm:
 * Landlock for files and outgoing TCP connections (Linux 5.13), seccomp for system calls. They hold for the calling
 * thread, and for the threads and processes that it starts later; other threads of the process keep theirs. Where the
 * kernel or a container refuses, the functions return false and nothing has changed: the caller continues unconfined.
 * Both also rule out new privileges by set-user-ID programs (no_new_privs). They are off with CUVETTE_SANDBOX=off in
 * the environment and under valgrind; the filter of system calls also in builds with sanitizers, which need more
 * calls. */

typedef enum confine_right { CONFINE_READ = 1, CONFINE_RUN = 2, CONFINE_WRITE = 4 } confine_right;

/* A file, or a folder with all below it. RUN includes READ; WRITE includes READ, creating, renaming and removing. */
typedef struct confine_place {
    const char *path;
    unsigned rights;
} confine_place;

/* Restricts access to these places; places that do not exist are skipped. Open files stay open. If it returns false,
 * errno is 0, or reports a shortage (memory, open files). */
bool os_confine_files(const confine_place *places, size_t count);

/* CONFINE_COMPUTING: memory, locks, clocks and the end of the thread; no files, no descriptors. CONFINE_READING: also
 * opening files for reading, reading and writing what is open, and more threads. Everything else fails with EPERM. */
typedef enum confine_calls { CONFINE_COMPUTING, CONFINE_READING } confine_calls;
bool os_confine_calls(confine_calls what);

/* Whether confinement is off, by the environment or valgrind. */
bool os_confine_is_off(void);
