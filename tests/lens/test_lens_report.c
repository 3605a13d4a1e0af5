/* The report of a lens against closed forms, published values, and Seidel sums against real rays. Rays are traced
 * through the solids that the prescription stands for. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "lens/lens.h"
#include "scene/model/edit/edit.h"
#include "scene/model/params.h"
#include <stdlib.h>
#include <string.h>

#define DEGREE (M_PI / 180.0)
#define assert_near(a, b, tolerance) assert_true(fabs((a) - (b)) <= (tolerance))

/* --- lenses --- */

enum { ROOM = 16 };

typedef struct bench {
    lens_surface surface[ROOM];
    lens_prescription p;
    lens_options options;
    lens_report report;
} bench;

static bench *begin(lens_aperture_kind kind, double aperture)
{
    bench *b = calloc(1, sizeof *b);
    assert_non_null(b);
    b->p = lens_prescription_empty();
    b->p.surface = b->surface;
    b->p.aperture_kind = kind;
    b->p.aperture = aperture;
    b->p.stop = 0;
    b->options = lens_options_usual;
    return b;
}

/* index 1: air; below 0: a mirror. */
static lens_surface *add(bench *b, double radius, double thickness, double index, double diameter)
{
    lens_surface *s = &b->surface[b->p.count++];
    *s = (lens_surface){.radius = radius, .thickness = thickness, .diameter = diameter, .mirror = index < 0.0};
    s->medium = index > 1.0 ? lens_medium_of_numbers(index, 0.0) : (lens_medium){.kind = LENS_AIR};
    return s;
}

static void field(bench *b, double y)
{
    b->p.field[0] = (lens_field){0.0, y, 1.0};
    b->p.field_count = 1;
}

static void make(bench *b)
{
    diagnostic why = {0};
    scene *s = NULL;
    lens_place place;
    char text[DIAGNOSTIC_TEXT_MAX];
    lens_report_release(&b->report);
    status code = lens_place_alone(&b->p, NULL, &s, &place, &why);
    if (code == STATUS_OK)
        code = lens_report_make(&b->p, &place, isa_best(), &b->options, &b->report, &why);
    if (code != STATUS_OK)
        fail_msg("%s", diagnostic_text(&why, text, sizeof text));
    scene_destroy(s);
}

static void end(bench *b)
{
    lens_report_release(&b->report);
    free(b);
}

/* The value of a row; x NaN, surface 0: any. NaN if there is none. */
static double at(const bench *b, const char *section, int surface, double x, const char *quantity)
{
    for (size_t i = 0; i < b->report.count; i++) {
        const lens_row *r = &b->report.row[i];
        if (strcmp(r->section, section) == 0 && strcmp(r->quantity, quantity) == 0 &&
            (surface == 0 || r->surface == surface) && (isnan(x) || fabs(r->x - x) < 1e-9))
            return r->value;
    }
    return NAN;
}

static double first(const bench *b, const char *quantity)
{
    return at(b, "first-order", 0, NAN, quantity);
}

static double sum(const bench *b, const char *quantity)
{
    return at(b, "seidel-sum", 0, NAN, quantity);
}

static bench *parabola(double number, double y)
{
    bench *b = begin(LENS_APERTURE_PUPIL, 200.0 / number);
    add(b, -400.0, -200.0, -1.0, 220.0 / number)->conic = -1.0;
    field(b, y);
    return b;
}

/* Optiland's sample lenses (HarrisonKramer/optiland, optiland/samples; after Zemax's samples and Laikin, Lens Design).
 * Indices are the catalogues' n_d. */
static bench *double_gauss(void)
{
    bench *b = begin(LENS_APERTURE_NUMBER, 5.0);
    add(b, 56.20238, 8.75, 1.62229, 60.0);
    add(b, 152.28580, 0.5, 1.0, 60.0);
    add(b, 37.68262, 12.5, 1.60738, 50.0);
    add(b, 0.0, 3.8, 1.60342, 50.0);
    add(b, 24.23130, 16.369445, 1.0, 36.0);
    add(b, 0.0, 13.747957, 1.0, 34.0);
    add(b, -28.37731, 3.8, 1.60342, 36.0);
    add(b, 0.0, 11.0, 1.62041, 40.0);
    add(b, -37.92546, 0.5, 1.0, 44.0);
    add(b, 177.41176, 7.0, 1.62041, 50.0);
    add(b, -79.41143, 61.487536, 1.0, 50.0);
    b->p.stop = 5;
    field(b, 14.0);
    return b;
}

/* --- first order --- */

