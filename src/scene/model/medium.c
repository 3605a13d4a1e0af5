/* The laws of refraction, absorption and polarising sheets of a material (medium.h). */
#include "scene/model/medium.h"
#include "base/lanes.h"
#include "base/number.h"
#include "optics/coating.h"
#include "optics/media.h"
#include "scene/model/scene.h"

#include <assert.h>
#include <float.h>
#include <string.h>

#define NAME(name) name,
const char *const medium_words[] = {"ior",   "sellmeier", "cauchy",
                                    "table", "data",      MEDIA_NAMES(NAME) METAL_NAMES(NAME) NULL};
static_assert((int)COATING_MAX == (int)COATING_TEXT_MAX, "a material holds every text of a coating");

const char *const surrounding_words[] = {"ior", MEDIA_NAMES(NAME) NULL};

static index_law law_of_catalogue(int64_t at)
{
    const medium *m = media_at((size_t)at);
    return (index_law){.law = m->law, .relative_to_air = m->relative_to_air};
}

/* A medium of the catalogue, or a metal. */
static index_law law_of_medium(int64_t word)
{
    return word < MEDIUM_METAL ? law_of_catalogue(word - MEDIUM_CATALOGUE)
                               : (index_law){.law = metals_at((size_t)(word - MEDIUM_METAL))->n};
}

static index_law law_of_ior(double ior)
{
    return (index_law){.law = {.kind = DISPERSION_CONSTANT, .count = 1, .coefficient = {ior}}};
}

/* Data that are not loaded yet have the constant index. */
static status law_of_data(const material *m, const char *label, index_law *out, diagnostic *why)
{
    if (!m->medium_data[0])
        return diagnose(why, STATUS_BAD_INPUT, "set medium_data to the name of one of the scene's data",
                        "%.80s: medium is data, but medium_data is not set", label);
    *out = law_of_ior(m->ior);
    if (!m->index_data)
        return STATUS_OK;
    if (!optical_data_has_first(m->index_data))
        return diagnose(why, STATUS_BAD_INPUT, "choose a file with n", "%.80s: the data %.80s have no refractive index",
                        label, m->medium_data);
    out->data = m->index_data;
    out->relative_to_air = m->index_in_air;
    out->law = (dispersion){.kind = DISPERSION_CURVE};
    optical_data_range(m->index_data, &out->law.low_nm, &out->law.high_nm);
    return STATUS_OK;
}

status material_index_law(const material *m, const char *label, index_law *out, diagnostic *why)
{
    static const dispersion_kind kinds[] = {[MEDIUM_IOR] = DISPERSION_CONSTANT,
                                            [MEDIUM_SELLMEIER] = DISPERSION_SELLMEIER,
                                            [MEDIUM_CAUCHY] = DISPERSION_CAUCHY,
                                            [MEDIUM_TABLE] = DISPERSION_CURVE};
    if (m->medium == MEDIUM_IOR || m->medium >= MEDIUM_CATALOGUE) {
        *out = m->medium == MEDIUM_IOR ? law_of_ior(m->ior) : law_of_medium(m->medium);
        return STATUS_OK;
    }
    if (m->medium == MEDIUM_DATA)
        return law_of_data(m, label, out, why);
    *out = (index_law){.law = {.kind = kinds[m->medium], .count = (int)m->coefficients.count}};
    memcpy(out->law.coefficient, m->coefficients.value, (size_t)m->coefficients.count * sizeof(double));
    diagnostic bad = {.what = ""};
    if (m->coefficients.count == 0) {
        static const char *const examples[] = {
            [MEDIUM_SELLMEIER] = "give pairs B, C (um^2), for example 'coefficients: [1.1, 0.012]'",
            [MEDIUM_CAUCHY] = "give A, B (um^2), ..., for example 'coefficients: [1.5046, 0.0042]'",
            [MEDIUM_TABLE] =
                "give pairs of wavelength (nm) and index, for example 'coefficients: [450, 1.34, 650, 1.33]'"};
        return diagnose(why, STATUS_BAD_INPUT, examples[m->medium], "%.80s: medium %s has no coefficients", label,
                        medium_words[m->medium]);
    }
    status code = dispersion_check(&out->law, &bad);
    return code == STATUS_OK ? code : diagnose(why, code, bad.remedy, "%.80s: %s", label, bad.what);
}

