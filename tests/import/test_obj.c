/* Tests of the reader of OBJ files and their material libraries. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "base/random.h"
#include "import/mesh_wire.h"
#include "mesh_read.h"
#include <math.h>
#include <sched.h>
#include <stdbool.h>
#include <sys/wait.h>

#define THREE "v 0 0 0\nv 1 0 0\nv 0 1 0\n"
#define SQUARE "v 0 0 0\nv 1 0 0\nv 1 1 0.5\nv 0 1 0\n"

static void equal_vertices_are_joined(void **state)
{
    (void)state;
    mesh_import *got = read_text("join.obj", SQUARE "v 1 1 0.5\nv -0 -0.0 -0\nf 1 2 3\nf 6 5 4\n");
    assert_int_equal(got->mesh->vertex_count, 4);
    assert_int_equal(got->mesh->triangles[1].corner[0], got->mesh->triangles[0].corner[0]);
    assert_int_equal(got->mesh->triangles[1].corner[1], got->mesh->triangles[0].corner[2]);
    mesh_import_destroy(got);
}

/* Each is one triangle, (0 0 0) (1 0 0) (0 1 0). */
static void a_triangle_is_read_in_every_form(void **state)
{
    (void)state;
    static const double expected[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    static const char *const texts[] = {
        THREE "f 1 2 3\n",
        THREE "f 1 2 3", /* no end of the last line */
        "\xef\xbb\xbf" THREE "f 1 2 3\n",
        "  v 0 0 0\n\tv 1 0 0\n v 0 1 0\n f 1 2 3\n",
        THREE "f 1 2 3 # comment\n",
        "v 0 0 0 # comment\nv 1 0 0#comment\nv 0 1 0\nf 1 2 3#\n",
        "v 0 0 0\r\nv 1 0 0\r\nv 0 1 0\r\nf 1 2 3\r\n",
        "v 0 0 0\rv 1 0 0\rv 0 1 0\rf 1 2 3\r",
        "v 0 0 0\rv 1 0 0\rv 0 1 0\rf 1 2 3",
        "v  0\t0  0 \nv 1 0 0\t\nv 0 1 0\nf  1\t2 3 \n",
        "# comment\n\n\n" THREE "\n# f 1 2 3 \\\nf 1 2 3\n",
        "f 1 2 3\n" THREE, /* vertices after their use */
        THREE "f -3 -2 -1\n",
        "v 0 0 0\nf -1 2 3\nv 1 0 0\nv 0 1 0\n",
        THREE "f 1 \\\n2 \\\r\n3\n",
        "v 0 \\\n0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3 \\\n",
        "v 0 0 0 1\nv 1 0 0 1\nv 0 1 0 0.5\nf 1 2 3\n", /* weights: x, y, z are as written */
        "v 0 0 0 nan nan nan\nv 1 0 0 red\nv 0 1 0 \\\n1 2 # 3\nf 1 2 3\n",
        "v -0 0.0 .0\nv +1. 0e5 0\nv 0 10e-1 -0e-9\nf 1 2 3\n",
        "v 0 0 0\n" THREE "f 2 3 4\n",
        THREE "vt 0\nvt 1 1 0\nvn 0 0 1\nf 1/1/1 2/2/1 3/1/1\n",
        THREE "vt 0 0\nvn 0 0 1\nf 1//1 2/1 3\n",
        THREE "f 1/ 2/ 3/\n",
        THREE "f 1// 2// 3//\n",
        THREE "vt 0 0\nf 1/-1/ 2/-1 3\n",
        THREE "l 1 2\np 1\nf 1 2 3\ng a b\no c\ns off\nvp 1 2\ncstype bezier\nunknown x \\\nf 1 1 1\n",
        "mtllib\n" THREE "usemtl\nf 1 2 3\n",
    };
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        mesh_import *got = read_text("form.obj", texts[i]);
        assert_triangles(got, expected, 1, texts[i]);
        assert_null(got->note);
        mesh_import_destroy(got);
    }
}

