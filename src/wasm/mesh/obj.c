/* Reads OBJ files: v, vt, vn, f with any number of corners, relative indices, usemtl, mtllib with its materials; lines,
 * points, groups and smoothing are ignored. Format: Wavefront, Advanced Visualizer Manual, appendix B1, "Object
 * Files". */
#include "import/obj.h"
#include "base/array.h"
#include "base/file.h"
#include "wasm/mesh/mesh.h"

#include <stdlib.h>
#include <string.h>

/* --- material libraries: newmtl, Kd, Ka, Ks, Ke, Ns, Ni, d, Tr, map_Kd; the rest is ignored --- */

enum { MTL_BYTES_MAX = 1 << 24 };

/* Reads a colour; a single number is a grey. */
static void read_color(lines *l, double color[3])
{
    float v[3];
    const int count = lines_numbers(l, 3, v);
    for (int k = 0; k < 3 && count > 0; k++)
        color[k] = (double)v[count == 3 ? k : 0];
}

static void read_number(lines *l, double *number)
{
    float v;
    if (lines_numbers(l, 1, &v) == 1)
        *number = (double)v;
}

/* Reads the name of an image; after options, which begin with -, it is the last word. */
static status read_texture(lines *l, mesh_material *m, diagnostic *why)
{
    const char *name;
    size_t length = lines_rest(l, &name);
    for (size_t i = length; *name == '-' && i > 0; i--)
        if (name[i - 1] == ' ' || name[i - 1] == '\t') {
            length -= i;
            name += i;
            break;
        }
    if (length == 0)
        return STATUS_OK;
    free(m->texture);
    m->texture = strndup(name, length);
    return m->texture ? STATUS_OK : out_of_memory(why);
}

static status read_mtl_line(lines *l, mesh_parts *p, size_t *current, diagnostic *why)
{
    const char *word, *rest;
    size_t length;
    if (!lines_word(l, &word, &length) || *word == '#')
        return STATUS_OK;
    if (lines_is(word, length, "newmtl")) {
        const size_t size = lines_rest(l, &rest);
        for (size_t i = 1; i < p->material_count; i++)
            if (lines_is(rest, size, p->materials[i].name)) {
                *current = i;
                return STATUS_OK;
            }
        return mesh_parts_material(p, rest, size, current, why);
    }
    if (*current == 0)
        return STATUS_OK;
    mesh_material *m = &p->materials[*current];
    if (lines_is(word, length, "Kd"))
        read_color(l, m->values.diffuse);
    else if (lines_is(word, length, "Ka"))
        read_color(l, m->values.ambient);
    else if (lines_is(word, length, "Ks"))
        read_color(l, m->values.specular);
    else if (lines_is(word, length, "Ke"))
        read_color(l, m->values.emissive);
    else if (lines_is(word, length, "Ns"))
        read_number(l, &m->values.shininess);
    else if (lines_is(word, length, "Ni"))
        read_number(l, &m->values.ior);
    else if (lines_is(word, length, "d"))
        read_number(l, &m->values.opacity);
    else if (lines_is(word, length, "map_Kd"))
        return read_texture(l, m, why);
    else if (lines_is(word, length, "Tr")) {
        float clear;
        if (lines_numbers(l, 1, &clear) == 1)
            m->values.opacity = (double)(1.0F - clear);
    }
    return STATUS_OK;
}

static status mtl_read(const char *path, const char *root, mesh_parts *p, diagnostic *why)
{
    char *text = NULL;
    size_t size = 0, current = 0;
    TRY(file_read_below(path, root, MTL_BYTES_MAX, &text, &size, why));
    lines l = {.at = text, .end = text + size};
    status code = STATUS_OK;
    while (code == STATUS_OK && lines_next(&l))
        code = read_mtl_line(&l, p, &current, why);
    free(text);
    return code;
}

/* --- the mesh --- */

/* A polygon of the file: its corners and its material. */
typedef struct face {
    size_t first, count, material;
} face;

typedef struct obj_text {
    const char *path;
    mesh_parts *parts;
    float (*places)[3], (*uvs)[2], (*normals)[3];
    obj_corner *corners;
    face *faces;
    size_t place_count, uv_count, normal_count, corner_count, face_count;
    size_t place_room, uv_room, normal_room, corner_room, face_room;
    size_t material;
    long line;
    diagnostic *why;
} obj_text;

