/* `cuvette mesh`: describes a mesh of a file or of a generator, or writes its triangles for other programs. The options
 * of the generators are parameters of a scene's mesh, set through the parameter table. */
#include "base/cancel.h"
#include "base/text.h"
#include "cli/cli.h"
#include "cli/options.h"
#include "cli/outputs.h"
#include "cli/scene_input.h"
#include "cli/terminal.h"
#include "geometry/hierarchy/hierarchy.h"
#include "report/json.h"
#include "report/mesh_writers.h"
#include "scene/assets/mesh_stream.h"
#include "scene/model/edit/edit.h"
#include "scene/model/params.h"
#include "scene/model/scene.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct mesh_request {
    scene *scene; /* with only a generated mesh */
    const char *file;
    mesh_import *imported; /* the file's */
    const mesh *made;      /* the mesh of either; borrowed */
    mesh *repaired;        /* by --close; else NULL */
    bool generate, close;
    double weld;        /* negative: not given */
    int format;         /* mesh_format; MESH_FORMAT_COUNT: describe it */
    const char *output; /* NULL: standard output */
    bool json;
} mesh_request;

static status parse_format(const command_option *o, void *context, const char *value, diagnostic *why)
{
    mesh_request *request = context;
    (void)o;
    const char *names[MESH_FORMAT_COUNT];
    for (int format = 0; format < MESH_FORMAT_COUNT; format++)
        names[format] = mesh_format_name((mesh_format)format);
    return options_choice("--format", "format", value, names, MESH_FORMAT_COUNT, &request->format, why);
}

static status parse_parameter(const command_option *o, void *context, const char *value, diagnostic *why)
{
    mesh_request *request = context;
    char path[64], name[64];
    snprintf(path, sizeof path, "body.%s", o->parameter ? o->parameter : o->name);
    snprintf(name, sizeof name, "--%s", o->name);
    request->generate |= strcmp(o->name, "generate") == 0;
    return locate_failure(why, name, scene_set(request->scene, path, value, why));
}

static status parse_weld(const command_option *o, void *context, const char *value, diagnostic *why)
{
    mesh_request *request = context;
    TRY(options_reals("--weld", value, o->form, 1, &request->weld, why));
    return request->weld >= 0.0
               ? STATUS_OK
               : options_wrong("--weld", value, why, "use a length of at least 0", "the distance is negative");
}

static const command_option options[] = {
    {"generate", 0, "KIND", "generate sparse, dense, sphere, icosphere, torus, lathe, terrain or box",
     .store = parse_parameter},
    {"count", 0, "N", "number of triangles of sparse and dense, approximate for sphere; default 10000",
     .store = parse_parameter},
    {"level", 0, "N", "icosphere: number of subdivisions, 0 to 11; default 4", .store = parse_parameter},
    {"major", 0, "R", "torus: radius of the centre line of the tube; default 1", .store = parse_parameter},
    {"minor", 0, "R", "torus: radius of the tube; default 0.4", .store = parse_parameter},
    {"around", 0, "N", "torus, lathe: segments around the axis; terrain: cells along x; default 64",
     .store = parse_parameter},
    {"tube", 0, "N", "torus: segments around the tube; terrain: cells along z; default 32", .store = parse_parameter},
    {"profile", 0, "R,Y,R,Y,...", "lathe: radius and height of each point of the profile; default a cylinder",
     .store = parse_parameter},
    {"crease", 0, "DEG", "lathe: angle of the profile above which an edge stays sharp; default 30",
     .store = parse_parameter, .parameter = "crease_deg"},
    {"size", 0, "X,Y,Z", "box: edge lengths; terrain: size, with the height of the hills as Y; default 1,1,1",
     .store = parse_parameter},
    {"depth", 0, "D", "terrain: depth of its flat bottom, 0 leaves the mesh open; default 0", .store = parse_parameter},
    {"seed", 0, "N", "terrain: seed of the random hills; default 1", .store = parse_parameter},
    {"close", 0, NULL, "close an open mesh: drop double triangles, turn them to agree, fill holes",
     OPTION_FILLS(option_flag, mesh_request, close)},
    {"weld", 0, "LENGTH", "with --close, first join vertices within this distance; default 0", .store = parse_weld},
    {"format", 'f', "FORMAT", "write the triangles as obj, ply or glb (default: by the ending of -o FILE)",
     .store = parse_format},
    {"output", 'o', "FILE", "write to FILE instead of standard output",
     OPTION_FILLS(option_text, mesh_request, output)},
    OPTION_MEMORY,
    {"json", 0, NULL, "print the description as JSON", OPTION_FILLS(option_flag, mesh_request, json)},
    {0},
};