static void a_thick_lens_has_the_focal_length_of_the_lensmakers_formula(void **state)
{
    (void)state;
    bench *b = begin(LENS_APERTURE_PUPIL, 10.0);
    const double n = 1.5168, R1 = 50.0, R2 = -70.0, d = 9.0;
    add(b, R1, d, n, 30.0);
    add(b, R2, 45.0, 1.0, 30.0);
    make(b);
    /* Hecht, Optics, (6.2), (6.3). */
    const double f = 1.0 / ((n - 1.0) * (1.0 / R1 - 1.0 / R2 + (n - 1.0) * d / (n * R1 * R2)));
    assert_near(first(b, "efl"), f, 1e-12);
    assert_near(first(b, "z_principal"), -f * (n - 1.0) * d / (R2 * n), 1e-12);
    assert_near(first(b, "z_principal_rear"), d - f * (n - 1.0) * d / (R1 * n), 1e-12);
    assert_near(first(b, "bfl"), f * (1.0 - (n - 1.0) * d / (n * R1)), 1e-12);
    assert_near(first(b, "ffl"), -f * (1.0 + (n - 1.0) * d / (n * R2)), 1e-12);
    assert_near(first(b, "z_nodal"), first(b, "z_principal"), 1e-12);
    assert_near(first(b, "f_number"), f / 10.0, 1e-12);
    end(b);
}

static void an_object_at_twice_the_focal_length_has_magnification_1(void **state)
{
    (void)state;
    bench *b = begin(LENS_APERTURE_PUPIL, 4.0);
    const double n = 1.5, R = 100.0, d = 1.0;
    add(b, R, d, n, 16.0);
    add(b, -R, 200.0, 1.0, 16.0);
    const double f = 1.0 / ((n - 1.0) * (2.0 / R - (n - 1.0) * d / (n * R * R)));
    const double principal = f * (n - 1.0) * d / (R * n);
    b->p.object_distance = 2.0 * f - principal;
    b->p.surface[1].thickness = 2.0 * f - principal;
    b->p.field_kind = LENS_FIELD_OBJECT;
    field(b, 1.0);
    make(b);
    assert_near(first(b, "magnification"), -1.0, 1e-12);
    assert_near(first(b, "z_paraxial_image"), first(b, "z_image"), 1e-10);
    assert_near(at(b, "chief", 0, NAN, "image_y"), -1.0, 1e-3);
    assert_near(at(b, "field-curves", 0, 1.0, "ideal_height"), -1.0, 1e-10);
    end(b);
}

static void the_cooke_triplet_has_optilands_paraxial_values(void **state)
{
    (void)state;
    bench *b = begin(LENS_APERTURE_PUPIL, 10.0);
    /* Indices of SK16 and F2 at 550 nm; optiland/tests/paraxial/test_paraxial.py. */
    const double sk16 = 1.6226077, f2 = 1.6236551;
    add(b, 22.01359, 3.25896, sk16, 19.0);
    add(b, -435.76044, 6.00755, 1.0, 19.0);
    add(b, -22.21328, 0.99997, f2, 10.0);
    add(b, 20.29192, 4.75041, 1.0, 10.0);
    add(b, 79.68360, 2.95208, sk16, 15.0);
    add(b, -18.39533, 42.20778, 1.0, 15.0);
    b->p.stop = 3;
    b->p.wavelength[0].nm = 550.0;
    field(b, 20.0);
    make(b);
    assert_near(first(b, "efl"), 49.999, 1e-2);
    assert_near(first(b, "ffl"), -37.345, 1e-2);
    assert_near(first(b, "z_paraxial_image") - first(b, "z_image"), 0.207, 1e-2);
    assert_near(first(b, "z_principal"), 12.654, 1e-2);
    assert_near(first(b, "z_entrance_pupil"), 11.512, 1e-2);
    assert_near(first(b, "z_exit_pupil") - first(b, "z_image"), -50.961, 1e-2);
    assert_near(first(b, "exit_pupil"), 10.233, 1e-2);
    assert_near(first(b, "f_number"), 4.999, 1e-2);
    assert_near(first(b, "lagrange_invariant"), 1.819, 1e-2);
    end(b);
}

/* --- Seidel sums --- */

