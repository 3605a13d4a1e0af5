/* Describes a mesh (counts, bounds, area, volume or first hole, memory), and writes it as Wavefront OBJ, binary PLY
 * or GLB. */
#include "report/mesh_writers.h"
#include "base/cancel.h"
#include "base/number.h"
#include "base/text.h"
#include "image/image.h"
#include "import/mesh_wire.h"
#include "report/json.h"
#include "scene/file/write.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* --- description --- */

/* Size of the mesh's arrays. */
static size_t memory_bytes(const mesh *m)
{
    const size_t by_vertex = sizeof *m->vertices + (m->normals ? sizeof *m->normals : 0) +
                             (m->uvs ? sizeof *m->uvs : 0) + (m->colors ? sizeof *m->colors : 0);
    return m->vertex_count * by_vertex + m->triangle_count * (sizeof *m->triangles + (m->slots ? 1 : 0));
}

static void print_vector(FILE *stream, const char *name, vec3 v)
{
    char x[NUMBER_TEXT_MAX], y[NUMBER_TEXT_MAX], z[NUMBER_TEXT_MAX];
    fprintf(stream, "%-10s %s %s %s\n", name, number_format_digits(v.x, 9, x), number_format_digits(v.y, 9, y),
            number_format_digits(v.z, 9, z));
}

static void print_hole(FILE *stream, const mesh *m)
{
    static const char *const faults[MESH_FAULT_COUNT] = {
        [MESH_ODD] = "", /* see below */
        [MESH_ONE_SIDED] = "inconsistent orientation at",
        [MESH_UNBALANCED] = "triangles do not agree about the inside at",
        [MESH_CANCELLED] = "each triangle lies on one that faces the other way, as at"};
    const mesh_hole *h = &m->hole;
    if (m->triangle_count == 0 || h->fault == MESH_FLAT) {
        fprintf(stream, "closed     no: %s\n",
                m->triangle_count ? "every triangle has zero area" : "it has points only");
        return;
    }
    fprintf(stream, "closed     no: %s%sthe edge from vertex %lu to %lu of triangle %zu", faults[h->fault],
            h->fault == MESH_ODD ? "" : " ", (unsigned long)h->from, (unsigned long)h->to, h->triangle);
    if (h->fault != MESH_ONE_SIDED)
        fprintf(stream, h->fault == MESH_ODD ? " is shared by %d, not %s" : ", which %d share%s", h->sharing,
                h->fault != MESH_ODD ? ""
                : h->sharing == 1    ? "2"
                                     : "an even number");
    putc('\n', stream);
}

void mesh_rows_text(FILE *stream, const mesh *m, const char *refusal)
{
    char number[NUMBER_TEXT_MAX];
    fprintf(stream, "triangles  %zu\nvertices   %zu\n", m->triangle_count, m->vertex_count);
    if (m->bounds.low.x <= m->bounds.high.x) {
        print_vector(stream, "from", m->bounds.low);
        print_vector(stream, "to", m->bounds.high);
    }
    fprintf(stream, "area       %s\n", number_format_digits(mesh_area(m), 12, number));
    if (m->closed)
        fprintf(stream, "closed     yes\nvolume     %s\n", number_format_digits(mesh_volume(m), 12, number));
    else
        print_hole(stream, m);
    if (m->shell_count > 1 || m->crowded)
        fprintf(stream, "shells     %zu\n", m->shell_count);
    if (refusal)
        fprintf(stream, "solid      no: %s\n", refusal);
    fprintf(stream, "has       %s%s%s%s positions\n", m->normals ? " normals," : "",
            m->uvs ? " texture coordinates," : "", m->colors ? " colours," : "",
            m->single ? " single-precision" : " double-precision");
    if (m->slot_count > 1)
        fprintf(stream, "materials  %d\n", m->slot_count);
    fprintf(stream, "memory     %s MB\n", number_format_digits((double)memory_bytes(m) / 1e6, 4, number));
}

static json_t *vector_json(vec3 v)
{
    return json_pack("[o,o,o]", json_of_real(v.x), json_of_real(v.y), json_of_real(v.z));
}

static json_t *hole_json(const mesh *m)
{
    const mesh_hole *h = &m->hole;
    if (m->closed || h->fault == MESH_FLAT)
        return json_null();
    return json_pack("{s:I,s:I,s:I,s:i}", "from", (json_int_t)h->from, "to", (json_int_t)h->to, "triangle",
                     (json_int_t)h->triangle, "sharing", h->sharing);
}

