#include "base/float_environment.h"
#include "cli/cli.h"
#include "cli/terminal.h"
#include <argp.h>
#include <stdio.h>
#include <string.h>

static status command_help(int argc, char **argv, diagnostic *why);

static const command commands[] = {
    {"render", "render a scene; write the picture, the counts, the times", command_render},
    {"animate", "render a film of a scene whose slimes move", command_animate},
    {"scene", "check, change and write a scene; build one without an editor", command_scene},
    {"trace", "take one ray apart: the whole tree that it grows into", command_trace},
    {"fan", "send many rays through the scene: their focus, their caustic", command_fan},
    {"params", "print the table of parameters", command_params},
    {"media", "print the catalogue of media: refractive indices, dispersion, sources", command_media},
    {"mesh", "make a mesh of triangles, describe it, write it for other programs", command_mesh},
    {"study", "run, list, merge and sum up studies", command_study},
    {"compare", "say how far two pictures lie apart", command_compare},
    {"realism", "measure how far what is traced lies from textbook optics", command_realism},
    {"motion", "measure how slimes move beside textbook mechanics", command_motion},
    {"lab", "open the laboratory in the browser", command_lab},
    {"machine", "print what this machine is, and what could disturb a measurement", command_machine},
    {"help", "explain a command", command_help},
};

enum { COMMAND_COUNT = sizeof commands / sizeof commands[0] };

static const char about[] = "Cuvette, a ray-tracing laboratory: describe a scene, sweep any of its parameters, get the "
                            "picture, the exact ray counts and honest times.";

static status dispatch(int argc, char **argv, diagnostic *why)
{
    return command_dispatch(commands, COMMAND_COUNT, about, argc, argv, why);
}

/* "cuvette help study run" is "cuvette study run --help". */
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
    fprintf(stream, "cuvette %s\n", CUVETTE_VERSION);
}

int main(int argc, char **argv)
{
    float_environment_set(); /* the start-up code of a library can have left another one */
    terminal_prepare();
    argp_err_exit_status = STATUS_BAD_INPUT;
    argp_program_version_hook = print_version;
    char program[] = "cuvette";
    char *alone[] = {program, NULL};
    if (argc < 1)
        argc = 1, argv = alone;
    argv[0] = program;
    diagnostic why = {0};
    status result = dispatch(argc, argv, &why);
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
