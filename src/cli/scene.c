/* `cuvette scene`: checks, lists, edits and writes scene files. */
#include "scene/model/scene.h"
#include "base/array.h"
#include "cli/cli.h"
#include "cli/options.h"
#include "cli/outputs.h"
#include "cli/scene_input.h"
#include "cli/terminal.h"
#include "report/scene_export.h"
#include "scene/assets/mesh_stream.h"
#include "scene/file/shared.h"
#include "scene/file/write.h"
#include "scene/model/edit/edit.h"
#include "scene/model/material.h"
#include "scene/model/open.h"
#include "scene/model/params.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* --- the edits, applied in the order of the command line --- */

typedef struct scene_edit scene_edit;

/* One option that edits a scene: name, placeholder of its value, help text, and function. */
struct scene_edit {
    const char *option; /* "--move" */
    int letter;         /* 0 for none */
    bool is_named;      /* the value is NAME=TEXT */
    const char *form;   /* "NAME=DX,DY,DZ" */
    const char *purpose;
    /* Without is_named, name is NULL and text is the complete value. */
    status (*apply)(scene *s, const scene_edit *edit, const char *name, const char *text, diagnostic *why);
};

static status malformed(const scene_edit *edit, const char *text, diagnostic *why)
{
    char remedy[96];
    snprintf(remedy, sizeof remedy, "write %s %s", edit->option, edit->form);
    return diagnose(why, STATUS_BAD_INPUT, remedy, "'%.80s' does not have the form %s", text, edit->form);
}

static status apply_set(scene *s, const scene_edit *edit, const char *path, const char *value, diagnostic *why)
{
    (void)edit;
    return scene_set_property(s, path, value, why);
}

static status apply_move(scene *s, const scene_edit *edit, const char *name, const char *text, diagnostic *why)
{
    double v[3];
    TRY(options_reals(edit->option, text, edit->form, 3, v, why));
    return scene_move(s, name, vec3_make(v[0], v[1], v[2]), why);
}

static status apply_turn(scene *s, const scene_edit *edit, const char *name, const char *text, diagnostic *why)
{
    double v[3];
    TRY(options_reals(edit->option, text, edit->form, 3, v, why));
    return scene_turn(s, name, vec3_make(v[0], v[1], v[2]), why);
}

static status apply_scale(scene *s, const scene_edit *edit, const char *name, const char *text, diagnostic *why)
{
    double factor;
    TRY(options_reals(edit->option, text, edit->form, 1, &factor, why));
    return scene_scale(s, name, factor, why);
}

static status apply_rename(scene *s, const scene_edit *edit, const char *name, const char *new_name, diagnostic *why)
{
    (void)edit;
    return scene_rename(s, name, new_name, why);
}

static status apply_delete(scene *s, const scene_edit *edit, const char *none, const char *text, diagnostic *why)
{
    (void)edit, (void)none;
    return scene_remove(s, text, why);
}

static status apply_title(scene *s, const scene_edit *edit, const char *none, const char *text, diagnostic *why)
{
    (void)edit, (void)none;
    return scene_set_title(s, text, why);
}

/* Splits "a=1,b=2,3,c=4" at the first comma before "WORD=", so that the commas of vectors stay. Returns the start of
 * the next parameter, NULL at the end. */
static char *cut_parameter(char *text)
{
    for (char *comma = strchr(text, ','); comma; comma = strchr(comma + 1, ',')) {
        const size_t word = strspn(comma + 1, "abcdefghijklmnopqrstuvwxyz_");
        if (word > 0 && comma[1 + word] == '=') {
            *comma = 0;
            return comma + 1;
        }
    }
    return NULL;
}

/* Sets a parameter such as "size=1,2,3" of the new object. A first pass sets the material (wants_material), a second
 * one all other parameters. */