json_t *mesh_rows_json(const mesh *m, const char *refusal)
{
    return json_pack("{s:i,s:I,s:I,s:o,s:o,s:o,s:b,s:o,s:o,s:I,s:s?,s:b,s:b,s:b,s:b,s:i,s:I}", "schema", 1, "triangles",
                     (json_int_t)m->triangle_count, "vertices", (json_int_t)m->vertex_count, "low",
                     vector_json(m->bounds.low), "high", vector_json(m->bounds.high), "area",
                     json_of_real(mesh_area(m)), "closed", m->closed, "volume",
                     json_of_real(m->closed ? mesh_volume(m) : (double)NAN), "hole", hole_json(m), "shells",
                     (json_int_t)m->shell_count, "refusal", refusal, "normals", m->normals != NULL,
                     "texture_coordinates", m->uvs != NULL, "colors", m->colors != NULL, "single", m->single,
                     "materials", m->slot_count, "bytes", (json_int_t)memory_bytes(m));
}

/* --- formats of other programs --- */

const char *mesh_format_name(mesh_format format)
{
    static const char *const names[MESH_FORMAT_COUNT] = {"obj", "ply", "glb"};
    return names[format];
}

static vec3 mirrored_if(bool mirrored, vec3 v)
{
    return mirrored ? vec3_make(v.x, v.y, 0.0 - v.z) : v;
}

/* The corner of a triangle that is written as number k: a mirror exchanges the last two (mesh_mirror). */
static uint32_t corner_if(bool mirrored, const mesh_triangle *t, int k)
{
    return t->corner[mirrored && k > 0 ? 3 - k : k];
}

/* A component of a vertex's colour as OBJ and PLY files have it, in sRGB. */
static float encoded_color(const mesh *m, size_t v, int c)
{
    return (float)srgb_encode((double)m->colors[v][c]);
}

/* Whether bytes represent all colours exactly. */
static bool has_byte_colors(const mesh *m)
{
    bool exact = true;
    for (size_t i = 0; exact && i < 3 * m->vertex_count && !cancel_asked_at(i); i++) {
        const float value = m->colors[i / 3][i % 3], byte = rintf(255.0f * encoded_color(m, i / 3, (int)(i % 3)));
        const float decoded = (float)srgb_decode((double)(float)((double)byte / 255.0));
        exact = memcmp(&decoded, &value, sizeof value) == 0;
    }
    return exact;
}

static void write_obj(const mesh *m, bool mirrored, FILE *stream)
{
    const int digits = m->single ? 9 : 17;
    for (size_t v = 0; v < m->vertex_count && !cancel_asked(); v++) {
        const vec3 p = mirrored_if(mirrored, m->vertices[v]);
        fprintf(stream, "v %.*g %.*g %.*g", digits, p.x, digits, p.y, digits, p.z);
        for (int c = 0; m->colors && c < 3; c++)
            fprintf(stream, " %.9g", (double)encoded_color(m, v, c));
        putc('\n', stream);
    }
    for (size_t t = 0; t < m->triangle_count && !cancel_asked(); t++) {
        const mesh_triangle *one = &m->triangles[t];
        fprintf(stream, "f %lu %lu %lu\n", corner_if(mirrored, one, 0) + 1ul, corner_if(mirrored, one, 1) + 1ul,
                corner_if(mirrored, one, 2) + 1ul);
    }
}

/* Little-endian on every machine. */
static void put_bits(uint64_t bits, int bytes, FILE *stream)
{
    for (int k = 0; k < bytes; k++)
        putc((int)(bits >> 8 * k & 0xff), stream);
}

static void put_real(double x, bool single, FILE *stream)
{
    const float narrow = (float)x;
    uint32_t bits32;
    uint64_t bits64;
    memcpy(&bits32, &narrow, sizeof bits32);
    memcpy(&bits64, &x, sizeof bits64);
    put_bits(single ? bits32 : bits64, single ? 4 : 8, stream);
}

static void put_vector(vec3 v, bool single, FILE *stream)
{
    put_real(v.x, single, stream);
    put_real(v.y, single, stream);
    put_real(v.z, single, stream);
}

