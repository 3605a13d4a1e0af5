/* `cuvette scene`: checks, lists, edits and writes scene files. */
#include "base/array.h"
#include "cli/cli.h"
#include "cli/inert_notes.h"
#include "cli/options.h"
#include "cli/outputs.h"
#include "cli/scene_edits.h"
#include "cli/scene_input.h"
#include "scene/model/params.h"
#include "scene/file/shared.h"
#include "scene/file/write.h"
#include "scene/model/scene.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct edit_option {
    const scene_edit *edit;
    const char *text;
} edit_option;

typedef struct scene_request {
    const char *path, *output; /* path NULL: no file; output NULL: standard output */
    edit_option *edits;
    size_t edit_count;
    bool begins_empty, only_checks, only_lists, only_links, writes_all;
} scene_request;

enum { OPTIONS_MOST = 20 };

static status take_edit(const command_option *o, void *context, const char *text, diagnostic *why)
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
    {"check", 0, NULL, "only check the scene and its files, and note likely mistakes",
     OPTION_FILLS(option_flag, scene_request, only_checks)},
    {"list", 0, NULL, "only list the objects: kind and name; for a solid also shape and material",
     OPTION_FILLS(option_flag, scene_request, only_lists)},
    {"link", 0, NULL, "only print the scene as the fragment of a link, which 'cuvette render' and 'lab' open too",
     OPTION_FILLS(option_flag, scene_request, only_links)},
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
    for (size_t i = 0; i < scene_edit_count; i++)
        options[i] = (command_option){.name = scene_edits[i].option + 2,
                                      .letter = scene_edits[i].letter,
                                      .form = scene_edits[i].form,
                                      .purpose = scene_edits[i].purpose,
                                      .take = take_edit,
                                      .at = i};
    memcpy(&options[scene_edit_count], plain_options, sizeof plain_options);
}

static status check_request(const scene_request *request, diagnostic *why)
{
    static const char *const endings[] = {".yaml", ".yml"};
    size_t unused;
    if (!request->path && !request->begins_empty)
        return options_wrong("scene", NULL, why, "give a scene file, such as experiments/scenes/rod.yaml, or --new",
                             "no scene is given");
    if (request->path && request->begins_empty)
        return options_wrong("scene", NULL, why, "use only one of them", "a scene file and --new exclude each other");
    const int only = request->only_checks + request->only_lists + request->only_links;
    if (only > 1)
        return options_wrong("scene", NULL, why, "use only one of them",
                             "--check, --list and --link exclude each other");
    if (request->output && only)
        return options_wrong("scene", NULL, why, "remove -o FILE",
                             "--check, --list and --link do not write a scene file");
    if (!request->output || strcmp(request->output, "-") == 0)
        return STATUS_OK;
    TRY(outputs_ending("-o", request->output, endings, 2, "use a name that ends in .yaml or .yml", &unused, why));
    return outputs_check_folder("-o", request->output, why);
}

static status make_scene(const scene_request *request, scene **out, diagnostic *why)
{
    status result = STATUS_OK;
    if (request->path)
        result = scene_read(request->path, out, why);
    else if (!(*out = scene_create()))
        result = out_of_memory(why);
    for (size_t i = 0; i < request->edit_count && result == STATUS_OK; i++)
        result = scene_edit_apply(*out, request->edits[i].edit, request->edits[i].text, why);
    if (result == STATUS_OK && (request->edit_count > 0 || !request->path)) {
        /* The place of errors that have no line. */
        diagnostic_locate(why, request->path ? request->path : "--new", 0, 0);
        result = scene_check(*out, why);
    }
    for (size_t i = 0; i < request->edit_count && result == STATUS_OK; i++)
        if (strcmp(request->edits[i].edit->option, "--set") == 0)
            inert_note_assignment(*out, request->edits[i].text);
    return result;
}

static status print_list(const scene *s)
{
    static const param_group groups[] = {PARAM_MESH,  PARAM_TEXTURE, PARAM_MATERIAL,
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

static status check_files(const scene_request *request, scene *s, diagnostic *why)
{
    status result = scene_input_load(s, why);
    if (result == STATUS_OK)
        result = scene_check(s, why); /* again, now with the triangles of the meshes */
    if (result != STATUS_OK) {
        if (why->line == 0) /* keep the place of an error that has a line */
            diagnostic_locate(why, request->path ? request->path : "--new", 0, 0);
        return result;
    }
    isa level = ISA_BASE;
    TRY(scene_input_isa(&level, why));
    TRY(scene_input_lint(s, level, why));
    scene_input_note_beams(s);
    printf("%s: valid; meshes %zu, textures %zu, materials %zu, lights %zu, solids %zu\n",
           request->path ? request->path : "--new", s->mesh_count, s->texture_count, s->material_count, s->light_count,
           s->solid_count);
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

static status run(const scene_request *request, scene *s, diagnostic *why)
{
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
    "Read a scene file, or start with an empty scene; apply the edits in the order of the options; check the scene and "
    "write it in canonical form. Only values that differ from the defaults are written; comments are dropped. If "
    "there is an error, nothing is written.\vExamples:\n"
    "  cuvette scene rod.yaml --move rod=0,0.5,0 --turn rod=0,0,-22 -o b.yaml\n"
    "  cuvette scene --new --add light:lamp --add solid:ball=sphere,diffuse=0.8";

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