static void a_double_gauss_has_optilands_seidel_sums(void **state)
{
    (void)state;
    bench *b = double_gauss();
    make(b);
    /* optiland/tests/aberrations/test_aberrations.py, which has the other sign. */
    assert_near(sum(b, "S_I"), 0.003929, 2e-5);
    assert_near(sum(b, "S_II"), -0.0003, 1e-4);
    assert_near(sum(b, "S_III"), -0.0034, 1e-4);
    assert_near(sum(b, "S_IV"), 0.0162, 1e-4);
    assert_near(sum(b, "S_V"), 0.0464, 1e-4);
    end(b);
}

static void a_plano_convex_lens_has_optilands_seidel_sums(void **state)
{
    (void)state;
    bench *b = begin(LENS_APERTURE_PUPIL, 25.4);
    add(b, 19.93, 7.0, 1.78472, 27.0);
    add(b, 0.0, 21.48, 1.0, 27.0);
    field(b, 14.0);
    make(b);
    const double published[] = {1.730769, -0.142537, 0.352955, 0.221200, 0.020854};
    const char *const name[] = {"S_I", "S_II", "S_III", "S_IV", "S_V"};
    for (int i = 0; i < 5; i++)
        assert_near(sum(b, name[i]), published[i], 2e-4 * fabs(published[i]) + 1e-5);
    end(b);
}

static void a_parabola_has_no_spherical_aberration_and_the_coma_of_its_formula(void **state)
{
    (void)state;
    bench *b = parabola(8.0, 0.0);
    make(b);
    assert_near(sum(b, "S_I"), 0.0, 1e-17);
    assert_near(at(b, "spot", 0, NAN, "geo"), 0.0, 1e-12);
    assert_near(at(b, "fan-tangential", 0, 1.0, "opd"), 0.0, 1e-9);
    assert_near(at(b, "wavefront", 0, NAN, "rms"), 0.0, 1e-9);
    assert_near(at(b, "wavefront", 0, NAN, "strehl_diffraction"), 1.0, 1e-9);
    field(b, 0.01);
    make(b);
    /* Tangential coma 3 f theta / (16 N^2) (Schroeder, Astronomical Optics); both edges are off by it. */
    const double coma =
        0.5 * (at(b, "fan-tangential", 0, 1.0, "e_tangential") + at(b, "fan-tangential", 0, -1.0, "e_tangential"));
    const double formula = 3.0 * 200.0 * 0.01 * DEGREE / (16.0 * 8.0 * 8.0);
    assert_near(fabs(coma), formula, 3e-3 * formula);
    end(b);
}

/* The wavefronts of real rays at a small aperture and a small field are those of the Seidel sums. Welford. */
static void seidel_sums_are_the_first_terms_of_real_wavefronts(void **state)
{
    (void)state;
    bench *b = double_gauss();
    b->p.aperture = 24.0;
    field(b, 2.0);
    make(b);
    b->p.surface[10].thickness += first(b, "z_paraxial_image") - first(b, "z_image");
    make(b);
    const double mm = b->p.wavelength[0].nm * 1e-6;
    double t[2], s[2];
    for (int i = 0; i < 2; i++) {
        t[i] = mm * at(b, "fan-tangential", 0, i ? 1.0 : -1.0, "opd");
        s[i] = mm * at(b, "fan-sagittal", 0, i ? 1.0 : -1.0, "opd");
    }
    const double W040 = sum(b, "S_I") / 8.0, W131 = sum(b, "S_II") / 2.0, W222 = sum(b, "S_III") / 2.0;
    const double W220 = (sum(b, "S_III") + sum(b, "S_IV")) / 4.0;
    const double size = fabs(W040) + fabs(W131) + fabs(W222) + fabs(W220);
    assert_near(0.5 * (s[0] + s[1]), W040 + W220, 0.02 * size);
    assert_near(0.5 * (t[0] + t[1]), W040 + W220 + W222, 0.02 * size);
    assert_near(0.5 * (t[1] - t[0]), W131, 0.02 * size);
    field(b, 0.0);
    make(b);
    assert_near(mm * at(b, "fan-tangential", 0, 1.0, "opd"), W040, 0.02 * fabs(W040));
    end(b);
}

