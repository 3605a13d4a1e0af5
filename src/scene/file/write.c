/* Writes a scene's parameters in the order of the table and of the scene, without those that a reader infers. Quoting
 * and paths: write_parts.c. */
#include "scene/file/write.h"
#include "base/file.h"
#include "base/text.h"
#include "scene/model/medium.h"
#include "scene/model/params.h"
#include "scene/model/scene.h"

#include <stdlib.h>
#include <string.h>

/* --- which lines --- */

static bool is_material_row(const param *row, size_t offset)
{
    return row->group == PARAM_MATERIAL && row->offset == offset;
}

static bool is_background_row(const param *row, size_t offset)
{
    return row->group == PARAM_BACKGROUND && row->offset == offset;
}

/* Whether the row is the source that the mesh does not use: a mesh has either a file or a generator. */
static bool is_other_source(const mesh_entry *m, const param *row)
{
    if (row->offset == offsetof(mesh_entry, script_path))
        return false;
    return m->source == MESH_FILE ? row->offset == offsetof(mesh_entry, source)
                                  : row->offset == offsetof(mesh_entry, path);
}

/* The index of a material with another medium has no effect, and writing it would replace that medium. */
static bool is_without_effect(const scene *s, const param_place *at)
{
    if (at->object_group == PARAM_MESH)
        return is_other_source(&s->meshes[at->index], at->row);
    if (is_background_row(at->row, offsetof(background, ior)))
        return s->background.medium != MEDIUM_IOR;
    if (!is_material_row(at->row, offsetof(material, ior)))
        return false;
    const material *m =
        at->object_group == PARAM_SOLID ? &s->solids[at->index].surface : &s->materials[at->index].value;
    return m->medium != MEDIUM_IOR;
}

/* The value that a reader would assume without the line: the material's for a solid with one, else the default. */
static char *implied_text(const scene *s, const param_place *at)
{
    const int index =
        at->object_group == PARAM_SOLID && at->row->group == PARAM_MATERIAL ? s->solids[at->index].material_index : -1;
    if (index < 0)
        return param_default_text(at->row);
    const param_place there = {.row = at->row, .object_group = PARAM_MATERIAL, .index = (size_t)index, .element = -1};
    const material *m = &s->materials[index].value;
    return is_without_effect(s, &there) ? param_default_text(at->row)
                                        : param_value_text(at->row, -1, (const char *)m + at->row->offset);
}

/* yaw_deg of a camera that is aimed by angles is written even if it is 0: its presence selects the angles. */
static bool is_needed(const param *row)
{
    return row->group == PARAM_CAMERA && row->offset == offsetof(camera, yaw_deg);
}

/* Whether a solid has the value that a reader would assume. A fast test for scenes of many solids, which have most
 * parameters from a material or the defaults; false if it is not known. */
static bool solid_has_implied(const scene *s, const param_place *at)
{
    const solid *one = &s->solids[at->index], *new = s->new_solid;
    if (at->row->group != PARAM_MATERIAL)
        return new &&param_values_match(at->row, one, new);
    if (one->material_index < 0)
        return new &&param_values_match(at->row, &one->surface, &new->surface);
    const material *m = &s->materials[one->material_index].value;
    const bool is_other_index = is_material_row(at->row, offsetof(material, ior)) && m->medium != MEDIUM_IOR;
    return !is_other_index && param_values_match(at->row, &one->surface, m);
}

/* Whether the line is written: a reader would infer another value. all: every line, unless it would replace a setting
 * in use. value: the row's value as text. */
static status is_line_wanted(const scene *s, const param_place *at, const char *value, bool all, bool *wanted,
                             diagnostic *why)
{
    *wanted = false;
    char *implied = implied_text(s, at);
    if (!implied)
        return out_of_memory(why);
    /* An empty path is not written, and unused paths are not visited. */
    *wanted = (all && value[0]) || is_needed(at->row) || strcmp(implied, value) != 0;
    free(implied);
    return STATUS_OK;
}

/* --- the text --- */

