/* The dispatcher of commands: help text, selection by name, unknown names. */
#include "base/text.h"
#include "cli/cli.h"
#include "cli/options.h"
#include "cli/outputs.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { COMMANDS_MAX = 16 };

/* The help text, generated from the table so that the two always agree. */
static char *table_text(const command *table, size_t count, const char *about, const char *program)
{
    char *text = text_format("%s\vCommands:\n", about);
    for (size_t i = 0; text && i < count; i++) {
        char *longer = text_format("%s  %-9s %s\n", text, table[i].name, table[i].purpose);
        free(text);
        text = longer;
    }
    if (!text)
        return NULL;
    char *help = text_format("%s\n'%s COMMAND --help' prints help for a command.", text, program);
    free(text);
    return help;
}

static status unknown_command(const command *table, size_t count, const char *program, const char *word,
                              diagnostic *why)
{
    const char *names[COMMANDS_MAX];
    size_t named = 0;
    for (; named < count && named < COMMANDS_MAX; named++)
        names[named] = table[named].name;
    options_unknown_word("command", word, names, named, why);
    if (outputs_ends_with(word, ".yaml") && why)
        snprintf(why->remedy, sizeof why->remedy, "for an image: %s render %.256s -o image.png", program, word);
    options_locate(why, program);
    return STATUS_BAD_INPUT;
}

static status run_command(const command *chosen, int argc, char **argv, diagnostic *why)
{
    char *program = text_format("%s %s", argv[0], chosen->name);
    char **arguments = calloc((size_t)argc + 1, sizeof *arguments);
    status result;
    if (!program || !arguments) {
        result = out_of_memory(why);
    } else {
        arguments[0] = program;
        memcpy(arguments + 1, argv + 2, (size_t)(argc - 2) * sizeof *arguments);
        result = chosen->run(argc - 1, arguments, why);
    }
    free(arguments);
    free(program);
    return result;
}

status command_dispatch(const command *table, size_t count, const char *about, int argc, char **argv, diagnostic *why)
{
    char *help = table_text(table, count, about, argv[0]);
    if (!help)
        return out_of_memory(why);
    const char *word = NULL;
    const command_form form = {
        .synopsis = "COMMAND [ARGUMENT...]", .about = help, .argument_limit = 1, .ends_at_argument = true};
    status result = command_form_read(&form, argc, argv, &word, why);
    free(help);
    if (result != STATUS_OK)
        return result;
    if (!word) {
        char remedy[96];
        snprintf(remedy, sizeof remedy, "'%s --help' lists the commands", argv[0]);
        options_locate(why, argv[0]);
        return diagnose(why, STATUS_BAD_INPUT, remedy, "no command is given");
    }
    int at = 1;
    while (argv[at] != word)
        at++;
    for (size_t i = 0; i < count; i++) {
        if (strcmp(argv[at], table[i].name) == 0) {
            argv[at - 1] = argv[0]; /* replaces a "--", the only word that can precede the command */
            return run_command(&table[i], argc - at + 1, argv + at - 1, why);
        }
    }
    return unknown_command(table, count, argv[0], argv[at], why);
}
