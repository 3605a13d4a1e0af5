/* moment SIGNAL AFTER_S COMMAND...: runs a command in a process group of its own, sends the group a signal AFTER_S
 * seconds later, as a terminal does, and waits for the command's end. Prints one line: milliseconds from the signal to
 * the end (- if it ended before), milliseconds of CPU time that the command itself used in between (all threads; on a
 * busy machine the better measure of how soon it reacts), the exit code (-number if the signal itself ended it),
 * seconds that it ran, its peak memory in KiB, and seconds of CPU time in all. SIGNAL 0 sends none: how long does the
 * command take? A command that does not end within ten minutes is killed (code -9). Its standard output goes to the
 * file "out". */
#define _GNU_SOURCE
#include <errno.h>
#include <poll.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/pidfd.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

static double now_s(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* Whether the process ended within that time. */
static int ends_within(int handle, double seconds)
{
    struct pollfd one = {.fd = handle, .events = POLLIN};
    struct timespec limit = {.tv_sec = (time_t)seconds, .tv_nsec = (long)((seconds - (double)(time_t)seconds) * 1e9)};
    int ready;
    while ((ready = ppoll(&one, 1, &limit, NULL)) < 0 && errno == EINTR)
        ;
    return ready > 0;
}

/* CPU time of a process that was not waited for yet, also of one that has ended. */
static double cpu_s(pid_t child)
{
    clockid_t clock;
    struct timespec t;
    if (clock_getcpuclockid(child, &clock) != 0 || clock_gettime(clock, &t) != 0)
        return -1.0;
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

int main(int argc, char **argv)
{
    const double LONGEST_S = 600.0;
    if (argc < 4)
        return 2;
    const int number = atoi(argv[1]);
    const double after_s = number ? strtod(argv[2], NULL) : LONGEST_S, began_s = now_s();
    const pid_t child = fork();
    if (child < 0)
        return 1;
    if (child == 0) {
        setpgid(0, 0);
        signal(SIGINT, SIG_DFL);
        if (!freopen("out", "w", stdout))
            _exit(127);
        execvp(argv[3], argv + 3);
        _exit(127);
    }
    setpgid(child, child); /* whoever is first */
    const int handle = pidfd_open(child, 0);
    const int early = ends_within(handle, after_s);
    const double sent_s = now_s(), before_s = cpu_s(child);
    if (!early && number)
        kill(-child, number);
    if (!early && (!number || !ends_within(handle, LONGEST_S)))
        kill(-child, SIGKILL);
    ends_within(handle, LONGEST_S);
    const double used_s = cpu_s(child) - before_s;
    int state;
    struct rusage used;
    while (wait4(child, &state, 0, &used) < 0)
        if (errno != EINTR)
            return 1;
    const double ended_s = now_s(), all_s = (double)(used.ru_utime.tv_sec + used.ru_stime.tv_sec) +
                                            1e-6 * (double)(used.ru_utime.tv_usec + used.ru_stime.tv_usec);
    const int code = WIFEXITED(state) ? WEXITSTATUS(state) : -WTERMSIG(state);
    if (early || !number)
        printf("- - %d %.3f %ld %.3f\n", code, ended_s - began_s, used.ru_maxrss, all_s);
    else
        printf("%.1f %.1f %d %.3f %ld %.3f\n", (ended_s - sent_s) * 1e3, used_s * 1e3, code, ended_s - began_s,
               used.ru_maxrss, all_s);
    return 0;
}
