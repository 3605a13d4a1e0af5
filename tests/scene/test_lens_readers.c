/* Tests of what readers of lens files tell: apertures and vignetting factors that are read, words that are not, files
 * that are cut short, and what a file that is written again has kept. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

#include "base/text.h"
#include "scene/lens/lens_prescription.h"
#include "scene/model/scene.h"

#define assert_near(a, b, tolerance) assert_true(fabs((a) - (b)) <= (tolerance))
#define HEAD "VERS 1 2\nUNIT MM X W\n"
#define SYSTEM "ENPD 10\nFTYP 0 0 2 1 0\nXFLN 0 0\nYFLN 0 5\nWAVM 1 0.5875618 1\nPWAV 1\n"
#define OBJECT "SURF 0\n  TYPE STANDARD\n  DISZ INFINITY\n"
#define FRONT "SURF 1\n  STOP\n  CURV 0.02 1 0 0\n  DISZ 5\n  GLAS N-BK7 0 0 1.5 40\n  DIAM 6 0 0 0\n"
#define BACK "SURF 2\n  CURV -0.02\n  DISZ 47\n"
#define IMAGE "SURF 3\n  CURV 0\n  DISZ 0\n"
#define SINGLET(head, front, rest) HEAD head SYSTEM OBJECT FRONT front BACK IMAGE rest

static lens_prescription parsed(const char *name, const char *text)
{
    lens_prescription p;
    diagnostic why = {.what = ""};
    if (lens_file_parse(name, text, strlen(text), NULL, &p, &why) != STATUS_OK)
        fail_msg("%s:%ld:%ld: %s; %s\n%s", name, why.line, why.column, why.what, why.remedy, text);
    return p;
}

static void refused(const char *name, const char *text, long line, long column, const char *what, const char *remedy)
{
    lens_prescription p;
    diagnostic why = {.what = ""};
    assert_int_equal(lens_file_parse(name, text, strlen(text), NULL, &p, &why), STATUS_BAD_INPUT);
    if (!strstr(why.what, what) || !strstr(why.remedy, remedy))
        fail_msg("'%s; %s' does not contain '%s' and '%s'", why.what, why.remedy, what, remedy);
    assert_int_equal(why.line, line);
    assert_int_equal(why.column, column);
}

static char *written(const lens_prescription *p, const char *name)
{
    text_writer writer;
    char *text = NULL;
    diagnostic why = {.what = ""};
    assert_int_equal(text_writer_open(&writer, &why), STATUS_OK);
    const status code = lens_file_write(p, name, writer.stream, &why);
    assert_int_equal(text_writer_end(&writer, code, &text, NULL, &why), STATUS_OK);
    return text;
}

static void noted(const char *name, const char *text, const char *note)
{
    lens_prescription p = parsed(name, text);
    if (strcmp(p.note, note) != 0)
        fail_msg("the note is '%s', not '%s'", p.note, note);
    lens_prescription_release(&p);
}

/* --- .zmx: what is read --- */

/* Clear apertures of either kind precede the semi-diameter, wherever they are. */
static void apertures_of_a_surface_are_its_clear_diameter(void **state)
{
    (void)state;
    static const char *const texts[] = {SINGLET("", "  CLAP 0 4 0\n", ""), SINGLET("", "  FLAP 0 4 0\n", ""),
                                        SINGLET("", "  FLAP 0 4 0\n  DIAM 5\n", "")};
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        lens_prescription p = parsed("a.zmx", texts[i]);
        assert_near(p.surface[0].diameter, 8.0, 0.0);
        assert_near(p.surface[0].hole, 0.0, 0.0);
        char *text = written(&p, "a.zmx");
        lens_prescription again = parsed("a.zmx", text);
        assert_near(again.surface[0].diameter, 8.0, 0.0);
        free(text);
        lens_prescription_release(&again);
        lens_prescription_release(&p);
    }
    noted("a.zmx", SINGLET("", "  CLAP 1 4 0\n", ""),
          "not read: the inner radius of the aperture of surface 1, which is no mirror");
}

