/* Tests of the linter's hints: each is given where a scene lacks something, and not where the scene is complete. Run
 * from the repository root. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "lint/lint.h"
#include "scene/model/params.h"
#include <stdio.h>
#include <string.h>

#define LIT "lights: {lamp: {}}\n"

/* Appends each line with its newline. */
static void append_line(void *context, const scene_note *note)
{
    char *all = context, text[NOTE_LINE_MAX];
    note_line(note, text, sizeof text);
    assert_true(text[0] && !strchr(text, '\n') && strlen(all) + strlen(text) < 900);
    strcat(strcat(all, text), "\n");
}

static void expect(void (*hint)(const scene *s, const note_sink *taker), const char *file, const char *hints)
{
    scene *s;
    char all[1000] = "";
    assert_int_equal(scene_read_text("t.yaml", file, strlen(file), &s, NULL), STATUS_OK);
    hint(s, &(note_sink){append_line, all});
    assert_string_equal(all, hints);
    scene_destroy(s);
}

static void expect_hints(const char *file, const char *hints)
{
    expect(scene_hints, file, hints);
}

static void missing_objects_and_lights_give_a_hint(void **state)
{
    (void)state;
    static const char none[] = "solids: no visible solids: the image shows only the background; add solids:\n";
    expect_hints("{}", none);
    expect_hints("solids: {ball: {shape: sphere, visible: no}}", none);
    expect_hints("solids: {ball: {shape: sphere, diffuse: 1}, egg: {shape: sphere, specular: 1, radius: 2}}",
                 "lights: no lights: opaque surfaces show only ambient and emitted light; add lights:\n");
    expect_hints(LIT "solids: {ball: {shape: sphere}}",
                 "ball.diffuse: ball is black: it is neither transparent, nor diffuse, nor ambient, nor "
                 "emitting; set its diffuse\n");
    expect_hints(LIT "solids: {ball: {shape: sphere, emission: 0.5}}", "");
    expect_hints(LIT
                 "lens_systems: {eye: {pupil: 10, surfaces: [{radius: 60, thickness: 6, medium: bk7, stop: on, hole: "
                 "1}, {radius: -45, thickness: 0}]}}",
                 "eye: not read: the inner radius of the aperture of surface 1, which is no mirror\n");
    expect_hints("render: {integrator: path}\nsolids: {ball: {shape: sphere, diffuse: 1}, egg: {shape: sphere, "
                 "emission: 1, radius: 2}}",
                 "");
    expect_hints(LIT "solids: {ball: {shape: sphere, transparency: 1}}",
                 "ball.ior: ball is transparent with the refractive index of the surrounding medium: it is "
                 "invisible; set its ior\n");
    expect_hints(LIT "solids: {ball: {shape: sphere, transparency: 1, specular: 0.5}}",
                 "ball.ior: ball is transparent with the refractive index of the surrounding medium: it is "
                 "invisible; set its ior\n");
    expect_hints(LIT "solids: {ball: {shape: sphere, transparency: 0.5}}",
                 "ball.ior: ball is transparent with the refractive index of the surrounding medium: it is "
                 "invisible; set its ior\n");
    expect_hints(LIT "solids: {ball: {shape: sphere, transparency: 1, emission: 0.5}}", "");
    expect_hints(LIT "solids: {ball: {shape: sphere, transparency: 1, absorb_per_m: [1, 0, 0]}}",
                 "ball.ior: ball is transparent with the refractive index of the surrounding medium: it "
                 "refracts no light; set its ior\n");
    expect_hints(LIT "solids: {ball: {shape: sphere, ior: 1.5}, egg: {shape: sphere, diffuse: 1, ior: 0.9, radius: 2}}",
                 "ball.ior: ball has a refractive index but is opaque; set its transparency\n"
                 "egg.ior: egg has a refractive index but is opaque; set its transparency\n");
}