static void numbers_are_the_nearest_doubles(void **state)
{
    (void)state;
    static const char *const numbers[] = {".5",
                                          "007.50",
                                          "0.1",
                                          "1e-7",
                                          "16777217",
                                          "0.3333333333333333333333",
                                          "0.86602540378443864676",
                                          "123456.789012345678",
                                          "9007199254740993e-9",
                                          "0.00000000000000000000000000012345678901234567890",
                                          "1e-30",
                                          "4.9e-324",
                                          "2.2250738585072011e-308",
                                          "999999999.99999999",
                                          "1.7976931348623157e-300",
                                          "100000000000000000000000000000000e-25"};
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++) {
        char *text = text_format("v %s 1 2\nv 1 -%s 2\nv 0 1 %s\nf 1 2 3\n", numbers[i], numbers[i], numbers[i]);
        const double x = strtod(numbers[i], NULL);
        mesh_import *got = read_text("number.obj", text);
        assert_triangles(got, (double[9]){x, 1, 2, 1, -x, 2, 0, 1, x}, 1, text);
        mesh_import_destroy(got);
        free(text);
    }
}

static void what_is_wrong_is_refused_with_its_line(void **state)
{
    (void)state;
    static const refusal cases[] = {
        {THREE "f 1 2 5\n", 4, "a face refers to vertex 5, but the file has 3"},
        {THREE "\n\nf 1 2 3\nf -4 -2 -1\n", 7, "a face refers to vertex 0, but the file has 3"},
        {THREE "f 1 2 0\n", 4, "a corner of a face is invalid: '0'"},
        {THREE "f 1 2 3x\n", 4, "a corner of a face is invalid: '3x'"},
        {THREE "f 1 2 18446744073709551617\n", 4, "a corner of a face is invalid"},
        {THREE "f 1 2 4294967299\n", 4, "a corner of a face is invalid"},
        {"v 0 0\n" THREE, 1, "fewer than three numbers"},
        {"\rv 0 0 0\rv 1 0 O\r", 3, "not a finite number within 1e9: 'O'"},
        {"v 0 0 \\\n0,5\n", 2, "'0,5'"},
        {"v 0 0 nan\n", 1, "'nan'"},
        {"v 0 0 -inf\n", 1, "'-inf'"},
        {"v 0 0 1e999\n", 1, "'1e999'"},
        {"v 0 0 1e12\n", 1, "within 1e9: '1e12'"},
        {"v 0 0 1e\n", 1, "'1e'"},
        {"v 0 0 .\n", 1, "'.'"},
        {"v 0 0 --1\n", 1, "'--1'"},
        {"v 0 0 0x10\n", 1, "'0x10'"},
        {"vn 0 1\n", 1, "a normal has fewer than three numbers"},
        {"vn 0 nan 1\n", 1, "a normal has a word"},
        {"vt\n", 1, "a texture coordinate has no numbers"},
        {"vt 0 one\n", 1, "'one'"},
        {SQUARE, 0, "the file has no triangles"},
        {"hello, this is no mesh\n", 0, "the file has no triangles"},
        {"mtllib bad.mtl\n" THREE "f 1 2 3\n", 1, "needs the file 'bad.mtl', where in line 3 Kd has 'x'"},
    };
    put_text("bad.mtl", "Kd y\r\nnewmtl a\rKd x 0 0\n");
    refuse_texts("wrong.obj", cases, sizeof cases / sizeof *cases);
}

/* --- polygons --- */

/* The text of a prism on a polygon in the plane y = 0; the polygon runs counterclockwise when seen from above in a
 * right-handed world. */
static char *prism(const double (*at)[2], int n)
{
    char *text = strdup("");
    for (int side = 0; side < 2; side++)
        for (int i = 0; i < n; i++) {
            char *more = text_format("%sv %.17g %d %.17g\n", text, at[i][0], side, at[i][1]);
            free(text);
            text = more;
        }
    for (int side = 0; side < 2; side++) {
        char *face = strdup("f");
        for (int i = 0; i < n; i++) {
            char *more = text_format("%s %d", face, side ? n + 1 + i : n - i);
            free(face);
            face = more;
        }
        char *more = text_format("%s%s\n", text, face);
        free(face);
        free(text);
        text = more;
    }
    for (int i = 0; i < n; i++) {
        const int j = (i + 1) % n;
        char *more = text_format("%sf %d %d %d %d\n", text, i + 1, j + 1, n + 1 + j, n + 1 + i);
        free(text);
        text = more;
    }
    return text;
}