static void vignetting_factors_are_those_of_their_field(void **state)
{
    (void)state;
    const char *text = SINGLET("VDXN 0 0.1\nVDYN 0 -0.2\nVCXN 0 0.3\nVCYN 0 0.4\n", "", "");
    const char *const names[] = {"a.zmx", "a.csv"};
    lens_prescription p = parsed("a.zmx", text);
    for (int i = 0; i < 3; i++) {
        const lens_vignetting v = lens_vignetting_of(&p, 0.0, 5.0);
        assert_near(v.shift_x, 0.1, 0.0);
        assert_near(v.shift_y, -0.2, 0.0);
        assert_near(v.squeeze_x, 0.3, 0.0);
        assert_near(v.squeeze_y, 0.4, 0.0);
        assert_near(lens_vignetting_of(&p, 0.0, 0.0).squeeze_y, 0.0, 0.0);
        assert_near(lens_vignetting_of(&p, 0.0, 2.0).squeeze_y, 0.0, 0.0);
        if (i == 2)
            break;
        char *next = written(&p, names[i]);
        lens_prescription_release(&p);
        p = parsed(names[i], next);
        free(next);
    }
    lens_prescription_release(&p);
    refused("a.zmx", SINGLET("VCYN 0 1\n", "", ""), 3, 8, "vignetting factor 1", "below 1");
}

/* --- .zmx: notes and errors --- */

static void words_that_act_on_light_are_noted(void **state)
{
    (void)state;
    noted("a.zmx",
          SINGLET("NOTE 0 a\nGCAT SCHOTT\nTELE 0\nVANN 0 0\n", "  COMM a\n  MAZH 0 0\n  POPS 0 0\n", "TOL TOFF\n"), "");
    noted("a.zmx", SINGLET("VANN 0 9\n", "  COAT AR\n  OBSC 0 1 0\n", ""),
          "not read: VANN, COAT AR of surface 1, OBSC of surface 1");
    noted("a.zmx", SINGLET("", "  QQQQ 1\n  QQQQ 1\n  ZZZZ\n", ""),
          "unknown words, not read: QQQQ (line 18), QQQQ (line 19), ZZZZ (line 20)");
    noted(
        "a.zmx", HEAD "YFLN 0\nWAVM 1 0.5\nWAVM 3 0.6\n" OBJECT FRONT BACK IMAGE,
        "not read: wavelength 3 (line 5); no ENPD, FNUM, OBNA or FLOA: the beam fills the stop as its diameter states");
    noted("a.zmx", SINGLET("GCAT HOYA\n", "", ""), "taken as Schott's, which GCAT does not name: bk7");
    noted("a.zmx", HEAD SYSTEM "FNUM 4 0\n" OBJECT FRONT BACK IMAGE, "FNUM replaces the aperture that is given before");
    noted("a.zmx", HEAD SYSTEM OBJECT FRONT "SURF 2\n  CURV -0.02\n  DISZ 90\n" IMAGE,
          "the image is 90 after the last surface, but the paraxial focus is at 47.5362");
    noted("a.zmx", HEAD SYSTEM OBJECT FRONT BACK "SURF 3\n  CURV 0\n",
          "surface 3, taken as the image, has no DISZ: is the file cut short?");
    noted("a.zmx",
          HEAD SYSTEM OBJECT "SURF 1\n  STOP\n  CURV 0.02\n  DISZ 5\n  GLAS QF1 0 0 1.5168 64.2\n  DIAM 6\n" BACK IMAGE,
          "by n_d and V_d, which do not tell the index of other colours exactly: QF1");
}

static void mistakes_of_words_and_cut_files_are_located(void **state)
{
    (void)state;
    refused("a.zmx", SINGLET("", "  DIZS 5\n", ""), 18, 3, "unknown word 'DIZS'", "DISZ?");
    refused("a.zmx", SINGLET("", "  GLASS N-BK7\n", ""), 18, 3, "unknown word 'GLASS'", "GLAS?");
    refused("a.zmx", SINGLET("ENDP 10\n", "", ""), 3, 1, "unknown word 'ENDP'", "ENPD?");
    refused("a.zmx", HEAD SYSTEM OBJECT FRONT BACK, 18, 0, "last surface, 2, has a thickness of 47", "image");
    refused("a.zmx", HEAD "WAVM 1 0.5\nPWAV 7\n" OBJECT FRONT BACK IMAGE, 4, 0, "PWAV is 7, but the file has 1",
            "number");
    refused("a.zmx", HEAD "PWAV 0\n", 3, 6, "PWAV 0", "number");
    refused("a.zmx", HEAD OBJECT "SURF 1\n  CURV 0.02\n  DISZ 5\n  GLAS SK16 0 0 1.5 40\n" BACK IMAGE, 9, 8,
            "the glass 'SK16'", "N-SK16 is known");
    refused("a.zmx", HEAD OBJECT "SURF 1\n  GLAS QF1\n" BACK IMAGE, 7, 8, "the glass 'QF1'", "-g FILE.agf");
}

