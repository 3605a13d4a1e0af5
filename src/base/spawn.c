/* Starting another program. */
#include "base/spawn.h"

#include "base/os_process.h"
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

extern char **environ;

static int set_attributes(posix_spawnattr_t *attributes, bool own_group)
{
    sigset_t none, all;
    sigemptyset(&none);
    sigfillset(&all);
    posix_spawnattr_setsigmask(attributes, &none);
    posix_spawnattr_setsigdefault(attributes, &all);
    posix_spawnattr_setpgroup(attributes, 0);
    return posix_spawnattr_setflags(
        attributes, (short)(POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF | (own_group ? POSIX_SPAWN_SETPGROUP : 0)));
}

static int spawn(pid_t *pid, const char *program, char *const *arguments, char *const *environment, int out, int err,
                 bool own_group)
{
    posix_spawn_file_actions_t actions;
    posix_spawnattr_t attributes;
    int error = posix_spawn_file_actions_init(&actions);
    if (error)
        return error;
    error = posix_spawnattr_init(&attributes);
    if (!error) {
        error = set_attributes(&attributes, own_group);
        error = error ? error : posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
        error = error ? error : posix_spawn_file_actions_adddup2(&actions, out, 1);
        error = error ? error : posix_spawn_file_actions_adddup2(&actions, err, 2);
        error = error ? error : posix_spawn_file_actions_addclosefrom_np(&actions, 3);
        error = error ? error : posix_spawn(pid, program, &actions, &attributes, arguments, environment);
        posix_spawnattr_destroy(&attributes);
    }
    posix_spawn_file_actions_destroy(&actions);
    return error;
}

int spawn_program(pid_t *pid, const char *program, char *const *arguments, int out, int err, bool own_group)
{
    return spawn(pid, program, arguments, environ, out, err, own_group);
}

/* The process that started this one, if it is to end with it. */
#define PARENT "CUVETTE_PARENT"

int spawn_bound(pid_t *pid, const char *program, char *const *arguments, int out, int err)
{
    char own[64];
    size_t count = 0;
    snprintf(own, sizeof own, PARENT "=%ld", (long)getpid());
    while (environ && environ[count])
        count++;
    char **with_own = calloc(count + 2, sizeof *with_own); /* not setenv, which other threads could meet */
    if (!with_own)
        return ENOMEM;
    memcpy(with_own, environ, count * sizeof *with_own);
    with_own[count] = own;
    const int error = spawn(pid, program, arguments, with_own, out, err, false);
    free(with_own);
    return error;
}

bool spawn_follow_parent(void)
{
    const char *parent = getenv(PARENT);
    if (!parent)
        return true;
    const long id = strtol(parent, NULL, 10);
    unsetenv(PARENT);
    os_die_with_parent();
    return getppid() == (pid_t)id;
}
