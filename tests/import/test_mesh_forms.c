/* Tests of the readers of PLY and STL files: every form of the formats gives the values of the file, or is refused with
 * the line or the byte. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "mesh_read.h"
#include <math.h>

/* The square (0 0 0) (1 0 0) (1 1 0) (0 1 0), divided at its first corner. */
static const double square[18] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 0, 0, 1, 1, 0, 0, 1, 0};

static void check_square(mesh_import *got, const char *what)
{
    assert_triangles(got, square, 2, what);
    assert_int_equal(got->mesh->vertex_count, 4);
    assert_int_equal(got->material_count, 1);
    assert_false(got->materials[0].given);
    mesh_import_destroy(got);
}

/* Each text is the square, and so it is with \r\n and with \r at the ends of its lines. */
static void check_squares(const char *name, const char *const *texts, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        check_square(read_text(name, texts[i]), texts[i]);
        for (int end = 0; end < 2; end++) {
            bytes b = {0};
            for (const char *c = texts[i]; *c; c++)
                *c == '\n' ? add(&b, "\r\n", end ? 1 : 2) : add(&b, c, 1);
            check_square(read_bytes(name, b), texts[i]);
        }
    }
}

/* --- PLY --- */

#define XYZ "property float x\nproperty float y\nproperty float z\n"
#define CORNERS "0 0 0\n1 0 0\n1 1 0\n0 1 0\n"
#define FACE "element face 1\nproperty list uchar int vertex_indices\n"
#define ASCII "ply\nformat ascii 1.0\n"

static void ply_texts_are_read_in_every_form(void **state)
{
    (void)state;
    static const char *const texts[] = {
        ASCII "element vertex 4\n" XYZ FACE "end_header\n" CORNERS "4 0 1 2 3\n",
        ASCII "element vertex 4\n" XYZ FACE "end_header\n" CORNERS "4 0 1 2 3", /* no end of the last line */
        "\xef\xbb\xbfPLY\nformat ascii 1.0\nelement vertex 4\n" XYZ FACE "end_header\n" CORNERS "4 0 1 2 3\n",
        ASCII "element vertex 4\n" XYZ FACE "end_header\n0 0\n0 1 0 0 1 1 0\n\n0 1 0 4 0 1\n2 3\n", /* any lines */
        ASCII "comment TextureFile a.png\nobj_info x\n" FACE "element vertex 4\n" XYZ "end_header\n4 0 1 2 3\n" CORNERS,
        ASCII "element camera 1\nproperty float a\nproperty list uchar float m\nelement vertex 4\n" XYZ FACE
              "end_header\n1 2 8.5 9\n" CORNERS "4 0 1 2 3\n",
        ASCII "element vertex 4\nproperty list int int a\n" XYZ "property uchar red\n" FACE "end_header\n"
              "0 0 0 0 7\n2 8 9 1 0 0 7\n1 3 1 1 0 7\n0 0 1 0 7\n4 0 1 2 3\n",
        ASCII "element vertex 4\nproperty double z\nproperty float64 y\nproperty int32 x\nelement face 2\n"
              "property uchar flags\nproperty list uint8 uint vertex_index\nproperty list uchar float texcoord\n"
              "end_header\n0 0 0\n0 0 1\n0 1 1\n0 1 0\n7 3 0 1 2 2 .5 .5\n7 3 0 2 3 0\n",
        ASCII "element vertex 4\n" XYZ "element face 3\nproperty list uchar int vertex_indices\nend_header\n" CORNERS
              "2 0 1\n4 0 1 2 3\n0\n", /* a line, and nothing */
        ASCII "element vertex 6\n" XYZ FACE "end_header\n9 9 9\n" CORNERS "8 8 8\n4 1 2 3 4\n", /* unused vertices */
        ASCII "element vertex 4\n" XYZ FACE "element edge 1\nproperty int a\nend_header\n" CORNERS "4 0 1 2 3\n5\n",
    };
    check_squares("form.ply", texts, sizeof texts / sizeof *texts);
}

/* A header that forgets a property, as common tools have written it. */
static void what_a_line_has_beyond_the_header_is_left_out(void **state)
{
    (void)state;
    mesh_import *got =
        read_text("beyond.ply", ASCII "element vertex 4\n" XYZ FACE "end_header\n" CORNERS "4 0 1 2 3 9 1 1 1\n");
    assert_string_equal(got->note,
                        "lines of the element face have more numbers than the header says: they are left out");
    check_square(got, "beyond.ply");
}

