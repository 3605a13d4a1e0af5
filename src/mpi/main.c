/* The entry point of `cuvette-mpi`: commands of `cuvette` on the ranks of an MPI job. Rank 0 reads the command line and
 * writes the files; the other ranks follow it. */
#include "base/cancel.h"
#include "base/float_environment.h"
#include "base/installed.h"
#include "base/json_build.h"
#include "base/os_process.h"
#include "base/text.h"
#include "cli/cli.h"
#include "cli/scene_input.h"
#include "cli/study.h"
#include "cli/terminal.h"
#include "mpi/tracing.h"

#include <argp.h>
#include <errno.h>
#include <fcntl.h>
#include <mpi.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

/* --- studies --- */

/* Each rank runs a shard with the program `cuvette` next to this one; then rank 0 merges. The shards need another
 * program, because a study with fresh processes starts processes, which must not be MPI ranks. */

static void pause_s(double s)
{
    nanosleep(&(struct timespec){.tv_nsec = (long)(s * 1e9)}, NULL);
}

/* The highest status of all ranks. MPI's wait would keep a processor busy, and disturb ranks that still measure. */
static status agree(status code)
{
    int mine = (int)code, highest = 0, there = 0;
    MPI_Request request;
    MPI_Iallreduce(&mine, &highest, 1, MPI_INT, MPI_MAX, MPI_COMM_WORLD, &request);
    for (; !there; pause_s(0.002))
        MPI_Test(&request, &there, MPI_STATUS_IGNORE);
    return (status)highest;
}

static char *program_path(void)
{
    char path[4096];
    const ssize_t length = readlink("/proc/self/exe", path, sizeof path - 1);
    if (length <= 0)
        return NULL;
    path[length] = '\0';
    char *slash = strrchr(path, '/');
    *slash = '\0';
    return text_format("%s/cuvette", path);
}

/* Waits for the process to end; forwards a cancellation once. */
static int wait_for_end(pid_t pid)
{
    bool forwarded = false;
    for (int ended = 0;; pause_s(0.01)) {
        if (waitpid(pid, &ended, WNOHANG) == pid)
            return WIFEXITED(ended) ? WEXITSTATUS(ended) : STATUS_FAILURE;
        if (!forwarded && cancel_asked()) {
            kill(pid, SIGTERM);
            forwarded = true;
        }
    }
}

/* Runs cuvette with the arguments, which end with NULL. The program prints its errors. loud: keeps standard output. */
static status run_cuvette(char **arguments, bool loud, diagnostic *why)
{
    char *program = program_path();
    const int out = loud ? STDOUT_FILENO : open("/dev/null", O_WRONLY | O_CLOEXEC);
    pid_t pid = 0;
    const int error = program ? spawn_bound(&pid, program, arguments, out, STDERR_FILENO) : ENOMEM;
    if (!loud)
        close(out);
    if (error == ENOENT)
        diagnose_at(why, program, STATUS_FAILURE, "install cuvette next to cuvette-mpi",
                    "cannot start cuvette: there is no such file");
    else if (error)
        system_error(why, STATUS_FAILURE, program, "cannot start cuvette", error, "install cuvette again");
    free(program);
    return error ? STATUS_FAILURE : (status)wait_for_end(pid);
}

/* Runs "cuvette study run" with the arguments of the shard, then the caller's. */
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
    char program[] = "cuvette", group[] = "study", verb[] = "merge", results[] = "--results", rest[] = "--";
    THEN(code, all ? STATUS_OK : out_of_memory(why));
    if (code == STATUS_OK) {
        int at = 0;
        all[at++] = program, all[at++] = group, all[at++] = verb, all[at++] = results;
        all[at++] = (char *)(uintptr_t)request.results, all[at++] = rest;
        memcpy(all + at, request.files, request.file_count * sizeof *all);
        code = run_cuvette(all, true, why);
    }
    free(all);
    study_request_release(&request);
    return code;
}

/* Whether the command only prints help, a plan, or that no study is given; then only rank 0 runs it. */
static bool measures_nothing(int argc, char **argv)
{
    static const char *const words[] = {"--help", "-?", "--usage", "--version", "-V", "--dry-run", "-n"};
    for (int i = 3; i < argc; i++)
        for (size_t k = 0; k < sizeof words / sizeof words[0]; k++)
            if (strcmp(argv[i], words[k]) == 0)
                return true;
    return argc == 3;
}

/* Runs "study run" with those arguments (argv[0] is the program, then the command) on this rank; all ranks call it.
 * Returns the highest status of all ranks, with the reason on ranks that have one. If a rank fails, the rows of the
 * others stay, and the same command continues from there, even with another number of ranks. */