static double six_digits(double x)
{
    char text[NUMBER_TEXT_MAX];
    double rounded = x;
    number_parse_real(number_format_digits(x, 6, text), &rounded);
    return rounded;
}

number_list medium_first_coefficients(int word, double ior)
{
    const double spread = 0.004, d_um = LINE_HELIUM_D_NM / 1000; /* B of water and crown glass, um^2 */
    const double lines[] = {LINE_HYDROGEN_F_NM, LINE_HELIUM_D_NM, LINE_HYDROGEN_C_NM};
    const dispersion cauchy = {DISPERSION_CAUCHY, 2, {six_digits(ior - spread / (d_um * d_um)), spread}, 0, 0};
    const dispersion *crown = &media_find("bk7")->law;
    number_list list = {0};
    if (word == MEDIUM_TABLE) {
        for (size_t i = 0; i < sizeof lines / sizeof *lines; i++) {
            list.value[list.count++] = six_digits(lines[i]);
            list.value[list.count++] = six_digits(dispersion_index(&cauchy, lines[i]));
        }
        return list;
    }
    if (word != MEDIUM_CAUCHY && word != MEDIUM_SELLMEIER)
        return list;
    const dispersion *law = word == MEDIUM_CAUCHY ? &cauchy : crown;
    list.count = law->count;
    memcpy(list.value, law->coefficient, (size_t)law->count * sizeof *list.value);
    return list;
}

index_law surrounding_index_law(const background *b)
{
    return b->medium < SURROUNDING_CATALOGUE ? law_of_ior(b->ior) : law_of_catalogue(b->medium - SURROUNDING_CATALOGUE);
}

double index_law_at(const index_law *law, double lambda_nm)
{
    const double n = law->data ? optical_data_at(law->data, lambda_nm) : dispersion_index(&law->law, lambda_nm);
    return law->relative_to_air ? n * medium_index(media_at(0), lambda_nm) : n;
}

static bool index_laws_equal(const index_law *a, const index_law *b)
{
    if (a->data || b->data)
        return a->data == b->data && a->relative_to_air == b->relative_to_air;
    if (a->law.kind != b->law.kind || a->law.count != b->law.count || a->relative_to_air != b->relative_to_air)
        return false;
    for (int i = 0; i < a->law.count; i++)
        if (a->law.coefficient[i] != b->law.coefficient[i])
            return false;
    return true;
}

bool index_laws_match(const render_settings *r, const index_law *a, const index_law *b)
{
    return r->spectrum == SPECTRUM_SPECTRAL ? index_laws_equal(a, b)
                                            : index_law_at(a, r->lambda_nm) == index_law_at(b, r->lambda_nm);
}

bool material_matches_surroundings(const scene *s, const material *m)
{
    index_law own;
    const index_law around = surrounding_index_law(&s->background);
    return material_index_law(m, "", &own, NULL) == STATUS_OK && index_laws_match(&s->render, &own, &around);
}

bool material_is_mirror(const material *m)
{
    return m->transparency > 0.0 && m->medium == MEDIUM_IOR &&
           m->ior > MIRROR_IOR; /* no law and no catalogue entry has so large an index */
}

bool material_is_opaque(const material *m)
{
    return m->transparency == 0.0 || material_is_mirror(m);
}

const metal *material_metal(const material *m)
{
    return m->medium >= MEDIUM_METAL ? metals_at((size_t)(m->medium - MEDIUM_METAL)) : NULL;
}

static bool has_k(const material *m)
{
    return m->medium == MEDIUM_DATA && m->index_data && optical_data_has_k(m->index_data);
}

/* An opaque material whose surface is a metal's: by its medium, or by its extinction. */
static bool material_is_conductor(const material *m)
{
    return m->transparency == 0.0 &&
           (material_metal(m) || has_k(m) || material_extinction_index(m, VISIBLE_LOW_NM) > 0.0);
}

bool material_has_film(const material *m)
{
    return (m->film_thickness_nm > 0.0 || m->coating[0]) && !material_is_mirror(m);
}

