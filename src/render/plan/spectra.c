/* Tables of the scene's spectra, the fractions of its lines, and the choice of a ray's wavelength. */
#include "render/plan/spectra.h"

#include "base/random.h"
#include "render/plan/sky.h"
#include "scene/model/face_materials.h"
#include "scene/model/scene.h"
#include <stdlib.h>

/* --- lines --- */

int spectral_lines_of(const light *l, lamp_line lines[LAMP_LINES_MAX])
{
    spectral_line exact[LAMP_LINES_MAX];
    const int count = lamp_lines((lamp_spectrum)l->spectrum, l->line_nm, exact);
    for (int k = 0; k < count; k++) {
        double eye[3];
        observer_weights(exact[k].nm, eye);
        const double power = exact[k].power * l->intensity;
        lines[k] = (lamp_line){spectra_number(exact[k].nm), power * SPECTRA_COUNT, power * (eye[0] + eye[1] + eye[2])};
    }
    return count;
}

/* The line of a beam, computed as for a lamp. */
static int lines_of_beam(const scene *s, const beam *b, lamp_line lines[LAMP_LINES_MAX])
{
    const light lamp = {.spectrum = LAMP_LINE, .line_nm = b->lambda_nm, .intensity = b->power};
    return beam_lights_scene(b, &s->render) && !b->white ? spectral_lines_of(&lamp, lines) : 0;
}

static bool is_black(vec3 color)
{
    return color.x == 0.0 && color.y == 0.0 && color.z == 0.0;
}

/* Whether the sky emits light; each kind uses different colours (render/plan/sky.h). */
static bool sky_shines(const background *b)
{
    switch ((background_kind)b->kind) {
    case BACKGROUND_UNIFORM: break;
    case BACKGROUND_RAIN: return !is_black(b->color) || !is_black(b->horizon) || b->rain > 0.0;
    case BACKGROUND_GRADIENT:
    case BACKGROUND_CIE: return !is_black(b->color) || !is_black(b->horizon);
    case BACKGROUND_IMAGE: return true;
    }
    return !is_black(b->color);
}

/* Whether a surface emits light, or reflects ambient light, which random paths do not have. */
static bool surface_shines(const scene *s, const material *m)
{
    const bool ambient =
        m->ambient > 0.0 && !is_black(s->background.ambient) && !integrator_traits_of(&s->render)->by_chance;
    return (m->emission > 0.0 || ambient) && (!is_black(m->color) || (m->checker > 0.0 && !is_black(m->checker_color)));
}

static bool solid_shines(const scene *s, const solid *one)
{
    const int slots = face_material_slots(s, one);
    bool any = slots == 0 && surface_shines(s, &one->surface);
    for (int slot = 0; slot < slots; slot++) {
        const shading_material of_face = shading_material_of_face(s, one, &one->surface, slot);
        any |= surface_shines(s, &of_face.surface);
    }
    return any && one->visible;
}

static bool lamp_has_continuum(const light *l)
{
    return l->intensity > 0.0 && (l->spectrum == LAMP_BLACK_BODY || l->spectrum == LAMP_DATA ||
                                  (l->spectrum == LAMP_OF_COLOR && !is_black(l->color)));
}

/* Whether anything in the scene emits light other than lines. */
static bool emits_a_continuum(const scene *s)
{
    bool any = sky_shines(&s->background);
    for (size_t i = 0; i < s->light_count; i++)
        any |= lamp_has_continuum(&s->lights[i]);
    for (size_t i = 0; i < s->beam_count; i++)
        any |= s->beams[i].white && beam_lights_scene(&s->beams[i], &s->render);
    for (size_t i = 0; i < s->solid_count; i++)
        any |= solid_shines(s, &s->solids[i]);
    return any;
}