static double area_of(const double (*at)[2], int n)
{
    double sum = 0;
    for (int i = 0; i < n; i++)
        sum += at[i][0] * at[(i + 1) % n][1] - at[(i + 1) % n][0] * at[i][1];
    return fabs(sum) / 2;
}

static double perimeter_of(const double (*at)[2], int n)
{
    double sum = 0;
    for (int i = 0; i < n; i++)
        sum += hypot(at[(i + 1) % n][0] - at[i][0], at[(i + 1) % n][1] - at[i][1]);
    return sum;
}

static void check_prism(const double (*at)[2], int n, const char *what)
{
    char *text = prism(at, n);
    mesh_import *got = read_text("prism.obj", text);
    const double area = area_of(at, n), surface = 2 * area + perimeter_of(at, n);
    if (got->mesh->triangle_count != (size_t)(4 * n - 4) || !got->mesh->closed ||
        fabs(mesh_volume(got->mesh) - area) > 1e-12 || fabs(mesh_area(got->mesh) - surface) > 1e-12)
        fail_msg("%s: %zu triangles, closed %d, volume %.15g for %.15g, area %.15g for %.15g", what,
                 got->mesh->triangle_count, got->mesh->closed, mesh_volume(got->mesh), area, mesh_area(got->mesh),
                 surface);
    mesh_import_destroy(got);
    free(text);
}

/* A wrong division would cover more area than the polygon has. */
static void concave_polygons_are_divided_within_themselves(void **state)
{
    (void)state;
    static const double dart[][2] = {{0, 0}, {0.5, 0.25}, {1, 0}, {0.5, 1}},
                        dart_at_0[][2] = {{0.5, 0.25}, {1, 0}, {0.5, 1}, {0, 0}},
                        letter[][2] = {{0, 0},       {1, 0},       {1, 0.25}, {0.25, 0.25}, {0.25, 0.5}, {0.75, 0.5},
                                       {0.75, 0.75}, {0.25, 0.75}, {0.25, 1}, {1, 1},       {1, 1.25},   {0, 1.25}},
                        straight[][2] = {{0, 0}, {0.25, 0}, {0.5, 0}, {0.75, 0}, {1, 0}, {0.5, 1}},
                        straight_quad[][2] = {{0, 0}, {0.5, 0}, {1, 0}, {0, 1}},
                        keyhole[][2] = {{0, 0},       {1, 0},       {1, 1},       {0, 1},
                                        {0, 0.5},     {0.25, 0.5},  {0.25, 0.75}, {0.75, 0.75},
                                        {0.75, 0.25}, {0.25, 0.25}, {0.25, 0.4},  {0, 0.4}};
    check_prism(dart, 4, "dart");
    check_prism(dart_at_0, 4, "dart from its notch");
    check_prism(letter, 12, "E");
    check_prism(straight, 6, "corners on an edge");
    check_prism(straight_quad, 4, "a corner on an edge");
    check_prism(keyhole, 12, "C");
    for (int n = 5; n <= 200; n += 39) {
        double star[200][2], round[200][2];
        for (int i = 0; i < n; i++) {
            const double angle = 2 * M_PI * i / n, radius = i % 2 ? 0.3 : 1;
            star[i][0] = radius * cos(angle), star[i][1] = radius * sin(angle);
            round[i][0] = cos(angle), round[i][1] = sin(angle);
        }
        check_prism((const double(*)[2])star, n, "star");
        check_prism((const double(*)[2])round, n, "round");
    }
}

