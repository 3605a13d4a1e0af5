#include "cli/cli.h"
#include "cli/json.h"
#include "cli/options.h"
#include "cli/param_rows.h"
#include <errno.h>
#include <stdbool.h>

typedef struct params_request {
    const char *scene_path;
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
        if (!request->scene_path) {
            request->scene_path = value;
            return 0;
        }
        diagnose(input->why, STATUS_BAD_INPUT, "name one scene at most", "'%.128s' is one too many", value);
        diagnostic_locate(input->why, "params", 0, 0);
        return EINVAL;
    default: return ARGP_ERR_UNKNOWN;
    }
}

static const struct argp parser = {
    .options = options,
    .parser = take_option,
    .args_doc = "[SCENE]",
    .doc = "Print the table of parameters: name, default, unit, range, meaning. With a scene, its own parameters and "
           "their values.\vA name is what --set takes, what a scene file has under its group, and what a study sweeps. "
           "LIGHT, MATERIAL and SOLID stand for the names that a scene gives. One element of a vector is "
           "lamp.position.x (.y .z, for colours .r .g .b).",
};

static status print(const params_request *request, const scene *s, diagnostic *why)
{
    if (request->manual) {
        param_rows_manual(stdout);
        return STATUS_OK;
    }
    if (!request->json)
        return param_rows_print(stdout, s, why);
    json_t *table = param_rows_json(s);
    status result = json_write(stdout, table, why);
    json_decref(table);
    return result;
}

status command_params(int argc, char **argv, diagnostic *why)
{
    params_request request = {0};
    scene *s = NULL;
    status result = options_parse(&parser, 0, argc, argv, &request, why);
    if (result == STATUS_OK && request.scene_path)
        result = scene_read(request.scene_path, &s, why);
    if (result == STATUS_OK)
        result = print(&request, s, why);
    scene_destroy(s);
    return result;
}