#define TEXTURE_NOTE "the texture that the file names, and texture coordinates of faces, are not read"

static void looks_that_are_not_read_are_notes(void **state)
{
    (void)state;
    static const struct {
        const char *text, *note;
    } cases[] = {
        {ASCII "comment made by x, TextureFile\nelement vertex 4\n" XYZ FACE "end_header\n" CORNERS "4 0 1 2 3\n",
         NULL},
        {ASCII "comment TextureFile a.png\nelement vertex 4\n" XYZ FACE "end_header\n" CORNERS "4 0 1 2 3\n",
         TEXTURE_NOTE},
        {ASCII "element vertex 4\n" XYZ FACE "property list uchar float texcoord\nend_header\n" CORNERS "4 0 1 2 3 0\n",
         TEXTURE_NOTE},
        {ASCII "element vertex 4\n" XYZ "property uchar red\nproperty uchar green\nproperty uchar blue\n" FACE
               "end_header\n0 0 0 1 2 3\n1 0 0 1 2 3\n1 1 0 1 2 3\n0 1 0 1 2 3\n4 0 1 2 3\n",
         NULL},
        {ASCII "element vertex 4\n" XYZ FACE "property uchar red\nend_header\n" CORNERS "4 0 1 2 3 9\n", NULL},
        {ASCII "element vertex 4\n" XYZ "element face 3\nproperty list uchar int vertex_indices\nend_header\n" CORNERS
               "2 0 1\n4 0 1 2 3\n0\n",
         "faces with fewer than three corners are left out"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        mesh_import *got = read_text("looks.ply", cases[i].text);
        if (cases[i].note)
            assert_string_equal(got->note, cases[i].note);
        else
            assert_null(got->note);
        check_square(got, cases[i].text);
    }
}

static void add_number(bytes *b, double value, int size, bool big)
{
    unsigned char at[8];
    if (size == 8)
        memcpy(at, &value, 8);
    else if (size == 4)
        memcpy(at, &(float){(float)value}, 4);
    else
        at[0] = (unsigned char)value;
    const uint16_t one = 1;
    const bool turn = big == (*(const unsigned char *)&one == 1);
    for (int i = 0; i < size; i++)
        add(b, &at[turn ? size - 1 - i : i], 1);
}

static void add_index(bytes *b, uint32_t index, bool big)
{
    for (int i = 0; i < 4; i++)
        add(b, &(unsigned char){(unsigned char)(index >> 8 * (big ? 3 - i : i))}, 1);
}

/* With `first`, the faces come before the vertices. The header's lines end with `line`. */
static bytes ply_of(bool big, int size, bool first, const char *line, const double (*places)[3], uint32_t count)
{
    bytes b = {0};
    char *vertex = text_format("element vertex %u%sproperty %s x%sproperty %s y%sproperty %s z%s", count, line,
                               size == 8 ? "double" : "float", line, size == 8 ? "double" : "float", line,
                               size == 8 ? "double" : "float", line),
         *face = text_format("element face 1%sproperty list uchar int vertex_indices%s", line, line),
         *header = text_format("ply%sformat binary_%s_endian 1.0%s%s%send_header%s", line, big ? "big" : "little", line,
                               first ? face : vertex, first ? vertex : face, line);
    add_text(&b, header);
    for (int part = 0; part < 2; part++) {
        for (uint32_t i = 0; (part == 0) != first && i < count; i++)
            for (int k = 0; k < 3; k++)
                add_number(&b, places[i][k], size, big);
        if ((part == 0) == first) {
            add(&b, &(unsigned char){(unsigned char)count}, 1);
            for (uint32_t i = 0; i < count; i++)
                add_index(&b, i, big);
        }
    }
    free(vertex), free(face), free(header);
    return b;
}

static void binary_ply_files_are_read_in_every_form(void **state)
{
    (void)state;
    static const double places[4][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    static const char *const lines[] = {"\n", "\r\n", "\r"};
    for (int form = 0; form < 24; form++) {
        char *what = text_format("form %d", form);
        check_square(read_bytes("b.ply", ply_of(form & 1, form & 2 ? 8 : 4, form & 4, lines[form / 8], places, 4)),
                     what);
        free(what);
    }
    bytes mixed = ply_of(false, 4, false, "\n", places, 4); /* \r\n ends the header's last line only */
    char *end = (char *)memmem(mixed.at, mixed.size, "end_header\n", 11) + 10;
    bytes turned = {0};
    add(&turned, mixed.at, (size_t)(end - (char *)mixed.at));
    add(&turned, "\r", 1);
    add(&turned, end, mixed.size - (size_t)(end - (char *)mixed.at));
    free(mixed.at);
    check_square(read_bytes("mixed.ply", turned), "mixed line ends");
    /* an element with a list before the vertices, and a vertex with a list */
    bytes b = {0};
    add_text(&b,
             "ply\nformat binary_little_endian 1.0\nelement camera 1\nproperty float a\n"
             "property list uchar float m\nelement vertex 4\n" XYZ "property list uchar uchar n\n" FACE "end_header\n");
    add_floats(&b, (float[1]){1}, 1);
    add(&b, "\2", 1);
    add_floats(&b, (float[2]){3, 4}, 2);
    for (int i = 0; i < 4; i++) {
        add_floats(&b, (float[3]){(float)places[i][0], (float)places[i][1], (float)places[i][2]}, 3);
        add(&b, "\2ab", i % 2 ? 3 : 1);
        b.at[b.size - (i % 2 ? 3 : 1)] = i % 2 ? 2 : 0;
    }
    add(&b, "\4", 1);
    for (uint32_t i = 0; i < 4; i++)
        add_u32(&b, i);
    check_square(read_bytes("lists.ply", b), "lists");
}

/* 0.1 and 1/3 are not floats; a text has all digits, whatever type it names. */
static void ply_numbers_are_doubles(void **state)
{
    (void)state;
    static const double places[3][3] = {{0.1, 1.0 / 3, -1e-300}, {0.86602540378443864676, 2, 3}, {-7e8, 1e-9, 0}};
    for (int big = 0; big < 2; big++) {
        mesh_import *got = read_bytes("d.ply", ply_of(big, 8, false, "\n", places, 3));
        assert_triangles(got, places[0], 1, "binary");
        mesh_import_destroy(got);
    }
    char *text = text_format(ASCII "element vertex 3\n" XYZ FACE "end_header\n%.17g %.17g %.17g\n%.17g %.17g %.17g\n"
                                   "%.17g %.17g %.17g\n3 0 1 2\n",
                             places[0][0], places[0][1], places[0][2], places[1][0], places[1][1], places[1][2],
                             places[2][0], places[2][1], places[2][2]);
    mesh_import *got = read_text("d.ply", text);
    assert_triangles(got, places[0], 1, text);
    mesh_import_destroy(got);
    free(text);
}

static void normals_and_texture_coordinates_are_read(void **state)
{
    (void)state;
    static const char *const names[][2] = {{"s", "t"}, {"u", "v"}, {"texture_u", "texture_v"}};
    for (size_t i = 0; i < 3; i++) {
        char *text =
            text_format(ASCII "element vertex 3\n" XYZ "property float nx\nproperty float %s\nproperty float ny\n"
                              "property float %s\nproperty float nz\n" FACE "end_header\n"
                              "0 0 0 0 .25 0 .5 2\n1 0 0 0 1 0 0 1\n0 1 0 1 0 0 1 0\n3 0 1 2\n",
                        names[i][0], names[i][1]);
        mesh_import *got = read_text("n.ply", text);
        assert_vec3(got->mesh->normals[0], 0, 0, 1);
        assert_vec3(got->mesh->normals[2], 1, 0, 0);
        assert_true(got->mesh->uvs[0].u == 0.25 && got->mesh->uvs[0].v == 0.5 && got->mesh->uvs[2].v == 1);
        mesh_import_destroy(got);
        free(text);
    }
    /* nx alone is no normal */
    check_square(read_text("n.ply", ASCII "element vertex 4\nproperty float nx\n" XYZ FACE "end_header\n"
                                          "1 0 0 0\n0 1 0 0\n1 1 1 0\n0 0 1 0\n4 0 1 2 3\n"),
                 "nx");
}

/* 0 1 3 2 is the square; -1 begins a strip; equal corners have no triangle. */
static void triangle_strips_are_read(void **state)
{
    (void)state;
    static const double expected[18] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 1, 0, 1, 0, 0, 1, 1, 0};
    static const char *const strips[] = {"4 0 1 3 2\n", "8 0 1 3 -1 3 1 2 2\n", "7 0 1 3 3 3 1 2\n",
                                         "9 -1 -1 0 1 -1 0 1 3 2\n"};
    for (size_t i = 0; i < 4; i++) {
        char *text = text_format(ASCII "element vertex 4\n" XYZ "element tristrips 1\nproperty list int int "
                                       "vertex_indices\nend_header\n" CORNERS "%s",
                                 strips[i]);
        mesh_import *got = read_text("strip.ply", text);
        assert_triangles(got, expected, 2, strips[i]);
        mesh_import_destroy(got);
        free(text);
    }
}

static void wrong_ply_files_are_refused_with_their_place(void **state)
{
    (void)state;
    static const refusal cases[] = {
        {"no ply\n", 0, "begins with the line 'ply'"},
        {"ply\nelement vertex 3\nend_header\n", 3, "names no format"},
        {"ply\nformat klingon 1.0\n", 2, "the format is not ascii"},
        {ASCII "element vertex -3\n", 3, "the count of an element is invalid"},
        {ASCII "property float x\n", 3, "a property without an element"},
        {ASCII "element vertex 1\nproperty quad x\n", 4, "unknown type"},
        {ASCII "element vertex 1\nproperty list\n", 4, "unknown type"},
        {ASCII "element vertex 1\n" XYZ, 7, "the header has no end"},
        {ASCII FACE "end_header\n", 5, "names no vertices"},
        {ASCII "element vertex 1\nproperty float x\nend_header\n1\n", 0, "no x, y or z"},
        {ASCII "element vertex 4\n" XYZ FACE "end_header\n0 0 0\n1 0 0\n1 1 O\n", 12,
         "'O' in vertex 3 is not a finite number"},
        {ASCII "element vertex 4\n" XYZ FACE "end_header\n0 0 0\nnan", 11, "'nan' in vertex 2"},
        {ASCII "element vertex 4\n" XYZ FACE "end_header\n0 0 0\n1e10", 11,
         "vertex 2 has a number that is not finite, or not within 1e9"},
        {ASCII "element vertex 4\n" XYZ FACE "end_header\n0 0 0\n1", 11, "the file ends within vertex 2 of 4"},
        {ASCII "element vertex 4\n" XYZ FACE "end_header\n" CORNERS "4 0 1 2 4\n", 14,
         "face 1 refers to vertex 4, counted from 0, of 4"},
        {ASCII "element vertex 4\n" XYZ FACE "end_header\n" CORNERS "4 0 1 2 -1\n", 14, "vertex -1"},
        {ASCII "element vertex 4\n" XYZ FACE "end_header\n" CORNERS "4 0 1 2 1.5\n", 14, "face 1 refers"},
        {ASCII "element vertex 4\n" XYZ FACE "end_header\n" CORNERS "-1\n", 14, "a list of face 1 has the length -1"},
        {ASCII "element vertex 4\n" XYZ FACE "end_header\n" CORNERS "4 0 1 2\n", 15,
         "the file ends within face 1 of 1"},
        {ASCII FACE "element vertex 4\n" XYZ "end_header\n4 0 1 2 9\n" CORNERS, 10, "face 1 refers to vertex 9"},
        {ASCII "element vertex 4\n" XYZ "end_header\n" CORNERS, 0, "no triangles"},
    };
    refuse_texts("wrong.ply", cases, sizeof cases / sizeof *cases);
    static const double places[4][3] = {{0, 0, 0}, {1, 0, 0}, {1, (double)NAN, 0}, {0, 1, 0}};
    static const double good[3][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}};
    bytes b = ply_of(false, 4, false, "\n", places, 4); /* 175 bytes of header */
    const size_t header = b.size - 4 * 12 - 17;
    char words[80];
    snprintf(words, sizeof words, "byte %zu: vertex 3 has a number that is not finite", header + 2 * 12 + 4);
    refuse_at("nan.ply", b.at, b.size, 0, words);
    snprintf(words, sizeof words, "byte %zu: the file ends within vertex 4 of 4", header + 47);
    refuse_at("cut.ply", b.at, header + 47, 0, words);
    free(b.at);
    b = ply_of(true, 8, false, "\n", good, 3);
    snprintf(words, sizeof words, "byte %zu: the file ends within face 1 of 1", b.size - 4);
    refuse_at("cut.ply", b.at, b.size - 1, 0, words);
    b.at[b.size - 1] = 3;
    snprintf(words, sizeof words, "byte %zu: face 1 refers to vertex 3, counted from 0, of 3", b.size);
    refuse_at("index.ply", b.at, b.size, 0, words);
    free(b.at);
}

