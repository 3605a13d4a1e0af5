/* Reads PLY files (plain.h). */
#include "base/array.h"
#include "import/plain.h"

#include <float.h>
#include <math.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

enum { PLY_ELEMENTS_MAX = 16, PLY_PROPERTIES_MAX = 64, PLY_ALPHA = JOIN_NUMBERS, PLY_NUMBERS };

typedef enum ply_type { PLY_NONE, PLY_I8, PLY_U8, PLY_I16, PLY_U16, PLY_I32, PLY_U32, PLY_F32, PLY_F64 } ply_type;

typedef struct ply_property {
    ply_type count, type; /* count: the type of a list's length; PLY_NONE: not a list */
    int number;           /* index in the numbers of a vertex; -1: ignored */
    bool corners;         /* the list of a face's or a strip's corners */
} ply_property;

typedef struct ply_element {
    enum { PLY_OTHER, PLY_VERTEX, PLY_FACE, PLY_STRIP } kind;
    const char *name;
    size_t name_length;
    uint64_t count;
    ply_property properties[PLY_PROPERTIES_MAX];
    int property_count;
} ply_element;

/* Where a number of a vertex is: its type, and its offset from the vertex. PLY_NONE: the vertices lack it. */
typedef struct ply_column {
    ply_type type;
    size_t offset;
} ply_column;

typedef struct ply {
    const request *req;
    const char *begin;
    lines text;                      /* the rest of the file; of a binary file no lines after the header */
    bool ascii, big, swap, by_lines; /* by_lines: each item of a text begins on a line of its own */
    ply_element elements[PLY_ELEMENTS_MAX];
    int element_count;
    const ply_element *vertices, *element; /* element: being read */
    uint64_t vertex_count, index;          /* index: of the vertex, face or other item that is being read */
    const char *base;                      /* vertex i begins at base + i * stride */
    size_t stride;
    bool clear;    /* a vertex has an alpha below 1 */
    bool in_place; /* the vertices are in the file, in its byte order and unchecked; else in rows */
    ply_column columns[PLY_NUMBERS];
    double *rows; /* row_size numbers for each vertex */
    size_t row_size;
    uint32_t *corners, *sizes; /* of faces: indices of vertices, and the number of each face's corners */
    size_t corner_count, corner_room, face_count, size_room;
    joiner join;
    polygon shape;
    flat_mesh *flat;
    diagnostic *why;
} ply;

static const char repair[] = "repair the file or export it again";

#define TEXTURE_NOTE "the texture that the file names, and texture coordinates of faces, are not read"

/* --- the header --- */

static status bad(const ply *p, const char *what)
{
    diagnostic_locate(p->why, p->req->path, p->text.line, 0);
    return diagnose(p->why, STATUS_BAD_INPUT, "fix the header", "%s", what);
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
    } all[] = {{"x", 0},
               {"y", 1},
               {"z", 2},
               {"nx", 3},
               {"ny", 4},
               {"nz", 5},
               {"s", 6},
               {"t", 7},
               {"u", 6},
               {"v", 7},
               {"texture_u", 6},
               {"texture_v", 7},
               {"red", JOIN_COLOR},
               {"green", JOIN_COLOR + 1},
               {"blue", JOIN_COLOR + 2},
               {"diffuse_red", JOIN_COLOR},
               {"diffuse_green", JOIN_COLOR + 1},
               {"diffuse_blue", JOIN_COLOR + 2},
               {"alpha", PLY_ALPHA}};
    for (size_t i = 0; i < sizeof all / sizeof *all; i++)
        if (lines_is(word, length, all[i].name))
            return all[i].number;
    return -1;
}

