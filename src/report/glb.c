/* glTF files: meshes, materials and their images in one buffer. */
#include "base/array.h"
#include "base/cancel.h"
#include "base/text.h"
#include "import/mesh_wire.h"
#include "report/json.h"
#include "report/mesh_writers.h"
#include "scene/file/write.h"

#include <math.h>
#include <stdlib.h>

enum { GLB_HEADER = 12, GLB_CHUNK = 8, GL_FLOAT = 5126, GL_UINT = 5125, GL_VERTICES = 34962, GL_INDICES = 34963 };

/* A mesh in the buffer: positions, normals, texture coordinates, colours, and the triangles by slot. */
typedef struct glb_mesh {
    const mesh *m;
    bool mirrored, smooth, colored;
} glb_mesh;

/* The buffer: the meshes, then the image files of the looks, each filled up to a multiple of 4 bytes. */
struct glb {
    const mesh_import *looks; /* NULL: none */
    char *path;               /* of the GLB file */
    glb_mesh *list;
    size_t count;
    uint64_t bytes; /* so far */
    json_t *meshes, *views, *accessors;
    json_t *materials, *images, *textures, *samplers;
    json_t *extensions; /* its keys are the names */
    bool bad;
};

/* Adds an array and its accessor. Returns the accessor's number. */
static json_int_t add_array(glb *l, int target, int component, const char *type, size_t count, size_t size)
{
    l->bad |=
        json_array_append_new(l->views, json_pack("{s:i,s:I,s:I,s:i}", "buffer", 0, "byteOffset", (json_int_t)l->bytes,
                                                  "byteLength", (json_int_t)(count * size), "target", target)) != 0;
    l->bad |= json_array_append_new(l->accessors, json_pack("{s:I,s:i,s:I,s:s}", "bufferView",
                                                            (json_int_t)json_array_size(l->views) - 1, "componentType",
                                                            component, "count", (json_int_t)count, "type", type)) != 0;
    l->bytes += (uint64_t)count * size;
    return (json_int_t)json_array_size(l->accessors) - 1;
}

static json_t *float_vector_json(vec3 v)
{
    return json_pack("[f,f,f]", (double)(float)v.x, (double)(float)v.y, (double)(float)v.z);
}

/* Adds a value to a list or, with a key, to an object; takes it. */
static void add_to(glb *l, json_t *to, const char *key, json_t *value)
{
    l->bad |= (key ? json_object_set_new(to, key, value) : json_array_append_new(to, value)) != 0;
}

static void add_attribute(glb *l, json_t *to, const char *name, const char *type, size_t count, size_t size)
{
    add_to(l, to, name, json_integer(add_array(l, GL_VERTICES, GL_FLOAT, type, count, size)));
}

/* The accessors of the vertices. The format wants the bounds of all positions, used or not. */
static json_t *vertices_json(const glb_mesh *one, glb *l)
{
    const mesh *m = one->m;
    json_t *attributes = json_object();
    vec3 low = mirrored_if(one->mirrored, m->vertices[0]), high = low;
    for (size_t v = 1; v < m->vertex_count; v++) {
        const vec3 p = mirrored_if(one->mirrored, m->vertices[v]);
        low = vec3_make(fmin(low.x, p.x), fmin(low.y, p.y), fmin(low.z, p.z));
        high = vec3_make(fmax(high.x, p.x), fmax(high.y, p.y), fmax(high.z, p.z));
    }
    add_attribute(l, attributes, "POSITION", "VEC3", m->vertex_count, 12);
    json_t *positions = json_array_get(l->accessors, json_array_size(l->accessors) - 1);
    add_to(l, positions, "min", float_vector_json(low));
    add_to(l, positions, "max", float_vector_json(high));
    if (m->normals && one->smooth)
        add_attribute(l, attributes, "NORMAL", "VEC3", m->vertex_count, 12);
    if (m->uvs)
        add_attribute(l, attributes, "TEXCOORD_0", "VEC2", m->vertex_count, 8);
    if (m->colors && one->colored)
        add_attribute(l, attributes, "COLOR_0", "VEC3", m->vertex_count, 12);
    return attributes;
}

