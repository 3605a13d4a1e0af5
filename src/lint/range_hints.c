/* Notes on refractive indices outside the wavelengths at which they were measured. A dispersion law is extrapolated
 * there; a table keeps the value of its end. */
#include "lint/lint.h"
#include "scene/model/medium.h"
#include "scene/model/scene.h"

#include <stdio.h>

typedef struct nm_range {
    double low, high;
} nm_range;

static const nm_range visible = {VISIBLE_LOW_NM, VISIBLE_HIGH_NM};

/* The wavelengths at which laws are evaluated. */
typedef struct range_case {
    const scene *s;
    const note_sink *taker;
    nm_range clear, layered; /* for surroundings and transparent solids; for metals and films on opaque solids */
    bool beams;              /* the visible beams' wavelengths are used instead */
} range_case;

/* A spectral film needs the visible range, also for lamps that emit lines. An rgb film needs one wavelength for
 * transparent matter; the reflection of metals and films is integrated over daylight (render/plan/layered_table.h). */
static range_case of_film(const scene *s, const note_sink *taker)
{
    const nm_range one = {s->render.lambda_nm, s->render.lambda_nm};
    return (range_case){
        .s = s, .taker = taker, .clear = s->render.spectrum == SPECTRUM_SPECTRAL ? visible : one, .layered = visible};
}

/* The first visible beam with wavelengths outside the law's range, and in *at the range of its wavelengths; NULL for
 * none. */
static const beam *beam_beyond(const scene *s, const dispersion *law, nm_range *at)
{
    for (size_t i = 0; i < s->beam_count; i++) {
        const beam *b = &s->beams[i];
        *at = (nm_range){beam_lambda(b, 0), beam_lambda(b, beam_wavelengths(b) - 1)};
        if (b->visible && !dispersion_covers(law, at->low, at->high))
            return b;
    }
    return NULL;
}

static void say(const range_case *c, const char *where, const char *name, const dispersion *law, const char *who)
{
    const bool is_table = law->kind == DISPERSION_TABLE || law->kind == DISPERSION_CURVE,
               is_of_scene = is_table && !name;
    const bool is_stated = law->low_nm != 0.0 || law->high_nm != 0.0;
    const double low_nm = is_stated ? law->low_nm : law->coefficient[0],
                 high_nm = is_stated ? law->high_nm : law->coefficient[law->count - 2];
    if (is_of_scene)
        note_report(c->taker, where, "coefficients",
                    "use wavelengths in this range, or coefficients with a wider range",
                    "its table of indices covers only %g to %g nm and is constant outside%s", low_nm, high_nm, who);
    else
        note_report(c->taker, where, "medium",
                    is_table ? "use wavelengths in this range, or the ior and extinction of the wavelength"
                             : "use wavelengths in this range, or coefficients with a wider range",
                    "%s was measured only from %g to %g nm and is %s outside%s", name, low_nm, high_nm,
                    is_table ? "constant" : "extrapolated", who);
}

/* name: the medium's; NULL for a table in the scene file. */
static void hint_at_law(const range_case *c, const char *where, const char *name, const dispersion *law, nm_range at)
{
    char who[SCENE_NAME_MAX + 80] = "";
    if (c->beams) {
        const beam *b = beam_beyond(c->s, law, &at);
        if (!b)
            return;
        snprintf(who, sizeof who, at.low < at.high ? ": the beam %s has %g to %g nm" : ": the beam %s has %g nm",
                 b->name, at.low, at.high);
    }
    if (c->beams || !dispersion_covers(law, at.low, at.high))
        say(c, where, name, law, who);
}

static void hint_at_solid(const range_case *c, const solid *one)
{
    const material *m = &one->surface;
    const bool clear = !material_is_opaque(m);
    index_law law;
    if (!one->visible || !(clear || material_is_layered(m, &c->s->render)) ||
        material_index_law(m, "", &law, NULL) != STATUS_OK)
        return;
    hint_at_law(c, one->name,
                m->medium == MEDIUM_TABLE  ? NULL
                : m->medium == MEDIUM_DATA ? m->medium_data
                                           : medium_words[m->medium],
                &law.law, clear ? c->clear : c->layered);
}

static void hint_at_all(const range_case *c)
{
    const background *sky = &c->s->background;
    const index_law around = surrounding_index_law(sky);
    hint_at_law(c, "background", surrounding_words[sky->medium], &around.law, c->clear);
    for (size_t i = 0; i < c->s->solid_count; i++)
        hint_at_solid(c, &c->s->solids[i]);
}

void scene_range_hints(const scene *s, const note_sink *taker)
{
    const range_case c = of_film(s, taker);
    hint_at_all(&c);
}

void scene_lambda_range_hints(const scene *s, bool layered, const note_sink *taker)
{
    const nm_range one = {s->render.lambda_nm, s->render.lambda_nm};
    hint_at_all(&(range_case){.s = s, .taker = taker, .clear = one, .layered = layered ? one : visible});
}

void scene_beam_range_hints(const scene *s, const note_sink *taker)
{
    hint_at_all(&(range_case){.s = s, .taker = taker, .beams = true});
}
