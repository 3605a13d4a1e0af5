/* Starting other programs, and running one to its end. They get a minimal environment of file descriptors and signals:
 * standard input is empty, no other file of ours is open, and no signal is blocked or ignored. */
#pragma once

#include "base/status.h"
#include <stdbool.h>
#include <sys/types.h>

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
