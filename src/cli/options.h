/* argp with errors as values: argp prints two lines of its own and exits, whereas here a mistake on the command line
 * becomes a diagnostic that names the option at fault and the nearest right one. --help, --usage and --version are
 * argp's: they print and exit. Ownership: nothing is kept. */
#pragma once

#include "base/status.h"
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* One option of a command, and what is done with its value. */
typedef struct command_option {
    const char *name; /* without its "--" */
    int letter;       /* 'o' for -o; 0 for none */
    const char *form; /* of its value; NULL when it takes none */
    const char *purpose;
    /* Fills in what lies `at` bytes into the request. value is NULL where there is none. */
    status (*take)(const struct command_option *o, void *request, const char *value, diagnostic *why);
    size_t at;
    int64_t lowest, highest; /* of option_integer */
    const char *parameter;   /* of what stands for a parameter */
} command_option;

/* How a field of the request is filled in. */
#define OPTION_FILLS(function, type, field) .take = function, .at = offsetof(type, field)
status option_text(const command_option *o, void *request, const char *value, diagnostic *why);    /* const char * */
status option_flag(const command_option *o, void *request, const char *value, diagnostic *why);    /* bool */
status option_integer(const command_option *o, void *request, const char *value, diagnostic *why); /* int64_t */

/* Of a request of that type with a bool csv. */
#define OPTION_CSV(type)                                                                                \
    {                                                                                                   \
        "csv", 0, NULL, "print the table as CSV, with all digits", OPTION_FILLS(option_flag, type, csv) \
    }

/* A command line: its options, and the words that are none, which go into a list of const char *. */
typedef struct command_form {
    const command_option *options; /* the last has no name; NULL for none */
    const char *words, *about;
    size_t words_at, words_most;
    const char *excess, *excess_remedy; /* of a further word, as "'%s' is one too many"; NULL: argp's own error */
    void (*word)(void *request, const char *word); /* in place of a list that has an end; or NULL */
    bool ends_at_word;                             /* what follows the first word is not read */
} command_form;

/* Reads a command line into the request. */
status command_form_read(const command_form *form, int argc, char **argv, void *request, diagnostic *why);

/* STATUS_BAD_INPUT, located: at a command or an option, and its value unless that is NULL. */
status options_wrong(const char *where, const char *value, diagnostic *why, const char *remedy, const char *what, ...)
    __attribute__((format(printf, 5, 6)));

/* Locates a mistake on the command line: at the words of the command without the program's own ("study run"). */
void options_locate(diagnostic *why, const char *program);

/* The value of an option as an integer lowest..highest. */
status options_integer(const char *option, const char *value, int64_t lowest, int64_t highest, int64_t *out,
                       diagnostic *why);

/* The value of an option as count numbers with commas between them, blanks around them allowed; form says which, as
 * "X,Y,Z". */
status options_reals(const char *option, const char *value, const char *form, size_t count, double *out,
                     diagnostic *why);

/* Which of the words value is, by its number; else *which stays, and the mistake is as of options_unknown_word, located
 * at a command or an option. */
status options_choice(const char *where, const char *what, const char *value, const char *const *words, size_t count,
                      int *which, diagnostic *why);

/* "there is no WHAT 'wrong'", with the nearest of words as the remedy, or else all of them. */
status options_unknown_word(const char *what, const char *wrong, const char *const *words, size_t count,
                            diagnostic *why);
