/* What a process knows of itself and of its parent: proc(5), sched_setaffinity(2), prctl(2). */
#include "base/os_process.h"

#include <sched.h>
#include <signal.h>
#include <sys/prctl.h>
#include <unistd.h>

bool os_program_path(char path[PATH_MAX])
{
    const ssize_t length = readlink("/proc/self/exe", path, PATH_MAX);
    const bool known = length > 0 && length < PATH_MAX;
    path[known ? length : 0] = 0;
    return known;
}

/* The mask has room for more units than any machine has; a smaller mask is an error on a machine with more units. */
int os_usable_units(void)
{
    enum { UNITS_MAX = 16384 };
    cpu_set_t set[UNITS_MAX / CPU_SETSIZE];
    return sched_getaffinity(0, sizeof set, set) == 0 ? CPU_COUNT_S(sizeof set, set) : 0;
}

void os_die_with_parent(void)
{
    prctl(PR_SET_PDEATHSIG, SIGKILL);
}
