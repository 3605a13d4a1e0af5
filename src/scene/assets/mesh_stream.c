/* Reads the wire format of cuvette-import (import/mesh_wire.h), and finds the images that materials name. */
#include "scene/assets/mesh_stream.h"
#include "base/cancel.h"
#include "base/file.h"
#include "import/mesh_wire.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

_Static_assert(sizeof(mesh_wire_header) == 40 && sizeof(mesh_wire_material) == 15 * 8 + 16, "no padding");
_Static_assert(sizeof(vec3) == 24 && sizeof(mesh_uv) == 16 && sizeof(mesh_triangle) == 12, "arrays without padding");

#define COLOR_MAX 1e6 /* maximum of a colour component, an exponent or an index; larger values are errors in the file */

mesh_limits mesh_limits_complete(const mesh_limits *limits)
{
    mesh_limits all = limits ? *limits : (mesh_limits){0};
    all.triangles = !all.triangles                       ? (size_t)1 << 25
                    : all.triangles > MESH_TRIANGLES_MAX ? MESH_TRIANGLES_MAX
                                                         : all.triangles;
    all.vertices = !all.vertices                      ? (size_t)1 << 26
                   : all.vertices > MESH_VERTICES_MAX ? MESH_VERTICES_MAX
                                                      : all.vertices;
    all.memory_bytes = all.memory_bytes ? all.memory_bytes : (uint64_t)4 << 30;
    all.wall_s = all.wall_s > 0 ? all.wall_s : 60;
    return all;
}

void mesh_import_destroy(mesh_import *imported)
{
    if (!imported)
        return;
    for (int i = 0; imported->materials && i < imported->material_count; i++) {
        free(imported->materials[i].name);
        free(imported->materials[i].texture);
    }
    free(imported->materials);
    mesh_release(imported->mesh);
    free(imported);
}

static status damaged(diagnostic *why, const char *what)
{
    return diagnose(why, STATUS_BAD_INPUT, "check that cuvette-import has the same version",
                    "the importer's answer is damaged: %s", what);
}

static status no_memory(diagnostic *why)
{
    return diagnose(why, STATUS_FAILURE, MEMORY_REMEDY, "out of memory for the mesh");
}

static status read_header(const mesh_source *source, const mesh_limits *limits, mesh_wire_header *header,
                          diagnostic *why)
{
    TRY(source->read(source->context, header, sizeof *header, why));
    if (memcmp(header->magic, MESH_WIRE_MAGIC, sizeof header->magic) != 0 || header->version != MESH_WIRE_VERSION)
        return damaged(why, "it does not begin with the header of this version");
    if (header->flags & ~(uint32_t)(MESH_WIRE_NORMALS | MESH_WIRE_UVS) || header->reserved)
        return damaged(why, "unknown flags");
    if (header->material_count < 1 || header->material_count > MESH_SLOTS_MAX)
        return damaged(why, "the number of materials is out of range");
    if (!header->triangle_count || !header->vertex_count)
        return damaged(why, "no triangles");
    if (header->triangle_count > limits->triangles)
        return diagnose(why, STATUS_BAD_INPUT, "use a mesh of less detail",
                        "the mesh has %llu triangles, more than the limit of %zu",
                        (unsigned long long)header->triangle_count, limits->triangles);
    if (header->vertex_count > limits->vertices)
        return diagnose(why, STATUS_BAD_INPUT, "use a mesh of less detail",
                        "the mesh has %llu vertices, more than the limit of %zu",
                        (unsigned long long)header->vertex_count, limits->vertices);
    return STATUS_OK;
}

