/* The materials in a mesh file, and their images, each once. */
#include "image/texture.h"
#include "scene/package/package_parts.h"

#include <stdlib.h>
#include <string.h>

/* Numbers that the parameter table and the importer allow at most. */
#define NUMBER_MAX 1e6

typedef struct face_record {
    char name[SCENE_NAME_MAX + 1];
    int64_t given;
    double number[8]; /* colour, diffuse, specular, shininess, emission, opacity */
    int64_t image;    /* 0: none; 1: it follows; else that of slot image - 2 */
} face_record;
_Static_assert(sizeof(face_record) == SCENE_NAME_MAX + 1 + 10 * 8 && SCENE_NAME_MAX % 8 == 7, "no padding");

static int64_t image_of(const face_materials *l, int slot)
{
    const texture *img = face_materials_at(l, slot)->img;
    for (int i = 0; img && i < slot; i++)
        if (face_materials_at(l, i)->img == img)
            return i + 2;
    return img != NULL;
}

static status put_material(pack_writer *to, const face_materials *l, int slot, diagnostic *why)
{
    const face_material *m = face_materials_at(l, slot);
    face_record record = {
        .given = m->given,
        .number = {m->color.x, m->color.y, m->color.z, m->diffuse, m->specular, m->shininess, m->emission, m->opacity},
        .image = image_of(l, slot)};
    memcpy(record.name, m->name, sizeof record.name);
    TRY(pack_put(to, &record, sizeof record, why));
    return record.image == 1 ? texture_pack(m->img, to, why) : STATUS_OK;
}

status package_put_face_materials(pack_writer *to, const face_materials *l, diagnostic *why)
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
    bool sound =
        memchr(r->name, 0, sizeof r->name) && r->given >= 0 && r->given <= 1 && r->image >= 0 && r->image <= slot + 1;
    for (size_t i = 0; i < sizeof r->number / sizeof *r->number; i++)
        sound = sound && r->number[i] >= 0.0 && r->number[i] <= NUMBER_MAX;
    return sound;
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
                         .opacity = n[7]};
    memcpy(m->name, record.name, sizeof m->name);
    if (record.image == 1)
        return texture_unpack(from, &m->img, why);
    if (record.image > 1 && (m->img = list[record.image - 2].img))
        texture_retain(m->img);
    return STATUS_OK;
}

static status get_list(pack_reader *from, face_material *list, int count, const face_materials **out, diagnostic *why)
{
    for (int i = 0; i < count; i++) {
        const status code = get_material(from, list, i, why);
        if (code != STATUS_OK) {
            for (int k = 0; k <= i; k++)
                texture_release(list[k].img);
            return code;
        }
    }
    return face_materials_of(list, count, out, why);
}

status package_get_face_materials(pack_reader *from, const face_materials **out, diagnostic *why)
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