static status read_element(ply *p)
{
    const char *number;
    size_t digits;
    if (p->element_count == PLY_ELEMENTS_MAX)
        return bad(p, "more than 16 PLY elements");
    ply_element *e = &p->elements[p->element_count];
    if (!lines_word(&p->text, &e->name, &e->name_length) || !lines_word(&p->text, &number, &digits) || digits > 18)
        return bad(p, "the count of an element is invalid");
    for (size_t i = 0; i < digits; i++) {
        if (number[i] < '0' || number[i] > '9')
            return bad(p, "the count of an element is invalid");
        e->count = 10 * e->count + (uint64_t)(number[i] - '0');
    }
    e->kind = lines_is(e->name, e->name_length, "vertex")      ? PLY_VERTEX
              : lines_is(e->name, e->name_length, "face")      ? PLY_FACE
              : lines_is(e->name, e->name_length, "tristrips") ? PLY_STRIP
                                                               : PLY_OTHER;
    if (e->kind == PLY_VERTEX && p->vertices)
        return bad(p, "a second element of vertices");
    if (e->kind == PLY_VERTEX) {
        if (e->count > UINT32_MAX - 1)
            return bad(p, "more than 4294967294 vertices");
        p->vertices = e;
        p->vertex_count = e->count;
    }
    p->element_count++;
    return STATUS_OK;
}

/* Notes a property of looks that is not read. */
static void note_unread(const ply *p, const ply_element *e, const ply_property *of, const char *word, size_t length)
{
    if (e->kind == PLY_FACE && of->count != PLY_NONE && lines_is(word, length, "texcoord"))
        flat_note(p->flat, TEXTURE_NOTE);
}

/* A comment, in which a program may have named its texture. */
static void read_comment(ply *p)
{
    const char *word;
    size_t length;
    if (lines_word(&p->text, &word, &length) && lines_is(word, length, "TextureFile"))
        flat_note(p->flat, TEXTURE_NOTE);
}

static status read_property(ply *p)
{
    const char *word;
    size_t length;
    ply_property parsed = {.number = -1};
    if (p->element_count == 0)
        return bad(p, "a property without an element");
    ply_element *e = &p->elements[p->element_count - 1];
    if (e->property_count == PLY_PROPERTIES_MAX)
        return bad(p, "more than 64 properties");
    bool good = lines_word(&p->text, &word, &length);
    if (good && lines_is(word, length, "list")) {
        good = lines_word(&p->text, &word, &length) && (parsed.count = type_named(word, length)) != PLY_NONE &&
               lines_word(&p->text, &word, &length);
    }
    good = good && (parsed.type = type_named(word, length)) != PLY_NONE && lines_word(&p->text, &word, &length);
    if (!good)
        return bad(p, "a property of unknown type");
    if (e->kind == PLY_VERTEX && parsed.count == PLY_NONE)
        parsed.number = number_named(word, length);
    parsed.corners = (e->kind == PLY_FACE || e->kind == PLY_STRIP) && parsed.count != PLY_NONE &&
                     (lines_is(word, length, "vertex_indices") || lines_is(word, length, "vertex_index"));
    note_unread(p, e, &parsed, word, length);
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
               : bad(p, "the format is not ascii, binary_little_endian or binary_big_endian");
}

/* Goes past the end of the header's last line. \r\n is one line end unless the first line ends with \r alone: then the
 * body begins with \n. */
static void end_header(ply *p)
{
    const char *first = p->begin;
    while (*first != '\n' && *first != '\r')
        first++;
    while (p->text.at < p->text.end && *p->text.at != '\n' && *p->text.at != '\r')
        p->text.at++;
    const bool two = (*first == '\n' || first[1] == '\n') && p->text.at[0] == '\r' && p->text.at[1] == '\n';
    p->text.at += two ? 2 : 1;
    p->text.at = p->text.at < p->text.end ? p->text.at : p->text.end;
    p->text.line++;
}

static status read_header(ply *p)
{
    const char *word;
    size_t length;
    bool format = false;
    while (lines_next(&p->text)) {
        if (!lines_word(&p->text, &word, &length))
            continue;
        if (lines_is(word, length, "end_header")) {
            if (!format)
                return bad(p, "the header names no format");
            if (!p->vertices)
                return bad(p, "the header names no vertices");
            end_header(p);
            return STATUS_OK;
        }
        if (lines_is(word, length, "comment"))
            read_comment(p);
        format |= lines_is(word, length, "format");
        TRY(lines_is(word, length, "format")     ? read_format(p)
            : lines_is(word, length, "element")  ? read_element(p)
            : lines_is(word, length, "property") ? read_property(p)
                                                 : STATUS_OK);
    }
    return bad(p, "the header has no end");
}

