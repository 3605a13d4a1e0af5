/* The elements of a PLY file, as text or binary. */
#include "wasm/mesh/ply.h"

#include "base/array.h"
#include <stdlib.h>
#include <string.h>

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

/* keep: the corners of a face. */
static bool read_list(ply *p, const ply_property *of, bool keep)
{
    double count, value;
    if (!read_number(p, of->count, &count) || !(count >= 0 && count < 1e9))
        return false;
    for (double i = 0; i < count; i++) {
        if (!read_number(p, of->type, &value))
            return false;
        if (!keep)
            continue;
        if (!(value >= 0 && value < (double)UINT32_MAX) || !GROW(p->corners, p->corner_room, p->corner_count + 1))
            return false;
        p->corners[p->corner_count++] = (uint32_t)value;
    }
    return true;
}

static bool read_vertex(ply *p, const ply_element *e)
{
    double numbers[PLY_NUMBERS] = {0}, value;
    if (!GROW(p->vertices, p->vertex_room, p->vertex_count + 1))
        return false;
    for (int q = 0; q < e->property_count; q++) {
        const ply_property *of = &e->properties[q];
        if (of->count != PLY_NONE ? !read_list(p, of, false) : !read_number(p, of->type, &value))
            return false;
        if (of->number >= 0)
            numbers[of->number] = (double)(float)value; /* the importer's numbers are floats */
    }
    memcpy(p->vertices[p->vertex_count++], numbers, sizeof numbers);
    return true;
}

static bool read_face(ply *p, const ply_element *e)
{
    double unused;
    if (!GROW(p->starts, p->start_room, p->face_count + 2))
        return false;
    p->starts[p->face_count++] = p->corner_count;
    for (int q = 0; q < e->property_count; q++) {
        const ply_property *of = &e->properties[q];
        if (of->count != PLY_NONE ? !read_list(p, of, of->corners) : !read_number(p, of->type, &unused))
            return false;
    }
    p->starts[p->face_count] = p->corner_count;
    return true;
}

static bool read_other(ply *p, const ply_element *e)
{
    double unused;
    for (int q = 0; q < e->property_count; q++) {
        const ply_property *of = &e->properties[q];
        if (of->count != PLY_NONE ? !read_list(p, of, false) : !read_number(p, of->type, &unused))
            return false;
    }
    return true;
}

status ply_body(ply *p)
{
    static const char *const names[] = {"element", "vertex", "face"};
    for (int i = 0; i < p->element_count; i++) {
        const ply_element *e = &p->elements[i];
        for (uint64_t k = 0; e->property_count > 0 && k < e->count; k++) {
            const bool good = e->kind == PLY_VERTEX ? read_vertex(p, e)
                              : e->kind == PLY_FACE ? read_face(p, e)
                                                    : read_other(p, e);
            if (!good)
                return diagnose(p->why, STATUS_BAD_INPUT,
                                "the file is truncated, or its header is wrong; export it again",
                                "the file ends within %s %llu of %llu, or it has an invalid number", names[e->kind],
                                (unsigned long long)k + 1, (unsigned long long)e->count);
        }
        for (int q = 0; q < e->property_count && e->kind == PLY_VERTEX; q++) {
            p->parts->flat.with_normals |= e->properties[q].number >= 3 && e->properties[q].number <= 5;
            p->parts->flat.with_uvs |= e->properties[q].number >= 6;
        }
    }
    return STATUS_OK;
}
