/* Tests of the catalogues of media and of metals against published tables. */
#include <ctype.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <cmocka.h>

#include "optics/media.h"
#include "optics/multilayer.h"

/* The catalogue of media against published tables. */

#define COUNT(a) (sizeof(a) / sizeof((a)[0]))
#define assert_near(a, b, tolerance) assert_true(fabs((a) - (b)) <= (tolerance))

static const medium *the(const char *name)
{
    const medium *m = media_find(name);
    if (!m)
        fail_msg("there is no %s", name);
    return m;
}

static double published(const char *name, double lambda_nm)
{
    return dispersion_index(&the(name)->law, lambda_nm);
}

/* Computed from the published coefficients independently of this program, to eight and four decimals. */
static void indices_at_spectral_lines_and_abbe_numbers_equal_computed_values(void **state)
{
    (void)state;
    static const struct {
        const char *name;
        double n_d, n_F, n_C, V_d;
    } expected[] = {
        {"air", 1.00027717, 1.00027936, 1.00027625, 89.3013},
        {"water", 1.33340334, 1.33749186, 1.33151260, 55.7600},
        {"ethanol", 1.36168149, 1.36595638, 1.35986264, 59.3530},
        {"glycerol", 1.47227128, 1.47682824, 1.46991385, 68.3026},
        {"toluene", 1.49210880, 1.50331146, 1.48759251, 31.3067},
        {"bk7-liquid", 1.51681328, 1.52370474, 1.51391563, 52.7947},
        {"fused-silica", 1.45846369, 1.46312648, 1.45636662, 67.8214},
        {"bk7", 1.51680003, 1.52237629, 1.51432235, 64.1673},
        {"sf11", 1.78471985, 1.80645439, 1.77598768, 25.7566},
        {"n-sf11", 1.78471994, 1.80651274, 1.77595511, 25.6800},
        {"soda-lime", 1.52338241, 1.52901613, 1.52083425, 63.9684},
        {"pmma", 1.49252744, 1.49836316, 1.49006681, 59.3668},
        {"sapphire", 1.76817209, 1.77550751, 1.76488399, 72.3086},
        {"diamond", 2.41748587, 2.43553792, 2.40990556, 55.3006},
        {"mgf2", 1.37774392, 1.38019898, 1.37664266, 106.2176},
        {"alumina", 1.67982114, 1.68841101, 1.67611230, 55.2758},
        {"hfo2", 1.89805730, 1.91195863, 1.89270787, 46.6505},
        {"ta2o5", 2.14623770, 2.18339966, 2.13125425, 21.9816},
        {"tio2", 2.41165235, 2.49689622, 2.37994132, 12.0701},
        {"n-fk5", 1.48749000, 1.49226946, 1.48534546, 70.4058},
        {"n-fk51a", 1.48656108, 1.49055744, 1.48479714, 84.4680},
        {"n-fk58", 1.45600036, 1.45947898, 1.45446247, 90.9000},
        {"n-pk51", 1.52855435, 1.53332919, 1.52646267, 76.9755},
        {"n-psk53a", 1.61800010, 1.62478154, 1.61503232, 63.3897},
        {"n-bk10", 1.49782101, 1.50295661, 1.49552139, 66.9545},
        {"n-k5", 1.52248876, 1.52859894, 1.51981506, 59.4827},
        {"k7", 1.51112096, 1.51700222, 1.50854082, 60.4062},
        {"n-bak1", 1.57250012, 1.57943457, 1.56948658, 57.5493},
        {"n-bak2", 1.53996009, 1.54625241, 1.53720915, 59.7086},
        {"n-bak4", 1.56882749, 1.57591145, 1.56574942, 55.9758},
        {"n-sk2", 1.60738097, 1.61485707, 1.60413545, 56.6501},
        {"n-sk4", 1.61271761, 1.61999173, 1.60954192, 58.6343},
        {"n-sk5", 1.58913012, 1.59580857, 1.58619276, 61.2668},
        {"n-sk11", 1.56383974, 1.57028420, 1.56101035, 60.7989},
        {"n-sk14", 1.60311043, 1.61002832, 1.60007548, 60.5968},
        {"n-sk16", 1.62040997, 1.62755635, 1.61727166, 60.3236},
        {"n-ssk2", 1.62229380, 1.63045168, 1.61877061, 53.2737},
        {"n-ssk5", 1.65844006, 1.66749425, 1.65455396, 50.8829},
        {"n-ssk8", 1.61772821, 1.62640751, 1.61401059, 49.8292},
        {"n-balf4", 1.57955936, 1.58707063, 1.57631133, 53.8659},
        {"n-baf4", 1.60568291, 1.61541938, 1.60156593, 43.7207},
        {"n-baf10", 1.67002983, 1.68000037, 1.66577834, 47.1121},
        {"n-lak8", 1.71300317, 1.72221895, 1.70897389, 53.8316},
        {"n-lak9", 1.69100207, 1.69978943, 1.68715879, 54.7084},
        {"n-lak10", 1.72002801, 1.72994854, 1.71572499, 50.6222},
        {"n-lak14", 1.69680002, 1.70554080, 1.69296550, 55.4102},
        {"n-lak21", 1.64049477, 1.64789868, 1.63724187, 60.1019},
        {"n-lak22", 1.65113045, 1.65924910, 1.64759925, 55.8918},
        {"n-lak33b", 1.75500016, 1.76505892, 1.75062300, 52.3001},
        {"n-laf2", 1.74397227, 1.75561780, 1.73902994, 44.8504},
        {"n-laf21", 1.78800006, 1.79959974, 1.78300673, 47.4899},
        {"n-lasf31a", 1.88299981, 1.89822463, 1.87656125, 40.7600},
        {"n-lasf40", 1.83404369, 1.84981386, 1.82745083, 37.2956},
        {"n-lasf44", 1.80419990, 1.81630264, 1.79900826, 46.5006},
        {"n-kzfs4", 1.61336019, 1.62300232, 1.60921698, 44.4937},
        {"n-kzfs8", 1.72046969, 1.73512780, 1.71436507, 34.7002},
        {"llf1", 1.54814010, 1.55654684, 1.54456565, 45.7501},
        {"lf5", 1.58144042, 1.59146245, 1.57722936, 40.8513},
        {"f2", 1.62004014, 1.63208146, 1.61503169, 36.3665},
        {"n-f2", 1.62005314, 1.63207786, 1.61505790, 36.4309},
        {"f5", 1.60342026, 1.61461226, 1.59874527, 38.0299},
        {"n-sf1", 1.71736012, 1.73456762, 1.71034896, 29.6201},
        {"sf2", 1.64768909, 1.66123127, 1.64209618, 33.8482},
        {"n-sf2", 1.64768977, 1.66125183, 1.64210086, 33.8202},
        {"sf4", 1.75520125, 1.77468086, 1.74729815, 27.5795},
        {"n-sf4", 1.75513113, 1.77476906, 1.74718640, 27.3770},
        {"sf5", 1.67269749, 1.68749533, 1.66661050, 32.2098},
        {"n-sf5", 1.67270704, 1.68749621, 1.66663786, 32.2512},
        {"sf6", 1.80518208, 1.82775211, 1.79609194, 25.4320},
        {"n-sf6", 1.80518018, 1.82782920, 1.79607886, 25.3597},
        {"n-sf8", 1.68893592, 1.70454941, 1.68254425, 31.3079},
        {"sf10", 1.72825024, 1.74648091, 1.72084751, 28.4102},
        {"n-sf10", 1.72827707, 1.74643051, 1.72090617, 28.5326},
        {"n-sf15", 1.69892030, 1.71535894, 1.69221660, 30.2009},
        {"n-sf57", 1.84665994, 1.87209976, 1.83649576, 23.7799},
        {"n-sf66", 1.92286009, 1.95458592, 1.91038711, 20.8797},
    };
    assert_int_equal(COUNT(expected) + 1, media_count()); /* olive oil has no dispersion */
    for (size_t k = 0; k < COUNT(expected); k++) {
        assert_near(published(expected[k].name, 587.5618), expected[k].n_d, 6e-9);
        assert_near(published(expected[k].name, 486.1327), expected[k].n_F, 6e-9);
        assert_near(published(expected[k].name, 656.2725), expected[k].n_C, 6e-9);
        assert_near(dispersion_abbe_number(&the(expected[k].name)->law), expected[k].V_d, 6e-5);
    }
}

