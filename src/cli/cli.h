/* The program `cuvette`: a table of subcommands, and what they share. A subcommand parses its own options with argp,
 * does its work through the rooms below, and returns a status with the reason in a diagnostic; main.c alone prints
 * the error and turns the status into the exit code (0 done, 1 the machine failed, 2 wrong input, 130 interrupted).
 * Data goes to standard output, progress and errors to standard error. */
#pragma once

#include "base/status.h"
#include <stddef.h>

typedef struct command {
    const char *name;
    const char *purpose; /* one line for the help, no full stop */
    /* argv[0] is the words so far ("cuvette render"); the rest is the subcommand's own. */
    status (*run)(int argc, char **argv, diagnostic *why);
} command;

status command_render(int argc, char **argv, diagnostic *why);
status command_animate(int argc, char **argv, diagnostic *why);
status command_scene(int argc, char **argv, diagnostic *why);
status command_trace(int argc, char **argv, diagnostic *why);
status command_fan(int argc, char **argv, diagnostic *why);
status command_params(int argc, char **argv, diagnostic *why);
status command_media(int argc, char **argv, diagnostic *why);
status command_mesh(int argc, char **argv, diagnostic *why);
status command_study(int argc, char **argv, diagnostic *why);
status command_compare(int argc, char **argv, diagnostic *why);
status command_realism(int argc, char **argv, diagnostic *why);
status command_motion(int argc, char **argv, diagnostic *why);
status command_lab(int argc, char **argv, diagnostic *why);
status command_machine(int argc, char **argv, diagnostic *why);

/* Parses "program [OPTION...] COMMAND ..." and runs the command of the table that it names. about stands above the list
 * of commands in the help. */
status command_dispatch(const command *table, size_t count, const char *about, int argc, char **argv, diagnostic *why);
