/* Tests of the catalogue of metals against values of the literature, and of its form. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "optics/media.h"
#include "optics/multilayer.h"

#define COUNT(a) (sizeof(a) / sizeof((a)[0]))
#define assert_near(a, b, tolerance) assert_true(fabs((a) - (b)) <= (tolerance))

static void names_are_in_the_order_of_the_list(void **state)
{
    (void)state;
#define NAME(name) name,
    static const char *const names[] = {METAL_NAMES(NAME)};
#undef NAME
    assert_int_equal(COUNT(names), metals_count());
    for (size_t i = 0; i < COUNT(names); i++) {
        assert_string_equal(metals_at(i)->name, names[i]);
        assert_ptr_equal(metals_find(names[i]), metals_at(i)); /* so that no name occurs twice */
    }
    assert_null(metals_find("Gold"));
    assert_null(metals_find(""));
}

static void tables_cover_the_visible_range(void **state)
{
    (void)state;
    for (size_t i = 0; i < metals_count(); i++) {
        const metal *m = metals_at(i);
        assert_true(m->n.kind == DISPERSION_TABLE && m->k.kind == DISPERSION_TABLE);
        assert_true(m->n.count == m->k.count && m->n.count <= DISPERSION_TERMS_MAX && m->n.count % 2 == 0);
        for (int k = 0; k < m->n.count; k += 2) {
            assert_true(m->n.coefficient[k] == m->k.coefficient[k]);
            assert_true(k == 0 || m->n.coefficient[k] > m->n.coefficient[k - 2]);
            assert_true(m->n.coefficient[k + 1] > 0.0 && m->k.coefficient[k + 1] > 1.0);
        }
        assert_true(dispersion_covers(&m->n, VISIBLE_LOW_NM, VISIBLE_HIGH_NM));
        assert_true(m->title[0] && m->source[0] && m->verified[0] && m->note);
    }
}

/* Johnson and Christy's wavelengths are those of their photon energies: E = 1239.842 eV nm / lambda, of 0.01 eV. */
static void johnsons_wavelengths_are_of_whole_hundredths_of_an_electronvolt(void **state)
{
    (void)state;
    static const double energy_ev[] = {3.37, 3.25, 3.12, 3.00, 2.88, 2.75, 2.63, 2.50,
                                       2.38, 2.26, 2.13, 2.01, 1.88, 1.76, 1.64, 1.51};
    static const char *const names[] = {"silver", "gold", "copper"};
    for (size_t i = 0; i < COUNT(names); i++)
        for (size_t k = 0; k < COUNT(energy_ev); k++)
            assert_near(metals_find(names[i])->n.coefficient[2 * k], 1239.842 / energy_ev[k], 0.051);
}

/* An independent measurement, at 2.0, 2.5 and 3.0 eV for copper and gold, at 1.7, 2.0 and 3.0 eV for aluminium:
 * Hagemann, Gudat and Kunz, J. Opt. Soc. Am. 65, 742 (1975). Samples differ: within 0.25 in k, 0.3 in n of gold. */
static void indices_are_near_those_of_hagemann(void **state)
{
    (void)state;
    static const struct {
        const char *name;
        double lambda_nm, n, k;
    } rows[] = {{"gold", 619.9, 0.487, 3.31},      {"gold", 476.8, 1.541, 1.71},      {"gold", 413.2, 1.950, 1.86},
                {"copper", 619.9, 0.272, 3.24},    {"copper", 476.9, 1.152, 2.50},    {"copper", 413.3, 1.184, 2.21},
                {"aluminium", 729.3, 2.082, 8.34}, {"aluminium", 619.9, 1.292, 7.28}, {"aluminium", 413.3, 0.548, 5.00},
                {"aluminium", 495.9, 0.771, 5.91}};
    for (size_t i = 0; i < COUNT(rows); i++) {
        const complex_pair index = metal_index(metals_find(rows[i].name), rows[i].lambda_nm);
        assert_near(index.re, rows[i].n, rows[i].name[0] == 'g' ? 0.5 : 0.13);
        assert_near(index.im, rows[i].k, 0.15);
    }
}

/* Colours: silver and aluminium are almost grey, gold is dark in the blue, copper in blue and green; aluminium reflects
 * 0.91 to 0.93 of visible light. */
static void reflectances_make_the_known_colours(void **state)
{
    (void)state;
    static const struct {
        const char *name;
        double low[3], high[3]; /* at 450, 550 and 650 nm */
    } rows[] = {{"silver", {0.97, 0.97, 0.98}, {0.99, 0.99, 0.995}},
                {"gold", {0.36, 0.75, 0.95}, {0.42, 0.84, 0.98}},
                {"copper", {0.50, 0.57, 0.92}, {0.56, 0.65, 0.96}},
                {"aluminium", {0.915, 0.91, 0.90}, {0.93, 0.925, 0.915}}};
    for (size_t i = 0; i < COUNT(rows); i++)
        for (int k = 0; k < 3; k++) {
            const double R = metal_reflectance(metals_find(rows[i].name), 450.0 + 100.0 * k);
            assert_true(R >= rows[i].low[k] && R <= rows[i].high[k]);
        }
}

static void reflectance_is_that_of_the_interface(void **state)
{
    (void)state;
    for (size_t i = 0; i < metals_count(); i++)
        for (double lambda_nm = 380.0; lambda_nm <= 780.0; lambda_nm += 10.0) {
            const metal *m = metals_at(i);
            const sp_amplitudes a = conductor_amplitudes(1.0, 1.0, metal_index(m, lambda_nm));
            assert_near(metal_reflectance(m, lambda_nm), complex_norm2(a.r_s), 1e-14);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(names_are_in_the_order_of_the_list),
        cmocka_unit_test(tables_cover_the_visible_range),
        cmocka_unit_test(johnsons_wavelengths_are_of_whole_hundredths_of_an_electronvolt),
        cmocka_unit_test(indices_are_near_those_of_hagemann),
        cmocka_unit_test(reflectances_make_the_known_colours),
        cmocka_unit_test(reflectance_is_that_of_the_interface),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