/* --- the elements, as text or binary --- */

static const size_t type_bytes[] = {0, 1, 1, 2, 2, 4, 4, 4, 8};

static double scalar(const char *at, ply_type type, bool swap)
{
    union {
        uint16_t two;
        uint32_t four;
        uint64_t eight;
        float single;
        double real;
    } u = {.eight = 0};
    memcpy(&u, at, type_bytes[type]);
    switch (type) {
    case PLY_I8: return (signed char)*at;
    case PLY_U8: return (unsigned char)*at;
    case PLY_I16:
    case PLY_U16: u.two = swap ? __builtin_bswap16(u.two) : u.two; return type == PLY_I16 ? (int16_t)u.two : u.two;
    case PLY_I32:
    case PLY_U32:
    case PLY_F32:
        u.four = swap ? __builtin_bswap32(u.four) : u.four;
        return type == PLY_I32 ? (double)(int32_t)u.four : type == PLY_U32 ? (double)u.four : (double)u.single;
    case PLY_F64: u.eight = swap ? __builtin_bswap64(u.eight) : u.eight; return u.real;
    case PLY_NONE: break;
    }
    return 0.0;
}

/* Reports where the file is wrong: the line of a text, the byte of a binary file. */
static status wrong(const ply *p, const char *remedy, const char *format, ...) __attribute__((format(printf, 3, 4)));
static status wrong(const ply *p, const char *remedy, const char *format, ...)
{
    char what[400], place[32] = "";
    va_list list;
    va_start(list, format);
    vsnprintf(what, sizeof what, format, list);
    va_end(list);
    if (p->ascii)
        diagnostic_locate(p->why, p->req->path, p->text.line, 0);
    else
        snprintf(place, sizeof place, "byte %zu: ", (size_t)(p->text.at - p->begin));
    return diagnose(p->why, STATUS_BAD_INPUT, remedy, "%s%s", place, what);
}

static status ends_within(const ply *p)
{
    const ply_element *e = p->element;
    return wrong(p, "the file is truncated, or its header is wrong; export it again",
                 "the file ends within %.*s %llu of %llu", (int)e->name_length, e->name,
                 (unsigned long long)p->index + 1, (unsigned long long)e->count);
}

static status read_number(ply *p, ply_type type, double *value)
{
    if (p->ascii) {
        const char *word;
        size_t length;
        if (!lines_any_word(&p->text, &word, &length))
            return ends_within(p);
        if (!lines_number(word, length, value))
            return wrong(p, repair, "'%.*s' in %.*s %llu is not a finite number", length < 60 ? (int)length : 60, word,
                         (int)p->element->name_length, p->element->name, (unsigned long long)p->index + 1);
        return STATUS_OK;
    }
    if ((size_t)(p->text.end - p->text.at) < type_bytes[type])
        return ends_within(p);
    *value = scalar(p->text.at, type, p->swap);
    p->text.at += type_bytes[type];
    return STATUS_OK;
}

static status read_length(ply *p, const ply_property *list, uint64_t *length)
{
    double count;
    TRY(read_number(p, list->count, &count));
    if (!(count >= 0 && count < 1e12 && count == floor(count)))
        return wrong(p, repair, "a list of %.*s %llu has the length %g", (int)p->element->name_length, p->element->name,
                     (unsigned long long)p->index + 1, count);
    *length = (uint64_t)count;
    return STATUS_OK;
}

/* Skips a value, or a list. */
static status skip(ply *p, const ply_property *of)
{
    uint64_t length = 1;
    double unused;
    if (of->count != PLY_NONE)
        TRY(read_length(p, of, &length));
    if (p->ascii) {
        for (; length > 0; length--)
            TRY(read_number(p, of->type, &unused));
    } else {
        if ((uint64_t)(p->text.end - p->text.at) / type_bytes[of->type] < length)
            return ends_within(p);
        p->text.at += length * type_bytes[of->type];
    }
    return STATUS_OK;
}

/* Whether the rest of a text has a line for each item. If not, an item begins after the last number of the one before
 * it. */
