/* Writes and reads the contents of a package: the scene's text, path and limits, and all loaded data. */
#include "geometry/hierarchy/hierarchy.h"
#include "image/texture.h"
#include "scene/model/scene.h"
#include "scene/package/package.h"

#include <stdlib.h>
#include <string.h>

/* --- the materials in a mesh file, and their images, each once --- */

/* No number of a material that the parameter table or the importer allows is larger. */
#define NUMBER_MAX 1e6

typedef struct face_record {
    char name[SCENE_NAME_MAX + 1];
    int64_t given;
    double number[12]; /* colour, diffuse, specular, shininess, emission, opacity, alpha_cutoff, glow */
    int64_t alpha;
    /* 0: none; 1: it follows; else the image at place image - 2: slot i has places 2 i, and 2 i + 1 of its glow */
    int64_t image, glow_image;
} face_record;
_Static_assert(sizeof(face_record) == SCENE_NAME_MAX + 1 + 16 * 8 && SCENE_NAME_MAX % 8 == 7, "no padding");

static const texture *image_at(const face_material *m, int place)
{
    return place % 2 ? m->glow_img : m->img;
}

static int64_t image_of(const face_materials *l, int place)
{
    const texture *img = image_at(face_materials_at(l, place / 2), place);
    for (int i = 0; img && i < place; i++)
        if (image_at(face_materials_at(l, i / 2), i) == img)
            return i + 2;
    return img != NULL;
}

static status put_material(pack_writer *to, const face_materials *l, int slot, diagnostic *why)
{
    const face_material *m = face_materials_at(l, slot);
    face_record record = {.given = m->given,
                          .number = {m->color.x, m->color.y, m->color.z, m->diffuse, m->specular, m->shininess,
                                     m->emission, m->opacity, m->alpha_cutoff, m->glow.x, m->glow.y, m->glow.z},
                          .alpha = m->alpha,
                          .image = image_of(l, 2 * slot),
                          .glow_image = image_of(l, 2 * slot + 1)};
    memcpy(record.name, m->name, sizeof record.name);
    TRY(pack_put(to, &record, sizeof record, why));
    if (record.image == 1)
        TRY(texture_pack(m->img, to, why));
    return record.glow_image == 1 ? texture_pack(m->glow_img, to, why) : STATUS_OK;
}

static status put_face_materials(pack_writer *to, const face_materials *l, diagnostic *why)
{
    const int64_t count = face_materials_count(l), any = l != NULL;
    TRY(pack_put(to, &any, sizeof any, why));
    TRY(pack_put(to, &count, sizeof count, why));
    for (int i = 0; i < count; i++)
        TRY(put_material(to, l, i, why));
    return STATUS_OK;
}

static bool is_record(const face_record *r, int slot)
{
    bool valid = memchr(r->name, 0, sizeof r->name) && r->given >= 0 && r->given <= 1 && r->image >= 0 &&
                 r->image <= 2 * slot + 1 && r->glow_image >= 0 && r->glow_image <= 2 * slot + 2 &&
                 r->alpha >= ALPHA_OPAQUE && r->alpha <= ALPHA_BLEND;
    for (size_t i = 0; i < sizeof r->number / sizeof *r->number; i++)
        valid = valid && r->number[i] >= 0.0 && r->number[i] <= NUMBER_MAX;
    return valid;
}

static status get_image(pack_reader *from, const face_material *list, int64_t number, const texture **out,
                        diagnostic *why)
{
    if (number == 1)
        return texture_unpack(from, out, why);
    const int place = (int)number - 2;
    if (number > 1 && (*out = image_at(&list[place / 2], place)))
        texture_retain(*out);
    return STATUS_OK;
}

static status get_material(pack_reader *from, face_material *list, int slot, diagnostic *why)
{
    face_record record;
    TRY(pack_get(from, &record, sizeof record, why));
    if (!is_record(&record, slot))
        return pack_damaged(why, "a material of a mesh");
    face_material *m = &list[slot];
    const double *n = record.number;
    *m = (face_material){.given = record.given,
                         .color = {n[0], n[1], n[2]},
                         .diffuse = n[3],
                         .specular = n[4],
                         .shininess = n[5],
                         .emission = n[6],
                         .opacity = n[7],
                         .alpha = (material_alpha)record.alpha,
                         .alpha_cutoff = n[8],
                         .glow = {n[9], n[10], n[11]}};
    memcpy(m->name, record.name, sizeof m->name);
    TRY(get_image(from, list, record.image, &m->img, why));
    return get_image(from, list, record.glow_image, &m->glow_img, why);
}

static status get_list(pack_reader *from, face_material *list, int count, const face_materials **out, diagnostic *why)
{
    for (int i = 0; i < count; i++) {
        const status code = get_material(from, list, i, why);
        if (code != STATUS_OK) {
            for (int k = 0; k <= i; k++)
                texture_release(list[k].img), texture_release(list[k].glow_img);
            return code;
        }
    }
    return face_materials_of(list, count, "", out, why);
}

