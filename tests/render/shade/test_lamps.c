/* Tests of lamps' spectra in films: a white floor shows the lamp's colour, lines are refracted each by its own index,
 * and photons carry them. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <cmocka.h>

#include "optics/spectrum.h"
#include "random_scene.h"
#include "render/plan/spectra.h"
#include "render_fixture.h"
#include "scene/model/scene.h"

#define COUNT(a) (sizeof(a) / sizeof((a)[0]))
#define assert_near(a, b, tolerance)                                    \
    do {                                                                \
        if (!(fabs((a) - (b)) <= (tolerance)))                          \
            fail_msg("%.9g instead of %.9g", (double)(a), (double)(b)); \
    } while (0)

/* A white floor, one unit below a lamp of intensity 2 and reach 1, of which 0.02 units are seen from above: Lambert's
 * law at normal incidence gives 2. */
#define FLOOR                                                                              \
    "render: {width: 24, height: 24, spectrum: spectral, wavelengths: 16, shadows: off}\n" \
    "camera: {position: [0, 100, 0], target: [0, 0, 0.0001], fov_deg: 0.01}\n"             \
    "background: {color: [0, 0, 0], ambient: [0, 0, 0]}\n"                                 \
    "lights: {lamp: {position: [0, 1, 0], reach: 1, intensity: 2}}\n"                      \
    "solids: {ground: {shape: plane, diffuse: 1}}\n"

/* The mean XYZ of the image. */
static void mean_xyz(const scene *s, double xyz[3])
{
    render_result *r = render(s);
    double rgb[3] = {0.0, 0.0, 0.0};
    const film *f = r->img;
    for (int y = 0; y < f->height; y++)
        for (int x = 0; x < f->width; x++)
            for (int c = 0; c < 3; c++)
                rgb[c] += film_value(f, x, y, c) / (f->width * f->height);
    linear_srgb_to_xyz(rgb, xyz);
    render_result_destroy(r);
}

/* XYZ of a lamp by its definition, Y = 1. */
static void lamp_xyz(lamp_spectrum kind, double xyz[3])
{
    spectral_line lines[LAMP_LINES_MAX];
    const int count = lamp_lines(kind, 589.3, lines);
    xyz[0] = xyz[1] = xyz[2] = 0.0;
    for (int k = 0; k < count; k++) {
        double w[3];
        observer_weights(lines[k].nm, w);
        for (int c = 0; c < 3; c++)
            xyz[c] += lines[k].power * w[c];
    }
    for (int nm = 380; count == 0 && nm < 780; nm++) {
        double w[3];
        observer_weights(nm + 0.5, w);
        for (int c = 0; c < 3; c++)
            xyz[c] += w[c] * planck_relative(nm + 0.5, 2856.0) / 400.0;
    }
    for (int c = 2; c >= 0; c--)
        xyz[c] /= c == 1 ? 1.0 : xyz[1];
    xyz[1] = 1.0;
}

static const char *const lamps[] = {"black_body", "sodium", "mercury", "hydrogen", "line"};

/* The tolerance is that of wavelengths of 0.1 nm, and of their choice at random in 576 pixels. */
static void a_white_floor_shows_the_lamp(void **state)
{
    (void)state;
    for (size_t k = 0; k < COUNT(lamps); k++) {
        char assignments[80];
        double seen[3], wanted[3];
        scene *s = scene_from(FLOOR);
        snprintf(assignments, sizeof assignments, "lamp.spectrum=%s lamp.line_nm=589.3", lamps[k]);
        set_all(s, assignments);
        mean_xyz(s, seen);
        lamp_xyz((lamp_spectrum)(k + 1), wanted);
        for (int c = 0; c < 3; c++)
            assert_near(seen[c], 2.0 * wanted[c], 4e-3 * (wanted[0] + wanted[1] + wanted[2]));
        scene_destroy(s);
    }
}

/* Of numbers in [0, 1), the share that gives a wavelength is its density over SPECTRA_COUNT. The slots of a line are
 * its share of the light, but for one that each has and one that is rounded; where the sky shines too, half of all. */
