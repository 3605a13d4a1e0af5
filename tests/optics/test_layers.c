/* Tests of coatings as text and as films: what is read and refused; named designs against closed forms and their
 * titles; random stacks against an independent method, the recursion of Fresnel's coefficients from the last interface
 * to the first (Rouard; Macleod, Thin-Film Optical Filters, 4th ed., 2.5), in C's own complex numbers. */
#include <complex.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <cmocka.h>

#include "optics/coating.h"
#include "optics/media.h"
#include "random_stream.h"

#define COUNT(a) (sizeof(a) / sizeof((a)[0]))
#define assert_near(a, b, tolerance) assert_true(fabs((a) - (b)) <= (tolerance))

static film_stack stack_of(const char *text)
{
    coating_layers layers;
    diagnostic why = {.what = ""};
    film_stack s;
    if (coating_parse(text, &layers, &why) != STATUS_OK)
        fail_msg("%s: %s", text, why.what);
    film_stack_make((thin_film){complex_of(1.0, 0.0), 0.0}, &layers, NULL, false, &s);
    return s;
}

/* --- the independent method --- */

typedef struct answer {
    long double complex r_s, r_p;
    long double R_s, R_p, T_s, T_p;
} answer;

/* Recursion for one polarisation: r = (r1 + r2 e^(2 i d)) / (1 + r1 r2 e^(2 i d)), t = t1 t2 e^(i d) / (the same). q: n
 * cos (s) or cos / n (p) by medium. */
static void recursion(const long double complex *q, const long double complex *phase, int media, long double complex *r,
                      long double complex *t)
{
    *r = 0.0, *t = 1.0;
    for (int i = media - 2; i >= 0; i--) {
        const long double complex r1 = (q[i] - q[i + 1]) / (q[i] + q[i + 1]), t1 = 2.0 * q[i] / (q[i] + q[i + 1]),
                                  wave = i + 1 < media - 1 ? cexpl(I * phase[i + 1]) : 1.0,
                                  divisor = 1.0 + r1 * *r * wave * wave;
        *t = t1 * *t * wave / divisor;
        *r = (r1 + *r * wave * wave) / divisor;
    }
}

static answer by_recursion(double cos_i, double n_from, const thin_film *film, int count, long double complex to,
                           double lambda_nm)
{
    long double complex n[FILMS_MAX + 2], s[FILMS_MAX + 2], p[FILMS_MAX + 2], phase[FILMS_MAX + 2];
    const long double sine = n_from * sqrtl(1.0L - (long double)cos_i * cos_i);
    n[0] = n_from, n[count + 1] = to;
    for (int i = 0; i < count; i++)
        n[i + 1] = film[i].index.re + I * film[i].index.im;
    for (int i = 0; i < count + 2; i++) {
        long double complex c = csqrtl(1.0L - (sine / n[i]) * (sine / n[i]));
        if (cimagl(n[i] * c) < 0.0)
            c = -c;
        s[i] = n[i] * c, p[i] = c / n[i];
        phase[i] = i > 0 && i <= count ? 2.0L * acosl(-1.0L) * n[i] * c * film[i - 1].thickness_nm / lambda_nm : 0.0;
    }
    answer a;
    long double complex t_s, t_p;
    recursion(s, phase, count + 2, &a.r_s, &t_s);
    recursion(p, phase, count + 2, &a.r_p, &t_p);
    a.R_s = creall(a.r_s * conjl(a.r_s)), a.R_p = creall(a.r_p * conjl(a.r_p));
    a.T_s = creall(t_s * conjl(t_s)) * creall(s[count + 1]) / creall(s[0]);
    a.T_p = creall(t_p * conjl(t_p)) * creall(p[count + 1]) / creall(p[0]);
    return a;
}

static double apart(double a, long double b)
{
    return fabs((double)(a - b));
}

