/* The entry point of `cuvette-mpi`: commands of `cuvette` on the ranks of an MPI job. Rank 0 reads the command line and
 * writes the files; the other ranks follow it. */
#include "base/json_build.h"
#include "base/build_id.h"
#include "base/float_environment.h"
#include "cli/cli.h"
#include "cli/scene_input.h"
#include "cli/terminal.h"
#include "mpi/follow.h"
#include "mpi/lead.h"
#include "mpi/shards.h"
#include <argp.h>
#include <mpi.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>

/* All ranks run shards before any command is chosen: see run. */
static status command_shards(int argc, char **argv, diagnostic *why)
{
    (void)argc, (void)argv;
    return diagnose_at(why, "cuvette-mpi study", STATUS_BAD_INPUT, "use 'cuvette study' for the others",
                       "the only command of studies here is 'study run'");
}

static const command commands[] = {
    {"render", "render one frame on all ranks; write the image, counts and times", command_render},
    {"animate", "render an animation, each frame on all ranks", command_animate},
    {"study", "run a study, one shard on each rank, and merge the rows", command_shards},
};

static const char about[] = "Cuvette on many machines: the ranks of an MPI job share each frame. For example:\n"
                            "  mpirun -n 4 cuvette-mpi render rod.yaml -o rod.png\n"
                            "The film is the same for any number of ranks. cuvette-mpi(1) tells more.";

static lead *leader; /* of rank 0, for the exit handler */

/* exit() is called by --help and after errors of the command line too. */
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

/* Structures travel as their bytes, and films of different builds may differ. All ranks call it. */
static status check_builds(int rank, int ranks, diagnostic *why)
{
    enum { LENGTH = 64 };
    char own[LENGTH] = "", first[LENGTH];
    strncpy(own, build_id(), LENGTH - 1);
    memcpy(first, own, LENGTH);
    MPI_Bcast(first, LENGTH, MPI_CHAR, 0, MPI_COMM_WORLD);
    const int other = memcmp(own, first, LENGTH) == 0 ? ranks : rank;
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
    if (argc > 3 && strcmp(argv[1], "study") == 0 && strcmp(argv[2], "run") == 0)
        return shards_run(argc, argv, rank, ranks, why);
    if (rank > 0) {
        signal(SIGINT, SIG_IGN); /* rank 0 ends the frame */
        signal(SIGTERM, SIG_IGN);
        return follow(why);
    }
    TRY(lead_create(ranks, &leader, why));
    scene_input_share(lead_sharing(leader));
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
