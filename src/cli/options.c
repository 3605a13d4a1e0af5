/* The command-line parser: options and arguments by argp, with diagnostics in place of argp's error output. */
#include "cli/options.h"
#include "base/number.h"
#include "base/text.h"

#include <argp.h>
#include <errno.h>
#include <getopt.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { OPTIONS_MAX = 32, KEY_USAGE = 0x10000, KEY_HELP, KEY_OF_ARGP };

/* The options in the form of getopt_long. */
typedef struct getopt_table {
    struct option options[OPTIONS_MAX + 6];
    const char *names[OPTIONS_MAX + 6];
    size_t count, documented; /* documented: the first ones, which the help lists */
    char short_options[2 * OPTIONS_MAX + 8];
} getopt_table;

static void add(getopt_table *table, const char *name, int key, int takes_value)
{
    table->options[table->count] = (struct option){name, takes_value, NULL, key};
    table->names[table->count++] = name;
    if (key > ' ' && key < 127) {
        size_t end = strlen(table->short_options);
        table->short_options[end] = (char)key;
        if (takes_value == required_argument)
            table->short_options[end + 1] = ':';
    }
}

static void make_table(const struct argp *argp, unsigned flags, getopt_table *table)
{
    memset(table, 0, sizeof *table);
    strcpy(table->short_options, flags & ARGP_IN_ORDER ? "+:" : ":");
    for (const struct argp_option *o = argp->options; o && o->name && table->count < OPTIONS_MAX; o++)
        add(table, o->name, o->key,
            !o->arg                          ? no_argument
            : o->flags & OPTION_ARG_OPTIONAL ? optional_argument
                                             : required_argument);
    add(table, "help", KEY_HELP, no_argument);
    add(table, "usage", KEY_USAGE, no_argument);
    add(table, "version", 'V', no_argument);
    table->documented = table->count;
    add(table, "program-name", KEY_OF_ARGP, optional_argument); /* argp adds these two, for its tests */
    add(table, "HANG", KEY_OF_ARGP, optional_argument);
}

static const char *name_of_key(const getopt_table *table, int key)
{
    for (size_t i = 0; i < table->count; i++)
        if (table->options[i].val == key)
            return table->names[i];
    return NULL;
}

static size_t count_with_prefix(const getopt_table *table, const char *prefix)
{
    size_t found = 0;
    for (size_t i = 0; i < table->count; i++)
        found += strncmp(table->names[i], prefix, strlen(prefix)) == 0;
    return found;
}

static status unknown_long_option(const getopt_table *table, const char *program, const char *typed, diagnostic *why)
{
    char word[64], remedy[192];
    size_t length = strcspn(typed + 2, "=");
    snprintf(word, sizeof word, "%.*s", (int)(length < 63 ? length : 63), typed + 2);
    if (count_with_prefix(table, word) > 1) {
        snprintf(remedy, sizeof remedy, "write the full name; '%s --help' lists the options", program);
        return diagnose(why, STATUS_BAD_INPUT, remedy, "option '--%s' is ambiguous", word);
    }
    const char *nearest = text_nearest(word, table->names, table->documented);
    if (nearest)
        snprintf(remedy, sizeof remedy, "did you mean '--%s'?", nearest);
    else
        snprintf(remedy, sizeof remedy, "'%s --help' lists the options", program);
    return diagnose(why, STATUS_BAD_INPUT, remedy, "unknown option '--%s'", word);
}

static status explain(const getopt_table *table, int result, const char *program, const char *typed, diagnostic *why)
{
    char remedy[192];
    const char *known = name_of_key(table, optopt);
    if (result == ':') {
        snprintf(remedy, sizeof remedy, "see '%s --help' for the accepted values", program);
        return diagnose(why, STATUS_BAD_INPUT, remedy, "option '--%s' requires a value", known ? known : "?");
    }
    if (optopt == 0)
        return unknown_long_option(table, program, typed, why);
    if (known)
        return diagnose(why, STATUS_BAD_INPUT, "remove the '=' and the value", "option '--%s' takes no value", known);
    snprintf(remedy, sizeof remedy, "'%s --help' lists the options", program);
    return diagnose(why, STATUS_BAD_INPUT, remedy, "unknown option '-%c'", optopt);
}

