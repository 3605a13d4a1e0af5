/* Tests of the readers of optical data, against the formulas of their formats and numbers written by hand, and of media
 * in scenes that come from such files. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <cmocka.h>

#include "base/file.h"
#include "optics/media.h"
#include "render_fixture.h"
#include "scene/data/optical_files.h"
#include "scene/file/write.h"
#include "scene/model/edit/edit.h"
#include "scene/model/medium.h"
#include "scene/model/params.h"
#include "scene/model/scene.h"
#include "scene/package/package.h"

#define COUNT(a) (sizeof(a) / sizeof((a)[0]))

static void assert_near(double a, double b, double tolerance)
{
    if (!(fabs(a - b) <= tolerance))
        fail_msg("%.17g is not %.17g within %g", a, b, tolerance);
}

static const optical_data *parsed(const char *name, const char *text, const char *glass, const char *column)
{
    const optical_data *d;
    diagnostic why = {.what = ""};
    if (optical_file_parse(name, text, strlen(text), &(optical_file_choice){glass, column, 1.0}, &d, &why) != STATUS_OK)
        fail_msg("%s: %s", name, why.what);
    return d;
}

static void refused(const char *name, const char *text, const char *glass, const char *column, long line,
                    const char *what)
{
    const optical_data *d;
    diagnostic why = {.what = ""};
    assert_int_equal(optical_file_parse(name, text, strlen(text), &(optical_file_choice){glass, column, 1.0}, &d, &why),
                     STATUS_BAD_INPUT);
    assert_null(d);
    if (!strstr(why.what, what) && !strstr(why.remedy, what))
        fail_msg("'%s; %s' does not contain '%s'", why.what, why.remedy, what);
    assert_int_equal(why.line, line);
    assert_true(why.remedy[0] != 0);
}

/* --- refractiveindex.info --- */

/* The nine formulas at 0.5 um, with L^2 = 1/4, computed by hand. */
static void the_database_s_formulas_are_read(void **state)
{
    (void)state;
    const struct {
        const char *text;
        double n;
    } cases[] = {
        {"1\n    coefficients: 0.5 1 0.25", sqrt(1 + 0.5 + 0.25 / (0.25 - 0.0625))},
        {"2\n    coefficients: 0 1 0.0625", sqrt(1 + 0.25 / (0.25 - 0.0625))},
        {"3\n    coefficients: 2 4 2 0.5 -2", sqrt(2 + 4 * 0.25 + 0.5 * 4)},
        {"4\n    coefficients: 1 3 2 0.25 2 0.2 0 0.01 1 0.1 2", sqrt(1 + 0.75 / 0.1875 + 0.2 / 0.24 + 0.025)},
        {"5\n    coefficients: 1.5 0.01 -2", 1.5 + 0.04},
        {"6\n    coefficients: 0.001 0.05 14", 1 + 0.001 + 0.05 / 10},
        {"7\n    coefficients: 1.4 0.01 0 0.02 0 0", 1.4 + 0.01 / (0.25 - 0.028) + 0.02 * 0.25},
        {"8\n    coefficients: 0.25 0.0625 0.0 0.0", sqrt((1 + 2 * 0.3125) / (1 - 0.3125))},
        {"9\n    coefficients: 2 0.1 0.05 0.2 0.25 0.1", sqrt(2 + 0.1 / 0.2 + 0.2 * 0.25 / (0.0625 + 0.1))},
    };
    for (size_t i = 0; i < COUNT(cases); i++) {
        char text[300];
        snprintf(text, sizeof text, "DATA:\n  - type: formula %s\n    wavelength_range: 0.4 0.7\n", cases[i].text);
        const optical_data *d = parsed("a.yml", text, "", "");
        assert_near(optical_data_at(d, 500), cases[i].n, 2e-15);
        assert_false(optical_data_has_k(d));
        optical_data_release(d);
    }
}

