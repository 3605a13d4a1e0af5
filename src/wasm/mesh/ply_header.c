/* The header of a PLY file. */
#include "wasm/mesh/ply.h"

#include <ctype.h>

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

static status take_element(ply *p)
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

static status take_property(ply *p)
{
    const char *word;
    size_t length;
    ply_property got = {.number = -1};
    if (p->element_count == 0)
        return bad(p, "a property without an element", "fix the header");
    ply_element *e = &p->elements[p->element_count - 1];
    if (e->property_count == PLY_PROPERTIES_MAX)
        return bad(p, "more than 64 properties", "fix the header");
    bool good = lines_word(&p->text, &word, &length);
    if (good && lines_is(word, length, "list")) {
        good = lines_word(&p->text, &word, &length) && (got.count = type_named(word, length)) != PLY_NONE &&
               got.count < PLY_F32 && lines_word(&p->text, &word, &length);
    }
    good = good && (got.type = type_named(word, length)) != PLY_NONE && lines_word(&p->text, &word, &length);
    if (!good)
        return bad(p, "a property of unknown type", "fix the header");
    if (e->kind == PLY_VERTEX && got.count == PLY_NONE)
        got.number = number_named(word, length);
    got.corners = e->kind == PLY_FACE && got.count != PLY_NONE &&
                  (lines_is(word, length, "vertex_indices") || lines_is(word, length, "vertex_index"));
    e->properties[e->property_count++] = got;
    return STATUS_OK;
}

static status take_format(ply *p)
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

status ply_header(ply *p)
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
            code = take_format(p);
            has_format = true;
        } else if (lines_is(word, length, "element")) {
            code = take_element(p);
        } else if (lines_is(word, length, "property")) {
            code = take_property(p);
        }
        if (code != STATUS_OK)
            return code;
    }
    return bad(p, "the header has no end", "export the file again");
}
