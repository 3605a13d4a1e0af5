/* Faults of system calls, from outside, so that the calls of every library are seen. */
#pragma once

#include "run.h"

#include <sys/types.h>

/* False where this is not written for the processor. */
bool trace_available(void);
/* In the child, before exec. */
void trace_begin(void);
/* In the parent: the state of the child as from waitpid, when it has ended. */
int trace_until_end(pid_t child, const fault *f, outcome *o);