static void the_database_s_tables_are_read(void **state)
{
    (void)state;
    const optical_data *d = parsed("gold.yml",
                                   "REFERENCES: |\n    x\nDATA:\n  - type: tabulated nk\n    data: |\n"
                                   "        0.5 0.97 1.87\n        0.6 0.25 2.93\n        0.7 0.13 -0.1\n",
                                   "", "");
    assert_near(optical_data_at(d, 500), 0.97, 0);
    assert_near(optical_data_k(d, 600), 2.93, 0);
    assert_near(optical_data_k(d, 700), 0, 0);
    optical_data_release(d);
    d = parsed("b.yaml",
               "DATA:\n  - type: formula 5\n    wavelength_range: 0.3 1\n    coefficients: 1.5 0.004 -2\n"
               "  - type: tabulated k\n    data: |\n        0.4 1e-7\n        0.4 3e-7\n        0.5 0\n"
               "  - type: tabulated n2\n    data: |\n        0.4 1e-20\n",
               "", "");
    assert_near(optical_data_at(d, 1000), 1.504, 1e-15);
    assert_near(optical_data_k(d, 400), 2e-7, 1e-22);
    optical_data_release(d);
}

/* --- glass catalogues --- */

#define GLASS(number, c) "NM TEST " number " 517642.251 1.5168 64.17 0 1\nCD " c "\nLD 0.4 0.7\n"

/* The thirteen formulas at 0.5 um: L^2 = 1/4, L^-2 = 4. */
static void a_catalogue_s_formulas_are_read(void **state)
{
    (void)state;
    const double M = 1 / (0.25 - 0.028);
    const struct {
        const char *text;
        double n;
    } cases[] = {
        {GLASS("1", "2.25 -0.01 0.01 0.001 0.0001 0.00001"),
         sqrt(2.25 - 0.0025 + 0.04 + 0.016 + 0.0064 + 0.00001 * 256)},
        {GLASS("2", "1 0.01 0.2 0.02 1 100"), sqrt(1 + 0.25 / 0.24 + 0.05 / 0.23 + 0.25 / (0.25 - 100))},
        {GLASS("3", "1.4 0.01 0.001 -0.01 0.002 0.003"),
         1.4 + 0.01 * M + 0.001 * M * M - 0.0025 + 0.002 / 16 + 0.003 / 64},
        {GLASS("4", "0.5 1 0.1 0.02 0.2"), sqrt(1 + 0.5 + 0.25 / (0.25 - 0.01) + 0.02 / (0.25 - 0.04))},
        {GLASS("5", "1.5 0.01 0.001"), 1.5 + 0.02 + 0.001 * pow(0.5, -3.5)},
        {GLASS("6", "1 0.01 0.2 0.02 1 100 0.1 0.03"),
         sqrt(1 + 0.25 / 0.24 + 0.05 / 0.23 + 0.25 / (0.25 - 100) + 0.025 / 0.22)},
        {GLASS("7", "2.2 0.02 0.01 0.03"), sqrt(2.2 + 0.02 / 0.24 - 0.0075)},
        {GLASS("8", "1.2 1 0.01 0.03"), sqrt(1.2 + 0.25 / 0.24 - 0.0075)},
        {GLASS("9", "1.2 1 0.01 0.1 60"), sqrt(1.2 + 0.25 / 0.24 + 0.025 / (0.25 - 60))},
        {GLASS("10", "2.25 -0.01 0.01 0.001 0 0 1e-6 1e-7"),
         sqrt(2.25 - 0.0025 + 0.04 + 0.016 + 1e-6 * 1024 + 1e-7 * 4096)},
        {GLASS("11", "1 0.01 0 0 0 0 0 0 0.1 0.03"), sqrt(1 + 0.25 / 0.24 + 0.025 / 0.22)},
        {GLASS("12", "2.25 -0.01 0.01 0 0 0 0.01 0.1"), sqrt(2.25 - 0.0025 + 0.04 + 0.01 / 16 + 0.1 / 64)},
        /* the numbers go on in the next lines */
        {"NM TEST 13 1 1.5 60\nED 1 2\nCD 2.25 -0.01 0.02 0.01\n0.001 0 0\n0 1e-7\nTD 5 5\nLD 0.4 0.7\n",
         sqrt(2.25 - 0.0025 + 0.02 / 16 + 0.04 + 0.016 + 1e-7 * 4096)},
    };
    for (size_t i = 0; i < COUNT(cases); i++) {
        const optical_data *d = parsed("a.agf", cases[i].text, "", "");
        assert_near(optical_data_at(d, 500), cases[i].n, 1e-14);
        optical_data_release(d);
    }
}