/* --- tables --- */

static void tables_lose_no_cell(void **state)
{
    (void)state;
    const char *rows = "radius,thickness,medium,stop\n50,5,bk7,1\n-50,47\n";
    char text[256];
    snprintf(text, sizeof text, "pupil,10,,\nfield_deg,0,5,,\n%s", rows);
    noted("a.csv", text, ""); /* the empty cells of a spreadsheet */
    refused("a.csv", "pupil,10\nf_number,5\npupil,9\n", 2, 1, "second aperture", "keep one");
    refused("a.csv", "unit_mm,1\nunit_mm,2\n", 2, 1, "unit_mm is given twice", "keep one");
    refused("a.csv", "pupil,1,2\n", 1, 9, "pupil has 2 numbers", "one number");
    refused("a.csv", "radius,thickness,radius\n", 1, 18, "second column radius", "keep one");
    refused("a.csv", "radius,thickness\n50,5,6\n", 2, 6, "3 cells, the header 2", "as many cells");
    refused("a.csv", "radius,thickness\n50,5\n-50\n", 3, 0, "the thickness is missing", "complete");
    refused("a.dat", "10 5 1.5 8 60 1\n", 1, 15, "6 numbers", "radius, thickness");
    noted("a.csv", "pupil,10\nradius,thickness,diameter,stop,hole\n50,5,12,1,3\n",
          "not read: the inner radius of the aperture of surface 1, which is no mirror");
}

/* From a table to a scene, back, and to a table again. */
static void bevels_are_kept_by_tables_and_scenes(void **state)
{
    (void)state;
    lens_prescription p = parsed("a.csv", "pupil,8\nunit_mm,1\nradius,thickness,medium,diameter,chamfer\n"
                                          "50,5,bk7,20,0.25\n-50,40,,20,0.5\n"),
                      back;
    scene *s = NULL;
    diagnostic why = {.what = ""};
    assert_int_equal(lens_scene_create(&p, NULL, &s, &why), STATUS_OK);
    assert_int_equal(lens_of_scene(s, NULL, &back, NULL, &why), STATUS_OK);
    assert_true(back.surface[0].chamfer == 0.25 && back.surface[1].chamfer == 0.5);
    char *text = written(&back, "a.csv");
    lens_prescription again = parsed("a.csv", text);
    assert_true(again.surface[0].chamfer == 0.25 && again.surface[1].chamfer == 0.5);
    free(text);
    scene_destroy(s);
    lens_prescription_release(&p), lens_prescription_release(&back), lens_prescription_release(&again);
    noted("a.csv", "radius,thickness,medium,diameter,chamfer\n50,5,bk7,20,0\n-50,2,sf2,20,0.5\n-90,40,,20,0\n",
          "not read: the bevel of surface 2, which is no side of glass in air; no stop is stated: it is surface 1, "
          "which a beam on the axis fills first; the image is 40 after the last surface, but the paraxial focus is "
          "at 65.1065");
    refused("a.csv", "radius,thickness,chamfer\n50,5,-1\n", 2, 6, "below 0", "0 or more");
}

static void what_a_format_lacks_is_told(void **state)
{
    (void)state;
    lens_prescription p = parsed("a.zmx", SINGLET("", "", ""));
    assert_null(lens_file_lacks(&p, "a.zmx"));
    assert_null(lens_file_lacks(&p, "a.csv"));
    assert_non_null(strstr(lens_file_lacks(&p, "a.dat"), "names of glasses"));
    p.field[1].x = 1.0;
    assert_non_null(strstr(lens_file_lacks(&p, "a.csv"), "fields across y"));
    p.surface[0].chamfer = 0.3;
    assert_string_equal(lens_file_lacks(&p, "a.zmx"), "bevels");
    lens_prescription_release(&p);
}