/* Far from the origin, and not simple: still n - 2 triangles. */
static void unusual_polygons_keep_their_triangles(void **state)
{
    (void)state;
    mesh_import *got =
        read_text("bow.obj", "v 0 0 0\nv 1 1 0\nv 1 0 0\nv 0 1 0\nv 0 0 2\nf 1 2 3 4\nf 1 2 3 4 5 1 3\n");
    assert_int_equal(got->mesh->triangle_count, 2 + 5);
    mesh_import_destroy(got);
    got = read_text("far.obj",
                    "v 1e8 5 1e8\nv 100000001 5 1e8\nv 100000000.25 5 100000000.25\nv 1e8 5 100000001\nf 1 2 3 4\n");
    assert_true(fabs(mesh_area(got->mesh) - 0.25) < 1e-7);
    mesh_import_destroy(got);
}

/* --- materials --- */

static const imported_material *material_of(const mesh_import *got, size_t triangle)
{
    return &got->materials[got->mesh->slots[triangle]];
}

static void several_libraries_are_read(void **state)
{
    (void)state;
    static const char *const statements[] = {"mtllib a.mtl b.mtl\n", "mtllib a.mtl\nmtllib  b.mtl \n",
                                             "mtllib b.mtl\nmtllib a b.mtl\nmtllib a.mtl\n"};
    put_text("a.mtl", "newmtl a\nKd 1 0 0\n");
    put_text("b.mtl", "newmtl b\nKd 0 0.3 0\n");
    put_text("a b.mtl", "newmtl c\nKd 0 0 1\n");
    for (size_t i = 0; i < 3; i++) {
        char *text =
            text_format(SQUARE "f 1 2 3\nusemtl b\nf 2 3 4\nusemtl a\nf 1 3 4\nusemtl b\nf 1 2 4\n%s", statements[i]);
        mesh_import *got = read_text("two.obj", text);
        assert_int_equal(got->material_count, 3);
        assert_false(material_of(got, 0)->given);
        assert_true(material_of(got, 1)->color[1] == 0.3 && material_of(got, 2)->color[0] == 1);
        assert_ptr_equal(material_of(got, 3), material_of(got, 1));
        assert_null(got->note);
        mesh_import_destroy(got);
        free(text);
    }
}

static void statements_of_a_library_are_read_or_ignored(void **state)
{
    (void)state;
    put_text("my paint.png", "an image");
    put_text("forms.mtl",
             "\xef\xbb\xbf"
             "Kd 9 9 9\r\nnewmtl m\r\nkd 0.1 0.2 0.3 # red\r\naniso 0.5\r\nPr x\r\nKe .5\r\nTr 0.25\r\n"
             "map_Kd -blendu on -s 1 1 1 -mm 0 1 -clamp on my paint.png\r\nmap_Ks nowhere.png\r\n"
             "newmtl n\r\nKd spectral a.rfl\r\nKa xyz 1 2 3\r\nd -halo 0.5\r\nNs\r\nnewmtl m\r\nKd 9 9 9\r\n");
    mesh_import *got = read_text("forms.obj", "mtllib forms.mtl\n" SQUARE "usemtl m\nf 1 2 3\nusemtl n\nf 2 3 4\n");
    const imported_material *m = material_of(got, 0), *n = material_of(got, 1);
    assert_true(m->color[0] == 0.1 && m->color[1] == 0.2 && m->color[2] == 0.3 && m->emissive[2] == 0.5);
    assert_true(m->opacity == 0.75 && n->opacity == 0.5 && n->color[0] == 0.6 && n->ambient[0] == 0 && m->given);
    char *img = in_folder("my paint.png");
    assert_string_equal(m->texture.path, img);
    assert_string_equal(got->note, "the option -s of map_Kd in 'forms.mtl' is ignored; the option -mm of map_Kd in "
                                   "'forms.mtl' is ignored");
    free(img);
    mesh_import_destroy(got);
}