/* Adds the brightness of the lines by wavelength, and returns their sum. */
static double add_lines(const scene *s, double *bright)
{
    double all = 0.0;
    for (size_t i = 0; i < s->light_count + s->beam_count; i++) {
        lamp_line lines[LAMP_LINES_MAX];
        const int count = i < s->light_count ? spectral_lines_of(&s->lights[i], lines)
                                             : lines_of_beam(s, &s->beams[i - s->light_count], lines);
        for (int k = 0; k < count; k++)
            bright[lines[k].wavelength] += lines[k].bright, all += lines[k].bright;
    }
    return all;
}

/* Each line has one slot; the spare slots are distributed by brightness, with rounded cumulative numbers. */
static void fill_slots(line_table *t, const double *bright, double all)
{
    const int spare = LINE_SLOTS - t->count;
    double so_far = 0.0;
    int filled = 0, passed = 0;
    for (int w = 0; w < SPECTRA_COUNT; w++) {
        if (!(bright[w] > 0.0))
            continue;
        passed++;
        so_far += bright[w];
        for (const int end = passed + (int)(so_far / all * spare + 0.5); filled < end && filled < LINE_SLOTS;)
            t->slot[filled++] = (int16_t)w;
    }
}

line_table line_table_of(const scene *s)
{
    line_table t = {.lines_only = !emits_a_continuum(s)};
    double bright[SPECTRA_COUNT] = {0.0};
    const double all = add_lines(s, bright);
    for (int w = 0; w < SPECTRA_COUNT; w++)
        t.count += bright[w] > 0.0;
    if (t.count > 0)
        fill_slots(&t, bright, all);
    return t;
}

int64_t line_table_choose(const line_table *t, double u, bool *of_line)
{
    *of_line = t->lines_only || u >= 0.5;
    if (!*of_line)
        return (int64_t)(2.0 * u * SPECTRA_COUNT);
    return t->slot[(int)((t->lines_only ? u : 2.0 * u - 1.0) * LINE_SLOTS)];
}

double line_table_density(const line_table *t, int64_t wavelength)
{
    int slots = 0;
    if (t->count == 0)
        return 1.0;
    for (int k = 0; k < LINE_SLOTS; k++)
        slots += t->slot[k] == wavelength;
    const double of_lines = (double)slots / LINE_SLOTS * SPECTRA_COUNT;
    return t->lines_only ? of_lines : 0.5 + 0.5 * of_lines;
}

/* --- tables --- */

/* The scene's upsampled colours, before they are evaluated at each wavelength. */
typedef struct upsampled_scene {
    const scene *s;
    const material *const *materials;
    const index_law *const *laws;
    upsampled_spectrum sky, horizon, ambient, basis[SKY_BASIS_COUNT];
    upsampled_spectrum *color, *checker_color, *light; /* by priority index, by priority index, by light */
} upsampled_scene;

static upsampled_spectrum upsample_light(vec3 color, double intensity)
{
    return upsample_emission((const double[3]){color.x * intensity, color.y * intensity, color.z * intensity});
}

static upsampled_spectrum upsample_surface(vec3 color)
{
    return upsample_reflectance((const double[3]){color.x, color.y, color.z});
}

