/* What a process knows of itself and of its parent, and what differs between systems in that: Linux. */
#pragma once

#include <limits.h>
#include <stdbool.h>

/* The path of the running program. False and "" if it cannot be known, or is too long. */
bool os_program_path(char path[PATH_MAX]);

/* The number of processing units that the process may use now (its CPU affinity); 0 if it cannot be known. */
int os_usable_units(void);

/* The kernel kills this process when the thread that started it ends. */
void os_die_with_parent(void);