/* Parses a copy of argv with getopt_long first, because argp does not report which option is wrong. */
static status check(const struct argp *argp, unsigned flags, int argc, char **argv, diagnostic *why)
{
    getopt_table table;
    make_table(argp, flags, &table);
    char **copy = calloc((size_t)argc + 1, sizeof *copy);
    if (!copy)
        return out_of_memory(why);
    memcpy(copy, argv, (size_t)argc * sizeof *copy);
    status result = STATUS_OK;
    optind = 0; /* glibc: restart the scan */
    opterr = 0;
    for (;;) {
        int key = getopt_long(argc, copy, table.short_options, table.options, NULL);
        bool leaves = key == -1 || key == KEY_HELP || key == KEY_USAGE || key == 'V' || (key == '?' && optopt == '?');
        if (leaves) /* argp prints the help and exits */
            break;
        if (key == KEY_OF_ARGP)
            optopt = 0, key = '?'; /* users get an error as for an unknown option */
        if (key == '?' || key == ':') {
            result = explain(&table, key, argv[0], copy[optind - 1], why);
            options_locate(why, argv[0]);
            break;
        }
    }
    free(copy);
    return result;
}

void options_locate(diagnostic *why, const char *program)
{
    const char *words = strchr(program, ' ');
    diagnostic_locate(why, words ? words + 1 : "command line", 0, 0);
}

/* --- command lines --- */

enum { KEY_FIRST = 0x100 };

typedef struct form_reading {
    const command_form *form;
    const char *program;
    void *request;
    size_t arguments;
    diagnostic *why;
    status wrong; /* the status behind EINVAL */
} form_reading;

static error_t parse_word(form_reading *reading, const char *word, struct argp_state *state)
{
    const command_form *form = reading->form;
    if (form->store_argument)
        return form->store_argument(reading->request, word), 0;
    if (reading->arguments == form->argument_limit) {
        char remedy[192];
        snprintf(remedy, sizeof remedy, "see '%s --help'", reading->program);
        options_wrong(NULL, NULL, reading->why, form->excess ? form->excess_remedy : remedy,
                      form->excess ? form->excess : "unexpected argument '%.128s'", word);
        options_locate(reading->why, reading->program);
        return EINVAL;
    }
    ((const char **)((char *)reading->request + form->arguments_at))[reading->arguments++] = word;
    if (form->ends_at_argument)
        state->next = state->argc;
    return 0;
}

/* Returns EINVAL for an error, with the reason in *why. */
static error_t handle_key(int key, char *value, struct argp_state *state)
{
    form_reading *reading = state->input;
    if (key == ARGP_KEY_ARG)
        return parse_word(reading, value, state);
    for (const command_option *o = reading->form->options; o && o->name; o++)
        if (key == o->letter || key == KEY_FIRST + (int)(o - reading->form->options)) {
            const status stored = o->store(o, reading->request, value, reading->why);
            reading->wrong = stored == STATUS_OK ? reading->wrong : stored;
            return stored == STATUS_OK ? 0 : EINVAL;
        }
    return ARGP_ERR_UNKNOWN;
}

/* The help text with the manual page at its end: cuvette-study(1) for the program "cuvette study run". argp prints what
 * follows a '\v' after the options. */
static char *about_with_page(const char *about, const char *program)
{
    const size_t command = strcspn(program, " ");
    const char *word = program + command + strspn(program + command, " ");
    const int length = (int)strcspn(word, " ");
    return text_format("%s%cThe manual page is %.*s%s%.*s(1).", about, strchr(about, '\v') ? '\n' : '\v', (int)command,
                       program, length > 0 ? "-" : "", length, word);
}

status command_form_read(const command_form *form, int argc, char **argv, void *request, diagnostic *why)
{
    struct argp_option options[OPTIONS_MAX + 1] = {{0}};
    form_reading reading = {form, argv[0], request, 0, why, STATUS_BAD_INPUT};
    const unsigned flags = form->ends_at_argument ? ARGP_IN_ORDER : 0;
    for (int i = 0; form->options && form->options[i].name && i < OPTIONS_MAX; i++) {
        const command_option *o = &form->options[i];
        options[i] = (struct argp_option){o->name,    o->letter ? o->letter : KEY_FIRST + i,
                                          o->form,    o->optional ? OPTION_ARG_OPTIONAL : 0,
                                          o->purpose, 0};
    }
    struct argp argp = {.options = options, .parser = handle_key, .args_doc = form->synopsis};
    TRY(check(&argp, flags, argc, argv, why));
    char *about = about_with_page(form->about, argv[0]);
    if (!about)
        return out_of_memory(why);
    argp.doc = about;
    const error_t error = argp_parse(&argp, argc, argv, flags, NULL, &reading);
    free(about);
    if (error == EINVAL)
        return reading.wrong;
    if (error == ENOMEM)
        return out_of_memory(why);
    return error ? diagnose(why, STATUS_FAILURE, "", "cannot read the command line: %s", strerror(error)) : STATUS_OK;
}

