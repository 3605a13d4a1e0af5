#include "cli/cli.h"
#include "cli/json.h"
#include "cli/mesh_rows.h"
#include "cli/options.h"
#include "base/file.h"
#include "geometry/bodies.h"
#include "scene/mesh_write.h"
#include <errno.h>
#include <stdlib.h>
#include <string.h>

typedef struct mesh_request {
    body_recipe recipe;
    bool generate;
    profile_point *profile; /* of --profile, owned; NULL: the recipe's own */
    mesh_format format;     /* MESH_FORMAT_COUNT: describe it */
    const char *output;     /* NULL: standard output */
    bool json;
} mesh_request;

enum { KEY_JSON = 0x100, KEY_GENERATE, KEY_COUNT, KEY_LEVEL, KEY_MAJOR, KEY_MINOR, KEY_AROUND, KEY_TUBE, KEY_PROFILE, KEY_CREASE, KEY_SIZE };

static const struct argp_option options[] = {
    {"generate", KEY_GENERATE, "BODY", 0, "make sparse, dense, sphere, icosphere, torus, lathe or box", 0},
    {"count", KEY_COUNT, "N", 0, "triangles of sparse and dense, and about as many of sphere; 10000", 0},
    {"level", KEY_LEVEL, "N", 0, "bisections of the icosphere, 0 to 11; 3", 0},
    {"major", KEY_MAJOR, "R", 0, "distance of the torus's tube from its axis; 1", 0},
    {"minor", KEY_MINOR, "R", 0, "radius of the torus's tube; 0.25", 0},
    {"around", KEY_AROUND, "N", 0, "segments around the axis of torus and lathe; 64", 0},
    {"tube", KEY_TUBE, "N", 0, "segments around the torus's tube; 32", 0},
    {"profile", KEY_PROFILE, "R,Y,R,Y,...", 0, "radius and height of the points that lathe turns; a cone", 0},
    {"crease", KEY_CREASE, "DEG", 0, "lathe: a profile that turns by more keeps its edge; 30", 0},
    {"size", KEY_SIZE, "X,Y,Z", 0, "edges of the box; 1,1,1", 0},
    {"format", 'f', "FORMAT", 0, "write the triangles as obj, bin, pov, tachyon or ply", 0},
    {"output", 'o', "FILE", 0, "write there instead of to standard output", 0},
    {"json", KEY_JSON, NULL, 0, "print the description as JSON", 0},
    {0},
};

static error_t take_int(const char *option, const char *value, int *out, diagnostic *why)
{
    int64_t number = 0;
    if (options_integer(option, value, 0, INT32_MAX, &number, why) != STATUS_OK)
        return EINVAL;
    *out = (int)number;
    return 0;
}

static error_t take_count(const char *value, size_t *out, diagnostic *why)
{
    int64_t number = 0;
    if (options_integer("--count", value, 1, MESH_TRIANGLES_MAX, &number, why) != STATUS_OK)
        return EINVAL;
    *out = (size_t)number;
    return 0;
}

static error_t take_reals(const char *option, const char *value, const char *form, size_t count, double *out, diagnostic *why)
{
    return options_reals(option, value, form, count, out, why) == STATUS_OK ? 0 : EINVAL;
}

static error_t take_size(const char *value, vec3 *out, diagnostic *why)
{
    double size[3];
    const error_t error = take_reals("--size", value, "X,Y,Z", 3, size, why);
    if (!error)
        *out = vec3_make(size[0], size[1], size[2]);
    return error;
}

static error_t take_profile(mesh_request *request, const char *value, diagnostic *why)
{
    size_t numbers = 1;
    for (const char *at = value; *at; at++)
        numbers += *at == ',';
    numbers += numbers % 2; /* an odd one is found missing */
    free(request->profile);
    request->profile = calloc(numbers / 2, sizeof *request->profile);
    double *reals = calloc(numbers, sizeof *reals);
    error_t error = ENOMEM;
    if (request->profile && reals)
        error = take_reals("--profile", value, "R,Y for each point, as 0,0,1,0,0,2", numbers, reals, why);
    for (size_t k = 0; !error && k < numbers / 2; k++)
        request->profile[k] = (profile_point){reals[2 * k], reals[2 * k + 1]};
    request->recipe.profile = request->profile;
    request->recipe.profile_count = numbers / 2;
    free(reals);
    return error;
}

static error_t take_word(const char *option, const char *value, const char *const *words, size_t count, size_t *which, diagnostic *why)
{
    for (*which = 0; *which < count; ++*which)
        if (strcmp(value, words[*which]) == 0)
            return 0;
    options_unknown_word(option[2] == 'g' ? "body" : "format", value, words, count, why);
    diagnostic_locate(why, option, 0, 0);
    return EINVAL;
}

static error_t take_body(mesh_request *request, const char *value, diagnostic *why)
{
    const char *names[BODY_KIND_COUNT];
    body_kind kinds[BODY_KIND_COUNT];
    size_t count = 0, which;
    for (int kind = 0; kind < BODY_KIND_COUNT; kind++) {
        if (kind == BODY_TERRAIN) /* its heights come from elsewhere */
            continue;
        kinds[count] = (body_kind)kind;
        names[count++] = body_name((body_kind)kind);
    }
    const error_t error = take_word("--generate", value, names, count, &which, why);
    if (!error)
        request->recipe.kind = kinds[which];
    request->generate = true;
    return error;
}