/* Schott, data sheet N-BK7 517642.251: the lines t, s, r, C, C', He-Ne, D, d, e, F, F', g, h, i. */
static void bk7_equals_schotts_data_sheet(void **state)
{
    (void)state;
    static const double sheet[][2] = {
        {1060.0, 1.50669},   {1013.98, 1.50731},  {852.11, 1.50980},   {706.5188, 1.51289}, {656.2725, 1.51432},
        {643.8469, 1.51472}, {632.8, 1.51509},    {589.2938, 1.51673}, {587.5618, 1.51680}, {546.074, 1.51872},
        {486.1327, 1.52238}, {479.9914, 1.52283}, {435.8343, 1.52668}, {404.6561, 1.53024}, {365.0146, 1.53627}};
    for (size_t k = 0; k < COUNT(sheet); k++)
        assert_near(published("bk7", sheet[k][0]), sheet[k][1], 5.5e-6);
    assert_near(dispersion_abbe_number(&the("bk7")->law), 64.17, 0.005);
}

/* Schott, data sheets of optical glasses, 20 January 2017: n_d to five decimals, V_d to two. */
static void glasses_have_the_indices_and_abbe_numbers_of_their_data_sheets(void **state)
{
    (void)state;
    static const struct {
        const char *name;
        double n_d, V_d;
    } sheet[] = {{"n-fk5", 1.48749, 70.41},    {"n-fk51a", 1.48656, 84.47},  {"n-fk58", 1.45600, 90.90},
                 {"n-pk51", 1.52855, 76.98},   {"n-psk53a", 1.61800, 63.39}, {"n-bk10", 1.49782, 66.95},
                 {"n-k5", 1.52249, 59.48},     {"k7", 1.51112, 60.41},       {"n-bak1", 1.57250, 57.55},
                 {"n-bak2", 1.53996, 59.71},   {"n-bak4", 1.56883, 55.98},   {"n-sk2", 1.60738, 56.65},
                 {"n-sk4", 1.61272, 58.63},    {"n-sk5", 1.58913, 61.27},    {"n-sk11", 1.56384, 60.80},
                 {"n-sk14", 1.60311, 60.60},   {"n-sk16", 1.62041, 60.32},   {"n-ssk2", 1.62229, 53.27},
                 {"n-ssk5", 1.65844, 50.88},   {"n-ssk8", 1.61773, 49.83},   {"n-balf4", 1.57956, 53.87},
                 {"n-baf4", 1.60568, 43.72},   {"n-baf10", 1.67003, 47.11},  {"n-lak8", 1.71300, 53.83},
                 {"n-lak9", 1.69100, 54.71},   {"n-lak10", 1.72003, 50.62},  {"n-lak14", 1.69680, 55.41},
                 {"n-lak21", 1.64049, 60.10},  {"n-lak22", 1.65113, 55.89},  {"n-lak33b", 1.75500, 52.30},
                 {"n-laf2", 1.74397, 44.85},   {"n-laf21", 1.78800, 47.49},  {"n-lasf31a", 1.88300, 40.76},
                 {"n-lasf40", 1.83404, 37.30}, {"n-lasf44", 1.80420, 46.50}, {"n-kzfs4", 1.61336, 44.49},
                 {"n-kzfs8", 1.72047, 34.70},  {"llf1", 1.54814, 45.75},     {"lf5", 1.58144, 40.85},
                 {"f2", 1.62004, 36.37},       {"n-f2", 1.62005, 36.43},     {"f5", 1.60342, 38.03},
                 {"n-sf1", 1.71736, 29.62},    {"sf2", 1.64769, 33.85},      {"n-sf2", 1.64769, 33.82},
                 {"sf4", 1.75520, 27.58},      {"n-sf4", 1.75513, 27.38},    {"sf5", 1.67270, 32.21},
                 {"n-sf5", 1.67271, 32.25},    {"sf6", 1.80518, 25.43},      {"n-sf6", 1.80518, 25.36},
                 {"n-sf8", 1.68894, 31.31},    {"sf10", 1.72825, 28.41},     {"n-sf10", 1.72828, 28.53},
                 {"n-sf15", 1.69892, 30.20},   {"n-sf57", 1.84666, 23.78},   {"n-sf66", 1.92286, 20.88}};
    for (size_t k = 0; k < COUNT(sheet); k++) {
        assert_near(published(sheet[k].name, LINE_HELIUM_D_NM), sheet[k].n_d, 5.5e-6);
        assert_near(dispersion_abbe_number(&the(sheet[k].name)->law), sheet[k].V_d, 0.0051);
        char maker[32];
        for (size_t i = 0; i <= strlen(sheet[k].name); i++)
            maker[i] = (char)toupper((unsigned char)sheet[k].name[i]);
        assert_string_equal(media_usual_name(maker), sheet[k].name);
    }
    assert_string_equal(media_usual_name("N-SF6HT"), "n-sf6");
}

