/* System calls that fail: the program is traced with ptrace, and a seccomp filter stops it only at the calls of
 * interest. Other processes and threads that it starts are traced too (a filtered call without a tracer would fail),
 * but only calls of the program itself are counted, from the moment at which its own code begins. */
#include "trace.h"

#include <errno.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <signal.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/ptrace.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/user.h>
#include <sys/wait.h>
#include <unistd.h>

#ifdef __x86_64__

static const struct {
    int number;
    call_group group;
} calls[] = {{SYS_mmap, CALL_MMAP},        {SYS_open, CALL_OPEN},        {SYS_openat, CALL_OPEN},
             {SYS_openat2, CALL_OPEN},     {SYS_read, CALL_READ},        {SYS_pread64, CALL_READ},
             {SYS_write, CALL_WRITE},      {SYS_pwrite64, CALL_WRITE},   {SYS_writev, CALL_WRITE},
             {SYS_fsync, CALL_SYNC},       {SYS_fdatasync, CALL_SYNC},   {SYS_rename, CALL_RENAME},
             {SYS_renameat, CALL_RENAME},  {SYS_renameat2, CALL_RENAME}, {SYS_linkat, CALL_RENAME},
             {SYS_ftruncate, CALL_RENAME}, {SYS_close, CALL_CLOSE},      {SYS_prctl, CALL_GROUPS}};

enum { CALLS = sizeof calls / sizeof calls[0] };

bool trace_available(void)
{
    return true;
}

static bool filter_calls(void)
{
    struct sock_filter code[CALLS + 3];
    struct sock_fprog program = {.len = CALLS + 3, .filter = code};
    code[0] = (struct sock_filter)BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(struct seccomp_data, nr));
    for (int i = 0; i < CALLS; i++)
        code[i + 1] = (struct sock_filter)BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, (unsigned)calls[i].number,
                                                   (unsigned char)(CALLS - i), 0);
    code[CALLS + 1] = (struct sock_filter)BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW);
    code[CALLS + 2] = (struct sock_filter)BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_TRACE);
    return prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0 && prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program) == 0;
}

void trace_begin(void)
{
    if (ptrace(PTRACE_TRACEME, 0, NULL, NULL) != 0 || raise(SIGSTOP) != 0 || !filter_calls())
        _exit(124);
}

/* The process of a thread; threads are few, and their numbers are not used again within a run. */
enum { KNOWN = 512 };
static struct {
    pid_t thread, process;
} known[KNOWN];
static int known_count;

static pid_t process_of(pid_t thread)
{
    for (int i = 0; i < known_count; i++)
        if (known[i].thread == thread)
            return known[i].process;
    char path[64], line[128];
    int process = thread;
    snprintf(path, sizeof path, "/proc/%d/status", (int)thread);
    FILE *about = fopen(path, "r");
    while (about && fgets(line, sizeof line, about))
        if (sscanf(line, "Tgid: %d", &process) == 1)
            break;
    if (about)
        fclose(about);
    if (known_count < KNOWN) {
        known[known_count].thread = thread;
        known[known_count++].process = process;
    }
    return process;
}

static call_group group_of(long number)
{
    for (int i = 0; i < CALLS; i++)
        if (calls[i].number == number)
            return calls[i].group;
    return CALL_GROUPS;
}

static bool is_file(pid_t thread, int fd)
{
    char path[64];
    struct stat about;
    snprintf(path, sizeof path, "/proc/%d/fd/%d", (int)thread, fd);
    return stat(path, &about) == 0 && S_ISREG(about.st_mode);
}

/* A counter in the kernel's memory, with which libmicrohttpd wakes its threads: it has no disk that could fail, and the
 * library ends the program if it did. */
static bool is_counter(pid_t thread, int fd)
{
    char path[64], target[64] = "";
    snprintf(path, sizeof path, "/proc/%d/fd/%d", (int)thread, fd);
    return readlink(path, target, sizeof target - 1) > 0 && strcmp(target, "anon_inode:[eventfd]") == 0;
}