status option_text(const command_option *o, void *request, const char *value, diagnostic *why)
{
    (void)why;
    *(const char **)((char *)request + o->at) = value;
    return STATUS_OK;
}

status option_flag(const command_option *o, void *request, const char *value, diagnostic *why)
{
    (void)value, (void)why;
    *(bool *)((char *)request + o->at) = true;
    return STATUS_OK;
}

status option_integer(const command_option *o, void *request, const char *value, diagnostic *why)
{
    char name[64];
    snprintf(name, sizeof name, "--%s", o->name);
    return options_integer(name, value, o->lowest, o->highest, (int64_t *)((char *)request + o->at), why);
}

/* --- values --- */

status options_wrong(const char *where, const char *value, diagnostic *why, const char *remedy, const char *what, ...)
{
    char place[512], text[512];
    va_list arguments;
    va_start(arguments, what);
    vsnprintf(text, sizeof text, what, arguments);
    va_end(arguments);
    snprintf(place, sizeof place, value ? "%s %s" : "%s", where ? where : "", value);
    return diagnose_at(why, place, STATUS_BAD_INPUT, remedy, "%s", text);
}

status options_integer(const char *option, const char *value, int64_t lowest, int64_t highest, int64_t *out,
                       diagnostic *why)
{
    int64_t number;
    if (!number_parse_int(value, &number) || number < lowest || number > highest) {
        char remedy[96];
        snprintf(remedy, sizeof remedy, "give an integer from %lld to %lld", (long long)lowest, (long long)highest);
        const char *digits = value + (value[0] == '-');
        bool is_integer = digits[0] && digits[strspn(digits, "0123456789")] == 0;
        return options_wrong(option, value, why, remedy,
                             is_integer ? "%.64s is out of range" : "'%.64s' is not an integer", value);
    }
    *out = number;
    return STATUS_OK;
}

status options_reals(const char *option, const char *value, const char *form, size_t count, double *out,
                     diagnostic *why)
{
    char remedy[96];
    const char *at = value;
    snprintf(remedy, sizeof remedy, "give %s", form);
    for (size_t i = 0; i < count; i++) {
        char word[64];
        at += strspn(at, " ");
        const size_t length = strcspn(at, ",");
        const bool fits = length < sizeof word;
        snprintf(word, sizeof word, "%.*s", fits ? (int)length : 0, at);
        for (size_t end = strlen(word); end > 0 && word[end - 1] == ' ';)
            word[--end] = '\0';
        if (!number_parse_real(word, &out[i]))
            return options_wrong(option, value, why, remedy, "'%.*s' is not a number", length < 64 ? (int)length : 64,
                                 at);
        at += length;
        if ((*at == ',') != (i + 1 < count))
            return options_wrong(option, value, why, remedy, "%s than %zu numbers", *at ? "more" : "fewer", count);
        at += *at == ',';
    }
    return STATUS_OK;
}

status options_unknown_word(const char *what, const char *wrong, const char *const *words, size_t count,
                            diagnostic *why)
{
    char remedy[256] = "give one of:";
    const char *nearest = text_nearest(wrong, words, count);
    if (nearest)
        snprintf(remedy, sizeof remedy, "did you mean '%s'?", nearest);
    for (size_t i = 0; !nearest && i < count; i++) {
        size_t used = strlen(remedy);
        snprintf(remedy + used, sizeof remedy - used, "%s %s", i ? "," : "", words[i]);
    }
    return diagnose(why, STATUS_BAD_INPUT, remedy, "unknown %s '%.64s'", what, wrong);
}

status options_choice(const char *where, const char *what, const char *value, const char *const *words, size_t count,
                      int *which, diagnostic *why)
{
    for (size_t i = 0; i < count; i++)
        if (strcmp(value, words[i]) == 0) {
            *which = (int)i;
            return STATUS_OK;
        }
    diagnostic_locate(why, where, 0, 0);
    return options_unknown_word(what, value, words, count, why);
}