/* A path as a URI reference: RFC 3986, 2.3 and 3.3. */
static json_t *uri_json(const char *path)
{
    text_writer to;
    char *text = NULL;
    size_t size;
    if (text_writer_open(&to, NULL) != STATUS_OK)
        return NULL;
    for (const char *c = path; *c; c++) {
        const bool plain = (*c >= 'a' && *c <= 'z') || (*c >= 'A' && *c <= 'Z') || (*c >= '0' && *c <= '9') ||
                           strchr("/-._~!$&'()*+,;=@", *c);
        fprintf(to.stream, plain ? "%c" : "%%%02X", (unsigned char)*c);
    }
    json_t *result = text_writer_end(&to, STATUS_OK, &text, &size, NULL) == STATUS_OK ? json_string(text) : NULL;
    free(text);
    return result;
}

static size_t filled_up(size_t size)
{
    return (size + 3) / 4 * 4;
}

/* The images inside the mesh file come before those that are named by path: they keep their numbers. */
static void add_images(glb *l)
{
    for (int i = 0; l->looks && i < l->looks->image_count; i++) {
        const imported_image *one = &l->looks->images[i];
        const char *type = one->bytes[0] == 0xff ? "image/jpeg" : one->bytes[0] == 'B' ? "image/bmp" : "image/png";
        add_to(l, l->views, NULL,
               json_pack("{s:i,s:I,s:I}", "buffer", 0, "byteOffset", (json_int_t)l->bytes, "byteLength",
                         (json_int_t)one->size));
        json_t *entry =
            json_pack("{s:I,s:s}", "bufferView", (json_int_t)json_array_size(l->views) - 1, "mimeType", type);
        l->bad |= json_array_insert_new(l->images, (size_t)i, entry) != 0;
        l->bytes += filled_up(one->size);
    }
}

/* How an image is laid on, in numbers of OpenGL (3.8.4); nothing for the way of a texture without a sampler. */
static void add_sampler(const imported_texture *m, json_t *texture, glb *l)
{
    static const int wraps[] = {[MESH_WIRE_REPEAT] = 10497, [MESH_WIRE_MIRROR] = 33648, [MESH_WIRE_CLAMP] = 33071},
                     near[] = {[MESH_WIRE_TRILINEAR] = 9729, [MESH_WIRE_BILINEAR] = 9729, [MESH_WIRE_NEAREST] = 9728},
                     far[] = {[MESH_WIRE_TRILINEAR] = 9987, [MESH_WIRE_BILINEAR] = 9729, [MESH_WIRE_NEAREST] = 9728};
    if (m->wrap_u == MESH_WIRE_REPEAT && m->wrap_v == MESH_WIRE_REPEAT && m->filter == MESH_WIRE_TRILINEAR)
        return;
    add_to(l, l->samplers, NULL,
           json_pack("{s:i,s:i,s:i,s:i}", "wrapS", wraps[m->wrap_u], "wrapT", wraps[m->wrap_v], "magFilter",
                     near[m->filter], "minFilter", far[m->filter]));
    add_to(l, texture, "sampler", json_integer((json_int_t)json_array_size(l->samplers) - 1));
}

static void add_texture(const imported_texture *m, const char *key, json_t *surface, glb *l)
{
    json_int_t source = m->image - 1;
    char *moved = NULL;
    if (!imported_texture_exists(m))
        return;
    if (m->path) {
        l->bad |= write_moved_path(m->path, "", l->path, &moved, NULL) != STATUS_OK;
        add_to(l, l->images, NULL, json_pack("{s:o}", "uri", moved ? uri_json(moved) : NULL));
        source = (l->looks ? l->looks->image_count : 0) + (json_int_t)json_array_size(l->images) - 1;
        free(moved);
    }
    json_t *texture = json_pack("{s:I}", "source", source);
    add_sampler(m, texture, l);
    add_to(l, l->textures, NULL, texture);
    add_to(l, surface, key, json_pack("{s:I}", "index", (json_int_t)json_array_size(l->textures) - 1));
}

static void add_extension(json_t *to, const char *name, json_t *value, glb *l)
{
    add_to(l, to, name, value);
    add_to(l, l->extensions, name, json_null());
}

/* Glass and strong emission, which the format itself does not have. Without a volume, glass would be a thin wall. */
static json_t *extensions_json(const imported_material *m, double brightest, bool is_solid, glb *l)
{
    json_t *all = json_object();
    if (brightest > 1.0)
        add_extension(all, "KHR_materials_emissive_strength", json_pack("{s:f}", "emissiveStrength", brightest), l);
    if (m->transmission == 0.0)
        return all;
    add_extension(all, "KHR_materials_transmission", json_pack("{s:f}", "transmissionFactor", m->transmission), l);
    add_extension(all, "KHR_materials_ior", json_pack("{s:f}", "ior", m->ior), l);
    if (m->attenuation_distance > 0.0)
        add_extension(all, "KHR_materials_volume",
                      json_pack("{s:f,s:f,s:[f,f,f]}", "thicknessFactor", 1.0, "attenuationDistance",
                                m->attenuation_distance, "attenuationColor", m->attenuation_color[0],
                                m->attenuation_color[1], m->attenuation_color[2]),
                      l);
    else if (is_solid)
        add_extension(all, "KHR_materials_volume", json_pack("{s:f}", "thicknessFactor", 1.0), l);
    if (m->dispersion > 0.0)
        add_extension(all, "KHR_materials_dispersion", json_pack("{s:f}", "dispersion", m->dispersion), l);
    return all;
}