/* Near the axis the two foci give Petzval's curvature and the astigmatism, the chief ray's height the distortion. */
static void coddingtons_foci_are_those_of_the_sums(void **state)
{
    (void)state;
    bench *b = double_gauss();
    field(b, 0.5);
    make(b);
    b->p.surface[10].thickness += first(b, "z_paraxial_image") - first(b, "z_image");
    make(b);
    const double t = at(b, "field-curves", 0, 0.5, "tangential"), s = at(b, "field-curves", 0, 0.5, "sagittal");
    const double u = 0.5 / first(b, "working_f_number"), per = 1.0 / (2.0 * u * u);
    /* z = -W 2 / u^2 with W220, W220 + W222: -(S_III + S_IV) / (2 u^2), -(3 S_III + S_IV) / (2 u^2). */
    assert_near(s, -per * (sum(b, "S_III") + sum(b, "S_IV")), 2e-3 * fabs(s));
    assert_near(t, -per * (3.0 * sum(b, "S_III") + sum(b, "S_IV")), 2e-3 * fabs(t) + 1e-5);
    /* delta y' = S_V / (2 n' u') */
    const double height = at(b, "field-curves", 0, 0.5, "ideal_height");
    assert_near(at(b, "field-curves", 0, 0.5, "distortion"), -100.0 * sum(b, "S_V") / (2.0 * u * height), 2e-5);
    end(b);
}

static void sums_of_colour_are_differences_of_paraxial_foci(void **state)
{
    (void)state;
    bench *b = begin(LENS_APERTURE_PUPIL, 5.0);
    add(b, 100.0, 3.0, 1.5, 30.0)->medium = lens_medium_of_numbers(1.5168, 64.17);
    add(b, -120.0, 95.0, 1.0, 30.0);
    b->p.stop = 1;
    b->p.wavelength[1] = (lens_wavelength){LINE_HYDROGEN_F_NM, 1.0};
    b->p.wavelength[2] = (lens_wavelength){LINE_HYDROGEN_C_NM, 1.0};
    b->p.wavelength_count = 3;
    field(b, 1.0);
    make(b);
    const double u = 0.5 / first(b, "working_f_number");
    double focus[3];
    int found = 0;
    for (size_t i = 0; i < b->report.count && found < 3; i++)
        if (strcmp(b->report.row[i].section, "axial-colour") == 0 && strcmp(b->report.row[i].quantity, "focus") == 0)
            focus[found++] = b->report.row[i].value;
    assert_int_equal(found, 3);
    /* delta l' = -C_L / (n' u'^2), to first order in the dispersion. */
    assert_near(focus[2] - focus[1], sum(b, "C_L") / (u * u), 2e-2 * fabs(focus[2] - focus[1]));
    end(b);
}

/* --- diffraction --- */

static void a_perfect_pupil_has_airys_image_and_its_mtf(void **state)
{
    (void)state;
    bench *b = parabola(20.0, 0.0);
    b->options.frequency_per_mm = 90.0;
    b->options.wave_grid = 128;
    make(b);
    for (int i = 1; i <= 40; i++) {
        const double f = 90.0 * i / 40.0, limit = at(b, "mtf-diffraction", 0, f, "limit");
        const double v = f * b->p.wavelength[0].nm * 1e-6 * 20.0;
        const double closed = v < 1.0 ? M_2_PI * (acos(v) - v * sqrt(1.0 - v * v)) : 0.0;
        assert_near(limit, closed, 1e-12);
        assert_near(at(b, "mtf-diffraction", 0, f, "tangential"), closed, 1.5e-3);
        assert_near(at(b, "mtf-diffraction", 0, f, "sagittal"), closed, 1.5e-3);
    }
    /* (2 J1(v) / v)^2: 0.8378 of the light is within the first zero, 0.910 within the second (Born and Wolf, ch. 8). */
    const double airy = at(b, "spot", 0, NAN, "airy_radius");
    assert_near(at(b, "encircled", 0, airy, "fraction"), 0.8378, 1e-3);
    int points = 0;
    for (size_t i = 0; i < b->report.count; i++) {
        const lens_row *r = &b->report.row[i];
        if (strcmp(r->section, "psf") != 0)
            continue;
        const double v = 2.0 * M_PI / (b->p.wavelength[0].nm * 1e-6) * sin(atan(1.0 / 40.0)) * r->x;
        const double shape = v == 0.0 ? 1.0 : 2.0 * j1(v) / v;
        assert_near(r->value, shape * shape, 2e-3);
        points++;
    }
    assert_true(points > 50);
    end(b);
}

