/* Runs another program to its end, with an empty standard input, no other open file of ours, in a process group of
 * its own that is killed with it. Ownership: the output belongs to the caller. Errors: STATUS_FAILURE if the program
 * cannot be started, STATUS_INTERRUPTED after the time limit or a cancellation. */
#pragma once

#include "base/status.h"

/* arguments[0] is the program's path; the last element is NULL. *output: the first OUTPUT_MAX bytes of its standard
 * output and error, also after an error; NULL when out of memory. *exit_code: -1 if a signal ended it. */
status child_run(char *const *arguments, double limit_s, char **output, int *exit_code, diagnostic *why);