static void extrapolated_dispersion_laws_give_a_hint(void **state)
{
    (void)state;
    expect_hints("solids: {drop: {shape: sphere, transparency: 1, medium: ethanol}}", "");
    expect_hints("render: {lambda_nm: 450}\nsolids: {drop: {shape: sphere, transparency: 1, medium: ethanol}}",
                 "drop.medium: ethanol was measured only from 476.5 to 830 nm and is extrapolated outside; "
                 "use wavelengths in this range, or coefficients with a wider range\n");
    expect_hints("render: {spectrum: spectral}\nsolids: {drop: {shape: sphere, transparency: 1, medium: water}}", "");
    expect_hints("render: {spectrum: spectral}\nsolids: {drop: {shape: sphere, transparency: 1, medium: ethanol}}",
                 "drop.medium: ethanol was measured only from 476.5 to 830 nm and is extrapolated outside; "
                 "use wavelengths in this range, or coefficients with a wider range\n");
    expect_hints("render: {lambda_nm: 450}\nbackground: {medium: ethanol}\nsolids: {drop: {shape: sphere, "
                 "transparency: 1, ior: 1.5}}",
                 "background.medium: ethanol was measured only from 476.5 to 830 nm and is extrapolated "
                 "outside; use wavelengths in this range, or coefficients with a wider range\n");
    expect_hints("background: {medium: water}\nsolids: {drop: {shape: sphere, transparency: 1, medium: water}}",
                 "drop.ior: drop is transparent with the refractive index of the surrounding medium: it is "
                 "invisible; set its ior\n");
}

static void at_one_wavelength(const scene *s, const note_sink *taker)
{
    scene_lambda_range_hints(s, true, taker);
}

/* An rgb film has metals in daylight, and a probe with --lambda at its wavelength. */
static void metals_out_of_their_range_give_a_hint(void **state)
{
    (void)state;
#define BEYOND "use wavelengths in this range, or the ior and extinction of the wavelength\n"
    static const char mirror[] = "render: {lambda_nm: 250}\nsolids: {mirror: {shape: plane, medium: silver}}";
    static const char silver[] =
        "mirror.medium: silver was measured only from 367.9 to 821.1 nm and is constant outside; " BEYOND;
    expect_hints(mirror, "");
    expect(at_one_wavelength, mirror, silver);
    expect_hints("render: {spectrum: spectral}\nsolids: {mirror: {shape: plane, medium: silver}}", "");
    expect(scene_beam_range_hints,
           "beams: {a: {lambda_nm: 600}, b: {lambda_nm: 250}, c: {lambda_nm: 200}}\n"
           "solids: {one: {shape: sphere, medium: aluminium}, two: {shape: sphere, ior: 0.05, extinction: 3}}",
           "one.medium: aluminium was measured only from 364.66 to 815.69 nm and is constant outside: the beam b has "
           "250 nm; " BEYOND);
#undef BEYOND
}

static void media_out_of_the_range_of_beams_give_a_hint(void **state)
{
    (void)state;
#define BEYOND "use wavelengths in this range, or coefficients with a wider range\n"
#define BALL "solids: {ball: {shape: sphere, transparency: 1, medium: bk7}}"
    static const char bk7[] = "ball.medium: bk7 was measured only from 300 to 2500 nm and is extrapolated outside: the "
                              "beam l has 210 nm; " BEYOND;
    expect_hints("beams: {l: {lambda_nm: 210}}\n" BALL, "");
    expect(scene_beam_range_hints, "beams: {l: {lambda_nm: 210}}\n" BALL, bk7);
    expect(scene_beam_range_hints, "beams: {l: {lambda_nm: 210, visible: off}}\n" BALL, "");
    expect(scene_beam_range_hints, "render: {lambda_nm: 210}\nbeams: {l: {lambda_nm: 300}}\n" BALL, "");
    expect(scene_beam_range_hints,
           "beams: {l: {lambda_nm: 210}}\n"
           "solids: {ball: {shape: sphere, visible: off, transparency: 1, medium: bk7}}",
           "");
    expect(scene_beam_range_hints, "beams: {l: {white: on}}\nbackground: {medium: ethanol}\nsolids: {}",
           "background.medium: ethanol was measured only from 476.5 to 830 nm and is extrapolated outside: the beam l "
           "has 400 to 700 nm; " BEYOND);
#undef BALL
#undef BEYOND
}