static void a_known_defocus_has_the_strehl_ratio_of_its_sinc(void **state)
{
    (void)state;
    const double number = 20.0;
    for (int k = 1; k <= 3; k++) {
        bench *b = parabola(number, 0.0);
        b->options.wave_grid = 128;
        const double shift = 0.25 * k * b->p.wavelength[0].nm * 1e-6 * 8.0 * number * number;
        /* Over the distance from the pupil to the displaced image, in the mean of both. */
        const double waves = 0.25 * k * 200.0 / (200.0 - shift);
        b->p.surface[0].thickness += shift;
        make(b);
        /* Born and Wolf, ch. 8: (sin(pi W) / (pi W))^2 at the middle. */
        const double closed = pow(sin(M_PI * waves) / (M_PI * waves), 2);
        assert_near(at(b, "wavefront", 0, NAN, "strehl_diffraction"), closed, 3e-4);
        assert_near(at(b, "wavefront", 0, NAN, "pv"), waves, 5e-3 * waves);
        assert_near(at(b, "wavefront", 0, NAN, "rms"), waves / sqrt(12.0), 1e-3 * waves);
        assert_near(at(b, "wavefront", 0, NAN, "strehl_marechal"), exp(-M_PI * M_PI * waves * waves / 3.0), 1e-2);
        end(b);
    }
}

/* --- colour, vignetting, ghosts --- */

static void the_triplet_objective_has_optilands_distortion_and_focus(void **state)
{
    (void)state;
    bench *b = begin(LENS_APERTURE_NUMBER, 2.8);
    add(b, 50.098, 4.5, 1.51680, 40.0);
    add(b, -983.42, 0.1, 1.0, 40.0);
    add(b, 56.671, 4.5, 1.51680, 38.0);
    add(b, -171.15, 5.571, 1.0, 38.0);
    add(b, -97.339, 3.5, 1.71736, 36.0);
    add(b, 81.454, 75.132, 1.0, 36.0);
    field(b, 1.0);
    make(b);
    assert_near(at(b, "field-curves", 0, 1.0, "distortion"), 0.0057863, 1e-5);
    field(b, 55.0 / 127.0); /* the 56th of 128 points */
    make(b);
    assert_near(at(b, "field-curves", 0, 55.0 / 127.0, "sagittal"), -0.004469, 1e-3);
    end(b);
}

static void a_rim_takes_the_part_of_the_pupil_that_two_circles_leave(void **state)
{
    (void)state;
    bench *b = begin(LENS_APERTURE_PUPIL, 10.0);
    add(b, 0.0, 30.0, 1.0, 10.0);
    add(b, 500.0, 0.0495, 1.5, 14.0); /* as thin as its sag of 0.0490 allows */
    add(b, 0.0, 900.0, 1.0, 14.0);
    b->options.spot_grid = 128;
    field(b, atan(6.0 / 30.0) / DEGREE);
    make(b);
    /* The beam, of radius 5, is 6.01 mm off the axis of the rim, of radius 7, where the lens is full. */
    const double d = 0.2 * (30.0 + 0.0495), r = 5.0, R = 7.0;
    const double a = acos((d * d + r * r - R * R) / (2.0 * d * r)), c = acos((d * d + R * R - r * r) / (2.0 * d * R));
    const double lens = r * r * (a - sin(a) * cos(a)) + R * R * (c - sin(c) * cos(c));
    assert_near(at(b, "vignetting", 0, NAN, "passes"), lens / (M_PI * r * r), 3e-3);
    end(b);
}

static void a_plate_has_one_ghost_with_fresnels_weight(void **state)
{
    (void)state;
    bench *b = begin(LENS_APERTURE_PUPIL, 10.0);
    add(b, 100.0, 5.0, 1.5, 20.0);
    add(b, 0.0, 200.0, 1.0, 20.0);
    make(b);
    const double R = 0.04;
    assert_near(at(b, "ghosts", 2, 1.0, "weight"), (1.0 - R) * (1.0 - R) * R * R, 1e-15);
    /* By vergences in the lens: the flat side reflects, then side 1, of power -2 n / R within the glass. */
    const double n = 1.5, d = 5.0;
    double V = (n - 1.0) / 100.0;
    V = V / (1.0 - d * V / n), V = V / (1.0 - d * V / n);
    V += 2.0 * n / 100.0;
    V = V / (1.0 - d * V / n);
    assert_near(at(b, "ghosts", 2, 1.0, "focus") + 200.0, 1.0 / V, 1e-10);
    /* Over a second plate: it passes side 1, side 2 three times, and both sides of the plate. */
    b->p.surface[1].thickness = 10.0;
    add(b, 0.0, 3.0, 1.8, 20.0);
    add(b, 0.0, 180.0, 1.0, 20.0);
    make(b);
    const double S = pow(0.8 / 2.8, 2);
    assert_near(at(b, "ghosts", 3, 1.0, "weight"), pow(1.0 - R, 4) * S * R * pow(1.0 - S, 2), 1e-15);
    end(b);
}

