/* Another program that is run to its end: with an empty standard input, nothing else of ours open, in a process group
 * of its own, all of which ends with it. Ownership: what it said is the caller's. Errors: STATUS_FAILURE for a program
 * that cannot be started, STATUS_INTERRUPTED where its time is over or stop was set. */
#pragma once

#include "base/status.h"
#include <stdatomic.h>

/* arguments[0] is the program's path; NULL at the end. *said: the beginning of what it wrote on standard output and
 * error, also after an error; NULL when memory is out. *exit_code: -1 where a signal ended it. */
status child_run(char *const *arguments, double limit_s, const atomic_bool *stop, char **said, int *exit_code,
                 diagnostic *why);
