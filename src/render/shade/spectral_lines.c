/* The shares of the lines. */
#include "render/shade/spectral_lines.h"

#include "render/shade/spectra.h"
#include "scene/model/face_materials.h"

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

/* A beam's line, as that of a lamp. */
static int lines_of_beam(const scene *s, const beam *b, lamp_line lines[LAMP_LINES_MAX])
{
    const light lamp = {.spectrum = LAMP_LINE, .line_nm = b->lambda_nm, .intensity = b->power};
    return beam_lights_scene(b, &s->render) && !b->white ? spectral_lines_of(&lamp, lines) : 0;
}

static bool is_black(vec3 color)
{
    return color.x == 0.0 && color.y == 0.0 && color.z == 0.0;
}

/* Each kind of sky has its own colours; render/shade/sky.h. */
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

/* Random paths have no ambient light. */
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
    return l->intensity > 0.0 &&
           (l->spectrum == LAMP_BLACK_BODY || (l->spectrum == LAMP_OF_COLOR && !is_black(l->color)));
}

/* Does anything that the film shows emit light of other wavelengths? */
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

/* By wavelength. */
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

/* Each line has at least one slot; the others are shared in proportion, so that the sum so far is nearest. */
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
    line_table t = {.alone = !emits_a_continuum(s)};
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
    *of_line = t->alone || u >= 0.5;
    if (!*of_line)
        return (int64_t)(2.0 * u * SPECTRA_COUNT);
    return t->slot[(int)((t->alone ? u : 2.0 * u - 1.0) * LINE_SLOTS)];
}

double line_table_density(const line_table *t, int64_t wavelength)
{
    int slots = 0;
    if (t->count == 0)
        return 1.0;
    for (int k = 0; k < LINE_SLOTS; k++)
        slots += t->slot[k] == wavelength;
    const double of_lines = (double)slots / LINE_SLOTS * SPECTRA_COUNT;
    return t->alone ? of_lines : 0.5 + 0.5 * of_lines;
}