/* Reads the arrays, and checks texture coordinates and slots; mesh_finish checks the others. */
static status read_arrays(const mesh_source *source, mesh *m, diagnostic *why)
{
    struct {
        void *bytes;
        size_t size;
    } arrays[] = {
        {m->vertices, m->vertex_count * sizeof *m->vertices},
        {m->normals, m->normals ? m->vertex_count * sizeof *m->normals : 0},
        {m->uvs, m->uvs ? m->vertex_count * sizeof *m->uvs : 0},
        {m->triangles, m->triangle_count * sizeof *m->triangles},
        {m->slots, m->triangle_count},
    };
    for (size_t i = 0; i < sizeof arrays / sizeof *arrays; i++)
        if (arrays[i].size)
            TRY(source->read(source->context, arrays[i].bytes, arrays[i].size, why));
    for (size_t i = 0; m->uvs && i < m->vertex_count; i++) {
        if (cancel_asked_at(i))
            return cancel_check(why);
        if (!isfinite(m->uvs[i].u) || !isfinite(m->uvs[i].v))
            return diagnose(why, STATUS_BAD_INPUT, "use finite texture coordinates",
                            "a texture coordinate of vertex %zu is not a number", i);
    }
    for (size_t t = 0; t < m->triangle_count; t++)
        if (m->slots[t] >= m->slot_count)
            return damaged(why, "a triangle's material is out of range");
    return STATUS_OK;
}

/* Reads a text of this length; *text is newly allocated, or NULL for length 0. NUL and other control characters are
 * refused. */
static status read_text(const mesh_source *source, uint32_t length, char **text, diagnostic *why)
{
    *text = NULL;
    if (length == 0)
        return STATUS_OK;
    if (length > MESH_WIRE_TEXT_MAX)
        return damaged(why, "a text is too long");
    char *fresh = malloc(length + 1);
    if (!fresh)
        return no_memory(why);
    status code = source->read(source->context, fresh, length, why);
    fresh[length] = 0;
    for (uint32_t i = 0; i < length && code == STATUS_OK; i++) {
        if ((unsigned char)fresh[i] < 0x20 || fresh[i] == 0x7f)
            code = diagnose(why, STATUS_BAD_INPUT, "rename it",
                            "the name of a material or of its image contains a control character");
    }
    if (code != STATUS_OK) {
        free(fresh);
        return code;
    }
    *text = fresh;
    return STATUS_OK;
}

static bool within(const double *values, int count, double low, double high)
{
    for (int i = 0; i < count; i++)
        if (!(values[i] >= low && values[i] <= high)) /* NaN is refused as well */
            return false;
    return true;
}

static status check_numbers(const imported_material *m, diagnostic *why)
{
    const char *wrong = !within(m->color, 3, 0, COLOR_MAX)        ? "diffuse colour"
                        : !within(m->ambient, 3, 0, COLOR_MAX)    ? "ambient colour"
                        : !within(m->specular, 3, 0, COLOR_MAX)   ? "specular colour"
                        : !within(m->emissive, 3, 0, COLOR_MAX)   ? "emitted colour"
                        : !within(&m->shininess, 1, 0, COLOR_MAX) ? "shininess"
                        : !within(&m->opacity, 1, 0, 1)           ? "opacity"
                        : !within(&m->ior, 1, 0, COLOR_MAX)       ? "index of refraction"
                                                                  : NULL;
    return !wrong ? STATUS_OK
                  : diagnose(why, STATUS_BAD_INPUT, "correct the material", "material '%s': its %s is out of range",
                             m->name ? m->name : "", wrong);
}

static status read_material(const mesh_source *source, imported_material *m, diagnostic *why)
{
    mesh_wire_material record;
    TRY(source->read(source->context, &record, sizeof record, why));
    if (record.flags & ~(uint32_t)(MESH_WIRE_GIVEN | MESH_WIRE_TEXTURE_INSIDE) || record.reserved)
        return damaged(why, "unknown flags of a material");
    m->given = record.flags & MESH_WIRE_GIVEN;
    m->texture_inside = record.flags & MESH_WIRE_TEXTURE_INSIDE;
    memcpy(m->color, record.diffuse, sizeof m->color);
    memcpy(m->ambient, record.ambient, sizeof m->ambient);
    memcpy(m->specular, record.specular, sizeof m->specular);
    memcpy(m->emissive, record.emissive, sizeof m->emissive);
    m->shininess = record.shininess;
    m->opacity = record.opacity;
    m->ior = record.ior;
    TRY(read_text(source, record.name_length, &m->name, why));
    TRY(read_text(source, record.texture_length, &m->texture, why));
    return check_numbers(m, why);
}