static const command_form form = {
    .options = options,
    .synopsis = "FILE\n--generate KIND",
    .arguments_at = offsetof(mesh_request, file),
    .argument_limit = 1,
    .about = "Read a triangle mesh (OBJ, PLY, STL, glTF) or generate one, and describe it: triangle and vertex counts, "
             "bounds, area, whether it is closed, and its volume or first hole. With --format, write its triangles "
             "instead.\vFor example:\n"
             "  cuvette mesh teapot.obj\n"
             "  cuvette mesh --generate torus --minor 0.4 --around 256 --tube 128\n"
             "  cuvette mesh --generate sparse --count 50000 -f obj -o sparse.obj\n"
             "  cuvette mesh --generate terrain --close -o closed.ply\n"
             "Sparse, dense and sphere are the triangle sets of the speed study; they are bit-identical on every "
             "machine.",
};

static status check_request(const mesh_request *request, diagnostic *why)
{
    const char *what = NULL, *remedy = "use only one of them";
    if (!request->generate && !request->file)
        what = "no mesh is given", remedy = "give a file, or a generator such as --generate torus";
    else if (request->generate && request->file)
        what = "a file and --generate exclude each other";
    else if (request->json && request->format != MESH_FORMAT_COUNT)
        what = "--json and --format exclude each other";
    else if (request->weld >= 0.0 && !request->close)
        what = "--weld has no effect without --close", remedy = "add --close";
    return what ? options_wrong("mesh", NULL, why, remedy, "%s", what) : STATUS_OK;
}

/* Without --format, the ending of the output file selects the format; .txt selects the description. */
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
    return options_wrong("-o", NULL, why, "use .obj, .ply or .glb, or .txt for the description, or give --format",
                         "unknown file name ending of '%.80s'", request->output);
}

/* A file is described and written in its own axes. */
static status read_file(mesh_request *request, diagnostic *why)
{
    const mesh_limits limits = {.right_handed = false};
    const status code = mesh_is_points(request->file)
                            ? mesh_points_read(request->file, NULL, false, &request->imported, why)
                            : mesh_read_file(request->file, &limits, &request->imported, why);
    if (code == STATUS_OK)
        request->made = request->imported->mesh;
    return code;
}

static status generate(mesh_request *request, diagnostic *why)
{
    status code = scene_check(request->scene, why);
    THEN(code, scene_input_load(request->scene, why));
    if (code == STATUS_BAD_INPUT)
        diagnostic_locate(why, "--generate", 0, 0);
    request->made = request->scene->meshes[0].data;
    return code;
}

static void note_holes(FILE *to, const mesh_repairs *r)
{
    enum { SHOWN = 5 };
    size_t largest[SHOWN], shown = 0;
    for (size_t i = 0; i < r->holes; i++) {
        size_t at = shown < SHOWN ? shown++ : SHOWN - 1;
        if (at == SHOWN - 1 && shown == SHOWN && i >= SHOWN && r->fills[i].edges <= r->fills[largest[at]].edges)
            continue;
        for (; at > 0 && r->fills[largest[at - 1]].edges < r->fills[i].edges; at--)
            largest[at] = largest[at - 1];
        largest[at] = i;
    }
    for (size_t i = 0; i < shown; i++)
        fprintf(to, "%s%zu edges, %.3g wide", i ? "; " : ": ", r->fills[largest[i]].edges, r->fills[largest[i]].span);
    if (r->holes > shown)
        fprintf(to, "; and %zu smaller ones", r->holes - shown);
}