static status put_parameter(scene *s, const char *name, char *parameter, bool wants_material, diagnostic *why)
{
    char *equals = strchr(parameter, '='), path[2 * SCENE_NAME_MAX];
    const size_t length = equals ? (size_t)(equals - parameter) : strlen(parameter);
    const bool names_material = length == strlen("material") && strncmp(parameter, "material", length) == 0;
    if (names_material != wants_material)
        return STATUS_OK;
    if (!equals)
        return diagnose(why, STATUS_BAD_INPUT, "write PARAMETER=VALUE after each comma", "'%.80s' has no value",
                        parameter);
    snprintf(path, sizeof path, "%s.%.*s", name, (int)(length < SCENE_NAME_MAX ? length : SCENE_NAME_MAX), parameter);
    return scene_set_property(s, path, equals + 1, why);
}

static status put_parameters(scene *s, const char *name, const char *text, bool wants_material, diagnostic *why)
{
    char *copy = strdup(text);
    status result = copy ? STATUS_OK : out_of_memory(why);
    for (char *next, *at = copy; at && result == STATUS_OK; at = next) {
        next = cut_parameter(at);
        result = put_parameter(s, name, at, wants_material, why);
    }
    free(copy);
    return result;
}

static status add_solid(scene *s, const char *name, const char *shape, diagnostic *why)
{
    shape_kind kind;
    TRY(scene_shape_named(shape, &kind, why));
    return scene_add_solid(s, name, kind, NULL, why);
}

static status add_object(scene *s, const char *kind, const char *name, const char *shape, diagnostic *why)
{
    static const char *const kinds[] = {"solid", "light", "beam", "material", "mesh", "texture", "data"};
    const bool is_solid = strcmp(kind, "solid") == 0;
    if (is_solid && !shape)
        return diagnose(why, STATUS_BAD_INPUT, "write solid:NAME=SHAPE, such as solid:rod=box", "%.80s has no shape",
                        name);
    if (is_solid)
        return add_solid(s, name, shape, why);
    if (shape)
        return diagnose(why, STATUS_BAD_INPUT, "remove '=SHAPE'", "a %.20s has no shape", kind);
    static const param_group groups[] = {PARAM_SOLID, PARAM_LIGHT,   PARAM_BEAM, PARAM_MATERIAL,
                                         PARAM_MESH,  PARAM_TEXTURE, PARAM_DATA};
    int which = 0;
    TRY(options_choice(NULL, "kind of object", kind, kinds, sizeof kinds / sizeof *kinds, &which, why));
    return scene_add(s, groups[which], name, NULL, why);
}

/* Splits "solid:rod=box,size=1,2,3" into its parts, adds the object and sets its parameters. */
static status apply_add(scene *s, const scene_edit *edit, const char *none, const char *text, diagnostic *why)
{
    (void)none;
    char *copy = strdup(text);
    if (!copy)
        return out_of_memory(why);
    char *colon = strchr(copy, ':'), *comma = strchr(copy, ',');
    if (comma)
        *comma = 0;
    char *equals = colon ? strchr(colon, '=') : NULL;
    status result;
    if (!colon || (comma && colon > comma)) {
        result = malformed(edit, text, why);
    } else {
        *colon = 0;
        if (equals)
            *equals = 0;
        result = add_object(s, copy, colon + 1, equals ? equals + 1 : NULL, why);
    }
    for (int pass = 0; pass < 2 && comma && result == STATUS_OK; pass++)
        result = put_parameters(s, colon + 1, comma + 1, pass == 0, why);
    free(copy);
    return result;
}