static status read_materials(const mesh_source *source, mesh_import *into, diagnostic *why)
{
    for (int i = 0; i < into->material_count; i++) {
        imported_material *m = &into->materials[i];
        TRY(read_material(source, m, why));
        if (m->name && !(into->mesh->slot_names[i] = strdup(m->name)))
            return no_memory(why);
    }
    char end[sizeof MESH_WIRE_END - 1];
    TRY(source->read(source->context, end, sizeof end, why));
    return memcmp(end, MESH_WIRE_END, sizeof end) == 0 ? source->end(source->context, why)
                                                       : damaged(why, "it has the wrong length");
}

static status read_all(const mesh_source *source, const mesh_limits *limits, mesh_import *into, diagnostic *why)
{
    mesh_wire_header header;
    TRY(read_header(source, limits, &header, why));
    TRY(mesh_create((size_t)header.vertex_count, (size_t)header.triangle_count, header.flags & MESH_WIRE_NORMALS,
                    header.flags & MESH_WIRE_UVS, true, &into->mesh, why));
    into->mesh->slot_count = into->material_count = (int)header.material_count;
    into->materials = calloc(header.material_count, sizeof *into->materials);
    if (!into->materials)
        return no_memory(why);
    TRY(read_arrays(source, into->mesh, why));
    TRY(read_materials(source, into, why));
    into->mesh->distinct = !into->mesh->normals && !into->mesh->uvs; /* equal vertices are joined: mesh_wire.h */
    return mesh_finish(into->mesh, why);
}

status mesh_stream_read(const mesh_source *source, const mesh_limits *limits, mesh_import **out, diagnostic *why)
{
    mesh_limits all = mesh_limits_complete(limits);
    *out = NULL;
    mesh_import *fresh = calloc(1, sizeof *fresh);
    if (!fresh)
        return no_memory(why);
    status code = read_all(source, &all, fresh, why);
    if (code != STATUS_OK) {
        mesh_import_destroy(fresh);
        return code;
    }
    *out = fresh;
    return STATUS_OK;
}

/* --- images --- */

/* Alternative spellings of a file name: \ for / (MTL files from Windows), and %20 for a blank (URIs in glTF). */
static void respell(char *name)
{
    char *to = name;
    for (const char *from = name; *from; from++) {
        char digits[3] = {from[0] == '%' ? from[1] : (char)0, 0, 0};
        digits[1] = digits[0] ? from[2] : (char)0;
        char *end = digits;
        long byte = strtol(digits, &end, 16);
        if (end == digits + 2 && byte >= 0x20) {
            *to++ = (char)byte;
            from += 2;
        } else {
            *to++ = *from == '\\' ? '/' : *from;
        }
    }
    *to = 0;
}

static bool is_file(const char *path)
{
    struct stat about;
    return path && stat(path, &about) == 0 && S_ISREG(about.st_mode);
}

/* Finds the image of a material; the original spelling is tried first. */
static status resolve(const char *path, imported_material *m, diagnostic *why)
{
    char *found = file_next_to(path, m->texture);
    if (!is_file(found)) {
        char *respelt = strdup(m->texture);
        if (respelt) {
            respell(respelt);
            free(found);
            found = file_next_to(path, respelt);
        }
        free(respelt);
    }
    if (!found)
        return out_of_memory(why);
    if (!is_file(found)) {
        diagnose(why, STATUS_BAD_INPUT,
                 "put the image where the mesh file expects it, or remove the line that names it",
                 "the image '%.200s' of material '%.100s' does not exist", m->texture, m->name ? m->name : "");
        free(found);
        return STATUS_BAD_INPUT;
    }
    free(m->texture);
    m->texture = found;
    return STATUS_OK;
}

status mesh_textures_find(const char *path, mesh_import *imported, diagnostic *why)
{
    status code = STATUS_OK;
    for (int i = 0; i < imported->material_count && code == STATUS_OK; i++)
        code = imported->materials[i].texture ? resolve(path, &imported->materials[i], why) : STATUS_OK;
    return code;
}