static void write_ply(const mesh *m, bool mirrored, FILE *stream)
{
    const char *real = m->single ? "float" : "double";
    fprintf(stream, "ply\nformat binary_little_endian 1.0\nelement vertex %zu\n", m->vertex_count);
    fprintf(stream, "property %s x\nproperty %s y\nproperty %s z\n", real, real, real);
    if (m->normals)
        fprintf(stream, "property %s nx\nproperty %s ny\nproperty %s nz\n", real, real, real);
    if (m->uvs)
        fprintf(stream, "property %s s\nproperty %s t\n", real, real);
    const bool bytes = m->colors && has_byte_colors(m);
    const char *of_color = bytes ? "uchar" : "float";
    if (m->colors)
        fprintf(stream, "property %s red\nproperty %s green\nproperty %s blue\n", of_color, of_color, of_color);
    fprintf(stream, "element face %zu\nproperty list uchar int vertex_indices\n%send_header\n", m->triangle_count,
            m->slots ? "property uchar material_index\n" : "");
    for (size_t v = 0; v < m->vertex_count && !cancel_asked(); v++) {
        put_vector(mirrored_if(mirrored, m->vertices[v]), m->single, stream);
        if (m->normals)
            put_vector(mirrored_if(mirrored, m->normals[v]), m->single, stream);
        if (m->uvs) {
            put_real(m->uvs[v].u, m->single, stream);
            put_real(m->uvs[v].v, m->single, stream);
        }
        for (int c = 0; m->colors && c < 3; c++) {
            const float color = encoded_color(m, v, c);
            if (bytes)
                putc((int)rintf(255.0f * color), stream);
            else
                put_real((double)color, true, stream);
        }
    }
    for (size_t t = 0; t < m->triangle_count && !cancel_asked(); t++) {
        putc(3, stream);
        for (int k = 0; k < 3; k++)
            put_bits(corner_if(mirrored, &m->triangles[t], k), 4, stream);
        if (m->slots)
            putc(m->slots[t], stream);
    }
}

/* --- GLB: a header, a chunk of JSON that says where everything is, and a chunk of numbers --- */

enum { GLB_HEADER = 12, GLB_CHUNK = 8, GL_FLOAT = 5126, GL_UINT = 5125, GL_VERTICES = 34962, GL_INDICES = 34963 };

/* The second chunk, in order: positions, normals, texture coordinates, colours, the triangles by slot, and the image
 * files of the looks, each filled up to a multiple of 4 bytes. */
typedef struct glb_layout {
    const mesh_import *looks;       /* NULL: none */
    const char *path;               /* of the GLB file */
    size_t by_slot[MESH_SLOTS_MAX]; /* triangles */
    uint64_t bytes;                 /* so far */
    json_t *views, *accessors, *attributes;
    json_t *materials, *images, *textures, *samplers;
    json_t *extensions; /* its keys are the names */
    bool bad;
} glb_layout;

/* Adds an array and its accessor. Returns the accessor's number. */
static json_int_t add_array(glb_layout *l, int target, int component, const char *type, size_t count, size_t size)
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

/* The accessors of the vertices. The format wants the bounds of all positions, used or not. */
static void add_vertices(const mesh *m, bool mirrored, glb_layout *l)
{
    vec3 low = mirrored_if(mirrored, m->vertices[0]), high = low;
    for (size_t v = 1; v < m->vertex_count; v++) {
        const vec3 p = mirrored_if(mirrored, m->vertices[v]);
        low = vec3_make(fmin(low.x, p.x), fmin(low.y, p.y), fmin(low.z, p.z));
        high = vec3_make(fmax(high.x, p.x), fmax(high.y, p.y), fmax(high.z, p.z));
    }
    const json_int_t positions = add_array(l, GL_VERTICES, GL_FLOAT, "VEC3", m->vertex_count, 12);
    json_t *one = json_array_get(l->accessors, (size_t)positions);
    l->bad |= json_object_set_new(one, "min", float_vector_json(low)) != 0;
    l->bad |= json_object_set_new(one, "max", float_vector_json(high)) != 0;
    l->bad |= json_object_set_new(l->attributes, "POSITION", json_integer(positions)) != 0;
    if (m->normals)
        l->bad |=
            json_object_set_new(l->attributes, "NORMAL",
                                json_integer(add_array(l, GL_VERTICES, GL_FLOAT, "VEC3", m->vertex_count, 12))) != 0;
    if (m->uvs)
        l->bad |=
            json_object_set_new(l->attributes, "TEXCOORD_0",
                                json_integer(add_array(l, GL_VERTICES, GL_FLOAT, "VEC2", m->vertex_count, 8))) != 0;
    if (m->colors)
        l->bad |=
            json_object_set_new(l->attributes, "COLOR_0",
                                json_integer(add_array(l, GL_VERTICES, GL_FLOAT, "VEC3", m->vertex_count, 12))) != 0;
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

/* Adds to a list or, with a key, to an object; takes the value. */
static void add_to(glb_layout *l, json_t *to, const char *key, json_t *value)
{
    l->bad |= (key ? json_object_set_new(to, key, value) : json_array_append_new(to, value)) != 0;
}

static size_t filled_up(size_t size)
{
    return (size + 3) / 4 * 4;
}

/* The images inside the mesh file come before those that are named by path: they keep their numbers. */
static void add_images(glb_layout *l)
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
static void add_sampler(const imported_texture *m, json_t *texture, glb_layout *l)
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

static void add_texture(const imported_texture *m, const char *key, json_t *surface, glb_layout *l)
{
    json_int_t source = m->image - 1;
    char *moved = NULL;
    if (!imported_texture_exists(m))
        return;
    if (m->path) {
        l->bad |= write_moved_path(m->path, "", l->path, &moved, NULL) != STATUS_OK;
        add_to(l, l->images, NULL, json_pack("{s:o}", "uri", moved ? uri_json(moved) : NULL));
        source = l->looks->image_count + (json_int_t)json_array_size(l->images) - 1;
        free(moved);
    }
    json_t *texture = json_pack("{s:I}", "source", source);
    add_sampler(m, texture, l);
    add_to(l, l->textures, NULL, texture);
    add_to(l, surface, key, json_pack("{s:I}", "index", (json_int_t)json_array_size(l->textures) - 1));
}

static void add_extension(json_t *to, const char *name, json_t *value, glb_layout *l)
{
    add_to(l, to, name, value);
    add_to(l, l->extensions, name, json_null());
}

/* Glass and strong emission, which the format itself does not have. */
static json_t *extensions_json(const imported_material *m, double brightest, glb_layout *l)
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
    if (m->dispersion > 0.0)
        add_extension(all, "KHR_materials_dispersion", json_pack("{s:f}", "dispersion", m->dispersion), l);
    return all;
}