#define TWO                                                                                            \
    "CC a catalogue\r\nNM N-BK7 2 517642.251 1.5168 64.17 0 1\r\n"                                     \
    "CD 1.03961212E+00 6.00069867E-03 2.31792344E-01 2.00179144E-02 1.01046945E+00 1.03560653E+02\r\n" \
    "LD 3.0E-01 2.5E+00\r\nIT 4.0E-01 9.97E-01 1.0E+01\r\nIT 4.0E-01 9.92E-01 2.5E+01\r\n"             \
    "IT 5.0E-01 0.0 2.5E+01\r\nNM F2 2 620364.360 1.62004 36.37 0 1\r\n"                               \
    "CD 1.34533359E+00 9.97743871E-03 2.09073176E-01 4.70450767E-02 9.37357162E-01 1.11886764E+02\r\nLD .32 2.5\r\n"

/* Published indices; T = exp(-4 pi k d / lambda), of the thicker sample. */
static void a_glass_of_a_catalogue_is_found(void **state)
{
    (void)state;
    const optical_data *d = parsed("schott.AGF", TWO, "n-bk7", "");
    assert_near(optical_data_at(d, LINE_HELIUM_D_NM), 1.51680, 5e-6);
    assert_near(exp(-4 * acos(-1) * optical_data_k(d, 400) * 25e6 / 400), 0.992, 1e-12);
    optical_data_release(d);
    d = parsed("schott.agf", TWO, "F2", "");
    assert_near(optical_data_at(d, LINE_HELIUM_D_NM), 1.62004, 5e-6);
    assert_false(optical_data_has_k(d));
    optical_data_release(d);
    refused("schott.agf", TWO, "", "", 11, "give glass: NAME");
    refused("schott.agf", TWO, "N-BK77", "", 11, "did you mean 'N-BK7'?");
    refused("a.agf", "NM A 2 1 1 1\nLD 0.3 1\n", "", "", 3, "lacks coefficients");
    d = parsed("a.agf", "NM A 2 1 1 1\nCD 1 0.01 9 0.02\nCD 0.5 0.01\nLD 0.3 1\n", "", ""); /* the last ones only */
    assert_near(optical_data_at(d, 500), sqrt(1 + 0.5 * 0.25 / 0.24), 1e-15);
    optical_data_release(d);
    refused("a.agf", "NM A 2 1 1 1\nCD 1 0.01\nLD 0 0\n", "", "", 0, "begins at 0 nm");
    refused("a.agf", GLASS("14", "1"), "", "", 4, "formula 14");
}

static void a_catalogue_may_be_utf_16(void **state)
{
    (void)state;
    static const char plain[] = GLASS("5", "1.5 0.01 0");
    for (int high_first = 0; high_first < 2; high_first++) {
        char wide[2 * sizeof plain];
        memcpy(wide, high_first ? "\xfe\xff" : "\xff\xfe", 2);
        for (size_t i = 0; i + 1 < sizeof plain; i++)
            wide[2 + 2 * i + (size_t)high_first] = plain[i], wide[3 + 2 * i - (size_t)high_first] = 0;
        const optical_data *d;
        assert_int_equal(
            optical_file_parse("w.agf", wide, 2 * sizeof plain, &(optical_file_choice){"test", "", 1}, &d, NULL),
            STATUS_OK);
        assert_near(optical_data_at(d, 500), 1.52, 1e-15);
        optical_data_release(d);
    }
}

/* --- tables --- */