static bool has_lines(const ply *p)
{
    uint64_t items = 0, count = 0;
    for (int i = 0; i < p->element_count; i++)
        items += p->elements[i].property_count > 0 ? p->elements[i].count : 0;
    lines l = p->text;
    const char *word;
    size_t length;
    do
        count += lines_word(&l, &word, &length);
    while (lines_next(&l));
    return count >= items;
}

/* Leaves out what the line of an item has after the properties of the header. */
static void end_item(ply *p)
{
    const char *rest;
    if (!p->by_lines)
        return;
    const size_t length = lines_rest(&p->text, &rest);
    if (length > 0)
        flat_note(p->flat, "lines of the element %.*s have more numbers than the header says: they are left out",
                  (int)p->element->name_length, p->element->name);
    p->text.at = rest + length;
}

/* --- vertices --- */

static status check_number(const ply *p, int number, double value)
{
    return fabs(value) <= (number < 3 ? MESH_WIRE_FAR : DBL_MAX)
               ? STATUS_OK
               : wrong(p, repair, "vertex %llu has a number that is not finite%s", (unsigned long long)p->index + 1,
                       number < 3 ? ", or not within 1e9" : "");
}

/* The value of a column's type that means 1: of integers in colours, by their bytes or their two bytes. */
static double full_value(int number, ply_type type)
{
    return number < JOIN_COLOR || type == PLY_F32 || type == PLY_F64 ? 1.0 : type == PLY_U16 ? 65535.0 : 255.0;
}

/* Reads the used numbers of vertices one by one. */
static status read_rows(ply *p, const ply_element *e)
{
    size_t room = 0;
    for (int k = 0; k < PLY_NUMBERS; k++)
        p->row_size = p->columns[k].type != PLY_NONE ? (size_t)k + 1 : p->row_size;
    for (p->index = 0; p->index < e->count; p->index++) {
        if (!GROW(p->rows, room, (p->index + 1) * p->row_size))
            return no_memory_for(p->req, p->why);
        for (int q = 0; q < e->property_count; q++) {
            const ply_property *of = &e->properties[q];
            double value = 0.0;
            if (of->number < 0 || p->columns[of->number].type == PLY_NONE) {
                TRY(skip(p, of));
                continue;
            }
            TRY(read_number(p, of->type, &value));
            TRY(check_number(p, of->number, value));
            p->rows[p->index * p->row_size + (size_t)of->number] = value / full_value(of->number, of->type);
        }
        end_item(p);
    }
    for (int k = 0; k < PLY_NUMBERS; k++)
        if (p->columns[k].type != PLY_NONE)
            p->columns[k] = (ply_column){PLY_F64, (size_t)k * sizeof(double)};
    p->base = (const char *)p->rows;
    p->stride = p->row_size * sizeof *p->rows;
    return STATUS_OK;
}

/* Vertices of one size are read where they are. */
static status read_vertices(ply *p, const ply_element *e)
{
    bool lists = false;
    for (int q = 0; q < e->property_count; q++) {
        const ply_property *of = &e->properties[q];
        if (of->number >= 0)
            p->columns[of->number] = (ply_column){of->type, p->stride};
        p->stride += type_bytes[of->type];
        lists |= of->count != PLY_NONE;
    }
    for (int k = 0; k < 3; k++)
        if (p->columns[k].type == PLY_NONE)
            return diagnose(p->why, STATUS_BAD_INPUT, "export the file again", "the vertices have no x, y or z");
    const bool normals = p->columns[3].type && p->columns[4].type && p->columns[5].type,
               uvs = p->columns[6].type && p->columns[7].type,
               colors = p->columns[8].type && p->columns[9].type && p->columns[10].type;
    for (int k = 3; k < PLY_NUMBERS; k++)
        if (k < 6 ? !normals : k < JOIN_COLOR ? !uvs : !colors)
            p->columns[k].type = PLY_NONE;
    p->flat->with_normals = normals;
    p->flat->with_uvs = uvs;
    p->flat->with_colors = p->flat->srgb = colors;
    if (p->ascii || lists)
        return read_rows(p, e);
    const size_t left = (size_t)(p->text.end - p->text.at);
    p->index = left / p->stride;
    if (p->index < e->count) {
        p->text.at = p->text.end;
        return ends_within(p);
    }
    p->base = p->text.at;
    p->in_place = true;
    p->text.at += e->count * p->stride;
    return STATUS_OK;
}

