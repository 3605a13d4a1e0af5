/* What a failed system call means to a user: who must act, and how. */
#pragma once

#include "base/status.h"

/* What to do about an errno; NULL if that depends on what was being done. */
const char *system_remedy(int error);

/* Fills *why with "doing: reason" and a remedy. error: an errno. path: the place, or NULL to leave it unchanged.
 * Returns STATUS_FAILURE for what only the machine can lack (memory, room, open files, a sound disk), otherwise
 * `otherwise`, with the remedy `advice` if the error has none of its own. */
status system_error(diagnostic *why, status otherwise, const char *path, const char *doing, int error,
                    const char *advice);