/* A quarter-wave layer has R = ((n0 ns - n1^2) / (n0 ns + n1^2))^2 from both sides. The series of all numbers of
 * reflections between two surfaces is T^2 (R R')^k. */
static void coated_ghosts_have_the_powers_of_their_layers(void **state)
{
    (void)state;
    bench *b = begin(LENS_APERTURE_PUPIL, 10.0);
    diagnostic why = {0};
    scene *s = NULL;
    lens_place place;
    b->p.wavelength[0].nm = 550.0;
    add(b, 100.0, 5.0, 1.5, 20.0);
    add(b, 0.0, 200.0, 1.0, 20.0);
    assert_int_equal(lens_place_alone(&b->p, NULL, &s, &place, &why), STATUS_OK);
    assert_int_equal(scene_set_assignment(s, "lens.coating=1.38 550/4", &why), STATUS_OK);
    assert_int_equal(lens_report_make(&b->p, &place, isa_best(), &b->options, &b->report, &why), STATUS_OK);
    const double r = (1.5 - 1.38 * 1.38) / (1.5 + 1.38 * 1.38), R = r * r;
    assert_near(at(b, "ghosts", 2, 1.0, "weight"), (1.0 - R) * (1.0 - R) * R * R, 1e-16);
    assert_near(at(b, "ghosts-sum", 0, 2.0, "weight"), (1.0 - R) * (1.0 - R) * R * R, 1e-16);
    assert_near(at(b, "ghosts-sum", 0, 4.0, "weight"), (1.0 - R) * (1.0 - R) * R * R * R * R, 1e-18);
    scene_destroy(s);
    end(b);
}

/* A flat mirror behind a lens, tilted about X and Y, changes nothing but the place of the image. */
static void a_folded_system_has_the_report_of_the_straight_one(void **state)
{
    (void)state;
    static const struct {
        const char *section, *quantity;
    } rows[] = {{"spot", "rms_centroid"},           {"spot", "geo"},      {"wavefront", "rms"},
                {"vignetting", "passes"},           {"chief", "image_x"}, {"chief", "image_y"},
                {"wavefront", "strehl_diffraction"}};
    double value[2][8];
    for (int folded = 0; folded < 2; folded++) {
        bench *b = begin(LENS_APERTURE_PUPIL, 12.0);
        b->options = (lens_options){.fan_rays = 4, .spot_grid = 16, .wave_grid = 16};
        add(b, 60.0, 4.0, 1.6, 20.0);
        add(b, -300.0, folded ? 40.0 : 88.0, 1.0, 20.0);
        if (folded) {
            lens_surface *mirror = add(b, 0.0, -48.0, -1.0, 60.0);
            mirror->tilt_x_deg = 38.0, mirror->tilt_y_deg = -21.0;
        }
        b->p.field[0] = (lens_field){1.0, 3.0, 1.0};
        b->p.field_count = 1;
        make(b);
        for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
            value[folded][i] = at(b, rows[i].section, 0, NAN, rows[i].quantity);
        value[folded][7] = at(b, "field-curves", 0, sqrt(10.0), "tangential");
        end(b);
    }
    for (int i = 0; i < 8; i++)
        assert_near(fabs(value[0][i]), fabs(value[1][i]), 1e-9 * (1.0 + fabs(value[0][i])));
}

/* A mirror behind glass: its wavefront is free of spherical aberration if all surfaces have the object's place as their
 * centre, from which the light comes and to which it returns. */
static void a_concentric_mangin_mirror_is_perfect(void **state)
{
    (void)state;
    bench *b = begin(LENS_APERTURE_OBJECT, 0.2);
    b->p.object_distance = 100.0;
    add(b, -100.0, 6.0, 1.5, 60.0);
    add(b, -106.0, -6.0, -1.0, 60.0)->medium = lens_medium_of_numbers(1.5, 0.0);
    add(b, -100.0, -100.0, 1.0, 60.0);
    b->p.field_kind = LENS_FIELD_OBJECT;
    make(b);
    assert_near(first(b, "magnification"), -1.0, 1e-12);
    assert_near(at(b, "spot", 0, NAN, "geo"), 0.0, 1e-11);
    assert_near(at(b, "wavefront", 0, NAN, "rms"), 0.0, 1e-8);
    assert_near(at(b, "ghosts-sum", 0, 2.0, "omitted"), 3.0, 0.0);
    end(b);
}

