/* The fuzzer of command lines: the words of the input, each ended by a NUL or a newline, are the arguments of cuvette.
 * Only the parsing runs: the linker puts the function below in place of command_form_read (--wrap), and it ends every
 * command behind its parsing. */
#include "cli/cli.h"
#include "cli/options.h"
#include "fuzz.h"

#define EACH(X) \
    X(render)   \
    X(animate)  \
    X(scene)    \
    X(trace)    \
    X(fan) X(section) X(params) X(media) X(mesh) X(study) X(compare) X(realism) X(motion) X(lesson) X(lab) X(machine)
#define ROW(name) {#name, "fuzzed", command_##name},
static const command commands[] = {EACH(ROW)};

/* The linker's names. */
status __real_command_form_read(const command_form *form, int argc, char **argv, void *request, diagnostic *why);
status __wrap_command_form_read(const command_form *form, int argc, char **argv, void *request, diagnostic *why);

#define PARSED "the command line is parsed"

status __wrap_command_form_read(const command_form *form, int argc, char **argv, void *request, diagnostic *why)
{
    const status code = __real_command_form_read(form, argc, argv, request, why);
    if (code != STATUS_OK || form->ends_at_argument)
        return code;
    return diagnose(why, STATUS_INTERRUPTED, NULL, PARSED);
}

/* argp prints the help and ends the process: such words are left out. */
static bool prints_and_ends(const char *word)
{
    if (word[0] != '-')
        return false;
    return word[1] == '-' ? word[2] == 'h' || word[2] == 'u' || word[2] == 'v' : strpbrk(word, "?V") != NULL;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    enum { WORDS_MAX = 64 };
    char program[] = "cuvette", *argv[WORDS_MAX + 2] = {program}, *text = malloc(size + 1);
    int argc = 1;
    must(text);
    memcpy(text, data, size);
    text[size] = 0;
    for (size_t i = 0; i < size; i++)
        text[i] = text[i] == '\n' ? 0 : text[i];
    for (char *word = text; word < text + size && argc <= WORDS_MAX; word += strlen(word) + 1)
        if (!prints_and_ends(word))
            argv[argc++] = word;
    argv[argc] = NULL;
    diagnostic why = {.what = ""};
    const status code = command_dispatch(commands, sizeof commands / sizeof *commands, "", argc, argv, &why);
    if (code == STATUS_INTERRUPTED)
        must(strcmp(why.what, PARSED) == 0);
    else
        must_refuse(code, &why);
    free(text);
    return 0;
}
