/* cuvette mesh: what a file or a computed body is made of, and its triangles for other programs. The body's numbers are
 * the parameters of a scene's mesh, set by the parameter table. */
#include "cli/cli.h"
#include "report/json.h"
#include "report/mesh_rows.h"
#include "cli/options.h"
#include "cli/scene_input.h"
#include "base/file.h"
#include "scene/model/edit/edit.h"
#include "scene/assets/mesh_write.h"
#include "scene/model/params.h"
#include "scene/model/scene.h"
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct mesh_request {
    scene *around; /* holds the one mesh */
    const char *file;
    bool generate;
    mesh_format format; /* MESH_FORMAT_COUNT: describe it */
    const char *output; /* NULL: standard output */
    bool json;
} mesh_request;

enum { KEY_JSON = 0x100, KEY_FIRST_PARAMETER };

/* Options that are parameters of the mesh, in the order of their keys. */
static const struct {
    const char *option, *parameter;
} turned[] = {
    {"generate", "generate"}, {"count", "count"},   {"level", "level"}, {"major", "major"},
    {"minor", "minor"},       {"around", "around"}, {"tube", "tube"},   {"profile", "profile"},
    {"crease", "crease_deg"}, {"size", "size"},     {"depth", "depth"}, {"seed", "seed"},
};
enum { TURNED = sizeof turned / sizeof turned[0] };

static const struct argp_option options[] = {
    {"generate", KEY_FIRST_PARAMETER, "BODY", 0, "make sparse, dense, sphere, icosphere, torus, lathe, terrain or box",
     0},
    {"count", KEY_FIRST_PARAMETER + 1, "N", 0, "triangles of sparse and dense, and about as many of sphere; 10000", 0},
    {"level", KEY_FIRST_PARAMETER + 2, "N", 0, "bisections of the icosphere, 0 to 11; 4", 0},
    {"major", KEY_FIRST_PARAMETER + 3, "R", 0, "distance of the torus's tube from its axis; 1", 0},
    {"minor", KEY_FIRST_PARAMETER + 4, "R", 0, "radius of the torus's tube; 0.4", 0},
    {"around", KEY_FIRST_PARAMETER + 5, "N", 0,
     "segments around the axis of torus and lathe, cells of terrain along x; 64", 0},
    {"tube", KEY_FIRST_PARAMETER + 6, "N", 0, "segments around the torus's tube, cells of terrain along z; 32", 0},
    {"profile", KEY_FIRST_PARAMETER + 7, "R,Y,R,Y,...", 0,
     "radius and height of the points that lathe turns; a cylinder", 0},
    {"crease", KEY_FIRST_PARAMETER + 8, "DEG", 0, "lathe: a profile that turns by more keeps its edge; 30", 0},
    {"size", KEY_FIRST_PARAMETER + 9, "X,Y,Z", 0,
     "edges of the box; of terrain, with the height of its hills as Y; 1,1,1", 0},
    {"depth", KEY_FIRST_PARAMETER + 10, "D", 0, "terrain: how deep its flat bottom lies; 0 leaves it open", 0},
    {"seed", KEY_FIRST_PARAMETER + 11, "N", 0, "terrain: which hills; 1", 0},
    {"format", 'f', "FORMAT", 0, "write the triangles as obj, bin, pov, tachyon or ply; else by the ending of -o FILE",
     0},
    {"output", 'o', "FILE", 0, "write there instead of to standard output", 0},
    {"json", KEY_JSON, NULL, 0, "print the description as JSON", 0},
    {0},
};

static error_t take_format(mesh_request *request, const char *value, diagnostic *why)
{
    const char *names[MESH_FORMAT_COUNT];
    for (int format = 0; format < MESH_FORMAT_COUNT; format++) {
        names[format] = mesh_format_name((mesh_format)format);
        if (strcmp(value, names[format]) == 0) {
            request->format = (mesh_format)format;
            return 0;
        }
    }
    options_unknown_word("format", value, names, MESH_FORMAT_COUNT, why);
    diagnostic_locate(why, "--format", 0, 0);
    return EINVAL;
}

static error_t take_parameter(mesh_request *request, int which, const char *value, diagnostic *why)
{
    char path[64], option[64];
    snprintf(path, sizeof path, "body.%s", turned[which].parameter);
    snprintf(option, sizeof option, "--%s", turned[which].option);
    request->generate |= which == 0;
    if (scene_set(request->around, path, value, why) == STATUS_OK)
        return 0;
    diagnostic_locate(why, option, 0, 0);
    return EINVAL;
}