/* The same notes as of a change on the command line, of a material that no solid shows once. */
static void what_a_file_sets_in_vain_gives_a_hint(void **state)
{
    (void)state;
    static const char smooth[] = "no effect with render.integrator=whitted; set render.integrator=path\n";
    char text[300];
    snprintf(text, sizeof text, "ball.roughness: %s", smooth);
    expect_hints(LIT "solids: {ball: {shape: sphere, transparency: 1, ior: 1.5, roughness: 0.3}}", text);
    expect_hints("render: {integrator: path}\nlights: {lamp: {radius: 1, reach: 5}}\n"
                 "solids: {ball: {shape: sphere, transparency: 1, ior: 1.5, roughness: 0.3}}",
                 "");
    snprintf(text, sizeof text, "dull.roughness: %s", smooth);
    expect_hints(LIT
                 "materials: {dull: {reflectivity: 0.5, roughness: 0.3}, unused: {roughness: 0.2}}\n"
                 "solids: {a: {shape: sphere, material: dull}, b: {shape: box, material: dull, position: [4, 0, 0]}}",
                 text);
    snprintf(text, sizeof text, "dull.roughness: %sb.roughness: %s", smooth, smooth);
    expect_hints(LIT
                 "materials: {dull: {reflectivity: 0.5, roughness: 0.3}}\n"
                 "solids: {a: {shape: sphere, material: dull}, b: {shape: box, material: dull, position: [4, 0, 0], "
                 "roughness: 0.2}}",
                 text);
    expect_hints(LIT "solids: {ball: {shape: sphere, transparency: 1, ior: 1.5, extinction: 2}}",
                 "ball.extinction: no effect with ball.transparency=1; set ball.transparency=0\n");
    expect_hints(LIT "materials: {m: {ior: 0.05, extinction: 3}}\nsolids: {a: {shape: sphere, material: m}, b: {shape: "
                     "box, material: m, transparency: 1, ior: 1.5, position: [4, 0, 0]}}",
                 "");
    expect_hints(LIT "render: {weights: constant}\nsolids: {ball: {shape: sphere, transparency: 1, ior: 1.5, "
                     "film_thickness_nm: 300}}",
                 "ball.film_thickness_nm: a film needs the Fresnel equations, and this scene has constant weights; set "
                 "render.weights=fresnel and render.transmission=refract\n");
}