static status bad(const obj_text *o, const char *what, const char *remedy)
{
    return diagnose(o->why, STATUS_BAD_INPUT, remedy, "line %ld: %s", o->line, what);
}

static status read_place(obj_text *o, lines *l)
{
    float v[7];
    const int count = lines_numbers(l, 7, v);
    if (count < 0)
        return bad(o, "a vertex has a word that is not a finite number", "give three finite numbers");
    if (count < 3)
        return bad(o, "a vertex has fewer than three numbers", "give three finite numbers");
    if (!GROW(o->places, o->place_room, o->place_count + 1))
        return out_of_memory(o->why);
    if (count == 4 && v[3] == 0.0F)
        return bad(o, "the fourth number of a vertex is 0", "give three numbers");
    for (int k = 0; k < 3; k++)
        o->places[o->place_count][k] = count == 4 ? v[k] / v[3] : v[k];
    o->place_count++;
    return STATUS_OK;
}

static status read_uv(obj_text *o, lines *l)
{
    float v[3] = {0.0F, 0.0F, 0.0F};
    if (lines_numbers(l, 3, v) < 1)
        return bad(o, "a texture coordinate is not a number", "give two finite numbers");
    if (!GROW(o->uvs, o->uv_room, o->uv_count + 1))
        return out_of_memory(o->why);
    memcpy(o->uvs[o->uv_count++], v, sizeof *o->uvs);
    return STATUS_OK;
}

static status read_normal(obj_text *o, lines *l)
{
    float v[3];
    const int count = lines_numbers(l, 3, v);
    if (count < 0)
        return bad(o, "a normal has a word that is not a finite number", "give three finite numbers");
    if (count < 3)
        return bad(o, "a normal has fewer than three numbers", "give three finite numbers");
    if (!GROW(o->normals, o->normal_room, o->normal_count + 1))
        return out_of_memory(o->why);
    memcpy(o->normals[o->normal_count++], v, sizeof *o->normals);
    return STATUS_OK;
}

/* Reads the index of one of `count` elements: 1 is the first, -1 the last. Returns the index from 1, or 0 if there is
 * no such element. */
static uint32_t read_index(const char **at, size_t count)
{
    char *end;
    const long index = strtol(*at, &end, 10);
    if (end == *at)
        return 0;
    *at = end;
    if (index < 0)
        return (unsigned long)-index <= count ? (uint32_t)(count + 1 - (size_t)-index) : 0;
    return (size_t)index <= count ? (uint32_t)index : 0;
}

/* Reads a corner: place, place/uv, place//normal or place/uv/normal. */
static bool read_corner(const obj_text *o, const char *word, size_t length, obj_corner *c)
{
    char copy[64];
    if (length >= sizeof copy)
        return false;
    memcpy(copy, word, length);
    copy[length] = 0;
    const char *at = copy;
    *c = (obj_corner){.place = read_index(&at, o->place_count)};
    if (c->place == 0)
        return false;
    if (*at == '/' && at[1] && at[1] != '/') {
        at++;
        if ((c->uv = read_index(&at, o->uv_count)) == 0)
            return false;
    } else if (*at == '/') {
        at++;
    }
    if (*at == '/' && at[1]) {
        at++;
        if ((c->normal = read_index(&at, o->normal_count)) == 0)
            return false;
    } else if (*at == '/') {
        at++;
    }
    return *at == 0;
}

static status read_face(obj_text *o, lines *l)
{
    face f = {.first = o->corner_count, .material = o->material};
    const char *word;
    size_t length;
    while (lines_word(l, &word, &length) && *word != '#') {
        if (f.count == POLYGON_MAX)
            return bad(o, "a face has more than 4096 corners", "divide it into triangles");
        if (!GROW(o->corners, o->corner_room, o->corner_count + 1))
            return out_of_memory(o->why);
        if (!read_corner(o, word, length, &o->corners[o->corner_count]))
            return diagnose(
                o->why, STATUS_BAD_INPUT, "give indices of preceding vertices, such as 1, 1/1, 1//1 or 1/1/1",
                "line %ld: the corner '%.*s' of a face is invalid", o->line, (int)(length < 60 ? length : 60), word);
        o->corner_count++;
        f.count++;
    }
    if (f.count < 3) { /* a point or a line */
        o->corner_count = f.first;
        return STATUS_OK;
    }
    if (!GROW(o->faces, o->face_room, o->face_count + 1))
        return out_of_memory(o->why);
    o->faces[o->face_count++] = f;
    return STATUS_OK;
}

