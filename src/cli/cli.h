/* The commands of the program `cuvette`, and the dispatcher that they share. A command parses its options with argp,
 * calls the modules, and returns a status with the reason in a diagnostic. main.c prints the error and maps the status
 * to the exit code (0 success, 1 system failure, 2 invalid input, 130 interrupted). Data goes to standard output,
 * progress and errors to standard error. */
#pragma once

#include "base/status.h"

#include <stddef.h>

typedef struct command {
    const char *name;
    const char *purpose; /* one help line without a full stop, at most 67 columns */
    /* argv[0] is the program and the command ("cuvette render"), followed by the command's own arguments. */
    status (*run)(int argc, char **argv, diagnostic *why);
} command;

status command_render(int argc, char **argv, diagnostic *why);
status command_animate(int argc, char **argv, diagnostic *why);
status command_scene(int argc, char **argv, diagnostic *why);
status command_trace(int argc, char **argv, diagnostic *why);
status command_fan(int argc, char **argv, diagnostic *why);
status command_section(int argc, char **argv, diagnostic *why);
status command_params(int argc, char **argv, diagnostic *why);
status command_media(int argc, char **argv, diagnostic *why);
status command_lens(int argc, char **argv, diagnostic *why);
status command_mesh(int argc, char **argv, diagnostic *why);
status command_study(int argc, char **argv, diagnostic *why);
status command_fit(int argc, char **argv, diagnostic *why);
status command_compare(int argc, char **argv, diagnostic *why);
status command_realism(int argc, char **argv, diagnostic *why);
status command_motion(int argc, char **argv, diagnostic *why);
status command_lens_report(int argc, char **argv, diagnostic *why); /* `lens report`, by command_lens */
status command_lesson(int argc, char **argv, diagnostic *why);
status command_lab(int argc, char **argv, diagnostic *why);
status command_machine(int argc, char **argv, diagnostic *why);

/* Parses "program [OPTION...] COMMAND ..." and runs that command of the table. about is the first paragraph of the
 * help, above the list of commands. */
status command_dispatch(const command *table, size_t count, const char *about, int argc, char **argv, diagnostic *why);