/* --- faces --- */

static status add_face(ply *p, size_t first)
{
    const size_t count = p->corner_count - first;
    if (count < 3) {
        flat_note(p->flat, FLAT_FEW_CORNERS);
        p->corner_count = first;
        return STATUS_OK;
    }
    if (count > POLYGON_MAX)
        return wrong(p, "divide it into triangles", "face %llu has more than %d corners",
                     (unsigned long long)p->index + 1, (int)POLYGON_MAX);
    if (!GROW(p->sizes, p->size_room, p->face_count + 1))
        return no_memory_for(p->req, p->why);
    p->sizes[p->face_count++] = (uint32_t)count;
    return STATUS_OK;
}

static status add_corner(ply *p, double index)
{
    if (!(index >= 0 && index < (double)p->vertex_count && index == floor(index)))
        return wrong(p, repair, "%.*s %llu refers to vertex %.0f, counted from 0, of %llu vertices",
                     (int)p->element->name_length, p->element->name, (unsigned long long)p->index + 1, index,
                     (unsigned long long)p->vertex_count);
    if (p->corner_count == p->corner_room && !GROW(p->corners, p->corner_room, p->corner_count + 1))
        return no_memory_for(p->req, p->why);
    p->corners[p->corner_count++] = (uint32_t)index;
    return STATUS_OK;
}

static status read_polygon(ply *p, const ply_property *list)
{
    const size_t first = p->corner_count;
    uint64_t length = 0;
    double index;
    TRY(read_length(p, list, &length));
    for (; length > 0; length--) {
        TRY(read_number(p, list->type, &index));
        TRY(add_corner(p, index));
    }
    return add_face(p, first);
}

/* Each index makes a triangle with the two before it, every other one turned around; -1 begins another strip. Triangles
 * with two equal corners join parts of a strip, and have no area. */
static status read_strip(ply *p, const ply_property *list)
{
    double last[3] = {-1, -1, -1}, index;
    uint64_t length = 0, count = 0;
    TRY(read_length(p, list, &length));
    for (; length > 0; length--) {
        TRY(read_number(p, list->type, &index));
        count = index < 0 && index >= -1 ? 0 : count + 1;
        memcpy(last, (double[3]){last[1], last[2], index}, sizeof last);
        const double a = last[count % 2 ? 0 : 1], b = last[count % 2 ? 1 : 0];
        const size_t first = p->corner_count;
        if (count < 3 || !(a < b || a > b) || !(a < index || a > index) || !(b < index || b > index))
            continue;
        TRY(add_corner(p, a));
        TRY(add_corner(p, b));
        TRY(add_corner(p, index));
        TRY(add_face(p, first));
    }
    return STATUS_OK;
}

static status read_others(ply *p, const ply_element *e)
{
    for (p->index = 0; e->property_count > 0 && p->index < e->count; p->index++) {
        for (int q = 0; q < e->property_count; q++) {
            const ply_property *of = &e->properties[q];
            TRY(!of->corners ? skip(p, of) : e->kind == PLY_FACE ? read_polygon(p, of) : read_strip(p, of));
        }
        end_item(p);
    }
    return STATUS_OK;
}

static status read_body(ply *p)
{
    p->by_lines = p->ascii && has_lines(p);
    for (int i = 0; i < p->element_count; i++) {
        p->element = &p->elements[i];
        TRY(p->element == p->vertices ? read_vertices(p, p->element) : read_others(p, p->element));
    }
    return STATUS_OK;
}

/* --- the triangles --- */

static inline status read_column(ply *p, size_t i, int k, double *number)
{
    const ply_column *c = &p->columns[k];
    const char *at = p->base + i * p->stride + c->offset;
    *number = 0.0;
    if (c->type == PLY_NONE)
        return STATUS_OK;
    *number = scalar(at, c->type, p->in_place && p->swap);
    if (!p->in_place || fabs(*number) <= MESH_WIRE_FAR)
        return STATUS_OK;
    p->text.at = at;
    p->index = i;
    return check_number(p, k, *number);
}

