/* Opens an address in the browser without showing it to others: arguments of programs are visible to everyone on the
 * machine, so the browser gets a file that only its owner can read and that opens the address. */
#pragma once

#include "base/status.h"

/* Writes the file, to $XDG_RUNTIME_DIR or the folder for temporary files, and starts xdg-open with it in a session of
 * its own. *file is its path, allocated; NULL after an error: STATUS_FAILURE where the file cannot be written. */
status browser_open(const char *address, char **file, diagnostic *why);
/* Removes the file and frees its path; NULL is allowed. */
void browser_forget(char *file);
