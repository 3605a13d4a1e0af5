#include "cli/cli.h"
#include "report/json.h"
#include "cli/options.h"
#include "report/param_rows.h"
#include "cli/terminal.h"
#include <errno.h>
#include <stdbool.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

typedef struct params_request {
    const char *words[2]; /* scene and filter, either one alone, or none */
    const char *scene_path, *filter;
    bool json, manual;
} params_request;

enum { KEY_JSON = 0x100, KEY_MAN };

static const struct argp_option options[] = {
    {"json", KEY_JSON, NULL, 0, "print JSON", 0},
    {"man", KEY_MAN, NULL, 0, "print the parameter part of the manual page, as roff", 0},
    {0},
};

static error_t take_option(int key, char *value, struct argp_state *state)
{
    options_input *input = state->input;
    params_request *request = input->request;
    switch (key) {
    case KEY_JSON: request->json = true; return 0;
    case KEY_MAN: request->manual = true; return 0;
    case ARGP_KEY_ARG:
        if (request->words[1]) {
            diagnose(input->why, STATUS_BAD_INPUT, "name one scene and one parameter or word at most",
                     "'%.128s' is one too many", value);
            diagnostic_locate(input->why, "params", 0, 0);
            return EINVAL;
        }
        request->words[request->words[0] != NULL] = value;
        return 0;
    default: return ARGP_ERR_UNKNOWN;
    }
}

static const struct argp parser = {
    .options = options,
    .parser = take_option,
    .args_doc = "[SCENE] [PATH-OR-WORD]",
    .doc =
        "Print the table of parameters: name, default, unit, range, meaning. With a scene, its own parameters and "
        "their values. With a path, a part of one, or a word, only those that it fits.\v"
        "A name is what --set takes, what a scene file has under its group, and what a study sweeps. "
        "MESH, TEXTURE, LIGHT, MATERIAL and SOLID stand for the names that a scene gives. One element of a vector is "
        "lamp.position.x (.y .z, for colours .r .g .b).",
};

static bool ends_with(const char *text, const char *ending)
{
    size_t length = strlen(text), tail = strlen(ending);
    return length > tail && strcmp(text + length - tail, ending) == 0;
}

/* A path or word has no slash, and no ending of a scene file. */
static bool names_scene(const char *word)
{
    struct stat found;
    return strchr(word, '/') || ends_with(word, ".yaml") || ends_with(word, ".yml") ||
           (stat(word, &found) == 0 && S_ISREG(found.st_mode));
}

static status sort_words(params_request *request, diagnostic *why)
{
    const char *what = NULL, *remedy = NULL, *first = request->words[0], *second = request->words[1];
    if (first && (second || names_scene(first)))
        request->scene_path = first;
    request->filter = request->scene_path ? second : first;
    if (request->manual && (request->json || first))
        what = "--man prints the whole reference, as roff", remedy = "leave out what else was given";
    else if (second && names_scene(second) && strchr(second, '.'))
        what = "a second scene is one too many", remedy = "name one scene, then a path or word";
    if (!what)
        return STATUS_OK;
    diagnose(why, STATUS_BAD_INPUT, remedy, "%s", what);
    diagnostic_locate(why, "params", 0, 0);
    return STATUS_BAD_INPUT;
}

static status print(const params_request *request, const scene *s, diagnostic *why)
{
    if (request->manual) {
        param_rows_manual(stdout);
        return STATUS_OK;
    }
    if (!request->json)
        return param_rows_print(stdout, s, request->filter, terminal_columns(STDOUT_FILENO), why);
    json_t *table = NULL;
    status result = param_rows_json(s, request->filter, &table, why);
    if (result == STATUS_OK)
        result = json_write(stdout, table, why);
    json_decref(table);
    return result;
}

status command_params(int argc, char **argv, diagnostic *why)
{
    params_request request = {0};
    scene *s = NULL;
    status result = options_parse(&parser, 0, argc, argv, &request, why);
    if (result == STATUS_OK)
        result = sort_words(&request, why);
    if (result == STATUS_OK && request.scene_path)
        result = scene_read(request.scene_path, &s, why);
    if (result == STATUS_OK)
        result = print(&request, s, why);
    scene_destroy(s);
    return result;
}
