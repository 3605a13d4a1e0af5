/* The shares of the lines. */
#include "render/shade/spectral_lines.h"

#include "render/shade/spectra.h"

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

/* Does anything emit light of other wavelengths? */
static bool emits_a_continuum(const scene *s)
{
    const background *b = &s->background;
    const vec3 sum = vec3_add(b->color, vec3_add(b->horizon, b->ambient));
    bool any = sum.x + sum.y + sum.z > 0.0 || b->kind == BACKGROUND_IMAGE || b->rain > 0.0;
    for (size_t i = 0; i < s->light_count; i++)
        any |= s->lights[i].spectrum < LAMP_SODIUM && s->lights[i].intensity > 0.0;
    for (size_t i = 0; i < s->beam_count; i++)
        any |= s->beams[i].white && beam_lights_scene(&s->beams[i], &s->render);
    for (size_t i = 0; i < s->solid_count; i++)
        any |= s->solids[i].surface.emission > 0.0 || s->solids[i].mesh[0];
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