static const double basis[SKY_BASIS_COUNT][3] = {{1, 1, 1}, {0, 1, 1}, {1, 0, 1}, {1, 1, 0},
                                                 {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

static bool upsample_scene(upsampled_scene *l, size_t priority_indices)
{
    const scene *s = l->s;
    l->color = calloc(priority_indices, sizeof *l->color);
    l->checker_color = calloc(priority_indices, sizeof *l->checker_color);
    l->light = calloc(s->light_count + 1, sizeof *l->light);
    if (!l->color || !l->checker_color || !l->light)
        return false;
    for (size_t r = 1; r < priority_indices; r++) {
        l->color[r] = upsample_surface(l->materials[r]->color);
        l->checker_color[r] = upsample_surface(l->materials[r]->checker_color);
    }
    for (size_t i = 0; i < s->light_count; i++)
        l->light[i] = upsample_light(s->lights[i].color, s->lights[i].intensity);
    l->sky = upsample_light(s->background.color, 1.0);
    l->horizon = upsample_light(s->background.horizon, 1.0);
    l->ambient = upsample_light(s->background.ambient, 1.0);
    for (size_t i = 0; i < SKY_BASIS_COUNT; i++)
        l->basis[i] = upsample_emission(basis[i]);
    return true;
}

/* The weights of what the film records: the observer's, or those of bands, whose mean over all wavelengths is the mean
 * over the band. */
static void eye_of(const render_settings *r, int64_t number, double eye[3])
{
    observer_weights(spectra_lambda(number), eye);
    for (int c = 0; c < 3 && r->bands > 0; c++)
        eye[c] = number * r->bands / SPECTRA_COUNT == r->band + c ? (double)r->bands : 0.0;
}

static spectral_row row_at(const upsampled_scene *l, int64_t number, double density)
{
    const double lambda_nm = spectra_lambda(number);
    spectral_row row;
    eye_of(&l->s->render, number, row.eye);
    for (int c = 0; c < 3; c++)
        row.eye[c] /= density;
    row.sky = upsampled_emission(&l->sky, lambda_nm);
    row.horizon = upsampled_emission(&l->horizon, lambda_nm);
    row.ambient = upsampled_emission(&l->ambient, lambda_nm);
    for (size_t i = 0; i < SKY_BASIS_COUNT; i++)
        row.basis[i] = upsampled_emission(&l->basis[i], lambda_nm);
    return row;
}

static region_spectrum region_at(const upsampled_scene *l, size_t priority_index, double lambda_nm)
{
    region_spectrum b = {.index = index_law_at(l->laws[priority_index], lambda_nm)};
    if (!l->materials[priority_index]) {
        b.absorption = surrounding_absorption_at(&l->s->background, lambda_nm) * l->s->render.unit_m;
        return b;
    }
    const material *m = l->materials[priority_index];
    b.color = m->color_values ? optical_data_fraction(m->color_values, lambda_nm)
                              : upsampled_reflectance(&l->color[priority_index], lambda_nm);
    b.checker_color = upsampled_reflectance(&l->checker_color[priority_index], lambda_nm);
    b.absorption = material_absorption_at(l->materials[priority_index], lambda_nm) * l->s->render.unit_m;
    b.scattering = material_scattering_at(m, lambda_nm) * l->s->render.unit_m;
    if (material_tints(l->materials[priority_index]))
        b.absorption += material_tint(l->materials[priority_index], b.color);
    return b;
}

int64_t wavelengths_per_offset(const render_settings *render)
{
    if (!integrator_traits_of(render)->by_chance)
        return render->wavelengths;
    return render->sampler == SAMPLER_SOBOL ? render->paths / path_sampling_of(render).replicates : render->paths;
}

/* The i-th of `count` wavelengths; *of_line: whether it is drawn from the lines. */
static int64_t wavelength_of(const spectra *p, int64_t i, int64_t count, int offset, bool *of_line)
{
    *of_line = false;
    if (p->lines.count == 0)
        return (int64_t)(((double)i + (offset + 0.5) / SPECTRA_OFFSETS) / (double)count * SPECTRA_COUNT);
    return line_table_choose(&p->lines, ((double)i + (offset + 0.5) / SPECTRA_OFFSETS) / (double)count, of_line);
}

static void whiten(spectra *p, int offset)
{
    const int64_t count = p->per_offset;
    double white[3], sum[3] = {0.0, 0.0, 0.0};
    int64_t even = 0; /* wavelengths not drawn from lines; the others' part of white is subtracted from the target */
    linear_srgb_to_xyz((const double[3]){1.0, 1.0, 1.0}, white);
    for (int64_t i = 0; i < count; i++) {
        bool of_line;
        const spectral_row *row = &p->rows[wavelength_of(p, i, count, offset, &of_line)];
        double *to = of_line ? white : sum;
        for (int c = 0; c < 3; c++)
            to[c] += (of_line ? -1.0 : 1.0) * row->eye[c] * row->basis[0] / (double)count;
        even += !of_line;
    }
    for (int c = 0; c < 3; c++)
        p->white[offset][c] = even < SPECTRA_WHITE_FROM ? 1.0 : white[c] / sum[c];
}

/* Adds a lamp's light, by wavelength number. */
static void fill_light(const upsampled_scene *l, spectra *p, size_t lamp)
{
    const light *one = &l->s->lights[lamp];
    lamp_line lines[LAMP_LINES_MAX];
    const int count = spectral_lines_of(one, lines);
    const double of_body =
        one->spectrum == LAMP_BLACK_BODY ? one->intensity * black_body_scale(one->temperature_k) : 0.0;
    double xyz[3] = {0.0, 1.0, 0.0};
    const optical_data *of = one->spectrum == LAMP_DATA ? one->emission_data : NULL;
    if (of)
        spectrum_xyz(optical_data_emission, of, xyz);
    for (size_t i = 0; i < SPECTRA_COUNT; i++) {
        const double lambda_nm = spectra_lambda((int64_t)i);
        p->lights[i * p->light_count + lamp] =
            one->spectrum == LAMP_OF_COLOR     ? upsampled_emission(&l->light[lamp], lambda_nm)
            : one->spectrum == LAMP_BLACK_BODY ? of_body * planck_relative(lambda_nm, one->temperature_k)
            : of                               ? one->intensity / xyz[1] * optical_data_emission(of, lambda_nm)
                                               : 0.0;
    }
    for (int k = 0; k < count; k++)
        p->lights[(size_t)lines[k].wavelength * p->light_count + lamp] += lines[k].radiance;
}

/* The reflectances of the basis colours, if a mesh shows the colours of its vertices. False: out of memory. */
static bool fill_tints(const scene *s, spectra *p)
{
    bool any = false;
    for (size_t i = 0; i < s->solid_count; i++)
        any |= s->solids[i].visible && solid_shows_vertex_colors(s, &s->solids[i]);
    if (!any)
        return true;
    if (!(p->tints = malloc(SPECTRA_COUNT * sizeof *p->tints)))
        return false;
    for (size_t k = 0; k < SKY_BASIS_COUNT; k++) {
        const upsampled_spectrum one = upsample_reflectance(basis[k]);
        for (size_t i = 0; i < SPECTRA_COUNT; i++)
            p->tints[i][k] = upsampled_reflectance(&one, spectra_lambda((int64_t)i));
    }
    return true;
}

static bool fill_tables(const upsampled_scene *l, spectra *p)
{
    p->rows = calloc(SPECTRA_COUNT, sizeof *p->rows);
    p->regions = calloc(SPECTRA_COUNT * p->priority_indices, sizeof *p->regions);
    p->lights = calloc(SPECTRA_COUNT * (p->light_count + 1), sizeof *p->lights);
    p->white = calloc(SPECTRA_OFFSETS, sizeof *p->white);
    if (!p->rows || !p->regions || !p->lights || !p->white)
        return false;
    for (size_t i = 0; i < SPECTRA_COUNT; i++) {
        const double lambda_nm = spectra_lambda((int64_t)i);
        p->rows[i] = row_at(l, (int64_t)i, line_table_density(&p->lines, (int64_t)i));
        for (size_t r = 0; r < p->priority_indices; r++)
            p->regions[i * p->priority_indices + r] = region_at(l, r, lambda_nm);
    }
    for (size_t k = 0; k < p->light_count; k++)
        fill_light(l, p, k);
    p->per_offset = wavelengths_per_offset(&l->s->render);
    for (int i = 0; i < SPECTRA_OFFSETS; i++)
        if (l->s->render.bands > 0)
            p->white[i][0] = p->white[i][1] = p->white[i][2] = 1.0;
        else
            whiten(p, i);
    return fill_tints(l->s, p);
}

spectra *spectra_create(const scene *s, const material *const *materials, const index_law *const *laws,
                        size_t priority_indices)
{
    upsampled_scene l = {.s = s, .materials = materials, .laws = laws};
    spectra *p = calloc(1, sizeof *p);
    if (p)
        p->priority_indices = priority_indices, p->light_count = s->light_count, p->lines = line_table_of(s);
    const bool done = p && upsample_scene(&l, priority_indices) && fill_tables(&l, p);
    free(l.color);
    free(l.checker_color);
    free(l.light);
    if (done)
        return p;
    spectra_destroy(p);
    return NULL;
}

void spectra_destroy(spectra *p)
{
    if (!p)
        return;
    free(p->rows);
    free(p->regions);
    free(p->lights);
    free(p->white);
    free(p->tints);
    free(p);
}

double spectra_lambda(int64_t number)
{
    return OBSERVER_LOW_NM + ((double)number + 0.5) * ((double)(OBSERVER_HIGH_NM - OBSERVER_LOW_NM) / SPECTRA_COUNT);
}

int spectra_number(double lambda_nm)
{
    const int number =
        (int)((lambda_nm - OBSERVER_LOW_NM) * ((double)SPECTRA_COUNT / (OBSERVER_HIGH_NM - OBSERVER_LOW_NM)));
    return number < SPECTRA_COUNT ? number : SPECTRA_COUNT - 1;
}

int64_t spectra_choose(const spectra *p, const render_settings *render, int64_t sample_key, const double **white)
{
    const int64_t count = p->per_offset;
    const int64_t sample = sample_key_sample(sample_key),
                  all_of = sample_key_make(sample_key_pixel(sample_key), sample / count);
    const int offset = (int)(draw(render->seed, all_of, 0, DRAW_WAVELENGTH).word[0] % SPECTRA_OFFSETS);
    static const double unchanged[3] = {1.0, 1.0, 1.0};
    bool of_line;
    const int64_t wavelength = wavelength_of(p, sample % count, count, offset, &of_line);
    *white = of_line ? unchanged : p->white[offset];
    return sample_key_with_wavelength(sample_key, wavelength);
}

/* A colour as a sum of white, a secondary and a primary colour: Smits, "An RGB to Spectrum Conversion for
 * Reflectances", JGT 4(4), 1999, with basis spectra upsampled like all other colours. Linear as long as the order of
 * the channels does not change. */
static double basis_sum(const double by[SKY_BASIS_COUNT], vec3 rgb)
{
    const double v[3] = {rgb.x, rgb.y, rgb.z};
    int low = v[0] <= v[1] ? (v[0] <= v[2] ? 0 : 2) : (v[1] <= v[2] ? 1 : 2);
    int high = v[0] > v[1] ? (v[0] > v[2] ? 0 : 2) : (v[1] > v[2] ? 1 : 2);
    if (high == low) /* a grey */
        high = (low + 1) % 3;
    const int middle = 3 - low - high;
    return v[low] * by[0] + (v[middle] - v[low]) * by[1 + low] + (v[high] - v[middle]) * by[4 + high];
}

double spectra_tint(const spectra *p, int64_t sample_key, vec3 color)
{
    return basis_sum(p->tints[sample_key_wavelength(sample_key)], color);
}

double spectra_sky(const spectral_row *row, const background *sky, vec3 direction)
{
    const double up = direction.y > 0.0 ? direction.y : 0.0;
    switch ((background_kind)sky->kind) {
    case BACKGROUND_UNIFORM: break;
    case BACKGROUND_RAIN:
    case BACKGROUND_GRADIENT: return (1.0 - up) * row->horizon + up * row->sky;
    case BACKGROUND_IMAGE: return basis_sum(row->basis, sky_radiance(sky, direction));
    case BACKGROUND_CIE: return up > 0.0 ? row->sky * cie_sky_relative(&sky->cie, direction) : row->horizon;
    }
    return row->sky;
}

double spectra_sky_mean(const spectral_row *row, const background *sky, vec3 mean)
{
    switch ((background_kind)sky->kind) {
    case BACKGROUND_UNIFORM: break;
    case BACKGROUND_RAIN:
    case BACKGROUND_GRADIENT: return 0.75 * row->horizon + 0.25 * row->sky;
    case BACKGROUND_IMAGE: return basis_sum(row->basis, mean);
    case BACKGROUND_CIE: return 0.5 * (row->horizon + row->sky * sky->cie.mean);
    }
    return row->sky;
}