static status vertex_numbers(ply *p, size_t i, double numbers[JOIN_NUMBERS])
{
    double color[3] = {0.0, 0.0, 0.0}, alpha;
    for (int k = 0; k < JOIN_COLOR; k++)
        TRY(read_column(p, i, k, &numbers[k]));
    if (!p->flat->with_colors) {
        memset(numbers + JOIN_COLOR, 0, (JOIN_NUMBERS - JOIN_COLOR) * sizeof *numbers);
        return STATUS_OK;
    }
    for (int c = 0; c < 3; c++) {
        TRY(read_column(p, i, JOIN_COLOR + c, &color[c]));
        color[c] /= full_value(JOIN_COLOR + c, p->columns[JOIN_COLOR + c].type);
    }
    join_color(p->flat, color, numbers);
    TRY(read_column(p, i, PLY_ALPHA, &alpha));
    const ply_type type = p->columns[PLY_ALPHA].type;
    p->clear |= type != PLY_NONE && alpha < full_value(PLY_ALPHA, type);
    return STATUS_OK;
}

/* Joins the vertices that faces use, in the order of the file; joined has their indices. */
static status join_all(ply *p, uint32_t *joined)
{
    double numbers[JOIN_BLOCK][JOIN_NUMBERS];
    size_t from[JOIN_BLOCK], count = 0;
    uint32_t indices[JOIN_BLOCK];
    for (size_t i = 0; i < p->vertex_count; i++) {
        if (joined[i]) {
            TRY(vertex_numbers(p, i, numbers[count]));
            from[count++] = i;
        }
        if (count < JOIN_BLOCK && i + 1 < p->vertex_count)
            continue;
        TRY(join_vertices(p->req, &p->join, p->flat, numbers, count, indices, p->why));
        for (size_t k = 0; k < count; k++)
            joined[from[k]] = indices[k];
        count = 0;
    }
    return STATUS_OK;
}

static status build_with(ply *p, uint32_t *joined)
{
    static const mesh_material none = {.values = {.diffuse = {1, 1, 1}, .opacity = 1, .ior = 1}};
    uint8_t slot;
    uint32_t *at = p->corners;
    for (size_t c = 0; c < p->corner_count; c++)
        joined[p->corners[c]] = 1;
    TRY(flat_material(p->req, p->flat, &none, &slot, p->why));
    TRY(join_all(p, joined));
    if (p->clear)
        flat_note(p->flat, VERTEX_ALPHA_NOTE);
    for (size_t c = 0; c < p->corner_count; c++)
        p->corners[c] = joined[p->corners[c]];
    for (size_t f = 0; f < p->face_count; at += p->sizes[f++])
        TRY(polygon_append(p->req, &p->shape, at, p->sizes[f], slot, p->flat, p->why));
    return STATUS_OK;
}

static status build(ply *p)
{
    TRY(flat_reserve(p->req, p->flat, p->corner_count - 2 * p->face_count, p->why));
    const size_t used = p->vertex_count < p->corner_count ? p->vertex_count : p->corner_count;
    uint32_t *joined = large_calloc(p->vertex_count, sizeof *joined);
    const status code =
        joined && join_reserve(&p->join, p->flat, used) ? build_with(p, joined) : no_memory_for(p->req, p->why);
    free(joined);
    return code;
}

status ply_read(const request *req, const char *text, size_t size, flat_mesh *flat, diagnostic *why)
{
    ply *p = calloc(1, sizeof *p);
    if (!p)
        return no_memory_for(req, why);
    const uint16_t one = 1;
    unsigned char low;
    memcpy(&low, &one, 1);
    *p = (ply){.req = req, .begin = text, .text = lines_of(text, size), .flat = flat, .why = why};
    status code = read_header(p);
    p->swap = p->big == (low == 1);
    THEN(code, read_body(p));
    THEN(code, build(p));
    free(p->rows), free(p->sizes), free(p->corners), free(p->join.table);
    polygon_release(&p->shape);
    free(p);
    return code;
}
