/* Collects the mesh and the materials of a reader, and imports them with the same checks as the importer's answer. */
#include "base/array.h"
#include "wasm/mesh/mesh.h"

#include <stdlib.h>
#include <string.h>

status mesh_parts_begin(mesh_parts *p, const mesh_limits *limits, diagnostic *why)
{
    size_t none;
    *p = (mesh_parts){.limits = limits};
    TRY(mesh_parts_material(p, "", 0, &none, why));
    p->materials[0].values.flags = 0;
    return STATUS_OK;
}

void mesh_parts_release(mesh_parts *p)
{
    for (size_t i = 0; i < p->material_count; i++)
        free(p->materials[i].name), free(p->materials[i].texture);
    free(p->materials);
    free(p->flat.positions), free(p->flat.normals), free(p->flat.uvs), free(p->flat.triangles), free(p->flat.slots);
    free(p->join.table);
    *p = (mesh_parts){.limits = p->limits};
}

status mesh_parts_material(mesh_parts *p, const char *name, size_t length, size_t *index, diagnostic *why)
{
    if (p->material_count == MESH_SLOTS_MAX)
        return diagnose(why, STATUS_BAD_INPUT, "merge equal materials, and remove unused ones",
                        "the file has more than %d materials", (int)MESH_SLOTS_MAX - 1);
    if (length > MESH_WIRE_TEXT_MAX)
        return diagnose(why, STATUS_BAD_INPUT, "rename it", "the name of a material is too long");
    char *copy = strndup(name, length);
    if (!copy || !GROW(p->materials, p->material_room, p->material_count + 1)) {
        free(copy);
        return out_of_memory(why);
    }
    *index = p->material_count++;
    p->materials[*index] = (mesh_material){.values = {.diffuse = {(double)0.6F, (double)0.6F, (double)0.6F},
                                                      .opacity = 1,
                                                      .ior = 1,
                                                      .flags = MESH_WIRE_GIVEN},
                                           .name = copy};
    return STATUS_OK;
}

status mesh_parts_vertex(mesh_parts *p, const double numbers[8], uint32_t *index, diagnostic *why)
{
    double key[8];
    for (int k = 0; k < 8; k++)
        key[k] = numbers[k] + 0.0; /* -0 becomes 0 */
    switch (join_vertex(&p->join, &p->flat, p->limits->vertices, key, join_hash(&p->flat, key), index)) {
    case JOINED: return STATUS_OK;
    case JOIN_NO_MEMORY: return out_of_memory(why);
    case JOIN_TOO_MANY: break;
    }
    return diagnose(why, STATUS_BAD_INPUT, "use a mesh of less detail", "more vertices than the limit of %zu",
                    p->limits->vertices);
}

status mesh_parts_triangle(mesh_parts *p, const uint32_t corners[3], size_t material, diagnostic *why)
{
    const size_t t = p->flat.triangle_count;
    if (t >= p->limits->triangles)
        return diagnose(why, STATUS_BAD_INPUT, "use a mesh of less detail", "more triangles than the limit of %zu",
                        p->limits->triangles);
    if (!GROW(p->flat.triangles, p->triangle_room, t + 1) || !GROW(p->flat.slots, p->slot_room, t + 1))
        return out_of_memory(why);
    memcpy(p->flat.triangles[t], corners, sizeof p->flat.triangles[t]);
    p->flat.slots[t] = (uint8_t)material;
    p->flat.triangle_count++;
    return STATUS_OK;
}

/* --- the import, in the form of the importer's answer --- */

typedef struct answer {
    char *bytes;
    size_t size, room, read;
    bool failed;
} answer;

static void put(answer *a, const void *bytes, size_t size)
{
    if (size == 0 || a->failed)
        return;
    if (!GROW(a->bytes, a->room, a->size + size)) {
        a->failed = true;
        return;
    }
    memcpy(a->bytes + a->size, bytes, size);
    a->size += size;
}

static status read_answer(void *context, void *bytes, size_t size, diagnostic *why)
{
    answer *a = context;
    if (a->size - a->read < size)
        return diagnose(why, STATUS_FAILURE, "report this as a bug, with the file", "the mesh is incomplete");
    memcpy(bytes, a->bytes + a->read, size);
    a->read += size;
    return STATUS_OK;
}

static status end(void *context, diagnostic *why)
{
    (void)context, (void)why;
    return STATUS_OK;
}

static void put_material(answer *a, const mesh_material *m)
{
    mesh_wire_material record = m->values;
    const char *texture = m->texture ? m->texture : "";
    record.name_length = (uint32_t)strlen(m->name);
    record.texture_length = (uint32_t)strnlen(texture, MESH_WIRE_TEXT_MAX);
    put(a, &record, sizeof record);
    put(a, m->name, record.name_length);
    put(a, texture, record.texture_length);
}

/* Numbers the materials in use, in their order; returns how many there are. */
static uint32_t number_slots(mesh_parts *p, bool used[])
{
    uint8_t slot[MESH_SLOTS_MAX] = {0};
    uint32_t count = 0;
    for (size_t t = 0; t < p->flat.triangle_count; t++)
        used[p->flat.slots[t]] = true;
    for (size_t i = 0; i < p->material_count; i++)
        if (used[i])
            slot[i] = (uint8_t)count++;
    for (size_t t = 0; t < p->flat.triangle_count; t++)
        p->flat.slots[t] = slot[p->flat.slots[t]];
    return count;
}

static void put_all(answer *a, mesh_parts *p)
{
    const flat_mesh *f = &p->flat;
    bool used[MESH_SLOTS_MAX] = {false};
    const mesh_wire_header header = {.magic = MESH_WIRE_MAGIC,
                                     .version = MESH_WIRE_VERSION,
                                     .vertex_count = f->vertex_count,
                                     .triangle_count = f->triangle_count,
                                     .flags = (f->with_normals ? MESH_WIRE_NORMALS : 0u) |
                                              (f->with_uvs ? MESH_WIRE_UVS : 0u),
                                     .material_count = number_slots(p, used)};
    put(a, &header, sizeof header);
    put(a, f->positions, f->vertex_count * sizeof *f->positions);
    put(a, f->normals, f->with_normals ? f->vertex_count * sizeof *f->normals : 0);
    put(a, f->uvs, f->with_uvs ? f->vertex_count * sizeof *f->uvs : 0);
    put(a, f->triangles, f->triangle_count * sizeof *f->triangles);
    put(a, f->slots, f->triangle_count);
    for (size_t i = 0; i < p->material_count; i++)
        if (used[i])
            put_material(a, &p->materials[i]);
    put(a, MESH_WIRE_END, sizeof MESH_WIRE_END - 1);
}

status mesh_parts_import(mesh_parts *p, mesh_import **out, diagnostic *why)
{
    answer a = {.bytes = NULL};
    if (p->flat.triangle_count == 0)
        return diagnose(why, STATUS_BAD_INPUT, "points and lines are ignored; use a file with faces",
                        "the file has no triangles");
    put_all(&a, p);
    const mesh_source source = {.read = read_answer, .end = end, .context = &a};
    const status code = a.failed ? out_of_memory(why) : mesh_stream_read(&source, p->limits, out, why);
    free(a.bytes);
    return code;
}