static error_t take_option(int key, char *value, struct argp_state *state)
{
    options_input *input = state->input;
    mesh_request *request = input->request;
    diagnostic *why = input->why;
    if (key >= KEY_FIRST_PARAMETER && key < KEY_FIRST_PARAMETER + TURNED)
        return take_parameter(request, key - KEY_FIRST_PARAMETER, value, why);
    switch (key) {
    case 'o': request->output = value; return 0;
    case 'f': return take_format(request, value, why);
    case KEY_JSON: request->json = true; return 0;
    case ARGP_KEY_ARG:
        if (request->file)
            return ARGP_ERR_UNKNOWN;
        request->file = value;
        return 0;
    default: return ARGP_ERR_UNKNOWN;
    }
}

static const struct argp parser = {
    .options = options,
    .parser = take_option,
    .args_doc = "FILE\n--generate BODY",
    .doc = "Read a mesh of triangles (OBJ, PLY, STL, glTF), or make one, and say what it is: its numbers, bounds, "
           "area, whether it is closed, its "
           "volume or its first hole. With --format, write its triangles instead.\vFor example:\n"
           "  cuvette mesh teapot.obj\n"
           "  cuvette mesh --generate torus --minor 0.4 --around 256 --tube 128\n"
           "  cuvette mesh --generate sparse --count 50000 -f pov -o sparse.pov\n"
           "Sparse, dense and sphere are the triangle sets of the speed study, the same to the bit everywhere.",
};

static status check_request(const mesh_request *request, diagnostic *why)
{
    status result = STATUS_OK;
    if (!request->generate && !request->file)
        result = diagnose(why, STATUS_BAD_INPUT, "give a file, or --generate with a body, as --generate torus",
                          "no mesh is named");
    else if (request->generate && request->file)
        result = diagnose(why, STATUS_BAD_INPUT, "give one of them", "a file and --generate exclude each other");
    else if (request->json && request->format != MESH_FORMAT_COUNT)
        result = diagnose(why, STATUS_BAD_INPUT, "give one of them", "--json and --format exclude each other");
    if (result != STATUS_OK)
        diagnostic_locate(why, "mesh", 0, 0);
    return result;
}

/* A file's ending says the format where no option does; a description goes into a .txt. */
static status choose_format(mesh_request *request, diagnostic *why)
{
    const char *dot = request->output ? strrchr(request->output, '.') : NULL;
    if (!dot || request->json || request->format != MESH_FORMAT_COUNT || strchr(dot, '/'))
        return STATUS_OK;
    for (int format = 0; format < MESH_FORMAT_COUNT; format++)
        if (strcmp(dot + 1, mesh_format_name((mesh_format)format)) == 0) {
            request->format = (mesh_format)format;
            return STATUS_OK;
        }
    if (strcmp(dot, ".txt") == 0)
        return STATUS_OK;
    diagnostic_locate(why, "-o", 0, 0);
    return diagnose(why, STATUS_BAD_INPUT,
                    "end it in .obj, .pov, .bin or .ply, give --format, or .txt for the description",
                    "'%.80s' says no format", request->output);
}

/* The mesh that is asked for; the scene keeps it. */
static status obtain(const mesh_request *request, const mesh **out, diagnostic *why)
{
    status result = request->file ? scene_set(request->around, "body.file", request->file, why) : STATUS_OK;
    if (result == STATUS_OK)
        result = scene_check(request->around, why);
    if (result == STATUS_OK)
        result = scene_input_load(request->around, why);
    if (result == STATUS_BAD_INPUT && request->generate)
        diagnostic_locate(why, "--generate", 0, 0);
    *out = request->around->meshes[0].data;
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
    mesh_request request = {.around = scene_create(), .format = MESH_FORMAT_COUNT};
    const mesh *m = NULL;
    status result = request.around ? scene_add_mesh(request.around, "body", NULL, why) : out_of_memory(why);
    if (result == STATUS_OK)
        result = options_parse(&parser, 0, argc, argv, &request, why);
    if (result == STATUS_OK)
        result = check_request(&request, why);
    if (result == STATUS_OK)
        result = choose_format(&request, why);
    if (result == STATUS_OK)
        result = obtain(&request, &m, why);
    if (result == STATUS_OK)
        result = write_mesh(&request, m, why);
    scene_destroy(request.around);
    return result;
}