/* Alpha is the opacity without what glass lets through. */
static double add_alpha(const imported_material *m, json_t *to, glb_layout *l)
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

/* Colours are in [0, 1] in this format. */
static json_t *material_json(const imported_material *m, const char *name, glb_layout *l)
{
    const double *e = m->emissive, brightest = fmax(e[0], fmax(e[1], e[2])), by = fmax(brightest, 1.0);
    json_t *one = json_pack("{s:b}", "doubleSided", 1), *extensions = extensions_json(m, brightest, l);
    const double alpha = add_alpha(m, one, l);
    json_t *surface =
        json_pack("{s:[f,f,f,f],s:f,s:f}", "baseColorFactor", fmin(m->color[0], 1.0), fmin(m->color[1], 1.0),
                  fmin(m->color[2], 1.0), alpha, "metallicFactor", 0.0, "roughnessFactor", 1.0);
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
    return one;
}

static void add_primitives(const mesh *m, json_t *to, glb_layout *l)
{
    for (int slot = 0; slot < m->slot_count; slot++) {
        if (l->by_slot[slot] == 0)
            continue;
        const json_int_t indices = add_array(l, GL_INDICES, GL_UINT, "SCALAR", 3 * l->by_slot[slot], 4);
        json_t *one = json_pack("{s:O,s:I}", "attributes", l->attributes, "indices", indices);
        if (l->looks && l->looks->materials[slot].given) {
            add_to(l, one, "material", json_integer((json_int_t)json_array_size(l->materials)));
            add_to(l, l->materials, NULL, material_json(&l->looks->materials[slot], m->slot_names[slot], l));
        }
        add_to(l, to, NULL, one);
    }
}

/* Adds a list, which it takes, unless it is empty: the format has no empty lists. */
static void add_list(json_t *to, const char *key, json_t *list, glb_layout *l)
{
    if (json_array_size(list) > 0)
        l->bad |= json_object_set(to, key, list) != 0;
    json_decref(list);
}

/* The first chunk's document; NULL when out of memory. */
static json_t *glb_json(const mesh *m, bool mirrored, glb_layout *l)
{
    json_t *primitives = json_array(), *used = json_array();
    l->views = json_array(), l->accessors = json_array(), l->attributes = json_object();
    l->materials = json_array(), l->images = json_array(), l->textures = json_array(), l->samplers = json_array();
    l->extensions = json_object();
    for (size_t t = 0; t < m->triangle_count; t++)
        l->by_slot[m->slots ? m->slots[t] : 0]++;
    add_vertices(m, mirrored, l);
    add_primitives(m, primitives, l);
    add_images(l);
    json_t *all = json_pack("{s:{s:s,s:s},s:i,s:[{s:[i]}],s:[{s:i}],s:[{s:o}],s:o,s:o,s:[{s:I}]}", "asset", "version",
                            "2.0", "generator", "Cuvette", "scene", 0, "scenes", "nodes", 0, "nodes", "mesh", 0,
                            "meshes", "primitives", primitives, "accessors", l->accessors, "bufferViews", l->views,
                            "buffers", "byteLength", (json_int_t)l->bytes);
    const char *name;
    json_t *unused;
    json_object_foreach(l->extensions, name, unused) add_to(l, used, NULL, json_string(name));
    add_list(all, "materials", l->materials, l);
    add_list(all, "images", l->images, l);
    add_list(all, "textures", l->textures, l);
    add_list(all, "samplers", l->samplers, l);
    add_list(all, "extensionsUsed", used, l);
    json_decref(l->attributes);
    json_decref(l->extensions);
    if (l->bad) {
        json_decref(all);
        return NULL;
    }
    return all;
}