/* --- .zmx: what is written again --- */

static void a_file_is_written_again_with_what_nothing_here_uses(void **state)
{
    (void)state;
    lens_prescription p =
        parsed("a.zmx", SINGLET("NOTE 0 \xc3\xa9l\xc3\xa9ment\nGCAT SCHOTT HOYA\n",
                                "  COMM \xe9t\xe9\n  COAT AR\n  PZUP 2 1 0 0\n", "TOL TOFF 0\nMNUM 1 1\n"));
    char *text = written(&p, "a.zmx");
    static const char *const kept[] = {"VERS 1 2\nMODE SEQ\n",
                                       "NOTE 0 \xc3\xa9l\xc3\xa9ment\n",
                                       "GCAT SCHOTT HOYA\n",
                                       "  COMM \xc3\xa9t\xc3\xa9\n",
                                       "  CURV 0.02 1 0 0\n",
                                       "  DIAM 6 0 0 0\n",
                                       "  COAT AR\n  PZUP 2 1 0 0\nSURF 2\n",
                                       "TOL TOFF 0\nMNUM 1 1\n"};
    for (size_t i = 0; i < sizeof kept / sizeof *kept; i++)
        if (!strstr(text, kept[i]))
            fail_msg("'%s' is not in\n%s", kept[i], text);
    lens_prescription again = parsed("a.zmx", text);
    char *twice = written(&again, "a.zmx");
    assert_string_equal(text, twice);
    free(text), free(twice);
    lens_prescription_release(&again);
    lens_prescription_release(&p);
}

/* Numbers of up to 12 digits come back as they were published, from 16 digits of their inverse or of micrometres. */
static void numbers_are_the_shortest(void **state)
{
    (void)state;
    lens_prescription p =
        parsed("a.zmx", HEAD "YFLN 0\nENPD 1\nWAVM 1 5.8756180E-01 1\n" OBJECT
                             "SURF 1\n  STOP\n  CURV 4.126893728359601E-02\n  DISZ 0\n  DIAM 1.23\n" IMAGE);
    assert_true(p.surface[0].radius == 24.2313);
    assert_true(p.wavelength[0].nm == 587.5618);
    char *csv = written(&p, "a.csv"), *zmx = written(&p, "a.zmx");
    assert_non_null(strstr(csv, "\n24.2313,"));
    assert_non_null(strstr(csv, ",587.5618\n"));
    assert_non_null(strstr(zmx, " 0.5875618 "));
    lens_prescription again = parsed("a.zmx", zmx);
    assert_true(again.surface[0].radius == 24.2313);
    free(csv), free(zmx);
    lens_prescription_release(&again);
    lens_prescription_release(&p);
    for (int i = 1; i < 2000; i++) { /* any radius, through both formats */
        lens_prescription q = parsed("a.csv", "pupil,1\nradius,thickness,diameter,stop\n1,1,1,1\n");
        q.surface[0].radius = i % 2 ? i / 7.0 : 0.001 * i;
        q.wavelength[0].nm = 300.0 + i / 3.0;
        char *text = written(&q, "a.zmx");
        lens_prescription back = parsed("a.zmx", text);
        assert_near(back.surface[0].radius, q.surface[0].radius, 2.3e-16 * q.surface[0].radius);
        assert_near(back.wavelength[0].nm, q.wavelength[0].nm, 2.3e-16 * q.wavelength[0].nm);
        free(text);
        lens_prescription_release(&back);
        lens_prescription_release(&q);
    }
}

/* --- scenes --- */

static scene *scene_from(const char *text)
{
    scene *s = NULL;
    diagnostic why = {.what = ""};
    if (scene_read_text("a.yaml", text, strlen(text), &s, &why) != STATUS_OK)
        fail_msg("%ld:%ld: %s; %s", why.line, why.column, why.what, why.remedy);
    return s;
}