static status shards_run(int argc, char **argv, int rank, int ranks, diagnostic *why)
{
    if (measures_nothing(argc, argv))
        return rank == 0 ? run_shard(argc, argv, 0, 1, why) : STATUS_OK;
    const status mine = run_shard(argc, argv, rank, ranks, why), all = agree(mine);
    return all == STATUS_OK && rank == 0 && ranks > 1 ? merge(argc, argv, why) : all;
}

/* --- the program --- */

/* For all study commands except 'study run', which run() starts on all ranks before a command is chosen. */
static status command_shards(int argc, char **argv, diagnostic *why)
{
    (void)argc, (void)argv;
    return diagnose_at(why, "cuvette-mpi study", STATUS_BAD_INPUT, "use 'cuvette study' for other commands",
                       "of the study commands, cuvette-mpi supports only 'study run FILE'");
}

static const command commands[] = {
    {"render", "render one frame on all ranks; write the image, counts and times", command_render},
    {"animate", "render an animation, each frame on all ranks", command_animate},
    {"study", "run a study, one shard on each rank, and merge the rows", command_shards},
};

static const char about[] = "Cuvette on many machines: the ranks of an MPI job share each frame. For example:\n"
                            "  mpirun -n 4 cuvette-mpi render rod.yaml -o rod.png\n"
                            "The film is the same for any number of ranks. See cuvette-mpi(1).";

static lead *leader; /* rank 0's, for the exit handler */

/* Runs at exit(), which --help and errors of the command line call, too. */
static void leave(void)
{
    int finalized = 0;
    MPI_Finalized(&finalized);
    if (finalized)
        return;
    lead_destroy(leader);
    leader = NULL;
    MPI_Finalize();
}

static status begin(int *argc, char ***argv, int *rank, int *ranks, diagnostic *why)
{
    int level = 0;
    if (MPI_Init_thread(argc, argv, MPI_THREAD_SERIALIZED, &level) != MPI_SUCCESS || level < MPI_THREAD_SERIALIZED)
        return diagnose(why, STATUS_FAILURE, "use another MPI library", "MPI does not start with threads");
    MPI_Comm_rank(MPI_COMM_WORLD, rank);
    MPI_Comm_size(MPI_COMM_WORLD, ranks);
    float_environment_set(); /* a library may have changed it */
    return STATUS_OK;
}

/* All ranks must run the same build: structures are sent as bytes, and films of different builds may differ. All ranks
 * call this function. */
static status check_builds(int rank, int ranks, diagnostic *why)
{
    enum { LENGTH = 64 };
    char mine[LENGTH] = "", first[LENGTH];
    strncpy(mine, build_id(), LENGTH - 1);
    memcpy(first, mine, LENGTH);
    MPI_Bcast(first, LENGTH, MPI_CHAR, 0, MPI_COMM_WORLD);
    const int other = memcmp(mine, first, LENGTH) == 0 ? ranks : rank;
    int lowest = ranks;
    MPI_Allreduce(&other, &lowest, 1, MPI_INT, MPI_MIN, MPI_COMM_WORLD);
    if (lowest == ranks)
        return STATUS_OK;
    return diagnose(why, STATUS_BAD_INPUT, "install the same cuvette-mpi on all nodes",
                    "rank %d runs another build than rank 0", lowest);
}

static status run(int argc, char **argv, int rank, int ranks, diagnostic *why)
{
    TRY(check_builds(rank, ranks, why));
    if (argc > 2 && strcmp(argv[1], "study") == 0 && strcmp(argv[2], "run") == 0)
        return shards_run(argc, argv, rank, ranks, why);
    if (rank > 0) {
        signal(SIGINT, SIG_IGN); /* rank 0 ends the frame */
        signal(SIGTERM, SIG_IGN);
        return follow(why);
    }
    TRY(lead_create(ranks, &leader, why));
    scene_input_distribute(lead_distribution(leader));
    const status code = command_dispatch(commands, sizeof commands / sizeof commands[0], about, argc, argv, why);
    diagnostic unwritten = {0};
    const status flushed = terminal_flush(&unwritten);
    if (code != STATUS_OK || flushed == STATUS_OK)
        return code;
    *why = unwritten;
    return flushed;
}

int main(int argc, char **argv)
{
    int rank = 0, ranks = 1;
    diagnostic why = {0};
    json_memory_reserve();
    terminal_prepare();
    argp_err_exit_status = STATUS_BAD_INPUT;
    status code = begin(&argc, &argv, &rank, &ranks, &why);
    if (code == STATUS_OK) {
        atexit(leave);
        char program[] = "cuvette-mpi";
        argv[0] = program;
        code = run(argc, argv, rank, ranks, &why);
    }
    if (code != STATUS_OK && why.what[0])
        terminal_error(&why);
    return (int)code;
}
