/* One shard a rank, by the program `cuvette` next to this one, then the merge. It is another process because the rows
 * of a study with fresh processes are measured by programs that this one must not be: they are not ranks. */
#include "mpi/shards.h"

#include "base/cancel.h"
#include "base/child.h"
#include "base/text.h"
#include "cli/study_request.h"
#include "cli/terminal.h"
#include <errno.h>
#include <fcntl.h>
#include <mpi.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

static void pause_s(double s)
{
    nanosleep(&(struct timespec){.tv_nsec = (long)(s * 1e9)}, NULL);
}

/* The highest status of all ranks. MPI would wait without sleeping, and disturb those that still measure. */
static status agree(status own)
{
    int mine = (int)own, highest = 0, there = 0;
    MPI_Request request;
    MPI_Iallreduce(&mine, &highest, 1, MPI_INT, MPI_MAX, MPI_COMM_WORLD, &request);
    for (; !there; pause_s(0.002))
        MPI_Test(&request, &there, MPI_STATUS_IGNORE);
    return (status)highest;
}

static char *program_path(void)
{
    char own[4096];
    const ssize_t length = readlink("/proc/self/exe", own, sizeof own - 1);
    if (length <= 0)
        return NULL;
    own[length] = '\0';
    char *slash = strrchr(own, '/');
    *slash = '\0';
    return text_format("%s/cuvette", own);
}

/* A stop request is passed on once. */
static int wait_for_end(pid_t pid)
{
    bool told = false;
    for (int ended = 0;; pause_s(0.01)) {
        if (waitpid(pid, &ended, WNOHANG) == pid)
            return WIFEXITED(ended) ? WEXITSTATUS(ended) : STATUS_FAILURE;
        if (!told && cancel_asked()) {
            kill(pid, SIGTERM);
            told = true;
        }
    }
}

/* Runs cuvette with the arguments, which end with NULL. It prints its own error. loud: standard output is kept. */
static status run_cuvette(char **arguments, bool loud, diagnostic *why)
{
    char *program = program_path();
    const int out = loud ? STDOUT_FILENO : open("/dev/null", O_WRONLY | O_CLOEXEC);
    pid_t pid = 0;
    const int error = program ? spawn_bound(&pid, program, arguments, out, STDERR_FILENO) : ENOMEM;
    if (!loud)
        close(out);
    if (error)
        diagnose_at(why, program ? program : "cuvette", STATUS_FAILURE, "install cuvette next to cuvette-mpi",
                    "cannot start it: %s", strerrordesc_np(error));
    free(program);
    return error ? STATUS_FAILURE : (status)wait_for_end(pid);
}

/* "cuvette study run" with the caller's arguments, after those of the shard. */
static status run_shard(int argc, char **argv, int rank, int ranks, diagnostic *why)
{
    char **all = calloc((size_t)argc + 3, sizeof *all), *part = text_format("--shard=%d/%d", rank, ranks);
    char quiet[] = "--quiet", program[] = "cuvette";
    status code = all && part ? STATUS_OK : out_of_memory(why);
    if (code == STATUS_OK) {
        int at = 0;
        all[at++] = program, all[at++] = argv[1], all[at++] = argv[2];
        if (ranks > 1)
            all[at++] = part;
        if (rank > 0)
            all[at++] = quiet;
        memcpy(all + at, argv + 3, (size_t)(argc - 3) * sizeof *all);
        code = run_cuvette(all, rank == 0, why);
    }
    free(all);
    free(part);
    return code;
}

static status merge(int argc, char **argv, diagnostic *why)
{
    study_request request;
    status code = study_request_parse(STUDY_RUN, argc - 2, argv + 2, &request, why);
    char **all = calloc(request.file_count + 7, sizeof *all);
    char program[] = "cuvette", study[] = "study", verb[] = "merge", results[] = "--results", rest[] = "--";
    THEN(code, all ? STATUS_OK : out_of_memory(why));
    if (code == STATUS_OK) {
        int at = 0;
        all[at++] = program, all[at++] = study, all[at++] = verb, all[at++] = results;
        all[at++] = (char *)(uintptr_t)request.results, all[at++] = rest;
        memcpy(all + at, request.files, request.file_count * sizeof *all);
        code = run_cuvette(all, true, why);
    }
    free(all);
    study_request_release(&request);
    return code;
}

/* Help and plans are printed once. */
static bool measures_nothing(int argc, char **argv)
{
    static const char *const words[] = {"--help", "-?", "--usage", "--version", "-V", "--dry-run", "-n"};
    for (int i = 3; i < argc; i++)
        for (size_t k = 0; k < sizeof words / sizeof words[0]; k++)
            if (strcmp(argv[i], words[k]) == 0)
                return true;
    return false;
}

status shards_run(int argc, char **argv, int rank, int ranks, diagnostic *why)
{
    if (measures_nothing(argc, argv))
        return rank == 0 ? run_shard(argc, argv, 0, 1, why) : STATUS_OK;
    const status own = run_shard(argc, argv, rank, ranks, why), all = agree(own);
    return all == STATUS_OK && rank == 0 && ranks > 1 ? merge(argc, argv, why) : all;
}
