/* What a WebAssembly module lacks of an operating system: other programs, confinement, hardware counters, hwloc. */
#include "base/child.h"
#include "base/os_confine.h"
#include "measure/topology_private.h"
#include "measure/usage.h"

#include <errno.h>
#include <pthread.h>
#include <sched.h>
#include <stddef.h>
#include <unistd.h>

status child_run(char *const *arguments, double limit_s, char **output, int *exit_code, diagnostic *why)
{
    (void)limit_s;
    *output = NULL;
    *exit_code = -1;
    return diagnose(why, STATUS_FAILURE, "use the program cuvette for it", "a browser cannot start %.200s",
                    arguments[0]);
}

int spawn_program(pid_t *pid, const char *program, char *const *arguments, int out, int err, bool own_group)
{
    (void)pid, (void)program, (void)arguments, (void)out, (void)err, (void)own_group;
    return ENOSYS;
}

int spawn_bound(pid_t *pid, const char *program, char *const *arguments, int out, int err)
{
    return spawn_program(pid, program, arguments, out, err, false);
}

bool spawn_follow_parent(void)
{
    return false;
}

/* The browser's own sandbox is narrower than what these would leave. */
bool os_confine_files(const confine_place *places, size_t count)
{
    (void)places, (void)count;
    errno = 0;
    return false;
}

bool os_confine_calls(confine_calls what)
{
    (void)what;
    return false;
}

bool os_confine_is_off(void)
{
    return true;
}

/* Each unit is then taken for a core. */
char *topology_discover_in_child(const char *synthetic, status *code, bool *no_memory)
{
    (void)synthetic;
    *code = STATUS_FAILURE;
    *no_memory = false;
    return NULL;
}

hardware_counter *hardware_counter_create(void)
{
    return NULL;
}

hardware_counts hardware_counter_read(const hardware_counter *counter)
{
    (void)counter;
    return (hardware_counts){-1, -1, -1, -1};
}

hardware_counts hardware_counts_since(const hardware_counter *counter, const hardware_counts *before)
{
    (void)before;
    return hardware_counter_read(counter);
}

void hardware_counter_destroy(hardware_counter *counter)
{
    (void)counter;
}

/* --- functions of Linux that emscripten declares and does not have --- */

int sched_getcpu(void)
{
    return -1;
}

int sched_getaffinity(pid_t process, size_t size, cpu_set_t *set)
{
    (void)process, (void)size, (void)set;
    errno = ENOSYS;
    return -1;
}

int sched_setaffinity(pid_t process, size_t size, const cpu_set_t *set)
{
    (void)process, (void)size, (void)set;
    errno = ENOSYS;
    return -1;
}

int __sched_cpucount(size_t size, const cpu_set_t *set)
{
    (void)size, (void)set;
    return 0;
}

int pthread_timedjoin_np(pthread_t thread, void **result, const struct timespec *until)
{
    (void)thread, (void)result, (void)until;
    return ENOSYS;
}

int euidaccess(const char *path, int mode)
{
    return access(path, mode);
}