/* Malitson 1965, table 1, computed column. */
static void fused_silica_equals_malitsons_table(void **state)
{
    (void)state;
    static const double table[][2] = {
        {404.656, 1.469618}, {435.835, 1.466693}, {486.133, 1.463126}, {546.074, 1.460078}, {587.561, 1.458464},
        {589.262, 1.458404}, {656.272, 1.456367}, {706.519, 1.455145}, {852.111, 1.452465}, {1013.975, 1.450242}};
    for (size_t k = 0; k < COUNT(table); k++)
        assert_near(published("fused-silica", table[k][0]), table[k][1], 1.1e-6);
    assert_near(dispersion_abbe_number(&the("fused-silica")->law), 67.8, 0.05);
}

/* Schott's catalogue; Handbook of Chemistry and Physics at the sodium line, 20 C (toluene by -5.7e-4 / K to 27 C).
 * Diamond: Kaye and Laby. The tolerances are the differences between the sources. */
static void indices_equal_those_of_handbooks(void **state)
{
    (void)state;
    assert_near(published("sf11", LINE_HELIUM_D_NM), 1.78472, 5.5e-6);
    assert_near(dispersion_abbe_number(&the("sf11")->law), 25.76, 0.005);
    assert_near(published("n-sf11", LINE_HELIUM_D_NM), 1.78472, 5.5e-6);
    assert_near(dispersion_abbe_number(&the("n-sf11")->law), 25.68, 0.005);
    assert_near(published("ethanol", LINE_SODIUM_D_NM), 1.3611, 6e-4);
    assert_near(published("toluene", LINE_SODIUM_D_NM), 1.4961 - 7.0 * 5.7e-4, 5e-4);
    assert_near(published("glycerol", LINE_SODIUM_D_NM), 1.4746 - 5.0 * 2.3e-4, 2e-3);
    assert_near(published("pmma", LINE_SODIUM_D_NM), 1.492, 1e-3);
    assert_near(published("sapphire", LINE_SODIUM_D_NM), 1.768, 5e-4);
    assert_near(published("diamond", LINE_SODIUM_D_NM), 2.417, 5e-4);
    assert_near(published("soda-lime", LINE_SODIUM_D_NM), 1.523, 5e-3);
    assert_near(published("olive-oil", LINE_SODIUM_D_NM), 0.5 * (1.4677 + 1.4705), 1e-12);
}