/* --- STL --- */

#define FACET(a, b, c) \
    " facet normal 0 0 1\n  outer loop\n   vertex " a "\n   vertex " b "\n   vertex " c "\n  endloop\n endfacet\n"
#define FIRST FACET("0 0 0", "1 0 0", "1 1 0")
#define SECOND FACET("0 0 0", "1 1 0", "0 1 0")

static void stl_texts_are_read_in_every_form(void **state)
{
    (void)state;
    static const char *const texts[] = {
        "solid a\n" FIRST SECOND "endsolid a\n",
        "solid\n" FIRST SECOND "endsolid",
        "solid\n" FIRST FACET("-0 0 -0.0", "1 1 0", "-0 1 0") "endsolid\n", /* -0 and 0 are one vertex */
        " \n\tsolid a b c\n" FIRST SECOND "endsolid a b c\n",
        "\xef\xbb\xbfsolid a\n" FIRST SECOND "endsolid a\n",
        "SOLID a\n FACET NORMAL 0 0 1\n OUTER LOOP\n VERTEX 0 0 0\n VERTEX 1 0 0\n VERTEX 1 1 0\n ENDLOOP\n ENDFACET\n"
        " Facet Normal 0 0 1\n Outer Loop\n Vertex 0 0 0\n Vertex 1 1 0\n Vertex 0 1 0\n EndLoop\n "
        "EndFacet\nENDSOLID\n",
        "solid a\n" FIRST "endsolid a\nsolid b\n" SECOND "endsolid b\n", /* two solids */
        "solid a\nfacet normal nan nan -nan(ind) outer loop vertex 0 0 0 vertex 1 0 0 vertex 1 1 0 endloop "
        "endfacet\n" SECOND "endsolid\n",
        "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 1 1 0\nvertex 0 1 0\nendloop\n"
        "endfacet\nendsolid a\n", /* four corners */
    };
    check_squares("form.stl", texts, sizeof texts / sizeof *texts);
    mesh_import *got = read_text("d.stl", "solid\n" FACET("0.1 .3 -1e-300", "1 0 0", "0 1 0") "endsolid\n");
    assert_vec3(corner(got->mesh, 0, 0), 0.1, 0.3, -1e-300);
    mesh_import_destroy(got);
}

