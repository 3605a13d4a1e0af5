/* Reads PLY files: vertices with positions, normals and texture coordinates, and faces, as text or binary. Format: Greg
 * Turk, "The PLY Polygon File Format", 1994. */
#include "base/array.h"
#include "wasm/mesh/mesh.h"

#include <ctype.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

enum { PLY_ELEMENTS_MAX = 16, PLY_PROPERTIES_MAX = 64, PLY_NUMBERS = 8 };

typedef enum ply_type { PLY_NONE, PLY_I8, PLY_U8, PLY_I16, PLY_U16, PLY_I32, PLY_U32, PLY_F32, PLY_F64 } ply_type;

typedef struct ply_property {
    ply_type count, type; /* count: the type of a list's length; PLY_NONE: not a list */
    int number;           /* index in the numbers of a vertex; -1: ignored */
    bool corners;         /* the list of a face's corners */
} ply_property;

typedef struct ply_element {
    enum { PLY_OTHER, PLY_VERTEX, PLY_FACE } kind;
    uint64_t count;
    ply_property properties[PLY_PROPERTIES_MAX];
    int property_count;
} ply_element;

typedef struct ply {
    lines text;     /* the header; after it, the elements as text */
    const char *at; /* the rest of the elements as bytes */
    bool ascii, big;
    ply_element elements[PLY_ELEMENTS_MAX];
    int element_count;
    mesh_parts *parts;
    double (*vertices)[PLY_NUMBERS];
    uint32_t *joined; /* per vertex of the file: index in the mesh, if a face uses the vertex */
    size_t vertex_count, vertex_room;
    size_t *starts;    /* where each face starts in corners; then the end of the last face */
    uint32_t *corners; /* indices of vertices */
    size_t face_count, start_room, corner_count, corner_room;
    diagnostic *why;
} ply;

/* --- the header --- */

static status bad(const ply *p, const char *what, const char *remedy)
{
    return diagnose(p->why, STATUS_BAD_INPUT, remedy, "line %ld: %s", p->text.line, what);
}

static ply_type type_named(const char *word, size_t length)
{
    static const char *const names[][2] = {{"", ""},           {"char", "int8"},     {"uchar", "uint8"},
                                           {"short", "int16"}, {"ushort", "uint16"}, {"int", "int32"},
                                           {"uint", "uint32"}, {"float", "float32"}, {"double", "float64"}};
    for (int i = PLY_I8; i <= PLY_F64; i++)
        if (lines_is(word, length, names[i][0]) || lines_is(word, length, names[i][1]))
            return (ply_type)i;
    return PLY_NONE;
}

static int number_named(const char *word, size_t length)
{
    static const struct {
        const char *name;
        int number;
    } all[] = {{"x", 0}, {"y", 1}, {"z", 2}, {"nx", 3}, {"ny", 4},        {"nz", 5},
               {"s", 6}, {"t", 7}, {"u", 6}, {"v", 7},  {"texture_u", 6}, {"texture_v", 7}};
    for (size_t i = 0; i < sizeof all / sizeof *all; i++)
        if (lines_is(word, length, all[i].name))
            return all[i].number;
    return -1;
}

static status read_element(ply *p)
{
    const char *name, *number;
    size_t length, digits;
    if (p->element_count == PLY_ELEMENTS_MAX)
        return bad(p, "more than 16 PLY elements", "fix the header");
    ply_element *e = &p->elements[p->element_count];
    if (!lines_word(&p->text, &name, &length) || !lines_word(&p->text, &number, &digits) || digits > 18)
        return bad(p, "the count of an element is invalid", "fix the header");
    for (size_t i = 0; i < digits; i++) {
        if (!isdigit((unsigned char)number[i]))
            return bad(p, "the count of an element is invalid", "fix the header");
        e->count = 10 * e->count + (uint64_t)(number[i] - '0');
    }
    e->kind = lines_is(name, length, "vertex") ? PLY_VERTEX : lines_is(name, length, "face") ? PLY_FACE : PLY_OTHER;
    p->element_count++;
    return STATUS_OK;
}

