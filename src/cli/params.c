#include "cli/cli.h"
#include "report/json.h"
#include "cli/options.h"
#include "report/param_rows.h"
#include "cli/terminal.h"
#include <stdbool.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

typedef struct params_request {
    const char *words[2]; /* scene and filter, either one alone, or none */
    const char *scene_path, *filter;
    bool json, manual;
} params_request;

static const command_option options[] = {
    {"json", 0, NULL, "print JSON", OPTION_FILLS(option_flag, params_request, json)},
    {"man", 0, NULL, "print the parameter part of the manual page, as roff",
     OPTION_FILLS(option_flag, params_request, manual)},
    {0},
};

static const command_form form = {
    .options = options,
    .words = "[SCENE] [PATH-OR-WORD]",
    .words_at = offsetof(params_request, words),
    .words_most = 2,
    .excess_remedy = "name one scene and one parameter or word at most",
    .excess = "'%.128s' is one too many",
    .about = "Print the table of parameters: name, default, unit, range, meaning. With a scene, its own parameters and "
             "their values. With a path, a part of one, or a word, only those that it fits.\vA name is what --set "
             "takes, what a scene file has under its group, and what a study sweeps. MESH, TEXTURE, LIGHT, MATERIAL "
             "and SOLID stand for the names that a scene gives. One element of a vector is lamp.position.x (.y .z, for "
             "colours .r .g .b).",
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
    const char *first = request->words[0], *second = request->words[1];
    if (first && (second || names_scene(first)))
        request->scene_path = first;
    request->filter = request->scene_path ? second : first;
    if (request->manual && (request->json || first))
        return options_wrong("params", NULL, why, "leave out what else was given",
                             "--man prints the whole reference, as roff");
    if (second && names_scene(second) && strchr(second, '.'))
        return options_wrong("params", NULL, why, "name one scene, then a path or word",
                             "a second scene is one too many");
    return STATUS_OK;
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
    TRY(param_rows_json(s, request->filter, &table, why));
    return json_print(table, why);
}

status command_params(int argc, char **argv, diagnostic *why)
{
    params_request request = {0};
    scene *s = NULL;
    status result = command_form_read(&form, argc, argv, &request, why);
    THEN(result, sort_words(&request, why));
    if (result == STATUS_OK && request.scene_path)
        result = scene_read(request.scene_path, &s, why);
    THEN(result, print(&request, s, why));
    scene_destroy(s);
    return result;
}