/* The same three points in the forms that people have. */
static void tables_are_read_in_every_form(void **state)
{
    (void)state;
    static const char *const texts[] = {
        "400,1.5\n500,1.25\n600,1.125\n",
        "nm,n\r\n400,1.5\r\n500,1.25\r\n600,1.125\r\n",
        "\xef\xbb\xbf# a comment\n\nwl;value\n600;1,125\n500;1,25\n400;1,5\n",
        "400\t1.5\n500\t1.25\n600\t1.125\n",
        "  400   1.5\n  500   1.25\n  600 1.125\n",
        "wl,n\n0.4,1.5\n0.5,1.25\n0.6,1.125\n",
        "wavelength (\xc2\xb5m),n\n0.4,1.5\n0.5,1.25\n0.6,1.125\n",
        "Data from x\nDate: Mon\nNumber of pixels: 3\n>>>>>Begin Spectral Data<<<<<\n400,000\t1,500\n500,000\t1,250\n"
        "600,000\t1,125\n>>>>>End Spectral Data<<<<<\n",
        "\"wavelength\",\"T\"\n\"400\",\"1.5\"\n\"500\",\"1.25\"\n\"600\",\"1.125\"\n",
        "400,1.5,x\n500,1.25,y\n500,1.25,y\n600,1.125,z\n",
    };
    for (size_t i = 0; i < COUNT(texts); i++) {
        const optical_data *d = parsed("a.csv", texts[i], "", strstr(texts[i], ",x") ? "2" : "");
        double low, high;
        optical_data_range(d, &low, &high);
        assert_near(low, 400, 1e-12);
        assert_near(high, 600, 1e-12);
        assert_near(optical_data_at(d, 500), 1.25, 0);
        assert_near(optical_data_at(d, 300), 1.5, 0);
        assert_false(optical_data_has_k(d));
        optical_data_release(d);
    }
}

static void columns_and_k_are_chosen(void **state)
{
    (void)state;
    static const char table[] = "nm,dark,Sample A,n\n400,1,20,3\n500,2,40,5\n";
    const optical_data *d = parsed("a.csv", table, "", "sample a");
    assert_near(optical_data_at(d, 500), 40, 0);
    optical_data_release(d);
    d = parsed("a.csv", table, "", "4");
    assert_near(optical_data_at(d, 500), 5, 0);
    optical_data_release(d);
    assert_int_equal(optical_file_parse("a.csv", table, strlen(table), &(optical_file_choice){"", "3", 0.01}, &d, NULL),
                     STATUS_OK);
    assert_near(optical_data_at(d, 400), 0.2, 1e-17);
    optical_data_release(d);
    static const char *const with_k[] = {"400,1.5,0.1\n500,1.4,0.2\n", "wl,n,k\n400,1.5,0.1\n500,1.4,0.2\n",
                                         "wl,n\n0.4,1.5\n0.5,1.4\n\nwl,k\n0.4,0.1\n0.5,0.2\n"};
    for (size_t i = 0; i < COUNT(with_k); i++) {
        d = parsed("a.csv", with_k[i], "", "");
        assert_near(optical_data_at(d, 500), 1.4, 0);
        assert_near(optical_data_k(d, 400), 0.1, 0);
        optical_data_release(d);
    }
    refused("a.csv", table, "", "sampel a", 2, "no column 'sampel a'");
    refused("a.csv", table, "", "9", 2, "no column '9'");
}

static void wrong_files_are_refused_with_their_line(void **state)
{
    (void)state;
    refused("a.csv", "", "", "", 1, "no row of numbers");
    refused("a.csv", "nm,n\n400,1.5\n500,\n", "", "", 3, "column 2 has no number");
    refused("a.csv", "400,1.5\nabc,1\n", "", "", 2, "'abc' is not a number");
    refused("a.csv", "400\n500\n", "", "", 1, "fewer than two columns");
    refused("a.yml", "solids: {}\n", "", "", 1, "not a file of refractiveindex.info");
    refused("a.yml", "DATA:\n  - type: tabulated n2\n    data: |\n        1 2\n", "", "", 2, "neither n nor k");
    refused("a.yml", "DATA:\n  - type: formula 12\n    wavelength_range: 1 2\n    coefficients: 1\n", "", "", 2,
            "formula 12");
    refused("a.yml", "DATA:\n  - type: formula 1\n    coefficients: 1\n", "", "", 2, "lacks coefficients or a range");
    refused("a.yml", "DATA:\n  - type: formula 1\n    wavelength_range: 1 2\n    coefficients: 0 1\n", "", "", 2,
            "2 numbers do not fit");
    refused("a.yml", "DATA:\n  - type: tabulated n\n    data: |\n        0.4 1.5\n        0.5\n", "", "", 5,
            "has not 2 numbers");
}

/* --- scenes --- */

typedef struct folder {
    char path[64], file[96];
} folder;