static status read_property(ply *p)
{
    const char *word;
    size_t length;
    ply_property parsed = {.number = -1};
    if (p->element_count == 0)
        return bad(p, "a property without an element", "fix the header");
    ply_element *e = &p->elements[p->element_count - 1];
    if (e->property_count == PLY_PROPERTIES_MAX)
        return bad(p, "more than 64 properties", "fix the header");
    bool good = lines_word(&p->text, &word, &length);
    if (good && lines_is(word, length, "list")) {
        good = lines_word(&p->text, &word, &length) && (parsed.count = type_named(word, length)) != PLY_NONE &&
               parsed.count < PLY_F32 && lines_word(&p->text, &word, &length);
    }
    good = good && (parsed.type = type_named(word, length)) != PLY_NONE && lines_word(&p->text, &word, &length);
    if (!good)
        return bad(p, "a property of unknown type", "fix the header");
    if (e->kind == PLY_VERTEX && parsed.count == PLY_NONE)
        parsed.number = number_named(word, length);
    parsed.corners = e->kind == PLY_FACE && parsed.count != PLY_NONE &&
                     (lines_is(word, length, "vertex_indices") || lines_is(word, length, "vertex_index"));
    e->properties[e->property_count++] = parsed;
    return STATUS_OK;
}

static status read_format(ply *p)
{
    const char *word;
    size_t length;
    if (!lines_word(&p->text, &word, &length))
        length = 0;
    p->ascii = lines_is(word, length, "ascii");
    p->big = lines_is(word, length, "binary_big_endian");
    return p->ascii || p->big || lines_is(word, length, "binary_little_endian")
               ? STATUS_OK
               : bad(p, "the format is not ascii, binary_little_endian or binary_big_endian", "fix the header");
}

/* Reads from the first line to end_header. */
static status read_header(ply *p)
{
    const char *word;
    size_t length;
    bool has_format = false;
    if (!lines_next(&p->text) || !lines_word(&p->text, &word, &length) || !lines_is(word, length, "ply"))
        return bad(p, "this is not a file of format PLY", "check that the file is complete and has the right ending");
    while (lines_next(&p->text)) {
        status code = STATUS_OK;
        if (!lines_word(&p->text, &word, &length))
            continue;
        if (lines_is(word, length, "end_header")) {
            p->at = p->text.at;
            return has_format ? STATUS_OK : bad(p, "the format is missing", "fix the header");
        }
        if (lines_is(word, length, "format")) {
            code = read_format(p);
            has_format = true;
        } else if (lines_is(word, length, "element")) {
            code = read_element(p);
        } else if (lines_is(word, length, "property")) {
            code = read_property(p);
        }
        if (code != STATUS_OK)
            return code;
    }
    return bad(p, "the header has no end", "export the file again");
}

/* --- the elements, as text or binary --- */

static const int type_bytes[] = {0, 1, 1, 2, 2, 4, 4, 4, 8};

static bool read_binary(ply *p, ply_type type, double *value)
{
    const int bytes = type_bytes[type];
    uint64_t bits = 0;
    if (p->text.end - p->at < bytes)
        return false;
    for (int i = 0; i < bytes; i++)
        bits |= (uint64_t)(unsigned char)p->at[p->big ? bytes - 1 - i : i] << 8 * i;
    p->at += bytes;
    const uint32_t low = (uint32_t)bits;
    float single;
    memcpy(&single, &low, sizeof single);
    switch (type) {
    case PLY_I8: *value = (int8_t)bits; break;
    case PLY_I16: *value = (int16_t)bits; break;
    case PLY_I32: *value = (int32_t)bits; break;
    case PLY_U8:
    case PLY_U16:
    case PLY_U32: *value = (double)bits; break;
    case PLY_F32: *value = (double)single; break;
    case PLY_F64: memcpy(value, &bits, sizeof *value); break;
    case PLY_NONE: return false;
    }
    return true;
}

static bool read_ascii(ply *p, ply_type type, double *value)
{
    const char *word;
    size_t length;
    float number;
    while (!lines_word(&p->text, &word, &length))
        if (!lines_next(&p->text))
            return false;
    if (type != PLY_F32 && type != PLY_F64) {
        char copy[32];
        char *end;
        if (length >= sizeof copy)
            return false;
        memcpy(copy, word, length);
        copy[length] = 0;
        *value = strtod(copy, &end);
        return end > copy && *end == 0;
    }
    lines one = {.word = word, .line_end = word + length};
    if (lines_numbers(&one, 1, &number) != 1)
        return false;
    *value = (double)number;
    return true;
}

