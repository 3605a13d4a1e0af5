#include "cli/cli.h"
#include "cli/inert_notes.h"
#include "cli/options.h"
#include "cli/outputs.h"
#include "cli/scene_edits.h"
#include "cli/scene_input.h"
#include "scene/model/params_path.h"
#include "scene/file/write.h"
#include "scene/model/scene.h"
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct asked_edit {
    const scene_edit *edit;
    const char *text;
} asked_edit;

typedef struct scene_request {
    const char *path, *output; /* NULL: none, and standard output */
    asked_edit *edits;         /* room for as many as the command line has words */
    size_t edit_count;
    bool begins_empty, only_checks, only_lists, writes_all;
} scene_request;

enum { KEY_NEW = 0x100, KEY_CHECK, KEY_LIST, KEY_ALL, OPTION_MAX = 16 };

static const struct argp_option plain_options[] = {
    {"new", KEY_NEW, NULL, 0, "begin with an empty scene in place of a file", 0},
    {"check", KEY_CHECK, NULL, 0, "only say whether the scene is right, its files too, and what looks wrong in it", 0},
    {"list", KEY_LIST, NULL, 0, "only list its objects: kind, name, and of a solid shape and material", 0},
    {"all", KEY_ALL, NULL, 0, "write every parameter, not only what differs from the defaults", 0},
    {"output", 'o', "FILE", 0,
     "write there: .yaml or .yml, which may be the scene itself; standard output when not said", 0},
    {0},
};

static status misused(diagnostic *why, const char *remedy, const char *what)
{
    diagnose(why, STATUS_BAD_INPUT, remedy, "%s", what);
    diagnostic_locate(why, "scene", 0, 0);
    return STATUS_BAD_INPUT;
}

static error_t take_edit(scene_request *request, int key, const char *text)
{
    for (size_t i = 0; i < scene_edit_count; i++)
        if (scene_edits[i].key == key) {
            request->edits[request->edit_count++] = (asked_edit){&scene_edits[i], text};
            return 0;
        }
    return ARGP_ERR_UNKNOWN;
}

static error_t take_option(int key, char *value, struct argp_state *state)
{
    options_input *input = state->input;
    scene_request *request = input->request;
    switch (key) {
    case 'o': request->output = value; return 0;
    case KEY_NEW: request->begins_empty = true; return 0;
    case KEY_CHECK: request->only_checks = true; return 0;
    case KEY_LIST: request->only_lists = true; return 0;
    case KEY_ALL: request->writes_all = true; return 0;
    case ARGP_KEY_ARG:
        if (request->path) {
            misused(input->why, "scene takes one file", "there is more than one scene");
            return EINVAL;
        }
        request->path = value;
        return 0;
    default: return take_edit(request, key, value);
    }
}

/* The options of the edits come first, from their table. */
static void make_options(struct argp_option options[OPTION_MAX])
{
    size_t count = 0;
    for (size_t i = 0; i < scene_edit_count; i++)
        options[count++] = (struct argp_option){
            scene_edits[i].option + 2, scene_edits[i].key, scene_edits[i].form, 0, scene_edits[i].purpose, 0};
    memcpy(&options[count], plain_options, sizeof plain_options);
}

static status check_request(const scene_request *request, diagnostic *why)
{
    static const char *const endings[] = {".yaml", ".yml"};
    size_t unused;
    if (!request->path && !request->begins_empty)
        return misused(why, "name a scene file, as experiments/scenes/rod.yaml, or begin with --new",
                       "no scene is named");
    if (request->path && request->begins_empty)
        return misused(why, "give one of them", "a scene file and --new exclude each other");
    if (request->only_checks && request->only_lists)
        return misused(why, "give one of them", "--check and --list exclude each other");
    if (request->output && (request->only_checks || request->only_lists))
        return misused(why, "leave out -o FILE", "--check and --list write no scene");
    if (!request->output || strcmp(request->output, "-") == 0)
        return STATUS_OK;
    status result = outputs_ending("-o", request->output, endings, 2, "end it in .yaml or .yml", &unused, why);
    return result == STATUS_OK ? outputs_check_folder("-o", request->output, why) : result;
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
        for (size_t i = 0; i < place_group_size(s, groups[g]); i++) {
            printf("%s %s", param_group_name(groups[g]), place_group_name(s, groups[g], i));
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
    result = scene_input_isa(&level, why);
    if (result == STATUS_OK)
        result = scene_input_lint(s, level, NULL, why);
    if (result != STATUS_OK)
        return result;
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
    status result = outputs_check_script("-o", output, s, why);
    return result == STATUS_OK ? scene_write(s, output, request->writes_all, why) : result;
}

static const char about[] = "Read a scene, or begin with an empty one; change it by the options, one after another; "
                            "check it, and write it in one normal "
                            "form. Only what differs from the defaults is written. Comments are not kept.\vNothing is "
                            "written when something is wrong. For "
                            "example:\n"
                            "  cuvette scene rod.yaml --move rod=0,0.5,0 --turn rod=0,0,-22 -o b.yaml\n"
                            "  cuvette scene --new --add light:lamp --add solid:ball=sphere,diffuse=0.8";

status command_scene(int argc, char **argv, diagnostic *why)
{
    struct argp_option options[OPTION_MAX];
    make_options(options);
    const struct argp parser = {.options = options, .parser = take_option, .args_doc = "[FILE]", .doc = about};
    scene_request request = {.edits = calloc((size_t)argc + 1, sizeof *request.edits)};
    scene *s = NULL;
    status result = request.edits ? options_parse(&parser, 0, argc, argv, &request, why) : out_of_memory(why);
    if (result == STATUS_OK)
        result = check_request(&request, why);
    if (result == STATUS_OK)
        result = make_scene(&request, &s, why);
    if (result == STATUS_OK)
        result = run(&request, s, why);
    scene_destroy(s);
    free(request.edits);
    return result;
}