static void random_stacks_equal_the_recursion(void **state)
{
    (void)state;
    uint64_t seed = 531;
    double worst = 0.0;
    for (int i = 0; i < 20000; i++) {
        thin_film film[FILMS_MAX];
        const int count = random_below(&seed, 24), kind = i % 3; /* clear, absorbing, metals */
        const double k_most = kind == 0 ? 0.0 : kind == 1 ? 0.3 : 6.0;
        for (int j = 0; j < count; j++) {
            const bool again = j > 1 && random_below(&seed, 2); /* periodic in part */
            film[j] = again ? film[j - 2]
                            : (thin_film){complex_of(random_real(&seed, kind == 2 ? 0.1 : 1.0, 2.6),
                                                     random_real(&seed, 0.0, k_most)),
                                          random_real(&seed, 0.1, kind == 2 ? 40.0 : 300.0)};
        }
        const double n_from = random_real(&seed, 1.0, 1.9), cos_i = random_real(&seed, 0.01, 1.0),
                     n_to = random_real(&seed, 1.0, 1.9), k_to = i % 2 ? random_real(&seed, 0.0, k_most) : 0.0,
                     lambda_nm = random_real(&seed, 380.0, 780.0);
        const sp_amplitudes a = multilayer_amplitudes(cos_i, n_from, film, count, complex_of(n_to, k_to), lambda_nm);
        const answer b = by_recursion(cos_i, n_from, film, count, n_to + I * k_to, lambda_nm);
        worst = fmax(worst, apart(complex_norm2(a.r_s), b.R_s)),
        worst = fmax(worst, apart(complex_norm2(a.r_p), b.R_p));
        if (k_to > 0.0)
            continue; /* r and t are not powers then */
        worst = fmax(worst, apart(complex_norm2(a.t_s), b.T_s)),
        worst = fmax(worst, apart(complex_norm2(a.t_p), b.T_p));
        /* the phase of p relative to s: the recursion's r_p has the opposite sign */
        const complex_pair between = complex_conj_multiply(a.r_s, a.r_p);
        const long double complex product = conjl(b.r_s) * b.r_p;
        const double re = (double)creall(product), im = (double)cimagl(product);
        worst = fmax(worst, fmin(hypot(between.re - re, between.im - im), hypot(between.re + re, between.im + im)));
    }
    if (!(worst < 1e-12))
        fail_msg("largest difference %g", worst);
}

/* --- text --- */

static void lists_of_layers_are_read(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        int count, media;
    } valid[] = {{"1.38 99.7", 1, 1},
                 {"[mgf2 99.7, ta2o5 550/2]", 2, 2},
                 {"10x(tio2 550/4, sio2 550/4)", 20, 2},
                 {"2x(tio2 10), 1.5 3, 3x(1.5 4,tio2 5 )", 9, 2},
                 {"2.4+0.01i 20,data 30, silver 5.5", 3, 3},
                 {"Al 100", 1, 1},
                 {" mgf2   99.7 ", 1, 1}};
    for (size_t i = 0; i < COUNT(valid); i++) {
        const film_stack s = stack_of(valid[i].text);
        assert_int_equal(s.layers.count, valid[i].count);
        assert_int_equal(s.layers.media_count, valid[i].media);
    }
    const film_stack s = stack_of("2.4+0.01i 20, silver 5.5, mgf2 550/4");
    const complex_pair first = film_stack_index(&s, 0, 500.0), silver = metal_index(metals_find("silver"), 500.0),
                       second = film_stack_index(&s, 1, 500.0);
    assert_true(first.re == 2.4 && first.im == 0.01 && second.re == silver.re && second.im == silver.im && s.absorbs);
    assert_near(s.thickness_nm[2], 550.0 / 4.0 / medium_index(media_find("mgf2"), 550.0), 1e-12);
    assert_false(stack_of("mgf2 20, 1.5 3").absorbs);
}