/* Half of the bytes, at least one. */
static void shorten(struct user_regs_struct *now)
{
    if (now->orig_rax != SYS_writev && now->rdx > 1)
        now->rdx /= 2;
}

/* The thread whose call returns the error although it is made, and how often it has stopped since. */
static pid_t fails_at_end;
static int stops;

/* The second stop is at the call's end. */
static void at_end(pid_t thread, int error)
{
    struct user_regs_struct now;
    if (thread != fails_at_end || ++stops < 2)
        return;
    if (ptrace(PTRACE_GETREGS, thread, NULL, &now) == 0) {
        now.rax = (unsigned long long)-(long)error;
        ptrace(PTRACE_SETREGS, thread, NULL, &now);
    }
    fails_at_end = 0;
}

/* The stop of a thread before one of the calls. program: the process whose calls are counted; 0 until it begins. */
static void at_call(pid_t thread, const fault *f, outcome *o, pid_t *program)
{
    struct user_regs_struct now;
    if (ptrace(PTRACE_GETREGS, thread, NULL, &now) != 0)
        return;
    const call_group group = group_of((long)now.orig_rax);
    if (group == CALL_GROUPS) {
        if ((long)now.orig_rax == SYS_prctl && now.rdi == FAULTS_START)
            *program = process_of(thread);
        return;
    }
    if (!*program || process_of(thread) != *program)
        return;
    if ((group == CALL_READ || group == CALL_WRITE) && is_counter(thread, (int)now.rdi))
        return;
    o->by_group[group]++;
    if (group != f->group)
        return;
    o->counted++;
    if (o->counted != f->at && !(f->stays && o->fired))
        return;
    o->fired = true;
    o->must_report |= group == CALL_SYNC && is_file(thread, (int)now.rdi);
    if (group == CALL_CLOSE) {
        fails_at_end = thread; /* the kernel's close releases the descriptor even if it reports an error */
        return;
    }
    if (f->error == FAULT_SHORT) {
        shorten(&now);
    } else {
        now.orig_rax = (unsigned long long)-1;
        now.rax = (unsigned long long)-(long)f->error;
    }
    ptrace(PTRACE_SETREGS, thread, NULL, &now);
}

static bool is_first_stop(pid_t thread)
{
    for (int i = 0; i < known_count; i++)
        if (known[i].thread == thread)
            return false;
    process_of(thread);
    return true;
}

int trace_until_end(pid_t child, const fault *f, outcome *o)
{
    const long options = PTRACE_O_TRACESECCOMP | PTRACE_O_TRACECLONE | PTRACE_O_TRACEFORK | PTRACE_O_TRACEVFORK |
                         PTRACE_O_TRACEEXEC | PTRACE_O_EXITKILL;
    int state = 0;
    pid_t program = 0;
    known_count = 0;
    fails_at_end = 0;
    stops = 0;
    while (waitpid(child, &state, __WALL) < 0)
        ;
    process_of(child);
    ptrace(PTRACE_SETOPTIONS, child, NULL, options);
    ptrace(PTRACE_CONT, child, NULL, NULL);
    for (;;) {
        const pid_t thread = waitpid(-1, &state, __WALL);
        if (thread < 0 && errno == EINTR)
            continue;
        if (thread < 0)
            return 0x7f00; /* as if it had left with 127 */
        if (!WIFSTOPPED(state)) {
            if (thread == child)
                return state;
            continue;
        }
        const int event = state >> 16, number = WSTOPSIG(state);
        if (event == PTRACE_EVENT_SECCOMP)
            at_call(thread, f, o, &program);
        if (!event && number == SIGTRAP)
            at_end(thread, f->error);
        const bool quiet = event || number == SIGTRAP || (number == SIGSTOP && is_first_stop(thread));
        ptrace(thread == fails_at_end ? PTRACE_SYSCALL : PTRACE_CONT, thread, NULL, quiet ? 0L : (long)number);
    }
}

#else

bool trace_available(void)
{
    return false;
}
void trace_begin(void)
{
}
int trace_until_end(pid_t child, const fault *f, outcome *o)
{
    (void)child, (void)f, (void)o;
    return 0x7f00;
}

#endif