/* Alpha is the opacity without what glass lets through. */
static double add_alpha(const imported_material *m, json_t *to, glb *l)
{
    const double alpha = m->transmission < 1.0 ? fmin(m->opacity / (1.0 - m->transmission), 1.0) : 1.0;
    if (m->alpha_mode == MESH_WIRE_ALPHA_MASK) {
        add_to(l, to, "alphaMode", json_string("MASK"));
        add_to(l, to, "alphaCutoff", json_real(m->alpha_cutoff));
    } else if (m->alpha_mode == MESH_WIRE_ALPHA_BLEND || alpha < 1.0) {
        add_to(l, to, "alphaMode", json_string("BLEND"));
    }
    return alpha;
}

/* The reflection of the surface: matt, unless there is a finish. */
static void add_finish(const glb_finish *f, json_t *surface, json_t *extensions, glb *l)
{
    add_to(l, surface, "metallicFactor", json_real(f ? f->metallic : 0.0));
    add_to(l, surface, "roughnessFactor", json_real(f ? f->roughness : 1.0));
    if (f && f->specular < 1.0)
        add_extension(extensions, "KHR_materials_specular", json_pack("{s:f}", "specularFactor", f->specular), l);
}

/* Colours are in [0, 1] in this format. */
json_int_t glb_add_material(glb *l, const imported_material *m, const char *name, const glb_finish *finish)
{
    const double *e = m->emissive, brightest = fmax(e[0], fmax(e[1], e[2])), by = fmax(brightest, 1.0);
    const bool is_solid = finish && m->transmission > 0.0; /* seen from outside only, as the extension wants it */
    json_t *one = json_pack("{s:b}", "doubleSided", !is_solid),
           *extensions = extensions_json(m, brightest, finish != NULL, l);
    const double alpha = add_alpha(m, one, l);
    json_t *surface = json_pack("{s:[f,f,f,f]}", "baseColorFactor", fmin(m->color[0], 1.0), fmin(m->color[1], 1.0),
                                fmin(m->color[2], 1.0), alpha);
    add_finish(finish, surface, extensions, l);
    add_texture(&m->texture, "baseColorTexture", surface, l);
    add_to(l, one, "pbrMetallicRoughness", surface);
    if (name && name[0])
        add_to(l, one, "name", json_of_text(name));
    if (brightest > 0.0) {
        add_to(l, one, "emissiveFactor", json_pack("[f,f,f]", e[0] / by, e[1] / by, e[2] / by));
        add_texture(&m->glow, "emissiveTexture", one, l);
    }
    if (json_object_size(extensions) > 0)
        l->bad |= json_object_set(one, "extensions", extensions) != 0;
    json_decref(extensions);
    add_to(l, l->materials, NULL, one);
    return (json_int_t)json_array_size(l->materials) - 1;
}

void glb_use(glb *l, const char *extension)
{
    add_to(l, l->extensions, extension, json_null());
}

static int slot_of(const mesh *m, size_t triangle)
{
    return m->slots ? m->slots[triangle] : 0;
}

static void count_slots(const mesh *m, size_t by_slot[MESH_SLOTS_MAX])
{
    memset(by_slot, 0, MESH_SLOTS_MAX * sizeof *by_slot);
    for (size_t t = 0; t < m->triangle_count; t++)
        by_slot[slot_of(m, t)]++;
}

