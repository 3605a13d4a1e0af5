/* cuvette mesh: what a file or a computed body is made of, and its triangles for other programs. The body's numbers are
 * the parameters of a scene's mesh, set by the parameter table. */
#include "cli/cli.h"
#include "report/json.h"
#include "report/mesh_rows.h"
#include "report/mesh_write.h"
#include "cli/options.h"
#include "cli/scene_input.h"
#include "cli/outputs.h"
#include "scene/model/edit/edit.h"
#include "scene/model/params.h"
#include "scene/model/scene.h"
#include <stdio.h>
#include <string.h>

typedef struct mesh_request {
    scene *around; /* holds the one mesh */
    const char *file;
    bool generate;
    int format;         /* mesh_format; MESH_FORMAT_COUNT: describe it */
    const char *output; /* NULL: standard output */
    bool json;
} mesh_request;

static status take_format(const command_option *o, void *into, const char *value, diagnostic *why)
{
    mesh_request *request = into;
    (void)o;
    const char *names[MESH_FORMAT_COUNT];
    for (int format = 0; format < MESH_FORMAT_COUNT; format++)
        names[format] = mesh_format_name((mesh_format)format);
    return options_choice("--format", "format", value, names, MESH_FORMAT_COUNT, &request->format, why);
}

static status take_parameter(const command_option *o, void *into, const char *value, diagnostic *why)
{
    mesh_request *request = into;
    char path[64], name[64];
    snprintf(path, sizeof path, "body.%s", o->parameter ? o->parameter : o->name);
    snprintf(name, sizeof name, "--%s", o->name);
    request->generate |= strcmp(o->name, "generate") == 0;
    return locate_failure(why, name, scene_set(request->around, path, value, why));
}

static const command_option options[] = {
    {"generate", 0, "BODY", "make sparse, dense, sphere, icosphere, torus, lathe, terrain or box",
     .take = take_parameter},
    {"count", 0, "N", "triangles of sparse and dense, and about as many of sphere; 10000", .take = take_parameter},
    {"level", 0, "N", "bisections of the icosphere, 0 to 11; 4", .take = take_parameter},
    {"major", 0, "R", "distance of the torus's tube from its axis; 1", .take = take_parameter},
    {"minor", 0, "R", "radius of the torus's tube; 0.4", .take = take_parameter},
    {"around", 0, "N", "segments around the axis of torus and lathe, cells of terrain along x; 64",
     .take = take_parameter},
    {"tube", 0, "N", "segments around the torus's tube, cells of terrain along z; 32", .take = take_parameter},
    {"profile", 0, "R,Y,R,Y,...", "radius and height of the points that lathe turns; a cylinder",
     .take = take_parameter},
    {"crease", 0, "DEG", "lathe: a profile that turns by more keeps its edge; 30", .take = take_parameter,
     .parameter = "crease_deg"},
    {"size", 0, "X,Y,Z", "edges of the box; of terrain, with the height of its hills as Y; 1,1,1",
     .take = take_parameter},
    {"depth", 0, "D", "terrain: how deep its flat bottom lies; 0 leaves it open", .take = take_parameter},
    {"seed", 0, "N", "terrain: which hills; 1", .take = take_parameter},
    {"format", 'f', "FORMAT", "write the triangles as obj, bin or ply; else by the ending of -o FILE",
     .take = take_format},
    {"output", 'o', "FILE", "write there instead of to standard output",
     OPTION_FILLS(option_text, mesh_request, output)},
    {"json", 0, NULL, "print the description as JSON", OPTION_FILLS(option_flag, mesh_request, json)},
    {0},
};

static const command_form form = {
    .options = options,
    .words = "FILE\n--generate BODY",
    .words_at = offsetof(mesh_request, file),
    .words_most = 1,
    .about = "Read a mesh of triangles (OBJ, PLY, STL, glTF), or make one, and say what it is: its numbers, bounds, "
             "area, whether it is closed, its volume or its first hole. With --format, write its triangles "
             "instead.\vFor example:\n"
             "  cuvette mesh teapot.obj\n"
             "  cuvette mesh --generate torus --minor 0.4 --around 256 --tube 128\n"
             "  cuvette mesh --generate sparse --count 50000 -f obj -o sparse.obj\n"
             "Sparse, dense and sphere are the triangle sets of the speed study, the same to the bit everywhere.",
};

static status check_request(const mesh_request *request, diagnostic *why)
{
    const char *what = NULL, *remedy = "give one of them";
    if (!request->generate && !request->file)
        what = "no mesh is named", remedy = "give a file, or --generate with a body, as --generate torus";
    else if (request->generate && request->file)
        what = "a file and --generate exclude each other";
    else if (request->json && request->format != MESH_FORMAT_COUNT)
        what = "--json and --format exclude each other";
    return what ? options_wrong("mesh", NULL, why, remedy, "%s", what) : STATUS_OK;
}

/* A file's ending says the format where no option does; a description goes into a .txt. */
static status choose_format(mesh_request *request, diagnostic *why)
{
    const char *dot = request->output ? strrchr(request->output, '.') : NULL;
    if (!dot || request->json || request->format != MESH_FORMAT_COUNT || strchr(dot, '/'))
        return STATUS_OK;
    for (int format = 0; format < MESH_FORMAT_COUNT; format++)
        if (strcmp(dot + 1, mesh_format_name((mesh_format)format)) == 0) {
            request->format = format;
            return STATUS_OK;
        }
    if (strcmp(dot, ".txt") == 0)
        return STATUS_OK;
    return options_wrong("-o", NULL, why, "end it in .obj, .bin or .ply, give --format, or .txt for the description",
                         "'%.80s' says no format", request->output);
}

/* The mesh that is asked for; the scene keeps it. */
static status obtain(const mesh_request *request, diagnostic *why)
{
    status result = request->file ? scene_set(request->around, "body.file", request->file, why) : STATUS_OK;
    THEN(result, scene_check(request->around, why));
    THEN(result, scene_input_load(request->around, why));
    if (result == STATUS_BAD_INPUT && request->generate)
        diagnostic_locate(why, "--generate", 0, 0);
    return result;
}

static status write_to(const void *content, FILE *stream, diagnostic *why)
{
    const mesh_request *request = content;
    const mesh *m = request->around->meshes[0].data;
    if (request->format != MESH_FORMAT_COUNT)
        mesh_write(m, (mesh_format)request->format, stream);
    else if (request->json)
        return json_put(stream, mesh_rows_json(m), why);
    else
        mesh_rows_text(stream, m);
    return STATUS_OK;
}

status command_mesh(int argc, char **argv, diagnostic *why)
{
    mesh_request request = {.around = scene_create(), .format = MESH_FORMAT_COUNT};
    status result = request.around ? scene_add(request.around, PARAM_MESH, "body", NULL, why) : out_of_memory(why);
    THEN(result, command_form_read(&form, argc, argv, &request, why));
    THEN(result, check_request(&request, why));
    THEN(result, choose_format(&request, why));
    THEN(result, obtain(&request, why));
    THEN(result, outputs_write_text(request.output, write_to, &request, why));
    scene_destroy(request.around);
    return result;
}