static void put_numbers(const mesh *m, bool mirrored, const glb_layout *l, FILE *stream)
{
    for (size_t v = 0; v < m->vertex_count && !cancel_asked(); v++)
        put_vector(mirrored_if(mirrored, m->vertices[v]), true, stream);
    for (size_t v = 0; m->normals && v < m->vertex_count && !cancel_asked(); v++)
        put_vector(mirrored_if(mirrored, m->normals[v]), true, stream);
    for (size_t v = 0; m->uvs && v < m->vertex_count && !cancel_asked(); v++) {
        put_real(m->uvs[v].u, true, stream);
        put_real(1.0 - m->uvs[v].v, true, stream); /* v runs downwards */
    }
    for (size_t v = 0; m->colors && v < m->vertex_count && !cancel_asked(); v++)
        for (int c = 0; c < 3; c++)
            put_real((double)m->colors[v][c], true, stream);
    for (int slot = 0; slot < m->slot_count; slot++)
        for (size_t t = 0; l->by_slot[slot] && t < m->triangle_count && !cancel_asked_at(t); t++)
            for (int k = 0; (m->slots ? m->slots[t] : 0) == slot && k < 3; k++)
                put_bits(corner_if(mirrored, &m->triangles[t], k), 4, stream);
    for (int i = 0; l->looks && i < l->looks->image_count && !cancel_asked(); i++) {
        const imported_image *one = &l->looks->images[i];
        fwrite(one->bytes, 1, one->size, stream);
        put_bits(0, (int)(filled_up(one->size) - one->size), stream);
    }
}

static status write_glb(const mesh *m, const mesh_import *looks, bool mirrored, const char *path, FILE *stream,
                        diagnostic *why)
{
    if (m->triangle_count == 0)
        return diagnose(why, STATUS_BAD_INPUT, "write another format", "a GLB file needs triangles");
    glb_layout l = {.looks = looks, .path = path ? path : ""};
    json_t *document = glb_json(m, mirrored, &l);
    char *text = document ? json_dumps(document, JSON_COMPACT) : NULL;
    json_decref(document);
    if (!text)
        return out_of_memory(why);
    const uint64_t length = strlen(text), padded = (length + 3) / 4 * 4,
                   all = GLB_HEADER + 2 * GLB_CHUNK + padded + l.bytes;
    if (all > UINT32_MAX) {
        free(text);
        return diagnose(why, STATUS_BAD_INPUT, "write a PLY file", "the mesh is too large for a GLB file");
    }
    fputs("glTF", stream);
    put_bits(2, 4, stream);
    put_bits(all, 4, stream);
    put_bits(padded, 4, stream);
    fputs("JSON", stream);
    fprintf(stream, "%-*s", (int)padded, text);
    free(text);
    put_bits(l.bytes, 4, stream);
    fwrite("BIN", 1, 4, stream);
    put_numbers(m, mirrored, &l, stream);
    return STATUS_OK;
}

double mesh_rounding(const mesh *m)
{
    double most = 0.0;
    for (size_t v = 0; !m->single && v < m->vertex_count; v++) {
        const vec3 p = m->vertices[v];
        most = fmax(most, fmax(fabs((double)(float)p.x - p.x),
                               fmax(fabs((double)(float)p.y - p.y), fabs((double)(float)p.z - p.z))));
    }
    return most;
}

status mesh_write(const mesh *m, const mesh_import *looks, mesh_format format, bool mirrored, const char *path,
                  FILE *stream, diagnostic *why)
{
    switch (format) {
    case MESH_OBJ: write_obj(m, mirrored, stream); return STATUS_OK;
    case MESH_PLY: write_ply(m, mirrored, stream); return STATUS_OK;
    case MESH_GLB: return write_glb(m, looks, mirrored, path, stream, why);
    case MESH_FORMAT_COUNT: break;
    }
    return STATUS_OK;
}