static const scene_edit scene_edits[] = {
    {"--add", 0, false, "KIND:NAME[=SHAPE][,PARAM=VALUE]...",
     "add a solid, light, beam, material, mesh, texture or data, such as solid:rod=box,size=0.25,3,0.25", apply_add},
    {"--set", 's', true, "PATH=VALUE",
     "set a parameter, or the material or shape of a solid (NAME.material, NAME.shape)", apply_set},
    {"--move", 0, true, "NAME=DX,DY,DZ",
     "move a solid, a light, the camera, or a group: all, solids, lights, or names joined by +, such as all+camera",
     apply_move},
    {"--turn", 0, true, "NAME=RX,RY,RZ",
     "rotate a solid or the camera about its position, or a group about the origin: about the world's x, then y, then "
     "z axis, in degrees",
     apply_turn},
    {"--scale", 0, true, "NAME=FACTOR",
     "scale a solid or a light about its position, or a group about the origin; scaling all solids adapts "
     "render.unit_m, so that lengths in metres do not change",
     apply_scale},
    {"--rename", 0, true, "OLD=NEW", "rename an object", apply_rename},
    {"--delete", 0, false, "NAME", "delete an object; camera, background and render return to their defaults",
     apply_delete},
    {"--title", 0, false, "TEXT", "set the title of the scene", apply_title},
};
enum { EDITS = sizeof scene_edits / sizeof *scene_edits };

static status apply_named(scene *s, const scene_edit *edit, const char *text, diagnostic *why)
{
    const char *equals = strchr(text, '=');
    char *name = equals ? strndup(text, (size_t)(equals - text)) : NULL;
    const status result = name     ? edit->apply(s, edit, name, equals + 1, why)
                          : equals ? out_of_memory(why)
                                   : malformed(edit, text, why);
    free(name);
    return result;
}

/* Applies one edit; diagnostics name its option. */
static status scene_edit_apply(scene *s, const scene_edit *edit, const char *text, diagnostic *why)
{
    char where[512];
    const status result = edit->is_named ? apply_named(s, edit, text, why) : edit->apply(s, edit, NULL, text, why);
    snprintf(where, sizeof where, "%s %s", edit->option, text);
    return locate_failure(why, where, result);
}

/* --- the command --- */

typedef struct edit_option {
    const scene_edit *edit;
    const char *text;
} edit_option;

typedef struct scene_request {
    const char *path, *output, *model; /* path NULL: no file; output NULL: standard output; model NULL: no --from */
    const char *exported;              /* file of another format; NULL: none */
    edit_option *edits;
    size_t edit_count;
    bool begins_empty, only_checks, only_lists, only_links, writes_all;
} scene_request;

enum { OPTIONS_MOST = 22 };

static status parse_edit(const command_option *o, void *context, const char *text, diagnostic *why)
{
    scene_request *request = context;
    if (!room_for_one(&request->edits, request->edit_count, sizeof *request->edits))
        return out_of_memory(why);
    request->edits[request->edit_count++] = (edit_option){&scene_edits[o->at], text};
    return STATUS_OK;
}

static const command_option plain_options[] = {
    {"new", 0, NULL, "start with an empty scene instead of a file",
     OPTION_FILLS(option_flag, scene_request, begins_empty)},
    {"from", 0, "MODEL", "start with a mesh file, such as a .glb: its mesh, camera and lights",
     OPTION_FILLS(option_text, scene_request, model)},
    {"check", 0, NULL, "only check the scene and its files, and note likely mistakes",
     OPTION_FILLS(option_flag, scene_request, only_checks)},
    {"list", 0, NULL, "only list the objects: kind and name; for a solid also shape and material",
     OPTION_FILLS(option_flag, scene_request, only_lists)},
    {"link", 0, NULL, "only print the scene as the fragment of a link, which 'cuvette render' and 'lab' open too",
     OPTION_FILLS(option_flag, scene_request, only_links)},
    {"export", 0, "FILE",
     "write the scene, with the triangles of its meshes, for other programs: .pov for POV-Ray, .gltf or .glb; notes "
     "say "
     "what that format cannot say",
     OPTION_FILLS(option_text, scene_request, exported)},
    OPTION_MEMORY,
    {"all", 0, NULL, "write every parameter, not only those that differ from the defaults",
     OPTION_FILLS(option_flag, scene_request, writes_all)},
    {"output", 'o', "FILE", "write to FILE, .yaml or .yml; may be the input file (default: standard output)",
     OPTION_FILLS(option_text, scene_request, output)},
    {0},
};