/* The table of parameters accepts only coatings that can be parsed. */
void material_film_stack(const material *m, film_stack *out)
{
    coating_layers layers;
    const bool coated = m->coating[0] && coating_parse(m->coating, &layers, NULL) == STATUS_OK;
    const thin_film film = {complex_of(m->film_ior, 0.0), m->film_thickness_nm};
    film_stack_make(film, coated ? &layers : NULL, m->coating_values, m->coating_in_air, out);
}

bool material_films_match(const material *a, const material *b)
{
    return a->film_thickness_nm == b->film_thickness_nm && a->film_ior == b->film_ior &&
           strcmp(a->coating, b->coating) == 0 && a->coating_values == b->coating_values &&
           a->coating_in_air == b->coating_in_air;
}

double material_layers_pass(const material *m)
{
    const double channel_nm[] = CHANNEL_LAMBDA_NM;
    film_stack stack;
    index_law law;
    double sum = 0.0;
    if (!m->coating[0] || material_index_law(m, "", &law, NULL) != STATUS_OK)
        return 1.0;
    material_film_stack(m, &stack);
    for (int c = 0; c < 3; c++) {
        thin_film films[FILMS_MAX];
        const int count = film_stack_films(&stack, channel_nm[c], true, films);
        const complex_pair behind = complex_of(index_law_at(&law, channel_nm[c]), 0.0);
        const sp_amplitudes a = multilayer_amplitudes(1.0, 1.0, films, count, behind, channel_nm[c]);
        sum += complex_norm2(a.t_s) / 3.0;
    }
    return lesser(sum, 1.0);
}

status material_coating_check(const material *m, const char *label, diagnostic *why)
{
    coating_layers layers;
    if (!m->coating[0])
        return STATUS_OK;
    TRY(coating_parse(m->coating, &layers, why));
    if (coating_needs_data(&layers) && !m->coating_data[0])
        return diagnose(why, STATUS_BAD_INPUT, "set coating_data to the name of one of the scene's data",
                        "%.80s: a layer of its coating is data, but coating_data is not set", label);
    return STATUS_OK;
}

bool material_is_layered(const material *m, const render_settings *r)
{
    const bool film = material_has_film(m) && (material_is_opaque(m) || !scene_has_constant_weights(r));
    return film || material_is_conductor(m);
}

double material_roughness(const material *m, const render_settings *r)
{
    const bool clear = !material_is_opaque(m),
               sends = clear ? !scene_has_constant_weights(r)
                             : m->reflectivity > 0.0 || material_is_mirror(m) || material_is_layered(m, r);
    return integrator_traits_of(r)->by_chance && sends ? m->roughness : 0.0;
}

bool material_is_crystal(const material *m, const render_settings *r)
{
    return m->extraordinary_ior > 0.0 && !material_is_opaque(m) && integrator_traits_of(r)->tree &&
           r->lighting == LIGHTING_WHITTED && !scene_has_constant_weights(r);
}

/* No dielectric has a smaller index in visible light; n of silver is 0.03 to 0.06 (Johnson and Christy). */
#define DIELECTRIC_IOR_LEAST 0.1

status material_ior_check(const material *m, const char *label, diagnostic *why)
{
    if (m->medium != MEDIUM_IOR || m->ior >= DIELECTRIC_IOR_LEAST || material_is_conductor(m))
        return STATUS_OK;
    return diagnose(why, STATUS_BAD_INPUT,
                    m->transparency > 0.0 ? "set it to 0.1 or more; only an opaque metal has less"
                                          : "set it to 0.1 or more, or set its extinction, which makes it a metal",
                    "%.80s: ior %g is too small", label, m->ior);
}

status material_crystal_check(const material *m, const char *label, diagnostic *why)
{
    if (m->extraordinary_ior == 0.0 || material_is_opaque(m))
        return STATUS_OK;
    if (m->extraordinary_ior < DIELECTRIC_IOR_LEAST)
        return diagnose(why, STATUS_BAD_INPUT, "set it to 0.1 or more, or to 0 for a medium with one index",
                        "%.80s: extraordinary_ior %g is too small", label, m->extraordinary_ior);
    if (!(vec3_dot(m->optic_axis, m->optic_axis) > 0.0))
        return diagnose(why, STATUS_BAD_INPUT, "set it to a vector in the solid's frame, such as 0,1,0",
                        "%.80s: the optic_axis has no direction", label);
    const char *extra = m->reflectivity > 0.0        ? "reflectivity"
                        : m->coating[0]              ? "coating"
                        : m->film_thickness_nm > 0.0 ? "film_thickness_nm"
                        : m->sheet != 0              ? "sheet"
                                                     : NULL;
    if (!extra)
        return STATUS_OK;
    return diagnose(why, STATUS_BAD_INPUT,
                    m->coating[0]   ? "set its coating to none, or its extraordinary_ior to 0"
                    : m->sheet != 0 ? "set its sheet to none, or its extraordinary_ior to 0"
                                    : "set it to 0, or its extraordinary_ior to 0",
                    "%.80s: a crystal has no %s", label, extra);
}