static void ineffective_parameters_give_a_hint(void **state)
{
    (void)state;
    expect_hints("render: {integrator: path, polarisation: \"on\"}\nsolids: {milk: {shape: sphere, transparency: 1, "
                 "ior: 1.34, scatter_per_m: 2}}",
                 "milk.scatter_per_m: the light that milk scatters is unpolarised: its phase function does not "
                 "polarise\n");
    expect_hints("render: {lambda_nm: 700}\nsolids: {drop: {shape: sphere, transparency: 1, medium: table, "
                 "coefficients: [450, 1.34, 650, 1.33]}}",
                 "drop.coefficients: its table of indices covers only 450 to 650 nm and is constant "
                 "outside; use wavelengths in this range, or coefficients with a wider range\n");
    expect_hints("solids: {drop: {shape: sphere, transparency: 1, ior: 1.3, coefficients: [1.5, 0.004]}}",
                 "drop.coefficients: drop has coefficients but no dispersion law; set its medium to cauchy, "
                 "sellmeier or table\n");
    expect_hints(LIT "solids: {ball: {shape: sphere, diffuse: 1, absorb_per_m: [1, 0, 0]}}",
                 "ball.absorb_per_m: ball absorbs but is opaque; set its transparency\n");
    static const char lit[] = "lights: {lamp: {radius: 1, reach: 5}}\nsolids: {ball: {shape: sphere, diffuse: 1}}";
    expect_hints(lit, "lamp.radius: lamp acts as a point light; set render.soft_shadows=on, or "
                      "render.integrator=path\n");
    expect_hints("render: {integrator: path}\nlights: {lamp: {radius: 1, reach: 5}}\nsolids: {ball: {shape: sphere, "
                 "diffuse: 1}}",
                 "");
    expect_hints(
        "render: {integrator: path}\nlights: {lamp: {}}\nsolids: {ball: {shape: sphere, transparency: 1, ior: 1.5}}",
        "lamp.radius: lamp is a point light, which random paths cannot hit through transparent "
        "solids: no caustics; set render.caustics=photons, or its radius and its reach\n");
    expect_hints("render: {integrator: path, caustics: photons}\nlights: {lamp: {}}\nsolids: {ball: {shape: sphere, "
                 "transparency: 1, ior: 1.5}}",
                 "");
    expect_hints("render: {integrator: path}\nlights: {lamp: {}}\nsolids: {ball: {shape: sphere, diffuse: 1}}", "");
    expect_hints(
        "lights: {lamp: {polarised: 0.5}}\nsolids: {ball: {shape: sphere, diffuse: 1}}",
        "lamp.polarised: light is traced without its polarisation: the polarisation of lamp has no effect; set "
        "render.polarisation to on\n");
    expect_hints("beams: {laser: {lights: on}}\nsolids: {ball: {shape: sphere, diffuse: 1}}",
                 "lights: no lights: opaque surfaces show only ambient and emitted light; add lights:\n"
                 "laser.lights: laser lights nothing: only photons carry the light of beams; set "
                 "render.caustics=photons\n");
    expect_hints(
        "render: {caustics: photons}\nbeams: {laser: {lights: on}}\nsolids: {ball: {shape: sphere, diffuse: 1}}", "");
    expect_hints("lights: {noon: {kind: sun}}\nsolids: {ball: {shape: sphere, diffuse: 1}}",
                 "noon.angular_diameter_deg: all light of noon is parallel; set render.soft_shadows=on, or "
                 "render.integrator=path\n");
    expect_hints("lights: {noon: {kind: sun, angular_diameter_deg: 0, radius: 1}}\n"
                 "solids: {ball: {shape: sphere, diffuse: 1}}",
                 "");
    expect_hints("render: {integrator: path}\nlights: {noon: {kind: sun}}\n"
                 "solids: {ball: {shape: sphere, transparency: 1, ior: 1.5}}",
                 "noon.angular_diameter_deg: random paths through transparent solids rarely hit noon, which is small: "
                 "caustics are noise; set render.caustics=photons\n");
}

static void features_that_the_z_buffer_does_not_render_give_a_hint(void **state)
{
    (void)state;
    expect_hints(
        LIT "render: {integrator: zbuffer}\nsolids: {ball: {shape: sphere, transparency: 1, ior: 1.5, specular: 1}}",
        "");
    expect_hints(LIT "render: {integrator: zbuffer, lighting: phong}\nsolids: {ball: {shape: sphere, transparency: 1, "
                     "ior: 1.5, specular: 1}}",
                 "render.lighting: ball is transparent: without reflected and refracted rays its surface is "
                 "black except for highlights; set render.lighting to whitted\n");
    expect_hints(
        LIT "render: {integrator: zbuffer}\nsolids: {ball: {shape: sphere, transparency: 1, ior: 1.5, diffuse: 0.2}}",
        "");
    expect_hints(LIT "render: {integrator: zbuffer}\nsolids: {ball: {shape: sphere, diffuse: 1}}", "");
}