static void wavelengths_are_drawn_from_lines_by_their_light(void **state)
{
    (void)state;
    enum { NUMBERS = 2 * LINE_SLOTS * SPECTRA_COUNT };
    static int drawn[2][SPECTRA_COUNT];
    for (int alone = 0; alone < 2; alone++) {
        scene *s = scene_from(FLOOR);
        set_all(s, "lamp.spectrum=mercury background.horizon=0,0,0 background.ambient=0,0,0 background.rain=0");
        set(s, alone ? "background.color=0,0,0" : "background.color=1,1,1");
        const line_table t = line_table_of(s);
        assert_int_equal(t.lines_only, alone);
        for (int i = 0; i < NUMBERS; i++) {
            bool of_line;
            const double u = (i + 0.5) / NUMBERS;
            drawn[alone][line_table_choose(&t, u, &of_line)]++;
            assert_int_equal(of_line, alone || u > 0.5);
        }
        for (int w = 0; w < SPECTRA_COUNT; w++)
            assert_near((double)drawn[alone][w] / NUMBERS, line_table_density(&t, w) / SPECTRA_COUNT, 1e-12);
        lamp_line lines[LAMP_LINES_MAX];
        double bright = 0.0, of_lines = 0.0;
        const int count = spectral_lines_of(&s->lights[0], lines);
        for (int k = 0; k < count; k++)
            bright += lines[k].bright;
        for (int k = 0; k < count; k++) {
            const double density = line_table_density(&t, lines[k].wavelength) / SPECTRA_COUNT,
                         share = alone ? density : 2.0 * density - 1.0 / SPECTRA_COUNT;
            assert_near(share, lines[k].bright / bright, (count + 2.0) / LINE_SLOTS);
            of_lines += share;
        }
        assert_near(of_lines, 1.0, 1e-12);
        scene_destroy(s);
    }
}

/* What emits nothing takes no wavelengths: colours of a sky of another kind, ambient light on surfaces without it or on
 * random paths, black lamps and invisible solids. */
static void a_dark_room_has_the_lines_alone(void **state)
{
    (void)state;
    static const struct {
        const char *assignments;
        bool alone;
    } rooms[] = {
        {"", true},
        {"background.horizon=1,1,1 background.ambient=1,1,1 background.rain=1", true},
        {"ground.ambient=0.5", false},
        {"ground.ambient=0.5 ground.color=0,0,0", true},
        {"ground.ambient=0.5 render.integrator=path", true},
        {"ground.emission=0.5 render.integrator=path", false},
        {"ground.emission=0.5 ground.color=0,0,0", true},
        {"ground.emission=0.5 ground.color=0,0,0 ground.checker=1 ground.checker_color=1,1,1", false},
        {"ground.emission=0.5 ground.visible=off", true},
        {"background.kind=gradient", false},
        {"background.kind=gradient background.horizon=0,0,0", true},
        {"background.kind=cie", false},
        {"background.kind=rain background.horizon=0,0,0 background.rain=0", true},
        {"background.kind=rain background.horizon=0,0,0 background.rain=1", false},
        {"background.color=0,0,0.1", false},
        {"other.intensity=1", false},
        {"other.intensity=1 other.color=0,0,0", true},
        {"other.intensity=1 other.color=0,0,0 other.spectrum=black_body", false},
    };
    for (size_t k = 0; k < COUNT(rooms); k++) {
        scene *s = scene_from("background: {color: [0, 0, 0]}\n"
                              "lights: {lamp: {position: [0, 1, 0], spectrum: mercury}, other: {intensity: 0}}\n"
                              "solids: {ground: {shape: plane, diffuse: 1}}\n");
        set_all(s, rooms[k].assignments);
        if (line_table_of(s).lines_only != rooms[k].alone)
            fail_msg("'%s': %s", rooms[k].assignments, rooms[k].alone ? "lines are not alone" : "lines are alone");
        scene_destroy(s);
    }
}

/* What does not shine changes no wavelength, and no film. */
static void a_dark_rooms_film_has_no_wavelength_without_light(void **state)
{
    (void)state;
    static const char *const dark[] = {"background.horizon=0,0,0 background.ambient=0,0,0", ""};
    uint64_t hash[2];
    for (size_t k = 0; k < COUNT(dark); k++) {
        scene *s = scene_from("render: {width: 24, height: 24, spectrum: spectral, wavelengths: 16}\n"
                              "background: {color: [0, 0, 0]}\n"
                              "lights: {lamp: {position: [0, 4, -3], spectrum: mercury}}\n"
                              "solids: {ground: {shape: plane, diffuse: 1}}\n");
        set_all(s, dark[k]);
        render_result *r = render(s);
        hash[k] = film_hash(r->img);
        render_result_destroy(r);
        scene_destroy(s);
    }
    assert_true(hash[0] == hash[1]);
}

/* With another lamp, half of the wavelengths are for each; the sum is the same. */
static void lines_and_daylight_add_up(void **state)
{
    (void)state;
    double seen[3], line[3], white[3];
    scene *s = scene_from(FLOOR);
    set_all(s, "lamp.spectrum=mercury background.ambient=1,1,1 ground.ambient=0.5 render.wavelengths=32");
    mean_xyz(s, seen);
    lamp_xyz(LAMP_MERCURY, line);
    linear_srgb_to_xyz((const double[3]){0.5, 0.5, 0.5}, white);
    for (int c = 0; c < 3; c++)
        assert_near(seen[c], 2.0 * line[c] + white[c], 5e-3 * (2.0 * line[c] + white[c]));
    scene_destroy(s);
}