static status note_repairs(const mesh_repairs *r, diagnostic *why)
{
    text_writer to;
    char *text = NULL;
    size_t size;
    TRY(text_writer_open(&to, why));
    fprintf(
        to.stream,
        "welded %zu vertices; dropped %zu degenerate and %zu double triangles; swapped %zu diagonals; turned %zu over; "
        "filled %zu hole%s with %zu triangles",
        r->welded, r->degenerate, r->duplicate, r->swapped, r->turned, r->holes, r->holes == 1 ? "" : "s",
        r->triangles);
    note_holes(to.stream, r);
    TRY(text_writer_end(&to, STATUS_OK, &text, &size, why));
    terminal_note(text);
    free(text);
    return STATUS_OK;
}

static bool is_changed(const mesh_repairs *r)
{
    return r->welded || r->degenerate || r->duplicate || r->swapped || r->turned || r->holes;
}

static status close_mesh(mesh_request *request, diagnostic *why)
{
    mesh_repairs repairs;
    status code = mesh_repair(request->made, fmax(request->weld, 0.0), &repairs, &request->repaired, why);
    if (code != STATUS_OK && request->file)
        diagnostic_locate(why, request->file, 0, 0);
    if (code == STATUS_OK && request->made->closed && !is_changed(&repairs)) {
        terminal_note("the mesh is closed already; nothing was changed");
    } else if (code == STATUS_OK) {
        code = note_repairs(&repairs, why);
        request->made = request->repaired;
    }
    free(repairs.fills);
    return code;
}

static status load_mesh(mesh_request *request, diagnostic *why)
{
    TRY(request->file ? read_file(request, why) : generate(request, why));
    if (request->imported && request->imported->note)
        terminal_note(request->imported->note);
    if (request->close)
        TRY(close_mesh(request, why));
    const double rounding = request->format == MESH_GLB ? mesh_rounding(request->made) : 0.0;
    if (rounding > 0.0) {
        char note[120];
        snprintf(note, sizeof note, "GLB files have single precision: positions change by up to %.2g", rounding);
        terminal_note(note);
    }
    return STATUS_OK;
}

/* What a scene with a transparent solid of the mesh would say. */
static status describe(const mesh_request *request, FILE *stream, diagnostic *why)
{
    const mesh *m = request->made, *const * operands;
    diagnostic refusal = {.what = ""};
    int count;
    const status code = m->closed ? hierarchy_operands(m, 1, &operands, &count, &refusal) : STATUS_OK;
    if (code != STATUS_OK && code != STATUS_BAD_INPUT)
        return diagnose(why, code, refusal.remedy, "%s", refusal.what);
    const char *text = code == STATUS_OK ? NULL : refusal.what;
    if (request->json)
        return json_put(stream, mesh_rows_json(m, text), why);
    mesh_rows_text(stream, m, text);
    return STATUS_OK;
}

static status write_to(const void *content, FILE *stream, diagnostic *why)
{
    const mesh_request *request = content;
    if (request->format != MESH_FORMAT_COUNT)
        TRY(mesh_write(request->made, request->imported, (mesh_format)request->format, request->generate,
                       request->output, stream, why));
    else
        TRY(describe(request, stream, why));
    return cancel_check(why);
}

status command_mesh(int argc, char **argv, diagnostic *why)
{
    mesh_request request = {.scene = scene_create(), .format = MESH_FORMAT_COUNT, .weld = -1.0};
    status result = request.scene ? scene_add(request.scene, PARAM_MESH, "body", NULL, why) : out_of_memory(why);
    THEN(result, command_form_read(&form, argc, argv, &request, why));
    THEN(result, check_request(&request, why));
    THEN(result, choose_format(&request, why));
    THEN(result, load_mesh(&request, why));
    THEN(result, outputs_write_text(request.output, write_to, &request, why));
    mesh_release(request.repaired);
    mesh_import_destroy(request.imported);
    scene_destroy(request.scene);
    return result;
}