/* Builds the option list: the edits from their table, then the plain options. */
static void make_options(command_option options[OPTIONS_MOST])
{
    for (size_t i = 0; i < EDITS; i++)
        options[i] = (command_option){.name = scene_edits[i].option + 2,
                                      .letter = scene_edits[i].letter,
                                      .form = scene_edits[i].form,
                                      .purpose = scene_edits[i].purpose,
                                      .store = parse_edit,
                                      .at = i};
    memcpy(&options[EDITS], plain_options, sizeof plain_options);
}

static status check_request(const scene_request *request, diagnostic *why)
{
    static const char *const endings[] = {".yaml", ".yml"};
    size_t unused;
    if (!request->path && !request->begins_empty && !request->model)
        return options_wrong("scene", NULL, why, "give a scene file, such as experiments/scenes/rod.yaml, or --new",
                             "no scene is given");
    if ((request->path != NULL) + request->begins_empty + (request->model != NULL) > 1)
        return options_wrong("scene", NULL, why, "use only one of them",
                             "a scene file, --new and --from exclude each other");
    const int only = request->only_checks + request->only_lists + request->only_links + (request->exported != NULL);
    if (only > 1)
        return options_wrong("scene", NULL, why, "use only one of them",
                             "--check, --list, --link and --export exclude each other");
    if (request->output && only)
        return options_wrong("scene", NULL, why, "remove -o FILE",
                             "--check, --list, --link and --export do not write a scene file");
    if (request->exported) {
        TRY(outputs_ending("--export", request->exported, export_endings, EXPORT_FORMAT_COUNT,
                           "use a name that ends in .pov, .gltf or .glb", &unused, why));
        return outputs_check_folder("--export", request->exported, why);
    }
    if (!request->output || strcmp(request->output, "-") == 0)
        return STATUS_OK;
    TRY(outputs_ending("-o", request->output, endings, 2, "use a name that ends in .yaml or .yml", &unused, why));
    return outputs_check_folder("-o", request->output, why);
}

/* For messages: of the file, or the option that replaces it. */
static const char *name_of(const scene_request *request)
{
    return request->path ? request->path : request->model ? request->model : "--new";
}

static status make_scene(const scene_request *request, scene **out, diagnostic *why)
{
    status result = STATUS_OK;
    char *notes = NULL;
    if (request->path)
        result = scene_read(request->path, out, why);
    else if (request->model)
        result = mesh_first_scene(request->model, out, &notes, why);
    else if (!(*out = scene_create()))
        result = out_of_memory(why);
    if (notes)
        terminal_note(notes);
    free(notes);
    for (size_t i = 0; i < request->edit_count && result == STATUS_OK; i++)
        result = scene_edit_apply(*out, request->edits[i].edit, request->edits[i].text, why);
    if (result == STATUS_OK && (request->edit_count > 0 || !request->path)) {
        /* The position of errors without a line. */
        diagnostic_locate(why, name_of(request), 0, 0);
        result = scene_check(*out, why);
    }
    for (size_t i = 0; i < request->edit_count && result == STATUS_OK; i++)
        if (strcmp(request->edits[i].edit->option, "--set") == 0)
            scene_input_note_inert_assignment(*out, request->edits[i].text);
    return result;
}

static status print_list(const scene *s)
{
    static const param_group groups[] = {PARAM_MESH,  PARAM_TEXTURE, PARAM_DATA, PARAM_MATERIAL,
                                         PARAM_LIGHT, PARAM_BEAM,    PARAM_SOLID};
    for (size_t g = 0; g < sizeof groups / sizeof *groups; g++)
        for (size_t i = 0; i < param_place_group_size(s, groups[g]); i++) {
            printf("%s %s", param_group_name(groups[g]), param_place_group_name(s, groups[g], i));
            if (groups[g] == PARAM_SOLID) {
                const solid *owner = &s->solids[i];
                printf(" %s %s", shape_name(owner->shape.kind),
                       owner->material_index < 0 ? "-" : s->materials[owner->material_index].name);
            }
            putchar('\n');
        }
    return STATUS_OK;
}