static void what_is_no_coating_is_refused_with_a_remedy(void **state)
{
    (void)state;
    static const char *const invalid[][2] = {
        {"ar-55", "there is no coating 'ar-55'"},
        {"mgf3 20", "'mgf3' is no index of a layer"},
        {"mgf2", "there is no coating"},
        {"mgf2 20,", "a layer has no index"},
        {"mgf2 -3", "is no thickness"},
        {"mgf2 0", "is no thickness"},
        {"mgf2 nan", "is no thickness"},
        {"mgf2 550/0", "is no thickness"},
        {"mgf2 20 30", "unexpected"},
        {"2x(mgf2 20", "not closed"},
        {"2x(mgf2 20) 3", "unexpected"},
        {"0x(mgf2 20)", "is no layer"},
        {"65x(mgf2 20)", "at most 64 layers"},
        {"40x(mgf2 20, 1.5 3)", "at most 64 layers"},
        {"-1.5 20", "is no index"},
        {"1.5-0.1i 20", "is no index"},
        {"1.5+i 20", "is no index"},
        {"30 20", "is no index"},
        {"1.01 1, 1.02 1, 1.03 1, 1.04 1, 1.05 1, 1.06 1, 1.07 1, 1.08 1, 1.09 1, 1.1 1, 1.11 1, 1.12 1, 1.13 1",
         "different media"}};
    for (size_t i = 0; i < COUNT(invalid); i++) {
        coating_layers layers;
        diagnostic why = {.what = ""};
        assert_int_equal(coating_parse(invalid[i][0], &layers, &why), STATUS_BAD_INPUT);
        if (!strstr(why.what, invalid[i][1]) || !why.remedy[0])
            fail_msg("%s: %s; %s", invalid[i][0], why.what, why.remedy);
    }
}

/* --- designs --- */

typedef struct powers {
    double R_s, R_p, T_s, T_p, R, T;
} powers;

static powers powers_at(const film_stack *s, bool inward, double angle, double n_from, double n_to, double lambda_nm)
{
    thin_film films[FILMS_MAX];
    const int count = film_stack_films(s, lambda_nm, inward, films);
    const sp_amplitudes a = multilayer_amplitudes(cos(angle), n_from, films, count, complex_of(n_to, 0.0), lambda_nm);
    powers p = {complex_norm2(a.r_s), complex_norm2(a.r_p), complex_norm2(a.t_s), complex_norm2(a.t_p), 0.0, 0.0};
    p.R = 0.5 * (p.R_s + p.R_p), p.T = 0.5 * (p.T_s + p.T_p);
    return p;
}

static double index_of(const char *name, double lambda_nm)
{
    return medium_index(media_find(name), lambda_nm);
}

static powers on_crown(const char *design, double angle, double lambda_nm)
{
    const film_stack s = stack_of(design);
    return powers_at(&s, true, angle, 1.0, index_of("bk7", lambda_nm), lambda_nm);
}

/* Macleod, chapter 3: a quarter-wave layer has ((n0 ns - n^2) / (n0 ns + n^2))^2; chapter 6: N pairs have the
 * admittance ns (nH / nL)^2N. */
static void quarter_waves_have_their_closed_forms(void **state)
{
    (void)state;
    const double ns = index_of("bk7", 550.0), n = index_of("mgf2", 550.0), high = index_of("tio2", 550.0),
                 low = index_of("fused-silica", 550.0), many = ns * pow(high / low, 20.0);
    assert_near(on_crown("ar-550", 0.0, 550.0).R, pow((ns - n * n) / (ns + n * n), 2.0), 1e-14);
    assert_near(on_crown("mirror-550", 0.0, 550.0).R, pow((1.0 - many) / (1.0 + many), 2.0), 1e-13);
    assert_near(1.0 - on_crown("mirror-550", 0.0, 550.0).R, 4.0 * many / pow(1.0 + many, 2.0), 1e-12);
    assert_near(on_crown("1.5 550/2", 0.0, 550.0).R, pow((ns - 1.0) / (ns + 1.0), 2.0), 1e-14); /* absentee layer */
}