static bool read_number(ply *p, ply_type type, double *value)
{
    return p->ascii ? read_ascii(p, type, value) : read_binary(p, type, value);
}

/* These return STATUS_BAD_INPUT without a diagnostic, which read_body adds, if a number is invalid or missing. */

/* Reads a list; keep: appends its values to the corners. */
static status read_list(ply *p, const ply_property *list, bool keep)
{
    double count, value;
    if (!read_number(p, list->count, &count) || !(count >= 0 && count < 1e9))
        return STATUS_BAD_INPUT;
    for (double i = 0; i < count; i++) {
        if (!read_number(p, list->type, &value))
            return STATUS_BAD_INPUT;
        if (!keep)
            continue;
        if (!(value >= 0 && value < (double)UINT32_MAX))
            return STATUS_BAD_INPUT;
        if (!GROW(p->corners, p->corner_room, p->corner_count + 1))
            return out_of_memory(p->why);
        p->corners[p->corner_count++] = (uint32_t)value;
    }
    return STATUS_OK;
}

/* Reads a number, or a list as read_list does. */
static status read_value(ply *p, const ply_property *of, bool keep, double *value)
{
    if (of->count != PLY_NONE)
        return read_list(p, of, keep);
    return read_number(p, of->type, value) ? STATUS_OK : STATUS_BAD_INPUT;
}

static status read_vertex(ply *p, const ply_element *e)
{
    double numbers[PLY_NUMBERS] = {0}, value = 0.0;
    if (!GROW(p->vertices, p->vertex_room, p->vertex_count + 1))
        return out_of_memory(p->why);
    for (int q = 0; q < e->property_count; q++) {
        const ply_property *of = &e->properties[q];
        TRY(read_value(p, of, false, &value));
        if (of->number >= 0)
            numbers[of->number] = (double)(float)value; /* the importer's numbers are floats */
    }
    memcpy(p->vertices[p->vertex_count++], numbers, sizeof numbers);
    return STATUS_OK;
}

static status read_face(ply *p, const ply_element *e)
{
    double unused;
    if (!GROW(p->starts, p->start_room, p->face_count + 2))
        return out_of_memory(p->why);
    p->starts[p->face_count++] = p->corner_count;
    for (int q = 0; q < e->property_count; q++)
        TRY(read_value(p, &e->properties[q], e->properties[q].corners, &unused));
    p->starts[p->face_count] = p->corner_count;
    return STATUS_OK;
}

static status read_other(ply *p, const ply_element *e)
{
    double unused;
    for (int q = 0; q < e->property_count; q++)
        TRY(read_value(p, &e->properties[q], false, &unused));
    return STATUS_OK;
}

/* Reads vertices and faces. */
static status read_body(ply *p)
{
    static const char *const names[] = {"element", "vertex", "face"};
    for (int i = 0; i < p->element_count; i++) {
        const ply_element *e = &p->elements[i];
        for (uint64_t k = 0; e->property_count > 0 && k < e->count; k++) {
            const status code = e->kind == PLY_VERTEX ? read_vertex(p, e)
                                : e->kind == PLY_FACE ? read_face(p, e)
                                                      : read_other(p, e);
            if (code == STATUS_BAD_INPUT)
                return diagnose(p->why, STATUS_BAD_INPUT,
                                "the file is truncated, or its header is wrong; export it again",
                                "the file ends within %s %llu of %llu, or it has an invalid number", names[e->kind],
                                (unsigned long long)k + 1, (unsigned long long)e->count);
            if (code != STATUS_OK)
                return code;
        }
        for (int q = 0; q < e->property_count && e->kind == PLY_VERTEX; q++) {
            p->parts->flat.with_normals |= e->properties[q].number >= 3 && e->properties[q].number <= 5;
            p->parts->flat.with_uvs |= e->properties[q].number >= 6;
        }
    }
    return STATUS_OK;
}

/* --- the triangles --- */

