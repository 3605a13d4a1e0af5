/* Another program, started with as little of ours as can be: its standard input is empty, its output and errors go
 * where they are told, nothing else is open, and no signal is blocked or ignored. Ownership: the caller waits for it.
 */
#pragma once

#include <stdbool.h>
#include <sys/types.h>

/* program: its path. arguments: from its name on; NULL at the end. own_group: it leads a process group of its own. 0,
 * or an errno. */
int spawn_program(pid_t *pid, const char *program, char *const *arguments, int out, int err, bool own_group);