/* `extra` bytes after the facets. */
static bytes square_stl(const char *begin, size_t extra)
{
    bytes b = {0};
    char header[80] = {0};
    memcpy(header, begin, strlen(begin));
    add(&b, header, sizeof header);
    add_u32(&b, 2);
    for (int f = 0; f < 2; f++) {
        add_floats(&b, (float[3]){0, 0, 1}, 3);
        for (int k = 0; k < 9; k++)
            add_floats(&b, (float[1]){(float)square[9 * f + k]}, 1);
        add(&b, "\1\2", 2);
    }
    for (; extra > 0; extra--)
        add(&b, "\n", 1);
    return b;
}

static void binary_stl_files_are_read_in_every_form(void **state)
{
    (void)state;
    check_square(read_bytes("b.stl", square_stl("", 0)), "binary");
    check_square(read_bytes("b.stl", square_stl("xxxx", 1)), "one byte more");
    check_square(read_bytes("b.stl", square_stl("xxxx", 49)), "49 bytes more");
    check_square(read_bytes("b.stl", square_stl("solid of a binary file", 0)), "solid");
    check_square(read_bytes("b.stl", square_stl("solid of a binary file", 1)), "solid, one byte more");
}

static void wrong_stl_files_are_refused_with_their_place(void **state)
{
    (void)state;
    static const refusal cases[] = {
        {"this is not a mesh at all\n", 0, "it does not begin with 'solid'"},
        {"solid a\n", 2, "the text ends where 'facet' or 'endsolid' is expected"},
        {"solid a\nendsolid a\n", 0, "no triangles"},
        {"solid a\n" FIRST, 9, "the text ends where 'facet' or 'endsolid'"},
        {"solid a\n" FIRST "facets\n", 9, "'facets' where 'facet' or 'endsolid' is expected"},
        {"solid a\n" FIRST "endsolid\n" SECOND, 10, "'facet' where 'solid' is expected"},
        {"solid a\nfacet 0 0 1\n", 2, "'0' where 'normal' is expected"},
        {"solid a\n" FACET("0 0 0", "1 0 x", "1 1 0"), 5, "'x' where a finite number within 1e9 is expected"},
        {"solid a\n" FACET("0 0 0", "1 0", "1 1 0"), 6, "'vertex' where a finite number"},
        {"solid a\n" FACET("0 0 0", "inf 0 0", "1 1 0"), 5, "'inf'"},
        {"solid a\n" FACET("0 0 0", "1e30 0 0", "1 1 0"), 5, "'1e30'"},
        {"solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nendloop\n", 6,
         "'endloop' where 'vertex'"},
        {"solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1", 5, "the text ends where a finite number"},
    };
    refuse_texts("wrong.stl", cases, sizeof cases / sizeof *cases);
    bytes b = square_stl("", 0);
    refuse_at("cut.stl", b.at, 140, 0, "byte 140: the file ends within facet 2 of 2");
    refuse_at("short.stl", b.at, 83, 0, "shorter than a binary file's 84 bytes");
    memcpy(b.at + 84 + 50 + 12 + 16, "\0\0\xc0\x7f", 4);
    refuse_at("nan.stl", b.at, b.size, 0, "byte 162: facet 2 has a coordinate that is not a finite number");
    free(b.at);
    b = square_stl("", 50);
    refuse_at("more.stl", b.at, b.size, 0, "byte 80: the header counts 2 facets, but the file has 3");
    free(b.at);
}