static void what_faces_and_vertices_lose_is_a_note(void **state)
{
    (void)state;
    static const char narrow[] = "faces with fewer than three corners are left out";
    static const struct {
        const char *text, *note;
        bool normals, uvs;
    } cases[] = {
        {THREE "f 1/1 2/2 3/-1\n", "faces refer to texture coordinates that the file lacks: these are left out", false,
         false},
        {THREE "f 1//-1 2//1 3//1\n", "faces refer to normals that the file lacks: these are left out", false, false},
        {THREE "vn 0 0 1\nvt 0 1\nf 1/1/1 2/2/1 3/1/3\n",
         "faces refer to texture coordinates that the file lacks: these are left out; faces refer to normals that the "
         "file lacks: these are left out",
         true, true},
        {THREE "f 1 2 3\nf\n", narrow, false, false},
        {THREE "f 1\nf 1 2 3\n", narrow, false, false},
        {THREE "f 1 2 #3\nf 1 2 3\nl 1 2\n", narrow, false, false}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        mesh_import *got = read_text("lacking.obj", cases[i].text);
        assert_triangles(got, (const double[9]){0, 0, 0, 1, 0, 0, 0, 1, 0}, 1, cases[i].text);
        assert_string_equal(got->note, cases[i].note);
        assert_true((got->mesh->normals != NULL) == cases[i].normals && (got->mesh->uvs != NULL) == cases[i].uvs);
        mesh_import_destroy(got);
    }
}

static void map_d_blends_if_it_is_the_image_of_map_Kd(void **state)
{
    (void)state;
    put_text("leaf.png", "an image");
    put_text("leaf.mtl", "newmtl a\nmap_d -imfchan m leaf.png\nd 0.5\nmap_Kd leaf.png\n"
                         "newmtl b\nmap_Kd leaf.png\nmap_d other.png\nnewmtl c\nmap_Kd leaf.png\n");
    mesh_import *got =
        read_text("leaf.obj", "mtllib leaf.mtl\n" SQUARE "usemtl a\nf 1 2 3\nusemtl b\nf 2 3 4\nusemtl c\nf 1 2 4\n");
    assert_int_equal(material_of(got, 0)->alpha_mode, MESH_WIRE_ALPHA_BLEND);
    assert_true(material_of(got, 0)->opacity == 0.5);
    assert_int_equal(material_of(got, 1)->alpha_mode, MESH_WIRE_ALPHA_OPAQUE);
    assert_int_equal(material_of(got, 2)->alpha_mode, MESH_WIRE_ALPHA_OPAQUE);
    assert_string_equal(got->note, "map_d of the material 'b' is not read: only the alpha of the image of map_Kd is");
    mesh_import_destroy(got);
}

/* Of materials with an image, in one library. */
static void Tr_1_of_an_image_is_opaque(void **state)
{
    (void)state;
    static const struct {
        const char *statements;
        double opacity;
    } cases[] = {{"map_Kd leaf.png\nTr 1.000000\n", 1}, {"Tr 1\nmap_Kd leaf.png\n", 1},
                 {"map_Kd leaf.png\nTr 0.75\n", 0.25},  {"Tr 1\n", 0},
                 {"map_Kd leaf.png\nd 0\nTr 1\n", 0},   {"map_Kd leaf.png\nd 0\n", 0}};
    put_text("leaf.png", "an image");
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char *text = text_format("newmtl a\nd 1\nnewmtl m\n%snewmtl b\nd 1\n", cases[i].statements);
        put_text("tr.mtl", text);
        free(text);
        mesh_import *got = read_text("tr.obj", "mtllib tr.mtl\n" THREE "usemtl m\nf 1 2 3\n");
        assert_true(got->materials[0].opacity == cases[i].opacity);
        if (i < 2)
            assert_string_equal(got->note, "Tr 1 of material 'm' is taken for opaque, as some programs mean it");
        else
            assert_null(got->note);
        mesh_import_destroy(got);
    }
}

