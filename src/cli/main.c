/* The entry point of `cuvette`: the table of commands, --version, and the exit code. */
#include "base/float_environment.h"
#include "base/installed.h"
#include "base/json_build.h"
#include "base/os_process.h"
#include "cli/cli.h"
#include "cli/terminal.h"

#include <argp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static status command_help(int argc, char **argv, diagnostic *why);

static const command commands[] = {
    {"render", "render a scene; write the image, the ray counts and the times", command_render},
    {"animate", "render an animation of a scene with moving slimes", command_animate},
    {"scene", "check, edit and write a scene, or build a new one", command_scene},
    {"trace", "trace one ray and print its ray tree", command_trace},
    {"fan", "trace a fan of rays and find its focus and caustic", command_fan},
    {"section", "cut a plane through a scene and write its outlines", command_section},
    {"params", "list all parameters, or those of a scene", command_params},
    {"media", "print the media catalogue: refractive index, dispersion, source", command_media},
    {"lens", "read a lens prescription; write it as a scene or a lens file", command_lens},
    {"mesh", "describe, generate or convert a triangle mesh", command_mesh},
    {"study", "run and summarise studies (parameter sweeps)", command_study},
    {"fit", "choose parameters so that measured quantities meet targets", command_fit},
    {"compare", "compare two images", command_compare},
    {"realism", "compare the optics of a scene, as traced, with textbook formulas", command_realism},
    {"motion", "compare the motion of slimes (soft bodies) with mechanics", command_motion},
    {"lesson", "list and check the lessons of the laboratory", command_lesson},
    {"lab", "open the laboratory in the browser", command_lab},
    {"machine", "describe this machine and what may disturb timings on it", command_machine},
    {"help", "print help for a command", command_help},
};

enum { COMMAND_COUNT = sizeof commands / sizeof commands[0] };

static const char about[] = "Cuvette, a ray-tracing laboratory: describe a scene, sweep any of its parameters, and get "
                            "the image, exact ray counts and reliable timings.";

static status dispatch(int argc, char **argv, diagnostic *why)
{
    return command_dispatch(commands, COMMAND_COUNT, about, argc, argv, why);
}

/* Runs "cuvette help study run" as "cuvette study run --help". */
static status command_help(int argc, char **argv, diagnostic *why)
{
    enum { WORDS_MAX = 8 };
    char program[] = "cuvette", help[] = "--help";
    char *words[WORDS_MAX + 1] = {program};
    int count = 1;
    for (int i = 1; i < argc && count < WORDS_MAX - 1; i++) {
        if (strcmp(argv[i], "help") == 0 || argv[i][0] == '-')
            continue;
        words[count++] = argv[i];
    }
    words[count++] = help;
    return dispatch(count, words, why);
}

static void print_version(FILE *stream, struct argp_state *state)
{
    (void)state;
    const char *commit = build_commit();
    fprintf(stream, "cuvette %s (build %s%s%s)\n", CUVETTE_VERSION, build_id(), commit[0] ? ", commit " : "", commit);
}

/* Notes that under mpirun every process of `cuvette` does all the work: most likely cuvette-mpi was meant. The
 * variables are OpenMPI's. */
static void note_repeated_work(int argc, char **argv)
{
    const char *rank = getenv("OMPI_COMM_WORLD_RANK"), *ranks = getenv("OMPI_COMM_WORLD_SIZE");
    const bool is_frame = argc > 1 && (strcmp(argv[1], "render") == 0 || strcmp(argv[1], "animate") == 0);
    if (is_frame && rank && ranks && strcmp(rank, "0") == 0 && strcmp(ranks, "1") != 0)
        terminal_note("each process of this MPI job does all the work; cuvette-mpi divides it among them");
}

typedef struct command_line {
    int argc;
    char **argv;
} command_line;

static int run(void *context)
{
    const command_line *given = context;
    diagnostic why = {0};
    status result = dispatch(given->argc, given->argv, &why);
    diagnostic unwritten = {0};
    status flushed = terminal_flush(&unwritten);
    if (result == STATUS_OK && flushed != STATUS_OK) {
        why = unwritten;
        result = flushed;
    }
    if (result != STATUS_OK)
        terminal_error(&why);
    return (int)result;
}

int main(int argc, char **argv)
{
    if (!spawn_follow_parent())
        return STATUS_FAILURE;
    float_environment_set(); /* the start-up code of a library may have changed it */
    json_memory_reserve();
    terminal_prepare();
    argp_err_exit_status = STATUS_BAD_INPUT;
    argp_program_version_hook = print_version;
    char program[] = "cuvette";
    char *program_only[] = {program, NULL};
    if (argc < 1)
        argc = 1, argv = program_only;
    argv[0] = program;
    note_repeated_work(argc, argv);
    return os_call_with_stack(run, &(command_line){argc, argv});
}