/* State of the traversal: the output, and the position in the file. */
typedef struct scene_writer {
    const scene *s;
    const char *path; /* path of the new file */
    bool all;
    FILE *out;
    const size_t *size;              /* of the text, except for what the stream holds */
    size_t most;                     /* bytes; SIZE_MAX: no limit */
    bool begun;                      /* the file is not empty */
    param_group group;               /* the current group */
    bool in_section;                 /* the heading of the group's section is written */
    char object[SCENE_NAME_MAX + 1]; /* the object whose heading was written last */
    bool empty;                      /* the object has no line yet */
    diagnostic *why;
} scene_writer;

static bool is_section_of_objects(param_group group)
{
    return group > PARAM_BACKGROUND;
}

/* Writes the heading of the section ("materials:") once. */
static void put_section(scene_writer *w)
{
    if (!w->in_section) {
        const char *plural = w->group == PARAM_MESH            ? "es"
                             : w->group == PARAM_DATA          ? ""
                             : is_section_of_objects(w->group) ? "s"
                                                               : "";
        fprintf(w->out, "%s%s%s:\n", w->begun ? "\n" : "", param_group_name(w->group), plural);
        w->begun = w->in_section = true;
    }
}

/* An object without lines is written as an empty map. */
static void end_object(scene_writer *w)
{
    if (w->object[0] && w->empty)
        fputs(" {}\n", w->out);
    w->object[0] = 0;
}

static void begin_line(scene_writer *w, const char *key)
{
    if (w->object[0] && w->empty) {
        fputc('\n', w->out);
        w->empty = false;
    }
    fprintf(w->out, "%s%s: ", is_section_of_objects(w->group) ? "    " : "  ", key);
}

/* Writes the heading of an object; for a solid also its shape and material, which are not rows of the table. */
static void begin_object(scene_writer *w, const param_place *at)
{
    const char *name = param_place_group_name(w->s, at->object_group, at->index);
    end_object(w);
    put_section(w);
    fputs("  ", w->out);
    write_word(w->out, name);
    fputc(':', w->out);
    strcpy(w->object, name);
    w->empty = true;
    if (at->object_group != PARAM_SOLID)
        return;
    const solid *owner = &w->s->solids[at->index];
    begin_line(w, "shape");
    fprintf(w->out, "%s\n", shape_name(owner->shape.kind));
    if (owner->material_index >= 0) {
        begin_line(w, "material");
        write_word(w->out, w->s->materials[owner->material_index].name);
        fputc('\n', w->out);
    }
}

static void put_value(scene_writer *w, const param *row, const char *value)
{
    switch (row->type) {
    case PARAM_VECTOR:
    case PARAM_COLOR:
    case PARAM_LIST: write_list(w->out, value); break;
    case PARAM_LAYERS: fprintf(w->out, strchr(value, ' ') ? "[%s]" : "%s", value); break;
    case PARAM_PATH:
    case PARAM_WORD: write_word(w->out, value); break;
    case PARAM_INT:
    case PARAM_REAL:
    case PARAM_CHOICE: fputs(value, w->out); break;
    }
    fputc('\n', w->out);
}

static status put_path(scene_writer *w, const char *label, const param *row, const char *value)
{
    char *moved = NULL;
    status code = write_moved_path(value, w->s->path, w->path, &moved, w->why);
    THEN(code, write_check_text(label, moved, w->why));
    if (code == STATUS_OK)
        put_value(w, row, moved);
    free(moved);
    return code;
}

static status put_row(scene_writer *w, const char *name, const param_place *at, const char *value)
{
    bool wanted = false;
    status code = is_line_wanted(w->s, at, value, w->all, &wanted, w->why);
    if (code != STATUS_OK || !wanted)
        return code;
    put_section(w);
    begin_line(w, at->row->name);
    char label[2 * SCENE_NAME_MAX];
    snprintf(label, sizeof label, "%s.%s", name, at->row->name);
    if (at->row->type == PARAM_PATH)
        return put_path(w, label, at->row, value);
    if (at->row->type == PARAM_WORD)
        TRY(write_check_text(label, value, w->why));
    put_value(w, at->row, value);
    return STATUS_OK;
}