/* All rows but those of diffraction, whose waves are not scaled. */
static void same_reports(const lens_report *a, const lens_report *b, double scale)
{
    static const char *const scaled[] = {"first-order",  "surfaces",     "seidel",     "seidel-sum",
                                         "axial-colour", "field-curves", "chief",      "fan-tangential",
                                         "fan-sagittal", "spot",         "vignetting", "ghosts"};
    size_t compared = 0;
    assert_int_equal(a->count, b->count);
    for (size_t i = 0; i < a->count; i++) {
        const lens_row *r = &a->row[i], *t = &b->row[i];
        assert_string_equal(r->section, t->section);
        assert_string_equal(r->quantity, t->quantity);
        for (size_t k = 0; k < sizeof scaled / sizeof *scaled; k++)
            if (strcmp(scaled[k], r->section) == 0 && strcmp(r->quantity, "airy_radius") != 0 && isfinite(r->value)) {
                const double by = strcmp(r->unit, "mm") == 0      ? scale
                                  : strcmp(r->unit, "1/mm") == 0  ? 1.0 / scale
                                  : strcmp(r->unit, "waves") == 0 ? scale
                                                                  : 1.0;
                assert_near(by * r->value, t->value, 1e-9 + 1e-7 * fabs(t->value));
                compared++;
            }
    }
    assert_true(compared > 500);
}

static lens_report report_of_scene(const bench *b, const char *const *changes)
{
    scene *s;
    diagnostic why = {.what = ""};
    lens_report out = {0};
    lens_place place;
    lens_prescription p;
    assert_int_equal(lens_scene_create(&b->p, NULL, &s, &why), STATUS_OK);
    for (; *changes; changes++)
        assert_int_equal(scene_set_assignment(s, *changes, &why), STATUS_OK);
    assert_int_equal(scene_load(s, &why), STATUS_OK);
    if (lens_place_in_scene(s, "objective", &p, &place, &why) != STATUS_OK ||
        lens_report_make(&p, &place, isa_best(), &b->options, &out, &why) != STATUS_OK)
        fail_msg("%s", why.what);
    lens_prescription_release(&p);
    scene_destroy(s);
    return out;
}

static void a_moved_turned_and_scaled_system_has_the_same_report(void **state)
{
    (void)state;
    bench *b = double_gauss();
    b->options = (lens_options){.fan_rays = 6, .spot_grid = 8, .wave_grid = 16};
    b->p.field[1] = (lens_field){3.0, 8.0, 1.0};
    b->p.field_count = 2;
    const char *const none[] = {NULL}, *const all[] = {"wall.visible=off", "objective.scale=2.5,2.5,2.5",
                                                       "objective.rotation=-30,20,250",
                                                       "objective.position=500,20,-3000", NULL};
    lens_report here = report_of_scene(b, none), there = report_of_scene(b, all);
    same_reports(&here, &there, 2.5);
    lens_report_release(&here);
    lens_report_release(&there);
    end(b);
}

static void what_cannot_be_reported_says_why(void **state)
{
    (void)state;
    bench *b = begin(LENS_APERTURE_PUPIL, 10.0);
    diagnostic why = {0};
    scene *s = NULL;
    lens_place place;
    add(b, 0.0, 5.0, 1.5, 20.0);
    add(b, 0.0, 200.0, 1.0, 20.0);
    assert_int_equal(lens_place_alone(&b->p, NULL, &s, &place, &why), STATUS_OK);
    assert_int_equal(lens_report_make(&b->p, &place, isa_best(), &b->options, &b->report, &why), STATUS_BAD_INPUT);
    assert_non_null(strstr(why.what, "afocal"));
    b->p.aperture = 0.0;
    b->p.surface[0].radius = 100.0;
    assert_int_equal(lens_report_make(&b->p, &place, isa_best(), &b->options, &b->report, &why), STATUS_BAD_INPUT);
    assert_non_null(strstr(why.what, "aperture"));
    scene_destroy(s);
    end(b);
}

