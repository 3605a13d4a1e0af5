/* The search for parameters by words and synonyms (params.h). */
#include "scene/model/params.h"

#include <ctype.h>
#include <string.h>
#include <strings.h>

enum { MEANINGS_MAX = 6 };

/* Everyday words: a search for `word` also finds the rows whose path, meaning or choices contain one of its meanings.
 * Add a word if a search for it finds nothing, or misses what a newcomer means. */
static const struct synonym {
    const char *word, *meanings[MEANINGS_MAX];
} synonyms[] = {
    {"air", {"background.ior", "background.medium", "background.absorb"}},
    {"angle", {"rotation", "yaw", "pitch", "roll", "half_angle", "fov"}},
    {"antialiasing", {"render.samples", "render.filter", "render.paths"}},
    {"birefringent", {"extraordinary", "optic_axis", "birefringence"}},
    {"blur", {"render.filter", "shininess", "roughness"}},
    {"bounces", {"render.depth"}},
    {"brightness", {"intensity", "emission", "ambient", "background.color"}},
    {"bubble", {"film_thickness", "film_ior"}},
    {"calcite", {"extraordinary", "optic_axis"}},
    {"caustics", {"render.integrator", "render.shadows"}},
    {"colour", {"color", "absorb", "tint"}},
    {"cores", {"render.threads"}},
    {"crystal", {"extraordinary", "optic_axis", "medium"}},
    {"dark", {"intensity", "ambient", "render.depth"}},
    {"dispersion", {"medium", "coefficients", "render.spectrum", "render.wavelengths"}},
    {"environment", {"background"}},
    {"exposure", {"intensity", "emission"}},
    {"fresnel", {"render.weights"}},
    {"fog", {"scatter", "asymmetry"}},
    {"frosted", {"roughness"}},
    {"glass", {"medium", "ior", "transparency"}},
    {"glow", {"emission"}},
    {"index", {"ior", "medium", "coefficients"}},
    {"lens", {"fov", "ior"}},
    {"liquid", {"medium", "ior", "transparency", "absorb"}},
    {"magnification", {"fov"}},
    {"metal", {"medium", "extinction"}},
    {"mirror", {"reflectivity", "ior"}},
    {"milk", {"scatter", "asymmetry"}},
    {"murky", {"absorb", "tint", "scatter"}},
    {"noise", {"render.paths", "render.samples", "render.error", "render.sampler"}},
    {"oil", {"medium", "ior", "transparency", "absorb", "film_thickness"}},
    {"opacity", {"transparency"}},
    {"place", {"position"}},
    {"plate", {"sheet", "retardance", "birefringence"}},
    {"polarizer", {"sheet", "render.polarisation", "camera.analyser"}},
    {"polaroid", {"sheet", "render.polarisation", "camera.analyser"}},
    {"prism", {"medium", "coefficients", "render.spectrum", "sides"}},
    {"quality", {"render.samples", "render.depth", "render.paths", "render.width", "render.height"}},
    {"rainbow", {"background.kind", "background.rain", "background.drops", "render.spectrum", "medium"}},
    {"reflection", {"reflectivity", "render.depth", "render.weights", "specular"}},
    {"refraction", {"ior", "medium", "transparency", "render.transmission"}},
    {"resolution", {"render.width", "render.height"}},
    {"shiny", {"specular", "shininess", "reflectivity"}},
    {"sky", {"background", "background.sky_type"}},
    {"smooth", {"shading", "render.samples", "shininess", "roughness"}},
    {"soap", {"film_thickness", "film_ior"}},
    {"speed", {"render.threads", "render.accel", "render.samples", "render.depth"}},
    {"sun", {"background.sun", "light.position", "light.angular_diameter"}},
    {"transparent", {"transparency"}},
    {"waveplate", {"sheet", "retardance", "birefringence"}},
    {"water", {"medium", "ior", "transparency", "absorb"}},
    {"zoom", {"fov", "camera.position", "scale"}},
};

/* A word of the search, within its text. */
typedef struct query_word {
    const char *text;
    size_t length;
} query_word;

static bool next_word(const char **rest, query_word *out)
{
    while (isspace((unsigned char)**rest))
        ++*rest;
    out->text = *rest;
    while (**rest && !isspace((unsigned char)**rest))
        ++*rest;
    out->length = (size_t)(*rest - out->text);
    return out->length > 0;
}

static bool starts(const char *text, query_word w)
{
    return strncasecmp(text, w.text, w.length) == 0;
}

/* strcasestr for a word that is not terminated. */
static bool contains(const char *text, query_word w)
{
    for (; *text; text++)
        if (starts(text, w))
            return true;
    return false;
}

/* Whether the query is the synonym's word, its plural, or its beginning: 'brigh' finds what 'brightness' does. */
static bool means(const struct synonym *s, query_word w)
{
    enum { LEAST = 3 };
    const size_t length = strlen(s->word);
    if (w.length == length + 1 && tolower((unsigned char)w.text[length]) == 's')
        return strncasecmp(w.text, s->word, length) == 0;
    return (w.length == length || w.length >= LEAST) && starts(s->word, w);
}

/* Whether the word is in the path or, with `everywhere`, in the row's meaning or one of its choices. */
static bool row_has(const param *row, const char *path, bool everywhere, query_word w)
{
    bool found = contains(path, w) || (everywhere && contains(row->meaning, w));
    for (size_t i = 0; everywhere && row->choices && row->choices[i] && !found; i++)
        found = contains(row->choices[i], w);
    return found;
}

static bool row_means(const param *row, const char *path, bool everywhere, query_word w)
{
    bool found = row_has(row, path, everywhere, w);
    for (size_t i = 0; i < sizeof synonyms / sizeof *synonyms && !found; i++)
        for (int k = 0; k < MEANINGS_MAX && synonyms[i].meanings[k] && !found; k++)
            found =
                means(&synonyms[i], w) &&
                row_has(row, path, everywhere, (query_word){synonyms[i].meanings[k], strlen(synonyms[i].meanings[k])});
    return found;
}

/* Whether the path, or one of its parts, begins with the word. */
static bool part_starts(const char *path, query_word w)
{
    for (const char *at = path; at; at = strpbrk(at, "._") ? strpbrk(at, "._") + 1 : NULL)
        if (starts(at, w))
            return true;
    return false;
}

param_match param_matches(const param *row, const char *path, const char *words)
{
    bool in_name = true, in_path = true;
    query_word w;
    while (next_word(&words, &w)) {
        if (!row_means(row, path, true, w))
            return PARAM_NO_MATCH;
        in_name = in_name && part_starts(path, w);
        in_path = in_path && row_means(row, path, false, w);
    }
    return in_name ? PARAM_IN_NAME : in_path ? PARAM_IN_PATH : PARAM_IN_TEXT;
}