static status visit(void *context, const param_place *at)
{
    scene_writer *w = context;
    const char *name = param_place_group_name(w->s, at->object_group, at->index);
    if (is_section_of_objects(at->object_group) && strcmp(w->object, name) != 0)
        begin_object(w, at);
    if (*w->size > w->most)
        return STATUS_INTERRUPTED;
    if (is_without_effect(w->s, at) || (!w->all && at->object_group == PARAM_SOLID && solid_has_implied(w->s, at)))
        return STATUS_OK;
    char *value = param_place_text(w->s, at);
    const status code = value ? put_row(w, name, at, value) : out_of_memory(w->why);
    free(value);
    return code;
}

/* Arrays given by a program cannot be written to a file. */
static status check_sources(const scene *s, diagnostic *why)
{
    for (size_t i = 0; i < s->mesh_count; i++) {
        if (s->meshes[i].source == MESH_ARRAYS)
            return diagnose(why, STATUS_BAD_INPUT, "write the mesh to a file, and give its name",
                            "the mesh %.80s was given as arrays, which cannot be stored in a scene file",
                            s->meshes[i].name);
    }
    for (size_t i = 0; i < s->texture_count; i++) {
        if (s->textures[i].data && !s->textures[i].path[0])
            return diagnose(why, STATUS_BAD_INPUT, "write the image to a file, and give its name",
                            "the texture %.80s was given as pixels, which cannot be stored in a scene file",
                            s->textures[i].name);
    }
    for (size_t i = 0; i < s->data_count; i++) {
        if (s->data[i].data && !s->data[i].path[0])
            return diagnose(why, STATUS_BAD_INPUT, "write them to a file, and give its name",
                            "the data %.80s were given as arrays, which cannot be stored in a scene file",
                            s->data[i].name);
    }
    return STATUS_OK;
}

static status put_scene(scene_writer *w)
{
    /* Objects come before the objects that refer to them. */
    static const param_group order[] = {PARAM_RENDER, PARAM_CAMERA,   PARAM_BACKGROUND, PARAM_MESH, PARAM_TEXTURE,
                                        PARAM_DATA,   PARAM_MATERIAL, PARAM_LIGHT,      PARAM_BEAM, PARAM_SOLID};
    _Static_assert(sizeof order / sizeof *order == PARAM_GROUP_COUNT, "every group has its section");
    if (w->s->title[0]) {
        TRY(write_check_text("title", w->s->title, w->why));
        fputs("title: ", w->out);
        write_word(w->out, w->s->title);
        fputc('\n', w->out);
        w->begun = true;
    }
    status code = check_sources(w->s, w->why);
    for (size_t i = 0; i < PARAM_GROUP_COUNT && code == STATUS_OK; i++) {
        w->group = order[i];
        w->in_section = false;
        code = param_place_each(w->s, w->group, visit, w);
        end_object(w);
    }
    if (!w->begun)
        fputs("solids: {}\n", w->out); /* an empty file is not a scene */
    return code;
}

/* *text is NULL, and the status STATUS_INTERRUPTED, for a text of more than `most` bytes. */
static status write_text(const scene *s, const char *path, bool all, size_t most, char **text, diagnostic *why)
{
    *text = NULL;
    text_writer writer;
    TRY(text_writer_open(&writer, why));
    scene_writer w = {.s = s,
                      .path = path ? path : "",
                      .all = all,
                      .out = writer.stream,
                      .size = &writer.size,
                      .most = most,
                      .why = why};
    size_t size = 0;
    const status code = text_writer_end(&writer, put_scene(&w), text, &size, why);
    if (code != STATUS_OK || size <= most)
        return code;
    free(*text);
    *text = NULL;
    return STATUS_INTERRUPTED;
}

status scene_write_text(const scene *s, const char *path, bool all, char **text, diagnostic *why)
{
    return write_text(s, path, all, SIZE_MAX, text, why);
}

status scene_write_short(const scene *s, size_t most, char **text, diagnostic *why)
{
    const status code = write_text(s, NULL, false, most, text, why);
    return code == STATUS_INTERRUPTED ? STATUS_OK : code;
}

status scene_write(const scene *s, const char *path, bool all, diagnostic *why)
{
    char *text;
    TRY(scene_write_text(s, strcmp(path, "-") == 0 ? "" : path, all, &text, why));
    const status code = file_write(path, text, why);
    free(text);
    return code;
}