static scene *scene_with(folder *f, const char *name, const char *content, const char *text)
{
    strcpy(f->path, "/tmp/cuvette-optical-XXXXXX");
    assert_non_null(mkdtemp(f->path));
    snprintf(f->file, sizeof f->file, "%s/%s", f->path, name);
    assert_int_equal(file_write(f->file, content, NULL), STATUS_OK);
    char path[96];
    snprintf(path, sizeof path, "%s/s.yaml", f->path);
    scene *s;
    diagnostic why = {.what = ""};
    if (scene_read_text(path, text, strlen(text), &s, &why) != STATUS_OK || scene_load(s, &why) != STATUS_OK ||
        scene_check(s, &why) != STATUS_OK)
        fail_msg("%s: %s", why.file, why.what);
    return s;
}

static void end(folder *f, scene *s)
{
    scene_destroy(s);
    remove(f->file);
    rmdir(f->path);
}

static scene *through_a_package(const scene *s)
{
    void *bytes;
    size_t size;
    scene *again = NULL;
    assert_int_equal(scene_pack(s, &bytes, &size, NULL), STATUS_OK);
    assert_int_equal(scene_unpack(bytes, size, &again, NULL), STATUS_OK);
    free(bytes);
    return again;
}

/* A medium from a file equals the catalogue's: relative to air by default; k absorbs by 4 pi k / lambda. */
static void a_medium_is_read_from_a_file(void **state)
{
    (void)state;
    folder f;
    scene *s = scene_with(&f, "N-BK7.yml",
                          "DATA:\n  - type: formula 2\n    wavelength_range: 0.3 2.5\n    coefficients: 0 1.03961212 "
                          "0.00600069867 0.231792344 0.0200179144 1.01046945 103.560653\n"
                          "  - type: tabulated k\n    data: |\n        0.3 1e-8\n        2.5 1e-8\n",
                          "materials: {glass: {transparency: 1, medium: {file: N-BK7.yml}}}\n"
                          "solids: {ball: {shape: sphere, material: glass},\n"
                          "         other: {shape: sphere, position: [3, 0, 0], transparency: 1, medium: bk7}}\n");
    assert_int_equal(s->data_count, 1);
    assert_string_equal(s->data[0].name, "N-BK7");
    for (int copy = 0; copy < 3; copy++) {
        index_law own, known;
        assert_int_equal(material_index_law(&s->solids[0].surface, "", &own, NULL), STATUS_OK);
        assert_int_equal(material_index_law(&s->solids[1].surface, "", &known, NULL), STATUS_OK);
        for (double nm = 380; nm <= 780; nm += 5)
            assert_near(index_law_at(&own, nm), index_law_at(&known, nm), 1e-15);
        assert_near(material_absorption_at(&s->solids[0].surface, 500), 4 * acos(-1) * 1e-8 / 500e-9, 1e-12);
        assert_true(material_absorbs(&s->solids[0].surface));
        scene *other = copy == 0 ? scene_clone(s) : through_a_package(s);
        assert_non_null(other);
        scene_destroy(s);
        s = other;
    }
    assert_int_equal(scene_set(s, "N-BK7.relative_to", "vacuum", NULL), STATUS_OK);
    assert_null(s->solids[0].surface.index_data);
    assert_int_equal(scene_load(s, NULL), STATUS_OK);
    index_law own;
    assert_int_equal(material_index_law(&s->solids[0].surface, "", &own, NULL), STATUS_OK);
    assert_near(index_law_at(&own, 589.3), dispersion_index(&media_find("bk7")->law, 589.3), 1e-15);
    assert_int_equal(scene_remove(s, "N-BK7", NULL), STATUS_BAD_INPUT);
    assert_int_equal(scene_rename(s, "N-BK7", "crown", NULL), STATUS_OK);
    assert_string_equal(s->solids[0].surface.medium_data, "crown");
    assert_string_equal(s->materials[0].value.medium_data, "crown");
    assert_int_equal(scene_set(s, "glass.ior", "1.5", NULL), STATUS_OK);
    assert_int_equal(s->solids[0].surface.medium, MEDIUM_IOR);
    end(&f, s);
}

/* An opaque solid of data with k is a metal. */
static void k_makes_an_opaque_solid_a_metal(void **state)
{
    (void)state;
    folder f;
    scene *s = scene_with(&f, "m.csv", "nm,n,k\n400,0.5,2\n700,0.2,4\n",
                          "render: {spectrum: spectral}\nsolids: {ball: {shape: sphere, medium: {file: m.csv}}}\n");
    const material *m = &s->solids[0].surface;
    assert_true(material_is_layered(m, &s->render));
    assert_near(material_extinction_index(m, 400), 2, 0);
    assert_near(material_extinction_index(m, 550), 3, 1e-12);
    assert_false(material_absorbs(m));
    end(&f, s);
}