static status use_material(obj_text *o, const char *name, size_t length)
{
    for (size_t i = 1; i < o->parts->material_count; i++)
        if (lines_is(name, length, o->parts->materials[i].name)) {
            o->material = i;
            return STATUS_OK;
        }
    return mesh_parts_material(o->parts, name, length, &o->material, o->why);
}

static status use_library(obj_text *o, const char *name, size_t length)
{
    char *copy = strndup(name, length), *path = copy ? file_next_to(o->path, copy) : NULL;
    free(copy);
    if (!path)
        return out_of_memory(o->why);
    const status code = mtl_read(path, o->parts->limits->root, o->parts, o->why);
    free(path);
    return code;
}

static status read_line(obj_text *o, lines *l)
{
    const char *word, *rest;
    size_t length;
    if (!lines_word(l, &word, &length) || *word == '#')
        return STATUS_OK;
    if (lines_is(word, length, "v"))
        return read_place(o, l);
    if (lines_is(word, length, "vt"))
        return read_uv(o, l);
    if (lines_is(word, length, "vn"))
        return read_normal(o, l);
    if (lines_is(word, length, "f"))
        return read_face(o, l);
    const size_t size = lines_rest(l, &rest);
    if (lines_is(word, length, "usemtl") && size > 0)
        return use_material(o, rest, size);
    if (lines_is(word, length, "mtllib") && size > 0)
        return use_library(o, rest, size);
    return STATUS_OK;
}

/* --- triangles --- */

static void numbers_of(const obj_text *o, obj_corner c, double numbers[8])
{
    memset(numbers, 0, 8 * sizeof *numbers);
    for (int k = 0; k < 3; k++)
        numbers[k] = (double)o->places[c.place - 1][k];
    for (int k = 0; c.normal && k < 3; k++)
        numbers[3 + k] = (double)o->normals[c.normal - 1][k];
    for (int k = 0; c.uv && k < 2; k++)
        numbers[6 + k] = (double)o->uvs[c.uv - 1][k];
}

static status build_face(const obj_text *o, const face *f, uint32_t *indices, float (*places)[3],
                         uint32_t (*triangles)[3])
{
    size_t count = 1;
    for (size_t i = 0; i < f->count; i++) {
        double numbers[8];
        numbers_of(o, o->corners[f->first + i], numbers);
        TRY(mesh_parts_vertex(o->parts, numbers, &indices[i], o->why));
        memcpy(places[i], o->places[o->corners[f->first + i].place - 1], sizeof *places);
    }
    memcpy(triangles[0], (uint32_t[3]){0, 1, 2}, sizeof *triangles);
    if (f->count > 3)
        count = polygon_divide((const float(*)[3])places, f->count, triangles);
    for (size_t t = 0; t < count; t++) {
        const uint32_t corners[3] = {indices[triangles[t][0]], indices[triangles[t][1]], indices[triangles[t][2]]};
        TRY(mesh_parts_triangle(o->parts, corners, f->material, o->why));
    }
    return STATUS_OK;
}

static status build(const obj_text *o)
{
    for (size_t i = 0; i < o->corner_count; i++) {
        o->parts->flat.with_uvs |= o->corners[i].uv > 0;
        o->parts->flat.with_normals |= o->corners[i].normal > 0;
    }
    uint32_t *indices = malloc(POLYGON_MAX * sizeof *indices);
    float(*places)[3] = malloc(POLYGON_MAX * sizeof *places);
    uint32_t(*triangles)[3] = malloc(POLYGON_MAX * sizeof *triangles);
    status code = indices && places && triangles ? STATUS_OK : out_of_memory(o->why);
    for (size_t i = 0; i < o->face_count && code == STATUS_OK; i++)
        code = build_face(o, &o->faces[i], indices, places, triangles);
    free(indices), free(places), free(triangles);
    return code;
}

status obj_read_text(const char *path, const char *text, size_t size, mesh_parts *p, diagnostic *why)
{
    obj_text o = {.path = path, .parts = p, .why = why};
    lines l = {.at = text, .end = text + size};
    status code = STATUS_OK;
    while (code == STATUS_OK && lines_next(&l)) {
        o.line = l.line;
        code = read_line(&o, &l);
    }
    THEN(code, build(&o));
    free(o.places), free(o.uvs), free(o.normals), free(o.corners), free(o.faces);
    return code;
}