/* Joins the vertices that faces use, in the order of the file. */
static status join_vertices(ply *p)
{
    p->joined = malloc((p->vertex_count + 1) * sizeof *p->joined);
    if (!p->joined)
        return out_of_memory(p->why);
    memset(p->joined, 0, p->vertex_count * sizeof *p->joined);
    for (size_t f = 0; f < p->face_count; f++)
        for (size_t c = p->starts[f]; c < p->starts[f + 1]; c++) {
            if (p->corners[c] >= p->vertex_count)
                return diagnose(p->why, STATUS_BAD_INPUT, "repair the file or export it again",
                                "a face refers to vertex %u, counted from 0, of %zu vertices", p->corners[c],
                                p->vertex_count);
            p->joined[p->corners[c]] |= p->starts[f + 1] - p->starts[f] >= 3;
        }
    for (size_t i = 0; i < p->vertex_count; i++)
        if (p->joined[i])
            TRY(mesh_parts_vertex(p->parts, p->vertices[i], &p->joined[i], p->why));
    return STATUS_OK;
}

/* Imitates the importer: if a triangle begins at the same vertex as the one before it, and they are not the halves of a
 * quadrilateral, it is rotated to begin elsewhere. */
static void begin_elsewhere(const uint32_t *corners, uint32_t (*triangles)[3], size_t count, bool four, uint32_t *last)
{
    for (size_t t = 0; t < count; t += four ? 2 : 1) {
        uint32_t *a = triangles[t];
        if (corners[a[0]] == *last) {
            memcpy(a, (uint32_t[3]){a[2], a[0], a[1]}, 3 * sizeof *a);
            if (four) {
                uint32_t *b = triangles[t + 1];
                memcpy(b, (uint32_t[3]){b[1], b[2], b[0]}, 3 * sizeof *b);
            }
        }
        *last = corners[a[0]];
    }
}

static status build_face(ply *p, size_t f, bool polygons, float (*places)[3], uint32_t (*triangles)[3], uint32_t *last)
{
    const uint32_t *corners = p->corners + p->starts[f];
    const size_t size = p->starts[f + 1] - p->starts[f];
    size_t count = 1;
    if (size < 3)
        return STATUS_OK;
    if (size > POLYGON_MAX)
        return diagnose(p->why, STATUS_BAD_INPUT, "divide it into triangles", "a face has more than 4096 corners");
    memcpy(triangles[0], (uint32_t[3]){0, 1, 2}, sizeof *triangles);
    for (size_t i = 0; i < size; i++)
        for (int k = 0; k < 3; k++)
            places[i][k] = (float)p->vertices[corners[i]][k];
    if (size > 3)
        count = polygon_divide((const float(*)[3])places, size, triangles);
    if (polygons)
        begin_elsewhere(corners, triangles, count, size == 4, last);
    for (size_t t = 0; t < count; t++) {
        uint32_t indices[3];
        for (int k = 0; k < 3; k++)
            indices[k] = p->joined[corners[triangles[t][k]]];
        TRY(mesh_parts_triangle(p->parts, indices, 0, p->why));
    }
    return STATUS_OK;
}

static status build(ply *p)
{
    bool polygons = false;
    uint32_t last = UINT32_MAX;
    for (size_t f = 0; f < p->face_count; f++)
        polygons |= p->starts[f + 1] - p->starts[f] > 3;
    TRY(join_vertices(p));
    float(*places)[3] = malloc(POLYGON_MAX * sizeof *places);
    uint32_t(*triangles)[3] = malloc(POLYGON_MAX * sizeof *triangles);
    status code = places && triangles ? STATUS_OK : out_of_memory(p->why);
    for (size_t f = 0; f < p->face_count && code == STATUS_OK; f++)
        code = build_face(p, f, polygons, places, triangles, &last);
    free(places), free(triangles);
    return code;
}

status ply_read_text(const char *text, size_t size, mesh_parts *parts, diagnostic *why)
{
    ply *p = calloc(1, sizeof *p);
    if (!p)
        return out_of_memory(why);
    p->text = (lines){.at = text, .end = text + size};
    p->parts = parts;
    p->why = why;
    status code = read_header(p);
    if (code == STATUS_OK) {
        p->text.word = p->text.line_end = p->text.at;
        code = read_body(p);
    }
    THEN(code, build(p));
    free(p->vertices), free(p->joined), free(p->starts), free(p->corners);
    free(p);
    return code;
}