static double focal_length(const char *text)
{
    scene *s = scene_from(text);
    lens_prescription p;
    diagnostic why = {.what = ""};
    if (lens_of_scene(s, NULL, &p, NULL, &why) != STATUS_OK)
        fail_msg("%s; %s", why.what, why.remedy);
    const double f = lens_first_order_of(&p, 587.5618).efl;
    lens_prescription_release(&p);
    scene_destroy(s);
    return f;
}

#define DOUBLET(glass)                                                                                               \
    "lens_systems:\n  a:\n    pupil: 10\n    surfaces:\n      - {radius: 60, thickness: 6, medium: bk7, stop: on}\n" \
    "      - {radius: -45, thickness: 3, medium: " glass "}\n      - {radius: -130, thickness: 0}\n"

/* Indices of glasses by name and by n_d and V_d are both relative to air, also where no medium is named. */
static void a_scene_with_lenses_is_in_air(void **state)
{
    (void)state;
    lens_prescription p =
        parsed("a.csv", "pupil,10\nradius,thickness,medium,stop\n60,6,bk7,1\n-45,3,1.6727/32.2\n-130,0\n");
    const double f = lens_first_order_of(&p, 587.5618).efl;
    assert_near(focal_length(DOUBLET("1.6727/32.2")), f, 1e-9 * f);
    assert_near(focal_length("background: {medium: air}\n" DOUBLET("1.6727/32.2")), f, 1e-9 * f);
    assert_near(focal_length("background: {color: [1, 1, 1]}\n" DOUBLET("1.6727/32.2")), f, 1e-9 * f);
    lens_prescription_release(&p);
    scene *s = scene_from("background: {ior: 1}\n" DOUBLET("1.6727/32.2"));
    assert_null(surrounding_medium_name(&s->background));
    scene_destroy(s);
}

/* A material of the scene is the glass of its name, which the catalogue may lack, or have with another index. */
static void materials_of_the_scene_are_glasses(void **state)
{
    (void)state;
    const double f = focal_length(DOUBLET("1.6727")), air = medium_index(media_at(0), 587.5618);
    char text[1024];
    for (int i = 0; i < 2; i++) {
        snprintf(text, sizeof text, "materials:\n  %s: {transparency: 1, ior: %.17g}\n%s", i ? "n-bk10" : "my-glass",
                 1.6727 * air, i ? DOUBLET("N-BK10") : DOUBLET("My-Glass"));
        assert_near(focal_length(text), f, 1e-9 * f);
    }
}

/* What a reader tells about a lens of a scene is a remark of the scene, and of its copies. */
static void scenes_keep_what_readers_tell(void **state)
{
    (void)state;
    scene *s =
        scene_from("lens_systems:\n  a:\n    pupil: 10\n    surfaces:\n      - {radius: 60, thickness: 6, medium: bk7, "
                   "stop: on, hole: 1}\n      - {radius: -45, thickness: 9}\n");
    scene *copy = scene_clone(s);
    static const char told[] = "a: not read: the inner radius of the aperture of surface 1, which is no mirror\n"
                               "a: the image is 9 after the last surface, but the paraxial focus is at ";
    assert_non_null(copy);
    assert_int_equal(strncmp(s->remarks, told, strlen(told)), 0);
    assert_string_equal(s->remarks, copy->remarks);
    scene_destroy(copy);
    scene_destroy(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(apertures_of_a_surface_are_its_clear_diameter),
        cmocka_unit_test(vignetting_factors_are_those_of_their_field),
        cmocka_unit_test(words_that_act_on_light_are_noted),
        cmocka_unit_test(mistakes_of_words_and_cut_files_are_located),
        cmocka_unit_test(tables_lose_no_cell),
        cmocka_unit_test(bevels_are_kept_by_tables_and_scenes),
        cmocka_unit_test(what_a_format_lacks_is_told),
        cmocka_unit_test(a_file_is_written_again_with_what_nothing_here_uses),
        cmocka_unit_test(numbers_are_the_shortest),
        cmocka_unit_test(a_scene_with_lenses_is_in_air),
        cmocka_unit_test(materials_of_the_scene_are_glasses),
        cmocka_unit_test(scenes_keep_what_readers_tell),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
