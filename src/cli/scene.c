#include "base/grow.h"
#include "cli/cli.h"
#include "cli/inert_notes.h"
#include "cli/options.h"
#include "cli/outputs.h"
#include "cli/scene_edits.h"
#include "cli/scene_input.h"
#include "scene/model/params_path.h"
#include "scene/file/write.h"
#include "scene/model/scene.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct asked_edit {
    const scene_edit *edit;
    const char *text;
} asked_edit;

typedef struct scene_request {
    const char *path, *output; /* NULL: none, and standard output */
    asked_edit *edits;
    size_t edit_count;
    bool begins_empty, only_checks, only_lists, writes_all;
} scene_request;

enum { OPTIONS_MOST = 16 };

static status take_edit(const command_option *o, void *into, const char *text, diagnostic *why)
{
    scene_request *request = into;
    if (!room_for_one(&request->edits, request->edit_count, sizeof *request->edits))
        return out_of_memory(why);
    request->edits[request->edit_count++] = (asked_edit){&scene_edits[o->at], text};
    return STATUS_OK;
}

static const command_option plain_options[] = {
    {"new", 0, NULL, "begin with an empty scene in place of a file",
     OPTION_FILLS(option_flag, scene_request, begins_empty)},
    {"check", 0, NULL, "only say whether the scene is right, its files too, and what looks wrong in it",
     OPTION_FILLS(option_flag, scene_request, only_checks)},
    {"list", 0, NULL, "only list its objects: kind, name, and of a solid shape and material",
     OPTION_FILLS(option_flag, scene_request, only_lists)},
    {"all", 0, NULL, "write every parameter, not only what differs from the defaults",
     OPTION_FILLS(option_flag, scene_request, writes_all)},
    {"output", 'o', "FILE", "write there: .yaml or .yml, which may be the scene itself; standard output when not said",
     OPTION_FILLS(option_text, scene_request, output)},
    {0},
};

/* The options of the edits come first, from their table. */
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
        return options_wrong("scene", NULL, why,
                             "name a scene file, as experiments/scenes/rod.yaml, or begin with --new",
                             "no scene is named");
    if (request->path && request->begins_empty)
        return options_wrong("scene", NULL, why, "give one of them", "a scene file and --new exclude each other");
    if (request->only_checks && request->only_lists)
        return options_wrong("scene", NULL, why, "give one of them", "--check and --list exclude each other");
    if (request->output && (request->only_checks || request->only_lists))
        return options_wrong("scene", NULL, why, "leave out -o FILE", "--check and --list write no scene");
    if (!request->output || strcmp(request->output, "-") == 0)
        return STATUS_OK;
    TRY(outputs_ending("-o", request->output, endings, 2, "end it in .yaml or .yml", &unused, why));
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
    if (result == STATUS_OK) {
        /* For checks that have no line to name. */
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
    static const param_group groups[] = {PARAM_MESH, PARAM_TEXTURE, PARAM_MATERIAL, PARAM_LIGHT, PARAM_SOLID};
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
        result = scene_check(s, why); /* again, with the meshes' triangles */
    if (result != STATUS_OK) {
        if (why->line == 0) /* what has a line knows better */
            diagnostic_locate(why, request->path ? request->path : "--new", 0, 0);
        return result;
    }
    isa level = ISA_SSE2;
    TRY(scene_input_isa(&level, why));
    TRY(scene_input_lint(s, level, NULL, why));
    printf("%s: right; meshes %zu, textures %zu, materials %zu, lights %zu, solids %zu\n",
           request->path ? request->path : "--new", s->mesh_count, s->texture_count, s->material_count, s->light_count,
           s->solid_count);
    return STATUS_OK;
}

static status run(const scene_request *request, scene *s, diagnostic *why)
{
    if (request->only_checks)
        return check_files(request, s, why);
    if (request->only_lists)
        return print_list(s);
    const char *output = request->output ? request->output : "-";
    TRY(outputs_check_script("-o", output, s, why));
    return scene_write(s, output, request->writes_all, why);
}

static const char about[] =
    "Read a scene, or begin with an empty one; change it by the options, one after another; check it, and write it in "
    "one normal form. Only what differs from the defaults is written. Comments are not kept.\vNothing is written when "
    "something is wrong. For example:\n"
    "  cuvette scene rod.yaml --move rod=0,0.5,0 --turn rod=0,0,-22 -o b.yaml\n"
    "  cuvette scene --new --add light:lamp --add solid:ball=sphere,diffuse=0.8";

status command_scene(int argc, char **argv, diagnostic *why)
{
    command_option options[OPTIONS_MOST];
    make_options(options);
    const command_form form = {.options = options,
                               .words = "[FILE]",
                               .words_at = offsetof(scene_request, path),
                               .words_most = 1,
                               .excess_remedy = "scene takes one file",
                               .excess = "there is more than one scene",
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