/* --- the formats together --- */

/* A closed mesh of numbers that are not floats is the same in each format. */
static void formats_give_the_same_mesh(void **state)
{
    (void)state;
    bytes obj = {0}, ply = {0}, stl = {0};
    double places[4][3];
    add_text(&ply,
             ASCII "element vertex 4\n" XYZ "element face 4\nproperty list uchar int vertex_indices\nend_header\n");
    add_text(&stl, "solid\n");
    for (int i = 0; i < 4; i++) {
        for (int k = 0; k < 3; k++)
            places[i][k] = (double)corners[i][k] + 1.0 / (7 + 3 * i + k);
        char line[200];
        add(&obj, line,
            (size_t)snprintf(line, sizeof line, "v %.17g %.17g %.17g\n", places[i][0], places[i][1], places[i][2]));
        add(&ply, line + 2, strlen(line) - 2);
    }
    double expected[36], *to = expected;
    for (int f = 0; f < 4; f++) {
        char line[400];
        add(&obj, line,
            (size_t)snprintf(line, sizeof line, "f %d %d %d\n", faces[f][0] + 1, faces[f][1] + 1, faces[f][2] + 1));
        add(&ply, line, (size_t)snprintf(line, sizeof line, "3 %d %d %d\n", faces[f][0], faces[f][1], faces[f][2]));
        add_text(&stl, "facet normal 0 0 0\nouter loop\n");
        for (int k = 0; k < 3; k++, to += 3) {
            const double *p = places[faces[f][k]];
            memcpy(to, p, 3 * sizeof *p);
            add(&stl, line, (size_t)snprintf(line, sizeof line, "vertex %.17g %.17g %.17g\n", p[0], p[1], p[2]));
        }
        add_text(&stl, "endloop\nendfacet\n");
    }
    add_text(&stl, "endsolid\n");
    mesh_import *got[] = {read_bytes("same.obj", obj), read_bytes("same.ply", ply), read_bytes("same.stl", stl)};
    for (int i = 0; i < 3; i++) {
        assert_triangles(got[i], expected, 4, "the same mesh");
        assert_true(got[i]->mesh->closed && !got[i]->mesh->single && got[i]->mesh->vertex_count == 4);
        mesh_import_destroy(got[i]);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(ply_texts_are_read_in_every_form),
        cmocka_unit_test(what_a_line_has_beyond_the_header_is_left_out),
        cmocka_unit_test(looks_that_are_not_read_are_notes),
        cmocka_unit_test(binary_ply_files_are_read_in_every_form),
        cmocka_unit_test(ply_numbers_are_doubles),
        cmocka_unit_test(normals_and_texture_coordinates_are_read),
        cmocka_unit_test(triangle_strips_are_read),
        cmocka_unit_test(wrong_ply_files_are_refused_with_their_place),
        cmocka_unit_test(stl_texts_are_read_in_every_form),
        cmocka_unit_test(binary_stl_files_are_read_in_every_form),
        cmocka_unit_test(wrong_stl_files_are_refused_with_their_place),
        cmocka_unit_test(formats_give_the_same_mesh),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
