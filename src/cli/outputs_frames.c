/* Channels of an OpenEXR image that need frames of their own: Stokes vectors, and bands of wavelengths. */
#include "cli/options.h"
#include "cli/outputs.h"
#include "render/plan/spectra.h"
#include "scene/model/scene.h"
#include <stdlib.h>

status more_frames_check(const outputs *o, const scene *s, diagnostic *why)
{
    const char *option = o->stokes ? "--stokes" : "--bands";
    if (!o->stokes && o->bands == 0)
        return STATUS_OK;
    if (!o->img || image_format_of(o->img) != IMAGE_EXR)
        return options_wrong(option, NULL, why, "add -o FILE.exr", "only an OpenEXR image holds it");
    if (o->stokes && !s->render.polarisation)
        return options_wrong("--stokes", NULL, why, "set render.polarisation to on", "the scene's light has no state");
    if (o->stokes && s->camera.analyser != ANALYSER_NONE)
        return options_wrong("--stokes", NULL, why, "set camera.analyser to none",
                             "behind an analyser all light has one state");
    if (o->bands > 0 && s->render.spectrum != SPECTRUM_SPECTRAL)
        return options_wrong("--bands", NULL, why, "set render.spectrum to spectral", "the film has no wavelengths");
    if (o->bands > 0 && wavelengths_per_offset(&s->render) % o->bands != 0)
        return options_wrong("--bands", NULL, why, "give a divisor of it",
                             "%lld bands do not have equal shares of the %lld wavelengths of a pixel",
                             (long long)o->bands, (long long)wavelengths_per_offset(&s->render));
    return STATUS_OK;
}

static float value_of_three(const void *of, size_t pixel)
{
    return ((const float *)of)[3 * pixel];
}

static void add_channel(more_frames *m, const char *name, const float *values)
{
    m->channels.channels[m->channels.count++] = (image_channel){name, value_of_three, values};
}

static void add_text(more_frames *m, const char *keyword, const char *text)
{
    m->texts[m->channels.text_count++] = (image_text){keyword, text};
    m->channels.texts = m->texts;
}

/* Renders the changed scene; *out is twice its film minus `whole`, or the film if that is NULL. */
static status render_values(more_frames *m, scene *changed, const film *whole, job *frame_job, float **out,
                            diagnostic *why)
{
    job_account account = {.result = NULL};
    const size_t count = 3 * (size_t)changed->render.width * (size_t)changed->render.height;
    float *values = *out = m->values[m->value_count++] = malloc(count * sizeof *values);
    status code = values ? job_render(frame_job, changed, NULL, &account, why) : out_of_memory(why);
    for (size_t i = 0; code == STATUS_OK && i < count; i++) {
        const int x = (int)(i / 3 % (size_t)changed->render.width), y = (int)(i / 3 / (size_t)changed->render.width),
                  channel = (int)(i % 3);
        const double value = film_value(account.result->img, x, y, channel);
        values[i] = (float)(whole ? 2.0 * value - film_value(whole, x, y, channel) : value);
    }
    job_account_release(&account);
    return code;
}

/* An ideal analyser passes (S0 + S) / 2, where S is S1 at 0 degrees, S2 at 45 degrees, and S3 for left-handed light
 * (Collett, Polarized Light, 4.4). */
static status add_stokes(more_frames *m, scene *changed, const film *whole, job *frame_job, diagnostic *why)
{
    static const struct {
        analyser_kind kind;
        double angle_deg;
        const char *names[3];
    } states[] = {{ANALYSER_LINEAR, 0.0, {"S1.R", "S1.G", "S1.B"}},
                  {ANALYSER_LINEAR, 45.0, {"S2.R", "S2.G", "S2.B"}},
                  {ANALYSER_CIRCULAR_LEFT, 0.0, {"S3.R", "S3.G", "S3.B"}}};
    for (int i = 0; i < 3; i++) {
        float *values;
        changed->camera.analyser = states[i].kind;
        changed->camera.analyser_angle_deg = states[i].angle_deg;
        TRY(render_values(m, changed, whole, frame_job, &values, why));
        for (int k = 0; k < 3; k++)
            add_channel(m, states[i].names[k], values + k);
    }
    changed->camera.analyser = ANALYSER_NONE;
    add_text(m, "polarisationHandedness", "left"); /* positive S3 */
    return STATUS_OK;
}

/* Fichet, Pacanowski and Wilkie, "An OpenEXR Layout for Spectral Images", JCGT 10(3), 2021: the name of a channel has
 * its wavelength, here the middle of the band, with a decimal comma. */
static status add_bands(more_frames *m, scene *changed, int64_t bands, job *frame_job, diagnostic *why)
{
    const double width_nm = (double)(OBSERVER_HIGH_NM - OBSERVER_LOW_NM) / (double)bands;
    changed->render.bands = bands;
    for (int64_t band = 0; band < bands; band += 3) {
        float *values;
        changed->render.band = band;
        TRY(render_values(m, changed, NULL, frame_job, &values, why));
        for (int64_t k = 0; k < 3 && band + k < bands; k++) {
            char *name = m->names[band + k];
            const int thousandths = (int)(1000.0 * (OBSERVER_LOW_NM + ((double)(band + k) + 0.5) * width_nm) + 0.5);
            snprintf(name, sizeof m->names[0], "S0.%d,%03dnm", thousandths / 1000, thousandths % 1000);
            add_channel(m, name, values + k);
        }
    }
    add_text(m, "spectralLayoutVersion", "1.0");
    add_text(m, "emissiveUnits", "relative: a white surface under D65 has Y = 1");
    return STATUS_OK;
}

status more_frames_render(const outputs *o, const scene *s, const film *whole, job *frame_job, more_frames *m,
                          diagnostic *why)
{
    *m = (more_frames){.value_count = 0};
    if (!o->stokes && o->bands == 0)
        return STATUS_OK;
    scene *changed = scene_clone(s);
    status code = changed ? STATUS_OK : out_of_memory(why);
    if (o->stokes)
        THEN(code, add_stokes(m, changed, whole, frame_job, why));
    if (o->bands > 0)
        THEN(code, add_bands(m, changed, o->bands, frame_job, why));
    scene_destroy(changed);
    return code;
}

void more_frames_release(more_frames *m)
{
    for (int i = 0; i < m->value_count; i++)
        free(m->values[i]);
}