static status get_face_materials(pack_reader *from, const face_materials **out, diagnostic *why)
{
    int64_t any, count;
    *out = NULL;
    TRY(pack_get(from, &any, sizeof any, why));
    TRY(pack_get(from, &count, sizeof count, why));
    if (any < 0 || any > 1 || count < 0 || count > (any ? MESH_SLOTS_MAX : 0))
        return pack_damaged(why, "the number of a mesh's materials");
    if (!any)
        return STATUS_OK;
    face_material *list = calloc((size_t)count + 1, sizeof *list);
    if (!list)
        return out_of_memory(why);
    const status code = get_list(from, list, (int)count, out, why);
    free(list);
    return code;
}

/* --- loaded data --- */

/* Where the data of an entry are. */
enum {
    DATA_NONE,
    DATA_FOLLOWS,
    DATA_OF_ENTRY /* DATA_OF_ENTRY + i: with the earlier entry i */
};

typedef struct scene_record {
    uint64_t triangles; /* the limit of loading */
    int64_t image_line, image_column, image, textures, data, meshes;
} scene_record;

typedef struct texture_record {
    int64_t line, column, data;
} texture_record;

typedef struct mesh_record {
    int64_t path_line, path_column, script_line, script_column, data;
    softbody_quantities account;
    double motion_s;
} mesh_record;
_Static_assert(sizeof(softbody_quantities) == 22 * 8 && sizeof(mesh_record) == 28 * 8, "no padding");

static int64_t data_of_texture(const scene *s, size_t index)
{
    const texture *data = s->textures[index].data;
    for (size_t i = 0; data && i < index; i++)
        if (s->textures[i].data == data)
            return (int64_t)i + DATA_OF_ENTRY;
    return data ? DATA_FOLLOWS : DATA_NONE;
}

static int64_t data_of_mesh(const scene *s, size_t index)
{
    const mesh *data = s->meshes[index].data;
    for (size_t i = 0; data && i < index; i++)
        if (s->meshes[i].data == data)
            return (int64_t)i + DATA_OF_ENTRY;
    return data ? DATA_FOLLOWS : DATA_NONE;
}

static status put_texture(pack_writer *to, const scene *s, size_t index, diagnostic *why)
{
    const texture_entry *t = &s->textures[index];
    const texture_record record = {t->path_line, t->path_column, data_of_texture(s, index)};
    TRY(pack_put(to, &record, sizeof record, why));
    return record.data == DATA_FOLLOWS ? texture_pack(t->data, to, why) : STATUS_OK;
}

static status put_mesh(pack_writer *to, const scene *s, size_t index, diagnostic *why)
{
    const mesh_entry *m = &s->meshes[index];
    const mesh_record record = {.path_line = m->path_line,
                                .path_column = m->path_column,
                                .script_line = m->script_line,
                                .script_column = m->script_column,
                                .data = data_of_mesh(s, index),
                                .account = m->account,
                                .motion_s = m->motion_s};
    TRY(pack_put(to, &record, sizeof record, why));
    if (record.data != DATA_FOLLOWS)
        return STATUS_OK;
    TRY(mesh_pack(m->data, to, why));
    return put_face_materials(to, m->shading_materials, why);
}

static status put_data(pack_writer *to, const data_entry *d, diagnostic *why)
{
    const texture_record record = {d->path_line, d->path_column, d->data ? DATA_FOLLOWS : DATA_NONE};
    TRY(pack_put(to, &record, sizeof record, why));
    return d->data ? optical_data_pack(d->data, to, why) : STATUS_OK;
}

status package_put_scene(pack_writer *to, const scene *s, const char *text, diagnostic *why)
{
    const background *sky = &s->background;
    const scene_record record = {.triangles = s->limits.triangles,
                                 .image_line = sky->image_line,
                                 .image_column = sky->image_column,
                                 .image = sky->img ? DATA_FOLLOWS : DATA_NONE,
                                 .textures = (int64_t)s->texture_count,
                                 .data = (int64_t)s->data_count,
                                 .meshes = (int64_t)s->mesh_count};
    TRY(pack_put_text(to, s->path, why));
    TRY(pack_put_text(to, s->limits.root, why));
    TRY(pack_put_text(to, text, why));
    TRY(pack_put(to, &record, sizeof record, why));
    if (sky->img)
        TRY(image_pack(sky->img, to, why));
    for (size_t i = 0; i < s->texture_count; i++)
        TRY(put_texture(to, s, i, why));
    for (size_t i = 0; i < s->data_count; i++)
        TRY(put_data(to, &s->data[i], why));
    for (size_t i = 0; i < s->mesh_count; i++)
        TRY(put_mesh(to, s, i, why));
    return STATUS_OK;
}