static void missing_libraries_and_images_are_notes(void **state)
{
    (void)state;
    put_text("image.mtl", "newmtl m\nKd 1 0 0\nmap_Kd nowhere.png\n");
    static const char *const texts[][2] = {
        {"mtllib nowhere.mtl\n", "the material library 'nowhere.mtl' does not exist: its materials are grey"},
        {"mtllib image.mtl no.mtl\n", "the material library 'no.mtl' does not exist: its materials are grey; the image "
                                      "'nowhere.png' of material 'm' does not exist: the material is without it"},
        {"mtllib /nowhere/at/all.mtl\n",
         "the material library '/nowhere/at/all.mtl' does not exist: its materials are grey"}};
    for (size_t i = 0; i < 3; i++) {
        char *text = text_format("%s" THREE "usemtl m\nf 1 2 3\n", texts[i][0]);
        mesh_import *got = read_text("missing.obj", text);
        assert_int_equal(got->material_count, 1);
        assert_string_equal(got->materials[0].name, "m");
        assert_null(got->materials[0].texture.path);
        assert_true(got->materials[0].color[1] == (i == 1 ? 0 : 0.6));
        assert_string_equal(got->note, texts[i][1]);
        mesh_import_destroy(got);
        free(text);
    }
}

/* --- large files --- */

static uint32_t draw(uint32_t *counter, uint32_t below)
{
    return random_at(1, (*counter)++, 0, 0, 0).word[0] % below;
}

static void add_line(bytes *b, const char *format, ...)
{
    char line[200];
    va_list list;
    va_start(list, format);
    add(b, line, (size_t)vsnprintf(line, sizeof line, format, list));
    va_end(list);
}

/* Triangles of random places, and what they must be. Few of the places are new, so that vertices are joined. */
typedef struct random_mesh {
    bytes text, expected;
    size_t triangles;
} random_mesh;

static random_mesh random_file(uint32_t seed, size_t size)
{
    random_mesh r = {.triangles = 0};
    bytes places = {NULL, 0, 0};
    uint32_t at = seed * 100000000, count = 0;
    while (r.text.size < size || count < 3) {
        if (count < 3 || draw(&at, 3) == 0) {
            double p[3];
            for (int k = 0; k < 3; k++)
                p[k] = draw(&at, 4) ? draw(&at, 20) : ((double)draw(&at, 2000001) - 1000000) / 3000;
            add(&places, p, sizeof p);
            add_line(&r.text, "v %.17g %.17g %.17g\n", p[0], p[1], p[2]);
            count++;
        }
        add_line(&r.text, draw(&at, 9) ? "f" : "# \\\ng x\nf");
        for (int k = 0; k < 3; k++) {
            const uint32_t back = draw(&at, count < 50 ? count : 50);
            switch (draw(&at, 8)) {
            case 0: add_line(&r.text, " \\\n-%u", back + 1); break;
            case 1:
            case 2: add_line(&r.text, "\t-%u", back + 1); break;
            default: add_line(&r.text, " %u", count - back);
            }
            add(&r.expected, places.at + (count - 1 - back) * 3 * sizeof(double), 3 * sizeof(double));
        }
        add_text(&r.text, "\n");
        r.triangles++;
    }
    free(places.at);
    return r;
}

static void large_files_are_read_as_written(void **state)
{
    (void)state;
    for (uint32_t seed = 0; seed < 6; seed++) {
        random_mesh r = random_file(seed, seed < 4 ? 3000 : 2500000);
        char *what = text_format("seed %u", seed);
        put("random.obj", r.text.at, r.text.size);
        mesh_import *got = read_mesh("random.obj");
        assert_triangles(got, (const double *)(const void *)r.expected.at, r.triangles, what);
        mesh_import_destroy(got);
        free(what);
        free(r.text.at);
        free(r.expected.at);
    }
}

/* Two of three line ends are continued, so that one of these three files would be divided at such a line end. */
static void files_are_not_divided_within_a_continued_line(void **state)
{
    (void)state;
    enum { COUNT = 200000 };
    static const char *const beginnings[] = {"", "#234\n", "#2345678\n"};
    for (int i = 0; i < 3; i++) {
        bytes b = {NULL, 0, 0};
        add_text(&b, beginnings[i]);
        add_text(&b, THREE);
        for (int k = 0; k < COUNT; k++)
            add_text(&b, "f 1 \\\n2 \\\n3\n");
        mesh_import *got = read_bytes("continued.obj", b);
        assert_int_equal(got->mesh->triangle_count, COUNT);
        mesh_import_destroy(got);
    }
}

