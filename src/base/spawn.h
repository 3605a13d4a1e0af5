/* Starting another program with a minimal environment of file descriptors and signals: its standard input is empty, its
 * output and errors go to the given descriptors, nothing else is open, and no signal is blocked or ignored. Ownership:
 * the caller waits for it. */
#pragma once

#include <stdbool.h>
#include <sys/types.h>

/* program: its path. arguments: from its name on; NULL-terminated. own_group: it leads its own process group. Returns 0
 * or an errno. */
int spawn_program(pid_t *pid, const char *program, char *const *arguments, int out, int err, bool own_group);

/* The same for another `cuvette`, which the kernel ends when this thread has ended, however it did: it must not go on
 * to measure for nobody, or together with its successor. One thread at a time calls it. */
int spawn_bound(pid_t *pid, const char *program, char *const *arguments, int out, int err);
/* The other end: the program calls it first, and ends at once if it returns false: the parent has ended already. */
bool spawn_follow_parent(void);
