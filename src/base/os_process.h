/* This process and its parent, as far as it depends on the operating system: Linux. */
#pragma once

#include <limits.h>
#include <stdbool.h>

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