static status get_sky(pack_reader *from, background *sky, diagnostic *why)
{
    TRY(image_unpack(from, &sky->img, why));
    if (sky_take(sky, "", NULL) == STATUS_OK)
        return STATUS_OK;
    image_destroy(sky->img);
    sky->img = NULL;
    return pack_damaged(why, "the radiance of the sky");
}

/* Whether `data` is a valid value: none, follows, or an earlier entry. */
static bool is_known(int64_t data, size_t index)
{
    return data >= DATA_NONE && (data <= DATA_FOLLOWS || (uint64_t)(data - DATA_OF_ENTRY) < index);
}

static status get_texture(pack_reader *from, scene *s, size_t index, diagnostic *why)
{
    texture_entry *t = &s->textures[index];
    texture_record record;
    TRY(pack_get(from, &record, sizeof record, why));
    if (!is_known(record.data, index))
        return pack_damaged(why, "the number of a texture");
    t->path_line = record.line;
    t->path_column = record.column;
    if (record.data == DATA_FOLLOWS)
        return texture_unpack(from, &t->data, why);
    if (record.data >= DATA_OF_ENTRY && (t->data = s->textures[record.data - DATA_OF_ENTRY].data))
        texture_retain(t->data);
    return STATUS_OK;
}

static status get_data(pack_reader *from, data_entry *d, diagnostic *why)
{
    texture_record record;
    TRY(pack_get(from, &record, sizeof record, why));
    if (record.data != DATA_NONE && record.data != DATA_FOLLOWS)
        return pack_damaged(why, "where optical data are");
    d->path_line = record.line;
    d->path_column = record.column;
    return record.data == DATA_FOLLOWS ? optical_data_unpack(from, &d->data, why) : STATUS_OK;
}

static void reference_mesh(mesh_entry *m, const mesh_entry *other)
{
    if (!other->data)
        return;
    m->data = other->data;
    m->shading_materials = other->shading_materials;
    mesh_retain(m->data);
    face_materials_retain(m->shading_materials);
}

static status get_fitting_materials(pack_reader *from, mesh_entry *m, diagnostic *why)
{
    TRY(get_face_materials(from, &m->shading_materials, why));
    const bool fit = !m->shading_materials || face_materials_count(m->shading_materials) == m->data->slot_count;
    return fit ? STATUS_OK : pack_damaged(why, "the number of a mesh's materials");
}

static status get_mesh(pack_reader *from, scene *s, size_t index, diagnostic *why)
{
    mesh_entry *m = &s->meshes[index];
    mesh_record record;
    TRY(pack_get(from, &record, sizeof record, why));
    if (!is_known(record.data, index))
        return pack_damaged(why, "the number of a mesh");
    m->path_line = record.path_line;
    m->path_column = record.path_column;
    m->script_line = record.script_line;
    m->script_column = record.script_column;
    m->account = record.account;
    m->motion_s = record.motion_s;
    if (record.data >= DATA_OF_ENTRY)
        reference_mesh(m, &s->meshes[record.data - DATA_OF_ENTRY]);
    if (record.data != DATA_FOLLOWS)
        return STATUS_OK;
    TRY(mesh_unpack(from, &m->data, why));
    return get_fitting_materials(from, m, why);
}

/* Reads the scene from its text; nothing is loaded. */
static status get_text(pack_reader *from, scene **out, diagnostic *why)
{
    char *path = NULL, *root = NULL, *text = NULL;
    status code = pack_get_text(from, &path, why);
    THEN(code, pack_get_text(from, &root, why));
    THEN(code, pack_get_text(from, &text, why));
    if (code == STATUS_OK && (!path || !text))
        code = pack_damaged(why, "it has no text");
    THEN(code, scene_read_text(path, text, strlen(text), out, why));
    THEN(code, scene_limit(*out, root, 0, why));
    free(path);
    free(root);
    free(text);
    return code;
}

static status get_contents(pack_reader *from, scene *s, diagnostic *why)
{
    scene_record record;
    TRY(pack_get(from, &record, sizeof record, why));
    if (record.image < DATA_NONE || record.image > DATA_FOLLOWS || record.textures != (int64_t)s->texture_count ||
        record.data != (int64_t)s->data_count || record.meshes != (int64_t)s->mesh_count)
        return pack_damaged(why, "the number of its objects");
    s->limits.triangles = record.triangles;
    s->background.image_line = record.image_line;
    s->background.image_column = record.image_column;
    if (record.image == DATA_FOLLOWS)
        TRY(get_sky(from, &s->background, why));
    for (size_t i = 0; i < s->texture_count; i++)
        TRY(get_texture(from, s, i, why));
    for (size_t i = 0; i < s->data_count; i++)
        TRY(get_data(from, &s->data[i], why));
    for (size_t i = 0; i < s->mesh_count; i++)
        TRY(get_mesh(from, s, i, why));
    scene_follow_data(s);
    return STATUS_OK;
}

status package_get_scene(pack_reader *from, scene **out, diagnostic *why)
{
    TRY(get_text(from, out, why));
    return get_contents(from, *out, why);
}