static status load_files(const scene_request *request, scene *s, diagnostic *why)
{
    status result = scene_input_load(s, why);
    THEN(result, scene_check(s, why));         /* again, now with the triangles of the meshes */
    if (result != STATUS_OK && why->line == 0) /* keep the position of an error that has a line */
        diagnostic_locate(why, name_of(request), 0, 0);
    return result;
}

static status check_files(const scene_request *request, scene *s, diagnostic *why)
{
    TRY(load_files(request, s, why));
    isa level = ISA_BASE;
    TRY(scene_input_isa(&level, why));
    TRY(scene_input_lint(s, level, why));
    scene_input_note_beams(s);
    printf("%s: valid; meshes %zu, textures %zu, materials %zu, lights %zu, solids %zu\n", name_of(request),
           s->mesh_count, s->texture_count, s->material_count, s->light_count, s->solid_count);
    return STATUS_OK;
}

static status print_link(const scene *s, diagnostic *why)
{
    char *text = NULL, *code = NULL;
    status result = shared_scene_text(s, &text, why);
    THEN(result, shared_scene_code(text, &code, why));
    if (result == STATUS_OK)
        printf("%s%s\n", SHARED_FRAGMENT, code);
    free(text);
    free(code);
    return result;
}

static status write_exported(const void *content, FILE *stream, diagnostic *why)
{
    const scene_export *made = content;
    (void)why;
    fwrite(made->bytes, 1, made->size, stream); /* the caller checks the stream */
    return STATUS_OK;
}

static status export_scene(const scene_request *request, scene *s, diagnostic *why)
{
    scene_export made;
    size_t format = 0;
    TRY(outputs_check_place("--export", request->exported, s, why));
    TRY(load_files(request, s, why));
    TRY(outputs_ending("--export", request->exported, export_endings, EXPORT_FORMAT_COUNT, "", &format, why));
    TRY(scene_export_make(s, (export_format)format, request->exported, &made, why));
    const status code = outputs_write_text(request->exported, write_exported, &made, why);
    for (size_t i = 0; i < made.note_count && code == STATUS_OK; i++)
        terminal_note(made.notes[i]);
    scene_export_release(&made);
    return code;
}

static status run(const scene_request *request, scene *s, diagnostic *why)
{
    if (request->exported)
        return export_scene(request, s, why);
    if (request->only_checks)
        return check_files(request, s, why);
    if (request->only_lists)
        return print_list(s);
    if (request->only_links)
        return print_link(s, why);
    const char *output = request->output ? request->output : "-";
    TRY(outputs_check_script("-o", output, s, why));
    return scene_write(s, output, request->writes_all, why);
}

static const char about[] =
    "Read a scene file, or start with an empty scene or a mesh file; apply the edits in the order of the options; "
    "check the scene and write it in canonical form. Only values that differ from the defaults are written; comments "
    "are dropped. If there is an error, nothing is written.\vExamples:\n"
    "  cuvette scene rod.yaml --move rod=0,0.5,0 --turn rod=0,0,-22 -o b.yaml\n"
    "  cuvette scene --new --add light:lamp --add solid:ball=sphere,diffuse=0.8\n"
    "  cuvette scene --from bottle.glb -o bottle.yaml\n"
    "  cuvette scene rod.yaml --export rod.pov";

status command_scene(int argc, char **argv, diagnostic *why)
{
    command_option options[OPTIONS_MOST];
    make_options(options);
    const command_form form = {.options = options,
                               .synopsis = "[FILE]",
                               .arguments_at = offsetof(scene_request, path),
                               .argument_limit = 1,
                               .excess_remedy = "give one scene file",
                               .excess = "only one scene can be given",
                               .about = about};
    scene_request request = {.path = NULL};
    scene *s = NULL;
    status result = command_form_read(&form, argc, argv, &request, why);
    THEN(result, check_request(&request, why));
    THEN(result, make_scene(&request, &s, why));
    THEN(result, run(&request, s, why));
    scene_destroy(s);
    free(request.edits);
    return result;
}