/* The image of `with`, in which files are named, and of `without`, which says the same in numbers. */
static void same_image(const char *name, const char *content, const char *with, const char *without, double tolerance)
{
    static const char room[] = "camera: {position: [0, 0, -4], target: [0, 0, 0]}\nbackground: {color: [1, 1, 1]}\n";
    static const char *const films[] = {"spectral", "rgb"};
    for (size_t i = 0; i < COUNT(films); i++) {
        folder f;
        char text[1200];
        snprintf(text, sizeof text, "render: {width: 12, height: 9, spectrum: %s}\n%s%s", films[i], room, with);
        scene *a = scene_with(&f, name, content, text);
        snprintf(text, sizeof text, "render: {width: 12, height: 9, spectrum: %s}\n%s%s", films[i], room, without);
        scene *b = scene_from(text);
        render_result *x = render(a), *y = render(b);
        double brightest = 0.0;
        for (int c = 0; c < 3; c++)
            for (int k = 0; k < 12 * 9; k++) {
                const double seen = film_value(x->img, k % 12, k / 12, c);
                assert_near(seen, film_value(y->img, k % 12, k / 12, c), tolerance);
                brightest = fmax(brightest, seen);
            }
        assert_true(brightest > 0.1);
        render_result_destroy(x);
        render_result_destroy(y);
        scene_destroy(b);
        end(&f, a);
    }
}

/* A grey reflectance is that colour, also in percent; and as a tint. */
static void a_reflectance_from_a_file_is_the_colour(void **state)
{
    (void)state;
    static const char half[] = "380,50\n500,50\n780,50\n";
    same_image("r.csv", half,
               "lights: {l: {position: [2, 3, -4]}}\ndata: {d: {file: r.csv, scale: 0.01}}\n"
               "solids: {a: {shape: sphere, diffuse: 0.8, color_data: d}}\n",
               "lights: {l: {position: [2, 3, -4]}}\nsolids: {a: {shape: sphere, diffuse: 0.8, color: [.5, .5, .5]}}\n",
               2e-5);
    same_image("r.csv", half,
               "data: {d: {file: r.csv, scale: 0.01}}\nsolids: {a: {shape: sphere, transparency: 1, color_data: d}}\n",
               "solids: {a: {shape: sphere, transparency: 1, color: [0.5, 0.5, 0.5]}}\n", 2e-5);
}

static void absorption_from_a_file_is_that_of_a_list(void **state)
{
    (void)state;
    same_image("a.csv", "nm,1/m\n400,0.1\n700,1.2\n",
               "data: {d: {file: a.csv}}\nsolids: {a: {shape: sphere, transparency: 1, absorb_data: d}}\n",
               "solids: {a: {shape: sphere, transparency: 1, absorb_spectrum: [400, 0.1, 700, 1.2]}}\n", 1e-12);
}

/* Planck's law in a table is a black body; the unit does not matter. */
static void a_lamp_from_a_file_has_its_spectrum(void **state)
{
    (void)state;
    char table[12000] = "nm\tW\n";
    for (int nm = 370; nm <= 790; nm += 2)
        snprintf(table + strlen(table), sizeof table - strlen(table), "%d\t%.9g\n", nm,
                 7e3 * planck_relative(nm, 3200));
    same_image("lamp.txt", table,
               "data: {d: {file: lamp.txt}}\nlights: {l: {position: [2, 3, -4], spectrum: data, spectrum_data: d}}\n"
               "solids: {a: {shape: sphere, diffuse: 0.8}}\n",
               "lights: {l: {position: [2, 3, -4], spectrum: black_body, temperature_k: 3200}}\n"
               "solids: {a: {shape: sphere, diffuse: 0.8}}\n",
               1e-6);
}

