/* limit PROGRAM [ARGUMENT...] runs a test with two limits that a busy machine does not reach:
 *
 *   TEST_LIMIT_S (600)  seconds of CPU time, user and system, of the program and all processes that it started
 *   TEST_IDLE_S (120)   seconds in which they used less than 2% of one processor
 *
 * At a limit it kills them all, prints on stderr which limit it was, and ends with 124; otherwise it ends with the
 * program's status (128 + signal if a signal killed it). Processes that outlive the program are killed and named.
 * It kills all of them as well when a signal or the end of its parent stops it. Linux only. */
#include <dirent.h>
#include <math.h>
#include <signal.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <unistd.h>

enum { SAMPLE_MS = 250, STOPPED = 124, NOT_STARTED = 126, MAX_PROCESSES = 65536 };

typedef struct {
    pid_t id, parent;
    double cpu_s; /* of the process, and of its children that have ended */
    bool ended, descendant;
    char name[64];
} process;

static process processes[MAX_PROCESSES];
static size_t n_processes;

static bool read_process(const char *id, process *p)
{
    char path[300], text[1024], state;
    snprintf(path, sizeof path, "/proc/%s/stat", id);
    FILE *f = fopen(path, "r");
    if (f == NULL)
        return false;
    size_t length = fread(text, 1, sizeof text - 1, f);
    fclose(f);
    text[length] = '\0';
    char *name = strchr(text, '('), *after = strrchr(text, ')'); /* a name may hold spaces and parentheses */
    if (name == NULL || after == NULL)
        return false;
    unsigned long long ticks[4]; /* utime, stime, cutime, cstime: proc(5) */
    if (sscanf(after + 1, " %c %d %*d %*d %*d %*d %*u %*u %*u %*u %*u %llu %llu %llu %llu", &state, &p->parent,
               &ticks[0], &ticks[1], &ticks[2], &ticks[3]) != 6)
        return false;
    p->id = (pid_t)atol(id);
    p->cpu_s = (double)(ticks[0] + ticks[1] + ticks[2] + ticks[3]) / (double)sysconf(_SC_CLK_TCK);
    p->ended = state == 'Z' || state == 'X';
    p->descendant = false;
    snprintf(p->name, sizeof p->name, "%.*s", (int)(after - name - 1), name + 1);
    return true;
}

/* Reads all processes, and marks the descendants of this one. */
static void read_tree(void)
{
    n_processes = 0;
    DIR *folder = opendir("/proc");
    for (struct dirent *e; folder != NULL && (e = readdir(folder)) != NULL && n_processes < MAX_PROCESSES;)
        if (e->d_name[0] >= '1' && e->d_name[0] <= '9' && read_process(e->d_name, &processes[n_processes]))
            n_processes++;
    if (folder != NULL)
        closedir(folder);
    for (bool found = true; found;) {
        found = false;
        for (size_t i = 0; i < n_processes; i++) {
            bool below = processes[i].parent == getpid();
            for (size_t k = 0; k < n_processes && !below; k++)
                below = processes[k].descendant && processes[k].id == processes[i].parent;
            found = found || (below && !processes[i].descendant);
            processes[i].descendant = below;
        }
    }
}

/* CPU time of all descendants, also of those that have ended. */
static double tree_cpu_s(void)
{
    struct rusage ended;
    getrusage(RUSAGE_CHILDREN, &ended);
    double sum = (double)(ended.ru_utime.tv_sec + ended.ru_stime.tv_sec) +
                 1e-6 * (double)(ended.ru_utime.tv_usec + ended.ru_stime.tv_usec);
    read_tree();
    for (size_t i = 0; i < n_processes; i++)
        sum += processes[i].descendant ? processes[i].cpu_s : 0;
    return sum;
}