static error_t take_format(mesh_request *request, const char *value, diagnostic *why)
{
    const char *names[MESH_FORMAT_COUNT];
    size_t which;
    for (int format = 0; format < MESH_FORMAT_COUNT; format++)
        names[format] = mesh_format_name((mesh_format)format);
    const error_t error = take_word("--format", value, names, MESH_FORMAT_COUNT, &which, why);
    if (!error)
        request->format = (mesh_format)which;
    return error;
}

static error_t take_option(int key, char *value, struct argp_state *state)
{
    options_input *input = state->input;
    mesh_request *request = input->request;
    body_recipe *recipe = &request->recipe;
    diagnostic *why = input->why;
    switch (key) {
    case 'o': request->output = value; return 0;
    case 'f': return take_format(request, value, why);
    case KEY_JSON: request->json = true; return 0;
    case KEY_GENERATE: return take_body(request, value, why);
    case KEY_COUNT: return take_count(value, &recipe->count, why);
    case KEY_LEVEL: return take_int("--level", value, &recipe->level, why);
    case KEY_MAJOR: return take_reals("--major", value, "a radius", 1, &recipe->major, why);
    case KEY_MINOR: return take_reals("--minor", value, "a radius", 1, &recipe->minor, why);
    case KEY_AROUND: return take_int("--around", value, &recipe->around, why);
    case KEY_TUBE: return take_int("--tube", value, &recipe->tube, why);
    case KEY_PROFILE: return take_profile(request, value, why);
    case KEY_CREASE: return take_reals("--crease", value, "degrees from 0 to 180", 1, &recipe->crease_deg, why);
    case KEY_SIZE: return take_size(value, &recipe->size, why);
    default: return ARGP_ERR_UNKNOWN;
    }
}

static const struct argp parser = {
    .options = options,
    .parser = take_option,
    .args_doc = "--generate BODY",
    .doc = "Make a mesh of triangles and say what it is: its numbers, bounds, area, whether it is closed, its volume or its first hole. "
           "With --format, write its triangles instead.\vFor example:\n"
           "  cuvette mesh --generate torus --minor 0.4 --around 256 --tube 128\n"
           "  cuvette mesh --generate sparse --count 50000 -f pov -o sparse.pov\n"
           "Sparse, dense and sphere are the triangle sets of the speed study, the same to the bit everywhere.",
};

static status check_request(const mesh_request *request, diagnostic *why)
{
    status result = STATUS_OK;
    if (!request->generate)
        result = diagnose(why, STATUS_BAD_INPUT, "give --generate with a body, as --generate torus", "no mesh is named");
    else if (request->json && request->format != MESH_FORMAT_COUNT)
        result = diagnose(why, STATUS_BAD_INPUT, "give one of them", "--json and --format exclude each other");
    if (result != STATUS_OK)
        diagnostic_locate(why, "mesh", 0, 0);
    return result;
}

/* The mesh that is asked for. */
static status obtain(const mesh_request *request, mesh **out, diagnostic *why)
{
    char where[64];
    status result = body_make(&request->recipe, out, why);
    snprintf(where, sizeof where, "--generate %s", body_name(request->recipe.kind));
    if (result == STATUS_BAD_INPUT)
        diagnostic_locate(why, where, 0, 0);
    return result;
}

static status write_to(const mesh_request *request, const mesh *m, FILE *stream, diagnostic *why)
{
    if (request->format != MESH_FORMAT_COUNT) {
        mesh_write(m, request->format, stream);
        return STATUS_OK;
    }
    if (!request->json) {
        mesh_rows_text(stream, m);
        return STATUS_OK;
    }
    json_t *all = mesh_rows_json(m);
    status result = json_write(stream, all, why);
    json_decref(all);
    return result;
}

static status write_mesh(const mesh_request *request, const mesh *m, diagnostic *why)
{
    if (!request->output || strcmp(request->output, "-") == 0)
        return write_to(request, m, stdout, why);
    file_writer writer;
    status result = file_writer_open(&writer, request->output, why);
    if (result != STATUS_OK)
        return result;
    result = write_to(request, m, writer.stream, why);
    if (result == STATUS_OK)
        return file_writer_commit(&writer, why);
    file_writer_abandon(&writer);
    return result;
}

status command_mesh(int argc, char **argv, diagnostic *why)
{
    mesh_request request = {.recipe = body_recipe_default(BODY_SPARSE), .format = MESH_FORMAT_COUNT};
    mesh *m = NULL;
    status result = options_parse(&parser, 0, argc, argv, &request, why);
    if (result == STATUS_OK)
        result = check_request(&request, why);
    if (result == STATUS_OK)
        result = obtain(&request, &m, why);
    if (result == STATUS_OK)
        result = write_mesh(&request, m, why);
    mesh_release(m);
    free(request.profile);
    return result;
}