/* Under a line, a surface has the brightness of its reflectance there; a smooth spectrum of its colour would not. */
static void a_reflectance_is_that_of_each_wavelength(void **state)
{
    (void)state;
    static const char edge[] = "380,0\n580,0\n585,0.3\n600,0.3\n610,1\n780,1\n";
    double seen[2];
    for (int white = 0; white < 2; white++) {
        folder f;
        char text[500];
        snprintf(text, sizeof text,
                 "render: {width: 1, height: 1, spectrum: spectral}\n"
                 "camera: {position: [0, 0, -4], target: [0, 0, 0]}\nbackground: {color: [0, 0, 0]}\n"
                 "data: {d: {file: edge.csv}}\n"
                 "lights: {l: {position: [0, 0, -4], spectrum: line, line_nm: 590}}\n"
                 "solids: {a: {shape: sphere, diffuse: 1, %s}}\n",
                 white ? "color: [1, 1, 1]" : "color_data: d");
        scene *s = scene_with(&f, "edge.csv", edge, text);
        render_result *r = render(s);
        seen[white] = film_value(r->img, 0, 0, 1);
        render_result_destroy(r);
        end(&f, s);
    }
    assert_true(seen[1] > 0.1);
    assert_near(seen[0] / seen[1], 0.3, 1e-6);
}

/* Columns and glasses have any names; these survive in a written scene. */
static void columns_and_glasses_have_any_names(void **state)
{
    (void)state;
    static const char *const columns[] = {"Sample 2", "3", "%R (mean)", "a: b #c", "null"};
    for (size_t i = 0; i < COUNT(columns); i++) {
        folder f;
        char table[100], text[300];
        snprintf(table, sizeof table, "nm;x;%s\n400;1;0.25\n700;1;0.25\n", i == 1 ? "y" : columns[i]);
        snprintf(text, sizeof text,
                 "data: {d: {file: t.csv, column: '%s'}}\nsolids: {a: {shape: sphere, color_data: d}}\n", columns[i]);
        scene *s = scene_with(&f, "t.csv", table, text);
        assert_near(optical_data_at(s->solids[0].surface.color_values, 500), 0.25, 0);
        char *written;
        scene *again;
        assert_int_equal(scene_write_text(s, "", false, &written, NULL), STATUS_OK);
        assert_int_equal(scene_read_text("again.yaml", written, strlen(written), &again, NULL), STATUS_OK);
        assert_string_equal(again->data[0].column, columns[i]);
        scene_destroy(again);
        free(written);
        end(&f, s);
    }
    scene *s;
    static const char glass[] = "data: {d: {file: zeon.agf, glass: 480R}, e: {file: s.agf, glass: K-PSFn1(M)}}\n";
    assert_int_equal(scene_read_text("a.yaml", glass, strlen(glass), &s, NULL), STATUS_OK);
    assert_string_equal(s->data[0].glass, "480R");
    assert_int_equal(scene_set(s, "d.glass", "a\tb", NULL), STATUS_BAD_INPUT);
    scene_destroy(s);
}

/* Names as makers and shops write them. */
static void usual_names_of_media_are_understood(void **state)
{
    (void)state;
    static const char *const names[][2] = {
        {"N-BK7", "bk7"},     {"BK7", "bk7"},      {"Water", "water"}, {"SiO2", "fused-silica"},
        {"N-SF11", "n-sf11"}, {"acrylic", "pmma"}, {"Au", "gold"},     {"aluminum", "aluminium"},
        {"IOR", "IOR"}};
    for (size_t i = 0; i < COUNT(names); i++)
        assert_string_equal(media_usual_name(names[i][0]), names[i][1]);
    scene *s;
    static const char text[] =
        "background: {medium: Air}\nsolids: {a: {shape: sphere, transparency: 1, medium: N-BK7}}\n";
    assert_int_equal(scene_read_text("a.yaml", text, strlen(text), &s, NULL), STATUS_OK);
    char *value;
    assert_int_equal(scene_get(s, "a.medium", &value, NULL), STATUS_OK);
    assert_string_equal(value, "bk7");
    free(value);
    diagnostic why = {.what = ""};
    assert_int_equal(scene_set(s, "a.medium", "H-ZLAF90", &why), STATUS_BAD_INPUT);
    assert_non_null(strstr(why.remedy, "glass: NAME"));
    scene_destroy(s);
}