/* An astigmat: its foci in both meridians, by first order, narrow pencils and rays. Seidel's sums are not known. */
static void an_astigmat_has_two_foci(void **state)
{
    (void)state;
    bench *b = begin(LENS_APERTURE_PUPIL, 4.0);
    add(b, 0.0, 4.0, 1.5, 12.0);
    lens_surface *back = add(b, -60.0, 150.0, 1.0, 12.0);
    back->form = SIDE_TORIC, back->radius_x = -100.0;
    field(b, 3.0);
    make(b);
    assert_near(first(b, "efl"), 120.0, 1e-10);
    assert_near(at(b, "first-order-x", 0, NAN, "efl"), 200.0, 1e-10);
    assert_near(at(b, "first-order-x", 0, NAN, "bfl"), 200.0, 1e-10);
    assert_near(at(b, "first-order-x", 0, NAN, "f_number"), 50.0, 1e-10);
    assert_near(at(b, "field-curves", 0, 0.0, "tangential"), 120.0 - 150.0, 1e-9);
    assert_near(at(b, "field-curves", 0, 0.0, "sagittal"), 200.0 - 150.0, 1e-9);
    assert_true(isnan(sum(b, "S_I")) && isnan(at(b, "seidel", 2, NAN, "S_IV")));
    assert_true(at(b, "spot", 0, NAN, "rms_centroid") > 0.1);
    /* with the image there, only coma and spherical aberration are left of narrow fans about the chief ray */
    const double foci[2] = {at(b, "field-curves", 0, 3.0, "sagittal"), at(b, "field-curves", 0, 3.0, "tangential")};
    back->thickness = 150.0 + foci[0];
    make(b);
    assert_near(at(b, "fan-sagittal", 0, 0.05, "e_sagittal"), 0.0, 1e-6);
    back->thickness = 150.0 + foci[1];
    make(b);
    assert_near(at(b, "fan-tangential", 0, 0.05, "e_tangential") - at(b, "fan-tangential", 0, -0.05, "e_tangential"),
                0.0, 1e-6);
    end(b);
}

/* r^2 is the paraboloid, with all of its sums; r and r^3 have none. */
static void the_square_is_a_paraboloid(void **state)
{
    (void)state;
    bench *b = begin(LENS_APERTURE_PUPIL, 10.0), *c = begin(LENS_APERTURE_PUPIL, 10.0);
    add(b, 50.0, 4.0, 1.5, 12.0)->conic = -1.0, add(b, 0.0, 97.0, 1.0, 12.0);
    add(c, 0.0, 4.0, 1.5, 12.0)->odd[1] = 0.01, add(c, 0.0, 97.0, 1.0, 12.0);
    field(b, 2.0), field(c, 2.0);
    make(b), make(c);
    assert_near(first(c, "efl"), 100.0, 1e-10);
    static const char *const names[] = {"S_I", "S_II", "S_III", "S_IV", "S_V"};
    for (int k = 0; k < 5; k++)
        assert_near(sum(b, names[k]), sum(c, names[k]), 1e-14);
    assert_near(at(b, "field-curves", 0, 2.0, "sagittal"), at(c, "field-curves", 0, 2.0, "sagittal"), 1e-9);
    assert_near(at(b, "spot", 0, NAN, "rms_centroid"), at(c, "spot", 0, NAN, "rms_centroid"), 1e-12);
    c->surface[0].odd[2] = 1e-6;
    make(c);
    assert_true(isnan(sum(c, "S_I")));
    end(b), end(c);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_thick_lens_has_the_focal_length_of_the_lensmakers_formula),
        cmocka_unit_test(an_object_at_twice_the_focal_length_has_magnification_1),
        cmocka_unit_test(the_cooke_triplet_has_optilands_paraxial_values),
        cmocka_unit_test(a_double_gauss_has_optilands_seidel_sums),
        cmocka_unit_test(a_plano_convex_lens_has_optilands_seidel_sums),
        cmocka_unit_test(a_parabola_has_no_spherical_aberration_and_the_coma_of_its_formula),
        cmocka_unit_test(seidel_sums_are_the_first_terms_of_real_wavefronts),
        cmocka_unit_test(coddingtons_foci_are_those_of_the_sums),
        cmocka_unit_test(sums_of_colour_are_differences_of_paraxial_foci),
        cmocka_unit_test(a_perfect_pupil_has_airys_image_and_its_mtf),
        cmocka_unit_test(a_known_defocus_has_the_strehl_ratio_of_its_sinc),
        cmocka_unit_test(the_triplet_objective_has_optilands_distortion_and_focus),
        cmocka_unit_test(a_rim_takes_the_part_of_the_pupil_that_two_circles_leave),
        cmocka_unit_test(a_plate_has_one_ghost_with_fresnels_weight),
        cmocka_unit_test(a_folded_system_has_the_report_of_the_straight_one),
        cmocka_unit_test(a_concentric_mangin_mirror_is_perfect),
        cmocka_unit_test(coated_ghosts_have_the_powers_of_their_layers),
        cmocka_unit_test(a_moved_turned_and_scaled_system_has_the_same_report),
        cmocka_unit_test(what_cannot_be_reported_says_why),
        cmocka_unit_test(an_astigmat_has_two_foci),
        cmocka_unit_test(the_square_is_a_paraboloid),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
