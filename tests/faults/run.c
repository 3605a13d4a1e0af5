/* Starts a program with a fault: in its own process group, with the library preloaded, and, for system calls, traced.
 * A seccomp filter stops it only at the calls that are counted. */
#include "run.h"

#include "trace.h"

#include <err.h>
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/ptrace.h>
#include <sys/wait.h>
#include <unistd.h>

fault_page *run_page;
static const char *page_path;
static volatile pid_t running;
static volatile sig_atomic_t too_late;

static void end_group(int number)
{
    (void)number;
    too_late = 1;
    if (running > 0)
        kill(-running, SIGKILL);
}

void run_prepare(const char *path)
{
    const int file = open(path, O_RDWR | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    page_path = path;
    if (file < 0 || ftruncate(file, sizeof *run_page) != 0)
        err(3, "%s", path);
    run_page = mmap(NULL, sizeof *run_page, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
    if (run_page == MAP_FAILED)
        err(3, "%s", path);
    close(file);
    sigaction(SIGALRM, &(struct sigaction){.sa_handler = end_group}, NULL);
}

static void to_file(int fd, const char *path, int flags)
{
    const int file = open(path, flags, 0666);
    if (file < 0 || dup2(file, fd) < 0)
        _exit(125);
    close(file);
}

static void become(const run *r, const fault *f)
{
    setpgid(0, 0);
    to_file(0, "/dev/null", O_RDONLY);
    to_file(1, r->out, O_WRONLY | O_CREAT | O_TRUNC);
    to_file(2, r->err, O_WRONLY | O_CREAT | O_TRUNC);
    if (chdir(r->folder) != 0)
        _exit(125);
    setenv("LC_ALL", "C", 1);
    setenv("LD_PRELOAD", r->library, 1);
    setenv("FAULTS_PAGE", page_path, 1);
    if (f->class == FAULT_CALL)
        trace_begin();
    execv(r->words[0], r->words);
    _exit(126);
}

static int wait_plain(pid_t child)
{
    int state = 0;
    while (waitpid(child, &state, 0) < 0)
        if (errno != EINTR)
            err(3, "waitpid");
    return state;
}

static void set_page(const run *r, const fault *f)
{
    fault_page *p = run_page;
    memset(p, 0, offsetof(fault_page, sites));
    snprintf(p->program, sizeof p->program, "%s", r->target);
    p->class = (int)f->class;
    p->place = (int)f->place;
    p->records = f->records;
    p->stays = f->stays;
    p->at = f->at;
    p->hash = f->hash;
    p->depth = f->depth;
}

outcome run_with(const run *r, const fault *f)
{
    outcome o = {.code = 0};
    set_page(r, f);
    too_late = 0;
    fflush(NULL);
    const pid_t child = fork();
    if (child < 0)
        err(3, "fork");
    if (child == 0)
        become(r, f);
    running = child;
    alarm((unsigned)r->limit_s);
    const int state = f->class == FAULT_CALL ? trace_until_end(child, f, &o) : wait_plain(child);
    alarm(0);
    kill(-child, SIGKILL);
    running = 0;
    while (waitpid(-child, NULL, __WALL) > 0 || errno == EINTR)
        ;
    o.timed_out = too_late != 0;
    o.code = WIFEXITED(state) ? WEXITSTATUS(state) : 128 + WTERMSIG(state);
    if (f->class != FAULT_CALL) {
        o.fired = atomic_load(&run_page->fired) > 0;
        o.counted = atomic_load(&run_page->seen);
    }
    return o;
}