/* One film for random paths too, whose wavelengths are those of all paths of a pixel. */
static void paths_see_the_same_lines(void **state)
{
    (void)state;
    scene *s = scene_from(FLOOR);
    double seen[3], wanted[3];
    set_all(s, "lamp.spectrum=hydrogen render.integrator=path render.paths=64");
    mean_xyz(s, seen);
    lamp_xyz(LAMP_HYDROGEN, wanted);
    for (int c = 0; c < 3; c++)
        assert_near(seen[c], 2.0 * wanted[c], 4e-3 * (wanted[0] + wanted[1] + wanted[2]));
    scene_destroy(s);
}

/* An rgb film has the lamp's colour in the gamut, and the brightness of white. */
static void an_rgb_film_has_the_lamps_color(void **state)
{
    (void)state;
    scene *s = scene_from(FLOOR);
    set_all(s, "render.width=1 render.height=1 render.spectrum=rgb lamp.spectrum=sodium lamp.color=0,0,1");
    const vec3 seen = look(s);
    double rgb[3];
    lamp_rgb(LAMP_SODIUM, 0.0, 0.0, rgb);
    assert_near(seen.x, 2.0 * rgb[0], 1e-5);
    assert_near(seen.y, 2.0 * rgb[1], 1e-5);
    assert_near(seen.z, 2.0 * rgb[2], 1e-5);
    assert_near(0.2126 * seen.x + 0.7152 * seen.y + 0.0722 * seen.z, 2.0, 1e-3);
    scene_destroy(s);
}

/* A slab moves the lamp closer by 1 - 1 / n, and passes (1 - R) / (1 + R), as test_caustics.c explains; here with a
 * lamp of lines, alone and with the even spectrum of a second, dim one. */
static void photons_carry_lines(void **state)
{
    (void)state;
    static const char slab_scene[] =
        "render: {width: 24, height: 24, depth: 8, caustics: photons, photons: 1000000, integrator: raycast,\n"
        "  spectrum: spectral, wavelengths: 32}\n"
        "camera: {position: [0, 0.5, 0], target: [0, 0, 0.0001], fov_deg: 10}\n"
        "background: {color: [0, 0, 0], ambient: [0, 0, 0]}\n"
        "lights: {lamp: {position: [0, 8, 0], intensity: 1, reach: 8, spectrum: mercury}}\n"
        "solids:\n"
        "  ground: {shape: plane, diffuse: 1}\n"
        "  slab: {shape: box, position: [0, 2, 0], size: [1.5, 1, 1.5], transparency: 1, ior: 1.6}\n";
    scene *s = scene_from(slab_scene);
    double seen[3], line[3], white[3];
    const double apparent = 8.0 - 1.0 + 1.0 / 1.6, r = 0.6 * 0.6 / (2.6 * 2.6),
                 expected = 64.0 / (apparent * apparent) * (1.0 - r) / (1.0 + r);
    lamp_xyz(LAMP_MERCURY, line);
    linear_srgb_to_xyz((const double[3]){0.5, 0.5, 0.5}, white);
    mean_xyz(s, seen);
    for (int c = 0; c < 3; c++)
        assert_near(seen[c], expected * line[c], 0.01 * expected * (line[0] + line[1] + line[2]));
    set_all(s, "background.ambient=1,1,1 ground.ambient=0.5");
    mean_xyz(s, seen);
    for (int c = 0; c < 3; c++)
        assert_near(seen[c], expected * line[c] + white[c], 0.015 * expected * (line[0] + line[1] + line[2]));
    scene_destroy(s);
}

/* As many lasers as spectra.h distinguishes, whatever their lines; other lamps have few lines. */
static void too_many_lasers_are_refused(void **state)
{
    (void)state;
    scene_text text = {.length = 0};
    add(&text, "solids: {ground: {shape: plane, diffuse: 1}}\nlights:\n");
    for (int i = 0; i < 101; i++)
        add(&text, "  l%d: {spectrum: line, line_nm: %d}\n", i, 400 + 3 * i);
    scene *s = NULL;
    diagnostic why = {0};
    assert_int_equal(scene_read_text("test.yaml", text.at, text.length, &s, &why), STATUS_BAD_INPUT);
    assert_non_null(strstr(why.what, "101 lights and beams have the spectrum line; a scene can have 100"));
    assert_null(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(wavelengths_are_drawn_from_lines_by_their_light),
        cmocka_unit_test(a_dark_room_has_the_lines_alone),
        cmocka_unit_test(a_dark_rooms_film_has_no_wavelength_without_light),
        cmocka_unit_test(a_white_floor_shows_the_lamp),
        cmocka_unit_test(lines_and_daylight_add_up),
        cmocka_unit_test(paths_see_the_same_lines),
        cmocka_unit_test(an_rgb_film_has_the_lamps_color),
        cmocka_unit_test(photons_carry_lines),
        cmocka_unit_test(too_many_lasers_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
