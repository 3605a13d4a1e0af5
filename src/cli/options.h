/* The command-line parser: argp with errors as values. Where argp would print two lines and exit, a mistake becomes a
 * diagnostic with the wrong option and the nearest valid one. argp itself handles --help, --usage and --version, which
 * print and exit. Ownership: the parser keeps no pointer. */
#pragma once

#include "base/status.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* One option of a command, and the function that stores its value. */
typedef struct command_option {
    const char *name; /* without "--" */
    int letter;       /* 'o' for -o; 0 for none */
    const char *form; /* placeholder of the value in the help ("FILE"); NULL for a flag */
    const char *purpose;
    /* Stores the value in the request, at the byte offset `at`. value is NULL for a flag. */
    status (*store)(const struct command_option *o, void *request, const char *value, diagnostic *why);
    size_t at;
    int64_t lowest, highest; /* range of an option_integer */
    const char *parameter;   /* scene parameter that the option sets, or NULL */
    bool optional;           /* the value may be missing (--name or --name=VALUE); store receives NULL then */
} command_option;

/* Initialisers of store and at for one field of the request, and the usual functions with the field's type. */
#define OPTION_FILLS(function, type, field) .store = function, .at = offsetof(type, field)
status option_text(const command_option *o, void *request, const char *value, diagnostic *why);    /* const char * */
status option_flag(const command_option *o, void *request, const char *value, diagnostic *why);    /* bool */
status option_integer(const command_option *o, void *request, const char *value, diagnostic *why); /* int64_t */

/* The option --csv of a request type that has a field `bool csv`. */
#define OPTION_CSV(type)                                                                               \
    {                                                                                                  \
        "csv", 0, NULL, "print the table as CSV with all digits", OPTION_FILLS(option_flag, type, csv) \
    }

/* A command line: its options, and its arguments, which are stored in an array of const char * in the request. */
typedef struct command_form {
    const command_option *options; /* ended by an entry without a name; NULL for none */
    const char *synopsis, *about;
    size_t arguments_at, argument_limit; /* offset of the array in the request, and its length */
    const char *excess, *excess_remedy;  /* error for a surplus argument, with at most one %s; NULL: a general one */
    void (*store_argument)(
        void *request, const char *argument); /* stores each argument, of any number; NULL: they go to arguments_at */
    bool ends_at_argument;                    /* parsing stops after the first argument */
} command_form;

/* Reads a command line into the request. */
status command_form_read(const command_form *form, int argc, char **argv, void *request, diagnostic *why);

/* Reports STATUS_BAD_INPUT at a command or an option, followed by its value unless that is NULL. */
status options_wrong(const char *where, const char *value, diagnostic *why, const char *remedy, const char *what, ...)
    __attribute__((format(printf, 5, 6)));

/* Locates an error at the command: program without its first word ("study run" of "cuvette study run"). */
void options_locate(diagnostic *why, const char *program);

/* Parses the value of an option as an integer lowest..highest. */
status options_integer(const char *option, const char *value, int64_t lowest, int64_t highest, int64_t *out,
                       diagnostic *why);

/* Parses the value of an option as count numbers separated by commas; blanks around them are allowed. form describes
 * them in the error ("X,Y,Z"). */
status options_reals(const char *option, const char *value, const char *form, size_t count, double *out,
                     diagnostic *why);

/* Sets *which to the index of value in words. If value is not one of them, leaves *which unchanged and reports the
 * error of options_unknown_word at where (a command or an option). */
status options_choice(const char *where, const char *what, const char *value, const char *const *words, size_t count,
                      int *which, diagnostic *why);

/* Reports "unknown WHAT 'wrong'". The remedy is the nearest of the words, or all of them if none is near. */
status options_unknown_word(const char *what, const char *wrong, const char *const *words, size_t count,
                            diagnostic *why);