/* The bounds are those of a computation by numpy with the database's own tables, before their rounding here. */
static void designs_do_what_their_titles_say(void **state)
{
    (void)state;
    const double right = acos(-1.0) / 4.0;
    assert_true(on_crown("v-550", 0.0, 550.0).R < 1e-5);
    for (double nm = 420.0; nm <= 680.0; nm += 10.0) {
        assert_true(on_crown("ar-broad", 0.0, nm).R < 0.006);
        assert_true(nm < 430.0 || on_crown("ar-visible", 0.0, nm).R < 0.025);
        assert_true(nm < 480.0 || nm > 620.0 || on_crown("mirror-550", 0.0, nm).R > 0.98);
        assert_true(nm <= 530.0 ? nm < 430.0 || on_crown("long-pass-555", 0.0, nm).R > 0.95
                                : nm < 580.0 || on_crown("long-pass-555", 0.0, nm).T > 0.97);
        assert_true(nm <= 580.0 ? nm < 430.0 || on_crown("short-pass-595", 0.0, nm).T > 0.96
                                : nm < 615.0 || on_crown("short-pass-595", 0.0, nm).R > 0.94);
        assert_true(nm < 430.0 || nm > 670.0 || fabs(on_crown("splitter-45", right, nm).R - 0.5) < 0.02);
        const film_stack cube = stack_of("polariser-cube");
        const double n = index_of("n-sf11", nm);
        const powers p = powers_at(&cube, true, right, n, n, nm);
        assert_true(nm < 450.0 || (p.R_s > 0.99 && p.T_p > 0.95));
        assert_true(on_crown("aluminium-mirror", 0.0, nm).R > 0.85 && on_crown("aluminium-mirror", 0.0, nm).T < 1e-4);
        assert_true(on_crown("silver-mirror", 0.0, nm).R > 0.92);
    }
    assert_true(on_crown("aluminium-enhanced", 0.0, 550.0).R > 0.96);
    for (size_t i = 0; i < coating_designs_count(); i++) {
        const coating_design *d = coating_design_at(i);
        assert_true(stack_of(d->name).layers.count > 0 && d->title[0] && d->source[0]);
        assert_ptr_equal(coating_design_find(d->name), d);
        assert_null(media_find(d->name));
    }
}

/* From either side the transmittance is the same; the reflectance is, too, unless layers absorb. */
static void both_directions_of_light_agree(void **state)
{
    (void)state;
    const double ns = index_of("bk7", 500.0);
    for (size_t i = 0; i < coating_designs_count(); i++) {
        const film_stack s = stack_of(coating_design_at(i)->name);
        for (double angle = 0.0; angle < 1.5; angle += 0.1) {
            const double inner = asin(sin(angle) / ns);
            const powers in = powers_at(&s, true, angle, 1.0, ns, 500.0),
                         out = powers_at(&s, false, inner, ns, 1.0, 500.0);
            assert_near(in.T_s, out.T_s, 1e-13);
            assert_near(in.T_p, out.T_p, 1e-13);
            assert_true(in.R + in.T <= 1.0 + 1e-13 && out.R + out.T <= 1.0 + 1e-13);
            if (s.absorbs)
                continue;
            assert_near(in.R_s, out.R_s, 1e-12);
            assert_near(in.R_s + in.T_s, 1.0, 1e-12);
            assert_near(in.R_p + in.T_p, 1.0, 1e-12);
        }
    }
    const film_stack thin = stack_of("fused-silica 550/2, aluminium 20");
    const powers in = powers_at(&thin, true, 0.0, 1.0, ns, 550.0), out = powers_at(&thin, false, 0.0, ns, 1.0, 550.0);
    assert_true(fabs(in.R - out.R) > 1e-3 && in.R + in.T < 0.95);
}

/* A film lies on the outside of the coating. */
static void a_film_lies_above_the_coating(void **state)
{
    (void)state;
    coating_layers layers;
    film_stack s;
    thin_film films[FILMS_MAX];
    assert_int_equal(coating_parse("mgf2 10, tio2 20", &layers, NULL), STATUS_OK);
    film_stack_make((thin_film){complex_of(1.33, 0.0), 5.0}, &layers, NULL, false, &s);
    assert_int_equal(film_stack_films(&s, 500.0, true, films), 3);
    assert_true(films[0].index.re == 1.33 && films[0].thickness_nm == 5.0 && films[2].thickness_nm == 20.0);
    assert_int_equal(film_stack_films(&s, 500.0, false, films), 3);
    assert_true(films[2].index.re == 1.33 && films[0].thickness_nm == 20.0 && films[1].thickness_nm == 10.0);
    assert_true(film_stack_thickness_nm(&s) == 35.0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(random_stacks_equal_the_recursion),
        cmocka_unit_test(lists_of_layers_are_read),
        cmocka_unit_test(what_is_no_coating_is_refused_with_a_remedy),
        cmocka_unit_test(quarter_waves_have_their_closed_forms),
        cmocka_unit_test(designs_do_what_their_titles_say),
        cmocka_unit_test(both_directions_of_light_agree),
        cmocka_unit_test(a_film_lies_above_the_coating),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