/* Kills all descendants; orphans among them become children of this process, which is their subreaper. */
static void kill_tree(bool name_them)
{
    for (bool any = true; any; name_them = false) {
        any = false;
        read_tree();
        for (size_t i = 0; i < n_processes; i++) {
            const process *p = &processes[i];
            if (!p->descendant || p->ended)
                continue;
            any = true;
            kill(p->id, SIGKILL);
            if (name_them)
                fprintf(stderr, "# %s outlived the test, and was killed\n", p->name);
        }
        if (any)
            usleep(1000);
        while (waitpid(-1, NULL, WNOHANG) > 0)
            ;
    }
}

static double seconds_of(const char *variable, double otherwise)
{
    const char *text = getenv(variable);
    return text != NULL && *text != '\0' ? atof(text) : otherwise;
}

int main(int n_arguments, char **arguments)
{
    double cpu_limit_s = seconds_of("TEST_LIMIT_S", 600), idle_limit_s = seconds_of("TEST_IDLE_S", 120);
    if (n_arguments < 2 || !(cpu_limit_s > 0) || !(idle_limit_s > 0)) {
        fprintf(stderr,
                "limit: use TEST_LIMIT_S=SECONDS TEST_IDLE_S=SECONDS limit PROGRAM [ARGUMENT...], both above 0\n");
        return 2;
    }
    sigset_t waited, before;
    sigemptyset(&waited);
    for (const int *s = (const int[]){SIGCHLD, SIGALRM, SIGINT, SIGTERM, SIGHUP, 0}; *s != 0; s++)
        sigaddset(&waited, *s);
    sigprocmask(SIG_BLOCK, &waited, &before);
    prctl(PR_SET_CHILD_SUBREAPER, 1);
    prctl(PR_SET_PDEATHSIG, SIGTERM);
    pid_t program = fork();
    if (program == 0) {
        setpgid(0, 0); /* a test may send a signal to its group */
        /* signals keep their meaning under nohup and in the background of a script, which ignore some */
        for (const int *s = (const int[]){SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGPIPE, 0}; *s != 0; s++)
            signal(*s, SIG_DFL);
        sigprocmask(SIG_SETMASK, &before, NULL);
        execvp(arguments[1], &arguments[1]);
        perror(arguments[1]);
        _exit(NOT_STARTED);
    }
    if (program < 0) {
        perror("limit");
        return NOT_STARTED;
    }
    setitimer(ITIMER_REAL, &(struct itimerval){{0, SAMPLE_MS * 1000}, {0, SAMPLE_MS * 1000}}, NULL);

    /* Idle time is counted in samples, not read from a clock: it does not pass while this process has to wait, too. */
    const char *name = basename(arguments[n_arguments - 1]); /* after a shell or valgrind */
    double idle_s = 0, counted_from_s = 0;
    for (;;) {
        int signal_number = sigwaitinfo(&waited, NULL);
        if (signal_number == SIGCHLD) {
            int status = 0;
            pid_t ended;
            while ((ended = waitpid(-1, &status, WNOHANG)) > 0 && ended != program)
                ;
            if (ended != program)
                continue;
            kill_tree(true);
            return WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
        }
        if (signal_number != SIGALRM) {
            kill_tree(false);
            return 128 + signal_number;
        }
        double cpu_s = tree_cpu_s();
        if (cpu_s > cpu_limit_s)
            cpu_s = tree_cpu_s(); /* a process that ended between two readings was counted twice */
        idle_s += 1e-3 * SAMPLE_MS;
        if (fabs(cpu_s - counted_from_s) >= 0.02 * idle_limit_s)
            idle_s = 0, counted_from_s = cpu_s;
        if (cpu_s > cpu_limit_s)
            fprintf(stderr, "%s: stopped: used more than %g s of CPU time\n", name, cpu_limit_s);
        else if (idle_s >= idle_limit_s)
            fprintf(stderr, "%s: stopped: no CPU time used for %g s (less than 2%%)\n", name, idle_limit_s);
        else
            continue;
        kill_tree(false);
        return STOPPED;
    }
}