double material_extinction_index(const material *m, double lambda_nm)
{
    const metal *of = material_metal(m);
    return of                        ? metal_index(of, lambda_nm).im
           : has_k(m)                ? optical_data_k(m->index_data, lambda_nm)
           : m->medium == MEDIUM_IOR ? m->extinction
                                     : 0.0;
}

const char *material_medium_name(const material *m)
{
    return m->medium >= MEDIUM_CATALOGUE ? medium_words[m->medium] : NULL;
}

const char *surrounding_medium_name(const background *b)
{
    return b->medium >= SURROUNDING_CATALOGUE ? surrounding_words[b->medium] : NULL;
}

/* Piecewise linear through points x0, y0, x1, y1, ...; constant outside. */
static double interpolate(const double *points, int64_t count, double x)
{
    if (x <= points[0])
        return points[1];
    for (int64_t i = 2; i < count; i += 2) {
        if (x <= points[i]) {
            const double fraction = (x - points[i - 2]) / (points[i] - points[i - 2]);
            return points[i - 1] + fraction * (points[i + 1] - points[i - 1]);
        }
    }
    return points[count - 1];
}

static double between_channels(vec3 a, double lambda_nm)
{
    const double channel_nm[] = CHANNEL_LAMBDA_NM;
    const double points[] = {channel_nm[2], a.z, channel_nm[1], a.y, channel_nm[0], a.x};
    return interpolate(points, 6, lambda_nm);
}

/* Absorption coefficient of a transparent medium with k, 4 pi k / lambda, 1/m; Born and Wolf, 7th ed., 14.1 (20). */
static double absorption_of_k(const material *m, double lambda_nm)
{
    const double four_pi = 12.566370614359172954;
    return m->transparency > 0.0 && has_k(m) ? four_pi * optical_data_k(m->index_data, lambda_nm) / (lambda_nm * 1e-9)
                                             : 0.0;
}

material material_as_measured(const material *m)
{
    material measured = *m;
    double rgb[3];
    if (!m->color_values)
        return measured;
    optical_data_rgb(m->color_values, rgb);
    measured.color = vec3_make(rgb[0], rgb[1], rgb[2]);
    return measured;
}

double material_absorption_at(const material *m, double lambda_nm)
{
    const double own = m->absorb_values ? optical_data_coefficient(m->absorb_values, lambda_nm)
                       : m->absorb_spectrum.count > 0
                           ? interpolate(m->absorb_spectrum.value, m->absorb_spectrum.count, lambda_nm)
                           : between_channels(m->absorb_per_m, lambda_nm);
    return own + absorption_of_k(m, lambda_nm);
}

double surrounding_absorption_at(const background *b, double lambda_nm)
{
    return between_channels(b->absorb_per_m, lambda_nm);
}

vec3 material_absorption(const material *m)
{
    const double channel_nm[] = CHANNEL_LAMBDA_NM;
    if (m->absorb_spectrum.count == 0 && !m->absorb_values && !has_k(m))
        return m->absorb_per_m;
    return vec3_make(material_absorption_at(m, channel_nm[0]), material_absorption_at(m, channel_nm[1]),
                     material_absorption_at(m, channel_nm[2]));
}

static bool absorbs(vec3 a)
{
    return a.x > 0.0 || a.y > 0.0 || a.z > 0.0;
}

bool surroundings_absorb(const background *b)
{
    return absorbs(b->absorb_per_m);
}