/* The output of the import program with these options; *code: its exit status. */
static bytes import(const char *options, const char *name, int *code)
{
    char *path = in_folder(name);
    char *line = text_format("\"$CUVETTE_IMPORT\" %s '%s' 2>/dev/null", options, path);
    bytes got = {NULL, 0, 0};
    char buffer[65536];
    FILE *from = popen(line, "r");
    assert_non_null(from);
    for (size_t count; (count = fread(buffer, 1, sizeof buffer, from)) > 0;)
        add(&got, buffer, count);
    const int state = pclose(from);
    *code = WIFEXITED(state) ? WEXITSTATUS(state) : -1;
    free(line);
    free(path);
    return got;
}

/* A part of the file for each processor: the same result with one, also of a file that is wrong in its last line. */
static void processors_do_not_matter(void **state)
{
    (void)state;
    cpu_set_t before, one;
    int code_many, code_one;
    random_mesh r = random_file(30, 4000000);
    put("parts.obj", r.text.at, r.text.size);
    bytes many = import("", "parts.obj", &code_many);
    assert_int_equal(sched_getaffinity(0, sizeof before, &before), 0);
    CPU_ZERO(&one);
    for (size_t cpu = 0; cpu < CPU_SETSIZE && CPU_COUNT(&one) == 0; cpu++)
        if (CPU_ISSET(cpu, &before))
            CPU_SET(cpu, &one);
    assert_int_equal(sched_setaffinity(0, sizeof one, &one), 0);
    bytes alone = import("", "parts.obj", &code_one);
    assert_int_equal(sched_setaffinity(0, sizeof before, &before), 0);
    assert_int_equal(code_many, 0);
    assert_int_equal(code_one, 0);
    assert_int_equal(many.size, alone.size);
    assert_memory_equal(many.at, alone.at, many.size);
    long lines = 1;
    for (size_t i = 0; i < r.text.size; i++)
        lines += r.text.at[i] == '\n';
    add_text(&r.text, "f 1 2 999999999\n");
    refuse_at("parts.obj", r.text.at, r.text.size, lines, "'999999999'");
    r.text.size -= strlen("999999999\n");
    add_text(&r.text, "9999999\n");
    refuse_at("parts.obj", r.text.at, r.text.size, lines, "vertex 9999999, but");
    free(r.text.at);
    free(r.expected.at);
    free(many.at);
    free(alone.at);
}

static void limits_hold(void **state)
{
    (void)state;
    put_text("limit.obj", SQUARE "f 1 2 3\nf 1 3 4\n");
    static const char *const options[] = {"--triangles=1", "--vertices=3", "--triangles=2 --vertices=4"};
    for (int i = 0; i < 3; i++) {
        int code;
        bytes got = import(options[i], "limit.obj", &code);
        assert_int_equal(code, i < 2 ? 2 : 0);
        assert_int_equal(got.size > 0, i == 2);
        free(got.at);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_triangle_is_read_in_every_form),
        cmocka_unit_test(equal_vertices_are_joined),
        cmocka_unit_test(numbers_are_the_nearest_doubles),
        cmocka_unit_test(what_is_wrong_is_refused_with_its_line),
        cmocka_unit_test(concave_polygons_are_divided_within_themselves),
        cmocka_unit_test(unusual_polygons_keep_their_triangles),
        cmocka_unit_test(several_libraries_are_read),
        cmocka_unit_test(statements_of_a_library_are_read_or_ignored),
        cmocka_unit_test(what_faces_and_vertices_lose_is_a_note),
        cmocka_unit_test(map_d_blends_if_it_is_the_image_of_map_Kd),
        cmocka_unit_test(Tr_1_of_an_image_is_opaque),
        cmocka_unit_test(missing_libraries_and_images_are_notes),
        cmocka_unit_test(large_files_are_read_as_written),
        cmocka_unit_test(files_are_not_divided_within_a_continued_line),
        cmocka_unit_test(processors_do_not_matter),
        cmocka_unit_test(limits_hold),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