static void hidden_solids_give_a_hint(void **state)
{
    (void)state;
    static const char shell[] = "lights: {lamp: {}}\nsolids: {shell: {shape: sphere, transparency: 1, ior: 1.5}, ";
    static const struct {
        const char *solid;
        bool hidden;
    } cases[] = {
        {"x: {shape: sphere, diffuse: 1, radius: 0.5}}", true},
        {"x: {shape: sphere, diffuse: 1, radius: 0.999}}", true},
        {"x: {shape: sphere, diffuse: 1}}", true},
        {"x: {shape: sphere, diffuse: 1, radius: 0.5, priority: -1}}", true},
        {"x: {shape: sphere, diffuse: 1, radius: 0.5, priority: 1}}", false},
        {"x: {shape: sphere, diffuse: 1, radius: 1.2}}", false},
        {"x: {shape: box, diffuse: 1, size: [1, 1, 1]}}", true},
        {"x: {shape: box, diffuse: 1, size: [1, 1, 2]}}", false},
        {"x: {shape: box, diffuse: 1, size: [0.1, 1.9, 0.1], rotation: [0, 0, 45]}}", true},
        {"x: {shape: cylinder, diffuse: 1, radius: 0.5, height: 0.8}}", true},
        {"x: {shape: cylinder, diffuse: 1, radius: 0.5, height: 1.1}}", false},
        {"x: {shape: cup, diffuse: 1, radius: 0.5, inner_radius: 0.3, height: 0.8}}", true},
        {"x: {shape: plane, diffuse: 1}}", false},
        {"x: {shape: sphere, diffuse: 1, radius: 0.5, visible: off}}", false},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char file[300];
        snprintf(file, sizeof file, "%s%s", shell, cases[i].solid);
        expect_hints(file,
                     cases[i].hidden
                         ? "x.priority: x is entirely inside shell, which has precedence there and hides it; give x "
                           "the higher priority\n"
                         : "");
    }
}

static void intended_settings_give_no_hint(void **state)
{
    (void)state;
    expect_hints(LIT "solids: {a: {shape: sphere, ambient: 1}, b: {shape: sphere, reflectivity: 1, radius: 2}, "
                     "c: {shape: sphere, specular: 1, radius: 3}, d: {shape: sphere, visible: off}}",
                 "");
    expect_hints("solids: {glow: {shape: sphere, ambient: 1}}", "");
    expect_hints("solids: {lens: {shape: sphere, transparency: 1, ior: 1.5}}", "");
    expect_hints("solids: {lens: {shape: sphere, transparency: 1, ior: 1.5}, "
                 "bubble: {shape: sphere, transparency: 1, radius: 0.5, priority: 1}}",
                 "");
    expect_hints("render: {weights: constant}\nsolids: {veil: {shape: sphere, transparency: 0.5}}", "");
}

static void the_shipped_scenes_give_no_hint(void **state)
{
    (void)state;
    static const char *const names[] = {"rod", "rod-leaning", "rod-from-inside", "solids", "rainbow", "plates"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        char path[100], all[1000] = "";
        scene *s;
        snprintf(path, sizeof path, "experiments/scenes/%s.yaml", names[i]);
        assert_int_equal(scene_read(path, &s, NULL), STATUS_OK);
        scene_hints(s, &(note_sink){append_line, all});
        assert_string_equal(all, "");
        scene_destroy(s);
    }
}

static void crystals_that_split_no_light_give_a_hint(void **state)
{
    (void)state;
#define STONE "stone: {shape: sphere, transparency: 1, ior: 1.6, extraordinary_ior: 1.5}"
    expect_hints(LIT "solids: {" STONE "}", "");
    expect_hints(
        LIT "render: {weights: constant}\nsolids: {" STONE "}",
        "stone.extraordinary_ior: the crystal stone gives one image: light is refracted by its ordinary index "
        "alone; set render.lighting to whitted, render.weights to fresnel, and render.transmission to refract\n");
    expect_hints(LIT "render: {integrator: raycast}\nsolids: {" STONE "}",
                 "stone.extraordinary_ior: the crystal stone gives one image: light is refracted by its ordinary index "
                 "alone; set render.integrator to whitted\n");
    expect_hints(LIT "render: {caustics: photons}\nsolids: {" STONE "}",
                 "stone.extraordinary_ior: photons are refracted by the ordinary index of the crystal stone alone; set "
                 "render.caustics to off\n");
#undef STONE
}