json_int_t glb_add_mesh(glb *l, const mesh *m, bool mirrored, bool smooth, bool colored, const json_int_t *materials)
{
    size_t by_slot[MESH_SLOTS_MAX];
    json_t *primitives = json_array();
    if (!room_for_one(&l->list, l->count, sizeof *l->list)) {
        l->bad = true;
        json_decref(primitives);
        return 0;
    }
    l->list[l->count] = (glb_mesh){m, mirrored, smooth, colored};
    json_t *attributes = vertices_json(&l->list[l->count++], l);
    count_slots(m, by_slot);
    for (int slot = 0; slot < m->slot_count; slot++) {
        if (by_slot[slot] == 0)
            continue;
        const json_int_t indices = add_array(l, GL_INDICES, GL_UINT, "SCALAR", 3 * by_slot[slot], 4);
        json_t *one = json_pack("{s:O,s:I}", "attributes", attributes, "indices", indices);
        if (materials && materials[slot] >= 0)
            add_to(l, one, "material", json_integer(materials[slot]));
        add_to(l, primitives, NULL, one);
    }
    json_decref(attributes);
    add_to(l, l->meshes, NULL, json_pack("{s:o}", "primitives", primitives));
    return (json_int_t)json_array_size(l->meshes) - 1;
}

/* Adds a list, which it takes, unless it is empty: the format has no empty lists. */
static void add_list(json_t *to, const char *key, json_t *list, glb *l)
{
    if (json_array_size(list) > 0)
        l->bad |= json_object_set(to, key, list) != 0;
    json_decref(list);
}

static void add_members(json_t *all, json_t *more, glb *l)
{
    const char *key;
    json_t *value;
    json_object_foreach(more, key, value) l->bad |= json_object_set(all, key, value) != 0;
    json_decref(more);
}

/* The document; NULL when out of memory. Takes what it gets. */
static json_t *document_json(glb *l, json_t *nodes, json_t *more, json_t *extras, const char *uri)
{
    json_t *used = json_array(), *roots = json_array();
    for (size_t i = 0; i < json_array_size(nodes); i++)
        add_to(l, roots, NULL, json_integer((json_int_t)i));
    json_t *asset = json_pack("{s:s,s:s}", "version", "2.0", "generator", "Cuvette");
    if (extras)
        add_to(l, asset, "extras", extras);
    add_images(l);
    json_t *buffer = json_pack("{s:I}", "byteLength", (json_int_t)l->bytes);
    if (uri)
        add_to(l, buffer, "uri", json_string(uri));
    json_t *all =
        json_pack("{s:o,s:i,s:[{s:o}],s:o}", "asset", asset, "scene", 0, "scenes", "nodes", roots, "nodes", nodes);
    const char *name;
    json_t *unused;
    json_object_foreach(l->extensions, name, unused) add_to(l, used, NULL, json_string(name));
    add_list(all, "meshes", json_incref(l->meshes), l);
    add_list(all, "accessors", json_incref(l->accessors), l);
    add_list(all, "bufferViews", json_incref(l->views), l);
    if (l->bytes > 0)
        add_to(l, all, "buffers", json_pack("[O]", buffer));
    json_decref(buffer);
    add_list(all, "materials", json_incref(l->materials), l);
    add_list(all, "images", json_incref(l->images), l);
    add_list(all, "textures", json_incref(l->textures), l);
    add_list(all, "samplers", json_incref(l->samplers), l);
    add_list(all, "extensionsUsed", used, l);
    add_members(all, more, l);
    if (all && !l->bad)
        return all;
    json_decref(all);
    return NULL;
}

static void put_mesh(const glb_mesh *one, FILE *stream)
{
    const mesh *m = one->m;
    size_t by_slot[MESH_SLOTS_MAX];
    count_slots(m, by_slot);
    for (size_t v = 0; v < m->vertex_count && !cancel_asked(); v++)
        put_real_vector(mirrored_if(one->mirrored, m->vertices[v]), true, stream);
    for (size_t v = 0; m->normals && one->smooth && v < m->vertex_count && !cancel_asked(); v++)
        put_real_vector(mirrored_if(one->mirrored, m->normals[v]), true, stream);
    for (size_t v = 0; m->uvs && v < m->vertex_count && !cancel_asked(); v++) {
        put_real(m->uvs[v].u, true, stream);
        put_real(1.0 - m->uvs[v].v, true, stream); /* v runs downwards */
    }
    for (size_t v = 0; m->colors && one->colored && v < m->vertex_count && !cancel_asked(); v++)
        for (int c = 0; c < 3; c++)
            put_real((double)m->colors[v][c], true, stream);
    for (int slot = 0; slot < m->slot_count; slot++)
        for (size_t t = 0; by_slot[slot] && t < m->triangle_count && !cancel_asked_at(t); t++)
            for (int k = 0; slot_of(m, t) == slot && k < 3; k++)
                put_bits(corner_if(one->mirrored, &m->triangles[t], k), 4, stream);
}