bool material_absorbs(const material *m)
{
    for (int64_t i = 1; i < m->absorb_spectrum.count; i += 2)
        if (m->absorb_spectrum.value[i] > 0.0)
            return true;
    if (m->absorb_values) {
        double least, most;
        optical_data_extremes(m->absorb_values, &least, &most);
        return most > 0.0;
    }
    return (m->transparency > 0.0 && has_k(m)) || (m->absorb_spectrum.count == 0 && absorbs(m->absorb_per_m));
}

bool material_tints(const material *m)
{
    return !material_is_opaque(m) && (m->color_values || m->color.x < 1.0 || m->color.y < 1.0 || m->color.z < 1.0);
}

double material_tint(const material *m, double value)
{
    const double black = 1e9, ln_2 = 0.69314718055994530942;
    if (value >= 1.0)
        return 0.0;
    return (value > DBL_MIN ? -ln_2 * elementary_log2_inline(value) : black) / m->tint_distance;
}

bool material_attenuates(const material *m)
{
    return material_absorbs(m) || material_tints(m);
}

double material_scattering_at(const material *m, double lambda_nm)
{
    return m->scatter_values ? optical_data_coefficient(m->scatter_values, lambda_nm) : m->scatter_per_m;
}

vec3 material_scattering(const material *m)
{
    const double channel_nm[] = CHANNEL_LAMBDA_NM;
    return vec3_make(material_scattering_at(m, channel_nm[0]), material_scattering_at(m, channel_nm[1]),
                     material_scattering_at(m, channel_nm[2]));
}

bool material_is_turbid(const material *m)
{
    double least, most = m->scatter_per_m;
    if (m->scatter_values)
        optical_data_extremes(m->scatter_values, &least, &most);
    return most > 0.0;
}

bool material_scatters(const material *m, const render_settings *r)
{
    return material_is_turbid(m) && integrator_traits_of(r)->by_chance && !material_is_opaque(m);
}

vec3 material_extinction(const material *m, double unit_m)
{
    const vec3 absorbed = vec3_scale(material_absorption(m), unit_m);
    if (!material_tints(m))
        return absorbed;
    return vec3_add(
        absorbed, vec3_make(material_tint(m, m->color.x), material_tint(m, m->color.y), material_tint(m, m->color.z)));
}

double material_reflectivity(const material *m, const render_settings *r)
{
    return material_is_opaque(m) || scene_has_constant_weights(r) ? 0.0 : m->reflectivity;
}

status material_absorption_check(const material *m, const char *label, diagnostic *why)
{
    const number_list *list = &m->absorb_spectrum;
    bool valid = list->count % 2 == 0;
    for (int64_t i = 0; valid && i < list->count; i += 2)
        valid = list->value[i] > 0.0 && list->value[i + 1] >= 0.0 && (i == 0 || list->value[i] > list->value[i - 2]);
    return valid ? STATUS_OK
                 : diagnose(why, STATUS_BAD_INPUT,
                            "write nm,1/m,nm,1/m.. with ascending wavelengths, as [400, 0.1, 700, 2]",
                            "%.80s: absorb_spectrum is not a list of pairs of wavelength and coefficient", label);
}

/* --- sheets --- */

bool sheet_is_polariser(const material *m)
{
    return m->sheet != SHEET_NONE && m->sheet != SHEET_RETARDER;
}

bool sheet_has_axis(const material *m)
{
    return m->sheet == SHEET_POLARISER || m->sheet == SHEET_RETARDER;
}

bool sheet_retards(const material *m)
{
    return m->sheet == SHEET_RETARDER && (m->retardance_deg != 0.0 || m->birefringence != 0.0);
}

bool sheet_acts(const material *m, const render_settings *r)
{
    const bool transports = !integrator_traits_of(r)->drawn && !integrator_traits_of(r)->unlit;
    return transports && (sheet_is_polariser(m) || (r->polarisation && sheet_retards(m)));
}

bool sheet_disperses(const material *m, const render_settings *r)
{
    return sheet_acts(m, r) && m->sheet == SHEET_RETARDER && m->birefringence != 0.0;
}

status sheet_check(const material *m, const char *label, diagnostic *why)
{
    const vec3 a = m->sheet_axis;
    if (!sheet_has_axis(m) || vec3_dot(a, a) > 0.0)
        return STATUS_OK;
    return diagnose(why, STATUS_BAD_INPUT, "set it to a vector in the solid's frame, such as 1,0,0",
                    "%.80s: the sheet_axis has no direction", label);
}