/* Each value alone, and with what makes it act. */
static void alpha_that_is_ignored_gives_a_hint(void **state)
{
    (void)state;
    static const char *const cases[][2] = {
        {"wall.alpha=mask", ""},
        {"wall.alpha=blend", ""},
        {"wall.alpha=opaque", "crate.alpha: the image on crate has alpha, which is ignored; set its alpha to mask or "
                              "blend\n"}};
    for (size_t i = 0; i < 3; i++) {
        scene *s;
        char all[1000] = "";
        assert_int_equal(scene_read("tests/data/acts/holes.yaml", &s, NULL), STATUS_OK);
        assert_int_equal(scene_set_assignment(s, cases[i][0], NULL), STATUS_OK);
        assert_int_equal(scene_load(s, NULL), STATUS_OK);
        scene_hints(s, &(note_sink){append_line, all});
        assert_string_equal(all, cases[i][1]);
        scene_destroy(s);
    }
}

static void values_that_another_parameter_overrides_give_a_hint(void **state)
{
    (void)state;
#define BALL(what) "render: {integrator: path}\nsolids: {ball: {shape: sphere, " what "}}"
    expect_hints(BALL("transparency: 1, ior: 1.5, asymmetry: -0.5"),
                 "ball.asymmetry: ball does not scatter light: its asymmetry has no effect; set its scatter_per_m\n");
    expect_hints(BALL("transparency: 1, ior: 1.5, asymmetry: -0.5, scatter_per_m: 1"), "");
    expect_hints(LIT "solids: {ball: {shape: sphere, transparency: 1, ior: 1.5, retardance_deg: 90}}",
                 "ball.retardance_deg: ball is not a retarder and retards no light; set its sheet to retarder\n");
    expect_hints(LIT "solids: {ball: {shape: sphere, transparency: 1, ior: 1.5, birefringence: -0.01}}",
                 "ball.birefringence: ball is not a retarder and retards no light; set its sheet to retarder\n");
    expect_hints(LIT "render: {polarisation: on}\nsolids: {ball: {shape: sphere, transparency: 1, ior: 1.5, "
                     "retardance_deg: 90, sheet: retarder}}",
                 "");
    expect_hints(LIT "solids: {ball: {shape: sphere, diffuse: 1, extraordinary_ior: 1.5}}",
                 "ball.extraordinary_ior: ball has an extraordinary index but is opaque; set its transparency\n");
    expect_hints(LIT "solids: {ball: {shape: sphere, transparency: 1, ior: 1.5, absorb_per_m: [0, 0, 1], "
                     "absorb_spectrum: [400, 1, 700, 2]}}",
                 "ball.absorb_per_m: the absorb_spectrum of ball replaces its absorb_per_m; remove it, or "
                 "absorb_spectrum\n");
    expect_hints(LIT "solids: {ball: {shape: sphere, medium: silver, reflectivity: 0.5}}",
                 "ball.reflectivity: the complex index of ball determines what it reflects: its reflectivity has no "
                 "effect; remove it\n");
    expect_hints(LIT "solids: {ball: {shape: sphere, diffuse: 1, film_thickness_nm: 300, reflectivity: 0.5}}",
                 "ball.reflectivity: the film of ball determines what it reflects: its reflectivity has no effect; "
                 "remove it\n");
    expect_hints(LIT "solids: {ball: {shape: sphere, transparency: 1, ior: 1.5, film_thickness_nm: 300, "
                     "reflectivity: 0.5}}",
                 "");
#undef BALL
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(values_that_another_parameter_overrides_give_a_hint),
        cmocka_unit_test(alpha_that_is_ignored_gives_a_hint),
        cmocka_unit_test(crystals_that_split_no_light_give_a_hint),
        cmocka_unit_test(missing_objects_and_lights_give_a_hint),
        cmocka_unit_test(extrapolated_dispersion_laws_give_a_hint),
        cmocka_unit_test(metals_out_of_their_range_give_a_hint),
        cmocka_unit_test(media_out_of_the_range_of_beams_give_a_hint),
        cmocka_unit_test(what_a_file_sets_in_vain_gives_a_hint),
        cmocka_unit_test(ineffective_parameters_give_a_hint),
        cmocka_unit_test(features_that_the_z_buffer_does_not_render_give_a_hint),
        cmocka_unit_test(hidden_solids_give_a_hint),
        cmocka_unit_test(intended_settings_give_no_hint),
        cmocka_unit_test(the_shipped_scenes_give_no_hint),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