static void put_buffer(const glb *l, FILE *stream)
{
    for (size_t i = 0; i < l->count; i++)
        put_mesh(&l->list[i], stream);
    for (int i = 0; l->looks && i < l->looks->image_count && !cancel_asked(); i++) {
        const imported_image *one = &l->looks->images[i];
        fwrite(one->bytes, 1, one->size, stream);
        put_bits(0, (int)(filled_up(one->size) - one->size), stream);
    }
}

static status put_chunks(const glb *l, const char *text, FILE *stream, diagnostic *why)
{
    const uint64_t padded = filled_up(strlen(text)), all = GLB_HEADER + 2 * GLB_CHUNK + padded + l->bytes;
    if (all > UINT32_MAX)
        return diagnose(why, STATUS_BAD_INPUT, "write a PLY file", "the mesh is too large for a GLB file");
    fputs("glTF", stream);
    put_bits(2, 4, stream);
    put_bits(all, 4, stream);
    put_bits(padded, 4, stream);
    fputs("JSON", stream);
    fprintf(stream, "%-*s", (int)padded, text);
    put_bits(l->bytes, 4, stream);
    fwrite("BIN", 1, 4, stream);
    put_buffer(l, stream);
    return STATUS_OK;
}

/* The buffer as a URI: data:application/octet-stream;base64,... */
static status buffer_uri(const glb *l, char **uri, diagnostic *why)
{
    text_writer to;
    char *bytes = NULL;
    size_t size = 0;
    TRY(text_writer_open(&to, why));
    put_buffer(l, to.stream);
    TRY(text_writer_end(&to, STATUS_OK, &bytes, &size, why));
    char *text = base64_encode(bytes, size, false);
    *uri = text ? text_format("data:application/octet-stream;base64,%s", text) : NULL;
    free(text);
    free(bytes);
    return *uri ? STATUS_OK : out_of_memory(why);
}

status glb_write(glb *l, json_t *nodes, json_t *more, json_t *extras, bool binary, FILE *stream, diagnostic *why)
{
    char *uri = NULL, *text = NULL;
    status code = binary ? STATUS_OK : buffer_uri(l, &uri, why);
    json_t *document = document_json(l, nodes, more, extras, uri);
    if (code == STATUS_OK && document)
        text = json_dumps(document, binary ? JSON_COMPACT : JSON_INDENT(1));
    json_decref(document);
    free(uri);
    if (code == STATUS_OK && !text)
        code = out_of_memory(why);
    if (code == STATUS_OK && binary)
        code = put_chunks(l, text, stream, why);
    else if (code == STATUS_OK)
        fprintf(stream, "%s\n", text);
    free(text);
    return code;
}

glb *glb_create(const char *path, const mesh_import *images)
{
    glb *l = calloc(1, sizeof *l);
    if (!l)
        return NULL;
    l->looks = images;
    l->path = strdup(path ? path : "");
    l->meshes = json_array(), l->views = json_array(), l->accessors = json_array();
    l->materials = json_array(), l->images = json_array(), l->textures = json_array(), l->samplers = json_array();
    l->extensions = json_object();
    l->bad = !l->path;
    return l;
}

void glb_destroy(glb *l)
{
    if (!l)
        return;
    json_t *const values[] = {l->meshes, l->views,    l->accessors, l->materials,
                              l->images, l->textures, l->samplers,  l->extensions};
    for (size_t i = 0; i < sizeof values / sizeof *values; i++)
        json_decref(values[i]);
    free(l->list);
    free(l->path);
    free(l);
}

status glb_write_mesh(const mesh *m, const mesh_import *looks, bool mirrored, const char *path, FILE *stream,
                      diagnostic *why)
{
    if (m->triangle_count == 0)
        return diagnose(why, STATUS_BAD_INPUT, "write another format", "a GLB file needs triangles");
    glb *l = glb_create(path, looks);
    if (!l)
        return out_of_memory(why);
    size_t by_slot[MESH_SLOTS_MAX];
    json_int_t materials[MESH_SLOTS_MAX];
    count_slots(m, by_slot);
    for (int slot = 0; slot < m->slot_count; slot++) {
        const bool given = by_slot[slot] > 0 && looks && looks->materials[slot].given;
        materials[slot] = given ? glb_add_material(l, &looks->materials[slot], m->slot_names[slot], NULL) : -1;
    }
    glb_add_mesh(l, m, mirrored, true, true, materials);
    const status code = glb_write(l, json_pack("[{s:i}]", "mesh", 0), NULL, NULL, true, stream, why);
    glb_destroy(l);
    return code;
}
