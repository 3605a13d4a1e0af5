/* Substitutes for what a WebAssembly module lacks: other programs, confinement, hardware counters, hwloc, functions of
 * Linux, threads. */
#include "base/file.h"
#include "base/os_process.h"
#include "base/worker_pool.h"
#include "measure/clock.h"
#include "measure/topology_private.h"
#include "measure/usage.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <pthread.h>
#include <sched.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

status child_run(char *const *arguments, double limit_s, char **output, int *exit_code, diagnostic *why)
{
    (void)limit_s;
    *output = NULL;
    *exit_code = -1;
    return diagnose(why, STATUS_FAILURE, "use the program cuvette instead", "a browser cannot start %.200s",
                    arguments[0]);
}

int spawn_program(pid_t *pid, const char *program, char *const *arguments, int out, int err, bool new_group)
{
    (void)pid, (void)program, (void)arguments, (void)out, (void)err, (void)new_group;
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

/* The browser's sandbox is stricter than these functions would be. */
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

/* Always fails: the caller then counts each processing unit as a core. */
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

/* --- files --- */

/* Nobody else can change the files of a module between realpath and open. See base/file.h. */
int below_open(const char *path, const char *root)
{
    char real[PATH_MAX];
    if (!root || !*root)
        return open(path, O_RDONLY);
    const size_t length = strlen(root);
    if (!realpath(path, real))
        return -1;
    if (strncmp(real, root, length) != 0 || real[length] != '/') {
        errno = EXDEV;
        return -1;
    }
    return open(real, O_RDONLY);
}

/* --- threads: the workers of a pool run on the calling thread, one after another. See base/worker_pool.h. --- */

struct worker_pool {
    void (*watch)(void *context);
    void *context;
    double every_s, watched_s;
};

worker_pool *worker_pool_create(size_t stack_bytes)
{
    (void)stack_bytes;
    return calloc(1, sizeof(worker_pool));
}

void worker_pool_destroy(worker_pool *p)
{
    free(p);
}

status worker_pool_reserve(worker_pool *p, int count, diagnostic *why)
{
    (void)p, (void)count, (void)why;
    return STATUS_OK;
}

status worker_pool_run(worker_pool *p, int count, bool keep, worker_pool_task *task, void (*watch)(void *),
                       double every_s, void *context, diagnostic *why)
{
    (void)keep, (void)why;
    *p = (worker_pool){watch, context, every_s, clock_wall_s()};
    for (int worker = 0; worker < count; worker++)
        task(context, worker);
    return STATUS_OK;
}

void worker_pool_begin(worker_pool *p, int count, worker_pool_task *task, void *context)
{
    p->watch = NULL;
    for (int worker = 0; worker < count; worker++)
        task(context, worker);
}

void worker_pool_end(worker_pool *p)
{
    (void)p;
}

void worker_pool_pause(worker_pool *p)
{
    if (!p->watch || clock_wall_s() - p->watched_s < p->every_s)
        return;
    p->watch(p->context);
    p->watched_s = clock_wall_s();
}
