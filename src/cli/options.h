/* argp with errors as values: argp prints two lines of its own and exits, whereas here a mistake on the command line
 * becomes a diagnostic that names the option at fault and the nearest right one. --help, --usage and --version are
 * argp's: they print and exit. Ownership: nothing is kept. */
#ifndef CUVETTE_CLI_OPTIONS_H
#define CUVETTE_CLI_OPTIONS_H

#include "base/status.h"
#include <argp.h>
#include <stdbool.h>
#include <stdint.h>

/* What a parser of parse_options gets as state->input. A parser that finds a mistake fills *why and returns EINVAL. */
typedef struct options_input {
    void *request;
    diagnostic *why;
} options_input;

/* flags as argp_parse's. */
status options_parse(const struct argp *argp, unsigned flags, int argc, char **argv, void *request, diagnostic *why);

/* Locates a mistake on the command line: at the words of the command without the program's own ("study run"). */
void options_locate(diagnostic *why, const char *program);

/* The value of an option as an integer lowest..highest. */
status options_integer(const char *option, const char *value, int64_t lowest, int64_t highest, int64_t *out,
                       diagnostic *why);

/* The value of an option as count numbers with commas between them, blanks around them allowed; form says which, as
 * "X,Y,Z". */
status options_reals(const char *option, const char *value, const char *form, size_t count, double *out,
                     diagnostic *why);

/* "there is no WHAT 'wrong'", with the nearest of words as the remedy, or else all of them. */
status options_unknown_word(const char *what, const char *wrong, const char *const *words, size_t count,
                            diagnostic *why);

#endif
