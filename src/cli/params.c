/* `cuvette params`: the parameter table as text, JSON or roff. */
#include "cli/cli.h"
#include "cli/options.h"
#include "cli/terminal.h"
#include "report/json.h"
#include "report/param_rows.h"

#include <stdbool.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

typedef struct params_request {
    const char *arguments[2]; /* scene and filter, one of the two, or none */
    const char *scene_path, *filter;
    bool json, manual;
} params_request;

static const command_option options[] = {
    {"json", 0, NULL, "print JSON", OPTION_FILLS(option_flag, params_request, json)},
    {"man", 0, NULL, "print the parameter reference of cuvette-scene(5) as roff",
     OPTION_FILLS(option_flag, params_request, manual)},
    {0},
};

static const command_form form = {
    .options = options,
    .synopsis = "[SCENE] [PATH-OR-WORD]",
    .arguments_at = offsetof(params_request, arguments),
    .argument_limit = 2,
    .excess_remedy = "give at most one scene and one path or word",
    .excess = "unexpected argument '%.128s'",
    .about =
        "Print the parameter table: name, default, unit, range, meaning. With a scene, print the parameters of "
        "that scene and their values. With a path, a part of a path, or a word, print the matching parameters "
        "only.\vThe same names are used by --set, by scene files (under their group) and by the grid of a study. "
        "MESH, TEXTURE, LIGHT, BEAM, MATERIAL and SOLID are placeholders for the names of a scene's objects. An "
        "element of a vector is lamp.position.x (.y .z, for colours .r .g .b). On a terminal the lines are wrapped "
        "to its width; a pipe or a file gets the full lines.",
};

static bool ends_with(const char *text, const char *ending)
{
    size_t length = strlen(text), tail = strlen(ending);
    return length > tail && strcmp(text + length - tail, ending) == 0;
}

/* Whether an argument names a scene file: paths of parameters (render.depth) and search words have neither a slash nor
 * the ending .yaml or .yml. */
static bool names_scene(const char *word)
{
    struct stat found;
    return strchr(word, '/') || ends_with(word, ".yaml") || ends_with(word, ".yml") ||
           (stat(word, &found) == 0 && S_ISREG(found.st_mode));
}

static status sort_arguments(params_request *request, diagnostic *why)
{
    const char *first = request->arguments[0], *second = request->arguments[1];
    if (first && (second || names_scene(first)))
        request->scene_path = first;
    request->filter = request->scene_path ? second : first;
    if (request->manual && (request->json || first))
        return options_wrong("params", NULL, why, "remove the other arguments", "--man takes no other argument");
    if (second && names_scene(second) && strchr(second, '.'))
        return options_wrong("params", NULL, why, "give one scene, then a path or word", "only one scene can be given");
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
    TRY(param_rows_json(s, NULL, NULL, request->filter, &table, why));
    return json_print(table, why);
}

status command_params(int argc, char **argv, diagnostic *why)
{
    params_request request = {0};
    scene *s = NULL;
    status result = command_form_read(&form, argc, argv, &request, why);
    THEN(result, sort_arguments(&request, why));
    if (result == STATUS_OK && request.scene_path)
        result = scene_read(request.scene_path, &s, why);
    THEN(result, print(&request, s, why));
    scene_destroy(s);
    return result;
}