/* What a file must hold for its use is known when it is read. */
static void data_that_do_not_fit_their_use_are_refused(void **state)
{
    (void)state;
    static const struct {
        const char *content, *text, *what;
    } cases[] = {
        {"400,50\n700,60\n", "data: {d: {file: x.csv}}\nsolids: {a: {shape: sphere, color_data: d}}\n", "reach 60"},
        {"800,1\n900,1\n", "data: {d: {file: x.csv}}\nlights: {l: {spectrum: data, spectrum_data: d}}\n", "no power"},
        {"400,-1\n700,-2\n", "data: {d: {file: x.csv}}\nlights: {l: {spectrum: data, spectrum_data: d}}\n", "no power"},
    };
    for (size_t i = 0; i < COUNT(cases); i++) {
        folder f;
        strcpy(f.path, "/tmp/cuvette-optical-XXXXXX");
        assert_non_null(mkdtemp(f.path));
        snprintf(f.file, sizeof f.file, "%s/x.csv", f.path);
        assert_int_equal(file_write(f.file, cases[i].content, NULL), STATUS_OK);
        char path[96];
        snprintf(path, sizeof path, "%s/s.yaml", f.path);
        scene *s;
        diagnostic why = {.what = ""};
        assert_int_equal(scene_read_text(path, cases[i].text, strlen(cases[i].text), &s, &why), STATUS_OK);
        assert_int_equal(scene_load(s, &why), STATUS_OK);
        assert_int_equal(scene_check(s, &why), STATUS_BAD_INPUT);
        assert_non_null(strstr(why.what, cases[i].what));
        end(&f, s);
    }
}

static void wrong_media_of_files_are_refused(void **state)
{
    (void)state;
    static const struct {
        const char *text, *what;
    } cases[] = {
        {"solids: {a: {shape: sphere, medium: data}}\n", "medium_data is not set"},
        {"solids: {a: {shape: sphere, medium: data, medium_data: gone}}\n", "there is no data 'gone'"},
        {"solids: {a: {shape: sphere, medium: {glass: X}}}\n", "a.medium is a map without a file"},
        {"solids: {a: {shape: sphere, medium: {file: a.yml, glas: X}}}\n", "unknown key 'glas'"},
        {"data: {d: {}}\n", "the data have no file"},
        {"lights: {l: {spectrum: data}}\n", "spectrum_data is not set"},
        {"lights: {l: {spectrum: data, spectrum_data: gone}}\n", "there is no data 'gone'"},
        {"solids: {a: {shape: sphere, color_data: gone}}\n", "there is no data 'gone'"},
        {"solids: {a: {shape: sphere, absorb_data: gone}}\n", "there is no data 'gone'"},
        {"solids: {a: {shape: sphere, scatter_data: gone}}\n", "there is no data 'gone'"},
    };
    for (size_t i = 0; i < COUNT(cases); i++) {
        scene *s;
        diagnostic why = {.what = ""};
        assert_int_equal(scene_read_text("a.yaml", cases[i].text, strlen(cases[i].text), &s, &why), STATUS_BAD_INPUT);
        if (!strstr(why.what, cases[i].what))
            fail_msg("'%s' does not contain '%s'", why.what, cases[i].what);
        assert_true(why.line > 0);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_database_s_formulas_are_read),
        cmocka_unit_test(the_database_s_tables_are_read),
        cmocka_unit_test(a_catalogue_s_formulas_are_read),
        cmocka_unit_test(a_glass_of_a_catalogue_is_found),
        cmocka_unit_test(a_catalogue_may_be_utf_16),
        cmocka_unit_test(tables_are_read_in_every_form),
        cmocka_unit_test(columns_and_k_are_chosen),
        cmocka_unit_test(wrong_files_are_refused_with_their_line),
        cmocka_unit_test(a_medium_is_read_from_a_file),
        cmocka_unit_test(k_makes_an_opaque_solid_a_metal),
        cmocka_unit_test(a_reflectance_from_a_file_is_the_colour),
        cmocka_unit_test(a_reflectance_is_that_of_each_wavelength),
        cmocka_unit_test(columns_and_glasses_have_any_names),
        cmocka_unit_test(absorption_from_a_file_is_that_of_a_list),
        cmocka_unit_test(a_lamp_from_a_file_has_its_spectrum),
        cmocka_unit_test(usual_names_of_media_are_understood),
        cmocka_unit_test(wrong_media_of_files_are_refused),
        cmocka_unit_test(data_that_do_not_fit_their_use_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