/* Edlen, Metrologia 2, 71 (1966), eq. 1, for 300 ppm of CO2: 150 ppm more increase n - 1 by a relative 8e-5. */
static void air_equals_edlens_formula(void **state)
{
    (void)state;
    for (double lambda_nm = 300.0; lambda_nm <= 1600.0; lambda_nm += 10.0) {
        const double s2 = 1e6 / (lambda_nm * lambda_nm);
        const double edlen = 1e-8 * (8342.13 + 2406030.0 / (130.0 - s2) + 15997.0 / (38.9 - s2)) * (1.0 + 8e-5);
        assert_near(published("air", lambda_nm) - 1.0, edlen, 1.5e-8);
    }
}

/* Tilton and Taylor, J. Res. NBS 20, 419 (1938), give water relative to air: 1.33299 at D, 20 C; Daimon's law is
 * absolute. */
static void water_relative_to_air_has_the_textbooks_index(void **state)
{
    (void)state;
    assert_false(the("water")->relative_to_air);
    assert_near(published("water", LINE_SODIUM_D_NM) / published("air", LINE_SODIUM_D_NM), 1.33299, 2e-5);
    assert_true(fabs(published("water", LINE_SODIUM_D_NM) - 1.33299) > 3e-4);
}

static void relative_indices_are_converted_to_absolute_ones(void **state)
{
    (void)state;
    for (size_t i = 0; i < media_count(); i++) {
        const medium *m = media_at(i);
        for (double lambda_nm = 400.0; lambda_nm < 760.0; lambda_nm += 20.0) {
            const double n = dispersion_index(&m->law, lambda_nm), air = published("air", lambda_nm);
            assert_near(medium_index(m, lambda_nm), m->relative_to_air ? n * air : n, 4.5e-16 * n);
        }
        assert_int_equal(m->relative_to_air, strcmp(m->name, "air") != 0 && strcmp(m->name, "water") != 0);
    }
    /* Schott, TIE-29: the absolute index of N-BK7 is 1.00027 times that of its data sheet */
    assert_near(medium_index(the("bk7"), LINE_HELIUM_D_NM), 1.51680 + 1.5168 * 2.77e-4, 1e-5);
}

/* Dispersion is normal in the visible: violet is refracted most. */
static void every_law_is_valid_with_normal_dispersion(void **state)
{
    (void)state;
    for (size_t i = 0; i < media_count(); i++) {
        const medium *m = media_at(i);
        diagnostic why = {0};
        if (dispersion_check(&m->law, &why) != STATUS_OK)
            fail_msg("%s: %s", m->name, why.what);
        for (double lambda_nm = 380.0; lambda_nm < 780.0; lambda_nm += 1.0)
            assert_true(m->law.kind == DISPERSION_CONSTANT ||
                        dispersion_index(&m->law, lambda_nm) > dispersion_index(&m->law, lambda_nm + 1.0));
        assert_true(m->law.low_nm > 100.0 && m->law.low_nm <= m->law.high_nm);
        assert_true(isnan(m->temperature_c) || (m->temperature_c >= 15.0 && m->temperature_c <= 27.0));
        assert_true(m->title[0] && m->source[0] && m->verified[0] && m->note);
    }
}

static void names_are_in_the_order_of_the_list(void **state)
{
    (void)state;
#define NAME(name) name,
    static const char *const names[] = {MEDIA_NAMES(NAME)};
#undef NAME
    assert_int_equal(COUNT(names), media_count());
    for (size_t i = 0; i < COUNT(names); i++) {
        assert_string_equal(media_at(i)->name, names[i]);
        assert_ptr_equal(media_find(names[i]), media_at(i)); /* so that no name occurs twice */
    }
    assert_null(media_find("BK7"));
    assert_null(media_find("bk"));
    assert_null(media_find(""));
}

/* The purpose of the matching liquid: its index equals the glass's at one wavelength between C and F. */
static void the_index_of_the_matching_liquid_crosses_that_of_bk7(void **state)
{
    (void)state;
    const medium *glass = the("bk7"), *liquid = the("bk7-liquid");
    assert_true(medium_index(liquid, LINE_HYDROGEN_F_NM) > medium_index(glass, LINE_HYDROGEN_F_NM));
    assert_true(medium_index(liquid, LINE_HYDROGEN_C_NM) < medium_index(glass, LINE_HYDROGEN_C_NM));
    assert_near(medium_index(liquid, LINE_HELIUM_D_NM), medium_index(glass, LINE_HELIUM_D_NM), 2e-5);
}

/* The catalogue of metals against values of the literature, and of its form. */

static void names_of_metals_are_in_the_order_of_the_list(void **state)
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
        cmocka_unit_test(indices_at_spectral_lines_and_abbe_numbers_equal_computed_values),
        cmocka_unit_test(bk7_equals_schotts_data_sheet),
        cmocka_unit_test(glasses_have_the_indices_and_abbe_numbers_of_their_data_sheets),
        cmocka_unit_test(fused_silica_equals_malitsons_table),
        cmocka_unit_test(indices_equal_those_of_handbooks),
        cmocka_unit_test(air_equals_edlens_formula),
        cmocka_unit_test(water_relative_to_air_has_the_textbooks_index),
        cmocka_unit_test(relative_indices_are_converted_to_absolute_ones),
        cmocka_unit_test(every_law_is_valid_with_normal_dispersion),
        cmocka_unit_test(names_are_in_the_order_of_the_list),
        cmocka_unit_test(the_index_of_the_matching_liquid_crosses_that_of_bk7),
        cmocka_unit_test(names_of_metals_are_in_the_order_of_the_list),
        cmocka_unit_test(tables_cover_the_visible_range),
        cmocka_unit_test(johnsons_wavelengths_are_of_whole_hundredths_of_an_electronvolt),
        cmocka_unit_test(indices_are_near_those_of_hagemann),
        cmocka_unit_test(reflectances_make_the_known_colours),
        cmocka_unit_test(reflectance_is_that_of_the_interface),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
